//! Statements.

use super::property::Target;
use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::code::{Block, ExprId, ExprKind, Root, StmtKind};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::lint::can_leave;
use crate::st::signature::{PouId, Storage};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::st::{self, AssignOp, SectionKind, StmtKind as Written};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// Initial values of what lives as long as the call, then the statements of the unit.
    pub(super) fn statements_of(&mut self, id: PouId) {
        let mut body = Vec::new();
        self.initialise(id, &mut body);
        self.sample_edges(id, &mut body);
        if let Some(eno) = self.eno {
            let range = TextRange::default();
            let path = self.add_path(Root::Local(eno), Vec::new(), range);
            let value = self.add_const(1, crate::hir::Elementary::Bool, range);
            body.push(self.add_stmt(StmtKind::Assign(path, value), range));
        }
        self.mocked_result(id, &mut body);
        if let Some(written) = self.an.written_body(id) {
            body.extend(self.block(written));
        }
        self.code.body = body;
    }

    /// Variables that are made anew by every call get their initial values, the result included.
    fn initialise(&mut self, id: PouId, body: &mut Block) {
        let pou = self.an.pou(id).clone();
        for (index, var) in pou.vars.iter().enumerate() {
            let reset = match var.storage {
                Storage::Local => var.section != SectionKind::Input,
                Storage::Ref(_) => var.section == SectionKind::Output,
                Storage::Field(_)
                | Storage::Global(_)
                | Storage::Const(_)
                | Storage::Located(_) => false,
            };
            if !reset {
                continue;
            }
            let root = match (&var.storage, self.locals[index]) {
                (Storage::Ref(reference), _) => Root::Ref(*reference),
                (_, Some(local)) => Root::Local(local),
                (_, None) => continue,
            };
            match var.initial {
                Some(initial) if self.an.is_address(var.ty) => {
                    self.start_reference(root, var, initial, body);
                }
                _ => {
                    let init = self.own_init(var);
                    self.start(root, init, var.range, body);
                }
            }
        }
        let result = self
            .result
            .map(Root::Local)
            .or(self.result_ref.map(Root::Ref));
        if let (Some(root), Some(ty)) = (result, pou.result) {
            let init = self.an.default_init(ty);
            self.start(root, init, TextRange::default(), body);
        }
    }

    /// Locals are 0 at the start; what is passed by reference is not.
    fn start(
        &mut self,
        root: Root,
        init: Option<crate::hir::InitId>,
        range: TextRange,
        body: &mut Block,
    ) {
        let init = match (root, init) {
            (Root::Ref(_), None) => self.an.init(crate::hir::code::Init::Zero),
            (_, None) => return,
            (_, Some(init)) => init,
        };
        let path = self.add_path(root, Vec::new(), range);
        body.push(self.add_stmt(StmtKind::Initialise(path, init), range));
    }

    /// Statements, with what has to run before each of them.
    pub(super) fn block(&mut self, block: st::Block) -> Block {
        let mut statements = Vec::with_capacity(block.len());
        for &stmt in &self.arena()[block] {
            let outer = std::mem::take(&mut self.pending);
            let made = self.statement(stmt);
            statements.append(&mut self.pending);
            self.pending = outer;
            if let Some(kind) = made {
                let range = self.arena()[stmt].range;
                statements.push(self.add_stmt(kind, range));
            }
        }
        statements
    }

    fn statement(&mut self, id: st::Id<st::Stmt>) -> Option<StmtKind> {
        let arena = self.arena();
        let range = arena[id].range;
        match arena[id].kind {
            Written::Assign { target, op, value } => {
                self.assign(target, op, value, range);
                None
            }
            Written::Call(call) => {
                self.call_statement(call);
                None
            }
            Written::If { arms, otherwise } => Some(self.if_statement(arms, otherwise)),
            Written::Case {
                selector,
                arms,
                otherwise,
            } => self.case(selector, arms, otherwise),
            Written::For {
                variable,
                from,
                to,
                by,
                body,
            } => self.for_loop(variable, from, to, by, body, range),
            Written::While { condition, body } => {
                let value = self.loop_condition(condition);
                self.must_end(value, 1, condition, body);
                self.loops.push(None);
                let body = self.block(body);
                self.loops.pop();
                Some(StmtKind::While(value, body))
            }
            Written::Repeat { body, until } => {
                self.loops.push(None);
                let made = self.block(body);
                self.loops.pop();
                let value = self.loop_condition(until);
                self.must_end(value, 0, until, body);
                Some(StmtKind::Repeat(made, value))
            }
            Written::Return => Some(StmtKind::Return),
            Written::Mock(instance) => {
                self.mock(instance, range);
                None
            }
            Written::MockFunction { function, value } => {
                self.mock_function(function, value, range);
                None
            }
            Written::Exit => self.in_loop("EXIT", StmtKind::Exit, range),
            Written::Continue => self.in_loop("CONTINUE", StmtKind::Continue, range),
            Written::Empty | Written::Error => None,
        }
    }

    fn in_loop(&mut self, word: &str, kind: StmtKind, range: TextRange) -> Option<StmtKind> {
        if self.loops.is_empty() {
            self.error(
                Message::E3005,
                range,
                format!("{word} stands outside of a loop"),
            );
            return None;
        }
        Some(kind)
    }

    /// A condition that is evaluated again and again: what has to run before it becomes part of it.
    fn loop_condition(&mut self, id: st::Id<st::Expr>) -> ExprId {
        let outer = std::mem::take(&mut self.pending);
        let operand = self.expr(id, Some(TypeId::BOOL));
        let value = self.condition(&operand);
        let inner = std::mem::replace(&mut self.pending, outer);
        if inner.is_empty() {
            return value;
        }
        let kind = ExprKind::After(inner, value);
        self.add_expr(kind, crate::hir::Elementary::Bool, operand.range)
    }

    /// A loop whose condition is always the one that repeats needs another way out.
    fn must_end(
        &mut self,
        condition: ExprId,
        repeats: u64,
        written: st::Id<st::Expr>,
        body: st::Block,
    ) {
        let arena = self.arena();
        let constant = self.code.expr(condition).kind == ExprKind::Const(repeats);
        let broken = arena[written].kind == st::ExprKind::Error;
        if constant && !broken && !self.an.found.has_errors() && !can_leave(arena, body, false) {
            let message = "this loop never ends: its condition is constant, and nothing leaves it";
            self.error(Message::E3041, arena[written].range, message);
        }
    }

    fn if_statement(
        &mut self,
        arms: st::List<st::IfArm>,
        otherwise: Option<st::Block>,
    ) -> StmtKind {
        let mut made = Vec::with_capacity(arms.len());
        for (index, arm) in self.arena()[arms].iter().enumerate() {
            // Only the first condition is evaluated in any case.
            let condition = if index == 0 {
                let operand = self.expr(arm.condition, Some(TypeId::BOOL));
                self.condition(&operand)
            } else {
                self.loop_condition(arm.condition)
            };
            made.push((condition, self.block(arm.body)));
        }
        StmtKind::If {
            arms: made,
            otherwise: otherwise.map_or_else(Vec::new, |block| self.block(block)),
        }
    }

    fn assign(
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
            self.enabled(value, enable, |body| body.assign(target, op, value, range));
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
    pub(super) fn writable(&mut self, operand: &Operand) -> Option<Place> {
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
        self.error(code, operand.range, why);
        None
    }

    fn is_loop_variable(&self, place: &Place) -> bool {
        self.loops
            .iter()
            .flatten()
            .any(|(root, steps)| *root == place.root && *steps == place.steps)
    }

    fn for_loop(
        &mut self,
        variable: st::Id<st::Expr>,
        from: st::Id<st::Expr>,
        to: st::Id<st::Expr>,
        by: Option<st::Id<st::Expr>>,
        body: st::Block,
        range: TextRange,
    ) -> Option<StmtKind> {
        let counter = self.place(variable, None);
        let el = self
            .an
            .types
            .elementary(counter.ty)
            .filter(|el| self.counts(*el));
        if el.is_none() && !counter.is_error() {
            let message = format!(
                "a loop counts in an integer, not {}",
                self.type_name(counter.ty)
            );
            self.error(Message::E3008, counter.range, message);
        }
        let ty = el.map_or(TypeId::ERROR, TypeId::of);
        let from = self.expr(from, Some(ty));
        let to = self.expr(to, Some(ty));
        let step = by.map(|by| self.expr(by, Some(ty)));
        let place = self.writable(&counter);
        let key = place
            .as_ref()
            .map(|place| (place.root, place.steps.clone()));
        if let Some(step) = &step
            && matches!(step.as_const(), Some(Const::Int(0)))
        {
            self.error(Message::E3009, step.range, "a step of 0 never ends");
        }
        let parts = place.zip(el).map(|(place, el)| {
            let (from, to) = (self.as_scalar(&from, ty), self.as_scalar(&to, ty));
            let by = match &step {
                Some(step) => self.loop_step(step, el),
                None => self.add_const(1, el.storage(), range),
            };
            (self.path_of(&place, counter.range), from, to, by)
        });
        self.loops.push(key);
        let body = self.block(body);
        self.loops.pop();
        let (variable, from, to, by) = parts?;
        Some(StmtKind::For {
            variable,
            from,
            to,
            by,
            body,
        })
    }

    fn loop_step(&mut self, step: &Operand, el: El) -> ExprId {
        self.as_scalar(step, TypeId::of(el))
    }

    fn case(
        &mut self,
        selector: st::Id<st::Expr>,
        arms: st::List<st::CaseArm>,
        otherwise: Option<st::Block>,
    ) -> Option<StmtKind> {
        let operand = self.expr(selector, None);
        let ty = self.settle(&operand);
        let compared =
            self.an.types.is_text(ty) || self.an.types.elementary(ty).is_some_and(El::is_real);
        if compared && !operand.is_error() {
            return Some(self.case_by_comparison(operand, arms, otherwise));
        }
        let types = &self.an.types;
        let whole =
            types.enumeration(ty).is_some() || types.elementary(ty).is_some_and(|el| !el.is_real());
        if !whole && !operand.is_error() {
            let message = format!(
                "CASE takes whole numbers and enumerators, not {}",
                self.type_name(ty)
            );
            self.error(Message::E3010, operand.range, message);
        }
        let known = whole && !operand.is_error();
        let ty = if known { ty } else { TypeId::ERROR };
        let selector = if known {
            self.raw(&operand)
        } else {
            self.add_const(0, crate::hir::Elementary::Dint, operand.range)
        };
        let mut made = Vec::with_capacity(arms.len());
        let mut taken: Vec<(i128, i128, TextRange)> = Vec::new();
        for arm in &self.arena()[arms] {
            let mut ranges = Vec::with_capacity(arm.labels.len());
            for label in &self.arena()[arm.labels] {
                if let Some((low, high, range)) = self.label(label, ty) {
                    self.overlap(&mut taken, low, high, range);
                    let bits = |value: i128| Const::Int(value);
                    let (low, high) = (bits(low), bits(high));
                    ranges.push((self.const_bits(&low, ty), self.const_bits(&high, ty)));
                }
            }
            made.push((ranges, self.block(arm.body)));
        }
        if otherwise.is_none() {
            self.missing_enumerators(ty, &taken, operand.range);
        }
        Some(StmtKind::Case {
            selector,
            arms: made,
            otherwise: otherwise.map_or_else(Vec::new, |block| self.block(block)),
        })
    }

    /// Warns of a CASE without ELSE that leaves out values of its enumeration.
    fn missing_enumerators(
        &mut self,
        ty: TypeId,
        taken: &[(i128, i128, TextRange)],
        range: TextRange,
    ) {
        let Some(def) = self.an.types.enumeration(ty) else {
            return;
        };
        let is_taken = |value: i128| {
            taken
                .iter()
                .any(|(low, high, _)| (*low..=*high).contains(&value))
        };
        let missing = def.values.iter().filter(|(_, value)| !is_taken(*value));
        let names: Vec<&str> = missing.map(|(name, _)| self.text(*name)).collect();
        if def.named_values || names.is_empty() || self.an.is_library(self.unit) {
            return;
        }
        let message = format!("nothing is done for `{}`", names.join("`, `"));
        let diagnostic = Diagnostic::new(Message::E3053, self.span(range), message)
            .note("ELSE with `;` says that nothing is meant");
        self.an.warn(diagnostic);
    }

    /// CASE of strings and reals: labels are compared in their order.
    fn case_by_comparison(
        &mut self,
        selector: Operand,
        arms: st::List<st::CaseArm>,
        otherwise: Option<st::Block>,
    ) -> StmtKind {
        let selector = self.hold(selector);
        let mut made = Vec::with_capacity(arms.len());
        for arm in &self.arena()[arms] {
            let outer = std::mem::take(&mut self.pending);
            let mut condition: Option<Operand> = None;
            for label in &self.arena()[arm.labels] {
                let next = self.label_condition(&selector, label);
                condition = Some(match condition {
                    None => next,
                    Some(before) => {
                        let range = next.range;
                        self.binary_on(st::BinaryOp::Or, before, next, range, None)
                    }
                });
            }
            let condition = condition.unwrap_or_else(|| Operand::error(arm.range));
            let mut value = self.condition(&condition);
            let inner = std::mem::replace(&mut self.pending, outer);
            if !inner.is_empty() {
                let kind = ExprKind::After(inner, value);
                value = self.add_expr(kind, crate::hir::Elementary::Bool, arm.range);
            }
            made.push((value, self.block(arm.body)));
        }
        StmtKind::If {
            arms: made,
            otherwise: otherwise.map_or_else(Vec::new, |block| self.block(block)),
        }
    }

    fn label_condition(&mut self, selector: &Operand, label: &st::Label) -> Operand {
        let low = self.expr(label.low, Some(selector.ty));
        let range = low.range;
        let Some(high) = label.high else {
            return self.binary_on(st::BinaryOp::Equal, selector.clone(), low, range, None);
        };
        let high = self.expr(high, Some(selector.ty));
        let above = st::BinaryOp::GreaterEqual;
        let above = self.binary_on(above, selector.clone(), low, range, None);
        let below = self.binary_on(st::BinaryOp::LessEqual, selector.clone(), high, range, None);
        self.binary_on(st::BinaryOp::And, above, below, range, None)
    }

    /// The first and last value of a label.
    fn label(&mut self, label: &st::Label, ty: TypeId) -> Option<(i128, i128, TextRange)> {
        let arena = self.arena();
        let mut range = arena[label.low].range;
        let low = self.label_value(label.low, ty);
        let high = match label.high {
            None => low,
            Some(high) => {
                range = range.to(arena[high].range);
                self.label_value(high, ty)
            }
        };
        let (low, high) = (low?, high?);
        if low > high {
            let message = format!("the range begins at {low}, above its end {high}");
            self.error(Message::E2023, range, message);
            return None;
        }
        Some((low, high, range))
    }

    fn label_value(&mut self, id: st::Id<st::Expr>, ty: TypeId) -> Option<i128> {
        let operand = self.expr(id, (ty != TypeId::ERROR).then_some(ty));
        if operand.is_error() || ty == TypeId::ERROR {
            return None;
        }
        if operand.as_const().is_none() {
            self.error(Message::E2030, operand.range, "a label is a constant");
            return None;
        }
        // Labels of a subrange may be any values of its base.
        let subrange = self.an.types.subrange(ty);
        let ty = subrange.map_or(ty, |(base, _)| TypeId::of(base));
        self.constant_to(&operand, ty)?.as_int()
    }

    fn overlap(
        &mut self,
        taken: &mut Vec<(i128, i128, TextRange)>,
        low: i128,
        high: i128,
        range: TextRange,
    ) {
        let at = taken.partition_point(|(_, last, _)| *last < low);
        if let Some(&(first, _, other)) = taken.get(at)
            && first <= high
        {
            let diagnostic = Diagnostic::new(
                Message::E3011,
                self.span(range),
                "another label stands for this value",
            );
            let other = self.span(other);
            self.report(diagnostic.also(other, "here first"));
            return;
        }
        taken.insert(at, (low, high, range));
    }
}
