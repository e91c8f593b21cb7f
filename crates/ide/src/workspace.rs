//! The texts of a project, and what is wrong with them.

use iecc_ast::Names;
use iecc_ast::st::{File, list_name};
use iecc_diag::Diagnostics;
use iecc_grammar::st::{Dialect, Parsed, parse_file, reparse_file};
use iecc_sema::st::testing::Tests;
use iecc_sema::st::{self, Evaluator, Kept};
use iecc_source::{FileId, SourceMap};

/// A project of Structured Text that is being edited.
#[derive(Debug)]
pub struct Workspace<E> {
    map: SourceMap,
    dialect: Dialect,
    /// The name of the program that runs, where the source leaves it open.
    entry: Option<String>,
    evaluator: E,
    names: Names,
    stdlib: Vec<File>,
    files: Vec<Edited>,
    kept: Kept,
}

#[derive(Debug)]
struct Edited {
    id: FileId,
    /// Its last tree; `None` before the first one.
    parsed: Option<Parsed>,
    /// Whether the text is newer than the tree.
    changed: bool,
}

impl<E: Evaluator> Workspace<E> {
    /// A project without files. `evaluator` computes constants.
    pub fn new(dialect: Dialect, entry: Option<&str>, evaluator: E) -> Self {
        let mut workspace = Self {
            map: SourceMap::new(),
            dialect,
            entry: entry.map(str::to_owned),
            evaluator,
            names: Names::new(),
            stdlib: Vec::new(),
            files: Vec::new(),
            kept: Kept::default(),
        };
        workspace.read_stdlib();
        workspace
    }

    fn read_stdlib(&mut self) {
        let mut found = Diagnostics::new();
        for file in iecc_stdlib::IEC {
            let id = self.map.add(file.path, file.text);
            let names = &mut self.names;
            let tree = parse_file(id, file.text, Dialect::Iec, names, &mut found);
            self.stdlib.push(tree);
        }
        assert!(found.is_empty(), "the library follows the grammar");
        st::intern_words(&mut self.names);
    }

    /// Adds a file under the name that messages show. Files count in the order in which they were
    /// added.
    pub fn add(&mut self, name: &str, text: &str) -> FileId {
        let id = self.map.add(name, text);
        self.files.push(Edited {
            id,
            parsed: None,
            changed: true,
        });
        id
    }

    /// Gives a file another text.
    ///
    /// # Panics
    /// If the file was not added here.
    pub fn change(&mut self, id: FileId, text: &str) {
        let file = self.files.iter_mut().find(|file| file.id == id);
        file.expect("a file that was added").changed = true;
        self.map.replace(id, text);
    }

    /// The texts, for whoever shows messages.
    pub fn map(&self) -> &SourceMap {
        &self.map
    }

    /// How many bodies of the user the last check looked at; it knew the others.
    pub fn looked_at(&self) -> usize {
        self.kept.looked_at()
    }

    /// Everything that is wrong, by file and place. Levels of warnings are for the caller to apply.
    pub fn check(&mut self) -> Diagnostics {
        self.parse();
        let options = st::Options {
            codesys: self.dialect == Dialect::Codesys,
            entry: self.entry.as_deref().map(|entry| self.names.intern(entry)),
            tests: Tests::Checked,
        };
        let mut found = Diagnostics::new();
        let parsed = self.files.iter().filter_map(|file| file.parsed.as_ref());
        for one in parsed.clone() {
            found.append(one.found.clone());
        }
        let trees = parsed.map(|one| &one.file);
        let (evaluator, kept) = (&self.evaluator, &mut self.kept);
        st::recheck(
            &self.stdlib,
            trees,
            &self.names,
            options,
            evaluator,
            kept,
            &mut found,
        );
        found.sort();
        found
    }

    fn parse(&mut self) {
        for file in self.files.iter_mut().filter(|file| file.changed) {
            let source = self.map.file(file.id);
            let (names, before) = (&mut self.names, file.parsed.take());
            let mut parsed = reparse_file(file.id, source.text(), self.dialect, names, before);
            parsed.file.name = list_name(source.name()).map(|name| names.intern(name));
            st::intern_hidden(names, std::slice::from_ref(&parsed.file));
            file.parsed = Some(parsed);
            file.changed = false;
        }
    }
}
