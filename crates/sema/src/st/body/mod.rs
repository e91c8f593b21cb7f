//! Checks bodies and writes them down as typed code.
//!
//! An expression first becomes an [`Operand`]; the place that uses it says which type it needs, and
//! literals take that type. After a message a piece counts as of the error type, which goes with
//! everything, so one mistake gives one message.

mod assertion;
mod call;
mod coerce;
mod connect;
mod context;
mod edge;
mod expr;
mod initial_reference;
mod library;
mod literal;
mod object;
mod operand;
mod operator;
mod place;
mod program;
mod property;
mod stmt;
mod suite;

pub(crate) use connect::Connections;
pub(crate) use operand::{Operand, OperandKind, Place, Rights};
pub(crate) use suite::TestRun;

use super::analysis::Analysis;
use super::resolve::TypeScope;
use super::signature::{Bindings, NamespaceId, PouId, Storage, UnitId};
use super::types::TypeId;
use crate::hir::code::{
    Call, CallId, Code, Expr, ExprId, ExprKind, Local, LocalId, Path, PathId, PathStep, Root, Stmt,
    StmtId, StmtKind,
};
use crate::hir::{Elementary, Type};
use iecc_ast::Symbol;
use iecc_ast::st;
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::{Span, TextRange};
use std::collections::{HashMap, HashSet};

/// A body that is being checked, or the surroundings of a constant expression.
pub(crate) struct Body<'b, 'a> {
    pub an: &'b mut Analysis<'a>,
    pub unit: UnitId,
    pub namespace: NamespaceId,
    pub pou: Option<PouId>,
    pub bindings: Option<&'b Bindings>,
    pub code: Code,
    /// The locals of variables, by their position in the signature.
    locals: Vec<Option<LocalId>>,
    /// The local that holds the result.
    result: Option<LocalId>,
    /// The reference that holds the result.
    result_ref: Option<u32>,
    /// The local that holds ENO.
    eno: Option<LocalId>,
    /// Control variables of the loops around, innermost last.
    loops: Vec<Option<(Root, Vec<PathStep>)>>,
    /// Statements that have to run before the one that is being looked at.
    pub(super) pending: Vec<StmtId>,
    /// The REFERENCEs that were followed, by the addresses read from them.
    followed: HashMap<ExprId, Place>,
    /// How many calls were written that may change something.
    pub(super) effects: u32,
    /// Calls whose EN has been looked at.
    skips: HashSet<st::Id<st::Expr>>,
    /// Whether only constants are allowed; what is not constant is reported where it stands.
    constant_only: bool,
    /// How many bodies were wanted before this one.
    pub(super) mark: usize,
}

impl<'b, 'a> Body<'b, 'a> {
    /// The surroundings of a constant expression.
    pub(crate) fn for_constant(an: &'b mut Analysis<'a>, scope: TypeScope<'b>) -> Self {
        Self {
            constant_only: true,
            ..Self::new(an, scope)
        }
    }

    /// A body without statements.
    fn new(an: &'b mut Analysis<'a>, scope: TypeScope<'b>) -> Self {
        Self {
            mark: an.wanted.len(),
            an,
            unit: scope.unit,
            namespace: scope.namespace,
            pou: scope.pou,
            bindings: scope.bindings,
            code: Code::default(),
            locals: Vec::new(),
            result: None,
            result_ref: None,
            eno: None,
            loops: Vec::new(),
            pending: Vec::new(),
            followed: HashMap::new(),
            effects: 0,
            skips: HashSet::new(),
            constant_only: false,
        }
    }

    fn arena(&self) -> &'a st::Arena {
        &self.an.unit(self.unit).arena
    }

    fn span(&self, range: TextRange) -> Span {
        self.an.span(self.unit, range)
    }

    fn text(&self, name: Symbol) -> &'a str {
        self.an.text(name)
    }

    fn type_name(&self, ty: TypeId) -> String {
        self.an.type_name(ty)
    }

    pub(super) fn error(
        &mut self,
        code: Message,
        range: TextRange,
        message: impl Into<String>,
    ) -> Operand {
        let span = self.span(range);
        self.an.error(code, span, message);
        Operand::error(range)
    }

    fn report(&mut self, diagnostic: Diagnostic) {
        self.an.report(diagnostic);
    }

    fn type_scope(&self) -> TypeScope<'b> {
        TypeScope {
            unit: self.unit,
            namespace: self.namespace,
            bindings: self.bindings,
            pou: self.pou,
        }
    }

    // Writing code.

    fn add_expr(&mut self, kind: ExprKind, ty: Elementary, range: TextRange) -> ExprId {
        let span = self.span(range);
        self.code.exprs.push(Expr { kind, ty, span });
        ExprId(self.code.exprs.len() as u32 - 1)
    }

    fn add_const(&mut self, bits: u64, ty: Elementary, range: TextRange) -> ExprId {
        self.add_expr(ExprKind::Const(bits), ty, range)
    }

    pub(super) fn add_path(
        &mut self,
        root: Root,
        steps: Vec<PathStep>,
        range: TextRange,
    ) -> PathId {
        let span = self.span(range);
        self.code.paths.push(Path { root, steps, span });
        PathId(self.code.paths.len() as u32 - 1)
    }

    fn add_stmt(&mut self, kind: StmtKind, range: TextRange) -> StmtId {
        let span = self.span(range);
        self.code.stmts.push(Stmt { kind, span });
        StmtId(self.code.stmts.len() as u32 - 1)
    }

    fn add_call(&mut self, call: Call) -> CallId {
        self.code.calls.push(call);
        CallId(self.code.calls.len() as u32 - 1)
    }

    /// A new variable of the activation.
    fn add_local(&mut self, name: &str, ty: Type) -> LocalId {
        let id = LocalId(self.code.locals.len() as u32);
        // Names of users have no apostrophe, so this one is unique.
        let name = format!("{name}'{}", id.0);
        self.code.locals.push(Local { name, ty });
        id
    }

    /// A statement that runs before the one being looked at.
    pub(super) fn before(&mut self, kind: StmtKind, range: TextRange) {
        let stmt = self.add_stmt(kind, range);
        self.pending.push(stmt);
    }

    /// A place of something temporary.
    fn temporary(&mut self, name: &str, ty: TypeId) -> Place {
        let storage = self.an.storage(ty);
        let local = self.add_local(name, storage);
        Place {
            root: Root::Local(local),
            steps: Vec::new(),
            rights: Rights::Temporary,
        }
    }
}

impl Analysis<'_> {
    /// Checks the body of a unit, whose signature is complete, and writes its code.
    pub(crate) fn body(&mut self, id: PouId) -> Code {
        let scope = self.pou_scope(id);
        let mut body = Body::new(self, scope.as_scope());
        body.interface(id);
        body.statements_of(id);
        body.code
    }
}

impl Body<'_, '_> {
    /// References, parameters, results and locals, in the order of the call.
    fn interface(&mut self, id: PouId) {
        let shape = self.an.call_shape(id);
        let pou = self.an.pou(id).clone();
        if shape.instance {
            let of = self.an.instance_of(id);
            let ty = Type::Struct(self.an.instance_struct(of));
            self.add_ref("this".to_owned(), ty);
        }
        for &index in &shape.refs {
            let ty = self.an.storage(pou.vars[index].ty);
            let name = self.text(pou.vars[index].name).to_owned();
            self.add_ref(name, ty);
        }
        self.locals = vec![None; pou.vars.len()];
        for &index in &shape.params {
            self.locals[index] = Some(self.var_local(&pou.vars[index]));
        }
        self.code.params = shape.params.len() as u32;
        if let Some(result) = pou.result {
            let ty = self.an.storage(result);
            let name = self.text(pou.result_name).to_owned();
            if shape.result_by_ref {
                self.result_ref = Some(self.code.refs.len() as u32);
                self.add_ref(name, ty);
            } else {
                let local = LocalId(self.code.locals.len() as u32);
                self.code.locals.push(Local { name, ty });
                self.result = Some(local);
                self.code.results.push(local);
            }
        }
        for (index, var) in pou.vars.iter().enumerate() {
            if var.storage == Storage::Local && self.locals[index].is_none() {
                self.locals[index] = Some(self.var_local(var));
            }
        }
        self.edge_locals(id);
        for &index in &shape.results {
            let local = self.locals[index].expect("outputs by value are locals");
            self.code.results.push(local);
        }
        if shape.eno {
            let local = self.add_local("ENO", Type::Elementary(Elementary::Bool));
            self.eno = Some(local);
            self.code.results.push(local);
        }
    }

    fn add_ref(&mut self, name: String, ty: Type) {
        self.code.refs.push(crate::hir::code::RefParam { name, ty });
    }

    fn var_local(&mut self, var: &super::signature::Var) -> LocalId {
        let ty = self.an.storage(var.ty);
        let name = self.text(var.name).to_owned();
        // Names of variables are unique in their unit.
        self.code.locals.push(Local { name, ty });
        LocalId(self.code.locals.len() as u32 - 1)
    }
}
