//! Counters that matter up to a number only stop there.
//!
//! A counter that is compared with constants up to S, and otherwise only counts, is set or is kept,
//! may as well stop at S: `ACC` of a CTU with PRE 9 needs 4 bits, not 32. The one thing that tells a
//! stopped counter from one that goes on is what happens when the one that goes on wraps. There the
//! program must have a flag that remembers the wrap (OV), and must not let anyone see the
//! difference: with the flag set, or the counter at S, everything else comes out the same. `proof`
//! shows that case by case, or the counter stays as it is.
//!
//! The wrap then never happens, and state promotion removes the flag. Works on scans in normal
//! form.

mod proof;

use crate::Settings;
use crate::edit::{BlockEditor, hoist_loads};
use crate::scan_form::ScanForm;
use iecc_ir::{BinaryOp, CompareOp, Function, InstData, Module, Place, Type, Value};
use std::collections::{BTreeMap, BTreeSet};

/// How many conditions may choose the next value of a counter; each way is looked at.
const MAX_CONDITIONS: usize = 6;

/// Runs the pass.
pub(crate) fn run(module: &mut Module, _settings: &Settings) {
    let Some(form) = ScanForm::of(module) else {
        return;
    };
    let scan = module.scan;
    let func = &mut module.funcs[scan];
    hoist_loads(func, form.block);
    for leaf in 0..form.leaves.len() {
        let Some(counter) = Counter::of(func, &form, leaf) else {
            continue;
        };
        let flags = flags_beside(&form, leaf);
        if flags
            .into_iter()
            .any(|flag| proof::is_invisible(func, &form, &counter, flag))
        {
            apply(func, &form, &counter);
        }
    }
}

fn flags_beside(form: &ScanForm, leaf: usize) -> Vec<usize> {
    let parent = |place: &Place| place.path[..place.path.len() - 1].to_vec();
    let own = parent(&form.leaves[leaf].place);
    let beside = |&index: &usize| {
        let flag = &form.leaves[index];
        flag.ty == Type::I1
            && flag.init == 0
            && flag.load.is_some()
            && flag.next.is_some()
            && parent(&flag.place) == own
    };
    (0..form.leaves.len()).filter(beside).collect()
}

/// What the next value of a counter can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    /// The value it had.
    Keep,
    /// One more.
    Count,
    /// A constant, not negative.
    Set(i64),
}

/// What a value of the counter is made from.
#[derive(Debug, Clone, Copy)]
enum Node {
    /// One of two, by a condition.
    Select(Value, [Value; 2]),
    /// One more than another.
    Sum(Value),
}

/// How the next value is made.
#[derive(Debug)]
struct Choices {
    next: Value,
    /// Selects and sums, operands before users.
    nodes: Vec<(Value, Node)>,
    /// What stands at their ends.
    ends: BTreeMap<Value, Step>,
    conditions: BTreeSet<Value>,
}

/// One way through the selects.
#[derive(Debug)]
struct Way {
    conditions: BTreeMap<Value, bool>,
    /// What each select and end is on this way.
    steps: BTreeMap<Value, Step>,
    /// What the next value is.
    next: Step,
}

/// A comparison of the counter, of one more than it, or of its next value.
#[derive(Debug, Clone, Copy)]
struct Observation {
    op: CompareOp,
    of: Value,
    k: i64,
}

impl Observation {
    fn outcome(self, x: i64) -> bool {
        match self.op {
            CompareOp::Eq => x == self.k,
            CompareOp::Ne => x != self.k,
            CompareOp::Slt => x < self.k,
            CompareOp::Sle => x <= self.k,
            CompareOp::Sgt => x > self.k,
            CompareOp::Sge => x >= self.k,
            _ => panic!("only these are observations"),
        }
    }
}

/// A state leaf that counts.
#[derive(Debug)]
struct Counter {
    leaf: usize,
    load: Value,
    choices: Choices,
    /// Comparisons that come out alike for everything from `top` on.
    low: BTreeMap<Value, Observation>,
    /// Comparisons with the largest number of the type: `==` or `!=`, and of what.
    at_max: BTreeMap<Value, Observation>,
    /// Where the counter may stop.
    top: i64,
    max: i64,
}

impl Counter {
    fn of(func: &Function, form: &ScanForm, leaf: usize) -> Option<Self> {
        let data = &form.leaves[leaf];
        let (load, next) = (data.load?, data.next?);
        if !matches!(data.ty, Type::I8 | Type::I16 | Type::I32 | Type::I64)
            || data.ty.signed(data.init) < 0
        {
            return None;
        }
        let max = (data.ty.mask() >> 1) as i64;
        let choices = Choices::of(func, load, next)?;
        let mut counter = Self {
            leaf,
            load,
            choices,
            low: BTreeMap::new(),
            at_max: BTreeMap::new(),
            top: 0,
            max,
        };
        counter.observe(func, form)?;
        let ways: Vec<Way> = counter.choices.ways().flatten().collect();
        let sets = ways
            .iter()
            .flat_map(|way| way.steps.values())
            .filter_map(|step| match step {
                Step::Set(k) => Some(*k),
                Step::Keep | Step::Count => None,
            });
        counter.top = counter
            .top
            .max(sets.max().unwrap_or(0))
            .max(data.ty.signed(data.init));
        let counts = ways.iter().any(|way| way.next == Step::Count);
        // Half the bits must go, or it is not worth a comparison.
        let worth = counter.top < 1 << (data.ty.bits() / 2);
        (worth && counts).then_some(counter)
    }

    /// Constants at the ends are shared with others; they do not stand for the counter.
    fn is_counter_value(&self, value: Value) -> bool {
        value == self.load || self.choices.nodes.iter().any(|(node, _)| *node == value)
    }

    /// What a sum adds one to.
    fn summand(&self, value: Value) -> Option<Value> {
        self.choices
            .nodes
            .iter()
            .find_map(|(node, kind)| match kind {
                Node::Sum(of) if *node == value => Some(*of),
                Node::Sum(_) | Node::Select(..) => None,
            })
    }

    /// Collects every use of the counter's values; `None` if one is no comparison with a constant.
    fn observe(&mut self, func: &Function, form: &ScanForm) -> Option<()> {
        let place = &form.leaves[self.leaf].place;
        for &inst in &func.block(form.block).insts {
            let data = func.inst(inst);
            let used: Vec<Value> = data
                .values()
                .into_iter()
                .filter(|&v| self.is_counter_value(v))
                .collect();
            if used.is_empty() {
                continue;
            }
            match data {
                InstData::Store { place: stored, .. } if stored == place => {}
                InstData::Select { .. } | InstData::Binary { .. }
                    if self.is_counter_value(func.result(inst)) => {}
                InstData::Compare { op, args } => {
                    self.comparison(func, func.result(inst), *op, *args)?;
                }
                _ => return None,
            }
        }
        Some(())
    }

    fn comparison(
        &mut self,
        func: &Function,
        result: Value,
        op: CompareOp,
        [a, b]: [Value; 2],
    ) -> Option<()> {
        let (op, of, k) = match (func.constant(a), func.constant(b)) {
            (None, Some(k)) => (op, a, k),
            (Some(k), None) => (op.swapped(), b, k),
            _ => return None,
        };
        let k = func.value_type(of).signed(k);
        let may_be_at_max = |way: Option<Way>| {
            way.is_some_and(|way| way.steps.get(&of).copied().unwrap_or(Step::Keep) != Step::Count)
        };
        if k == self.max
            && matches!(op, CompareOp::Eq | CompareOp::Ne)
            && self.choices.ways().all(may_be_at_max)
        {
            self.at_max.insert(result, Observation { op, of, k });
            return Some(());
        }
        // From here on the outcome does not change any more.
        let settled = match op {
            CompareOp::Sge | CompareOp::Slt => k,
            CompareOp::Eq | CompareOp::Ne | CompareOp::Sgt | CompareOp::Sle => k.checked_add(1)?,
            _ => return None,
        };
        self.top = self.top.max(settled);
        self.low.insert(result, Observation { op, of, k });
        Some(())
    }
}

impl Choices {
    /// `None` if something else than keeping, setting and counting once is on a way.
    fn of(func: &Function, load: Value, next: Value) -> Option<Self> {
        let mut choices = Self {
            next,
            nodes: Vec::new(),
            ends: BTreeMap::new(),
            conditions: BTreeSet::new(),
        };
        let (mut open, mut seen) = (vec![next], BTreeSet::new());
        while let Some(value) = open.pop() {
            if !seen.insert(value) {
                continue;
            }
            if let Some(node) = node(func, value) {
                choices.nodes.push((value, node));
                match node {
                    Node::Select(condition, args) => {
                        choices.conditions.insert(condition);
                        open.extend(args);
                    }
                    Node::Sum(of) => open.push(of),
                }
            } else {
                choices.ends.insert(value, end(func, load, value)?);
            }
            if choices.conditions.len() > MAX_CONDITIONS {
                return None;
            }
        }
        let block = &func.block(func.entry()).insts;
        let order = block
            .iter()
            .flat_map(|&inst| func.results_of(inst))
            .enumerate();
        let position: BTreeMap<Value, usize> =
            order.map(|(index, &value)| (value, index)).collect();
        choices.nodes.sort_by_key(|(value, _)| position[value]);
        choices
            .ways()
            .map(|way| way.map(drop))
            .collect::<Option<()>>()?;
        Some(choices)
    }

    /// Every way through the conditions; `None` for one that counts twice.
    fn ways(&self) -> impl Iterator<Item = Option<Way>> + '_ {
        (0..1u32 << self.conditions.len()).map(|bits| {
            let numbered = self.conditions.iter().enumerate();
            let conditions =
                numbered.map(|(index, &condition)| (condition, bits >> index & 1 == 1));
            self.way(conditions.collect())
        })
    }

    fn way(&self, conditions: BTreeMap<Value, bool>) -> Option<Way> {
        let mut steps = self.ends.clone();
        for (value, node) in &self.nodes {
            let step = match node {
                Node::Select(condition, [yes, no]) => {
                    steps[if conditions[condition] { yes } else { no }]
                }
                Node::Sum(of) => match steps[of] {
                    Step::Keep => Step::Count,
                    Step::Set(k) => Step::Set(k.checked_add(1)?),
                    // Taken or not, a sum of a sum is no counter that counts by one.
                    Step::Count => return None,
                },
            };
            steps.insert(*value, step);
        }
        Some(Way {
            next: steps[&self.next],
            conditions,
            steps,
        })
    }
}

fn node(func: &Function, value: Value) -> Option<Node> {
    match func.def_inst(value)? {
        InstData::Select { cond, args } => Some(Node::Select(*cond, *args)),
        InstData::Binary {
            op: BinaryOp::Add,
            args: [a, b],
        } => match (func.constant(*a), func.constant(*b)) {
            (Some(1), None) => Some(Node::Sum(*b)),
            (None, Some(1)) => Some(Node::Sum(*a)),
            _ => None,
        },
        _ => None,
    }
}

fn end(func: &Function, load: Value, value: Value) -> Option<Step> {
    match func.def_inst(value) {
        _ if value == load => Some(Step::Keep),
        Some(InstData::Const { ty, bits }) if ty.signed(*bits) >= 0 => {
            Some(Step::Set(ty.signed(*bits)))
        }
        _ => None,
    }
}

/// Lets the counter stop: `x + 1` becomes `x >= top ? x : x + 1`, and it is never at the
/// largest number.
fn apply(func: &mut Function, form: &ScanForm, counter: &Counter) {
    let (mut editor, insts) = BlockEditor::new(func, form.block);
    let mut stopped = std::collections::HashMap::new();
    for inst in insts {
        let value = editor.func.results_of(inst).first().copied();
        editor.set_origin(editor.func.origin(inst));
        match value {
            Some(value) if counter.at_max.contains_key(&value) => {
                let never = counter.at_max[&value].outcome(0);
                let data = InstData::Const {
                    ty: Type::I1,
                    bits: u64::from(never),
                };
                *editor.func.inst_mut(inst) = data;
                editor.keep(inst);
            }
            Some(value) if counter.summand(value).is_some() => {
                let of = counter.summand(value).expect("just seen");
                editor.keep(inst);
                let stop = editor.compare_constant(CompareOp::Sge, of, counter.top);
                let ty = editor.func.value_type(value);
                let bounded = editor.value(
                    InstData::Select {
                        cond: stop,
                        args: [of, value],
                    },
                    ty,
                );
                stopped.insert(value, bounded);
            }
            _ => {
                editor
                    .func
                    .inst_mut(inst)
                    .map_values(|v| stopped.get(&v).copied().unwrap_or(v));
                editor.keep(inst);
            }
        }
    }
    editor.finish();
}
