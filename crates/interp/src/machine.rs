//! Executes one activation: a stack of frames over one register file.

use crate::cost::Costs;
use crate::memory::{Address, Cell, Memory, Space};
use crate::route::{Route, Routes};
use iecc_ir::eval::{eval_binary, eval_compare, eval_convert, eval_elapsed, eval_unary};
use iecc_ir::{
    Block, BlockData, FaultCode, FuncId, Function, Index, Inst, InstData, Module, Root, Target,
    Terminator, Type, Value,
};
use iecc_target::Fault;

/// What stays the same for the whole activation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scan<'p> {
    pub(crate) module: &'p Module,
    pub(crate) routes: &'p Routes,
    pub(crate) costs: &'p Costs,
    pub(crate) now_ns: u64,
    /// The time of the scan before, if there was one.
    pub(crate) last_ns: Option<u64>,
}

/// A function being executed.
#[derive(Debug)]
struct Frame<'p> {
    id: FuncId,
    func: &'p Function,
    /// The block being executed.
    at: Block,
    block: &'p BlockData,
    /// The next instruction of the block.
    position: usize,
    /// Where its values begin in the register file.
    base: usize,
    /// Where its locals begin.
    local_base: usize,
    /// What its references refer to; `None` where an index left its bounds at the call.
    refs: Vec<Option<Address>>,
}

impl<'p> Frame<'p> {
    /// At the start of a function, its values and locals all 0.
    fn enter(
        scan: Scan<'p>,
        id: FuncId,
        registers: &mut Vec<u64>,
        locals: &mut Vec<u8>,
        refs: Vec<Option<Address>>,
    ) -> Self {
        let (func, base) = (&scan.module.funcs[id], registers.len());
        registers.resize(base + func.value_count(), 0);
        let local_base = locals.len();
        locals.resize(local_base + scan.routes.local_bytes(id), 0);
        Self {
            id,
            func,
            at: func.entry(),
            block: func.block(func.entry()),
            position: 0,
            base,
            local_base,
            refs,
        }
    }
}

/// An activation under way.
#[derive(Debug)]
pub(crate) struct Machine<'p, 'm> {
    scan: Scan<'p>,
    memory: Memory<'m>,
    fuel: u64,
    frame: Frame<'p>,
    callers: Vec<Frame<'p>>,
    registers: Vec<u64>,
    /// Arguments on their way to parameters, which may be each other's sources.
    arguments: Vec<u64>,
}

impl<'p, 'm> Machine<'p, 'm> {
    /// At the start of `entry`, a function without parameters and results.
    pub(crate) fn new(scan: Scan<'p>, mut memory: Memory<'m>, fuel: u64, entry: FuncId) -> Self {
        let mut registers = Vec::new();
        let frame = Frame::enter(scan, entry, &mut registers, &mut memory.locals, Vec::new());
        Self {
            scan,
            memory,
            fuel,
            frame,
            callers: Vec::new(),
            registers,
            arguments: Vec::new(),
        }
    }

    /// Runs to the end of the function.
    pub(crate) fn run(mut self) -> Result<(), Fault> {
        loop {
            match self.frame.block.insts.get(self.frame.position) {
                Some(&inst) => {
                    self.frame.position += 1;
                    self.inst(inst);
                }
                None => {
                    if self.terminate()? {
                        return Ok(());
                    }
                }
            }
        }
    }

    fn value(&self, value: Value) -> u64 {
        self.registers[self.frame.base + value.as_u32() as usize]
    }

    fn set(&mut self, value: Value, bits: u64) {
        self.registers[self.frame.base + value.as_u32() as usize] = bits;
    }

    fn ty(&self, value: Value) -> Type {
        self.frame.func.value_type(value)
    }

    fn inst(&mut self, inst: Inst) {
        let func = self.frame.func;
        let result = match func.inst(inst) {
            InstData::Const { bits, .. } => *bits,
            InstData::Unary { op, arg } => eval_unary(*op, self.ty(*arg), self.value(*arg)),
            InstData::Binary { op, args: [a, b] } => {
                eval_binary(*op, self.ty(*a), self.value(*a), self.value(*b))
            }
            InstData::Compare { op, args: [a, b] } => {
                eval_compare(*op, self.ty(*a), self.value(*a), self.value(*b)).into()
            }
            InstData::Convert { op, to, arg } => {
                eval_convert(*op, self.ty(*arg), *to, self.value(*arg))
            }
            InstData::Select { cond, args: [a, b] } => match self.value(*cond) {
                0 => self.value(*b),
                _ => self.value(*a),
            },
            InstData::Load { .. } => self.memory.load(self.cell(inst)),
            InstData::Store { value, .. } => {
                return self.memory.store(self.cell(inst), self.value(*value));
            }
            InstData::Copy { .. } => {
                let [to, from] = self.scan.routes.of(self.frame.id, inst) else {
                    panic!("a copy has two places")
                };
                let (to, from, bytes) = (self.address(to), self.address(from), to.bytes);
                return self.memory.copy(to, from, bytes);
            }
            InstData::Clear { .. } => {
                let [route] = self.scan.routes.of(self.frame.id, inst) else {
                    panic!("a clear has one place")
                };
                let (to, bytes) = (self.address(route), route.bytes);
                return self.memory.copy(to, None, bytes);
            }
            InstData::Address { .. } => {
                let [route] = self.scan.routes.of(self.frame.id, inst) else {
                    panic!("an address has one place")
                };
                match self.address(route) {
                    Some(at) if at.space == Space::State => at.offset + 1,
                    Some(_) | None => 0,
                }
            }
            InstData::Now => self.scan.now_ns,
            InstData::Elapsed { unit_ns, ty, .. } => self.elapsed(inst, *unit_ns, *ty),
            InstData::Step { unit_ns, ty } => {
                let since_ns = self.scan.last_ns.unwrap_or(self.scan.now_ns);
                eval_elapsed(self.scan.now_ns, since_ns, *unit_ns, *ty)
            }
            InstData::Call { func, args, .. } => return self.call(inst, *func, args),
        };
        self.set(func.result(inst), result);
    }

    fn elapsed(&mut self, inst: Inst, unit_ns: u64, ty: Type) -> u64 {
        let (cell, now_ns) = (self.cell(inst), self.scan.now_ns);
        let since_ns = self.memory.load(cell);
        self.memory.store(cell, now_ns);
        eval_elapsed(now_ns, since_ns, unit_ns, ty)
    }

    fn call(&mut self, inst: Inst, callee: FuncId, args: &[Value]) {
        let routes = self.scan.routes.of(self.frame.id, inst);
        let refs = routes.iter().map(|route| self.address(route)).collect();
        self.gather(args);
        let locals = &mut self.memory.locals;
        let callee = Frame::enter(self.scan, callee, &mut self.registers, locals, refs);
        let caller = std::mem::replace(&mut self.frame, callee);
        self.callers.push(caller);
        self.scatter(&self.frame.block.params);
    }

    fn gather(&mut self, values: &[Value]) {
        self.arguments.clear();
        for &value in values {
            let bits = self.value(value);
            self.arguments.push(bits);
        }
    }

    fn scatter(&mut self, values: &[Value]) {
        for (index, &value) in values.iter().enumerate() {
            self.set(value, self.arguments[index]);
        }
    }

    /// Ends the block; true at the end of the activation.
    fn terminate(&mut self) -> Result<bool, Fault> {
        let (func, block) = (self.frame.func, self.frame.block);
        let terminator = block.terminator.as_ref().expect("verified blocks end");
        let fault = |code| Fault {
            code,
            origin: block.terminator_origin,
        };
        let cost = self.scan.costs.of(self.frame.id, self.frame.at);
        let left = self.fuel.checked_sub(cost);
        self.fuel = left.ok_or_else(|| fault(FaultCode::Bound))?;
        match terminator {
            Terminator::Jump(target) => self.jump(func, target),
            Terminator::Brif {
                cond,
                then,
                otherwise,
            } => match self.value(*cond) {
                0 => self.jump(func, otherwise),
                _ => self.jump(func, then),
            },
            Terminator::Switch {
                value,
                cases,
                default,
            } => {
                let bits = self.value(*value);
                let case = cases.iter().find(|(case, _)| *case == bits);
                self.jump(func, case.map_or(default, |(_, target)| target));
            }
            Terminator::Return(values) => return Ok(self.leave(values)),
            Terminator::Fault(code) => return Err(fault(*code)),
        }
        Ok(false)
    }

    fn jump(&mut self, func: &'p Function, target: &Target) {
        self.gather(&target.args);
        self.go_to(func, target.block);
        self.scatter(&self.frame.block.params);
    }

    fn go_to(&mut self, func: &'p Function, block: Block) {
        self.frame.at = block;
        self.frame.block = func.block(block);
        self.frame.position = 0;
    }

    /// Returns to the caller; true if there is none.
    fn leave(&mut self, values: &[Value]) -> bool {
        self.gather(values);
        self.registers.truncate(self.frame.base);
        self.memory.locals.truncate(self.frame.local_base);
        let Some(caller) = self.callers.pop() else {
            return true;
        };
        self.frame = caller;
        let call = self.frame.block.insts[self.frame.position - 1];
        self.scatter(self.frame.func.results_of(call));
        false
    }

    /// What the place of a load, store or `elapsed` is now.
    fn cell(&self, inst: Inst) -> Cell {
        let [route] = self.scan.routes.of(self.frame.id, inst) else {
            panic!("loads, stores and elapsed have one place")
        };
        let Some(address) = self.address(route) else {
            return Cell::Nowhere;
        };
        let ty = route.scalar();
        match route.bit {
            None => Cell::Scalar(address, ty),
            Some(bit) => match self.index(bit, ty.bits()) {
                Some(bit) => Cell::Bit(address, ty, bit),
                None => Cell::Nowhere,
            },
        }
    }

    /// Where a route ends; `None` if an index on it, or on that of its reference, is out of bounds.
    fn address(&self, route: &Route) -> Option<Address> {
        let mut address = match route.root {
            Root::State => start_of(Space::State, 0),
            Root::Input => start_of(Space::Input, 0),
            Root::Output => start_of(Space::Output, 0),
            Root::Local(_) => start_of(Space::Locals, self.frame.local_base),
            Root::Ref(param) => self.frame.refs[param.as_u32() as usize]?,
            Root::Deref { value, .. } => {
                let start = self.value(value).checked_sub(1)?;
                let end = start.checked_add(route.root_bytes)?;
                let inside = end <= self.memory.state.len() as u64;
                inside.then_some(start_of(Space::State, start as usize))?
            }
        };
        address.offset += route.offset;
        for stride in &route.strides {
            let index = self.index(Index::Value(stride.index), stride.len)?;
            address.offset += u64::from(index) * stride.bytes;
        }
        Some(address)
    }

    /// An index inside `0..len`. A negative `i32` is a large number in its bits, so one test will do.
    fn index(&self, index: Index, len: u32) -> Option<u32> {
        let index = match index {
            Index::Const(index) => index,
            Index::Value(value) => self.value(value) as u32,
        };
        (index < len).then_some(index)
    }
}

fn start_of(space: Space, offset: usize) -> Address {
    Address {
        space,
        offset: offset as u64,
    }
}
