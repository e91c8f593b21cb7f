//! What belongs to the CODESYS dialect is refused in the others, with the switch that allows it.

use crate::st::analysis::Analysis;
use crate::st::signature::UnitId;
use iecc_ast::st::{
    AssignOp, BinaryOp, Expr, ExprKind, Member, Stmt, StmtKind, TypeDecl, TypeKind, TypeSpec, Unit,
    UnitKind, VarDecl, VarSection,
};
use iecc_ast::st::{ModifierKind, PouKind, SectionKind};
use iecc_diag::{Code, Diagnostic};
use iecc_source::TextRange;

impl Analysis<'_> {
    /// Looks through the nodes of every unit of the user.
    pub(crate) fn check_dialect(&mut self) {
        for index in self.first_user_unit..self.units.len() as u32 {
            let id = UnitId(index);
            if self.options.codesys {
                self.check_bound(id);
                continue;
            }
            for (range, what) in foreign_forms(self.unit(id)) {
                self.foreign(id, range, what);
            }
        }
    }

    /// `REF=` in a declaration is for what is written REFERENCE TO.
    fn check_bound(&mut self, id: UnitId) {
        let unit = self.unit(id);
        let mut wrong = unit.arena.all::<VarDecl>().to_vec();
        wrong.retain(|decl| decl.bound && !is_reference(unit, decl));
        for decl in wrong {
            let span = self.span(id, unit.arena[decl.ty].range);
            let message = "`REF=` gives an initial value to a REFERENCE only";
            self.error(Code::E2034, span, message);
        }
    }

    /// Refuses a form that the dialect does not have.
    pub(crate) fn foreign(&mut self, unit: UnitId, range: TextRange, what: &str) {
        let span = self.span(unit, range);
        let message = format!("{what} belongs to the CODESYS dialect");
        let diagnostic = Diagnostic::new(Code::E8001, span, message);
        self.report(diagnostic.note("`--dialect codesys` allows it"));
    }
}

/// The forms that can be told by their looks; others are refused where names are known.
fn foreign_forms(unit: &Unit) -> Vec<(TextRange, &'static str)> {
    let mut found = Vec::new();
    if let UnitKind::Globals(section) = &unit.kind {
        found.push((section.range, "VAR_GLOBAL outside of a CONFIGURATION"));
    }
    foreign_code(unit, &mut found);
    foreign_types(unit, &mut found);
    foreign_sections(unit, &mut found);
    for member in unit.arena.all::<Member>() {
        match member {
            Member::Property(property) => found.push((property.name.range, "PROPERTY")),
            Member::Action(action) => found.push((action.name.range, "ACTION of a unit")),
            Member::Method(method) if is_program(unit) => {
                found.push((method.name.range, "a method of a program"));
            }
            Member::Method(_) => {}
        }
    }
    found
}

fn is_program(unit: &Unit) -> bool {
    matches!(&unit.kind, UnitKind::Pou(pou) if pou.kind == PouKind::Program)
}

fn foreign_code(unit: &Unit, found: &mut Vec<(TextRange, &'static str)>) {
    for expr in unit.arena.all::<Expr>() {
        if let ExprKind::Binary {
            op: op @ (BinaryOp::AndThen | BinaryOp::OrElse),
            ..
        } = expr.kind
        {
            found.push((expr.range, op.as_str()));
        }
    }
    for stmt in unit.arena.all::<Stmt>() {
        if let StmtKind::Assign {
            op: op @ (AssignOp::Latch | AssignOp::Unlatch | AssignOp::Bind),
            ..
        } = stmt.kind
        {
            found.push((stmt.range, op.as_str()));
        }
        if let StmtKind::AssignAll { .. } = stmt.kind {
            found.push((stmt.range, "an assignment to several variables at once"));
        }
    }
}

fn foreign_types(unit: &Unit, found: &mut Vec<(TextRange, &'static str)>) {
    let arena = &unit.arena;
    for ty in arena.all::<TypeSpec>() {
        let what = match ty.kind {
            TypeKind::PointerTo(_) => "POINTER TO",
            TypeKind::ReferenceTo(_) => "REFERENCE TO",
            TypeKind::Union { .. } => "UNION",
            TypeKind::Sized { round: true, .. } => "a length in round brackets",
            TypeKind::Enum {
                base: Some(base), ..
            } if arena[base].range.start > ty.range.start => {
                "the type of an enumeration behind its values"
            }
            TypeKind::Named(_)
            | TypeKind::Subrange { .. }
            | TypeKind::Sized { round: false, .. }
            | TypeKind::Array { .. }
            | TypeKind::Struct { .. }
            | TypeKind::Enum { .. }
            | TypeKind::RefTo(_)
            | TypeKind::Error => continue,
        };
        found.push((ty.range, what));
    }
    for decl in arena.all::<VarDecl>() {
        if decl.bound && !is_reference(unit, decl) {
            found.push((decl.range, "REF="));
        }
    }
    for decl in arena.all::<TypeDecl>() {
        if decl.extends.is_some() {
            found.push((decl.range, "EXTENDS of a structure"));
        }
    }
}

/// Whether a variable is written as a REFERENCE.
pub(crate) fn is_reference(unit: &Unit, decl: &VarDecl) -> bool {
    matches!(unit.arena[decl.ty].kind, TypeKind::ReferenceTo(_))
}

fn foreign_sections(unit: &Unit, found: &mut Vec<(TextRange, &'static str)>) {
    for section in unit.arena.all::<VarSection>() {
        if let SectionKind::Static | SectionKind::Instance = section.kind {
            found.push((section.range, section.kind.as_str()));
        }
        let modifiers = &unit.arena[section.modifiers];
        for modifier in modifiers {
            let passed = matches!(section.kind, SectionKind::Input | SectionKind::InOut);
            match modifier.kind {
                ModifierKind::Persistent => found.push((modifier.range, "PERSISTENT")),
                ModifierKind::Constant if passed => {
                    found.push((modifier.range, "CONSTANT of what is passed"));
                }
                ModifierKind::Constant
                | ModifierKind::Retain
                | ModifierKind::NonRetain
                | ModifierKind::Public
                | ModifierKind::Protected
                | ModifierKind::Private
                | ModifierKind::Internal
                | ModifierKind::Final
                | ModifierKind::Abstract
                | ModifierKind::Override => {}
            }
        }
    }
}
