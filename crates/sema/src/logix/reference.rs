//! References to places: tags, members, elements and bits.

use super::Analysis;
use super::symbols::Base;
use crate::hir::{Elementary, Place, Step, StructId, Type};
use iecc_ast::Name;
use iecc_ast::rung::{Expr, ExprKind, IntLiteral, Member, Radix, Reference, UnaryOp};
use iecc_diag::{Code, Diagnostic, closest};
use iecc_source::{Span, Spanned};

impl Analysis<'_> {
    /// The place a reference in a routine of `program` means.
    pub(crate) fn place(&mut self, program: Option<usize>, reference: &Reference) -> Option<Place> {
        let place = match self.base(program, reference)? {
            Base::Tag(tag) => Place::whole(tag),
            Base::Alias(alias) => self.alias_place(alias)?,
        };
        self.members(place, reference)
    }

    /// Follows the members of a reference from a place.
    pub(crate) fn members(&mut self, mut place: Place, reference: &Reference) -> Option<Place> {
        for member in &reference.members {
            place = match member {
                Member::Field(name) => self.field(place, name)?,
                Member::Bit(bit) => self.bit(place, *bit)?,
                Member::BitIndex(index) => {
                    let bit = self.constant_index(index, "bit number")?;
                    self.bit(place, Spanned::new(bit, index.span))?
                }
                Member::Index(indexes) => self.index(place, indexes, member.span())?,
            };
        }
        Some(place)
    }

    fn is_bit(place: &Place) -> bool {
        matches!(place.path.last(), Some(Step::Bit(_)))
    }

    fn field(&mut self, place: Place, name: &Name) -> Option<Place> {
        match self.type_of(&place) {
            Type::Struct(id) => match self.types.table.struct_def(id).member(&name.node) {
                Some(index) => Some(place.step(Step::Field(index))),
                None => self.no_member(&place, id, name),
            },
            ty @ (Type::Elementary(_) | Type::Array(_)) => {
                let what = self.describe(&place, ty);
                let mut diagnostic = Diagnostic::new(
                    Code::E1002,
                    name.span,
                    format!("{what} has no member `{}`", name.node),
                );
                if matches!(ty, Type::Array(_)) {
                    diagnostic = diagnostic.note("name an element first, as in `[0]`");
                }
                self.report(diagnostic);
                None
            }
        }
    }

    fn no_member(&mut self, place: &Place, id: StructId, name: &Name) -> Option<Place> {
        let what = self.describe(place, Type::Struct(id));
        let def = self.types.table.struct_def(id);
        let unusable = def
            .unusable
            .iter()
            .find(|member| member.name.eq_ignore_ascii_case(&name.node));
        let diagnostic = match unusable {
            Some(member) => Diagnostic::new(
                Code::E2010,
                name.span,
                format!("the member `{}` of {what} {}", name.node, member.reason),
            ),
            None => {
                let members = def.members.iter().filter(|member| !member.hidden);
                let names: Vec<&str> = members.map(|member| member.name.as_str()).collect();
                let diagnostic = Diagnostic::new(
                    Code::E1002,
                    name.span,
                    format!("{what} has no member `{}`", name.node),
                );
                match closest(&name.node, names.iter().copied()) {
                    Some(near) => {
                        diagnostic.fix(format!("did you mean `{near}`?"), name.span, near)
                    }
                    None if names.len() <= 12 => {
                        diagnostic.note(format!("its members are {}", names.join(", ")))
                    }
                    None => diagnostic,
                }
            }
        };
        self.report(diagnostic);
        None
    }

    fn bit(&mut self, place: Place, bit: Spanned<u32>) -> Option<Place> {
        let ty = self.type_of(&place);
        let message = match ty {
            Type::Elementary(word) if word.is_integer() && bit.node < word.bits() => {
                return Some(place.step(Step::Bit(bit.node)));
            }
            Type::Elementary(word) if word.is_integer() => format!(
                "{} has bits 0 to {}, not {}",
                self.describe(&place, ty),
                word.bits() - 1,
                bit.node
            ),
            Type::Elementary(_) | Type::Struct(_) | Type::Array(_) => format!(
                "{} has no bits with numbers; integers have",
                self.describe(&place, ty)
            ),
        };
        self.report(Diagnostic::new(Code::E2003, bit.span, message));
        None
    }

    fn index(&mut self, place: Place, indexes: &[Expr], span: Span) -> Option<Place> {
        let ty = self.type_of(&place);
        let lengths = self.dimensions(ty);
        if lengths.len() != indexes.len() {
            let what = self.describe(&place, ty);
            let message = match lengths.len() {
                0 => format!("{what} is no array"),
                1 => format!("{what} takes 1 index, not {}", indexes.len()),
                n => format!("{what} takes {n} indexes, not {}", indexes.len()),
            };
            self.report(Diagnostic::new(Code::E2004, span, message));
            return None;
        }
        let base = place.clone();
        indexes
            .iter()
            .zip(lengths)
            .try_fold(place, |place, (index, len)| {
                let value = self.constant_index(index, "index")?;
                if value < len {
                    return Some(place.step(Step::Index(value)));
                }
                let what = self.describe(&base, ty);
                let message = format!(
                    "the index {value} is outside {what}, whose elements are 0 to {}",
                    len - 1
                );
                self.report(Diagnostic::new(Code::E2002, index.span, message));
                None
            })
    }

    /// Array lengths of a type, outermost first.
    pub(crate) fn dimensions(&self, ty: Type) -> Vec<u32> {
        let (mut at, mut lengths) = (ty, Vec::new());
        while let Type::Array(id) = at {
            let array = self.types.table.array_def(id);
            lengths.push(array.len);
            at = array.element;
        }
        lengths
    }

    /// `` `tonp1.PRE` (DINT) ``
    pub(crate) fn describe(&self, place: &Place, ty: Type) -> String {
        let name = self.display(place);
        if Self::is_bit(place) {
            format!("`{name}` (a bit)")
        } else {
            format!("`{name}` ({})", self.types.table.name(ty))
        }
    }

    fn constant_index(&mut self, index: &Expr, what: &str) -> Option<u32> {
        match &index.kind {
            ExprKind::Int(literal) => match u32::try_from(literal.value) {
                Ok(value) => Some(value),
                Err(_) => {
                    let message = format!("the {what} {} is too large", literal.value);
                    self.report(Diagnostic::new(Code::E2002, index.span, message));
                    None
                }
            },
            ExprKind::Unary { op, .. } if op.node == UnaryOp::Negate => {
                let message = format!("the {what} `{index}` is negative");
                self.report(Diagnostic::new(Code::E2002, index.span, message));
                None
            }
            ExprKind::Real(_) | ExprKind::String(_) => {
                let message = format!("the {what} `{index}` is no whole number");
                self.report(Diagnostic::new(Code::E2002, index.span, message));
                None
            }
            ExprKind::Reference(_)
            | ExprKind::Unary { .. }
            | ExprKind::Binary { .. }
            | ExprKind::Call { .. } => {
                let message = format!(
                    "the {what} `{index}` is computed when the program runs, which is not compiled yet"
                );
                self.report(
                    Diagnostic::new(Code::E5023, index.span, message)
                        .note("constant indexes such as `[3]` are"),
                );
                None
            }
        }
    }
}

/// The reference in the target text of an alias: names, members, bits and constant indexes.
pub(crate) fn parse_alias_target(target: &Name) -> Option<Reference> {
    AliasText {
        rest: target.node.trim(),
        span: target.span,
    }
    .reference()
}

/// Aliases stand for plain paths, so a few steps read them; positions are that of the whole text.
struct AliasText<'t> {
    rest: &'t str,
    span: Span,
}

impl AliasText<'_> {
    fn reference(&mut self) -> Option<Reference> {
        let program = if self.take('\\') {
            let name = self.word(":")?;
            self.take('.').then_some(Some(name))?
        } else {
            None
        };
        let base = self.word(":")?;
        let mut members = Vec::new();
        while !self.rest.is_empty() {
            members.push(self.member()?);
        }
        Some(Reference {
            program,
            base,
            members,
            span: self.span,
        })
    }

    fn take(&mut self, c: char) -> bool {
        let found = self.rest.strip_prefix(c);
        self.rest = found.unwrap_or(self.rest);
        found.is_some()
    }

    fn word(&mut self, also: &str) -> Option<Name> {
        let is_part = |c: char| c.is_alphanumeric() || c == '_' || also.contains(c);
        let end = self.rest.find(|c| !is_part(c)).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        (!word.is_empty()).then(|| Spanned::new(word.to_owned(), self.span))
    }

    fn member(&mut self) -> Option<Member> {
        if self.take('.') {
            let word = self.word("")?;
            return Some(match word.node.parse() {
                Ok(bit) => Member::Bit(Spanned::new(bit, self.span)),
                Err(_) => Member::Field(word),
            });
        }
        if !self.take('[') {
            return None;
        }
        let mut indexes = Vec::new();
        loop {
            let value = self.word("")?.node.parse().ok()?;
            indexes.push(self.constant(value));
            if self.take(']') {
                return Some(Member::Index(indexes));
            }
            if !self.take(',') {
                return None;
            }
        }
    }

    fn constant(&self, value: u64) -> Expr {
        let literal = IntLiteral {
            value,
            radix: Radix::Decimal,
            suffix: None,
        };
        Expr {
            kind: ExprKind::Int(literal),
            span: self.span,
        }
    }
}

/// Whether a type is one value of a kind.
pub(crate) fn elementary(ty: Type) -> Option<Elementary> {
    match ty {
        Type::Elementary(elementary) => Some(elementary),
        Type::Struct(_) | Type::Array(_) => None,
    }
}
