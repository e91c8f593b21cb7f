//! The standard library, parsed once for many small programs, such as the tens of thousands that tests check.
//!
//! What a program means, and what is said of it, is the same as in [`check`](crate::check).

use crate::FrontOptions;
use crate::front::{library, lowered, meaning};
use iecc_ast::Names;
use iecc_ast::st::File;
use iecc_diag::Diagnostics;
use iecc_grammar::st::parse_file;
use iecc_ir::Module;
use iecc_sema::hir;
use iecc_source::{FileId, SourceMap};

/// The parsed library.
#[derive(Debug)]
pub struct ParsedLibrary {
    map: SourceMap,
    names: Names,
    files: Vec<File>,
}

impl Default for ParsedLibrary {
    fn default() -> Self {
        Self::parse()
    }
}

impl ParsedLibrary {
    /// Parses the library.
    pub fn parse() -> Self {
        let (mut map, mut names) = (SourceMap::new(), Names::new());
        let texts = iecc_stdlib::IEC.iter();
        let ids: Vec<FileId> = texts.map(|file| map.add(file.path, file.text)).collect();
        let files = library(&map, &ids, &mut names);
        Self { map, names, files }
    }

    /// Decides what a text means, the only file of its program.
    pub fn check(
        &self,
        text: &str,
        options: &FrontOptions,
        diagnostics: &mut Diagnostics,
    ) -> Option<hir::Program> {
        let mut names = self.names.clone();
        let mut found = Diagnostics::new();
        let file = parse_file(self.file(), text, options.dialect, &mut names, &mut found);
        let (program, _) = meaning(&self.files, &[file], &mut names, options, &mut found);
        options.levels.apply(&mut found);
        found.sort();
        let failed = found.has_errors();
        diagnostics.append(found);
        (!failed).then_some(program)
    }

    /// Compiles a text as [`compile`](crate::compile) does.
    pub fn compile(
        &self,
        text: &str,
        options: &FrontOptions,
        diagnostics: &mut Diagnostics,
    ) -> Option<Module> {
        let program = self.check(text, options, diagnostics)?;
        lowered(&program, options, diagnostics)
    }

    /// The file that places in a text belong to.
    pub fn file(&self) -> FileId {
        FileId::from_index(self.files.len())
    }

    /// Where places in a text are found, and those of the library.
    pub fn map(&self, text: &str) -> SourceMap {
        let mut map = self.map.clone();
        map.add("program.st", text);
        map
    }
}
