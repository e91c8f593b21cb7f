//! Calls: what is called, by which name, and EN.

mod arguments;
mod block;
mod builtin;
mod function;
mod mock;
mod order;
mod presence;

pub(super) use presence::Presence;

use super::object::Target;
use super::{Body, Operand, OperandKind, Place};
use crate::hir::code::StmtKind;
use crate::st::signature::{Def, PouId};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, ExprKind as Written, PouKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

/// What stands before the parentheses.
pub(super) enum Callee {
    /// Functions of one name; several are overloads of the library.
    Functions(Vec<PouId>),
    /// A block, by its instance.
    Block(PouId, Place),
    /// A method of an instance.
    Method(Target),
    /// A message has been given.
    Mistake,
}

impl Body<'_, '_> {
    /// Whether a name is EN or ENO.
    pub(super) fn is_enable(&self, name: Symbol) -> bool {
        name == self.an.words.en || name == self.an.words.eno
    }

    /// The argument for EN, if a call has one.
    pub(super) fn enable(&self, call: st::Id<st::Expr>) -> Option<st::Id<st::Expr>> {
        let Written::Call { arguments, .. } = self.arena()[call].kind else {
            return None;
        };
        let mut arguments = self.arena()[arguments].iter();
        let found = arguments.find(|argument| {
            matches!(argument.kind, ArgumentKind::Input(name) if name.name == self.an.words.en)
        })?;
        found.value
    }

    /// Where ENO of a call goes.
    pub(super) fn eno_target(&self, arguments: st::List<Argument>) -> Option<Argument> {
        let mut arguments = self.arena()[arguments].iter();
        let found = arguments.find(|argument| match argument.kind {
            ArgumentKind::Output(name) | ArgumentKind::NegatedOutput(name) => {
                name.name == self.an.words.eno
            }
            ArgumentKind::Positional | ArgumentKind::Input(_) => false,
        });
        found.copied()
    }

    /// What `run` does, only if the EN of a call is TRUE; else the call is skipped.
    pub(super) fn enabled(
        &mut self,
        call: st::Id<st::Expr>,
        enable: st::Id<st::Expr>,
        run: impl FnOnce(&mut Self) -> Operand,
    ) -> Operand {
        let Written::Call { arguments, .. } = self.arena()[call].kind else {
            unreachable!("what has EN is a call")
        };
        let condition = self.scalar_expr(enable, TypeId::BOOL);
        let (eno, range) = (self.eno_target(arguments), self.arena()[call].range);
        self.call_if(condition, eno, range, |body| {
            let noted = body.skips.insert(call);
            let result = run(body);
            if noted {
                body.skips.remove(&call);
            }
            result
        })
    }

    /// A call as a statement.
    pub(super) fn call_statement(&mut self, id: st::Id<st::Expr>) {
        if let Written::Call { callee, arguments } = self.arena()[id].kind
            && let Some(word) = self.test_word(callee)
        {
            return self.test_statement(word, arguments, self.arena()[id].range);
        }
        if let Some(enable) = self.enable(id)
            && !self.skips.contains(&id)
        {
            let range = self.arena()[id].range;
            self.enabled(id, enable, |body| {
                body.call_statement(id);
                Operand::nothing(range)
            });
            return;
        }
        let written = self.arena()[id];
        let Written::Call { callee, arguments } = written.kind else {
            let operand = self.place(id, None);
            if operand.is_error() {
                return;
            }
            if self.an.types.instance(operand.ty).is_some() {
                let name = self.type_name(operand.ty);
                let message = format!("an instance of {name} is called with parentheses");
                self.error(Message::E3004, written.range, message);
                return;
            }
            let message = "this does nothing; a call has parentheses";
            self.error(Message::E3012, written.range, message);
            return;
        };
        let callee = self.pointed_self(callee);
        if matches!(self.arena()[callee].kind, Written::Super) {
            self.super_call(arguments, written.range);
            return;
        }
        if let Some(value) = self.builtin(callee, arguments, written.range) {
            if !value.is_error() {
                let message = "this gives a value, which nobody takes";
                self.error(Message::E3012, written.range, message);
            }
            return;
        }
        match self.callee(callee, written.range) {
            Some(Callee::Block(pou, place)) => {
                self.block_call(pou, place, arguments, written.range);
            }
            Some(Callee::Mistake) | None => self.arguments_only(arguments),
            Some(callee) => {
                let result = self.call_of(callee, arguments, written.range, None);
                if let OperandKind::Value(value) = result.kind {
                    self.before(StmtKind::Eval(value), written.range);
                }
            }
        }
    }

    /// A call in an expression.
    pub(super) fn call(
        &mut self,
        id: st::Id<st::Expr>,
        callee: st::Id<st::Expr>,
        arguments: st::List<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        self.in_place(|body| body.call_anywhere(id, callee, arguments, range, want))
    }

    fn call_anywhere(
        &mut self,
        id: st::Id<st::Expr>,
        callee: st::Id<st::Expr>,
        arguments: st::List<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if let Some(enable) = self.enable(id)
            && !self.skips.contains(&id)
        {
            if self.constant_only {
                let message = "a constant is needed here, and EN may skip a call";
                return self.error(Message::E2030, range, message);
            }
            return self.enabled(id, enable, |body| body.expr(id, want));
        }
        if let Some(operand) = self.typed_conversion(callee, arguments, range, want) {
            return operand;
        }
        if let Some(operand) = self.clock(callee, arguments, range) {
            return operand;
        }
        if let Some(operand) = self.builtin(callee, arguments, range) {
            return operand;
        }
        match self.callee(callee, range) {
            Some(Callee::Mistake) | None => {
                self.arguments_only(arguments);
                Operand::error(range)
            }
            Some(Callee::Block(..)) => {
                self.arguments_only(arguments);
                let message = "a block gives no value; call it in a statement and use its outputs";
                self.error(Message::E3013, range, message)
            }
            Some(callee) => {
                let result = self.call_of(callee, arguments, range, want);
                if result.ty == TypeId::NOTHING {
                    return self.error(Message::E3014, range, "this function gives no value");
                }
                self.as_target(result)
            }
        }
    }

    fn call_of(
        &mut self,
        callee: Callee,
        arguments: st::List<Argument>,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        if self.constant_only {
            let Callee::Functions(functions) = &callee else {
                return self.error(Message::E2030, range, "a constant is needed here");
            };
            if !self.an.is_library(self.an.pou(functions[0]).unit) {
                return self.error(Message::E2030, range, "a constant is needed here");
            }
        }
        match callee {
            Callee::Functions(functions) => self.function_call(&functions, arguments, range, want),
            Callee::Method(target) => self.user_call(target, arguments, range),
            Callee::Block(..) | Callee::Mistake => unreachable!("handled by the callers"),
        }
    }

    /// After a mistake in what is called, mistakes in the arguments are still reported.
    fn arguments_only(&mut self, arguments: st::List<Argument>) {
        for argument in &self.arena()[arguments] {
            if let Some(value) = argument.value {
                self.expr(value, None);
            }
        }
    }

    fn callee(&mut self, id: st::Id<st::Expr>, range: TextRange) -> Option<Callee> {
        let written = self.arena()[id];
        if let Some(name) = written.kind.name() {
            return self.named_callee(name, id, written.range);
        }
        if let Written::Member { base, member } = written.kind {
            return self.member_callee(id, base, member);
        }
        if written.kind == Written::Super {
            let message = "SUPER() is a statement and gives no value";
            self.error(Message::E3003, range, message);
            return None;
        }
        self.instance_callee(id)
    }

    fn named_callee(
        &mut self,
        name: Symbol,
        id: st::Id<st::Expr>,
        range: TextRange,
    ) -> Option<Callee> {
        if self.own_symbol(name) {
            return self.instance_callee(id);
        }
        if let Some(callee) = self.own_method(name, range) {
            return Some(callee);
        }
        let defs = self.an.found_name(self.unit, self.namespace, name, range)?;
        self.functions_of(&defs).or_else(|| {
            match defs.first() {
                None => self.unknown_function(name, range),
                Some(Def::Global(_)) => return self.instance_callee(id),
                Some(Def::Pou(pou)) if self.an.pou(*pou).kind == PouKind::Program => {
                    return self.instance_callee(id);
                }
                Some(_) if self.an.unit(self.unit).lost_names => {}
                Some(&def) if self.an.is_damaged(def) => {}
                Some(&def) => self.no_function(def, name, range),
            }
            None
        })
    }

    fn no_function(&mut self, def: Def, name: Symbol, range: TextRange) {
        let name = self.text(name);
        let message = format!("`{name}` is no function");
        let mut diagnostic = Diagnostic::new(Message::E1018, self.span(range), message);
        if let Def::Pou(pou) = def
            && self.an.pou(pou).kind == PouKind::FunctionBlock
        {
            let note = format!("it is a block: declare an instance `x : {name};` and call that");
            diagnostic = diagnostic.note(note);
        }
        self.report(diagnostic);
    }

    fn unknown_function(&mut self, name: Symbol, range: TextRange) {
        if let Some(word) = self.an.testing.word(name) {
            let what = word.name();
            if self.in_test() {
                let message = format!("{what} is a statement and gives no value");
                self.error(Message::E3061, range, message);
            } else {
                self.outside_of_test(what, range);
            }
            return;
        }
        if self.an.lost_units || self.an.unit(self.unit).lost_names {
            return;
        }
        let message = format!("no function or instance is named `{}`", self.text(name));
        let mut diagnostic = Diagnostic::new(Message::E1018, self.span(range), message);
        let mut candidates = self.an.visible(self.namespace);
        if self.in_test() {
            candidates.extend(self.an.testing.words());
        }
        if let Some(close) = self.an.similar(name, candidates) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
    }

    fn functions_of(&self, defs: &[Def]) -> Option<Callee> {
        let functions: Vec<PouId> = defs
            .iter()
            .filter_map(|def| match def {
                Def::Pou(pou) if self.is_function(*pou) => Some(*pou),
                Def::Pou(_) | Def::Type(_) | Def::Global(_) | Def::Namespace(_) => None,
            })
            .collect();
        (!functions.is_empty()).then_some(Callee::Functions(functions))
    }

    fn member_callee(
        &mut self,
        id: st::Id<st::Expr>,
        base: st::Id<st::Expr>,
        member: st::Ident,
    ) -> Option<Callee> {
        let name = self.arena()[base].kind.name();
        let shadowed = name.is_some_and(|name| self.own_symbol(name));
        if !shadowed
            && let Some(&[Def::Namespace(namespace), ..]) =
                self.an.path(self.unit, self.namespace, base)
        {
            // What is INTERNAL on the way is reported there.
            self.an.found(self.unit, self.namespace, base)?;
            let defs = self
                .an
                .found_in(self.unit, self.namespace, namespace, member)?;
            if let Some(Def::Pou(pou)) = defs.first()
                && self.an.pou(*pou).kind == PouKind::Program
            {
                return self.instance_callee(id);
            }
            let found = self.functions_of(&defs);
            let damaged = defs.first().is_some_and(|&def| self.an.is_damaged(def));
            if found.is_none() && !damaged {
                let message = format!("the namespace has no function `{}`", self.text(member.name));
                self.error(Message::E1018, member.range, message);
            }
            return found;
        }
        let base = self.pointed_self(base);
        if matches!(self.arena()[base].kind, Written::Super) {
            return Some(self.super_method(member, self.arena()[id].range));
        }
        let operand = self.place(base, None);
        if operand.is_error() {
            return None;
        }
        if let Some(callee) = self.method_callee(&operand, member) {
            return Some(callee);
        }
        self.instance_callee(id)
    }

    fn instance_callee(&mut self, id: st::Id<st::Expr>) -> Option<Callee> {
        let operand = self.place(id, None);
        if operand.is_error() {
            return None;
        }
        if self.is_instance(&operand)
            && let (OperandKind::Place(place), TypeKind::Instance(pou)) =
                (&operand.kind, self.an.types.base(operand.ty))
        {
            let (pou, place) = (*pou, place.clone());
            if self.an.pou(pou).kind != PouKind::Class {
                return Some(Callee::Block(pou, place));
            }
        }
        let message = format!("{} cannot be called", self.type_name(operand.ty));
        let mut diagnostic = Diagnostic::new(Message::E1018, self.span(operand.range), message);
        if let TypeKind::Array { .. } = self.an.types.base(operand.ty) {
            diagnostic = diagnostic.note("an element is written with square brackets: a[3]");
        }
        self.report(diagnostic);
        None
    }
}
