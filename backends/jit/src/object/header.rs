//! The C header of an object: its structs, and what each function promises.

use super::interface::Interface;
use super::names::{Names, comment};
use super::types::{CStruct, Structs};
use crate::DEFAULT_BUDGET;
use crate::block::Block;
use iecc_ir::{FaultCode, Module};
use std::fmt::Write as _;

/// Functions and types of every header, after the name of the program and `_`; nothing else may have
/// these names.
const API: [&str; 12] = [
    "state",
    "inputs",
    "outputs",
    "tags",
    "init",
    "scan",
    "state_size",
    "inputs_size",
    "outputs_size",
    "fault_text",
    "fault_place",
    "H",
];

/// Everything a header tells.
pub(super) struct Header<'h> {
    /// The program as the user named it.
    title: &'h str,
    /// What all names begin with.
    name: &'h str,
    interface: &'h Interface,
    nested: Vec<CStruct>,
    inputs: CStruct,
    outputs: CStruct,
    tags: CStruct,
}

impl<'h> Header<'h> {
    /// Names what a module holds.
    pub(super) fn new(module: &'h Module, name: &'h str, interface: &'h Interface) -> Self {
        let mut names = Names::default();
        for taken in API {
            names.claim(&format!("{name}_{taken}"));
        }
        let mut structs = Structs::new(module, name, names);
        let mut region = |id, suffix| structs.region(id, &format!("{name}_{suffix}"));
        Self {
            title: &module.name,
            name,
            interface,
            inputs: region(module.input, "inputs"),
            outputs: region(module.output, "outputs"),
            tags: region(module.state, "tags"),
            nested: structs.nested,
        }
    }

    /// The header. Where the texts below say `@` stands the name.
    pub(super) fn text(&self) -> String {
        let mut text = self.introduction();
        for nested in &self.nested {
            let _ = writeln!(text, "{}", nested.definition());
        }
        text += "/* What the controller sees. */\n";
        let _ = writeln!(text, "{}", self.inputs.definition());
        text += "/* What the controller does. */\n";
        let _ = writeln!(text, "{}", self.outputs.definition());
        text += "/* What the program remembers, by the names it uses. */\n";
        let _ = writeln!(text, "{}", self.tags.definition());
        text += &self.state();
        text += &self.faults();
        text += &self.functions();
        text += &self.assertions();
        text.replace('@', self.name)
    }

    fn introduction(&self) -> String {
        let title = comment(self.title);
        let version = env!("CARGO_PKG_VERSION");
        format!(
            "/* {title}: a controller as machine code, made by iecc {version}.
 *
 *     static @_state controller;
 *     @_inputs inputs = {{0}};
 *     @_outputs outputs = {{0}};
 *
 *     @_init(&controller);
 *     inputs.... = ...;
 *     int fault = @_scan(&controller, &inputs, &outputs, now_ns);
 *
 * Link with @.o, which needs nothing but memmove and memset, if anything. It has no memory of
 * its own: every @_state is a controller, they may run side by side, and one may be used by one
 * thread at a time. Between scans a state may be copied, kept and put back.
 *
 * A comment beside a member tells its name in the program. A bool must be 0 or 1.
 */
#ifndef @_H
#define @_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The compiler that made this file and the object; they belong together. */
#define @_IECC_VERSION \"{version}\"

#ifdef __cplusplus
extern \"C\" {{
#endif

"
        )
    }

    fn state(&self) -> String {
        let block = &self.interface.block;
        let state_len = block.state_len;
        let mut text = "/* A controller. Only the last scan's time, the limit and the tags are of interest; change them
 * between scans only. */
typedef struct @_state {
    uint64_t last_ns;      /* time of the last scan without a fault */
    int64_t work_limit;    /* instructions a scan may execute, about; more are fault @_FAULT_BOUND */
    uint32_t started;      /* 1 after the first scan without a fault */
    uint32_t fault_origin; /* for @_fault_place */
"
        .to_owned();
        if state_len > 0 {
            text += "    @_tags tags;\n";
        }
        let rest = block.len() - Block::STATE - state_len;
        if rest > 0 {
            let _ = writeln!(
                text,
                "    uint8_t rest[{rest}]; /* of use in a scan only */"
            );
        }
        text + "} @_state;\n\n"
    }

    fn faults(&self) -> String {
        let mut text = "/* Faults: why a scan was abandoned. */\n".to_owned();
        for fault in FaultCode::ALL {
            let (number, meaning) = (fault.number(), fault.meaning());
            let upper = fault.name().to_ascii_uppercase();
            let _ = writeln!(text, "#define @_FAULT_{upper} {number} /* {meaning} */");
        }
        text + "\n"
    }

    fn functions(&self) -> String {
        let (stack_bytes, limit) = (self.interface.stack_bytes, DEFAULT_BUDGET);
        format!(
            "/* Makes a controller as it is before its first scan: initial values, no time, a limit of
 * {limit} instructions a scan. */
void @_init(@_state *state);

/* Executes one scan: reads the inputs, runs the program once, writes the outputs.
 *
 * now_ns is the time of the scan in nanoseconds, from any start; it is the same in the whole scan, and
 * must not be before the scan before. Timers count from one scan to the next, so the first counts
 * nothing.
 *
 * Returns 0, or the number of a fault. Then tags and outputs are as they were before, and the scan
 * does not count. An output that the program does not write keeps its value, so always pass the same ones.
 *
 * state, inputs and outputs must not overlap. The scan takes at most {stack_bytes} bytes of stack and expects
 * floating-point numbers to be handled as C does at the start of a program: rounding to nearest, small numbers not
 * flushed to zero. */
int @_scan(@_state *state, const @_inputs *inputs, @_outputs *outputs, uint64_t now_ns);

/* Bytes of the structs above, for languages that do not read this file. All need an alignment of 8. */
size_t @_state_size(void);
size_t @_inputs_size(void);
size_t @_outputs_size(void);

/* What the number of a fault means; \"{}\" for 0. */
const char *@_fault_text(int fault);

/* Where in the program the last fault arose, such as \"MainProgram/MainRoutine rung 3\"; \"\" if there was none or
 * its place is unknown. */
const char *@_fault_place(const @_state *state);

#ifdef __cplusplus
}} /* extern \"C\" */
#endif

",
            super::interface::NO_FAULT[0]
        )
    }

    /// A compiler that lays structs out in another way must not get through.
    fn assertions(&self) -> String {
        let mut text = "/* The layout that the object relies on. */
#if defined(__cplusplus)
#define @_ASSERT(fact) static_assert(fact, \"layout of @\")
#else
#define @_ASSERT(fact) _Static_assert(fact, \"layout of @\")
#endif
@_ASSERT(sizeof(bool) == 1 && sizeof(float) == 4 && sizeof(double) == 8);
"
        .to_owned();
        let size = |name: &str, bytes: u64| format!("@_ASSERT(sizeof({name}) == {bytes});\n");
        let all = [&self.inputs, &self.outputs, &self.tags];
        for made in self.nested.iter().chain(all) {
            if !made.members.is_empty() {
                text += &size(&made.name, made.bytes);
            }
            for (member, offset) in &made.members {
                let name = &made.name;
                let _ = writeln!(text, "@_ASSERT(offsetof({name}, {member}) == {offset});");
            }
        }
        if !self.tags.members.is_empty() {
            let _ = writeln!(
                text,
                "@_ASSERT(offsetof(@_state, tags) == {});",
                Block::STATE
            );
        }
        text += &size("@_state", self.interface.block.len() as u64);
        text + "#undef @_ASSERT\n\n#endif\n"
    }
}
