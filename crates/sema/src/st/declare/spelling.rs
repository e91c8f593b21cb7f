//! Names that begin with two underlines are those of the standard library: nothing of the user's is
//! declared with one. Other misplaced underlines are seen where names are read.

use crate::st::analysis::Analysis;
use crate::st::signature::UnitId;
use iecc_ast::st::{Ident, Member, TypeDecl, UnitKind};
use iecc_diag::{Code, Diagnostic};

impl Analysis<'_> {
    /// Looks at every name that the user declares.
    pub(crate) fn check_spelling(&mut self) {
        for index in self.first_user_unit..self.units.len() as u32 {
            let mut declared = self.declared_names(UnitId(index));
            declared.retain(|ident| self.text(ident.name).starts_with("__"));
            for ident in declared {
                let name = self.text(ident.name);
                let message = format!("the name `{name}` begins with two underlines");
                let span = self.span(UnitId(index), ident.range);
                let diagnostic = Diagnostic::new(Code::E0034, span, message);
                self.report(diagnostic.note("such names are those of the standard library"));
            }
        }
    }

    fn declared_names(&self, unit: UnitId) -> Vec<Ident> {
        let unit = self.unit(unit);
        let arena = &unit.arena;
        let mut names: Vec<Ident> = arena.all::<Ident>().to_vec();
        names.extend(arena.all::<TypeDecl>().iter().map(|decl| decl.name));
        if let UnitKind::Pou(pou) = &unit.kind {
            names.push(pou.name);
            names.extend(arena[pou.members].iter().map(Member::name));
        }
        names
    }
}
