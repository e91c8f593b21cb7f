//! Expects errors of the verifier.

use super::directives::ExpectedError;
use iecc_ir::{Module, verify};

pub(super) fn check(module: &Module, expected: &[ExpectedError]) -> Result<(), String> {
    let found = verify(module).err().unwrap_or_default();
    for (index, expected) in expected.iter().enumerate() {
        let rule = expected.rule;
        let found = found
            .get(index)
            .ok_or_else(|| format!("expected error {rule}, found none"))?;
        if found.rule != rule || !found.message.contains(&expected.message) {
            let message = &expected.message;
            return Err(format!("expected error {rule} {message}\n   found {found}"));
        }
    }
    match found.get(expected.len()) {
        None => Ok(()),
        Some(more) => Err(format!("unexpected {more}")),
    }
}
