//! The form of scan function this back end takes, and the refusal of everything else.
//!
//! The scan function is one block; places are static; there are no calls, no floats, no absolute
//! time (`step` is what is left of it), no divisions by something that varies. All reasons are
//! collected.

use crate::clock::{Divider, max_step};
use crate::options::Options;
use iecc_ir::analysis::{Cfg, Dominators, Loops, Range};
use iecc_ir::{
    BinaryOp, Function, Inst, InstData, Layout, MemType, Module, Origin, Place, Root, Terminator,
    Type, Value,
};
use iecc_target::{Refusal, TargetError};

/// More ports than any chip has pins.
const MAX_PORT_BYTES: u64 = 65_536;

/// Every reason why the scan function cannot become one clock of hardware.
pub(crate) fn check(module: &Module, options: &Options) -> Vec<TargetError> {
    let func = &module.funcs[module.scan];
    let mut check = Check {
        func,
        options,
        errors: Vec::new(),
    };
    check.board();
    check.ports(module);
    check.control();
    for &block in &func.layout {
        for &inst in &func.block(block).insts {
            check.inst(inst);
        }
    }
    check.locals();
    check.errors
}

struct Check<'m> {
    func: &'m Function,
    options: &'m Options,
    errors: Vec<TargetError>,
}

impl Check<'_> {
    fn refuse(&mut self, refusal: Refusal, origin: Option<Origin>, message: impl Into<String>) {
        let error = TargetError {
            refusal,
            origin,
            message: message.into(),
        };
        if !self.errors.contains(&error) {
            self.errors.push(error);
        }
    }

    fn board(&mut self) {
        let Some(board) = &self.options.board else {
            return;
        };
        if board.clock() != self.options.clock {
            let message = format!(
                "the clock of the board is {}, but hardware for {} is asked for; leave the clock to the board",
                board.clock(),
                self.options.clock
            );
            self.refuse(Refusal::Option, None, message);
        }
    }

    /// Counts without listing: regions may be large.
    fn ports(&mut self, module: &Module) {
        let layout = Layout::new(&module.types);
        for (name, region) in [("inputs", module.input), ("outputs", module.output)] {
            let bytes = layout.size(&module.types, MemType::Struct(region));
            if bytes > MAX_PORT_BYTES {
                let message = format!(
                    "the {name} take {bytes} bytes, and this target makes ports for at most \
                     {MAX_PORT_BYTES}; publish less"
                );
                self.refuse(Refusal::Size, None, message);
            }
        }
    }

    fn control(&mut self) {
        let func = self.func;
        self.loops();
        for &block in &func.layout {
            if let Terminator::Fault(code) = func.terminator(block) {
                let message = format!(
                    "a fault can end the scan here ({}), and hardware that runs a scan in one clock \
                     cannot stop; choose a fault policy that goes on, or exclude the case in the program",
                    code.meaning()
                );
                self.refuse(Refusal::Fault, func.block(block).terminator_origin, message);
            }
        }
        if func.layout.len() > 1 && self.errors.is_empty() {
            let message = "branches are left in the scan where hardware needs choices between values: outputs \
                           are stored on some ways only, or the passes for hardware were not run";
            self.refuse(Refusal::Option, None, message);
        }
    }

    fn loops(&mut self) {
        let func = self.func;
        let cfg = Cfg::new(func);
        let loops = Loops::new(&cfg, &Dominators::new(&cfg));
        let irreducible = loops.irreducible.map(|(_, header)| header);
        for header in loops.natural.iter().map(|l| l.header).chain(irreducible) {
            let data = func.block(header);
            let first = data.insts.first().and_then(|&inst| func.origin(inst));
            let message = "the program goes back to here, and a scan of one clock cannot repeat anything; \
                           unroll the loop or use another target";
            self.refuse(Refusal::Loop, first.or(data.terminator_origin), message);
        }
    }

    fn inst(&mut self, inst: Inst) {
        let func = self.func;
        let origin = func.origin(inst);
        let data = func.inst(inst);
        let float = |value: &Value| func.value_type(*value).is_float();
        if data.values().iter().any(float) || func.results_of(inst).iter().any(float) {
            let message = "a REAL is used here, and this target computes with integers and bits only; \
                           scale the number to a DINT";
            self.refuse(Refusal::Float, origin, message);
        }
        let is_deref = |place: &&Place| matches!(place.root, Root::Deref { .. });
        if matches!(data, InstData::Address { .. }) || data.places().iter().any(is_deref) {
            let message = "a reference is taken or followed here, and registers have no addresses; name the \
                           variable itself";
            return self.refuse(Refusal::Reference, origin, message);
        }
        if data.places().iter().any(|place| !place.is_static()) {
            let message = "the index is computed here, and every register has its own place in hardware; \
                           use a constant index";
            self.refuse(Refusal::DynamicPlace, origin, message);
        }
        match data {
            InstData::Binary { op, args } => self.division(*op, args[1], origin),
            InstData::Copy { .. } | InstData::Clear { .. } => {
                let message = "more values are moved at once here than this target has registers for; move a \
                               part of them";
                self.refuse(Refusal::Size, origin, message);
            }
            InstData::Now => {
                let message = "the absolute time is used here, and hardware only knows how much time has \
                               passed since the scan before; use a timer";
                self.refuse(Refusal::AbsoluteTime, origin, message);
            }
            InstData::Elapsed { .. } => {
                let message = "the time since something last ran is measured here, but it does not run in \
                               every scan; let it run unconditionally";
                self.refuse(Refusal::AbsoluteTime, origin, message);
            }
            InstData::Step { unit_ns, ty } => self.step(*unit_ns, *ty, origin),
            InstData::Call { .. } => {
                let message = "a routine is called here that is not part of the scan function yet; run the \
                               passes for hardware first";
                self.refuse(Refusal::Option, origin, message);
            }
            InstData::Const { .. }
            | InstData::Unary { .. }
            | InstData::Compare { .. }
            | InstData::Convert { .. }
            | InstData::Select { .. }
            | InstData::Load { .. }
            | InstData::Address { .. }
            | InstData::Store { .. } => {}
        }
    }

    /// What is left of locals, if nothing refused so far says why it is left.
    fn locals(&mut self) {
        let func = self.func;
        let insts = func
            .layout
            .iter()
            .flat_map(|&block| &func.block(block).insts);
        let is_local = |place: &&Place| matches!(place.root, Root::Local(_));
        let found = insts
            .copied()
            .find(|&inst| func.inst(inst).places().iter().any(is_local));
        if let (Some(inst), true) = (found, self.errors.is_empty()) {
            let message = "a variable of a call is left in memory here, and every register lives from scan to \
                           scan; run the passes for hardware first";
            self.refuse(Refusal::Option, func.origin(inst), message);
        }
    }

    fn division(&mut self, op: BinaryOp, divisor: Value, origin: Option<Origin>) {
        if !is_division(op) || divisor_of(self.func, self.options, divisor).is_some() {
            return;
        }
        let message = "the divisor varies here, and a divider does not fit into one clock; divide by a \
                       constant";
        self.refuse(Refusal::Division, origin, message);
    }

    fn step(&mut self, unit_ns: u64, ty: Type, origin: Option<Origin>) {
        if max_step(self.options.clock, unit_ns) > ty.mask() >> 1 {
            let message = format!(
                "at a clock of {} more units of {unit_ns} ns pass in one scan than an {ty} holds; choose a \
                 faster clock",
                self.options.clock
            );
            self.refuse(Refusal::Option, origin, message);
        }
        if Divider::new(self.options.clock, unit_ns).is_none() {
            let message = format!(
                "a clock of {} cannot count units of {unit_ns} ns within 64 bits; choose a simpler ratio",
                self.options.clock
            );
            self.refuse(Refusal::Option, origin, message);
        }
        if let Some(base) = self.options.tick_ns
            && (base == 0 || !unit_ns.is_multiple_of(base))
        {
            let message = format!(
                "the program counts units of {unit_ns} ns, which are no multiple of the tick of {base} ns; \
                 choose a finer tick"
            );
            self.refuse(Refusal::Option, origin, message);
        }
    }
}

/// Whether the right operand divides the left one.
pub(crate) fn is_division(op: BinaryOp) -> bool {
    match op {
        BinaryOp::Sdiv | BinaryOp::Udiv | BinaryOp::Srem | BinaryOp::Urem => true,
        BinaryOp::Add
        | BinaryOp::Sub
        | BinaryOp::Mul
        | BinaryOp::And
        | BinaryOp::Or
        | BinaryOp::Xor
        | BinaryOp::Shl
        | BinaryOp::Ushr
        | BinaryOp::Sshr
        | BinaryOp::Fadd
        | BinaryOp::Fsub
        | BinaryOp::Fmul
        | BinaryOp::Fdiv => false,
    }
}

/// The divisor as a signed number, if it is always the same.
pub(crate) fn divisor_of(func: &Function, options: &Options, divisor: Value) -> Option<i64> {
    let ty = func.value_type(divisor);
    if ty.is_float() || ty == Type::I1 {
        return None;
    }
    func.constant(divisor)
        .map(|bits| ty.signed(bits))
        .or_else(|| options.ranges.values[divisor].and_then(Range::as_constant))
}
