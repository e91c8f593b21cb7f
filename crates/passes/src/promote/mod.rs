//! Promotion: scalars of memory become values for the length of a function.
//!
//! Copies and clears of few scalars, or of locals, become loads and stores first.
//!
//! After it, a promoted scalar is loaded once, at the entry, and only if its old value is needed;
//! and stored once, at the only return, and only if it was written to; in machine code, at the end of
//! the entry if nothing but a return can come and only the entry wrote to it. Nothing is stored on the
//! way to a fault, which leaves memory as it was before the scan. Bits of a promoted word are taken
//! and put by shifts and masks.
//!
//! What is promoted: static scalars that nothing else in the function may overlap, no index value,
//! `elapsed`, reference or callee; outputs only if every way to the return stores them, since their
//! old value cannot be loaded. References may be the same as each other and lie in the state, so
//! a function that uses two of these roots promotes neither. Nor is a reference that may be to nothing
//! promoted where it is stored to. A scalar of a local is 0 at the entry and never stored back, so
//! there is no limit to how many are promoted.

mod candidates;
mod expand;
mod rename;
mod summary;

use crate::references::References;
use crate::rewrite::{join_returns, remove_unreachable};
use candidates::Candidates;
use iecc_ir::{Function, MemType, Module, Place, PlaceType, Root, Type, TypeTable};
use summary::Summaries;

/// How many scalars a function may hold in values for machine code: with more, loads and stores
/// where they are needed are cheaper than all of them at the entry and the return.
const FEW: usize = 48;

/// Promotes what can be promoted in every function.
pub(crate) fn promote(module: &mut Module) {
    run(module, usize::MAX, expand::ALL, false);
}

/// Promotes in functions that touch few scalars.
pub(crate) fn promote_few(module: &mut Module) {
    run(module, FEW, expand::FEW, true);
}

/// A scalar that becomes a variable.
#[derive(Debug)]
struct Promoted {
    /// Without a bit, but for outputs, whose bits are variables of their own.
    place: Place,
    ty: Type,
    is_stored: bool,
}

impl Promoted {
    fn is_local(&self) -> bool {
        matches!(self.place.root, Root::Local(_))
    }
}

fn run(module: &mut Module, limit: usize, expansion: expand::Limits, store_early: bool) {
    expand::expand(module, expansion);
    let summaries = Summaries::of(module);
    let regions = [
        (Root::State, module.state),
        (Root::Input, module.input),
        (Root::Output, module.output),
    ];
    let references = References::of(module);
    let has_addresses = module.has_addresses();
    for (id, func) in module.funcs.iter_mut() {
        remove_unreachable(func);
        let types = &module.types;
        let type_of = |func: &Function, place: &Place| {
            let region = regions.iter().find(|(root, _)| *root == place.root);
            let start = match (region, place.root) {
                (_, Root::Ref(param)) => func.refs[param].ty,
                (_, Root::Local(local)) => func.locals[local].ty,
                (_, Root::Deref { ty, .. }) => ty,
                (Some(&(_, id)), _) => MemType::Struct(id),
                (None, _) => panic!("every root is a region or a reference"),
            };
            scalar_type(types, start, place)
        };
        let certain = |root| references.certain(id, root);
        let mut promoted = Candidates::of(func, &summaries).promoted(func, &certain, &type_of);
        if has_addresses {
            // Any byte may have been put there, and storing what was loaded makes a bit of it.
            promoted.retain(|p| p.ty != Type::I1 || !p.place.root.may_alias());
        }
        let others = promoted.iter().filter(|p| !p.is_local()).count();
        if others > limit {
            promoted.retain(Promoted::is_local);
        } else if others > 0 {
            join_returns(func);
        }
        if !promoted.is_empty() {
            rename::rename(func, &promoted, store_early);
        }
    }
}

fn scalar_type(types: &TypeTable, start: MemType, place: &Place) -> Type {
    Place::walk(types, start, &place.path)
        .and_then(PlaceType::scalar)
        .expect("accesses are of scalars")
}
