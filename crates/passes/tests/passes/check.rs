//! One check for every pass: text before, text after; both keep the verifier's rules.

use iecc_ir::{Module, parse_module, print_module, verify};
use iecc_passes::{Settings, run};

/// Parses and verifies a module.
pub(crate) fn module(text: &str) -> Module {
    let module = parse_module(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(verify(&module).err(), None, "{text}");
    module
}

/// Runs passes in order, verifying after each.
pub(crate) fn optimised(passes: &[&str], text: &str) -> Module {
    let mut module = module(text);
    for pass in passes {
        run(pass, &mut module, &Settings::default()).unwrap();
        let text = print_module(&module);
        assert_eq!(verify(&module).err(), None, "after {pass}:\n{text}");
    }
    module
}

/// The module after the passes must print as `header` and `after`.
pub(crate) fn check(passes: &[&str], header: &str, before: &str, after: &str) {
    let found = optimised(passes, &format!("{header}{before}"));
    let expected = print_module(&module(&format!("{header}{after}")));
    pretty_eq(&print_module(&found), &expected);
}

fn pretty_eq(found: &str, expected: &str) {
    assert!(found == expected, "found:\n{found}\nexpected:\n{expected}");
}
