//! Which values are known to lie at which places, inside one block.
//!
//! Places that overlap are found without comparing all with all. Static places are kept by their
//! scalar, with the bits of it that are known; a place with index values may overlap anything, so
//! storing to one forgets its whole root, as do copies and clears. References may alias each other and the state.
//! A value may be too old to be of use: then it is as if it were not known.

use iecc_ir::{Index, Place, Projection, Root, Value};
use std::collections::HashMap;

/// Values at places.
#[derive(Debug)]
pub(super) struct Available {
    roots: HashMap<Root, Known>,
    /// Instructions so far.
    now: usize,
    /// How many instructions ago a value may have been found.
    memory: usize,
}

#[derive(Debug, Default)]
struct Known {
    scalars: HashMap<Place, Vec<(Option<u32>, Found)>>,
    dynamic: HashMap<Place, Found>,
}

/// A value, and when it was found.
#[derive(Debug, Clone, Copy)]
struct Found {
    value: Value,
    at: usize,
}

impl Available {
    /// Nothing is known; what is found will be of use for so many instructions.
    pub(super) fn new(memory: usize) -> Self {
        Self {
            roots: HashMap::new(),
            now: 0,
            memory,
        }
    }

    /// One more instruction begins.
    pub(super) fn next(&mut self) {
        self.now += 1;
    }

    /// The value at a place, if known.
    pub(super) fn get(&self, place: &Place) -> Option<Value> {
        let known = self.roots.get(&place.root)?;
        let found = if place.is_static() {
            let (scalar, bit) = split_bit(place);
            let values = known.scalars.get(&scalar)?;
            let same = values.iter().find(|(known_bit, _)| *known_bit == bit);
            same.map(|(_, found)| found)?
        } else {
            known.dynamic.get(place)?
        };
        (self.now - found.at <= self.memory).then_some(found.value)
    }

    /// A place was found to hold a value.
    pub(super) fn loaded(&mut self, place: &Place, value: Value) {
        let at = self.now;
        let found = Found { value, at };
        let known = self.roots.entry(place.root).or_default();
        if place.is_static() {
            let (scalar, bit) = split_bit(place);
            let values = known.scalars.entry(scalar).or_default();
            match values.iter_mut().find(|(known_bit, _)| *known_bit == bit) {
                Some((_, old)) => *old = found,
                None => values.push((bit, found)),
            }
        } else {
            known.dynamic.insert(place.clone(), found);
        }
    }

    /// A place was given a value. Where an index is outside, a load gives 0 and not what was
    /// stored, so places with index values are not remembered. `changed` comes first.
    pub(super) fn stored(&mut self, place: &Place, value: Value) {
        if place.is_static() {
            self.loaded(place, value);
        }
    }

    /// A place may hold anything now.
    pub(super) fn changed(&mut self, place: &Place) {
        self.forget_aliases(place.root);
        let Some(known) = self.roots.get_mut(&place.root) else {
            return;
        };
        known.dynamic.clear();
        if !place.is_static() {
            known.scalars.clear();
            return;
        }
        let (scalar, bit) = split_bit(place);
        if let Some(values) = known.scalars.get_mut(&scalar) {
            // Another bit of the word stays; the word itself does not.
            values.retain(|(other, _)| bit.is_some() && other.is_some() && *other != bit);
        }
    }

    /// All that lies at a place may be anything now.
    pub(super) fn all_changed(&mut self, place: &Place) {
        self.forget_aliases(place.root);
        self.roots.remove(&place.root);
    }

    /// Anything but the inputs, and locals that are not passed, may hold anything now.
    pub(super) fn called(&mut self, refs: &[Place]) {
        self.roots.retain(|root, _| match root {
            Root::Input => true,
            Root::Local(_) => refs.iter().all(|place| place.root != *root),
            Root::State | Root::Output | Root::Ref(_) | Root::Deref { .. } => false,
        });
    }

    fn forget_aliases(&mut self, root: Root) {
        if root.may_alias() {
            self.roots
                .retain(|&other, _| other == root || !other.may_alias());
        }
    }
}

/// A static place without its bit, and the bit.
fn split_bit(place: &Place) -> (Place, Option<u32>) {
    match place.path.split_last() {
        Some((Projection::Bit(Index::Const(bit)), rest)) => {
            let path = rest.to_vec();
            let root = place.root;
            (Place { root, path }, Some(*bit))
        }
        _ => (place.clone(), None),
    }
}
