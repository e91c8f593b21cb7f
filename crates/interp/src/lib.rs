//! The reference interpreter: the definition of what a program means.
//!
//! Other engines are right when they give the same outputs, state and faults, bit for bit. So this
//! one is written to be read: it walks the instructions of the module as they stand, with one match
//! arm per instruction ([`machine`]), and takes the meaning of every value operation from
//! [`iecc_ir::eval`]. Only places are prepared, into byte offsets ([`route`]).
//!
//! * A scan is transactional: after a fault state and outputs are as before it, and the next
//!   `step` instruction still counts from the last scan that ended well.
//! * A scan ends: each block costs *fuel*, and running out of it is the fault `bound`.
//! * Calls use a stack of frames of our own, and locals one of bytes; the acyclic call graph bounds
//!   their depth.

mod cost;
mod machine;
mod memory;
mod route;

use cost::{Costs, worst_case_cost};
use iecc_ir::{FuncId, Function, Image, Layout, Module, Region, Terminator, Verified};
use iecc_target::{Engine, Fault, region_bytes};
use machine::{Machine, Scan};
use memory::Memory;
use route::Routes;

/// Fuel of a scan unless said otherwise: instructions and jumps. Some seconds of endless loop.
pub const DEFAULT_FUEL: u64 = 100_000_000;

/// Executes scans of one module.
#[derive(Debug)]
pub struct Interpreter {
    module: Module,
    routes: Routes,
    costs: Costs,
    state: Vec<u8>,
    output_len: usize,
    input_len: usize,
    last_ns: Option<u64>,
    fuel: u64,
    worst_case_cost: u64,
    has_faults: bool,
    /// State and outputs before the scan, kept only when it may fail.
    saved: (Vec<u8>, Vec<u8>),
}

impl Interpreter {
    /// An interpreter in the initial state of the module's image.
    pub fn new(module: Verified<'_>) -> Self {
        let costs = Costs::new(&module);
        Self {
            routes: Routes::new(&module),
            state: module.image.bytes().to_vec(),
            output_len: region_bytes(&module, Region::Output).len(),
            input_len: region_bytes(&module, Region::Input).len(),
            last_ns: None,
            fuel: DEFAULT_FUEL,
            worst_case_cost: worst_case_cost(&module, &costs),
            costs,
            has_faults: has_faults(&module),
            saved: (Vec::new(), Vec::new()),
            module: Module::clone(&module),
        }
    }

    /// Gives every scan this much fuel.
    #[must_use]
    pub fn with_fuel(mut self, fuel: u64) -> Self {
        self.fuel = fuel;
        self
    }

    /// The module it executes.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// The bytes of the state region.
    pub fn state(&self) -> &[u8] {
        &self.state
    }

    /// Replaces the bytes of the state region.
    ///
    /// # Panics
    /// If the length is not that of the region.
    pub fn set_state(&mut self, state: &[u8]) {
        self.state.copy_from_slice(state);
    }

    fn run(
        &mut self,
        entry: FuncId,
        now_ns: u64,
        inputs: &[u8],
        outputs: &mut [u8],
    ) -> Result<(), Fault> {
        let scan = Scan {
            module: &self.module,
            routes: &self.routes,
            costs: &self.costs,
            now_ns,
            last_ns: self.last_ns,
        };
        let memory = Memory {
            state: &mut self.state,
            inputs,
            outputs,
            locals: Vec::new(),
        };
        Machine::new(scan, memory, self.fuel, entry).run()
    }

    fn may_fail(&self) -> bool {
        self.has_faults || self.worst_case_cost > self.fuel
    }
}

impl Engine for Interpreter {
    fn step(&mut self, now_ns: u64, inputs: &[u8], outputs: &mut [u8]) -> Result<(), Fault> {
        assert_eq!(inputs.len(), self.input_len, "size of the input region");
        assert_eq!(outputs.len(), self.output_len, "size of the output region");
        let may_fail = self.may_fail();
        if may_fail {
            self.saved.0.clone_from(&self.state);
            self.saved.1.clear();
            self.saved.1.extend_from_slice(outputs);
        }
        let result = self.run(self.module.scan, now_ns, inputs, outputs);
        match result {
            Ok(()) => self.last_ns = Some(now_ns),
            Err(_) => {
                assert!(may_fail, "a scan that cannot fail failed");
                self.state.copy_from_slice(&self.saved.0);
                outputs.copy_from_slice(&self.saved.1);
            }
        }
        result
    }
}

/// Runs `prescan` once over the image of the module, with all inputs 0 and `now` 0. A module
/// without one keeps its image. What it writes to outputs is dropped.
///
/// # Errors
/// The fault that ended it.
pub fn run_prescan(module: Verified<'_>) -> Result<Image, Fault> {
    let prescan = module
        .prescan
        .filter(|id| does_something(&module.funcs[*id]));
    let image = match prescan {
        Some(prescan) => {
            let mut interpreter = Interpreter::new(module);
            let inputs = region_bytes(&module, Region::Input);
            let mut outputs = region_bytes(&module, Region::Output);
            interpreter.run(prescan, 0, &inputs, &mut outputs)?;
            Image::from_bytes(interpreter.state)
        }
        None => module.image.clone(),
    };
    if module.has_addresses() {
        let layout = Layout::new(&module.types);
        return Ok(image.tidied(&layout, &module.types, module.state));
    }
    Ok(image)
}

/// Whether there is more in a function than a return.
fn does_something(func: &Function) -> bool {
    let entry = func.block(func.entry());
    let returns = matches!(entry.terminator, Some(Terminator::Return(_)));
    !(entry.insts.is_empty() && returns)
}

fn has_faults(module: &Module) -> bool {
    module.funcs.values().any(|func| {
        func.layout
            .iter()
            .any(|&block| matches!(func.terminator(block), Terminator::Fault(_)))
    })
}
