//! The engines a case runs on, in families that the statement has a column for.

use iecc_driver::EngineKind;

/// Engines that share the way a program is executed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// The reference interpreter, on the program before and after passes.
    Interp,
    /// Machine code of this computer.
    Jit,
    /// Simulated hardware.
    Verilog,
}

impl Family {
    /// All of them, in the order of the statement.
    pub const ALL: [Self; 3] = [Self::Interp, Self::Jit, Self::Verilog];

    /// Its name in cases.
    pub fn name(self) -> &'static str {
        match self {
            Self::Interp => "interp",
            Self::Jit => "jit",
            Self::Verilog => "verilog",
        }
    }

    /// The family of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|family| family.name() == name)
    }

    /// The family of an engine.
    pub fn of(engine: EngineKind) -> Self {
        match engine {
            EngineKind::Interp | EngineKind::InterpSoftware | EngineKind::InterpHardware => {
                Self::Interp
            }
            EngineKind::JitPlain | EngineKind::Jit => Self::Jit,
            EngineKind::Verilog => Self::Verilog,
        }
    }
}
