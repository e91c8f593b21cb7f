//! The cases of the conformance suite, as the command reads them.

use iecc_conformance::{Case, read_suite};
use iecc_diag::Diagnostics;
use iecc_driver::{Levels, Sources};
use iecc_source::SourceMap;
use std::path::PathBuf;

/// All cases of the project.
///
/// # Panics
/// If one cannot be read, with its line.
pub fn suite() -> Vec<Case> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("conformance");
    let (mut map, mut diagnostics) = (SourceMap::new(), Diagnostics::new());
    let sources = Sources::load(&mut map, &[folder], &Levels::default(), &mut diagnostics);
    let said: Vec<_> = diagnostics.iter().collect();
    assert!(said.is_empty(), "{said:?}");
    let sources = sources.expect("nothing was said");
    read_suite(&map, sources.files()).unwrap_or_else(|misread| {
        let misread: Vec<String> = misread.iter().map(ToString::to_string).collect();
        panic!("{}", misread.join("\n"))
    })
}
