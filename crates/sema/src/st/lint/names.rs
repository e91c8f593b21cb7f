//! Variables that nothing names, and instances of blocks that nothing calls.

use crate::st::analysis::Analysis;
use crate::st::signature::{PouId, UnitId};
use crate::st::types::TypeKind;
use iecc_ast::Symbol;
use iecc_ast::st::{
    self, Declarations, ExprKind, Member, Method, ModifierKind, PouKind, SectionKind, UnitKind,
    VarSection,
};
use iecc_diag::Code;
use rustc_hash::FxHashSet;

/// How the names of a unit are used.
#[derive(Default)]
struct Uses {
    /// Every name that stands in an expression.
    named: FxHashSet<Symbol>,
    /// Names that stand for more than the base of a member that is read: called, passed, assigned.
    whole: FxHashSet<Symbol>,
}

impl Analysis<'_> {
    /// Names in configurations, which reach into programs.
    pub(super) fn names_in_configurations(&self) -> FxHashSet<Symbol> {
        let mut names = FxHashSet::default();
        for unit in &self.units {
            if matches!(unit.unit.kind, UnitKind::Configuration(_)) {
                let arena = &unit.unit.arena;
                names.extend(arena.all::<st::Ident>().iter().map(|ident| ident.name));
                for expr in arena.all::<st::Expr>() {
                    if let ExprKind::Name(name)
                    | ExprKind::Member {
                        member: st::Ident { name, .. },
                        ..
                    } = expr.kind
                    {
                        names.insert(name);
                    }
                }
            }
        }
        if self.options.codesys {
            self.names_of_members(&mut names);
        }
        names
    }

    /// Names behind a dot: in CODESYS all variables of an instance are seen from outside.
    fn names_of_members(&self, names: &mut FxHashSet<Symbol>) {
        for unit in &self.units[self.first_user_unit as usize..] {
            for expr in unit.unit.arena.all::<st::Expr>() {
                if let ExprKind::Member { member, .. } = expr.kind {
                    names.insert(member.name);
                }
            }
        }
    }

    /// Warns of variables of a unit and its members.
    pub(super) fn unused_names(
        &mut self,
        id: UnitId,
        configured: &FxHashSet<Symbol>,
        extended: &FxHashSet<PouId>,
    ) {
        let unit = self.unit(id);
        let UnitKind::Pou(pou) = &unit.kind else {
            return;
        };
        let arena = &unit.arena;
        let mut uses = uses(arena);
        uses.named.extend(configured);
        uses.whole.extend(configured);
        // Derived units see the variables of what they extend, and everybody those of classes.
        let closed = matches!(pou.kind, PouKind::Function | PouKind::Program)
            || !self.is_extended(id, extended);
        if closed {
            self.unused_in(id, pou.sections, &uses);
            self.uncalled(id, pou.sections, &uses);
        }
        for member in &arena[pou.members] {
            match member {
                Member::Method(Method { sections, .. }) => self.unused_in(id, *sections, &uses),
                Member::Property(property) => {
                    for accessor in [property.get, property.set].into_iter().flatten() {
                        self.unused_in(id, accessor.sections, &uses);
                    }
                }
                Member::Action(_) => {}
            }
        }
    }

    fn is_extended(&self, unit: UnitId, extended: &FxHashSet<PouId>) -> bool {
        let pou = self.pou_of_unit.get(&unit);
        pou.is_none_or(|pou| extended.contains(pou))
    }

    /// The units that others extend.
    pub(super) fn extended(&self) -> FxHashSet<PouId> {
        self.pous
            .iter()
            .flat_map(|pou| pou.extends.iter().copied())
            .collect()
    }

    fn unused_in(&mut self, unit: UnitId, sections: st::List<VarSection>, uses: &Uses) {
        let mut unused = Vec::new();
        self.each_own_variable(unit, sections, |ident| {
            if !uses.named.contains(&ident.name) {
                unused.push(ident);
            }
        });
        for ident in unused {
            let name = self.text(ident.name);
            if !name.starts_with('_') {
                let text = format!("`{name}` is declared and not used");
                self.warning(unit, Code::E3050, ident.range, text);
            }
        }
    }

    fn uncalled(&mut self, unit: UnitId, sections: st::List<VarSection>, uses: &Uses) {
        let mut found = Vec::new();
        self.each_own_variable(unit, sections, |ident| {
            if uses.named.contains(&ident.name)
                && !uses.whole.contains(&ident.name)
                && self.is_block_with_body(unit, ident.name)
            {
                found.push(ident);
            }
        });
        for ident in found {
            let text = format!(
                "`{}` is never called, so its outputs never change",
                self.text(ident.name)
            );
            self.warning(unit, Code::E3055, ident.range, text);
        }
    }

    /// Whether a variable of a unit is an instance of a block that does something when called.
    fn is_block_with_body(&self, unit: UnitId, name: Symbol) -> bool {
        let pou = self.pou_of_unit.get(&unit).map(|id| self.pou(*id));
        let Some(var) = pou.and_then(|pou| pou.var(name)) else {
            return false;
        };
        let TypeKind::Instance(block) = *self.types.base(var.ty) else {
            return false;
        };
        let block = self.pou(block);
        let UnitKind::Pou(written) = &self.unit(block.unit).kind else {
            return false;
        };
        block.kind == PouKind::FunctionBlock && !written.body.is_empty()
    }

    /// The variables that nobody but the unit itself has to do with.
    fn each_own_variable(
        &self,
        unit: UnitId,
        sections: st::List<VarSection>,
        mut visit: impl FnMut(st::Ident),
    ) {
        let arena = &self.unit(unit).arena;
        for section in &arena[sections] {
            let Declarations::Variables(declarations) = section.declarations else {
                continue;
            };
            let open = |modifier: &st::Modifier| {
                matches!(modifier.kind, ModifierKind::Public | ModifierKind::Internal)
            };
            if !is_own(section.kind) || arena[section.modifiers].iter().any(open) {
                continue;
            }
            for declaration in &arena[declarations] {
                if declaration.location.is_none() {
                    arena[declaration.names]
                        .iter()
                        .copied()
                        .for_each(&mut visit);
                }
            }
        }
    }
}

fn is_own(section: SectionKind) -> bool {
    match section {
        SectionKind::Var
        | SectionKind::Temp
        | SectionKind::External
        | SectionKind::Static
        | SectionKind::Instance => true,
        SectionKind::Input
        | SectionKind::Output
        | SectionKind::InOut
        | SectionKind::Global
        | SectionKind::Access
        | SectionKind::Config => false,
    }
}

/// Looks at every expression of a unit once: those that are bases of members, by their members.
fn uses(arena: &st::Arena) -> Uses {
    let mut uses = Uses::default();
    let exprs = arena.all::<st::Expr>();
    let mut is_base = vec![false; exprs.len()];
    let mut called = vec![false; exprs.len()];
    // Parents come behind their children.
    for (index, expr) in exprs.iter().enumerate().rev() {
        match expr.kind {
            ExprKind::Call { callee, .. } => called[callee.index()] = true,
            ExprKind::Member { base, .. } if called[index] => called[base.index()] = true,
            ExprKind::Member { base, .. } => is_base[base.index()] = true,
            ExprKind::Index { base, .. } => {
                is_base[base.index()] = is_base[index];
                called[base.index()] = called[index];
            }
            ExprKind::Name(name) => {
                uses.named.insert(name);
                if !is_base[index] || called[index] {
                    uses.whole.insert(name);
                }
            }
            ExprKind::Literal(_)
            | ExprKind::Typed { .. }
            | ExprKind::Part { .. }
            | ExprKind::Deref(_)
            | ExprKind::Direct(_)
            | ExprKind::This
            | ExprKind::Super
            | ExprKind::Null
            | ExprKind::Ref(_)
            | ExprKind::Unary { .. }
            | ExprKind::Binary { .. }
            | ExprKind::ArrayValue(_)
            | ExprKind::Repeat { .. }
            | ExprKind::StructValue(_)
            | ExprKind::Error => {}
        }
    }
    uses
}
