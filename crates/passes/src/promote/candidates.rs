//! Which scalars of a function can be promoted.

use super::Promoted;
use super::summary::Summaries;
use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::Cfg;
use iecc_ir::{Block, Function, Index, InstData, Place, Projection, Root, Terminator, Type, Value};
use std::collections::{BTreeMap, BTreeSet};

/// What a function accesses.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    /// Scalars, and whether they are stored to.
    scalars: BTreeMap<Place, bool>,
    /// Places that are accessed in other ways. Index values are blurred, so that there are few.
    blockers: BTreeSet<Place>,
    /// Roots that are accessed and may be the same memory.
    aliases: BTreeSet<Root>,
    /// A callee stores outputs.
    outputs_blocked: bool,
}

impl Candidates {
    /// Collects the accesses of a function.
    pub(super) fn of(func: &Function, summaries: &Summaries) -> Self {
        let mut candidates = Self::default();
        let blocks = func.layout.iter().map(|&block| func.block(block));
        for &inst in blocks.flat_map(|block| &block.insts) {
            match func.inst(inst) {
                InstData::Load { place } => candidates.access(place, false),
                InstData::Store { place, .. } => candidates.access(place, true),
                InstData::Elapsed { place, .. } => candidates.block(place),
                InstData::Copy { to, from } => {
                    candidates.block(to);
                    candidates.block(from);
                }
                InstData::Clear { place } => candidates.block(place),
                InstData::Call { func, refs, .. } => {
                    refs.iter().for_each(|place| candidates.block(place));
                    let touched = summaries.call(*func);
                    candidates.outputs_blocked |= touched.outputs;
                    if touched.whole_state {
                        candidates.block(&Place::root(Root::State));
                    }
                    for &field in &touched.state {
                        candidates.block(&Place::root(Root::State).field(field));
                    }
                }
                _ => {}
            }
        }
        candidates
    }

    fn access(&mut self, place: &Place, is_store: bool) {
        match variable_place(place) {
            Some(scalar) => {
                self.note_root(scalar.root);
                *self.scalars.entry(scalar).or_default() |= is_store;
            }
            None => self.block(place),
        }
    }

    fn block(&mut self, place: &Place) {
        self.note_root(place.root);
        let mut blurred = place.clone();
        // Any value will do: places with index values are only asked whether they overlap.
        blurred.values_mut().for_each(|v| *v = Value::from_u32(0));
        self.blockers.insert(blurred);
    }

    fn note_root(&mut self, root: Root) {
        if root.may_alias() {
            self.aliases.insert(root);
        }
    }

    /// The scalars to promote, in the order of places.
    pub(super) fn promoted(
        mut self,
        func: &Function,
        certain: &dyn Fn(Root) -> bool,
        type_of: &dyn Fn(&Function, &Place) -> Type,
    ) -> Vec<Promoted> {
        self.drop_blocked();
        self.scalars
            .retain(|place, is_stored| !*is_stored || certain(place.root));
        if self.aliases.len() > 1 {
            self.scalars.retain(|place, _| !place.root.may_alias());
        }
        self.drop_outputs(func);
        let promoted = self.scalars.into_iter().map(|(place, is_stored)| Promoted {
            ty: type_of(func, &place),
            place,
            is_stored,
        });
        promoted.collect()
    }

    /// Scalars that lie under the static beginning of a blocker stand together in the order of
    /// places, so only these are compared with it.
    fn drop_blocked(&mut self) {
        for blocker in &self.blockers {
            let dynamic = |step: &Projection| {
                matches!(
                    step,
                    Projection::Index(Index::Value(_)) | Projection::Bit(_)
                )
            };
            let end = blocker.path.iter().position(dynamic);
            let prefix = Place {
                root: blocker.root,
                path: blocker.path[..end.unwrap_or(blocker.path.len())].to_vec(),
            };
            let under = self.scalars.range(prefix.clone()..).map(|(place, _)| place);
            let blocked: Vec<Place> = under
                .take_while(|p| p.root == prefix.root && p.path.starts_with(&prefix.path))
                .filter(|place| place.may_overlap(blocker))
                .cloned()
                .collect();
            for place in blocked {
                self.scalars.remove(&place);
            }
        }
    }

    fn drop_outputs(&mut self, func: &Function) {
        let is_output = |place: &Place| place.root == Root::Output;
        if self.outputs_blocked {
            self.scalars.retain(|place, _| !is_output(place));
        }
        // A word that is also stored bit by bit stands right before its bits.
        let outputs: Vec<&Place> = self.scalars.keys().filter(|p| is_output(p)).collect();
        let mixed: BTreeSet<Place> = outputs
            .iter()
            .filter(|word| {
                let next = self.scalars.range((**word).clone()..).nth(1);
                next.is_some_and(|(next, _)| next.may_overlap(word))
            })
            .map(|word| (*word).clone())
            .collect();
        self.scalars
            .retain(|place, _| !mixed.iter().any(|word| place.may_overlap(word)));
        let outputs: Vec<Place> = self
            .scalars
            .keys()
            .filter(|p| is_output(p))
            .cloned()
            .collect();
        if !outputs.is_empty() {
            let always = always_stored(func, &outputs);
            for (place, always) in outputs.iter().zip(always) {
                if !always {
                    self.scalars.remove(place);
                }
            }
        }
    }
}

/// The scalar whose variable a place belongs to: outputs have one for each bit, as their other
/// bits cannot be loaded. `None` if the place has an index value other than its bit.
pub(super) fn variable_place(place: &Place) -> Option<Place> {
    let mut scalar = place.clone();
    if place.root != Root::Output && matches!(place.path.last(), Some(Projection::Bit(_))) {
        scalar.path.pop();
    }
    scalar.is_static().then_some(scalar)
}

/// For each place, whether every way to a return stores it.
fn always_stored(func: &Function, places: &[Place]) -> Vec<bool> {
    let cfg = Cfg::new(func);
    let position: BTreeMap<&Place, usize> = places.iter().zip(0..).collect();
    let words = places.len().div_ceil(64);
    // Optimistic: all stored, until a way is found that does not.
    let mut stored_at_end: SecondaryMap<Block, Vec<u64>> =
        SecondaryMap::with_default(vec![u64::MAX; words]);
    let mut own = SecondaryMap::with_default(vec![0u64; words]);
    for &block in cfg.reverse_postorder() {
        own[block] = stored_in(func, block, &position, words);
    }
    let mut changed = true;
    while changed {
        changed = false;
        for &block in cfg.reverse_postorder() {
            let mut stored = stored_at_start(&cfg, func, block, &stored_at_end, words);
            stored
                .iter_mut()
                .zip(&own[block])
                .for_each(|(a, b)| *a |= b);
            if stored_at_end[block] != stored {
                stored_at_end[block] = stored;
                changed = true;
            }
        }
    }
    let returns = cfg.reverse_postorder().iter();
    let returns = returns.filter(|&&b| matches!(func.terminator(b), Terminator::Return(_)));
    let at_return = returns.fold(vec![u64::MAX; words], |all, &b| {
        meet(all, &stored_at_end[b])
    });
    (0..places.len())
        .map(|index| at_return[index / 64] >> (index % 64) & 1 == 1)
        .collect()
}

fn stored_in(
    func: &Function,
    block: Block,
    position: &BTreeMap<&Place, usize>,
    words: usize,
) -> Vec<u64> {
    let mut stored = vec![0; words];
    for &inst in &func.block(block).insts {
        if let InstData::Store { place, .. } = func.inst(inst)
            && let Some(&index) = position.get(place)
        {
            stored[index / 64] |= 1 << (index % 64);
        }
    }
    stored
}

fn stored_at_start(
    cfg: &Cfg,
    func: &Function,
    block: Block,
    stored_at_end: &SecondaryMap<Block, Vec<u64>>,
    words: usize,
) -> Vec<u64> {
    if block == func.entry() {
        return vec![0; words];
    }
    let predecessors = cfg.predecessors(block).iter();
    predecessors.fold(vec![u64::MAX; words], |all, &from| {
        meet(all, &stored_at_end[from])
    })
}

fn meet(mut all: Vec<u64>, other: &[u64]) -> Vec<u64> {
    all.iter_mut().zip(other).for_each(|(a, b)| *a &= b);
    all
}
