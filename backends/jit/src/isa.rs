//! The processor machine code is made for: this computer's, with what it has or with what all of its
//! kind have. Which instructions are used never changes a result.

use cranelift_codegen::isa::{OwnedTargetIsa, TargetIsa};
use cranelift_codegen::settings::{self, Configurable, Flags};
use iecc_target::{Refusal, TargetError};

/// Which instructions machine code may use.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Cpu {
    /// Those that every processor of the kind has, so that the code runs on all of them and its
    /// bytes do not depend on the computer that made it.
    #[default]
    Generic,
    /// All that this computer has.
    Native,
}

/// Code that runs where it is made, or code that a linker puts anywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    Run,
    Link,
}

/// The instruction set of this computer.
pub(crate) fn host(cpu: Cpu, purpose: Purpose) -> Result<OwnedTargetIsa, Vec<TargetError>> {
    let builder = cranelift_native::builder_with_options(cpu == Cpu::Native);
    let builder = builder.map_err(unfit)?;
    builder
        .finish(flags(purpose))
        .map_err(|error| unfit(&error.to_string()))
}

fn unfit(what: &str) -> Vec<TargetError> {
    vec![TargetError {
        refusal: Refusal::Option,
        origin: None,
        message: format!("there is no machine code for this computer: {what}"),
    }]
}

fn flags(purpose: Purpose) -> Flags {
    let word = |flag: bool| if flag { "true" } else { "false" };
    let mut flags = settings::builder();
    for (name, value) in [
        ("opt_level", "speed"),
        // A line of the cache, so that how fast a loop is does not depend on what lies before its function.
        ("log2_min_function_alignment", "6"),
        ("enable_verifier", word(cfg!(debug_assertions))),
        // Functions of the IR return as many values as they like.
        ("enable_multi_ret_implicit_sret", "true"),
        // A large frame touches every page on its way down, so that it cannot skip the guard page.
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
        ("unwind_info", "false"),
        ("is_pic", word(purpose == Purpose::Link)),
        ("use_colocated_libcalls", "false"),
    ] {
        flags.set(name, value).expect("a flag of Cranelift");
    }
    Flags::new(flags)
}

/// Whether rounding to integers is one instruction; otherwise Cranelift would call a library.
pub(crate) fn has_rounding(isa: &dyn TargetIsa) -> bool {
    let flags = isa.isa_flags();
    let sse41 = flags.iter().find(|flag| flag.name == "has_sse41");
    sse41.is_none_or(|flag| flag.as_bool() == Some(true))
}

/// Whether every processor of the kind moves 16 bytes at once.
pub(crate) fn has_vectors(isa: &dyn TargetIsa) -> bool {
    matches!(isa.name(), "x64" | "aarch64")
}
