//! Runs programs on this computer as machine code, made by Cranelift.
//!
//! A [`Jit`] does what the interpreter does, bit for bit: same outputs, same state, same faults, on
//! the same byte layout. One exception is by design: how much work a scan may do before it ends
//! with the fault `bound` is counted in larger steps, and the default budget is larger.
//!
//! * `plan` finds out which functions the scan needs and which of them can abandon it.
//! * `translate` turns each into Cranelift's IR.
//! * `compile` makes machine code of it, and refuses programs that are too large.
//! * `code` owns the machine code and enters it.
//!
//! This is the only crate with `unsafe`: in `code`, where each use has its argument.
#![expect(unsafe_code, reason = "machine code is entered through a pointer")]

mod code;
mod compile;
mod context;
mod plan;
mod translate;

use code::Code;
use context::ScanContext;
use iecc_ir::{FaultCode, Layout, Origin, Region, Verified};
use iecc_target::{Engine, Fault, TargetError, region_bytes};
use plan::Plan;

/// Work of a scan unless said otherwise, in instructions of the IR: some seconds of endless loop.
pub const DEFAULT_BUDGET: u64 = 1 << 32;

/// Executes scans of one module as machine code.
#[derive(Debug)]
pub struct Jit {
    code: Code,
    /// The region, and behind it what references that are absent may read.
    state: Vec<u8>,
    state_len: usize,
    locals: Vec<u8>,
    input_len: usize,
    output_len: usize,
    last_ns: Option<u64>,
    budget: i64,
    can_fault: bool,
    /// State and outputs before the scan, kept only when it can fail.
    saved: (Vec<u8>, Vec<u8>),
}

impl Jit {
    /// Compiles a module; the state is that of its image.
    ///
    /// # Errors
    /// The program is too large for machine code, or this computer has none.
    pub fn new(module: Verified<'_>) -> Result<Self, Vec<TargetError>> {
        let layout = Layout::new(&module.types);
        let plan = Plan::new(&module, &layout);
        let mut state = module.image.bytes().to_vec();
        state.resize(plan.state_bytes as usize, 0);
        Ok(Self {
            code: compile::compile(&module, &layout, &plan)?,
            state,
            state_len: module.image.bytes().len(),
            locals: vec![0; plan.local_bytes as usize],
            input_len: region_bytes(&module, Region::Input).len(),
            output_len: region_bytes(&module, Region::Output).len(),
            last_ns: None,
            budget: DEFAULT_BUDGET as i64,
            can_fault: plan.facts(module.scan).can_fault,
            saved: (Vec::new(), Vec::new()),
        })
    }

    /// Allows every scan about this many instructions; more than `i64::MAX` count as that.
    #[must_use]
    pub fn with_budget(mut self, instructions: u64) -> Self {
        self.budget = i64::try_from(instructions).unwrap_or(i64::MAX);
        self
    }

    /// The bytes of the state region.
    pub fn state(&self) -> &[u8] {
        &self.state[..self.state_len]
    }

    /// Replaces the bytes of the state region.
    ///
    /// # Panics
    /// If the length is not that of the region.
    pub fn set_state(&mut self, state: &[u8]) {
        self.state[..self.state_len].copy_from_slice(state);
    }

    fn save(&mut self, outputs: &[u8]) {
        self.saved.0.clone_from(&self.state);
        self.saved.1.clear();
        self.saved.1.extend_from_slice(outputs);
    }

    fn restore(&mut self, outputs: &mut [u8]) {
        self.state.copy_from_slice(&self.saved.0);
        outputs.copy_from_slice(&self.saved.1);
    }
}

impl Engine for Jit {
    fn step(&mut self, now_ns: u64, inputs: &[u8], outputs: &mut [u8]) -> Result<(), Fault> {
        assert_eq!(inputs.len(), self.input_len, "size of the input region");
        assert_eq!(outputs.len(), self.output_len, "size of the output region");
        if self.can_fault {
            self.save(outputs);
        }
        let mut context = ScanContext {
            inputs: inputs.as_ptr(),
            outputs: outputs.as_mut_ptr(),
            locals: self.locals.as_mut_ptr(),
            now_ns,
            previous_ns: self.last_ns.unwrap_or(now_ns),
            budget: self.budget,
            fault_origin: 0,
        };
        match self.code.run(&mut context, &mut self.state) {
            0 => {
                self.last_ns = Some(now_ns);
                Ok(())
            }
            status => {
                self.restore(outputs);
                Err(fault(status, context.fault_origin))
            }
        }
    }
}

fn fault(status: u32, origin: u32) -> Fault {
    let code = u8::try_from(status).ok().and_then(FaultCode::from_number);
    Fault {
        code: code.expect("machine code returns numbers of faults"),
        origin: origin.checked_sub(1).map(Origin::from_u32),
    }
}
