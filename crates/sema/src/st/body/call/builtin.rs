//! Operators of CODESYS that are called like functions. A unit of the user with such a name is meant
//! where there is one.

use crate::st::body::{Body, Operand};
use crate::st::constant::Const;
use crate::st::signature::Def;
use crate::st::types::{ReferenceKind, TypeId};
use iecc_ast::st::{self, Argument, ArgumentKind, ExprKind as Written};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Builtin {
    Adr,
    SizeOf,
    IsValidRef,
    Query,
    Refused(&'static str),
}

/// Why memory is not looked at as bytes.
const BYTES: &str = "variables are no bytes here: assign them, or copy in a loop";

/// Why nothing is made at run time.
const NOTHING_MADE: &str = "all instances are there from the start";

/// Names and what they mean, or why they are refused.
const BUILTINS: [(&str, Builtin); 22] = [
    ("ADR", Builtin::Adr),
    ("SIZEOF", Builtin::SizeOf),
    ("XSIZEOF", Builtin::SizeOf),
    ("__ISVALIDREF", Builtin::IsValidRef),
    (
        "BITADR",
        Builtin::Refused("variables have no bit addresses"),
    ),
    ("INDEXOF", Builtin::Refused("units have no numbers")),
    (
        "INI",
        Builtin::Refused("instances are initialised once, at the start"),
    ),
    ("MEMCMP", Builtin::Refused(BYTES)),
    ("MEMCPY", Builtin::Refused(BYTES)),
    ("MEMMOVE", Builtin::Refused(BYTES)),
    ("MEMSET", Builtin::Refused(BYTES)),
    (
        "__COMPARE_AND_SWAP",
        Builtin::Refused("tasks do not run at once here"),
    ),
    ("__DELETE", Builtin::Refused(NOTHING_MADE)),
    ("__NEW", Builtin::Refused(NOTHING_MADE)),
    (
        "__POSITION",
        Builtin::Refused("programs do not know their text"),
    ),
    (
        "__POUNAME",
        Builtin::Refused("programs do not know their text"),
    ),
    ("__QUERYINTERFACE", Builtin::Query),
    (
        "__QUERYPOINTER",
        Builtin::Refused("`target ?= value` does it, with a reference to the block"),
    ),
    (
        "__VARINFO",
        Builtin::Refused("programs do not know their text"),
    ),
    ("__XADD", Builtin::Refused("tasks do not run at once here")),
    (
        "F_GETTASKINDEX",
        Builtin::Refused("units do not know their task"),
    ),
    (
        "TEST_AND_SET",
        Builtin::Refused("tasks do not run at once here"),
    ),
];

impl Body<'_, '_> {
    /// A call of an operator of CODESYS; `None` if it is none.
    pub(crate) fn builtin(
        &mut self,
        callee: st::Id<st::Expr>,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Option<Operand> {
        let Written::Name(name) = self.arena()[callee].kind else {
            return None;
        };
        let text = self.text(name);
        let (word, builtin) = BUILTINS
            .iter()
            .find(|(word, _)| word.eq_ignore_ascii_case(text))?;
        if self.own_symbol(name) || !self.an.lookup(self.namespace, name).is_empty() {
            return None;
        }
        if !self.an.options.codesys {
            self.an.foreign(self.unit, range, word);
            return Some(Operand::error(range));
        }
        if let Builtin::Refused(why) = builtin {
            let message = format!("{word} is not compiled");
            let diagnostic = Diagnostic::new(Message::E8002, self.span(range), message);
            self.report(diagnostic.note(*why));
            return Some(Operand::error(range));
        }
        let given = self.arena()[arguments].iter();
        let given = given.filter(|argument| argument.kind == ArgumentKind::Positional);
        let given: Vec<st::Id<st::Expr>> = given.filter_map(|argument| argument.value).collect();
        let complete = given.len() == arguments.len();
        Some(match (builtin, &given[..]) {
            (Builtin::Adr, &[value]) if complete => {
                self.reference_to(value, ReferenceKind::Pointer, range)
            }
            (Builtin::SizeOf, &[value]) if complete => self.size_of(value, range),
            (Builtin::IsValidRef, &[value]) if complete => self.is_valid_reference(value, range),
            (Builtin::Query, &[value, target]) if complete => {
                self.query_interface(value, target, range)
            }
            _ => {
                let count = if *builtin == Builtin::Query {
                    "two arguments"
                } else {
                    "one argument"
                };
                let message = format!("{word} takes {count}, by position");
                self.error(Message::E3021, range, message)
            }
        })
    }

    /// `__QUERYINTERFACE(value, target)`: an attempt, and whether it succeeds.
    fn query_interface(
        &mut self,
        value: st::Id<st::Expr>,
        target: st::Id<st::Expr>,
        range: TextRange,
    ) -> Operand {
        self.attempt(target, value, range);
        if self.an.found.has_errors() {
            return Operand::error(range);
        }
        let target = self.place(target, None);
        let null = Operand::constant(Const::Null, TypeId::NULL, range);
        self.binary_on(st::BinaryOp::NotEqual, target, null, range, None)
    }

    /// `SIZEOF(x)`, `SIZEOF(type)`.
    fn size_of(&mut self, value: st::Id<st::Expr>, range: TextRange) -> Operand {
        let Some(ty) = self.measured(value) else {
            return Operand::error(range);
        };
        match self.an.size_of(ty) {
            Ok(bytes) => {
                let bytes = Const::Int(i128::from(bytes));
                Operand::constant(bytes, TypeId::UNTYPED_INT, range)
            }
            Err(why) => {
                let name = self.type_name(ty);
                let message = format!("the size of {name} is not told: {why}");
                self.error(Message::E8002, range, message)
            }
        }
    }

    /// The type whose size is asked for: it is written, or that of a variable.
    fn measured(&mut self, value: st::Id<st::Expr>) -> Option<TypeId> {
        let named = self.named_type(value);
        if let Some(ty) = named.or_else(|| self.type_of_named(value)) {
            return (ty != TypeId::ERROR).then_some(ty);
        }
        // Nothing of it is evaluated, so it may be a variable where a constant is needed.
        let constant_only = std::mem::replace(&mut self.constant_only, false);
        let pending = std::mem::take(&mut self.pending);
        let operand = self.expr(value, None);
        self.pending = pending;
        self.constant_only = constant_only;
        (!operand.is_error()).then(|| self.settle(&operand))
    }

    /// The type of a variable by its name alone, which may be asked for where constants are needed.
    fn type_of_named(&mut self, value: st::Id<st::Expr>) -> Option<TypeId> {
        let Written::Name(name) = self.arena()[value].kind else {
            return None;
        };
        if let Some(var) = self.pou.and_then(|pou| self.an.pou(pou).var(name)) {
            return Some(var.ty);
        }
        if self.own_symbol(name) {
            return None;
        }
        match *self.an.lookup(self.namespace, name).first()? {
            Def::Global(id) => {
                self.an.complete_global(id);
                Some(self.an.global(id).ty)
            }
            Def::Type(_) | Def::Pou(_) | Def::Namespace(_) => None,
        }
    }

    fn named_type(&mut self, value: st::Id<st::Expr>) -> Option<TypeId> {
        let scope = self.type_scope();
        if let Written::Name(name) = self.arena()[value].kind {
            if self.own_symbol(name) {
                return None;
            }
            if let Some(&ty) = self.an.elementary_names.get(&name) {
                return Some(ty);
            }
        }
        let defs = self.an.path(self.unit, self.namespace, value)?;
        let is_type = match defs.first()? {
            Def::Type(_) => true,
            Def::Pou(pou) => {
                let kind = self.an.pou(*pou).kind;
                matches!(kind, st::PouKind::FunctionBlock | st::PouKind::Class)
            }
            Def::Global(_) | Def::Namespace(_) => false,
        };
        is_type.then(|| self.an.type_by_path(scope, value))
    }
}
