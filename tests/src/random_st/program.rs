//! The program, and the configuration it may be part of.

use super::Generator;
use super::types::{Elementary, Type, Types};
use super::units::Frame;

/// Addresses, some of which lie in others.
const DIRECT: [(&str, Elementary, bool); 9] = [
    ("%MD0", Elementary::Dword, true),
    ("%MW1", Elementary::Word, true),
    ("%MB2", Elementary::Byte, true),
    ("%MX3.5", Elementary::Bool, true),
    ("%ML0", Elementary::Lword, true),
    ("%IW0", Elementary::Word, false),
    ("%IX0.3", Elementary::Bool, false),
    ("%QW0", Elementary::Word, true),
    ("%QX0.7", Elementary::Bool, true),
];

impl Generator<'_> {
    /// A program alone, or two under a configuration with tasks and global variables.
    pub(super) fn programs(&mut self) {
        if !self.rng.one_in(4) {
            return self.program("Main", &[]);
        }
        let globals: Vec<(String, Type)> = (0..1 + self.rng.below(3))
            .map(|index| (format!("g{index}"), self.types.any(self.rng)))
            .collect();
        self.program("Main", &globals);
        self.program("Other", &globals);
        self.configuration(&globals);
    }

    fn program(&mut self, name: &str, globals: &[(String, Type)]) {
        self.put(&format!("PROGRAM {name}\n"));
        let mut frame = Frame::default();
        self.program_inputs(&mut frame);
        self.put("VAR_OUTPUT\n");
        for index in 0..1 + self.rng.below(3) {
            let ty = self.types.value(self.rng);
            let name = format!("out{index}");
            self.declaration(&name, ty, true);
            frame.add(&name, ty, true, false);
        }
        self.put("END_VAR\n");
        self.externals(&mut frame, globals);
        self.instances_section(&mut frame, 3);
        self.locals(&mut frame, "VAR", true);
        self.program_rest(&mut frame);
        let size = self.options.statements;
        self.body(frame, size);
        self.constants.clear();
        self.put("END_PROGRAM\n");
    }

    fn program_inputs(&mut self, frame: &mut Frame) {
        self.put("VAR_INPUT\n  a : INT;\n  b : BOOL;\n");
        frame.add("a", Type::INT, false, false);
        frame.add("b", Type::BOOL, false, false);
        for index in 0..self.rng.below(4) {
            let ty = Type::Elementary(Types::elementary(self.rng));
            let name = format!("in{index}");
            self.declaration(&name, ty, true);
            frame.add(&name, ty, false, false);
        }
        self.put("END_VAR\n");
    }

    fn externals(&mut self, frame: &mut Frame, globals: &[(String, Type)]) {
        if globals.is_empty() {
            return;
        }
        self.put("VAR_EXTERNAL\n");
        for (name, ty) in globals {
            self.declaration(name, *ty, false);
            frame.add(name, *ty, true, false);
        }
        self.put("END_VAR\n");
    }

    /// A temporary variable, constants, addresses.
    fn program_rest(&mut self, frame: &mut Frame) {
        if self.rng.one_in(3) {
            self.put("VAR_TEMP\n");
            let ty = self.types.any(self.rng);
            self.declaration("t0", ty, true);
            self.put("END_VAR\n");
            frame.add("t0", ty, true, false);
        }
        if self.rng.one_in(3) {
            self.put("VAR CONSTANT\n");
            for index in 0..2 {
                let ty = self.types.value(self.rng);
                let (name, value) = (format!("k{index}"), self.literal(ty));
                let written = self.types.written(ty);
                self.put(&format!("  {name} : {written} := {value};\n"));
                self.constants.push((name, ty));
            }
            self.put("END_VAR\n");
        }
        if self.rng.one_in(3) {
            for (name, ty, write) in DIRECT {
                frame.add(name, Type::Elementary(ty), write, false);
            }
        }
    }

    fn configuration(&mut self, globals: &[(String, Type)]) {
        self.put("CONFIGURATION Plant\nVAR_GLOBAL\n");
        for (name, ty) in globals {
            self.declaration(name, *ty, true);
        }
        self.put("END_VAR\nRESOURCE Cell ON processor\n");
        for task in ["fast", "slow"] {
            let interval = self.rng.pick(&["T#1ms", "T#5ms", "T#10ms", "T#100ms"]);
            let priority = self.rng.below(3);
            self.put(&format!(
                "TASK {task}(INTERVAL := {interval}, PRIORITY := {priority});\n"
            ));
        }
        self.put("PROGRAM one WITH fast : Main(a := %IW10, b := %IX8.0);\n");
        let with = self.rng.pick(&[" WITH slow", " WITH fast", ""]);
        self.put(&format!("PROGRAM two{with} : Other(b := %IX8.1);\n"));
        self.put("END_RESOURCE\nEND_CONFIGURATION\n");
    }
}
