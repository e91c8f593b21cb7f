//! Ends of blocks, the budget, and the way out of a scan that is abandoned.

use super::{Translator, clif_type};
use crate::context::ScanContext;
use crate::plan::Entry;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{self as clif, BlockArg, InstBuilder, types};
use cranelift_frontend::Switch;
use iecc_ir::{Block, FaultCode, Origin, Target, Terminator, Type, Value};

impl Translator<'_, '_> {
    pub(super) fn terminator(&mut self, block: Block) {
        let (func, facts) = (self.func, self.facts);
        let origin = func.block(block).terminator_origin;
        self.write_all();
        for entry in facts.entries.get(&block).into_iter().flatten() {
            self.pay_for_rounds(entry, origin);
        }
        if let Some(&payment) = facts.payments.get(&block) {
            self.pay(payment, origin);
        }
        match func.terminator(block) {
            Terminator::Jump(target) => {
                let (to, args) = self.target(target);
                self.ins().jump(to, &args);
            }
            Terminator::Brif {
                cond,
                then,
                otherwise,
            } => self.brif(*cond, then, otherwise),
            Terminator::Switch {
                value,
                cases,
                default,
            } => self.switch(*value, cases, default),
            Terminator::Return(values) => self.ret(values),
            Terminator::Fault(code) => self.fault(*code, origin),
        }
    }

    fn target(&mut self, target: &Target) -> (clif::Block, Vec<BlockArg>) {
        let params = &self.func.block(target.block).params;
        let args = params.iter().zip(&target.args);
        let args = args.map(|(&param, &arg)| self.as_class(self.nan[param], arg).into());
        let args = args.collect();
        (self.block(target.block), args)
    }

    fn brif(&mut self, cond: Value, then: &Target, otherwise: &Target) {
        let cond = self.value(cond);
        let (then, then_args) = self.target(then);
        let (otherwise, otherwise_args) = self.target(otherwise);
        self.ins()
            .brif(cond, then, &then_args, otherwise, &otherwise_args);
    }

    fn switch(&mut self, value: Value, cases: &[(u64, Target)], default: &Target) {
        let value = self.value(value);
        let mut switch = Switch::new();
        let mut landings = Vec::new();
        for (bits, target) in cases {
            let landing = self.landing(target, &mut landings);
            switch.set_entry(u128::from(*bits), landing);
        }
        let default = self.landing(default, &mut landings);
        switch.emit(&mut self.builder, value, default);
        for (landing, to, args) in landings {
            self.builder.switch_to_block(landing);
            self.ins().jump(to, &args);
        }
    }

    /// Jump tables pass no arguments: targets that take some get a block that adds them.
    fn landing(
        &mut self,
        target: &Target,
        landings: &mut Vec<(clif::Block, clif::Block, Vec<BlockArg>)>,
    ) -> clif::Block {
        let (to, args) = self.target(target);
        if args.is_empty() {
            return to;
        }
        let landing = self.new_block();
        landings.push((landing, to, args));
        landing
    }

    fn ret(&mut self, values: &[Value]) {
        self.save_budget();
        let mut returned = Vec::with_capacity(values.len() + 1);
        if self.program.returns_status(self.id) {
            returned.push(self.ins().iconst(types::I32, 0));
        }
        returned.extend(values.iter().map(|&v| self.exact(v)));
        self.ins().return_(&returned);
    }

    fn fault(&mut self, code: FaultCode, origin: Option<Origin>) {
        let number = origin.map_or(0, |origin| origin.as_u32() + 1);
        let number = self.ins().iconst(types::I32, i64::from(number));
        let (flags, context) = (self.flags(self.regions.context), self.context);
        self.ins()
            .store(flags, number, context, ScanContext::FAULT_ORIGIN);
        let status = self.ins().iconst(types::I32, i64::from(code.number()));
        let exit = self.fault_exit();
        self.ins().jump(exit, &[status.into()]);
    }

    /// Leaves the function if a callee returned a fault; goes on in a new block otherwise.
    pub(super) fn leave_on_fault(&mut self, status: clif::Value) {
        let exit = self.fault_exit();
        let next = self.new_block();
        self.ins().brif(status, exit, &[status.into()], next, &[]);
        self.builder.switch_to_block(next);
    }

    fn fault_exit(&mut self) -> clif::Block {
        if let Some(exit) = self.fault_exit {
            return exit;
        }
        let exit = self.builder.create_block();
        self.builder.set_cold_block(exit);
        self.fault_exit = Some(exit);
        self.builder.append_block_param(exit, types::I32);
        exit
    }

    /// Fills the exit, after all other blocks.
    pub(super) fn finish_fault_exit(&mut self) {
        let Some(exit) = self.fault_exit else { return };
        self.builder.switch_to_block(exit);
        let mut returned = vec![self.builder.block_params(exit)[0]];
        for &ty in &self.func.results {
            returned.push(self.constant(ty, 0));
        }
        self.ins().return_(&returned);
    }

    /// Takes the budget as the caller or a callee left it.
    pub(super) fn reload_budget(&mut self) {
        if self.facts.metered {
            let (flags, context) = (self.flags(self.regions.context), self.context);
            let budget = self
                .ins()
                .load(types::I64, flags, context, ScanContext::BUDGET);
            self.builder.def_var(self.budget, budget);
        }
    }

    /// Hands the budget to the caller or a callee.
    pub(super) fn save_budget(&mut self) {
        if self.facts.metered {
            let budget = self.builder.use_var(self.budget);
            let (flags, context) = (self.flags(self.regions.context), self.context);
            self.ins()
                .store(flags, budget, context, ScanContext::BUDGET);
        }
    }

    /// Takes `work` from the budget and abandons the scan when it is used up.
    pub(super) fn pay(&mut self, work: u64, origin: Option<Origin>) {
        let work = i64::try_from(work).unwrap_or(i64::MAX);
        let price = self.ins().iconst(types::I64, work);
        self.pay_price(price, origin);
    }

    /// Pays for the rounds of a loop ahead. A shift takes the place of a division by the step: it gives as many
    /// rounds or up to twice as many.
    fn pay_for_rounds(&mut self, entry: &Entry, origin: Option<Origin>) {
        let counted = entry.counted;
        let [first, limit] = [entry.first, counted.limit].map(|value| self.wide(value));
        let distance = match counted.grows {
            true => self.ins().isub(limit, first),
            false => self.ins().isub(first, limit),
        };
        let excluded = i64::from(counted.excludes_limit);
        let distance = self.ins().iadd_imm_s(distance, -excluded);
        let firsts = i64::from(counted.counts_first);
        let none = self.ins().iconst(types::I64, -firsts);
        let distance = self.ins().smax(distance, none);
        let step = self.wide(counted.step);
        let step = self.ins().iabs(step);
        let zeros = self.ins().clz(step);
        let top = self.ins().iconst(types::I64, 63);
        let shift = self.ins().isub(top, zeros);
        let rounds = self.ins().sshr(distance, shift);
        let rounds = self.ins().iadd_imm_s(rounds, firsts);
        let work = i64::try_from(entry.work).unwrap_or(i64::MAX);
        let price = self.ins().imul_imm_s(rounds, work);
        self.pay_price(price, origin);
    }

    /// A number of a counter, which is known before its loop.
    fn wide(&mut self, value: Value) -> clif::Value {
        let ty = self.func.value_type(value);
        match self.func.constant(value) {
            Some(bits) => self.ins().iconst(types::I64, ty.signed(bits)),
            None => {
                let number = self.value(value);
                self.extend(number, ty, Type::I64, true)
            }
        }
    }

    fn pay_price(&mut self, price: clif::Value, origin: Option<Origin>) {
        let budget = self.builder.use_var(self.budget);
        let left = self.ins().isub(budget, price);
        self.builder.def_var(self.budget, left);
        let broke = self.ins().icmp(IntCC::SignedLessThan, budget, price);
        let (stop, next) = (self.new_block(), self.new_block());
        self.builder.set_cold_block(stop);
        self.ins().brif(broke, stop, &[], next, &[]);
        self.builder.switch_to_block(stop);
        self.fault(FaultCode::Bound, origin);
        self.builder.switch_to_block(next);
    }

    /// A constant of the IR.
    pub(super) fn constant(&mut self, ty: Type, bits: u64) -> clif::Value {
        match ty {
            Type::I1 | Type::I8 | Type::I16 | Type::I32 | Type::I64 => {
                self.ins().iconst(clif_type(ty), bits as i64)
            }
            Type::F32 => {
                let number = clif::immediates::Ieee32::with_bits(bits as u32);
                self.ins().f32const(number)
            }
            Type::F64 => {
                let number = clif::immediates::Ieee64::with_bits(bits);
                self.ins().f64const(number)
            }
        }
    }
}
