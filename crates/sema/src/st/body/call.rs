//! Calls: what is called, which argument goes where.

use super::object::{Run, Target};
use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::code::{Call, ExprKind, PathId, PathStep, Root, StmtKind};
use crate::st::constant::Const;
use crate::st::signature::{Def, PouId, Storage, Var};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, ExprKind as Written, PouKind, SectionKind};
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

    /// What `run` does, only if the EN of a call is TRUE; else ENO of the call is FALSE and nothing
    /// happens.
    pub(super) fn enabled(
        &mut self,
        call: st::Id<st::Expr>,
        enable: st::Id<st::Expr>,
        run: impl FnOnce(&mut Self),
    ) {
        let range = self.arena()[call].range;
        let condition = self.scalar_expr(enable, TypeId::BOOL);
        let outer = std::mem::take(&mut self.pending);
        let skipped = self.skips.insert(call);
        run(self);
        if skipped {
            self.skips.remove(&call);
        }
        let then = std::mem::take(&mut self.pending);
        if let Written::Call { arguments, .. } = self.arena()[call].kind
            && let Some(eno) = self.eno_target(arguments)
            && let Some(target) = eno.value
        {
            let none = Operand::constant(Const::Int(0), TypeId::BOOL, range);
            self.output_to(none, target, &eno);
        }
        let otherwise = std::mem::replace(&mut self.pending, outer);
        let kind = StmtKind::If {
            arms: vec![(condition, then)],
            otherwise,
        };
        self.before(kind, range);
    }

    /// The value of a call with EN inside of an expression: where the call is skipped, the default
    /// of its type.
    fn enabled_value(
        &mut self,
        id: st::Id<st::Expr>,
        enable: st::Id<st::Expr>,
        want: Option<TypeId>,
    ) -> Operand {
        let range = self.arena()[id].range;
        let mut result = Operand::error(range);
        self.enabled(id, enable, |body| {
            let value = body.expr(id, want);
            if value.is_error() {
                return;
            }
            let ty = body.settle(&value);
            let place = body.temporary("result", ty);
            body.store(&place, ty, &value, range);
            result = Operand {
                kind: OperandKind::Place(place),
                ty,
                range,
            };
        });
        result
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
            self.enabled(id, enable, |body| body.call_statement(id));
            return;
        }
        let written = self.arena()[id];
        let Written::Call { callee, arguments } = written.kind else {
            let operand = self.place(id, None);
            if operand.is_error() {
                return;
            }
            if let TypeKind::Instance(_) = self.an.types.base(operand.ty) {
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
                self.block_call(pou, &place, arguments, written.range);
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
        if let Some(enable) = self.enable(id)
            && !self.skips.contains(&id)
        {
            if self.constant_only {
                let message = "a constant is needed here, and EN may skip a call";
                return self.error(Message::E2030, range, message);
            }
            return self.enabled_value(id, enable, want);
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
        match written.kind {
            Written::Name(name) => self.named_callee(name, id, written.range),
            Written::Member { base, member } => self.member_callee(id, base, member),
            Written::Super => {
                let message = "SUPER() is a statement and gives no value";
                self.error(Message::E3003, range, message);
                None
            }
            _ => self.instance_callee(id),
        }
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
                Some(_) => {
                    let message = format!("`{}` is no function", self.text(name));
                    self.error(Message::E1018, range, message);
                }
            }
            None
        })
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
        let shadowed = match self.arena()[base].kind {
            Written::Name(name) => self.own_symbol(name),
            _ => false,
        };
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
            if found.is_none() {
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
                let place = self.freeze(place, operand.range);
                return Some(Callee::Block(pou, place));
            }
        }
        let message = format!("{} cannot be called", self.type_name(operand.ty));
        self.error(Message::E1018, operand.range, message);
        None
    }

    /// The place with its subscripts and references evaluated now, for several uses.
    fn freeze(&mut self, mut place: Place, range: TextRange) -> Place {
        if let Root::Deref { address, .. } = &mut place.root {
            *address = self.freeze_value(*address, range);
        }
        for step in &mut place.steps {
            if let PathStep::IndexBy { value, .. } | PathStep::Character { value, .. } = step {
                *value = self.freeze_value(*value, range);
            }
        }
        place
    }

    fn freeze_value(
        &mut self,
        value: crate::hir::code::ExprId,
        range: TextRange,
    ) -> crate::hir::code::ExprId {
        let ty = self.code.expr(value).ty;
        let local = self.add_local("index", crate::hir::Type::Elementary(ty));
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        self.before(StmtKind::Assign(path, value), range);
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        self.add_expr(ExprKind::Load(path), ty, range)
    }

    /// `instance(input := …, output => …)`.
    fn block_call(
        &mut self,
        pou: PouId,
        place: &Place,
        arguments: st::List<Argument>,
        range: TextRange,
    ) {
        self.an.complete(pou);
        let Some(pou) = self.open_instance(pou, arguments, range) else {
            return;
        };
        let matched = self.matched(pou, arguments, range);
        let mut refs: Vec<Option<PathId>> = Vec::new();
        let shape = self.an.call_shape(pou);
        refs.resize(shape.refs.len(), None);
        for (var, argument) in &matched {
            let Some(value) = argument.value else {
                continue;
            };
            match var.section {
                SectionKind::Input => self.block_input(pou, place, var, value),
                SectionKind::InOut => {
                    let path = self.in_out(var, value);
                    if let (Storage::Ref(position), Some(path)) = (&var.storage, path) {
                        refs[*position as usize - 1] = Some(path);
                    }
                }
                _ => {}
            }
        }
        self.require_in_outs(pou, &matched, range);
        let run = self.run(pou, place, None, pou, range);
        let given: Option<Vec<PathId>> = refs.into_iter().collect();
        let eno = self.eno_target(arguments);
        let mut changes_eno = false;
        let eno_place = eno.map(|_| self.temporary("ENO", TypeId::BOOL));
        if let Some(given) = given {
            let target = Target {
                signature: pou,
                run,
            };
            changes_eno = self.shape_of(&target).eno;
            let callee = self.run_unit(&target);
            let (mut refs, mut args) = (Vec::new(), Vec::new());
            match &target.run {
                Run::Function => {}
                Run::On { instance, .. } => refs.push(self.path_of(instance, range)),
                Run::Choose { address, .. } => args.push(*address),
            }
            refs.extend(given);
            let mut outputs = Vec::new();
            if let (true, Some(eno)) = (changes_eno, &eno_place) {
                outputs.push((0, self.path_of(eno, range)));
            }
            let call = self.add_call(Call {
                callee,
                refs,
                args,
                outputs,
            });
            let value = self.add_expr(ExprKind::Call(call), crate::hir::Elementary::Bool, range);
            let call = self.add_stmt(StmtKind::Eval(value), range);
            let eno = eno_place.as_ref().filter(|_| changes_eno);
            let call = self.unless_mocked(pou, place, call, eno, range);
            self.pending.push(call);
        }
        for (var, argument) in &matched {
            if var.section == SectionKind::Output {
                self.block_output(pou, place, var, argument);
            }
        }
        if let (Some(eno), Some(place)) = (eno, eno_place) {
            self.eno_to(changes_eno, place, &eno);
        }
    }

    /// Stores the ENO of a call; it is TRUE where the body does not change it.
    pub(super) fn eno_to(&mut self, changes: bool, place: Place, argument: &Argument) {
        let value = if changes {
            Operand {
                kind: OperandKind::Place(place),
                ty: TypeId::BOOL,
                range: argument.range,
            }
        } else {
            Operand::constant(Const::Int(1), TypeId::BOOL, argument.range)
        };
        if let Some(target) = argument.value {
            self.output_to(value, target, argument);
        }
    }

    fn block_input(&mut self, pou: PouId, place: &Place, var: &Var, value: st::Id<st::Expr>) {
        let operand = self.expr(value, Some(var.ty));
        let Some(steps) = self.field_steps(pou, place, var) else {
            return;
        };
        let target = Place {
            root: place.root,
            steps,
            rights: Rights::All,
        };
        self.store(&target, var.ty, &operand, operand.range);
    }

    /// The steps to a variable of an instance or of what it extends.
    fn field_steps(&self, pou: PouId, place: &Place, var: &Var) -> Option<Vec<PathStep>> {
        let Storage::Field(field) = var.storage else {
            return None;
        };
        let (of, _) = self.an.instance_var(pou, var.name)?;
        let mut steps = place.steps.clone();
        let distance = self.an.base_distance(pou, of).unwrap_or(0);
        steps.extend(std::iter::repeat_n(PathStep::Field(0), distance));
        steps.push(PathStep::Field(field));
        Some(steps)
    }

    fn block_output(&mut self, pou: PouId, place: &Place, var: &Var, argument: &Argument) {
        let Some(target) = argument.value else { return };
        let Some(steps) = self.field_steps(pou, place, var) else {
            return;
        };
        let from = Operand {
            kind: OperandKind::Place(Place {
                root: place.root,
                steps,
                rights: Rights::OtherOutput,
            }),
            ty: var.ty,
            range: argument.range,
        };
        self.output_to(from, target, argument);
    }

    /// Stores an output where `=>` points.
    pub(super) fn output_to(
        &mut self,
        from: Operand,
        target: st::Id<st::Expr>,
        argument: &Argument,
    ) {
        let target = self.place(target, None);
        let Some(to) = self.writable(&target) else {
            return;
        };
        let from = if matches!(argument.kind, ArgumentKind::NegatedOutput(_)) {
            self.unary_on(st::UnaryOp::Not, from, argument.range, None)
        } else {
            from
        };
        self.store(&to, target.ty, &from, argument.range);
    }

    /// The place an in-out stands for.
    pub(super) fn in_out(&mut self, var: &Var, value: st::Id<st::Expr>) -> Option<PathId> {
        let operand = self.place(value, None);
        self.reference_argument(var, &operand)
    }

    pub(super) fn require_in_outs(
        &mut self,
        pou: PouId,
        matched: &[(Var, Argument)],
        range: TextRange,
    ) {
        let missing: Vec<Symbol> = self
            .an
            .pou(pou)
            .section(SectionKind::InOut)
            .filter(|var| !matched.iter().any(|(given, _)| given.name == var.name))
            .map(|var| var.name)
            .collect();
        for name in missing {
            let message = format!("in-out `{}` has no argument", self.text(name));
            self.error(Message::E3016, range, message);
        }
    }

    /// Which argument goes to which parameter, in the order of the arguments.
    pub(super) fn matched(
        &mut self,
        pou: PouId,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Vec<(Var, Argument)> {
        let written: Vec<Argument> = self.arena()[arguments].to_vec();
        let positional = written
            .iter()
            .filter(|argument| argument.kind == ArgumentKind::Positional)
            .count();
        if positional > 0 && positional < written.len() && !self.an.options.codesys {
            let message = "arguments are given either all by name or all by position";
            self.error(Message::E3017, range, message);
        }
        let parameters = self.an.all_parameters(pou);
        if positional > parameters.len() {
            let message = format!(
                "{positional} arguments are given but `{}` has {} parameters",
                self.text(self.an.pou(pou).name),
                parameters.len()
            );
            self.error(Message::E3018, range, message);
        }
        if positional > 0 && positional == written.len() {
            self.require_positions(pou, &parameters, positional, range);
        }
        let mut matched: Vec<(Var, Argument)> = Vec::with_capacity(written.len());
        let mut next = 0;
        for argument in written {
            let var = match argument.kind {
                ArgumentKind::Positional => {
                    next += 1;
                    parameters.get(next - 1)
                }
                ArgumentKind::Input(name)
                | ArgumentKind::Output(name)
                | ArgumentKind::NegatedOutput(name) => {
                    if self.is_enable(name.name) {
                        continue;
                    }
                    let alias = self.an.parameter_alias(pou, name.name);
                    let wanted = alias.unwrap_or(name.name);
                    let found = parameters.iter().find(|var| var.name == wanted);
                    if found.is_none() {
                        let known = parameters.iter().map(|var| var.name);
                        self.no_parameter(pou, name, known);
                    }
                    found
                }
            };
            let Some(var) = var else {
                if let Some(value) = argument.value {
                    self.expr(value, None);
                }
                continue;
            };
            if matched.iter().any(|(given, _)| given.name == var.name) {
                let message = format!("`{}` is given twice", self.text(var.name));
                self.error(Message::E3019, argument.range, message);
                continue;
            }
            if self.right_arrow(var, &argument) {
                matched.push((var.clone(), argument));
            }
        }
        matched
    }

    /// Arguments by position reach to the last input and in-out.
    fn require_positions(
        &mut self,
        pou: PouId,
        parameters: &[Var],
        positional: usize,
        range: TextRange,
    ) {
        let missing = parameters.iter().skip(positional);
        let missing: Vec<&str> = missing
            .filter(|var| var.section != SectionKind::Output)
            .map(|var| self.text(var.name))
            .collect();
        if missing.is_empty() || self.an.options.codesys {
            return;
        }
        let name = self.text(self.an.pou(pou).name);
        let message = format!("`{name}` has no argument for `{}`", missing.join("`, `"));
        let note = "arguments by position are complete; with names some may be left out";
        let diagnostic = Diagnostic::new(Message::E3022, self.span(range), message).note(note);
        self.report(diagnostic);
    }

    /// Whether inputs stand with `:=` and outputs with `=>`.
    fn right_arrow(&mut self, var: &Var, argument: &Argument) -> bool {
        let output = matches!(
            argument.kind,
            ArgumentKind::Output(_) | ArgumentKind::NegatedOutput(_)
        );
        let named = argument.kind != ArgumentKind::Positional;
        let wrong = named && (output != (var.section == SectionKind::Output));
        if wrong {
            let name = self.text(var.name);
            let message = if output {
                format!("`{name}` is an input; it takes a value with `:=`")
            } else {
                format!("`{name}` is an output; it goes to a variable with `=>`")
            };
            self.error(Message::E3020, argument.range, message);
        }
        !wrong
    }

    pub(super) fn no_parameter(
        &mut self,
        pou: PouId,
        name: st::Ident,
        known: impl IntoIterator<Item = Symbol>,
    ) {
        let callee = self.text(self.an.pou(pou).name);
        let message = format!("`{callee}` has no parameter `{}`", self.text(name.name));
        let mut diagnostic = Diagnostic::new(Message::E1019, self.span(name.range), message);
        if let Some(close) = self.an.similar(name.name, known) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
    }
}
