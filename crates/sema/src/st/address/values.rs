//! Values at addresses: the way to them, whether a type fits, and what they hold at the start.

use super::Address;
use super::layout::Class;
use crate::hir::{self, Step, Type};
use crate::st::analysis::Analysis;
use crate::st::signature::{Spot, Storage, UnitId};
use crate::st::storage::steps_in_bytes;
use crate::st::types::TypeId;
use iecc_ast::st;
use iecc_diag::Code;
use iecc_source::Span;

impl Analysis<'_> {
    /// Whether anything is known at an address.
    pub(crate) fn is_used(&self, address: Address) -> bool {
        self.cluster_of(address).is_some()
    }

    /// The way to a value of a type at an address; `None` where it cannot be reached that way.
    pub(crate) fn spot(&mut self, address: Address, ty: TypeId) -> Option<Spot> {
        let storage = self.storage(ty);
        let (class, _) = self.class(storage);
        let cluster = self.cluster_of(address)?;
        let tag = cluster.tag;
        if let Some(plain) = cluster.plain {
            let steps = match (plain, class) {
                (Class::Whole(whole), Class::Bool | Class::Int | Class::Real) => {
                    let (offset, bits) = (address.first - cluster.first, self.width(storage));
                    self.part_of(whole, offset, bits, class == Class::Real)?
                }
                _ if plain == class => Vec::new(),
                _ => return None,
            };
            return Some(Spot { tag, steps });
        }
        let first = (address.first - cluster.first) as u32;
        let Type::Elementary(of) = storage else {
            return None;
        };
        let steps = steps_in_bytes(first, of);
        Some(Spot { tag, steps })
    }

    /// Says that the value at an address starts with something else than 0.
    pub(crate) fn set_initial(&mut self, address: Address, init: hir::InitId, span: Span) {
        let Some(cluster) = self.cluster_of(address) else {
            return;
        };
        let (tag, start) = (cluster.tag, cluster.first);
        match (cluster.plain, self.hir.inits.get(init)) {
            (Some(Class::Whole(whole)), hir::code::Init::Bits(bits)) => {
                let bits = *bits;
                let part = [false, true].into_iter().find_map(|real| {
                    self.part_of(whole, address.first - start, address.bits, real)
                });
                let spot = part.map(|steps| Spot { tag, steps });
                match spot.and_then(|spot| crate::st::config::place_of(&spot)) {
                    Some(place) => self.hir.tags[tag.index()].initial.push((place.path, bits)),
                    None => self.no_initial(span),
                }
                return;
            }
            (Some(_), _) => {
                self.hir.tags[tag.index()].init = Some(init);
                return;
            }
            (None, _) => {}
        }
        let hir::code::Init::Bits(bits) = *self.hir.inits.get(init) else {
            return self.no_initial(span);
        };
        let byte = ((address.first - start) / 8) as u32;
        let initial = &mut self.hir.tags[tag.index()].initial;
        if address.bits == 1 {
            let bit = Step::Bit((address.first % 8) as u32);
            initial.push((vec![Step::Index(byte), bit], bits));
            return;
        }
        for index in 0..(address.bits / 8) as u32 {
            let value = (bits >> (8 * index)) & 0xFF;
            initial.push((vec![Step::Index(byte + index)], value));
        }
    }

    fn no_initial(&mut self, span: Span) {
        let message = "this initial value at addresses that overlap is not compiled yet";
        self.error(Code::E2010, span, message);
    }

    /// Checks that a type fits an address.
    pub(crate) fn fits_address(
        &mut self,
        unit: UnitId,
        location: st::Id<st::Expr>,
        address: Address,
        ty: TypeId,
    ) -> bool {
        if ty == TypeId::ERROR {
            return true;
        }
        let mut of = self.storage(ty);
        while let Type::Array(id) = of {
            of = self.hir.types.array_def(id).element;
        }
        let fits = match of {
            Type::Struct(_) | Type::Array(_) => true,
            Type::Elementary(_) => self.width(of) == address.bits,
        };
        if !fits {
            let span = self.span(unit, self.unit(unit).arena[location].range);
            let text = address.text();
            let name = self.type_name(ty);
            let bits = self.width(of);
            let message = format!("{text} has {} bits but {name} has {bits}", address.bits);
            self.error(Code::E2022, span, message);
        }
        fits
    }

    /// Initial values of variables of units that stand at addresses.
    pub(crate) fn located_initials(&mut self) {
        for index in 0..self.pous.len() {
            for position in 0..self.pous[index].vars.len() {
                let var = self.pous[index].vars[position].clone();
                let Storage::Located(address) = var.storage else {
                    continue;
                };
                let init = match var.initial {
                    Some(initial) => self.initial_value(initial, var.ty),
                    None => self.default_init(var.ty),
                };
                if let Some(init) = init {
                    let span = self.span(self.pous[index].unit, var.range);
                    self.set_initial(address, init, span);
                }
            }
        }
    }
}
