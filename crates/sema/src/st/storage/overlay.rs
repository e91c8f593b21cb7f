//! Where the members of a structure lie: `AT %B4`, `AT %X3.0`, OVERLAP, UNION.
//!
//! Places of members that do not overlap cannot be told apart from others, so they are checked and
//! not followed. Members that overlap are numbers in an array of bytes.

use crate::hir::code::PathStep;
use crate::hir::{Elementary, Type};
use crate::st::address::unit_bits;
use crate::st::analysis::Analysis;
use crate::st::resolve::TypeScope;
use crate::st::storage::extent;
use crate::st::types::{Member, Overlay, Parts, TypeId};
use iecc_ast::st::{self, Direct, ExprKind};
use iecc_diag::{Code, Diagnostic};

/// How the members of a structure lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Side by side.
    Plain,
    /// As they say, also one over the other.
    Overlap,
    /// All at the start.
    Union,
}

/// Most bytes that members which overlap may take.
const MAX_OVERLAY: u64 = 1 << 16;

impl Analysis<'_> {
    /// Where members lie, if they overlap; `Err` after a message.
    pub(crate) fn overlay(
        &mut self,
        scope: TypeScope<'_>,
        written: st::List<st::VarDecl>,
        members: &[Member],
        shape: Shape,
    ) -> Result<Option<Overlay>, ()> {
        let arena = &self.unit(scope.unit).arena;
        let mut places: Vec<Option<(u64, u64)>> = Vec::new();
        for decl in &arena[written] {
            let given = match decl.location {
                Some(location) => self.relative(scope, location)?,
                None => None,
            };
            places.extend(
                decl.names
                    .len()
                    .checked_sub(1)
                    .map(|more| std::iter::repeat_n(given, more + 1))
                    .into_iter()
                    .flatten(),
            );
            if shape != Shape::Plain && decl.initial.is_some() {
                let message = "members that overlap have no initial values";
                let span = self.span(scope.unit, decl.range);
                self.error(Code::E2008, span, message);
            }
        }
        // After a message about a name that stands there twice.
        if places.len() != members.len() {
            return Ok(None);
        }
        let ranges = self.member_ranges(members, &places, shape)?;
        match shape {
            Shape::Plain => self.apart(members, &ranges).map(|()| None),
            Shape::Overlap | Shape::Union => {
                let ends = ranges.iter().flatten().map(|(first, bits)| first + bits);
                let bytes = ends.max().unwrap_or(8).div_ceil(8);
                if bytes > MAX_OVERLAY {
                    let message = "the members lie too far apart";
                    self.error(Code::E2007, members[0].span, message);
                    return Err(());
                }
                let first = ranges.iter().flatten().map(|(first, _)| *first as u32);
                Ok(Some(Overlay {
                    bytes: bytes as u32,
                    first: first.collect(),
                }))
            }
        }
    }

    /// A place in the structure: its first bit and the bits of its unit.
    fn relative(
        &mut self,
        scope: TypeScope<'_>,
        location: st::Id<st::Expr>,
    ) -> Result<Option<(u64, u64)>, ()> {
        let written = self.unit(scope.unit).arena[location];
        let ExprKind::Direct(Direct {
            resource: _,
            area: None,
            size,
            fields: Some(fields),
        }) = written.kind
        else {
            return Ok(None);
        };
        let bits = unit_bits(size);
        // All but bits are counted in bytes.
        match (bits, &self.unit(scope.unit).arena[fields]) {
            (1, &[byte, bit]) if bit < 8 => Ok(Some((u64::from(byte) * 8 + u64::from(bit), 1))),
            (2.., &[byte]) => Ok(Some((u64::from(byte) * 8, bits))),
            _ => {
                let span = self.span(scope.unit, written.range);
                let message = "a member is at a byte (%W2), or at a bit of it (%X1.3)";
                self.error(Code::E2003, span, message);
                Err(())
            }
        }
    }

    fn member_ranges(
        &mut self,
        members: &[Member],
        places: &[Option<(u64, u64)>],
        shape: Shape,
    ) -> Result<Vec<Option<(u64, u64)>>, ()> {
        let mut ranges = Vec::new();
        for (member, place) in members.iter().zip(places) {
            let bits = self.overlaid_bits(member.ty);
            let name = self.text(member.name);
            let range = match (place, bits, shape) {
                (_, _, _) if member.ty == TypeId::ERROR => return Err(()),
                (Some((first, unit)), Some((width, bits)), _) if *unit == width => {
                    Some((*first, bits))
                }
                (Some((_, unit)), Some((width, _)), _) => {
                    let message = format!("`{name}` has {width} bits, not {unit}");
                    self.error(Code::E2022, member.span, message);
                    return Err(());
                }
                (None, Some((_, bits)), Shape::Union) => Some((0, bits)),
                (None, _, Shape::Plain) => None,
                (None, Some(_), Shape::Overlap) => {
                    let message = format!("`{name}` does not say where it lies");
                    let note = "every member of an OVERLAP structure has a place: AT %B4";
                    self.report(Diagnostic::new(Code::E2003, member.span, message).note(note));
                    return Err(());
                }
                (_, None, _) => {
                    let message = format!(
                        "`{name}` is neither a number nor an array of numbers: it is not compiled here yet"
                    );
                    self.error(Code::E2010, member.span, message);
                    return Err(());
                }
            };
            ranges.push(range);
        }
        Ok(ranges)
    }

    /// Members of a structure without OVERLAP lie apart.
    fn apart(&mut self, members: &[Member], ranges: &[Option<(u64, u64)>]) -> Result<(), ()> {
        let given = members.iter().zip(ranges);
        let mut placed: Vec<(u64, u64, &Member)> = given
            .filter_map(|(member, range)| range.map(|(first, bits)| (first, bits, member)))
            .collect();
        placed.sort_by_key(|(first, _, _)| *first);
        for pair in placed.windows(2) {
            let ((first, bits, one), (next, _, other)) = (pair[0], pair[1]);
            if next < first + bits {
                let (a, b) = (self.text(one.name), self.text(other.name));
                let message = format!("`{b}` overlaps `{a}`");
                let note = "members may overlap in STRUCT OVERLAP only";
                let diagnostic = Diagnostic::new(Code::E2003, other.span, message).note(note);
                self.report(diagnostic.also(one.span, "it lies here"));
                return Err(());
            }
        }
        Ok(())
    }

    /// How many bits a member that may overlap has, behind those of one number in it; `None` for what
    /// is neither a number nor an array of numbers in whole bytes.
    fn overlaid_bits(&self, ty: TypeId) -> Option<(u64, u64)> {
        if let Some(el) = self.types.elementary(ty) {
            return Some((u64::from(el.bits()), u64::from(el.bits())));
        }
        let Parts::Elements {
            dimensions,
            element,
        } = self.types.parts(ty)
        else {
            return None;
        };
        let width = u64::from(self.types.elementary(element)?.bits());
        let elements = dimensions.iter().map(|d| u64::from(extent(*d)));
        let bits = elements.fold(width, u64::saturating_mul);
        (width >= 8).then_some((width, bits))
    }

    /// The way to a number, or to an array of numbers, from a bit of an array of bytes. An array that is not
    /// all of the bytes has no elements of its own there; it is where they begin.
    pub(crate) fn shared_steps(&mut self, first: u32, bytes: u32, ty: TypeId) -> Vec<PathStep> {
        match self.storage(ty) {
            Type::Elementary(of) => steps_in_bytes(first, of),
            all @ (Type::Array(_) | Type::Struct(_)) => {
                let byte = Type::Elementary(Elementary::Usint);
                if all == Type::Array(self.hir.types.array(byte, bytes)) {
                    return Vec::new();
                }
                vec![PathStep::Bytes {
                    offset: first / 8,
                    ty: Elementary::Usint,
                }]
            }
        }
    }
}

/// The way to a number in bytes, from the bit where it begins.
pub(crate) fn steps_in_bytes(first: u32, of: Elementary) -> Vec<PathStep> {
    let byte = first / 8;
    match of {
        Elementary::Bool => vec![
            PathStep::Index(byte),
            PathStep::Bits {
                first: first % 8,
                count: 1,
            },
        ],
        Elementary::Usint => vec![PathStep::Index(byte)],
        Elementary::Sint
        | Elementary::Int
        | Elementary::Uint
        | Elementary::Dint
        | Elementary::Udint
        | Elementary::Lint
        | Elementary::Ulint
        | Elementary::Real
        | Elementary::Lreal => vec![PathStep::Bytes {
            offset: byte,
            ty: of,
        }],
    }
}
