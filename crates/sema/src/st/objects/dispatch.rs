//! Which body runs: bodies of a base made for what extends it, and the choice by the type of an
//! instance.
//!
//! Where the type of an instance is known, its body is: a body of a base that may call what is
//! overridden is written down once per type it runs on, so nothing is chosen at run time. Behind
//! references, interfaces and in-outs the type may be any of a closed set; there a unit made for it
//! looks at the type number of the instance and calls the body of that type.

use crate::hir::code::{
    Block, Call, CallId, Code, Expr, ExprId, ExprKind, Local, LocalId, Path, PathId, PathStep,
    RefParam, Root, Stmt, StmtId, StmtKind,
};
use crate::hir::{self, Elementary, Type};
use crate::st::analysis::Analysis;
use crate::st::signature::{PouId, State};
use crate::st::signatures::CallShape;
use iecc_ast::Symbol;
use iecc_source::Span;

/// A unit that chooses a body. It is called like the body, with the address of the instance as the
/// first value in place of the instance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dispatcher {
    pub unit: hir::PouId,
    /// Whether ENO is the last result.
    pub eno: bool,
    /// The body whose parameters it has.
    pub signature: PouId,
}

/// A body and the numbers of the types that it runs on.
struct Choice {
    body: PouId,
    numbers: Vec<u32>,
}

impl Analysis<'_> {
    /// The class or block whose instance a body works on.
    pub(crate) fn instance_of(&self, body: PouId) -> PouId {
        let pou = self.pou(body);
        pou.receiver.or(pou.owner).unwrap_or(body)
    }

    /// A body as it runs on instances of a type: the same, unless it may call what was overridden
    /// since.
    pub(crate) fn body_for(&mut self, body: PouId, of: PouId) -> PouId {
        let pou = self.pou(body);
        let body_home = pou.owner.unwrap_or(body);
        if pou.receiver.is_some() || body_home == of || !self.overridden_since(body_home, of) {
            return body;
        }
        if let Some(&known) = self.receivers.get(&(body, of)) {
            return known;
        }
        self.complete(body);
        let mut made = self.pou(body).clone();
        made.receiver = Some(of);
        made.owner = Some(body_home);
        made.state = State::Done;
        let made = self.add_pou(made);
        self.receivers.insert((body, of), made);
        made
    }

    /// Whether something between a base and what extends it overrides a method of the base.
    fn overridden_since(&self, base: PouId, of: PouId) -> bool {
        let lineage = self.lineage(of);
        let since = lineage.iter().take_while(|id| **id != base);
        since
            .flat_map(|id| self.pou(*id).members.iter())
            .any(|(name, _)| self.method(base, *name).is_some())
    }

    /// The body that runs for a method, or for a call of the block where there is no name.
    pub(crate) fn body_of(&mut self, of: PouId, method: Option<Symbol>) -> Option<PouId> {
        let body = match method {
            Some(name) => self.method(of, name)?,
            None => of,
        };
        Some(self.body_for(body, of))
    }

    /// What may run where the type of an instance is one of those that may stand for `of`.
    fn choices(&mut self, of: PouId, method: Option<Symbol>) -> Vec<Choice> {
        let mut choices: Vec<Choice> = Vec::new();
        for concrete in self.concrete_types(of) {
            let Some(body) = self.body_of(concrete, method) else {
                continue;
            };
            let number = self.type_number(concrete);
            match choices.iter_mut().find(|choice| choice.body == body) {
                Some(choice) => choice.numbers.push(number),
                None => choices.push(Choice {
                    body,
                    numbers: vec![number],
                }),
            }
        }
        choices
    }

    /// The unit that chooses, if there is more than one body to choose from.
    pub(crate) fn dispatcher(
        &mut self,
        of: PouId,
        method: Option<Symbol>,
        signature: PouId,
    ) -> Option<Dispatcher> {
        if !self.pou(of).has_instances() {
            return Some(self.made_dispatcher(of, method, signature));
        }
        if !self.is_numbered(of) {
            return None;
        }
        let own = self.body_of(of, method);
        let choices = self.choices(of, method);
        let single = choices.iter().all(|choice| Some(choice.body) == own);
        (!single).then(|| self.made_dispatcher(of, method, signature))
    }

    /// The unit that chooses.
    pub(crate) fn made_dispatcher(
        &mut self,
        of: PouId,
        method: Option<Symbol>,
        signature: PouId,
    ) -> Dispatcher {
        if let Some(&known) = self.dispatchers.get(&(of, method)) {
            return known;
        }
        self.complete(signature);
        let choices = self.choices(of, method);
        for choice in &choices {
            self.complete(choice.body);
        }
        let eno = choices.iter().any(|c| self.call_shape(c.body).eno);
        let shape = CallShape {
            eno,
            ..self.call_shape(signature)
        };
        let span = self.pou(signature).span;
        let own = self.text(self.pou(of).name);
        let name = match method {
            Some(method) => format!("{own}.{}'", self.text(method)),
            None => format!("{own}''"),
        };
        let name = self.unique_unit_name(name);
        let code = Chooser::new(self, signature, shape, span).code(&choices);
        let unit = self.synthetic(name, code, span);
        let made = Dispatcher {
            unit,
            eno,
            signature,
        };
        self.dispatchers.insert((of, method), made);
        made
    }
}

/// Writes the code of a unit that chooses.
struct Chooser<'c, 'a> {
    an: &'c mut Analysis<'a>,
    code: Code,
    /// That of the units to choose from.
    shape: CallShape,
    span: Span,
}

/// The address of the instance.
const ADDRESS: LocalId = LocalId(0);

impl<'c, 'a> Chooser<'c, 'a> {
    fn new(an: &'c mut Analysis<'a>, signature: PouId, shape: CallShape, span: Span) -> Self {
        let mut chooser = Self {
            an,
            code: Code::default(),
            shape,
            span,
        };
        chooser.interface(signature);
        chooser
    }

    fn interface(&mut self, signature: PouId) {
        let pou = self.an.pou(signature).clone();
        let shape = self.shape.clone();
        for &index in &shape.refs {
            self.reference(pou.vars[index].ty, pou.vars[index].name);
        }
        if let (true, Some(result)) = (shape.result_by_ref, pou.result) {
            self.reference(result, pou.name);
        }
        self.local("instance'", Type::Elementary(Elementary::Ulint));
        for &index in &shape.params {
            let ty = self.an.storage(pou.vars[index].ty);
            self.local(self.an.text(pou.vars[index].name), ty);
        }
        self.code.params = shape.params.len() as u32 + 1;
        if let (true, Some(result)) = (shape.result_by_value, pou.result) {
            let ty = self.an.storage(result);
            self.result("result'", ty);
        }
        for &index in &shape.results {
            let ty = self.an.storage(pou.vars[index].ty);
            self.result(self.an.text(pou.vars[index].name), ty);
        }
        if shape.eno {
            self.result("ENO'", Type::Elementary(Elementary::Bool));
        }
    }

    fn reference(&mut self, ty: crate::st::types::TypeId, name: Symbol) {
        let ty = self.an.storage(ty);
        let name = self.an.text(name).to_owned();
        self.code.refs.push(RefParam { name, ty });
    }

    fn local(&mut self, name: &str, ty: Type) -> LocalId {
        let name = name.to_owned();
        self.code.locals.push(Local { name, ty });
        LocalId(self.code.locals.len() as u32 - 1)
    }

    fn result(&mut self, name: &str, ty: Type) {
        let local = self.local(name, ty);
        self.code.results.push(local);
    }

    fn path(&mut self, root: Root, steps: Vec<PathStep>) -> PathId {
        let span = self.span;
        self.code.paths.push(Path { root, steps, span });
        PathId(self.code.paths.len() as u32 - 1)
    }

    fn expr(&mut self, kind: ExprKind, ty: Elementary) -> ExprId {
        let span = self.span;
        self.code.exprs.push(Expr { kind, ty, span });
        ExprId(self.code.exprs.len() as u32 - 1)
    }

    fn stmt(&mut self, kind: StmtKind) -> StmtId {
        let span = self.span;
        self.code.stmts.push(Stmt { kind, span });
        StmtId(self.code.stmts.len() as u32 - 1)
    }

    fn value(&mut self, local: LocalId, ty: Elementary) -> ExprId {
        let path = self.path(Root::Local(local), Vec::new());
        self.expr(ExprKind::Load(path), ty)
    }

    /// What lies at the address; that it is not NULL is tested by the caller.
    fn instance(&mut self, ty: Type) -> PathId {
        let address = self.value(ADDRESS, Elementary::Ulint);
        let root = Root::Deref {
            address,
            ty,
            checked: true,
        };
        self.path(root, Vec::new())
    }

    fn code(mut self, choices: &[Choice]) -> Code {
        let number = self.instance(Type::Elementary(Elementary::Udint));
        let selector = self.expr(ExprKind::Load(number), Elementary::Udint);
        let mut arms = Vec::new();
        for choice in choices {
            let ranges = choice
                .numbers
                .iter()
                .map(|n| (u64::from(*n), u64::from(*n)));
            arms.push((ranges.collect(), self.call(choice.body)));
        }
        let choose = self.stmt(StmtKind::Case {
            selector,
            arms,
            otherwise: Vec::new(),
        });
        self.code.body = vec![choose];
        self.code
    }

    fn call(&mut self, body: PouId) -> Block {
        let instance = Type::Struct(self.an.instance_struct(self.an.instance_of(body)));
        let mut refs = vec![self.instance(instance)];
        for index in 0..self.code.refs.len() as u32 {
            refs.push(self.path(Root::Ref(index), Vec::new()));
        }
        let mut args = Vec::new();
        for index in 1..self.code.params {
            let Type::Elementary(ty) = self.code.locals[index as usize].ty else {
                unreachable!("parameters by value are numbers")
            };
            args.push(self.value(LocalId(index), ty));
        }
        let own_eno = self.an.call_shape(body).eno;
        let missing_eno = self.shape.eno && !own_eno;
        let given = self.code.results.len() - usize::from(missing_eno);
        let mut outputs = Vec::new();
        for position in 0..given {
            let local = self.code.results[position];
            outputs.push((position as u32, self.path(Root::Local(local), Vec::new())));
        }
        let callee = self.an.want(body);
        self.code.calls.push(Call {
            callee,
            refs,
            args,
            outputs,
        });
        let call = CallId(self.code.calls.len() as u32 - 1);
        let call = self.expr(ExprKind::Call(call), Elementary::Bool);
        let mut block = vec![self.stmt(StmtKind::Eval(call))];
        if missing_eno {
            let eno = *self.code.results.last().expect("ENO is a result");
            let path = self.path(Root::Local(eno), Vec::new());
            let one = self.expr(ExprKind::Const(1), Elementary::Bool);
            block.push(self.stmt(StmtKind::Assign(path, one)));
        }
        block
    }
}
