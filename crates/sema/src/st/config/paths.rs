//! Paths from outside of units: `resource.program.block.variable`, of VAR_ACCESS, VAR_CONFIG, tasks.

use crate::hir::code::PathStep;
use crate::hir::{Place, Step, TagId};
use crate::st::address::Address;
use crate::st::analysis::Analysis;
use crate::st::signature::{Def, PouId, Spot, Storage, UnitId};
use crate::st::types::{Parts, TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind};
use iecc_diag::Code;

/// What a path leads to.
#[derive(Debug, Clone)]
pub(crate) struct Found {
    /// `None` for a number of several bytes that others share.
    pub place: Option<Place>,
    /// Where it lies, if it is a variable at an address.
    pub address: Option<Address>,
    pub ty: TypeId,
    /// Whether VAR_CONFIG gives its address.
    pub partly: bool,
}

/// One part of a written path.
#[derive(Debug, Clone, Copy)]
enum Part {
    Name(st::Ident),
    Index(st::List<st::Id<st::Expr>>),
}

impl Analysis<'_> {
    /// Follows a path; a message where it leads nowhere.
    pub(crate) fn outside_path(&mut self, unit: UnitId, id: st::Id<st::Expr>) -> Option<Found> {
        let range = self.unit(unit).arena[id].range;
        if let ExprKind::Direct(_) = self.unit(unit).arena[id].kind {
            let address = self.address(unit, id)?;
            let ty = address.plain_type();
            return self.found_at(address, ty);
        }
        let mut parts = Vec::new();
        let found = self
            .written_parts(unit, id, &mut parts)
            .and_then(|()| self.follow_parts(unit, &parts));
        if found.is_none() {
            let span = self.span(unit, range);
            let message = "this path leads to no variable of the configuration";
            self.error(Code::E1012, span, message);
        }
        found.filter(|found| found.ty != TypeId::ERROR)
    }

    fn found_at(&mut self, address: Address, ty: TypeId) -> Option<Found> {
        let spot = self.spot(address, ty)?;
        Some(Found {
            place: place_of(&spot),
            address: Some(address),
            ty,
            partly: false,
        })
    }

    /// Follows a path that begins in a program.
    pub(super) fn inside_path(
        &mut self,
        unit: UnitId,
        program: PouId,
        tag: TagId,
        path: st::Id<st::Expr>,
    ) -> Option<Found> {
        let mut parts = Vec::new();
        self.written_parts(unit, path, &mut parts)?;
        let start = self.found_program(program, tag);
        self.follow_rest(unit, start, &parts)
    }

    /// The instance of a program.
    pub(super) fn found_program(&mut self, program: PouId, tag: TagId) -> Found {
        Found {
            place: Some(Place::whole(tag)),
            address: None,
            ty: self.types.intern(TypeKind::Instance(program)),
            partly: false,
        }
    }

    /// Recursion is bounded by the depth of expressions.
    fn written_parts(
        &self,
        unit: UnitId,
        id: st::Id<st::Expr>,
        parts: &mut Vec<Part>,
    ) -> Option<()> {
        let arena = &self.unit(unit).arena;
        let written = arena[id];
        if let ExprKind::Member { base, member } = written.kind {
            self.written_parts(unit, base, parts)?;
            parts.push(Part::Name(member));
        } else if let ExprKind::Index { base, indices } = written.kind {
            self.written_parts(unit, base, parts)?;
            parts.push(Part::Index(indices));
        } else {
            let (name, range) = (written.kind.name()?, written.range);
            parts.push(Part::Name(st::Ident { name, range }));
        }
        Some(())
    }

    fn follow_parts(&mut self, unit: UnitId, parts: &[Part]) -> Option<Found> {
        let Some((Part::Name(head), rest)) = parts.split_first() else {
            return None;
        };
        if let Some(found) = self.path_head(unit, head.name) {
            return self.follow_rest(unit, found, rest);
        }
        // The configuration and the resource may stand in front.
        let outer = self.outer_names(unit).contains(&head.name);
        if outer && !rest.is_empty() {
            return self.follow_parts(unit, rest);
        }
        None
    }

    /// The names of a configuration and of its resources.
    pub(crate) fn outer_names(&self, unit: UnitId) -> Vec<Symbol> {
        let unit = self.unit(unit);
        let st::UnitKind::Configuration(configuration) = &unit.kind else {
            return Vec::new();
        };
        let resources = unit.arena[configuration.resources].iter();
        let resources = resources.filter_map(|resource| resource.name);
        resources
            .chain([configuration.name])
            .map(|ident| ident.name)
            .collect()
    }

    fn path_head(&mut self, unit: UnitId, name: Symbol) -> Option<Found> {
        let instance = self.program_instances.iter().find(|one| one.0 == name);
        if let Some(&(_, program, tag)) = instance {
            return Some(self.found_program(program, tag));
        }
        let namespace = self.units[unit.index()].namespace;
        let [Def::Global(global)] = *self.lookup(namespace, name) else {
            return None;
        };
        let global = self.global(global);
        let (ty, spot) = (global.ty, global.spot.clone()?);
        Some(Found {
            place: place_of(&spot),
            address: None,
            ty,
            partly: false,
        })
    }

    fn follow_rest(&mut self, unit: UnitId, mut at: Found, rest: &[Part]) -> Option<Found> {
        for part in rest {
            at = match *part {
                Part::Name(name) => self.path_member(at, name.name)?,
                Part::Index(indices) => self.path_element(unit, at, indices)?,
            };
        }
        Some(at)
    }

    /// The member or variable of something.
    pub(crate) fn path_member(&mut self, at: Found, name: Symbol) -> Option<Found> {
        match self.types.parts(at.ty) {
            Parts::Members(def) => {
                let position = *def.by_name.get(&name)?;
                if def.overlay.is_some() {
                    return None;
                }
                let member = &def.members[position as usize];
                Some(Found {
                    place: Some(at.place?.step(Step::Field(position))),
                    address: None,
                    ty: member.ty,
                    partly: member.partly.is_some(),
                })
            }
            Parts::Variables(pou) => self.path_variable(at.place?, pou, name),
            Parts::Elements { .. } | Parts::None => None,
        }
    }

    fn path_variable(&mut self, mut place: Place, mut pou: PouId, name: Symbol) -> Option<Found> {
        loop {
            if let Some(var) = self.pou(pou).var(name).cloned() {
                return match var.storage {
                    Storage::Field(field) => Some(Found {
                        place: Some(place.step(Step::Field(field))),
                        address: None,
                        ty: var.ty,
                        partly: var.partly.is_some(),
                    }),
                    Storage::Located(address) => self.found_at(address, var.ty),
                    Storage::Global(_) | Storage::Const(_) | Storage::Local | Storage::Ref(_) => {
                        None
                    }
                };
            }
            pou = *self.pou(pou).extends.first()?;
            place = place.step(Step::Field(0));
        }
    }

    fn path_element(
        &mut self,
        unit: UnitId,
        mut at: Found,
        indices: st::List<st::Id<st::Expr>>,
    ) -> Option<Found> {
        let TypeKind::Array {
            dimensions,
            element,
        } = self.types.base(at.ty).clone()
        else {
            return None;
        };
        let written = self.unit(unit).arena[indices].to_vec();
        if written.len() != dimensions.len() {
            return None;
        }
        let scope = self.global_scope(unit);
        for (&(low, high), index) in dimensions.iter().zip(written) {
            let index = self.constant_int(scope, index, TypeId::UNTYPED_INT)?;
            let index = i64::try_from(index).ok()?;
            if !(low..=high).contains(&index) {
                return None;
            }
            at.place = at
                .place
                .map(|place| place.step(Step::Index((index - low) as u32)));
        }
        Some(Found {
            ty: element,
            address: None,
            ..at
        })
    }
}

/// A spot as a place, unless it is a value of several bytes.
pub(crate) fn place_of(spot: &Spot) -> Option<Place> {
    let steps = spot.steps.iter().map(|step| match *step {
        PathStep::Field(field) => Some(Step::Field(field)),
        PathStep::Index(index) => Some(Step::Index(index)),
        PathStep::Bits { first, count: 1 } => Some(Step::Bit(first)),
        PathStep::Bits { .. }
        | PathStep::IndexBy { .. }
        | PathStep::Character { .. }
        | PathStep::Bytes { .. } => None,
    });
    Some(Place {
        tag: spot.tag,
        path: steps.collect::<Option<_>>()?,
    })
}
