//! Values at addresses: the way to them, whether a type fits, and what they hold at the start.

use super::Address;
use super::layout::Class;
use crate::hir::code::{Init, PathStep};
use crate::hir::{self, Elementary, Step, Type};
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
        let bytes = ((cluster.end - cluster.first) / 8) as u32;
        if !self.lies_in_bytes(storage, first) {
            return None;
        }
        let steps = self.shared_steps(first, bytes, ty);
        Some(Spot { tag, steps })
    }

    /// Whether a type is numbers whose bytes others may share.
    fn lies_in_bytes(&self, ty: Type, first: u32) -> bool {
        let Type::Array(id) = ty else {
            return matches!(ty, Type::Elementary(_));
        };
        let (mut element, mut nested) = (self.hir.types.array_def(id).element, false);
        while let Type::Array(inner) = element {
            (element, nested) = (self.hir.types.array_def(inner).element, true);
        }
        match element {
            Type::Elementary(Elementary::Bool) => !nested && first.is_multiple_of(8),
            Type::Elementary(_) => true,
            Type::Array(_) | Type::Struct(_) => false,
        }
    }

    /// Says what the value of a type at an address starts with.
    pub(crate) fn set_initial(
        &mut self,
        address: Address,
        ty: TypeId,
        init: hir::InitId,
        span: Span,
    ) {
        // What has no place there was reported where it is declared.
        let Some(spot) = self.spot(address, ty) else {
            return;
        };
        let (tag, storage) = (spot.tag.index(), self.storage(ty));
        if spot.steps.is_empty() {
            self.hir.tags[tag].init = Some(init);
            return;
        }
        let mut made = Vec::new();
        let plain = match (storage, spot.steps.last()) {
            (Type::Array(_), Some(PathStep::Bytes { offset, .. })) => {
                self.leaves_in_bytes(storage, u64::from(*offset) * 8, Some(init), &mut made)
            }
            _ => match self.hir.inits.get(init) {
                Init::Zero => leaves(&spot.steps, 0, &mut made),
                Init::Bits(bits) => leaves(&spot.steps, *bits, &mut made),
                Init::Address(_) | Init::Struct(_) | Init::Array(_) => false,
            },
        };
        if !plain {
            let message = "a reference at an address that others overlap starts as NULL";
            self.error(Code::E2008, span, message);
        }
        self.hir.tags[tag].initial.extend(made);
    }

    /// The leaves of numbers from a bit of an array of bytes; whether there are only numbers.
    fn leaves_in_bytes(
        &self,
        ty: Type,
        first: u64,
        init: Option<hir::InitId>,
        made: &mut Vec<(Vec<Step>, u64)>,
    ) -> bool {
        let init = init.map(|init| self.hir.inits.get(init));
        match (ty, init) {
            (Type::Elementary(of), None | Some(Init::Zero)) => {
                leaves(&steps_in_bytes(first as u32, of), 0, made)
            }
            (Type::Elementary(of), Some(Init::Bits(bits))) => {
                leaves(&steps_in_bytes(first as u32, of), *bits, made)
            }
            (Type::Array(id), Some(Init::Array(runs))) => {
                let element = self.hir.types.array_def(id).element;
                let width = self.width(element);
                runs.iter().all(|&(from, count, value)| {
                    (from..from + count).all(|index| {
                        let first = first + u64::from(index) * width;
                        self.leaves_in_bytes(element, first, Some(value), made)
                    })
                })
            }
            (Type::Array(_), None | Some(Init::Zero)) => true,
            (_, Some(_)) | (Type::Struct(_), None) => false,
        }
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
                    self.set_initial(address, var.ty, init, span);
                }
            }
        }
    }
}

/// Adds the leaves that hold a number, which may be some bits of one or several bytes.
fn leaves(steps: &[PathStep], value: u64, made: &mut Vec<(Vec<Step>, u64)>) -> bool {
    let mut path: Vec<Step> = Vec::new();
    for step in steps {
        match *step {
            PathStep::Field(field) => path.push(Step::Field(field)),
            PathStep::Index(index) => path.push(Step::Index(index)),
            PathStep::Bits { first, count } => {
                let bits = (0..count).map(|bit| (Step::Bit(first + bit), (value >> bit) & 1));
                made.extend(bits.map(|(step, value)| ([&path[..], &[step]].concat(), value)));
                return true;
            }
            PathStep::Bytes { offset, ty } => {
                let bytes = (0..ty.bits() / 8)
                    .map(|byte| (Step::Index(offset + byte), (value >> (8 * byte)) & 0xFF));
                made.extend(bytes.map(|(step, value)| ([&path[..], &[step]].concat(), value)));
                return true;
            }
            PathStep::IndexBy { .. } | PathStep::Character { .. } => {
                panic!("addresses are constant")
            }
        }
    }
    made.push((path, value));
    true
}
