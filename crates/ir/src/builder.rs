//! The builder front ends use: they name variables and never see block parameters.

use crate::{
    BinaryOp, Block, CompareOp, ConvertOp, FaultCode, FuncId, Function, InstData, Local, LocalData,
    MemType, Origin, Place, RefParam, RefParamData, SsaConstruction, Target, Terminator, Type,
    UnaryOp, Value, Variable,
};

/// Builds one function, block by block.
///
/// A block is *sealed* when no more jumps to it will come; seal early, it keeps parameters few.
/// After a terminator the builder is in no block until [`switch_to`](Self::switch_to).
#[derive(Debug)]
pub struct FunctionBuilder {
    func: Function,
    ssa: SsaConstruction,
    current: Option<Block>,
    origin: Option<Origin>,
}

impl FunctionBuilder {
    /// Starts a function with its entry block, which is sealed and current.
    pub fn new(name: impl Into<String>, params: &[Type], results: &[Type]) -> Self {
        let mut func = Function::new(name, results.to_vec());
        let entry = func.add_block();
        for &ty in params {
            func.add_param(entry, ty);
        }
        let mut ssa = SsaConstruction::new();
        ssa.seal(&mut func, entry);
        Self {
            func,
            ssa,
            current: Some(entry),
            origin: None,
        }
    }

    /// Adds a reference parameter.
    pub fn add_ref(&mut self, name: impl Into<String>, ty: MemType) -> RefParam {
        self.func.refs.push(RefParamData {
            name: name.into(),
            ty,
        })
    }

    /// Adds memory of one activation, all 0 at its start.
    pub fn local(&mut self, name: impl Into<String>, ty: MemType) -> Local {
        self.func.locals.push(LocalData {
            name: name.into(),
            ty,
        })
    }

    /// The n-th value parameter of the function.
    pub fn param(&self, index: usize) -> Value {
        self.func.block(self.func.entry()).params[index]
    }

    /// Everything built from now on comes from here.
    pub fn set_origin(&mut self, origin: Option<Origin>) {
        self.origin = origin;
    }

    /// A new block, neither sealed nor current.
    pub fn create_block(&mut self) -> Block {
        self.func.add_block()
    }

    /// Goes on building in `block`.
    pub fn switch_to(&mut self, block: Block) {
        debug_assert!(self.current.is_none(), "the block before has a terminator");
        self.current = Some(block);
    }

    /// Says that no more jumps to `block` will come.
    pub fn seal(&mut self, block: Block) {
        self.ssa.seal(&mut self.func, block);
    }

    /// Whether the builder is in a block that has no terminator yet.
    pub fn is_open(&self) -> bool {
        self.current.is_some()
    }

    /// A new variable; 0 until assigned.
    pub fn declare(&mut self, ty: Type) -> Variable {
        self.ssa.declare(ty)
    }

    /// Assigns a variable here.
    pub fn assign(&mut self, variable: Variable, value: Value) {
        let block = self.block();
        self.ssa.define(variable, block, value);
    }

    /// Reads a variable here.
    pub fn read(&mut self, variable: Variable) -> Value {
        let block = self.block();
        self.ssa.value(&mut self.func, variable, block)
    }

    fn block(&self) -> Block {
        self.current.expect("the builder is in a block")
    }

    fn push(&mut self, data: InstData, results: &[Type]) -> crate::Inst {
        let block = self.block();
        self.func.append_inst(block, data, results, self.origin)
    }

    fn push_one(&mut self, data: InstData, ty: Type) -> Value {
        let inst = self.push(data, &[ty]);
        self.func.result(inst)
    }

    /// A constant; bits above the width are dropped.
    pub fn constant(&mut self, ty: Type, bits: u64) -> Value {
        self.push_one(
            InstData::Const {
                ty,
                bits: bits & ty.mask(),
            },
            ty,
        )
    }

    /// A unary operation.
    pub fn unary(&mut self, op: UnaryOp, arg: Value) -> Value {
        let ty = self.func.value_type(arg);
        self.push_one(InstData::Unary { op, arg }, ty)
    }

    /// A binary operation.
    pub fn binary(&mut self, op: BinaryOp, left: Value, right: Value) -> Value {
        let ty = self.func.value_type(left);
        self.push_one(
            InstData::Binary {
                op,
                args: [left, right],
            },
            ty,
        )
    }

    /// A comparison.
    pub fn compare(&mut self, op: CompareOp, left: Value, right: Value) -> Value {
        self.push_one(
            InstData::Compare {
                op,
                args: [left, right],
            },
            Type::I1,
        )
    }

    /// A conversion.
    pub fn convert(&mut self, op: ConvertOp, to: Type, arg: Value) -> Value {
        self.push_one(InstData::Convert { op, to, arg }, to)
    }

    /// `cond ? yes : no`.
    pub fn select(&mut self, cond: Value, yes: Value, no: Value) -> Value {
        let ty = self.func.value_type(yes);
        self.push_one(
            InstData::Select {
                cond,
                args: [yes, no],
            },
            ty,
        )
    }

    /// Loads a value of type `ty`, which must be that of the place.
    pub fn load(&mut self, place: Place, ty: Type) -> Value {
        self.push_one(InstData::Load { place }, ty)
    }

    /// Stores a value.
    pub fn store(&mut self, place: Place, value: Value) {
        self.push(InstData::Store { place, value }, &[]);
    }

    /// Moves a whole scalar, struct or array between places of the same type.
    pub fn copy(&mut self, to: Place, from: Place) {
        self.push(InstData::Copy { to, from }, &[]);
    }

    /// Makes a whole scalar, struct or array 0.
    pub fn clear(&mut self, place: Place) {
        self.push(InstData::Clear { place }, &[]);
    }

    /// The address of a place of the state.
    pub fn address(&mut self, place: Place) -> Value {
        self.push_one(InstData::Address { place }, Type::I64)
    }

    /// The time of the scan, `i64` nanoseconds.
    pub fn now(&mut self) -> Value {
        self.push_one(InstData::Now, Type::I64)
    }

    /// Units since the time at `place`, which is renewed.
    pub fn elapsed(&mut self, place: Place, unit_ns: u64, ty: Type) -> Value {
        self.push_one(InstData::Elapsed { place, unit_ns, ty }, ty)
    }

    /// Units since the scan before.
    pub fn step(&mut self, unit_ns: u64, ty: Type) -> Value {
        self.push_one(InstData::Step { unit_ns, ty }, ty)
    }

    /// Calls a function with these result types.
    pub fn call(
        &mut self,
        func: FuncId,
        refs: Vec<Place>,
        args: Vec<Value>,
        results: &[Type],
    ) -> Vec<Value> {
        let inst = self.push(InstData::Call { func, refs, args }, results);
        self.func.results_of(inst).to_vec()
    }

    /// The type of a value.
    pub fn value_type(&self, value: Value) -> Type {
        self.func.value_type(value)
    }

    /// Goes on in `block`.
    pub fn jump(&mut self, block: Block) {
        self.terminate(Terminator::Jump(Target::new(block)));
    }

    /// Goes on in `then` if `cond` is 1, else in `otherwise`.
    pub fn brif(&mut self, cond: Value, then: Block, otherwise: Block) {
        let (then, otherwise) = (Target::new(then), Target::new(otherwise));
        self.terminate(Terminator::Brif {
            cond,
            then,
            otherwise,
        });
    }

    /// Goes on in the block of the matching case.
    pub fn switch(&mut self, value: Value, cases: Vec<(u64, Block)>, default: Block) {
        let cases = cases
            .into_iter()
            .map(|(bits, block)| (bits, Target::new(block)))
            .collect();
        self.terminate(Terminator::Switch {
            value,
            cases,
            default: Target::new(default),
        });
    }

    /// Leaves the function.
    pub fn ret(&mut self, values: Vec<Value>) {
        self.terminate(Terminator::Return(values));
    }

    /// Abandons the scan.
    pub fn fault(&mut self, fault: FaultCode) {
        self.terminate(Terminator::Fault(fault));
    }

    fn terminate(&mut self, terminator: Terminator) {
        let block = self.block();
        for target in terminator.targets() {
            self.ssa.add_edge(block, target.block);
        }
        self.func.set_terminator(block, terminator, self.origin);
        self.current = None;
    }

    /// The finished function. Every block has a terminator and is sealed.
    pub fn finish(self) -> Function {
        debug_assert!(self.current.is_none(), "the last block has a terminator");
        self.func
    }
}
