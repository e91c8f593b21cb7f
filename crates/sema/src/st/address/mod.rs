//! Direct addresses: `%IX0.3`, `%QW4`, `%MD5`.
//!
//! Addresses count units of their own size, the lowest byte first. An address that nothing else
//! overlaps is a tag of its own. Where several overlap, and one structure or array holds all others in
//! its elements, that is the tag; else their bytes are one array of bytes.

mod linked;
mod part;

use super::analysis::Analysis;
use super::elementary::El;
use super::resolve::TypeScope;
use super::signature::{NamespaceId, Spot, Storage, UnitId};
use super::storage::steps_in_bytes;
use super::types::{TypeId, TypeKind};
use crate::hir::{self, Elementary, IoPoint, Place, Step, TagId, Type, View};
use iecc_ast::st::{self, AddressSize, Area, Direct, ExprKind, UnitKind};
use iecc_diag::{Code, Diagnostics};
use iecc_source::Span;
use std::collections::{BTreeMap, HashSet};

/// Overlapping bytes whose bits have names; those of more have none.
const MAX_NAMED_BYTES: u64 = 4096;

/// Some bits of an area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Address {
    /// I, Q or M.
    pub area: Area,
    /// The first bit, counted from the start of the area.
    pub first: u64,
    /// How wide the unit of the address is.
    pub bits: u64,
}

/// What is stored at an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
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
struct Cluster {
    first: u64,
    end: u64,
    tag: TagId,
    /// What it is as one tag; `None` for bytes.
    plain: Option<Class>,
}

/// Where every address of the program lies.
#[derive(Debug, Default)]
pub(crate) struct Addresses {
    areas: BTreeMap<u8, Vec<Cluster>>,
}

impl Address {
    /// The address in its usual form.
    pub(crate) fn text(self) -> String {
        let letter = letter(self.area);
        match self.bits {
            1 => format!("%{letter}X{}.{}", self.first / 8, self.first % 8),
            8 => format!("%{letter}B{}", self.first / 8),
            16 => format!("%{letter}W{}", self.first / 16),
            32 => format!("%{letter}D{}", self.first / 32),
            _ => format!("%{letter}L{}", self.first / 64),
        }
    }

    /// The type of what has no other.
    pub(crate) fn plain_type(self) -> TypeId {
        TypeId::of(match self.bits {
            1 => El::Bool,
            8 => El::Byte,
            16 => El::Word,
            32 => El::Dword,
            _ => El::Lword,
        })
    }
}

fn letter(area: Area) -> char {
    match area {
        Area::Input => 'I',
        Area::Output => 'Q',
        Area::Memory => 'M',
    }
}

fn key(area: Area) -> u8 {
    match area {
        Area::Input => 0,
        Area::Output => 1,
        Area::Memory => 2,
    }
}

pub(crate) fn unit_bits(size: Option<AddressSize>) -> u64 {
    match size {
        None | Some(AddressSize::Bit) => 1,
        Some(AddressSize::Byte) => 8,
        Some(AddressSize::Word) => 16,
        Some(AddressSize::DoubleWord) => 32,
        Some(AddressSize::LongWord) => 64,
    }
}

impl Analysis<'_> {
    /// The address that is written somewhere; `None` for one that VAR_CONFIG gives, and after a
    /// message.
    pub(crate) fn address(&mut self, unit: UnitId, id: st::Id<st::Expr>) -> Option<Address> {
        let written = self.unit(unit).arena[id];
        let ExprKind::Direct(direct) = written.kind else {
            return None;
        };
        if let Some(resource) = direct.resource
            && !self.outer_names(unit).contains(&resource)
        {
            let span = self.span(unit, written.range);
            let message = format!("no resource is named `{}`", self.text(resource));
            self.error(Code::E1012, span, message);
            return None;
        }
        match self.read_address(unit, direct) {
            Ok(address) => address,
            Err((code, message)) => {
                let span = self.span(unit, written.range);
                self.error(code, span, message);
                None
            }
        }
    }

    fn read_address(
        &self,
        unit: UnitId,
        direct: Direct,
    ) -> Result<Option<Address>, (Code, String)> {
        let Some(area) = direct.area else {
            let message = "an address outside of a structure begins with %I, %Q or %M";
            return Err((Code::E2003, message.to_owned()));
        };
        let Some(fields) = direct.fields else {
            return Ok(None);
        };
        let bits = unit_bits(direct.size);
        let fields = &self.unit(unit).arena[fields];
        let first = match (bits, fields) {
            (1, &[byte, bit]) if bit < 8 => u64::from(byte) * 8 + u64::from(bit),
            (1, &[_, bit]) => {
                let message = format!("a byte has bits 0 to 7, not {bit}");
                return Err((Code::E2003, message));
            }
            (_, &[number]) => u64::from(number) * bits,
            _ => {
                let message = "an address of this many numbers is not compiled".to_owned();
                return Err((Code::E2010, message));
            }
        };
        Ok(Some(Address { area, first, bits }))
    }

    /// The area of an address that VAR_CONFIG gives.
    pub(crate) fn partly_area(&self, unit: UnitId, id: st::Id<st::Expr>) -> Option<Area> {
        let ExprKind::Direct(direct) = self.unit(unit).arena[id].kind else {
            return None;
        };
        direct.area.filter(|_| direct.fields.is_none())
    }

    /// Whether an address is one that VAR_CONFIG gives.
    pub(crate) fn is_partly(&self, unit: UnitId, id: st::Id<st::Expr>) -> bool {
        self.partly_area(unit, id).is_some()
    }

    /// The area of the address that VAR_CONFIG gives a member; others are at a place in the structure.
    pub(crate) fn member_location(&mut self, unit: UnitId, decl: &st::VarDecl) -> Option<Area> {
        let location = decl.location?;
        let written = self.unit(unit).arena[location];
        if let ExprKind::Direct(direct) = written.kind
            && (direct.area.is_none() || direct.fields.is_none())
        {
            // `overlay` looks at places in the structure, which have no area.
            return direct.area;
        }
        let span = self.span(unit, written.range);
        let message = "a member is at a place in the structure (%B4), or at `*`";
        self.error(Code::E2003, span, message);
        None
    }

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
            if found != TypeId::ERROR && !matches!(self.types.base(found), TypeKind::Instance(_)) {
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

    fn class(&self, ty: Type) -> (Class, u64) {
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
            let place = spot.and_then(|spot| super::config::place_of(&spot));
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

    fn cluster_of(&self, address: Address) -> Option<&Cluster> {
        let clusters = self.addresses.areas.get(&key(address.area))?;
        let inside = |cluster: &&Cluster| {
            cluster.first < address.first + address.bits && address.first < cluster.end
        };
        clusters.iter().find(inside)
    }

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
                match spot.and_then(|spot| super::config::place_of(&spot)) {
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

    /// Where names of a unit outside of bodies are looked up.
    pub(crate) fn global_scope(&self, unit: UnitId) -> TypeScope<'static> {
        let namespace = self.units.get(unit.index());
        TypeScope {
            unit,
            namespace: namespace.map_or(NamespaceId::GLOBAL, |unit| unit.namespace),
            bindings: None,
            pou: self.pou_of_unit.get(&unit).copied(),
        }
    }
}
