//! Runs programs on this computer as machine code, made by Cranelift.
//!
//! A [`Jit`] does what the interpreter does, bit for bit: same outputs, same state, same faults, on
//! the same byte layout. One exception is by design: how much work a scan may do before it ends
//! with the fault `bound` is counted in larger steps, and the default budget is larger.
//!
//! * `plan` finds out which functions the scan needs and which of them can abandon it, `writes` what
//!   they change.
//! * `aside` finds out which blocks are better out of the way.
//! * `nan` finds out where the bits of a NaN matter.
//! * `translate` turns each into Cranelift's IR.
//! * `compile` makes machine code of it, and refuses programs that are too large.
//! * `entry` is what the outside calls, with the memory that `block` describes.
//! * `code` owns machine code that runs here, and enters it.
//! * `object` writes it to a file for a linker, with a header for C.
//!
//! This is the only crate with `unsafe`: in `code`, where each use has its argument.
#![expect(unsafe_code, reason = "machine code is entered through a pointer")]

mod aside;
mod block;
mod code;
mod compile;
mod context;
mod entry;
mod isa;
mod nan;
mod object;
mod plan;
mod translate;
mod writes;

pub use isa::Cpu;
pub use object::{Object, ObjectOptions};

use block::Block;
use code::Code;
use iecc_ir::{FaultCode, Origin, Region, Verified};
use iecc_target::{Engine, Fault, TargetError, region_bytes};

/// Work of a scan unless said otherwise, in instructions of the IR: some seconds of endless loop.
pub const DEFAULT_BUDGET: u64 = 1 << 32;

/// Executes scans of one module as machine code.
#[derive(Debug)]
pub struct Jit {
    code: Code,
    layout: Block,
    /// The controller.
    block: Vec<u8>,
    input_len: usize,
    output_len: usize,
}

impl Jit {
    /// Compiles a module; the state is that of its image.
    ///
    /// # Errors
    /// The program is too large for machine code, or this computer has none.
    pub fn new(module: Verified<'_>) -> Result<Self, Vec<TargetError>> {
        let (code, layout) = code::load(&module)?;
        Ok(Self {
            code,
            block: layout.initial(&module.image, DEFAULT_BUDGET as i64),
            layout,
            input_len: region_bytes(&module, Region::Input).len(),
            output_len: region_bytes(&module, Region::Output).len(),
        })
    }

    /// Allows every scan about this many instructions; more than `i64::MAX` count as that.
    #[must_use]
    pub fn with_budget(mut self, instructions: u64) -> Self {
        let limit = i64::try_from(instructions).unwrap_or(i64::MAX);
        self.block[Block::WORK_LIMIT as usize..][..8].copy_from_slice(&limit.to_ne_bytes());
        self
    }

    /// The bytes of the state region.
    pub fn state(&self) -> &[u8] {
        &self.block[Block::STATE..][..self.layout.state_len]
    }

    /// Replaces the bytes of the state region.
    ///
    /// # Panics
    /// If the length is not that of the region.
    pub fn set_state(&mut self, state: &[u8]) {
        self.block[Block::STATE..][..self.layout.state_len].copy_from_slice(state);
    }

    fn fault(&self, status: u32) -> Fault {
        let code = u8::try_from(status).ok().and_then(FaultCode::from_number);
        let origin = self.block[Block::FAULT_ORIGIN as usize..][..4].try_into();
        let origin = u32::from_ne_bytes(origin.expect("four bytes"));
        Fault {
            code: code.expect("machine code returns numbers of faults"),
            origin: origin.checked_sub(1).map(Origin::from_u32),
        }
    }
}

impl Engine for Jit {
    fn step(&mut self, now_ns: u64, inputs: &[u8], outputs: &mut [u8]) -> Result<(), Fault> {
        assert_eq!(inputs.len(), self.input_len, "size of the input region");
        assert_eq!(outputs.len(), self.output_len, "size of the output region");
        match self.code.run(&mut self.block, inputs, outputs, now_ns) {
            0 => Ok(()),
            status => Err(self.fault(status)),
        }
    }
}
