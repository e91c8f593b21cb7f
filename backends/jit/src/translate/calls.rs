//! Calls between the functions of a program.

use super::Translator;
use cranelift_codegen::ir::{self as clif, InstBuilder};
use iecc_ir::{FuncId, Inst, Place, Value};

impl Translator<'_, '_> {
    pub(super) fn call(&mut self, inst: Inst, callee: FuncId, refs: &[Place], args: &[Value]) {
        let mut passed = vec![self.context, self.state];
        for place in refs {
            let address = self.address(place);
            passed.push(self.pointer_to(&address));
        }
        passed.extend(args.iter().map(|&v| self.exact(v)));
        let metered = self.program.plan.facts(callee).metered;
        if metered {
            self.save_budget();
        }
        let target = self.callee(callee);
        let call = self.ins().call(target, &passed);
        let mut results = self.builder.inst_results(call).to_vec();
        if self.program.returns_status(callee) {
            let status = results.remove(0);
            if self.program.plan.facts(callee).can_fault {
                self.leave_on_fault(status);
            }
        }
        if metered {
            self.reload_budget();
        }
        for (&result, value) in self.func.results_of(inst).iter().zip(results) {
            self.values[result] = Some(value);
        }
    }

    fn callee(&mut self, callee: FuncId) -> clif::FuncRef {
        if let Some(&known) = self.callees.get(&callee) {
            return known;
        }
        let id = self.program.declared[callee].expect("callees are declared");
        let declared = self.unit.declare_func_in_func(id, self.builder.func);
        self.callees.insert(callee, declared);
        declared
    }
}
