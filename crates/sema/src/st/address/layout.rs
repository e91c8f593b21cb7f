//! Which addresses of a program lie on the same bytes, and the tags and points made of them.
//!
//! Uses that overlap are a cluster. Its tag is what all of them are, else a structure or array with all
//! others in its elements, else an array of bytes.

use super::{Address, letter};
use crate::hir::{Elementary, IoPoint, Place, Step, TagId, Type, View};
use crate::st::analysis::Analysis;
use crate::st::elementary::El;
use crate::st::signature::{Spot, UnitId};
use crate::st::types::TypeId;
use iecc_ast::st::{self, Area, ExprKind, UnitKind};
use iecc_diag::Diagnostics;
use std::collections::{BTreeMap, HashSet};

/// Overlapping bytes whose bits have names; those of more have none.
const MAX_NAMED_BYTES: u64 = 4096;

/// What is stored at an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    Bool,
    Int,
    Real,
    /// A structure or an array.
    Whole(Type),
}

/// One use of an address.
#[derive(Debug, Clone, Copy)]
struct Use {
    first: u64,
    bits: u64,
    class: Class,
    ty: Type,
    view: View,
    name: Option<iecc_ast::Symbol>,
}

/// Bits that belong together.
#[derive(Debug)]
pub(super) struct Cluster {
    pub(super) first: u64,
    pub(super) end: u64,
    pub(super) tag: TagId,
    /// What it is as one tag; `None` for bytes.
    pub(super) plain: Option<Class>,
}

/// Where every address of the program lies.
#[derive(Debug, Default)]
pub(crate) struct Addresses {
    areas: BTreeMap<u8, Vec<Cluster>>,
}

fn key(area: Area) -> u8 {
    match area {
        Area::Input => 0,
        Area::Output => 1,
        Area::Memory => 2,
    }
}

impl Analysis<'_> {
    /// Looks at all addresses of the user's units, and makes their tags.
    pub(crate) fn lay_out_addresses(&mut self) {
        let mut uses: BTreeMap<u8, Vec<Use>> = BTreeMap::new();
        for index in self.first_user_unit..self.units.len() as u32 {
            self.uses_of(UnitId(index), &mut uses);
        }
        for (area, mut uses) in uses {
            // Those that have a name come first.
            uses.sort_by_key(|one| (one.first, one.name.is_none()));
            let mut group: Vec<Use> = Vec::new();
            let mut end = 0;
            for one in uses {
                if !group.is_empty() && one.first >= end {
                    let whole = std::mem::take(&mut group);
                    self.cluster(area, &whole, end);
                }
                end = if group.is_empty() {
                    one.first + one.bits
                } else {
                    end.max(one.first + one.bits)
                };
                group.push(one);
            }
            if !group.is_empty() {
                self.cluster(area, &group, end);
            }
        }
    }

    fn uses_of(&mut self, id: UnitId, uses: &mut BTreeMap<u8, Vec<Use>>) {
        let unit = self.unit(id);
        let located = match unit.kind {
            UnitKind::Pou(_)
            | UnitKind::Configuration(_)
            | UnitKind::Globals(_)
            | UnitKind::Test(_) => true,
            UnitKind::Types { .. } | UnitKind::Using(_) | UnitKind::Nothing | UnitKind::Error => {
                false
            }
        };
        let mut places: HashSet<usize> = HashSet::new();
        for config in unit.arena.all::<st::InstanceConfig>() {
            places.extend(config.location.map(st::Id::index));
        }
        for decl in unit.arena.all::<st::VarDecl>() {
            let Some(location) = decl.location else {
                continue;
            };
            places.insert(location.index());
            let ExprKind::Direct(direct) = unit.arena[location].kind else {
                continue;
            };
            if let (true, Ok(Some(address))) = (located, self.read_address(id, direct)) {
                let made = self.use_of(id, decl, address);
                uses.entry(key(address.area)).or_default().push(made);
            }
        }
        for (index, expr) in unit.arena.all::<st::Expr>().iter().enumerate() {
            if let ExprKind::Direct(direct) = expr.kind
                && !places.contains(&index)
                && let Ok(Some(address)) = self.read_address(id, direct)
            {
                let ty = address.plain_type();
                let made = self.typed_use(address, ty, None);
                uses.entry(key(address.area)).or_default().push(made);
            }
        }
    }

    /// The use a declaration makes. Messages about its type come when it is compiled.
    fn use_of(&mut self, unit: UnitId, decl: &st::VarDecl, address: Address) -> Use {
        let name = self.unit(unit).arena[decl.names].first().map(|n| n.name);
        let kind = self.unit(unit).arena[decl.ty].kind;
        let simple = matches!(kind, st::TypeKind::Named(_) | st::TypeKind::Array { .. });
        let mut ty = address.plain_type();
        if simple {
            let kept = std::mem::replace(&mut self.found, Diagnostics::new());
            let found = self.type_of_spec(self.global_scope(unit), decl.ty);
            self.found = kept;
            if found != TypeId::ERROR && self.types.instance(found).is_none() {
                ty = found;
            }
        }
        self.typed_use(address, ty, name)
    }

    fn typed_use(&mut self, address: Address, ty: TypeId, name: Option<iecc_ast::Symbol>) -> Use {
        let storage = self.storage(ty);
        let (class, bits) = self.class(storage);
        Use {
            first: address.first,
            bits: bits.max(address.bits),
            class,
            ty: storage,
            view: self.view(ty),
            name,
        }
    }

    pub(super) fn class(&self, ty: Type) -> (Class, u64) {
        match ty {
            Type::Elementary(Elementary::Bool) => (Class::Bool, 1),
            Type::Elementary(of @ (Elementary::Real | Elementary::Lreal)) => {
                (Class::Real, u64::from(of.bits()))
            }
            Type::Elementary(of) => (Class::Int, u64::from(of.bits())),
            Type::Struct(_) | Type::Array(_) => (Class::Whole(ty), self.width(ty)),
        }
    }

    /// How many bits a type takes at an address.
    pub(crate) fn width(&self, ty: Type) -> u64 {
        match ty {
            Type::Elementary(Elementary::Bool) => 1,
            Type::Elementary(of) => u64::from(of.bits()),
            Type::Array(id) => {
                let def = self.hir.types.array_def(id);
                u64::from(def.len).saturating_mul(self.width(def.element))
            }
            Type::Struct(id) => {
                let members = &self.hir.types.struct_def(id).members;
                members
                    .iter()
                    .fold(0u64, |sum, m| sum.saturating_add(self.width(m.ty)))
            }
        }
    }

    fn cluster(&mut self, area: u8, uses: &[Use], end: u64) {
        let first = uses[0];
        let area_of = [Area::Input, Area::Output, Area::Memory][usize::from(area)];
        let alike = uses
            .iter()
            .all(|one| (one.first, one.bits, one.class) == (first.first, first.bits, first.class));
        let cluster = if alike {
            let width = match first.class {
                Class::Whole(_) => 8,
                Class::Bool | Class::Int | Class::Real => first.bits,
            };
            let address = Address {
                area: area_of,
                first: first.first,
                bits: width,
            };
            self.plain_cluster(address, first, end)
        } else if let Some(whole) = self.whole_of(uses, first.first, end) {
            let address = Address {
                area: area_of,
                first: whole.first,
                bits: 8,
            };
            let cluster = self.plain_cluster(address, whole, end);
            self.name_parts(area_of, &cluster, uses);
            cluster
        } else {
            self.byte_cluster(area_of, first.first, end)
        };
        self.addresses.areas.entry(area).or_default().push(cluster);
    }

    /// The structure or array that all other uses are elements of, or lie in an element of.
    fn whole_of(&self, uses: &[Use], first: u64, end: u64) -> Option<Use> {
        let covers = |one: &&Use| (one.first, one.first + one.bits) == (first, end);
        let is_whole = |one: &&Use| matches!(one.class, Class::Whole(_));
        let whole = uses.iter().filter(covers).find(is_whole)?;
        let fits = |one: &Use| match one.class {
            Class::Whole(_) => one.class == whole.class && one.first == whole.first,
            Class::Bool | Class::Int | Class::Real => {
                let real = one.class == Class::Real;
                let part = self.part_of(whole.ty, one.first - first, one.bits, real);
                part.is_some()
            }
        };
        uses.iter().all(fits).then_some(*whole)
    }

    /// Addresses in a structure or array name their elements and bits.
    fn name_parts(&mut self, area: Area, cluster: &Cluster, uses: &[Use]) {
        let Some(Class::Whole(ty)) = cluster.plain else {
            return;
        };
        let mut named = HashSet::new();
        for one in uses {
            let address = Address {
                area,
                first: one.first,
                bits: one.bits,
            };
            let (offset, real) = (one.first - cluster.first, one.class == Class::Real);
            let part = match one.class {
                Class::Whole(_) => None,
                Class::Bool | Class::Int | Class::Real => self.part_of(ty, offset, one.bits, real),
            };
            let spot = part.map(|steps| Spot {
                tag: cluster.tag,
                steps,
            });
            let place = spot.and_then(|spot| crate::st::config::place_of(&spot));
            if let Some(place) = place.filter(|_| named.insert(address.text())) {
                self.hir.names.push((address.text(), place));
            }
        }
    }

    fn plain_cluster(&mut self, address: Address, of: Use, end: u64) -> Cluster {
        let text = address.text();
        let tag = self.add_tag(&text, of.ty, of.view, None, None);
        if address.bits == 1 {
            let short = text.replacen('X', "", 1);
            self.hir.names.push((short, Place::whole(tag)));
        }
        let name = of.name.map_or(text, |name| self.text(name).to_owned());
        self.address_points(address.area, &name, Place::whole(tag), of.ty);
        Cluster {
            first: of.first,
            end,
            tag,
            plain: Some(of.class),
        }
    }

    /// Points for what lies at an address.
    fn address_points(&mut self, area: Area, name: &str, place: Place, ty: Type) {
        match ty {
            Type::Elementary(_) => {
                let points = match area {
                    Area::Input => &mut self.hir.inputs,
                    Area::Output => &mut self.hir.outputs,
                    Area::Memory => return,
                };
                let taken = |point: &IoPoint| point.name.eq_ignore_ascii_case(name);
                let name = if points.iter().any(taken) {
                    self.hir.display(&place)
                } else {
                    name.to_owned()
                };
                let points = match area {
                    Area::Input => &mut self.hir.inputs,
                    Area::Output | Area::Memory => &mut self.hir.outputs,
                };
                points.push(IoPoint { name, place });
            }
            Type::Array(id) => {
                let def = self.hir.types.array_def(id);
                for index in 0..def.len {
                    let name = format!("{name}[{index}]");
                    let place = place.clone().step(Step::Index(index));
                    self.address_points(area, &name, place, def.element);
                }
            }
            Type::Struct(id) => {
                let members = self.hir.types.struct_def(id).members.clone();
                for (index, member) in (0..).zip(members) {
                    let name = format!("{name}.{}", member.name);
                    let place = place.clone().step(Step::Field(index));
                    self.address_points(area, &name, place, member.ty);
                }
            }
        }
    }

    /// The bytes of addresses that overlap.
    fn byte_cluster(&mut self, area: Area, first: u64, end: u64) -> Cluster {
        let (low, high) = (first / 8, end.div_ceil(8));
        let byte = Type::Elementary(Elementary::Usint);
        let ty = Type::Array(self.hir.types.array(byte, (high - low) as u32));
        let letter = letter(area);
        let name = format!("%{letter}B{low}..{}", high - 1);
        let view = self.view(TypeId::of(El::Byte));
        let tag = self.add_tag(&name, ty, view, None, None);
        for at in low..high {
            let place = Place::whole(tag).step(Step::Index((at - low) as u32));
            let name = format!("%{letter}B{at}");
            for bit in (0..8).filter(|_| high - low <= MAX_NAMED_BYTES) {
                let place = place.clone().step(Step::Bit(bit));
                self.hir
                    .names
                    .push((format!("%{letter}X{at}.{bit}"), place));
            }
            self.hir.names.push((name.clone(), place.clone()));
            self.address_points(area, &name, place, byte);
        }
        Cluster {
            first: low * 8,
            end: high * 8,
            tag,
            plain: None,
        }
    }

    pub(super) fn cluster_of(&self, address: Address) -> Option<&Cluster> {
        let clusters = self.addresses.areas.get(&key(address.area))?;
        let inside = |cluster: &&Cluster| {
            cluster.first < address.first + address.bits && address.first < cluster.end
        };
        clusters.iter().find(inside)
    }
}
