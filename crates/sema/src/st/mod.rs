//! Structured Text: from the trees of all files to a typed program.
//!
//! 1. `declare` collects names: units, types, namespaces. Nothing is resolved, so order is free.
//! 2. `resolve` and `signatures` give types to declarations, on demand; `initial` gives values,
//!    `storage` and `address` say where they lie, `objects` who extends whom and which body runs.
//! 3. `body` checks every body and writes it down as [`hir::code`]; `lint` warns.
//! 4. `program` and `config` make instances, tasks, inputs and outputs; `testing` makes unit tests a
//!    program.
//!
//! Every mistake of every file is reported. What is wrong once counts as of the error type from
//! there on, which goes with everything: a mistake gives one message. Library units are checked
//! only where they are used.

#![expect(
    clippy::needless_pass_by_value,
    reason = "operands are handed over: what was looked at is used once"
)]

mod address;
mod analysis;
mod bodies;
mod body;
mod config;
pub mod constant;
mod declare;
pub mod elementary;
mod initial;
mod lint;
mod memory;
mod objects;
mod program;
mod recheck;
mod repeats;
mod resolve;
pub mod signature;
mod signatures;
mod storage;
pub mod testing;
pub mod types;
mod uncalled;

pub use constant::Const;
pub use declare::intern_hidden;
pub use elementary::{El, Family};
pub use initial::Evaluator;
pub use recheck::Kept;

use crate::hir;
use analysis::{Analysis, Namespace, Words};
use iecc_ast::st::{File, PouKind};
use iecc_ast::{Names, Symbol};
use iecc_diag::Diagnostics;
use resolve::DEFAULT_TEXT;
use rustc_hash::FxHashMap;
use signature::{NamespaceId, PouId};
use types::{TypeId, TypeKind, Types};

/// Choices that the source does not make.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Whether the conveniences of CODESYS and TwinCAT are allowed.
    pub codesys: bool,
    /// The program that runs, where there is no configuration; the only one if `None`.
    pub entry: Option<Symbol>,
    /// What becomes of unit tests.
    pub tests: testing::Tests,
}

/// Gives names that mean something without being words of the language their symbols. To be
/// called before [`analyze`], which cannot add names.
pub fn intern_words(names: &mut Names) {
    for word in WORDS {
        names.intern(word);
    }
    for el in El::ALL {
        names.intern(el.name());
        names.intern(el.short_name());
    }
    for word in ["STRING", "WSTRING"] {
        names.intern(word);
    }
    testing::intern_words(names);
}

const WORDS: [&str; 9] = [
    "EN", "ENO", "INTERVAL", "SINGLE", "PRIORITY", "BIT", "__XINT", "__UXINT", "__XWORD",
];

/// Types of CODESYS that are as wide as an address, which has 64 bits here.
const WIDE: [(&str, El); 3] = [
    ("__XINT", El::Lint),
    ("__UXINT", El::Ulint),
    ("__XWORD", El::Lword),
];

/// Decides what the program of some files means. The library's files are trees like others; what
/// of them is not used is not looked at. Constants that are more than folding are computed by
/// `evaluator`. The program means nothing if there are errors.
pub fn analyze<'a>(
    library: &'a [File],
    files: impl IntoIterator<Item = &'a File>,
    names: &'a Names,
    options: Options,
    evaluator: &'a dyn Evaluator,
    diagnostics: &mut Diagnostics,
) -> hir::Program {
    analyze_tests(library, files, names, options, evaluator, diagnostics).0
}

/// As [`analyze`], and says what the outputs of a program that runs tests mean.
pub fn analyze_tests<'a>(
    library: &'a [File],
    files: impl IntoIterator<Item = &'a File>,
    names: &'a Names,
    options: Options,
    evaluator: &'a dyn Evaluator,
    diagnostics: &mut Diagnostics,
) -> (hir::Program, testing::Suite) {
    analysis(library, files, names, options, evaluator).finish(diagnostics)
}

/// As [`analyze`], for whoever wants to know what is wrong and nothing else. Bodies that stand as they
/// were when `kept` was filled are not looked at again while no declaration changed. `names` may
/// have grown since; the library and the evaluator are the same.
pub fn recheck<'a>(
    library: &'a [File],
    files: impl IntoIterator<Item = &'a File>,
    names: &'a Names,
    options: Options,
    evaluator: &'a dyn Evaluator,
    kept: &mut Kept,
    diagnostics: &mut Diagnostics,
) {
    analysis(library, files, names, options, evaluator).finish_again(kept, diagnostics);
}

/// Everything up to the bodies.
fn analysis<'a>(
    library: &'a [File],
    files: impl IntoIterator<Item = &'a File>,
    names: &'a Names,
    options: Options,
    evaluator: &'a dyn Evaluator,
) -> Analysis<'a> {
    let mut analysis = Analysis::new(names, options, evaluator);
    for file in library {
        analysis.declare_file(file, NamespaceId::LIBRARY);
    }
    analysis.first_user_unit = analysis.units.len() as u32;
    for file in files {
        analysis.declare_file(file, NamespaceId::GLOBAL);
    }
    analysis.declare_lists();
    analysis.check_dialect();
    analysis.check_spelling();
    analysis.check_pragmas();
    analysis.index_units();
    analysis.resolve_usings();
    analysis.resolve_heritage();
    analysis.declare_tests();
    analysis.resolve_all();
    analysis.assemble_all();
    analysis
}

/// The functions of a library with some names, and what these call.
pub fn library(
    files: &[File],
    names: &Names,
    functions: &[&str],
    evaluator: &dyn Evaluator,
) -> hir::Program {
    let mut analysis = Analysis::new(names, Options::default(), evaluator);
    for file in files {
        analysis.declare_file(file, NamespaceId::LIBRARY);
    }
    analysis.first_user_unit = analysis.units.len() as u32;
    analysis.index_units();
    for function in functions {
        for id in analysis.stdlib_functions(function) {
            analysis.want(id);
        }
    }
    let mut found = Diagnostics::new();
    let (program, _) = analysis.finish(&mut found);
    if let Some(mistake) = found.iter().next() {
        panic!("the library has no mistakes: {mistake:?}");
    }
    program
}

impl<'a> Analysis<'a> {
    fn new(names: &'a Names, options: Options, evaluator: &'a dyn Evaluator) -> Self {
        let word = |text| names.find(text).expect("words are interned first");
        let mut types = Types::new();
        let mut elementary_names = FxHashMap::default();
        for el in El::ALL {
            for name in [el.name(), el.short_name()] {
                elementary_names.insert(word(name), TypeId::of(*el));
            }
        }
        for (name, wide) in [("STRING", false), ("WSTRING", true)] {
            let ty = types.intern(TypeKind::Text {
                wide,
                length: DEFAULT_TEXT,
            });
            elementary_names.insert(word(name), ty);
        }
        if options.codesys {
            // A type of its own, since it takes a bit of a structure there.
            let bit = types.add_alias(types::AliasDef {
                name: word("BIT"),
                base: TypeId::BOOL,
                initial: None,
            });
            elementary_names.insert(word("BIT"), bit);
            elementary_names.extend(WIDE.map(|(name, el)| (word(name), TypeId::of(el))));
        }
        let global = Namespace::default();
        Self {
            names,
            words: Words {
                en: word("EN"),
                eno: word("ENO"),
                interval: word("INTERVAL"),
                single: word("SINGLE"),
                priority: word("PRIORITY"),
                bit: word("BIT"),
            },
            options,
            evaluator,
            units: Vec::new(),
            namespaces: vec![global, Namespace::default()],
            types,
            type_decls: Vec::new(),
            pous: Vec::new(),
            globals: Vec::new(),
            lists: Vec::new(),
            accessors: FxHashMap::default(),
            statics: FxHashMap::default(),
            enumerators: FxHashMap::default(),
            elementary_names,
            pou_of_unit: FxHashMap::default(),
            storage: storage::StorageTypes::default(),
            memory: memory::Memory::default(),
            hir: hir::Program::empty(),
            addresses: address::Addresses::default(),
            program_instances: Vec::new(),
            program_tags: FxHashMap::default(),
            tag_names: rustc_hash::FxHashSet::default(),
            instances: FxHashMap::default(),
            wanted: Vec::new(),
            families: objects::Families::default(),
            receivers: FxHashMap::default(),
            dispatchers: FxHashMap::default(),
            eno_units: std::cell::RefCell::default(),
            synthetics: Vec::new(),
            unit_names: FxHashMap::default(),
            hir_ids: FxHashMap::default(),
            computed: initial::Computed::default(),
            testing: testing::Testing::new(names),
            found: Diagnostics::new(),
            suggestions: std::cell::Cell::new(0),
            warnings: Vec::new(),
            lost_members: false,
            lost_units: false,
            depth: 0,
            declaring: 0,
            forward: FxHashMap::default(),
            ahead: rustc_hash::FxHashSet::default(),
            first_user_unit: 0,
            declared_pous: 0,
        }
    }

    /// Initial values in types are checked even where no variable has the type.
    fn declared_defaults(&mut self) {
        for index in 0..self.type_decls.len() as u32 {
            let id = signature::TypeDeclId(index);
            if !self.is_library(self.type_decl(id).unit) {
                let ty = self.declared_type(id);
                self.default_init(ty);
            }
        }
    }

    fn index_units(&mut self) {
        for (index, pou) in (0..).zip(&self.pous) {
            if pou.owner.is_none() {
                self.pou_of_unit.insert(pou.unit, PouId(index));
            }
        }
    }

    /// Types, signatures and bodies of the user, used or not.
    fn resolve_all(&mut self) {
        for index in 0..self.type_decls.len() as u32 {
            self.declared_type(signature::TypeDeclId(index));
        }
        for index in 0..self.globals.len() as u32 {
            self.complete_global(signature::GlobalId(index));
        }
        self.lay_out_addresses();
        self.place_globals();
        let units = 0..self.pous.len() as u32;
        let user: Vec<PouId> = units
            .map(PouId)
            .filter(|id| !self.is_library(self.pou(*id).unit))
            .collect();
        for &id in &user {
            self.complete(id);
        }
        self.located_initials();
        self.declared_defaults();
        for &id in &user {
            self.check_inheritance(id);
            let home = self.pou(id).owner.unwrap_or(id);
            if self.pou(id).has_instances() {
                // Initial values are checked even where nobody makes an instance.
                let ty = self.types.intern(TypeKind::Instance(id));
                self.storage(ty);
                self.default_init(ty);
            }
            // With open arrays there is a body for every call.
            if self.pou(home).kind != PouKind::Interface && !self.has_open_arrays(id) {
                self.want(id);
            }
        }
    }
}
