//! What a target refuses, as messages to the user.

use iecc_diag::{Code, Diagnostic};
use iecc_ir::Module;
use iecc_target::{Refusal, TargetError};

/// The code of a refusal.
fn code(refusal: Refusal) -> Code {
    match refusal {
        Refusal::Loop => Code::E7001,
        Refusal::Division => Code::E7002,
        Refusal::Float => Code::E7003,
        Refusal::DynamicPlace => Code::E7004,
        Refusal::Reference => Code::E7010,
        Refusal::Fault => Code::E7005,
        Refusal::AbsoluteTime => Code::E7006,
        Refusal::Size => Code::E7007,
        Refusal::Option => Code::E7008,
    }
}

/// Refusals as messages at the places in the source that they are about.
pub(crate) fn to_diagnostics(module: &Module, errors: &[TargetError]) -> Vec<Diagnostic> {
    errors.iter().map(|e| to_diagnostic(module, e)).collect()
}

fn to_diagnostic(module: &Module, error: &TargetError) -> Diagnostic {
    let place = error.origin.and_then(|origin| module.origins[origin].span);
    let (code, message) = (code(error.refusal), error.message.as_str());
    match place {
        Some(span) => Diagnostic::new(code, span, message),
        None => Diagnostic::without_place(code, message),
    }
}
