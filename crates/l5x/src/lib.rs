//! Reads a Rockwell L5X export into [`iecc_ast::logix`].
//!
//! Guarantees: every name and text keeps its place in the file, also through CDATA and entities;
//! what bears on meaning is kept or reported; unknown elements and attributes are ignored, but an
//! unknown value of a known attribute is an error. Any text gives a result or messages, never a
//! panic; a file that is not well-formed gives exactly one. Every rung is parsed, so all syntax
//! errors of a file are found in one run. Names are not resolved here.

mod context;
mod data;
mod entities;
mod instructions;
mod l5k;
mod modules;
mod project;
mod routines;
mod tags;
mod types;
mod xml;

use iecc_ast::logix::Project;
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{FileId, Span};

/// The largest file that is read.
pub const MAX_FILE_BYTES: usize = 256 << 20;

/// Reads the text of a file, byte order mark included or not. `None` when the file is no L5X
/// export or no well-formed XML; a project with errors in parts is returned without those parts.
pub fn read(file: FileId, text: &str, diagnostics: &mut Diagnostics) -> Option<Project> {
    if text.len() > MAX_FILE_BYTES {
        let message = format!(
            "the file has {} bytes, at most {MAX_FILE_BYTES} are read",
            text.len()
        );
        diagnostics.push(Diagnostic::new(Code::E0003, Span::point(file, 0), message));
        return None;
    }
    match xml::Document::parse(file, text) {
        Ok(document) => project::read(document.root(), diagnostics),
        Err(diagnostic) => {
            diagnostics.push(*diagnostic);
            None
        }
    }
}
