//! Units with open arrays that nothing calls.
//!
//! A unit with `ARRAY[*]` has a body for each type of array that it is called with. One that is never
//! called is checked once, for arrays with so many elements that no subscript a body names is
//! outside. The code made for that is dropped.

use super::analysis::Analysis;
use super::signature::{Bindings, PouId};
use super::storage::MAX_ELEMENTS;
use super::types::{TypeId, TypeKind};
use iecc_ast::st::PouKind;
use std::collections::BTreeSet;

impl Analysis<'_> {
    /// Checks the bodies of the user that no call has needed.
    pub(crate) fn check_uncalled(&mut self) {
        let called: BTreeSet<PouId> = self.instances.keys().map(|(of, _)| *of).collect();
        let units = (0..self.pous.len() as u32).map(PouId);
        let uncalled: Vec<PouId> = units
            .filter(|id| !called.contains(id) && self.is_open_to_the_user(*id))
            .collect();
        let (mark, mut next) = (self.wanted.len(), self.wanted.len());
        for id in uncalled {
            let bindings = self.wide_bindings(id);
            let made = self.instance(id, bindings);
            self.want(made);
        }
        // What of the user's these call, and nobody else does, is looked at as well.
        while next < self.wanted.len() {
            let id = self.wanted[next];
            if self.is_written_by_the_user(id) {
                self.body(id);
            }
            next += 1;
        }
        self.drop_wanted(mark);
    }

    /// Whether a body is one of a source, not made to choose another or for what extends its own.
    fn is_written_by_the_user(&self, id: PouId) -> bool {
        let pou = self.pous.get(id.index());
        pou.is_some_and(|pou| !self.is_library(pou.unit) && pou.receiver.is_none())
    }

    /// Whether it is a unit of the user with open arrays, as it is written.
    fn is_open_to_the_user(&self, id: PouId) -> bool {
        let pou = self.pou(id);
        let home = pou.owner.unwrap_or(id);
        let written = pou.template.is_none() && pou.receiver.is_none();
        written
            && !self.is_library(pou.unit)
            && self.pou(home).kind != PouKind::Interface
            && self.has_open_arrays(id)
    }

    fn wide_bindings(&mut self, id: PouId) -> Bindings {
        let mut bindings = Bindings::default();
        for var in self.pou(id).vars.clone() {
            if let TypeKind::OpenArray {
                dimensions,
                element,
            } = *self.types.base(var.ty)
            {
                let ty = self.wide_array(dimensions, element);
                bindings.open.push((var.name, ty));
            }
        }
        bindings
    }

    fn wide_array(&mut self, dimensions: u32, element: TypeId) -> TypeId {
        let reach = reach(dimensions);
        let dimensions = vec![(-reach, reach); dimensions as usize];
        self.types.intern(TypeKind::Array {
            dimensions: dimensions.into(),
            element,
        })
    }
}

/// The largest subscript for which an array from its negative on has not too many elements.
fn reach(dimensions: u32) -> i64 {
    let fits = |reach: u64| {
        let elements = (2 * reach + 1).checked_pow(dimensions);
        elements.is_some_and(|elements| elements <= MAX_ELEMENTS)
    };
    let mut reach = MAX_ELEMENTS;
    while !fits(reach) {
        reach /= 2;
    }
    reach as i64
}

#[cfg(test)]
mod tests {
    use super::reach;

    #[test]
    fn arrays_of_many_dimensions_stay_within_the_limit() {
        // 2 * 67,108,864 + 1 elements are at most 2^28, and 16,385 squared is more than that.
        assert_eq!(reach(1), 1 << 26);
        assert_eq!(reach(2), 1 << 12);
        assert_eq!(reach(40), 0);
    }
}
