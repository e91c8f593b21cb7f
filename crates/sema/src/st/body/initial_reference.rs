//! Initial values of references: NULL, or the address of a variable that is there from the start.

use super::{Body, Place, Rights};
use crate::hir::code::{Block, ExprId, ExprKind, Init, PathId, PathStep, Root, StmtKind, Target};
use crate::hir::{self, InitId, Step, StructId, Type};
use crate::st::analysis::Analysis;
use crate::st::resolve::TypeScope;
use crate::st::signature::{Initial, Var};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st;
use iecc_diag::Code as Message;
use iecc_source::TextRange;

impl Analysis<'_> {
    /// Whether what a type holds is an address.
    pub(crate) fn is_address(&self, ty: TypeId) -> bool {
        let base = self.types.base(ty);
        matches!(base, TypeKind::Reference(..) | TypeKind::Interface(_))
    }

    /// What a reference holds at the start; `None` for NULL.
    pub(crate) fn reference_value(
        &mut self,
        scope: TypeScope<'_>,
        expr: st::Id<st::Expr>,
        ty: TypeId,
    ) -> Option<InitId> {
        let mut body = Body::new(self, scope);
        let (value, target) = body.fixed_reference(expr, ty)?;
        let target = target.filter(|_| body.code.expr(value).kind != ExprKind::Const(0));
        target.map(|target| self.init(Init::Address(target)))
    }

    /// Whether an initial value refers to an instance that is not around it.
    fn is_stray(&self, init: InitId, ty: Type, around: &mut Vec<StructId>) -> bool {
        match (self.hir.inits.get(init), ty) {
            (Init::Address(Target::Around(id, _)), _) => !around.contains(id),
            (Init::Struct(members), Type::Struct(id)) => {
                around.push(id);
                let types = &self.hir.types.struct_def(id).members;
                let stray = members
                    .iter()
                    .any(|(member, init)| self.is_stray(*init, types[*member as usize].ty, around));
                around.pop();
                stray
            }
            (Init::Array(runs), Type::Array(id)) => {
                let element = self.hir.types.array_def(id).element;
                let mut values = runs.iter().map(|(.., init)| *init);
                values.any(|init| self.is_stray(init, element, around))
            }
            (Init::Zero | Init::Bits(_) | Init::Address(Target::Tag(_)), _) => false,
            (Init::Struct(_) | Init::Array(_), _) => panic!("initial values fit their types"),
        }
    }
}

impl Body<'_, '_> {
    /// A reference that is the same whenever it is looked at, and what it refers to.
    fn fixed_reference(
        &mut self,
        expr: st::Id<st::Expr>,
        ty: TypeId,
    ) -> Option<(ExprId, Option<Target>)> {
        let operand = self.expr(expr, Some(ty));
        if operand.is_error() {
            return None;
        }
        let value = self.as_scalar(&operand, ty);
        let kind = &self.code.expr(value).kind;
        if matches!(kind, ExprKind::Const(_)) {
            return Some((value, None));
        }
        if let &ExprKind::Address(path) = kind
            && self.pending.is_empty()
            && let Some(target) = self.target(path)
        {
            return Some((value, Some(target)));
        }
        let message = "at the start a reference is NULL, or REF of a variable that is always there";
        self.error(Message::E2030, operand.range, message);
        None
    }

    /// What a path stands for, if that never changes.
    fn target(&mut self, path: PathId) -> Option<Target> {
        let path = self.code.path(path).clone();
        let step = |step: &PathStep| match step {
            PathStep::Field(field) => Some(Step::Field(*field)),
            PathStep::Index(index) => Some(Step::Index(*index)),
            PathStep::IndexBy { .. }
            | PathStep::Character { .. }
            | PathStep::Bits { .. }
            | PathStep::Bytes { .. } => None,
        };
        let steps: Option<Vec<Step>> = path.steps.iter().map(step).collect();
        match path.root {
            Root::Tag(tag) => Some(Target::Tag(hir::Place { tag, path: steps? })),
            Root::Ref(0) if self.home().is_some() => {
                let of = self.an.instance_of(self.pou?);
                Some(Target::Around(self.an.instance_struct(of), steps?))
            }
            Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => None,
        }
    }

    /// The initial value of a reference that every call makes anew.
    pub(super) fn start_reference(
        &mut self,
        root: Root,
        var: &Var,
        initial: Initial,
        body: &mut Block,
    ) {
        let outer = std::mem::take(&mut self.pending);
        if let Some((value, _)) = self.fixed_reference(initial.expr, var.ty) {
            let path = self.add_path(root, Vec::new(), var.range);
            self.before(StmtKind::Assign(path, value), var.range);
        }
        body.append(&mut self.pending);
        self.pending = outer;
    }

    /// The initial value of a variable of which every call has its own; `None` if it is 0, or after
    /// a mistake.
    pub(super) fn own_init(&mut self, var: &Var) -> Option<InitId> {
        let init = match var.initial {
            Some(initial) => self.an.initial_value(initial, var.ty),
            None => self.an.default_init(var.ty),
        }?;
        let storage = self.an.storage(var.ty);
        if self.an.is_stray(init, storage, &mut Vec::new()) {
            let what = "an initial value that refers to another variable of the instance, here";
            self.an.unsupported(self.unit, var.range, what);
            return None;
        }
        Some(init)
    }

    /// A scalar initial value as an expression; 0 for none.
    pub(super) fn init_expr(
        &mut self,
        init: Option<InitId>,
        ty: TypeId,
        range: TextRange,
    ) -> ExprId {
        let storage = self.an.scalar(ty);
        let bits = match init.map(|init| self.an.hir.inits.get(init).clone()) {
            Some(Init::Bits(bits)) => bits,
            Some(Init::Address(Target::Tag(place))) => {
                let place = Place {
                    root: Root::Tag(place.tag),
                    steps: place.path.into_iter().map(path_step).collect(),
                    rights: Rights::All,
                };
                let path = self.path_of(&place, range);
                return self.add_expr(ExprKind::Address(path), storage, range);
            }
            Some(Init::Address(Target::Around(..)) | Init::Struct(_) | Init::Array(_)) => {
                panic!("scalars have no parts, and what is stray is refused")
            }
            Some(Init::Zero) | None => 0,
        };
        self.add_const(bits, storage, range)
    }
}

fn path_step(step: Step) -> PathStep {
    match step {
        Step::Field(field) => PathStep::Field(field),
        Step::Index(index) => PathStep::Index(index),
        Step::Bit(first) => PathStep::Bits { first, count: 1 },
    }
}
