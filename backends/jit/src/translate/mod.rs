//! One function of the IR becomes one Cranelift function.
//!
//! The signature is `(context, state, references…, parameters…) -> (status?, results…)`, where the
//! status exists if the function can abandon the scan (or is the scan itself): 0, or the number of
//! the fault, which every caller passes on at once. An `i1` is an `i8` that is 0 or 1. Blocks are
//! translated in reverse postorder, so definitions come before uses; unreachable ones are left out.

mod bulk;
mod calls;
mod constants;
mod control;
mod memory;
mod nan;
mod values;

use crate::context::ScanContext;
use crate::nan::{NanClasses, classify};
use crate::plan::{Facts, Plan};
use cranelift_codegen::ir::{
    self as clif, AbiParam, AliasRegion, AliasRegionData, InstBuilder, MemFlagsData, types,
};
use cranelift_entity::{EntityRef, PrimaryMap, SecondaryMap};
use cranelift_frontend::{FuncInstBuilder, FunctionBuilder, FunctionBuilderContext, Variable};
use cranelift_module::Module as MachineModule;
use iecc_ir::analysis::Cfg;
use iecc_ir::{
    Block, FuncId, Function, Inst, InstData, Layout, Local, Module, RefParam, Type, Value,
};
use std::collections::BTreeMap;

/// What is the same for all functions of a program.
pub(crate) struct Program<'m> {
    pub(crate) module: &'m Module,
    pub(crate) layout: &'m Layout,
    pub(crate) plan: &'m Plan,
    /// Whether rounding to integers is one instruction.
    pub(crate) has_rounding: bool,
    /// Whether every processor of the kind moves 16 bytes at once.
    pub(crate) has_vectors: bool,
    /// The declared Cranelift function of each IR function.
    pub(crate) declared: SecondaryMap<FuncId, Option<cranelift_module::FuncId>>,
}

impl Program<'_> {
    /// Whether calls of the function return a status.
    pub(crate) fn returns_status(&self, id: FuncId) -> bool {
        self.plan.facts(id).can_fault || id == self.module.scan
    }

    /// Adds the parameters and results of a function to an empty signature.
    pub(crate) fn signature(
        &self,
        id: FuncId,
        signature: &mut clif::Signature,
        pointer: clif::Type,
    ) {
        let func = &self.module.funcs[id];
        let pointers = std::iter::repeat_n(pointer, 2 + func.refs.len());
        let params = func.param_types().into_iter().map(clif_type);
        signature.params = pointers.chain(params).map(AbiParam::new).collect();
        let status = self.returns_status(id).then_some(types::I32);
        let results = func.results.iter().map(|&ty| clif_type(ty));
        signature.returns = status
            .into_iter()
            .chain(results)
            .map(AbiParam::new)
            .collect();
    }
}

/// The Cranelift type that holds values of an IR type.
pub(crate) fn clif_type(ty: Type) -> clif::Type {
    match ty {
        Type::I1 | Type::I8 => types::I8,
        Type::I16 => types::I16,
        Type::I32 => types::I32,
        Type::I64 => types::I64,
        Type::F32 => types::F32,
        Type::F64 => types::F64,
    }
}

/// Memory that never overlaps.
#[derive(Clone, Copy)]
struct AliasRegions {
    context: AliasRegion,
    state: AliasRegion,
    input: AliasRegion,
    output: AliasRegion,
    locals: AliasRegion,
}

impl AliasRegions {
    fn new(func: &mut clif::Function) -> Self {
        let mut region = |user_id, description: &'static str| {
            func.dfg.alias_regions.insert(AliasRegionData {
                user_id,
                description: description.into(),
            })
        };
        Self {
            context: region(0, "context"),
            state: region(1, "state"),
            input: region(2, "input"),
            output: region(3, "output"),
            locals: region(4, "locals"),
        }
    }
}

struct Translator<'t, 'm> {
    program: &'t Program<'m>,
    unit: &'t mut dyn MachineModule,
    id: FuncId,
    func: &'m Function,
    facts: &'t Facts,
    builder: FunctionBuilder<'t>,
    pointer: clif::Type,
    regions: AliasRegions,
    values: SecondaryMap<Value, Option<clif::Value>>,
    blocks: SecondaryMap<Block, Option<clif::Block>>,
    callees: BTreeMap<FuncId, clif::FuncRef>,
    context: clif::Value,
    state: clif::Value,
    refs: Vec<clif::Value>,
    /// Where each local lies in the memory of the activation.
    local_offsets: PrimaryMap<Local, u64>,
    /// That memory, if it is on the stack.
    local_slot: Option<clif::StackSlot>,
    /// What is left of the budget, in metered functions.
    budget: Variable,
    /// The block of the program that is being translated.
    at: Block,
    /// What NaN each value may be.
    nan: NanClasses,
    /// Floats in memory that may be the wrong NaN.
    waiting: nan::Waiting,
    /// Constants that memory does not hold yet.
    constants: Vec<constants::Constant>,
    /// Returns the status it is given; made when first needed.
    fault_exit: Option<clif::Block>,
}

/// Fills `target`, whose signature is set, with the code of a function.
pub(crate) fn translate(
    program: &Program<'_>,
    unit: &mut dyn MachineModule,
    id: FuncId,
    target: &mut clif::Function,
    frontend: &mut FunctionBuilderContext,
) {
    let config = unit.target_config();
    let regions = AliasRegions::new(target);
    let func = &program.module.funcs[id];
    let mut builder = FunctionBuilder::new(target, frontend);
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    let params = builder.block_params(entry).to_vec();
    let (refs, params) = params[2..].split_at(func.refs.len());
    let mut translator = Translator {
        program,
        id,
        func,
        facts: program.plan.facts(id),
        pointer: config.pointer_type(),
        regions,
        values: SecondaryMap::new(),
        blocks: SecondaryMap::new(),
        callees: BTreeMap::new(),
        context: builder.block_params(entry)[0],
        state: builder.block_params(entry)[1],
        refs: refs.to_vec(),
        local_offsets: program.layout.locals(&program.module.types, func).0,
        local_slot: None,
        budget: builder.declare_var(types::I64),
        at: func.entry(),
        nan: NanClasses::new(),
        waiting: nan::Waiting::default(),
        constants: Vec::new(),
        fault_exit: None,
        unit,
        builder,
    };
    translator.blocks[func.entry()] = Some(entry);
    for (&param, &value) in func.block(func.entry()).params.iter().zip(params) {
        translator.values[param] = Some(value);
    }
    translator.function();
    translator.builder.seal_all_blocks();
    translator.builder.finalize(config);
}

impl<'t> Translator<'t, '_> {
    fn ins(&mut self) -> FuncInstBuilder<'_, 't> {
        self.builder.ins()
    }
}

impl Translator<'_, '_> {
    fn function(&mut self) {
        let func = self.func;
        let cfg = Cfg::new(func);
        self.nan = classify(func, &cfg);
        let entry = func.entry();
        for &block in cfg.reverse_postorder().iter().filter(|&&b| b != entry) {
            self.declare_block(block);
        }
        if self.facts.metered {
            self.reload_budget();
            self.pay(self.facts.work, None);
        }
        self.clear_locals();
        for &block in cfg.reverse_postorder() {
            self.at = block;
            if block != entry {
                let target = self.block(block);
                self.builder.switch_to_block(target);
            }
            for &inst in &func.block(block).insts {
                self.inst(inst);
                self.translated(inst);
            }
            self.terminator(block);
        }
        self.finish_fault_exit();
    }

    /// A block of machine code that belongs to the block of the program that is being translated.
    fn new_block(&mut self) -> clif::Block {
        let block = self.builder.create_block();
        if self.facts.aside.contains(self.at) {
            self.builder.set_cold_block(block);
        }
        block
    }

    fn declare_block(&mut self, block: Block) {
        self.at = block;
        let target = self.new_block();
        self.blocks[block] = Some(target);
        for &param in &self.func.block(block).params {
            let ty = clif_type(self.func.value_type(param));
            self.values[param] = Some(self.builder.append_block_param(target, ty));
        }
    }

    fn block(&self, block: Block) -> clif::Block {
        self.blocks[block].expect("reachable blocks are declared")
    }

    fn value(&self, value: Value) -> clif::Value {
        self.values[value].expect("definitions are translated before uses")
    }

    fn inst(&mut self, inst: Inst) {
        let func = self.func;
        let result = match func.inst(inst) {
            InstData::Const { ty, bits } => self.constant(*ty, *bits),
            InstData::Unary { op, arg } => self.unary(*op, *arg),
            InstData::Binary { op, args } => self.binary(*op, *args),
            InstData::Compare { op, args } => self.compare(*op, *args),
            InstData::Convert { op, to, arg } => self.convert(*op, *to, *arg),
            InstData::Select { cond, args } => {
                let class = self.nan[func.result(inst)];
                let (cond, args) = (self.value(*cond), args.map(|v| self.as_class(class, v)));
                self.ins().select(cond, args[0], args[1])
            }
            InstData::Load { place } => self.load(place),
            InstData::Store { place, value } => return self.store(place, *value),
            InstData::Copy { to, from } => {
                self.write_all();
                return self.copy(to, from);
            }
            InstData::Clear { place } => {
                self.write_all();
                return self.clear(place);
            }
            InstData::Address { place } => self.address_of(place),
            InstData::Now => self.now(),
            InstData::Elapsed { place, unit_ns, ty } => self.elapsed(place, *unit_ns, *ty),
            InstData::Step { unit_ns, ty } => self.step(*unit_ns, *ty),
            InstData::Call { func, refs, args } => {
                self.write_all();
                return self.call(inst, *func, refs, args);
            }
        };
        self.values[func.result(inst)] = Some(result);
    }

    /// Brings memory to what the program has stored so far.
    fn write_all(&mut self) {
        self.store_constants();
        self.settle();
    }

    /// A field of the context that no code changes.
    fn context_field(&mut self, ty: clif::Type, offset: i32) -> clif::Value {
        let flags = self
            .flags(self.regions.context)
            .with_readonly()
            .with_can_move();
        let context = self.context;
        self.ins().load(ty, flags, context, offset)
    }

    fn now(&mut self) -> clif::Value {
        self.context_field(types::I64, ScanContext::NOW_NS)
    }

    /// Every address is checked before it is used, so no access traps.
    fn flags(&self, region: AliasRegion) -> MemFlagsData {
        MemFlagsData::new()
            .with_notrap()
            .with_alias_region(Some(region))
    }

    fn reference(&self, param: RefParam) -> clif::Value {
        self.refs[param.index()]
    }
}
