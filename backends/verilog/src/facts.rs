//! What is known of a scan before any hardware is made: the range of every value, how many of its
//! low bits anyone looks at, and the memory it touches.
//!
//! A value is kept in `min(bits of its range, bits demanded)` bits. Where the range decides, the
//! bits are plain binary if no number is negative, else two's complement. Where the demand decides,
//! they are the low bits of the number and nobody asks for more.

use crate::clock::max_step;
use crate::options::Options;
use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::{Range, Ranges};
use iecc_ir::{
    BinaryOp, ConvertOp, Function, Index, Inst, InstData, Layout, MemType, Module, Place,
    Projection, Root, Type, Value,
};
use std::collections::BTreeMap;

/// Demand of an operation that looks at the whole number.
const WHOLE: u32 = 64;

/// A scalar of a region that the scan reads or writes.
#[derive(Debug, Clone)]
pub(crate) struct Leaf {
    pub(crate) ty: Type,
    /// At scan boundaries.
    pub(crate) range: Range,
    /// Initial bits; 0 for inputs and outputs.
    pub(crate) initial: u64,
    pub(crate) stored: bool,
}

/// The facts, for integer values of the only block of the scan function.
pub(crate) struct Facts {
    ranges: SecondaryMap<Value, Option<Range>>,
    demand: SecondaryMap<Value, u32>,
    pub(crate) leaves: BTreeMap<Place, Leaf>,
}

impl Facts {
    /// Collects the facts. The scan function has passed the check.
    pub(crate) fn new(module: &Module, options: &Options) -> Self {
        let func = &module.funcs[module.scan];
        let mut facts = Self {
            ranges: SecondaryMap::new(),
            demand: SecondaryMap::new(),
            leaves: BTreeMap::new(),
        };
        let insts = &func.block(func.entry()).insts;
        facts.find_leaves(module, func, insts, &options.ranges);
        facts.find_ranges(func, insts, options);
        facts.find_demand(func, insts);
        facts
    }

    /// What a value can be.
    pub(crate) fn range(&self, value: Value) -> Range {
        self.ranges[value].expect("ranges of all values are known")
    }

    /// Bits a value is kept in; 0 if nobody looks at it.
    pub(crate) fn width(&self, value: Value) -> u32 {
        self.range(value).bits().min(self.demand[value])
    }

    fn find_leaves(&mut self, module: &Module, func: &Function, insts: &[Inst], given: &Ranges) {
        let layout = Layout::new(&module.types);
        for &inst in insts {
            let data = func.inst(inst);
            let Some(place) = data.place() else { continue };
            let leaf = whole(place);
            let stored = matches!(data, InstData::Store { .. });
            self.leaves
                .entry(leaf.clone())
                .or_insert_with(|| new_leaf(module, &layout, func, &leaf, given))
                .stored |= stored;
        }
        for (place, leaf) in &mut self.leaves {
            if place.root == Root::State && !leaf.stored {
                leaf.range = Range::of_bits(leaf.ty, leaf.initial);
            }
        }
    }

    fn find_ranges(&mut self, func: &Function, insts: &[Inst], options: &Options) {
        // What a leaf holds in the middle of the scan.
        let mut now: BTreeMap<Place, Range> = BTreeMap::new();
        for &inst in insts {
            let data = func.inst(inst);
            if let InstData::Store { place, value } = data {
                let leaf = whole(place);
                let range = if &leaf == place {
                    self.range(*value)
                } else {
                    Range::of_type(self.leaves[&leaf].ty)
                };
                now.insert(leaf, range);
            }
            for &value in func.results_of(inst) {
                let ty = func.value_type(value);
                let own = self.own_range(data, ty, &now, options);
                let range = options.ranges.values[value]
                    .and_then(|range| range.intersection(own))
                    .unwrap_or(own);
                self.ranges[value] = Some(range);
            }
        }
    }

    /// What follows from the instruction alone.
    fn own_range(
        &self,
        data: &InstData,
        ty: Type,
        now: &BTreeMap<Place, Range>,
        options: &Options,
    ) -> Range {
        match data {
            InstData::Const { ty, bits } => Range::of_bits(*ty, *bits),
            InstData::Load { place } if whole(place) == *place => {
                now.get(place).copied().unwrap_or(self.leaves[place].range)
            }
            InstData::Step { unit_ns, .. } => step_range(options, *unit_ns),
            InstData::Load { .. }
            | InstData::Unary { .. }
            | InstData::Binary { .. }
            | InstData::Compare { .. }
            | InstData::Convert { .. }
            | InstData::Select { .. }
            | InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Address { .. }
            | InstData::Now
            | InstData::Elapsed { .. }
            | InstData::Call { .. } => Range::of_type(ty),
        }
    }

    /// Backwards, because demand flows from uses to definitions.
    fn find_demand(&mut self, func: &Function, insts: &[Inst]) {
        let mut memory: BTreeMap<Place, u32> = self
            .leaves
            .iter()
            .map(|(place, leaf)| (place.clone(), leaf.kept_bits(place)))
            .collect();
        for &inst in insts.iter().rev() {
            match func.inst(inst) {
                InstData::Load { place } => {
                    let leaf = whole(place);
                    let bits = if &leaf == place {
                        self.demand[func.result(inst)]
                    } else {
                        WHOLE
                    };
                    let demand = memory.get_mut(&leaf).expect("leaf is known");
                    *demand = bits.max(*demand);
                }
                InstData::Store { place, value } => {
                    let leaf = whole(place);
                    let demand = memory.get_mut(&leaf).expect("leaf is known");
                    let bits = *demand;
                    // A bit store keeps the other bits, a whole store none.
                    *demand = if &leaf == place { 0 } else { WHOLE };
                    self.raise(*value, bits);
                }
                data @ (InstData::Const { .. }
                | InstData::Unary { .. }
                | InstData::Binary { .. }
                | InstData::Compare { .. }
                | InstData::Convert { .. }
                | InstData::Select { .. }
                | InstData::Copy { .. }
                | InstData::Clear { .. }
                | InstData::Address { .. }
                | InstData::Now
                | InstData::Elapsed { .. }
                | InstData::Step { .. }
                | InstData::Call { .. }) => {
                    if let [result] = func.results_of(inst) {
                        self.demand_of_operands(func, data, *result);
                    }
                }
            }
        }
    }

    fn raise(&mut self, value: Value, bits: u32) {
        self.demand[value] = self.demand[value].max(bits);
    }

    fn demand_of_operands(&mut self, func: &Function, data: &InstData, result: Value) {
        let width = self.width(result);
        if width == 0 || self.range(result).as_constant().is_some() {
            return;
        }
        match data {
            InstData::Unary { arg, .. } => self.raise(*arg, width),
            InstData::Binary { op, args } => self.demand_of_binary(*op, *args, width),
            InstData::Compare { args, .. } => {
                for &arg in args {
                    self.raise(arg, WHOLE);
                }
            }
            InstData::Convert { op, arg, .. } => {
                let from = func.value_type(*arg);
                // Zeros or copies of the only bit need nothing beyond the operand.
                let own = *op == ConvertOp::Zext || from == Type::I1;
                let bits = if own { width.min(from.bits()) } else { width };
                self.raise(*arg, bits);
            }
            InstData::Select { cond, args } => {
                self.raise(*cond, 1);
                for &arg in args {
                    self.raise(arg, width);
                }
            }
            InstData::Const { .. }
            | InstData::Load { .. }
            | InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Address { .. }
            | InstData::Now
            | InstData::Elapsed { .. }
            | InstData::Step { .. }
            | InstData::Call { .. } => {}
        }
    }

    fn demand_of_binary(&mut self, op: BinaryOp, [a, b]: [Value; 2], width: u32) {
        let (left, right) = match op {
            BinaryOp::Add
            | BinaryOp::Sub
            | BinaryOp::Mul
            | BinaryOp::And
            | BinaryOp::Or
            | BinaryOp::Xor => (width, width),
            BinaryOp::Shl => (width, WHOLE),
            BinaryOp::Ushr | BinaryOp::Sshr => match self.range(b).as_constant() {
                Some(by) if (0..64).contains(&by) => ((by as u32 + width).min(WHOLE), WHOLE),
                Some(_) | None => (WHOLE, WHOLE),
            },
            BinaryOp::Sdiv
            | BinaryOp::Udiv
            | BinaryOp::Srem
            | BinaryOp::Urem
            | BinaryOp::Fadd
            | BinaryOp::Fsub
            | BinaryOp::Fmul
            | BinaryOp::Fdiv => (WHOLE, WHOLE),
        };
        self.raise(a, left);
        self.raise(b, right);
    }
}

impl Leaf {
    /// Bits of the value at the end of the scan that are kept.
    fn kept_bits(&self, place: &Place) -> u32 {
        match place.root {
            Root::State => self.range.bits(),
            Root::Output => self.ty.bits(),
            Root::Input | Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => 0,
        }
    }
}

/// The check has seen that the largest step fits the type.
fn step_range(options: &Options, unit_ns: u64) -> Range {
    let most = max_step(options.clock, unit_ns);
    Range::new(0, i64::try_from(most).expect("checked"))
}

/// The scalar a place is or is a bit of.
pub(crate) fn whole(place: &Place) -> Place {
    let mut leaf = place.clone();
    if matches!(leaf.path.last(), Some(Projection::Bit(_))) {
        leaf.path.pop();
    }
    leaf
}

/// The bit number, if the place is a bit.
pub(crate) fn bit_of(place: &Place) -> Option<u32> {
    match place.path.last() {
        Some(Projection::Bit(Index::Const(bit))) => Some(*bit),
        Some(Projection::Bit(Index::Value(_))) => panic!("places were checked to be static"),
        Some(Projection::Field(_) | Projection::Index(_)) | None => None,
    }
}

fn new_leaf(
    module: &Module,
    layout: &Layout,
    func: &Function,
    place: &Place,
    given: &Ranges,
) -> Leaf {
    let root = module.root_type(func, place.root).expect("verified root");
    let (offset, ty, _) = layout.resolve(&module.types, root, &place.path);
    let MemType::Scalar(ty) = ty else {
        panic!("verified loads and stores move scalars")
    };
    let (initial, range) = match place.root {
        Root::State => (
            module.image.get(offset, ty).bits,
            given
                .state
                .get(place)
                .copied()
                .unwrap_or_else(|| Range::of_type(ty)),
        ),
        Root::Input | Root::Output | Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => {
            (0, Range::of_type(ty))
        }
    };
    assert!(
        place.root != Root::State || range.union(Range::of_bits(ty, initial)) == range,
        "the range of a register holds its initial value"
    );
    Leaf {
        ty,
        range,
        initial,
        stored: false,
    }
}
