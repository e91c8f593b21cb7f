//! Range analysis: what state leaves and values of a scan can hold.
//!
//! The result is a fixpoint from the initial image over one scan with any inputs, for scans in
//! normal form (`scan_form`); for others nothing is claimed. Integers are intervals. A state leaf
//! is also tracked apart for each value of the flags beside it in the same struct, because that is
//! what bounds a timer: while DN is 0, ACC is below PRE. Growth jumps to the next threshold, a
//! constant of the leaf's own program, so the fixpoint comes quickly and stays exact where it
//! matters.
//!
//! `elapsed` and `now` are any number; `step` is at most what the caller says a scan can bring.

mod case;

use crate::scan_form::{Leaf, ScanForm};
use case::{Case, DEPTH};
use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::{Range, Ranges, interval};
use iecc_ir::{CompareOp, Function, InstData, Module, Projection, Root, Type, Value, Values};
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

/// Rounds before growth jumps to thresholds, and before it jumps to the whole type.
const EXACT_ROUNDS: u32 = 2;
const THRESHOLD_ROUNDS: u32 = 48;
/// How many values behind a leaf are searched for thresholds.
const CONE: usize = 100;
/// How many flags beside a leaf are told apart.
const MAX_FLAGS: usize = 6;
/// How far behind the next value of a number its gating flags are looked for.
const GATES: u32 = 5;
/// How deep an integer select is looked into when no assumption is made.
const SELECT_DEPTH: u32 = 8;

/// The ranges of a module's scan. `max_step(unit_ns)` is the largest value `step` can have.
pub fn ranges(module: &Module, max_step: &dyn Fn(u64) -> u64) -> Ranges {
    Analysis::of(module, max_step).map_or_else(Ranges::default, Analysis::result)
}

/// The ranges of a module's scan, given what is already known of its state at scan boundaries. For
/// modules from which a pass has taken what would prove it again.
pub fn ranges_given(module: &Module, known: &Ranges, max_step: &dyn Fn(u64) -> u64) -> Ranges {
    let Some(form) = ScanForm::of(module) else {
        return Ranges::default();
    };
    let mut analysis = Analysis::new(&module.funcs[module.scan], form, max_step);
    for (leaf, state) in analysis.form.leaves.iter().zip(&mut analysis.state) {
        if leaf.ty.is_int() {
            let whole = known.leaf(&leaf.place, leaf.ty);
            *state = LeafState {
                whole,
                by_flag: BTreeMap::new(),
            };
        }
    }
    analysis.compute_base(SELECT_DEPTH);
    analysis.result()
}

/// What is known of a leaf at scan boundaries.
#[derive(Debug, Clone, PartialEq, Eq)]
struct LeafState {
    whole: Range,
    /// By flag beside the leaf: what the leaf holds while the flag is 0 and while it is 1.
    by_flag: BTreeMap<usize, [Option<Range>; 2]>,
}

impl LeafState {
    /// The range while these flags have these values; `None` if they never do.
    fn given(&self, flags: &BTreeMap<usize, bool>) -> Option<Range> {
        let mut range = self.whole;
        for (flag, by_value) in &self.by_flag {
            if let Some(&value) = flags.get(flag) {
                range = range.intersection(by_value[usize::from(value)]?)?;
            }
        }
        Some(range)
    }
}

/// The fixpoint; solved when given out.
pub(crate) struct Analysis<'m> {
    func: &'m Function,
    form: ScanForm,
    max_step: &'m dyn Fn(u64) -> u64,
    leaf_index: SecondaryMap<Value, Option<u32>>,
    base: SecondaryMap<Value, Option<Range>>,
    state: Vec<LeafState>,
    thresholds: Vec<Vec<i64>>,
    /// What the present question may still compute.
    work: Cell<u32>,
}

impl<'m> Analysis<'m> {
    /// The solved analysis of a scan in normal form.
    pub(crate) fn of(module: &'m Module, max_step: &'m dyn Fn(u64) -> u64) -> Option<Self> {
        let form = ScanForm::of(module)?;
        let mut analysis = Self::new(&module.funcs[module.scan], form, max_step);
        analysis.solve();
        Some(analysis)
    }

    /// The registers of the scan.
    pub(crate) fn form(&self) -> &ScanForm {
        &self.form
    }

    /// The flag beside a leaf that says whether `x op k`, with the value it has then; x is the load
    /// of the leaf.
    pub(crate) fn flag_that_decides(
        &self,
        op: CompareOp,
        x: Value,
        k: i64,
    ) -> Option<(Value, bool)> {
        let leaf = self.leaf_of(x)?;
        let decided = |range: Option<Range>| {
            range.and_then(|range| interval::compare(op, range, Range::constant(k)).as_constant())
        };
        self.state[leaf]
            .by_flag
            .iter()
            .find_map(|(&flag, by_value)| {
                let load = self.form.leaves[flag].load?;
                match by_value.map(decided) {
                    [Some(0), Some(1)] => Some((load, true)),
                    [Some(1), Some(0)] => Some((load, false)),
                    _ => None,
                }
            })
    }

    fn new(func: &'m Function, form: ScanForm, max_step: &'m dyn Fn(u64) -> u64) -> Self {
        let mut leaf_index = SecondaryMap::new();
        for (index, leaf) in form.leaves.iter().enumerate() {
            if let Some(load) = leaf.load {
                leaf_index[load] = Some(index as u32);
            }
        }
        let mut flags = flags_beside(&form.leaves);
        for (leaf, flags) in form.leaves.iter().zip(&mut flags) {
            add_gating_flags(func, &leaf_index, leaf, flags);
        }
        let state = form
            .leaves
            .iter()
            .zip(&flags)
            .map(|(leaf, flags)| initial(&form.leaves, leaf, flags))
            .collect();
        let compared = compared_with(func, &form);
        let thresholds = form
            .leaves
            .iter()
            .map(|leaf| thresholds(func, &compared, leaf));
        let thresholds = thresholds.collect();
        Self {
            func,
            form,
            max_step,
            leaf_index,
            base: SecondaryMap::new(),
            state,
            thresholds,
            work: Cell::new(0),
        }
    }

    /// The range of a value without assumptions.
    pub(crate) fn base(&self, value: Value) -> Range {
        self.base[value].unwrap_or_else(|| Range::of_type(self.func.value_type(value)))
    }

    /// The bit that `value` must be when `condition` has the given value, if it is the same always.
    pub(crate) fn bit_when(&self, condition: Value, is: bool, value: Value) -> Option<bool> {
        let mut case = Case::new(self);
        case.assume(condition, Range::constant(i64::from(is)))?;
        case.range(value, DEPTH)?.as_constant().map(|bit| bit == 1)
    }

    /// Whether a bit can never have this value.
    pub(crate) fn is_never(&self, value: Value, bit: bool) -> bool {
        Case::new(self)
            .assume(value, Range::constant(i64::from(bit)))
            .is_none()
    }

    /// The index of the leaf whose load a value is.
    pub(crate) fn leaf_of(&self, value: Value) -> Option<usize> {
        self.leaf_index[value].map(|index| index as usize)
    }

    /// The leaf index of a value that is the load of an `i1`.
    fn flag_of(&self, value: Value) -> Option<usize> {
        self.leaf_of(value)
            .filter(|&leaf| self.form.leaves[leaf].ty == Type::I1)
    }

    fn solve(&mut self) {
        self.settle_flags();
        let mut round = 0;
        loop {
            self.compute_base(SELECT_DEPTH);
            let mut changed = false;
            for index in 0..self.state.len() {
                changed |= self.grow(index, round);
            }
            if !changed {
                return;
            }
            round += 1;
        }
    }

    /// Finds flags that never change, with all numbers open. One timer enables the next, so flags
    /// settle one after the other; numbers would have to wait for them in every round.
    fn settle_flags(&mut self) {
        let start: Vec<LeafState> = self.state.clone();
        for (leaf, state) in self.form.leaves.iter().zip(&mut self.state) {
            state.by_flag.clear();
            if leaf.ty.is_int() && leaf.ty != Type::I1 && leaf.next.is_some() {
                state.whole = Range::of_type(leaf.ty);
            }
        }
        loop {
            self.compute_base(1);
            let flags = self
                .form
                .leaves
                .iter()
                .enumerate()
                .filter(|(_, leaf)| leaf.ty == Type::I1);
            let grown: Vec<(usize, Range)> = flags
                .filter_map(|(index, leaf)| {
                    Some((index, self.base(leaf.next?).union(self.state[index].whole)))
                })
                .filter(|&(index, whole)| whole != self.state[index].whole)
                .collect();
            if grown.is_empty() {
                break;
            }
            for (index, whole) in grown {
                self.state[index].whole = whole;
            }
        }
        for (settled, start) in self.state.iter_mut().zip(start) {
            let whole = if settled.whole == Range::new(0, 1) {
                settled.whole
            } else {
                start.whole
            };
            *settled = LeafState { whole, ..start };
        }
    }

    /// Ranges of all values from the current state, without assumptions; selects of numbers are
    /// looked into that deep.
    fn compute_base(&mut self, select_depth: u32) {
        self.base.clear();
        let insts = &self.func.block(self.form.block).insts;
        for &inst in insts {
            let &[value] = self.func.results_of(inst) else {
                continue;
            };
            let ty = self.func.value_type(value);
            if ty.is_int() {
                let range = self.transfer(self.func.inst(inst), value, ty, select_depth);
                self.base[value] = Some(range);
            }
        }
    }

    fn transfer(&self, inst: &InstData, value: Value, ty: Type, select_depth: u32) -> Range {
        match inst {
            InstData::Const { bits, .. } => Range::of_bits(ty, *bits),
            InstData::Load { place } if place.root == Root::State => self
                .leaf_of(value)
                .map_or(Range::of_type(ty), |leaf| self.state[leaf].whole),
            InstData::Step { unit_ns, .. } => {
                let top = i64::try_from((self.max_step)(*unit_ns)).unwrap_or(i64::MAX);
                Range::new(0, top.min(Range::of_type(ty).hi))
            }
            InstData::Now => Range::new(0, i64::MAX),
            // Only here do paths matter; a flag's own value needs no context.
            InstData::Select { .. } if ty != Type::I1 => Case::new(self)
                .range(value, select_depth)
                .unwrap_or(Range::of_type(ty)),
            InstData::Compare { args, .. } if self.func.value_type(args[0]).is_float() => {
                Range::of_type(ty)
            }
            InstData::Convert { arg, .. } if self.func.value_type(*arg).is_float() => {
                Range::of_type(ty)
            }
            InstData::Unary { .. }
            | InstData::Binary { .. }
            | InstData::Compare { .. }
            | InstData::Convert { .. } => Case::new(self)
                .range(value, 1)
                .unwrap_or(Range::of_type(ty)),
            InstData::Select { .. } => Case::new(self)
                .range(value, 1)
                .unwrap_or(Range::of_type(ty)),
            InstData::Load { .. }
            | InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Address { .. }
            | InstData::Elapsed { .. }
            | InstData::Call { .. } => Range::of_type(ty),
        }
    }

    /// Joins what one scan makes of a leaf into its state; whether that changed anything.
    fn grow(&mut self, index: usize, round: u32) -> bool {
        let leaf = &self.form.leaves[index];
        let Some(next) = leaf.next.filter(|_| leaf.ty.is_int()) else {
            return false;
        };
        let old = &self.state[index];
        let mut new = old.clone();
        for (&flag, by_value) in &mut new.by_flag {
            for (before, after) in [(false, false), (false, true), (true, false), (true, true)] {
                if old.by_flag[&flag][usize::from(before)].is_none() {
                    continue;
                }
                let Some(range) = self.after_scan(next, flag, before, after) else {
                    continue;
                };
                let kept = &mut by_value[usize::from(after)];
                *kept = Some(self.widened(index, round, *kept, range));
            }
        }
        new.whole = match new.by_flag.is_empty() {
            true => self.widened(index, round, Some(old.whole), self.base(next)),
            false => whole(&new.by_flag, old.whole),
        };
        let changed = new != *old;
        self.state[index] = new;
        changed
    }

    /// The range of `next` in scans that change the flag from `before` to `after`; `None` if there
    /// are none.
    fn after_scan(&self, next: Value, flag: usize, before: bool, after: bool) -> Option<Range> {
        if !self.state[flag].whole.contains(i64::from(before)) {
            return None;
        }
        let mut case = Case::new(self);
        case.assume_flag(flag, before)?;
        match self.form.leaves[flag].next {
            Some(value) => case.assume(value, Range::constant(i64::from(after)))?,
            None if before != after => return None,
            None => {}
        }
        case.range(next, DEPTH)
    }

    /// The union of old and new; growth jumps to thresholds so that it ends.
    fn widened(&self, index: usize, round: u32, old: Option<Range>, new: Range) -> Range {
        let ty = Range::of_type(self.form.leaves[index].ty);
        let Some(old) = old else { return new };
        let union = old.union(new);
        if union == old || round < EXACT_ROUNDS {
            return union;
        }
        if round >= THRESHOLD_ROUNDS {
            return ty;
        }
        let thresholds = &self.thresholds[index];
        let above = thresholds
            .iter()
            .copied()
            .find(|&t| t >= union.hi)
            .unwrap_or(ty.hi)
            .min(ty.hi);
        let below = thresholds
            .iter()
            .rev()
            .copied()
            .find(|&t| t <= union.lo)
            .unwrap_or(ty.lo)
            .max(ty.lo);
        Range::new(
            if union.lo < old.lo { below } else { old.lo },
            if union.hi > old.hi { above } else { old.hi },
        )
    }

    fn result(self) -> Ranges {
        let leaves = self.form.leaves.iter().zip(&self.state);
        let state = leaves
            .filter(|(leaf, _)| leaf.ty.is_int())
            .map(|(leaf, state)| (leaf.place.clone(), state.whole))
            .collect();
        Ranges {
            values: self.base,
            state,
        }
    }
}

fn whole(by_flag: &BTreeMap<usize, [Option<Range>; 2]>, old: Range) -> Range {
    let unions = by_flag.values().filter_map(|[no, yes]| match (no, yes) {
        (Some(a), Some(b)) => Some(a.union(*b)),
        (one, other) => one.or(*other),
    });
    unions
        .reduce(|a, b| a.intersection(b).unwrap_or(a))
        .unwrap_or(old)
}

/// For each integer leaf the indices of the other `i1` leaves in the same struct.
fn flags_beside(leaves: &[Leaf]) -> Vec<Vec<usize>> {
    let mut by_parent: BTreeMap<&[Projection], Vec<usize>> = BTreeMap::new();
    for (index, leaf) in leaves.iter().enumerate() {
        if leaf.ty == Type::I1 {
            by_parent.entry(parent(leaf)).or_default().push(index);
        }
    }
    let beside = |(own, leaf): (usize, &Leaf)| {
        // The top level of the state is no unit of meaning; there may be thousands of flags.
        if leaf.ty.is_float() || leaf.place.path.len() == 1 {
            return Vec::new();
        }
        let flags = by_parent.get(parent(leaf)).into_iter().flatten();
        flags
            .copied()
            .filter(|&flag| flag != own)
            .take(MAX_FLAGS)
            .collect()
    };
    leaves.iter().enumerate().map(beside).collect()
}

/// Adds the flags that gate the next value of a number: those near the conditions of its selects.
/// A flag beside it that was merged with one elsewhere is found here.
fn add_gating_flags(
    func: &Function,
    leaf_index: &SecondaryMap<Value, Option<u32>>,
    leaf: &Leaf,
    flags: &mut Vec<usize>,
) {
    if leaf.ty == Type::I1 || leaf.ty.is_float() {
        return;
    }
    let mut queue: Vec<(Value, u32)> = leaf.next.map(|next| (next, GATES)).into_iter().collect();
    let mut next = 0;
    while let Some(&(value, depth)) = queue
        .get(next)
        .filter(|_| next < CONE && flags.len() < MAX_FLAGS)
    {
        next += 1;
        match func.def_inst(value) {
            Some(InstData::Load { .. }) if func.value_type(value) == Type::I1 => {
                let flag = leaf_index[value].map(|index| index as usize);
                flags.extend(flag.filter(|flag| !flags.contains(flag)));
            }
            Some(InstData::Select { .. } | InstData::Unary { .. } | InstData::Binary { .. })
                if depth > 0 =>
            {
                let operands = func.def_inst(value).map_or(Values::new(), InstData::values);
                queue.extend(operands.into_iter().map(|operand| (operand, depth - 1)));
            }
            _ => {}
        }
    }
}

fn parent(leaf: &Leaf) -> &[Projection] {
    &leaf.place.path[..leaf.place.path.len() - 1]
}

fn initial(leaves: &[Leaf], leaf: &Leaf, flags: &[usize]) -> LeafState {
    if leaf.ty.is_float() {
        return LeafState {
            whole: Range::new(0, 0),
            by_flag: BTreeMap::new(),
        };
    }
    let start = Range::of_bits(leaf.ty, leaf.init);
    let by_flag = flags.iter().map(|&flag| {
        let mut by_value = [None; 2];
        by_value[usize::from(leaves[flag].init == 1)] = Some(start);
        (flag, by_value)
    });
    LeafState {
        whole: start,
        by_flag: by_flag.collect(),
    }
}

/// The numbers that values are compared with: constants, and starts of leaves that may be constant.
fn compared_with(func: &Function, form: &ScanForm) -> BTreeMap<Value, Vec<i64>> {
    let starts: BTreeMap<Value, u64> = form
        .leaves
        .iter()
        .filter_map(|leaf| Some((leaf.load?, leaf.init)))
        .collect();
    let number = |value: Value| {
        let bits = func.constant(value).or_else(|| starts.get(&value).copied());
        bits.map(|bits| func.value_type(value).signed(bits))
    };
    let mut compared: BTreeMap<Value, Vec<i64>> = BTreeMap::new();
    for &inst in &func.block(form.block).insts {
        let InstData::Compare { args: [a, b], .. } = func.inst(inst) else {
            continue;
        };
        if func.value_type(*a).is_int() {
            for (x, k) in [(*a, number(*b)), (*b, number(*a))] {
                compared.entry(x).or_default().extend(k);
            }
        }
    }
    compared
}

/// Where the growth of a leaf may stop: the numbers that it, and what its next value is made from,
/// is compared with or set to, each with its neighbours, ascending. Conditions are not followed,
/// other leaves have their own thresholds.
fn thresholds(func: &Function, compared: &BTreeMap<Value, Vec<i64>>, leaf: &Leaf) -> Vec<i64> {
    let mut numbers = vec![0];
    let mut queue: Vec<Value> = leaf.next.into_iter().chain(leaf.load).collect();
    let mut seen: BTreeSet<Value> = queue.iter().copied().collect();
    let mut next = 0;
    while let Some(&value) = queue.get(next).filter(|_| next < CONE) {
        next += 1;
        numbers.extend(compared.get(&value).into_iter().flatten());
        let operands = match func.def_inst(value) {
            Some(InstData::Const { ty, bits }) => {
                numbers.push(ty.signed(*bits));
                Values::new()
            }
            Some(InstData::Select { args, .. }) => Values::from_slice(args),
            Some(InstData::Load { .. } | InstData::Compare { .. }) | None => Values::new(),
            Some(inst) => inst.values(),
        };
        queue.extend(
            operands
                .into_iter()
                .filter(|v| func.value_type(*v) != Type::I1 && seen.insert(*v)),
        );
    }
    let beside = |k: i64| [k.saturating_sub(1), k, k.saturating_add(1)];
    numbers
        .into_iter()
        .flat_map(beside)
        .collect::<BTreeSet<i64>>()
        .into_iter()
        .collect()
}
