//! The function that the outside calls for a scan: `(block, inputs, outputs, now) -> fault`.
//!
//! It fills the context, keeps what the scan may change if a fault can abandon it, runs the scan, and
//! then either notes the time or brings back what was kept. The result is 0 or the number of the fault.

use crate::block::Block;
use crate::compile::Compiled;
use crate::context::ScanContext;
use crate::isa::has_vectors;
use crate::writes::Target;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{
    self as clif, AbiParam, InstBuilder, MemFlagsData, StackSlotData, StackSlotKind, types,
};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::Module as MachineModule;

/// Bytes that are copied without a loop.
const UNROLLED_BYTES: u64 = 128;

/// Bytes that a round of a loop copies.
const ROUND_BYTES: u64 = 64;

/// Sets the signature of the entry.
pub(crate) fn signature(signature: &mut clif::Signature, pointer: clif::Type) {
    let params = [pointer, pointer, pointer, types::I64];
    signature.params = params.map(AbiParam::new).to_vec();
    signature.returns = vec![AbiParam::new(types::I32)];
}

/// Fills `target`, whose signature is set, with the code of the entry.
pub(crate) fn build(
    unit: &mut dyn MachineModule,
    compiled: &Compiled,
    target: &mut clif::Function,
    frontend: &mut FunctionBuilderContext,
) {
    let config = unit.target_config();
    let has_vectors = has_vectors(unit.isa());
    let scan = unit.declare_func_in_func(compiled.scan, target);
    let mut builder = FunctionBuilder::new(target, frontend);
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    let [block, inputs, outputs, now] = *builder.block_params(entry) else {
        panic!("the entry has four parameters")
    };
    let entry = Entry {
        builder,
        layout: &compiled.block,
        pointer: config.pointer_type(),
        widest: if has_vectors {
            types::I8X16
        } else {
            types::I64
        },
        block,
        outputs,
    };
    entry.fill(inputs, now, scan, config);
}

struct Entry<'e> {
    builder: FunctionBuilder<'e>,
    layout: &'e Block,
    pointer: clif::Type,
    /// What moves most bytes at once.
    widest: clif::Type,
    block: clif::Value,
    outputs: clif::Value,
}

impl Entry<'_> {
    fn fill(
        mut self,
        inputs: clif::Value,
        now: clif::Value,
        scan: clif::FuncRef,
        config: cranelift_codegen::isa::TargetFrontendConfig,
    ) {
        let context = self.context(inputs, now);
        self.copy_saved(true);
        let state = self.offset(self.block, Block::STATE as u64);
        let call = self.builder.ins().call(scan, &[context, state]);
        let status = self.builder.inst_results(call)[0];
        let (done, failed) = (self.builder.create_block(), self.builder.create_block());
        self.builder.set_cold_block(failed);
        self.builder.ins().brif(status, failed, &[], done, &[]);
        self.builder.switch_to_block(done);
        self.store(now, self.block, Block::LAST_NS);
        let started = self.builder.ins().iconst(types::I32, 1);
        self.store(started, self.block, Block::STARTED);
        self.builder.ins().return_(&[status]);
        self.builder.switch_to_block(failed);
        self.copy_saved(false);
        let origin = self.load(types::I32, context, ScanContext::FAULT_ORIGIN);
        self.store(origin, self.block, Block::FAULT_ORIGIN);
        self.builder.ins().return_(&[status]);
        self.builder.seal_all_blocks();
        self.builder.finalize(config);
    }

    fn context(&mut self, inputs: clif::Value, now: clif::Value) -> clif::Value {
        let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, ScanContext::BYTES, 3);
        let slot = self.builder.create_sized_stack_slot(slot);
        let context = self.builder.ins().stack_addr(self.pointer, slot, 0);
        let started = self.load(types::I32, self.block, Block::STARTED);
        let last = self.load(types::I64, self.block, Block::LAST_NS);
        let previous = self.builder.ins().select(started, last, now);
        let budget = self.load(types::I64, self.block, Block::WORK_LIMIT);
        let locals = self.offset(self.block, self.layout.locals_at() as u64);
        let nowhere = self.builder.ins().iconst(types::I32, 0);
        for (value, offset) in [
            (inputs, ScanContext::INPUTS),
            (self.outputs, ScanContext::OUTPUTS),
            (locals, ScanContext::LOCALS),
            (now, ScanContext::NOW_NS),
            (previous, ScanContext::PREVIOUS_NS),
            (budget, ScanContext::BUDGET),
            (nowhere, ScanContext::FAULT_ORIGIN),
        ] {
            self.store(value, context, offset);
        }
        context
    }

    /// Keeps what the scan may change, or brings it back.
    fn copy_saved(&mut self, keep: bool) {
        let mut saved = self.layout.saved_at() as u64;
        for span in self.layout.saved.clone() {
            let (base, start) = match span.target {
                Target::State => (self.block, Block::STATE as u64),
                Target::Output => (self.outputs, 0),
            };
            let live = self.offset(base, start + span.offset);
            let kept = self.offset(self.block, saved);
            let (from, to) = if keep { (live, kept) } else { (kept, live) };
            self.copy(from, to, span.len);
            saved += span.len;
        }
    }

    /// Copies bytes between places that do not overlap.
    fn copy(&mut self, from: clif::Value, to: clif::Value, len: u64) {
        let looped = if len > UNROLLED_BYTES {
            len / ROUND_BYTES * ROUND_BYTES
        } else {
            0
        };
        if looped > 0 {
            self.copy_loop(from, to, looped);
        }
        let mut at = looped;
        for ty in [self.widest, types::I64, types::I32, types::I16, types::I8] {
            let width = u64::from(ty.bytes());
            while len - at >= width {
                self.move_one(ty, from, to, at as i32);
                at += width;
            }
        }
    }

    fn copy_loop(&mut self, from: clif::Value, to: clif::Value, len: u64) {
        let (body, next) = (self.builder.create_block(), self.builder.create_block());
        let at = self.builder.append_block_param(body, self.pointer);
        let zero = self.builder.ins().iconst(self.pointer, 0);
        self.builder.ins().jump(body, &[zero.into()]);
        self.builder.switch_to_block(body);
        let source = self.builder.ins().iadd(from, at);
        let target = self.builder.ins().iadd(to, at);
        let width = self.widest.bytes();
        for part in (0..ROUND_BYTES as u32).step_by(width as usize) {
            self.move_one(self.widest, source, target, part as i32);
        }
        let after = self.offset(at, ROUND_BYTES);
        let end = self.builder.ins().iconst(self.pointer, len as i64);
        let more = self.builder.ins().icmp(IntCC::UnsignedLessThan, after, end);
        self.builder
            .ins()
            .brif(more, body, &[after.into()], next, &[]);
        self.builder.switch_to_block(next);
    }

    fn move_one(&mut self, ty: clif::Type, from: clif::Value, to: clif::Value, offset: i32) {
        let value = self.load(ty, from, offset);
        self.store(value, to, offset);
    }

    fn offset(&mut self, base: clif::Value, bytes: u64) -> clif::Value {
        self.builder.ins().iadd_imm_s(base, bytes as i64)
    }

    fn load(&mut self, ty: clif::Type, base: clif::Value, offset: i32) -> clif::Value {
        let flags = MemFlagsData::new().with_notrap();
        self.builder.ins().load(ty, flags, base, offset)
    }

    fn store(&mut self, value: clif::Value, base: clif::Value, offset: i32) {
        let flags = MemFlagsData::new().with_notrap();
        self.builder.ins().store(flags, value, base, offset);
    }
}
