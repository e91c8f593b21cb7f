//! What a back end provides and what an engine does.
//!
//! A [`Target`] turns a verified module into [`Artifact`]s or refuses with reasons that name where
//! in the program they arise; it never panics on a verified module and never decides meaning. An
//! [`Engine`] executes scans: the interpreter, the JIT, a simulator.

use iecc_ir::{FaultCode, Layout, MemType, Module, Origin, Region, Verified};
use std::fmt;

/// A file a back end made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Artifact {
    /// File name, with folders below the output folder separated by `/`.
    pub name: String,
    /// Contents.
    pub bytes: Vec<u8>,
}

impl Artifact {
    /// A text file.
    pub fn text(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            bytes: text.into().into_bytes(),
        }
    }
}

/// Why a target cannot express a program. The driver gives each a diagnostic code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Refusal {
    /// The scan contains a loop.
    Loop,
    /// Division or remainder by something that is no usable constant.
    Division,
    /// Floating-point numbers.
    Float,
    /// A place whose index is not constant.
    DynamicPlace,
    /// A reference that is a value.
    Reference,
    /// A fault that could end a scan.
    Fault,
    /// The absolute time of a scan.
    AbsoluteTime,
    /// A value or region too large for the target.
    Size,
    /// An option that does not fit the program or the board.
    Option,
}

/// A refusal with its place and words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TargetError {
    /// What cannot be expressed.
    pub refusal: Refusal,
    /// Where in the program.
    pub origin: Option<Origin>,
    /// What is there and what the target can do instead.
    pub message: String,
}

/// A back end. `Options` are the switches that belong to it.
pub trait Target {
    /// Its switches.
    type Options;

    /// Turns a module into files.
    ///
    /// # Errors
    /// All reasons why the program cannot be expressed.
    fn compile(
        &self,
        module: Verified<'_>,
        options: &Self::Options,
    ) -> Result<Vec<Artifact>, Vec<TargetError>>;
}

/// A scan that was abandoned. State and outputs are as before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fault {
    /// Why.
    pub code: FaultCode,
    /// Where, if the engine knows.
    pub origin: Option<Origin>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.code.meaning())
    }
}

/// Executes scans of one program.
pub trait Engine {
    /// Runs one scan at `now_ns` (not before the scan before it), reading the input region and
    /// writing the output region, both in the byte layout of the module.
    ///
    /// # Errors
    /// The fault that abandoned the scan; state and outputs are as before.
    fn step(&mut self, now_ns: u64, inputs: &[u8], outputs: &mut [u8]) -> Result<(), Fault>;
}

/// A zeroed buffer of the size of a region.
pub fn region_bytes(module: &Module, region: Region) -> Vec<u8> {
    let layout = Layout::new(&module.types);
    let size = layout.size(&module.types, MemType::Struct(module.region(region)));
    vec![0; usize::try_from(size).expect("verified regions are bounded")]
}
