//! Values of enumerations by their names.

use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::types::TypeId;
use iecc_ast::{Symbol, st};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// An enumerator of a type.
    pub(crate) fn enumerator_of(&mut self, ty: TypeId, name: Symbol, range: TextRange) -> Operand {
        if let Some(operand) = self.find_enumerator(ty, name, range) {
            return operand;
        }
        if ty == TypeId::ERROR || self.an.lost_members {
            return Operand::error(range);
        }
        let type_name = self.type_name(ty);
        let message = format!("{type_name} has no value `{}`", self.text(name));
        let mut diagnostic = Diagnostic::new(Message::E1016, self.span(range), message);
        if let Some(def) = self.an.types.enumeration(ty) {
            let candidates: Vec<Symbol> = def.values.iter().map(|(name, _)| *name).collect();
            if let Some(close) = self.an.similar(name, candidates) {
                diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
            }
        }
        self.report(diagnostic);
        Operand::error(range)
    }

    pub(super) fn find_enumerator(
        &self,
        ty: TypeId,
        name: Symbol,
        range: TextRange,
    ) -> Option<Operand> {
        let def = self.an.types.enumeration(ty)?;
        let (_, value) = def.values.iter().find(|(known, _)| *known == name)?;
        let ty = self.an.types.strip(ty);
        Some(Operand::constant(Const::Int(*value), ty, range))
    }

    /// Whether the values of an enumeration are named with it alone.
    pub(super) fn is_qualified(&self, ty: TypeId) -> bool {
        let enumeration = self.an.types.enumeration(ty);
        enumeration.is_some_and(|def| def.qualified)
    }

    /// Whether a place is in the declaration of an enumeration, whose initial value needs no name before it.
    pub(super) fn names_itself(&self, ty: TypeId, range: TextRange) -> bool {
        let Some(def) = self.an.types.enumeration(ty) else {
            return false;
        };
        let unit = self.an.unit(self.unit);
        let mut decls = unit.arena.all::<st::TypeDecl>().iter();
        decls.any(|decl| {
            let around = decl.range.start <= range.start && range.end <= decl.range.end;
            around && unit.span(unit.arena[decl.ty].range) == def.span
        })
    }

    pub(super) fn ambiguous_enumerator(
        &mut self,
        name: Symbol,
        of: &[(TypeId, i128)],
        range: TextRange,
    ) -> Operand {
        let text = self.text(name);
        let types: Vec<String> = of
            .iter()
            .map(|(ty, _)| format!("{}#{text}", self.type_name(*ty)))
            .collect();
        let message = format!("`{text}` is a value of several enumerations");
        let diagnostic = Diagnostic::new(Message::E1017, self.span(range), message);
        self.report(diagnostic.note(format!("write {}", types.join(" or "))));
        Operand::error(range)
    }
}
