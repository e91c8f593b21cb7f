//! Runs passes and shows what they made of a module.

use super::directives::RunTest;
use super::run;
use crate::differential::{Agreement, compare_modules};
use crate::rng::Rng;
use crate::stimulus::random_stimulus;
use iecc_ir::{Module, print_function, print_module};
use iecc_passes::Settings;

/// Scans of the comparison with the module before.
const SCANS: usize = 60;

/// The module after the passes, once it has been found to do the same as before.
pub(super) fn check(
    module: &Module,
    names: &[String],
    test: Option<&RunTest>,
) -> Result<Module, String> {
    let mut after = module.clone();
    let agreement = Agreement::after(&names.iter().map(String::as_str).collect::<Vec<_>>());
    for name in names {
        iecc_passes::run(name, &mut after, &Settings::default())
            .map_err(|error| error.to_string())?;
        if let Err(errors) = iecc_ir::verify(&after) {
            let text = print_module(&after);
            return Err(format!("after {name}: {}\n{text}", errors[0]));
        }
    }
    let stimulus = random_stimulus(module, &mut Rng::new(1), SCANS);
    compare_modules(module, &after, agreement, &stimulus)?;
    if let Some(test) = test {
        run::check_once(module, test, Agreement::All)?;
        run::check_once(&after, test, agreement)
            .map_err(|error| format!("after the pass: {error}"))?;
    }
    Ok(after)
}

/// All functions, and the head of the module if it changed.
pub(super) fn result_text(before: &Module, after: &Module) -> String {
    let functions: Vec<String> = after
        .funcs
        .values()
        .map(|f| print_function(after, f))
        .collect();
    let functions = functions.join("\n");
    if head(before) == head(after) {
        functions
    } else {
        format!("{}\n{functions}", head(after))
    }
}

fn head(module: &Module) -> String {
    let text = print_module(module);
    let end = text.find("\nfn @").unwrap_or(text.len());
    text[..end].to_owned()
}

/// The file with this result at its end.
pub(super) fn rewrite(text: &str, result: &str) -> String {
    let kept: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with(";>"))
        .collect();
    let kept = kept.join("\n");
    let result = result
        .lines()
        .map(|line| format!(";> {line}").trim_end().to_owned() + "\n");
    format!("{}\n\n{}", kept.trim_end(), result.collect::<String>())
}
