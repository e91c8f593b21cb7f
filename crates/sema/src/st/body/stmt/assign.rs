//! Assignments, and what may be assigned to.

use crate::hir::code::StmtKind;
use crate::st::body::property::Target;
use crate::st::body::{Body, Operand, OperandKind, Place, Rights};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, AssignOp};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    pub(super) fn assign(
        &mut self,
        target: st::Id<st::Expr>,
        op: AssignOp,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) {
        if let Some(enable) = self.enable(value)
            && op == AssignOp::Set
            && !self.skips.contains(&value)
        {
            // Where the call is skipped, the variable keeps its value.
            self.enabled(value, enable, |body| {
                body.assign(target, op, value, range);
                Operand::nothing(range)
            });
            return;
        }
        if op != AssignOp::Set {
            self.special_assign(target, op, value, range);
            return;
        }
        let place = match self.assign_target(target) {
            Target::Place(place) => place,
            Target::Property(property) => {
                self.write_property(property, value, range);
                return;
            }
        };
        let want = (!place.is_error()).then_some(place.ty);
        let value = self.expr(value, want);
        let Some(to) = self.writable(&place) else {
            return;
        };
        self.store(&to, place.ty, &value, range);
        if let (TypeKind::Instance(pou), false) = (self.an.types.base(place.ty), value.is_error()) {
            let (name, span) = (self.text(self.an.pou(*pou).name), self.span(range));
            let message = format!("this copies all that an instance of {name} holds");
            let note = "its inputs, outputs and what it remembers, times and edges too";
            let warning = Diagnostic::new(Message::E3057, span, message);
            self.an.warn(warning.note(note));
        }
    }

    fn special_assign(
        &mut self,
        target: st::Id<st::Expr>,
        op: AssignOp,
        value: st::Id<st::Expr>,
        range: TextRange,
    ) {
        if op == AssignOp::Attempt {
            self.attempt(target, value, range);
            return;
        }
        if op == AssignOp::Bind {
            self.rebind(target, value, range);
            return;
        }
        let place = self.place(target, None);
        let value = self.expr(value, Some(TypeId::BOOL));
        let Some(to) = self.writable(&place) else {
            return;
        };
        if self.an.types.strip(place.ty) != TypeId::BOOL {
            let name = self.type_name(place.ty);
            let message = format!("`{}` is for BOOL, not {name}", op.as_str());
            self.error(Message::E2022, place.range, message);
            return;
        }
        self.latch(&to, op == AssignOp::Latch, &value, range);
    }

    /// Makes a BOOL TRUE or FALSE if a condition holds; else it keeps its value.
    fn latch(&mut self, to: &Place, to_value: bool, condition: &Operand, range: TextRange) {
        let condition = self.condition(condition);
        let path = self.path_of(to, range);
        let value = self.add_const(u64::from(to_value), crate::hir::Elementary::Bool, range);
        let store = self.add_stmt(StmtKind::Assign(path, value), range);
        let kind = StmtKind::If {
            arms: vec![(condition, vec![store])],
            otherwise: Vec::new(),
        };
        self.before(kind, range);
    }

    /// The place of an operand that is to be changed; a message if it must not be.
    pub(crate) fn writable(&mut self, operand: &Operand) -> Option<Place> {
        if operand.is_error() {
            return None;
        }
        let OperandKind::Place(place) = &operand.kind else {
            let (code, why) = match operand.kind {
                OperandKind::Value(_) => (Message::E3006, "this is a value, not a variable"),
                OperandKind::Error | OperandKind::Const(_) | OperandKind::Place(_) => {
                    (Message::E2006, "a constant cannot be changed")
                }
            };
            self.error(code, operand.range, why);
            return None;
        };
        let place = place.clone();
        let why = match place.rights {
            // Tests prepare what blocks give, and what comes from outside.
            Rights::OtherOutput | Rights::OwnInput if self.in_test() => return Some(place),
            Rights::All | Rights::Temporary if !self.is_loop_variable(&place) => {
                return Some(place);
            }
            Rights::All | Rights::Temporary => {
                "the loop counts in this variable, so its body cannot change it"
            }
            Rights::Constant => "this is a constant",
            Rights::OwnInput => "a unit cannot change its own inputs",
            Rights::OtherOutput => "an output can be changed by its block only",
            Rights::Value => "the value of a property is a copy; only as a whole it is assigned",
        };
        let code = match place.rights {
            Rights::Constant => Message::E2006,
            Rights::OwnInput | Rights::OtherOutput | Rights::Value => Message::E3006,
            Rights::All | Rights::Temporary => Message::E3007,
        };
        let mut diagnostic = Diagnostic::new(code, self.span(operand.range), why);
        if place.rights == Rights::OwnInput {
            diagnostic = diagnostic.note("copy it into a variable, and change that");
        }
        self.report(diagnostic);
        None
    }

    fn is_loop_variable(&self, place: &Place) -> bool {
        self.loops
            .iter()
            .flatten()
            .any(|(root, steps)| *root == place.root && *steps == place.steps)
    }
}
