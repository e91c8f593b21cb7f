//! What a test that did not pass tells: values as literals, got and expected, and where.

use crate::run::{Probe, Shape, write_value};
use iecc_ast::st::{StringLiteral, string_text};
use iecc_diag::{Code, Diagnostic};
use iecc_ir::{Module, Type};
use iecc_sema::st::testing::{Check, CheckKind, Form, Test};
use iecc_target::Fault;

/// A value as people write it.
pub(super) fn shown(bits: &[u64], probe: &Probe, form: &Form) -> String {
    match (form, probe.shape) {
        (Form::Named(names), _) => {
            let named = names.iter().find(|(_, value)| *value == bits[0]);
            named.map_or_else(|| plain(bits[0], probe), |(name, _)| name.clone())
        }
        (Form::Quoted(quote), Shape::Text { capacity, .. }) => {
            let length = usize::try_from(bits[0]).unwrap_or(0).min(capacity);
            quoted(*quote, &bits[1..=length])
        }
        (Form::Quoted(quote), Shape::Scalar(_)) => quoted(*quote, &bits[..1]),
        (Form::Reference, _) if bits[0] == 0 => "NULL".to_owned(),
        (Form::Reference, _) => "a reference".to_owned(),
        (Form::Plain, _) => plain(bits[0], probe),
    }
}

fn quoted(quote: char, units: &[u64]) -> String {
    string_text(&StringLiteral {
        double: quote == '"',
        units: units.iter().map(|unit| *unit as u16).collect(),
    })
}

fn plain(bits: u64, probe: &Probe) -> String {
    let Shape::Scalar(ty) = probe.shape else {
        panic!("strings are quoted");
    };
    match ty {
        Type::I1 if bits == 0 => "FALSE".to_owned(),
        Type::I1 => "TRUE".to_owned(),
        Type::I8 | Type::I16 | Type::I32 | Type::I64 | Type::F32 | Type::F64 => {
            let mut text = String::new();
            write_value(&mut text, ty, probe.view, bits);
            text
        }
    }
}

/// The message of an assertion that did not hold.
pub(super) fn assertion(check: &Check, test: &Test, operands: &[String]) -> Diagnostic {
    let name = check.kind.name();
    let mut message = format!("{name} failed in `{}`", one_line(&test.title));
    if let Some(says) = check.message.as_ref().filter(|says| !says.is_empty()) {
        message = format!("{message}: {}", one_line(says));
    }
    let label = got_and_expected(check.kind, operands);
    Diagnostic::new(Code::E6090, check.span, message).label(label)
}

fn got_and_expected(kind: CheckKind, operands: &[String]) -> String {
    let got = operands[0].as_str();
    let other = operands.get(1).map_or("", String::as_str);
    match kind {
        CheckKind::Equal => format!("got {got}, expected {other}"),
        CheckKind::NotEqual => format!("got {got}, expected something else"),
        CheckKind::True => format!("got {got}, expected TRUE"),
        CheckKind::False => format!("got {got}, expected FALSE"),
        CheckKind::Greater => format!("got {got}, expected more than {other}"),
        CheckKind::GreaterEqual => format!("got {got}, expected at least {other}"),
        CheckKind::Less => format!("got {got}, expected less than {other}"),
        CheckKind::LessEqual => format!("got {got}, expected at most {other}"),
        CheckKind::Near => format!("got {got}, expected {other} within {}", operands[2]),
        CheckKind::Called | CheckKind::CallCount if got == "-1" => {
            "this instance is no mock".to_owned()
        }
        CheckKind::Called => "it was never called".to_owned(),
        CheckKind::CallCount => format!("got {}, expected {other}", calls(got)),
    }
}

fn calls(number: &str) -> String {
    let plural = if number == "1" { "" } else { "s" };
    format!("{number} call{plural}")
}

/// Texts of users without line ends and the like.
fn one_line(text: &str) -> String {
    text.replace(char::is_control, "\u{fffd}")
}

/// The message of a fault.
pub(super) fn fault(module: &Module, test: &Test, fault: Fault) -> Diagnostic {
    let origin = fault.origin.map(|origin| &module.origins[origin]);
    let message = format!("`{}` was abandoned: {fault}", one_line(&test.title));
    let span = origin.and_then(|origin| origin.span).unwrap_or(test.span);
    let diagnostic = Diagnostic::new(Code::E6091, span, message);
    match origin {
        // What it is in is said already.
        Some(origin) if origin.label.starts_with("TEST ") => diagnostic,
        Some(origin) => diagnostic
            .label(format!("in {}", origin.label))
            .also(test.span, "the test"),
        None => diagnostic,
    }
}
