//! Arguments of calls: which goes to which parameter, and what is missing.

use crate::st::body::Body;
use crate::st::signature::{PouId, Var};
use iecc_ast::Symbol;
use iecc_ast::st::{self, Argument, ArgumentKind, BinaryOp, ExprKind, SectionKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// Which argument goes to which parameter, in the order of the arguments.
    pub(crate) fn matched(
        &mut self,
        pou: PouId,
        arguments: st::List<Argument>,
        range: TextRange,
    ) -> Vec<(Var, Argument)> {
        let written: Vec<Argument> = self.arena()[arguments].to_vec();
        let parameters = self.an.all_parameters(pou);
        let written = self.without_comparisons(written, &parameters);
        self.check_positions(pou, &parameters, &written, range);
        let mut matched: Vec<(Var, Argument)> = Vec::with_capacity(written.len());
        let mut by_position = parameters.iter();
        for argument in written {
            let var = match argument.kind {
                ArgumentKind::Positional => by_position.next(),
                ArgumentKind::Input(name)
                | ArgumentKind::Output(name)
                | ArgumentKind::NegatedOutput(name) => {
                    if self.is_enable(name.name) {
                        continue;
                    }
                    self.parameter_named(pou, &parameters, name)
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

    /// The parameter that has a name, or has it as its second one.
    fn parameter_named<'v>(
        &mut self,
        pou: PouId,
        parameters: &'v [Var],
        name: st::Ident,
    ) -> Option<&'v Var> {
        let alias = self.an.parameter_alias(pou, name.name);
        let wanted = alias.unwrap_or(name.name);
        let found = parameters.iter().find(|var| var.name == wanted);
        if found.is_none() {
            let known = parameters.iter().map(|var| var.name);
            self.no_parameter(pou, name, known);
        }
        found
    }

    /// Whether arguments by position stand alone, and are as many as there are parameters.
    fn check_positions(
        &mut self,
        pou: PouId,
        parameters: &[Var],
        written: &[Argument],
        range: TextRange,
    ) {
        let by_position = |argument: &&Argument| argument.kind == ArgumentKind::Positional;
        let positional = written.iter().filter(by_position).count();
        if positional > 0 && positional < written.len() && !self.an.options.codesys {
            let message = "arguments are given either all by name or all by position";
            self.error(Message::E3017, range, message);
        }
        if positional > parameters.len() && !self.an.has_lost_names(pou) {
            let message = format!(
                "{positional} arguments are given but `{}` has {} parameters",
                self.text(self.an.pou(pou).name),
                parameters.len()
            );
            self.error(Message::E3018, range, message);
        }
        if positional > 0 && positional == written.len() {
            self.require_positions(pou, parameters, positional, range);
        }
    }

    /// Arguments but those like `speed = 5`, which compare where a parameter is to be given.
    fn without_comparisons(&mut self, written: Vec<Argument>, parameters: &[Var]) -> Vec<Argument> {
        let named = |argument: &Argument| argument.kind != ArgumentKind::Positional;
        let by_name = written.iter().any(named);
        let mut kept = Vec::with_capacity(written.len());
        for argument in written {
            match self.compared_parameter(&argument, parameters) {
                Some((name, sign)) if by_name || !self.own_symbol(name) => {
                    let name = self.text(name);
                    let message = format!("`{name}` is compared where it is to be given a value");
                    let span = self.span(sign);
                    let diagnostic = Diagnostic::new(Message::E3017, span, message)
                        .label("expected `:=`")
                        .fix("give the parameter with `:=`", span, ":=");
                    self.report(diagnostic);
                }
                Some(_) | None => kept.push(argument),
            }
        }
        kept
    }

    /// The parameter that an argument by position compares with something, and where.
    fn compared_parameter(
        &self,
        argument: &Argument,
        parameters: &[Var],
    ) -> Option<(Symbol, TextRange)> {
        let arena = self.arena();
        let value = argument
            .value
            .filter(|_| argument.kind == ArgumentKind::Positional)?;
        let ExprKind::Binary {
            op: BinaryOp::Equal,
            op_start,
            left,
            ..
        } = arena[value].kind
        else {
            return None;
        };
        let ExprKind::Name(name) = arena[left].kind else {
            return None;
        };
        let known = parameters.iter().any(|var| var.name == name);
        known.then(|| (name, TextRange::new(op_start, op_start + 1)))
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
        if missing.is_empty() || self.an.options.codesys || self.an.has_lost_names(pou) {
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

    pub(crate) fn no_parameter(
        &mut self,
        pou: PouId,
        name: st::Ident,
        known: impl IntoIterator<Item = Symbol>,
    ) {
        if self.an.has_lost_names(pou) {
            return;
        }
        let callee = self.text(self.an.pou(pou).name);
        let message = format!("`{callee}` has no parameter `{}`", self.text(name.name));
        let mut diagnostic = Diagnostic::new(Message::E1019, self.span(name.range), message);
        if let Some(close) = self.an.similar(name.name, known) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
    }

    pub(crate) fn require_in_outs(
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
}
