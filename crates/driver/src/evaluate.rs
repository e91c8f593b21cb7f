//! Constants that are computed: the code runs once on the reference interpreter, as it would in a scan.

use iecc_interp::Interpreter;
use iecc_ir::{Image, Layout, Region, verify};
use iecc_lower::{Options, lower, state_place};
use iecc_sema::hir::{Place, Program};
use iecc_sema::st::Evaluator;
use iecc_target::{Engine, region_bytes};

/// Instructions and jumps that a constant may take; the functions of the library take far less.
const FUEL: u64 = 10_000_000;

/// Computes constants.
#[derive(Debug, Clone, Copy)]
pub struct Constants;

impl Evaluator for Constants {
    fn run(&self, program: &Program, places: &[Place]) -> Result<Vec<u64>, String> {
        let module = lower(program, &Options::default());
        let verified = match verify(&module) {
            Ok(verified) => verified,
            Err(errors) => panic!("lowering broke the rules of the IR: {}", errors[0]),
        };
        let mut interpreter = Interpreter::new(verified).with_fuel(FUEL);
        let inputs = region_bytes(&module, Region::Input);
        let mut outputs = region_bytes(&module, Region::Output);
        interpreter
            .step(0, &inputs, &mut outputs)
            .map_err(|fault| fault.to_string())?;
        let state = Image::from_bytes(interpreter.state().to_vec());
        let layout = Layout::new(&module.types);
        let value = |place| {
            let place = state_place(place);
            state.get_place(&layout, &module.types, module.state, &place)
        };
        Ok(places.iter().map(|place| value(place).bits).collect())
    }
}
