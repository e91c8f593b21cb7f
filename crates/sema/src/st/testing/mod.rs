//! Unit tests of users: TEST, SETUP, TEARDOWN, and what runs them.
//!
//! A test is a block with one instance. SETUP is what the tests of its file extend, so they have its
//! variables; TEARDOWN is a method of it. A *test program* runs one test in a scan at time 0, chosen
//! by an input, on instances and global variables that were never touched. Time is data in it: what
//! reads the time reads a tag that ADVANCE_TIME moves, so a test need not be cut into scans.
//!
//! A check that fails stores its number and its operands in outputs and leaves the body. What the
//! numbers mean stands in the [`Suite`] beside the program.

mod assemble;
mod units;

use super::analysis::Analysis;
use super::constant::Const;
use super::signature::PouId;
use super::types::{TypeId, TypeKind};
use crate::hir::{self, Elementary, Place, Step, TagId, Type, View};
use iecc_ast::{Names, Symbol};
use iecc_source::{FileId, Span};
use rustc_hash::FxHashMap;

/// What becomes of unit tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tests {
    /// They are not looked at.
    #[default]
    LeftOut,
    /// They are checked; the program is what it is without them.
    Checked,
    /// The program is the one that runs some of them.
    Run {
        /// The position of the first.
        first: u32,
        /// How many; all that there are if there are less.
        count: u32,
    },
}

impl Tests {
    /// The program runs all tests.
    pub const RUN_ALL: Self = Self::Run {
        first: 0,
        count: u32::MAX,
    };

    /// Whether the program runs the test at a position.
    fn runs(self, position: u32) -> bool {
        match self {
            Self::LeftOut | Self::Checked => false,
            Self::Run { first, count } => position
                .checked_sub(first)
                .is_some_and(|index| index < count),
        }
    }
}

/// The tests of a program, and what its outputs mean.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Suite {
    /// The tests, by file and in their order. The number of a test is its position from 1.
    pub tests: Vec<Test>,
    /// What may fail. The number of a check is its position from 1.
    pub checks: Vec<Check>,
}

impl Suite {
    /// The input that holds the number of the test to run. Names of users have no apostrophe.
    pub const CHOICE: &'static str = "test'";
    /// The output that holds the number of the check that failed, 0 if none did.
    pub const FAILED: &'static str = "failed'";
}

/// A test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Test {
    /// Its file.
    pub file: FileId,
    /// Its title.
    pub title: String,
    /// The title where it stands.
    pub span: Span,
    /// Its instance, in the program that runs it.
    pub tag: Option<TagId>,
}

/// Something that a test asserts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Check {
    /// Which assertion.
    pub kind: CheckKind,
    /// The statement.
    pub span: Span,
    /// Its operands, in the order of its arguments.
    pub operands: Vec<Shown>,
    /// What the user says about it.
    pub message: Option<String>,
}

/// A value that is looked at after a test.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// The output that holds it.
    pub output: String,
    /// How people see it.
    pub form: Form,
}

/// How a value is written, beside what its type says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Form {
    /// As its type says.
    Plain,
    /// By name, where its bits are among these.
    Named(Vec<(String, u64)>),
    /// A character or string between these quotes.
    Quoted(char),
    /// Something or NULL: addresses mean nothing to people.
    Reference,
}

macro_rules! checks {
    ($($(#[doc = $doc:literal])* $kind:ident $name:literal $operands:literal,)*) => {
        /// The assertions.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum CheckKind {
            $($(#[doc = $doc])* $kind,)*
        }

        impl CheckKind {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$kind,)*];

            /// The name that users write.
            pub fn name(self) -> &'static str {
                match self { $(Self::$kind => $name,)* }
            }

            /// How many arguments it takes besides a message.
            pub(crate) fn arguments(self) -> usize {
                match self { $(Self::$kind => $operands,)* }
            }
        }
    };
}

checks! {
    /// The first is equal to the second.
    Equal "ASSERT_EQ" 2,
    /// The first is not equal to the second.
    NotEqual "ASSERT_NEQ" 2,
    /// It is TRUE.
    True "ASSERT_TRUE" 1,
    /// It is FALSE.
    False "ASSERT_FALSE" 1,
    /// The first is greater.
    Greater "ASSERT_GT" 2,
    /// The first is greater, or they are equal.
    GreaterEqual "ASSERT_GE" 2,
    /// The first is less.
    Less "ASSERT_LT" 2,
    /// The first is less, or they are equal.
    LessEqual "ASSERT_LE" 2,
    /// The first differs from the second by the third at most.
    Near "ASSERT_NEAR" 3,
    /// The instance was called since it is a mock.
    Called "MOCK_VERIFY_CALLED" 1,
    /// The instance was called so many times since it is a mock. Its operands are the calls, -1
    /// where there is no mock, and the number that was expected.
    CallCount "MOCK_VERIFY_CALL_COUNT" 2,
}

/// A call that means something in tests.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Word {
    Check(CheckKind),
    AdvanceTime,
}

const ADVANCE_TIME: &str = "ADVANCE_TIME";

impl Word {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Check(kind) => kind.name(),
            Self::AdvanceTime => ADVANCE_TIME,
        }
    }

    /// How many arguments it takes besides a message.
    pub(crate) fn arguments(self) -> usize {
        match self {
            Self::Check(kind) => kind.arguments(),
            Self::AdvanceTime => 1,
        }
    }

    /// Whether a message may follow.
    pub(crate) fn takes_message(self) -> bool {
        matches!(self, Self::Check(_))
    }

    fn all() -> impl Iterator<Item = Self> {
        let checks = CheckKind::ALL.iter().copied().map(Self::Check);
        checks.chain([Self::AdvanceTime])
    }
}

/// Gives the words of tests their symbols.
pub(crate) fn intern_words(names: &mut Names) {
    for word in Word::all() {
        names.intern(word.name());
    }
}

/// What is known of the tests while the program is looked at.
#[derive(Debug, Default)]
pub(crate) struct Testing {
    words: FxHashMap<Symbol, Word>,
    /// Units of tests, in order of declaration.
    units: Vec<super::signature::UnitId>,
    cases: Vec<Case>,
    checks: Vec<Check>,
    /// Whether some instance is mocked, so that all can be.
    pub mocks: bool,
    /// Functions that some test mocks, and what says whether it does now.
    functions: FxHashMap<PouId, Option<MockedFunction>>,
    /// The tags that hold operands, by storage, view and position of the operand.
    operands: FxHashMap<(Type, View, usize), TagId>,
    failed: Option<TagId>,
    clock: Option<TagId>,
}

/// A test and what runs around it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Case {
    pub test: PouId,
    pub setup: Option<PouId>,
    pub teardown: Option<PouId>,
    pub tag: Option<TagId>,
}

/// Tags of a function that can be mocked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MockedFunction {
    /// Whether it is.
    pub flag: TagId,
    /// What it gives then.
    pub value: TagId,
}

impl Testing {
    pub(crate) fn new(names: &Names) -> Self {
        let words = Word::all().filter_map(|word| Some((names.find(word.name())?, word)));
        Self {
            words: words.collect(),
            ..Self::default()
        }
    }

    /// The names that mean something in tests, in a fixed order.
    pub(crate) fn words(&self) -> Vec<Symbol> {
        let mut words: Vec<Symbol> = self.words.keys().copied().collect();
        words.sort_unstable();
        words
    }

    /// What a call of a name means in tests.
    pub(crate) fn word(&self, name: Symbol) -> Option<Word> {
        self.words.get(&name).copied()
    }
}

impl Analysis<'_> {
    /// Whether a unit is a test, or runs before or after tests.
    pub(crate) fn is_test(&self, unit: super::signature::UnitId) -> bool {
        matches!(self.unit(unit).kind, iecc_ast::st::UnitKind::Test(_))
    }

    fn hidden_tag(&mut self, name: &str, ty: Elementary, view: View) -> TagId {
        self.add_tag(name, Type::Elementary(ty), view, None, None)
    }

    /// The tag that holds the number of the check that failed.
    pub(crate) fn failed_tag(&mut self) -> TagId {
        if let Some(known) = self.testing.failed {
            return known;
        }
        let tag = self.hidden_tag(Suite::FAILED, Elementary::Udint, View::Number);
        self.testing.failed = Some(tag);
        tag
    }

    /// The tag that holds the time where programs run tests; `None` where the time is that of the
    /// scan.
    pub(crate) fn clock(&mut self) -> Option<TagId> {
        if !matches!(self.options.tests, Tests::Run { .. }) {
            return None;
        }
        Some(self.test_clock())
    }

    /// The tag that ADVANCE_TIME moves.
    pub(crate) fn test_clock(&mut self) -> TagId {
        if let Some(known) = self.testing.clock {
            return known;
        }
        let tag = self.hidden_tag("now'", Elementary::Lint, View::Time);
        self.testing.clock = Some(tag);
        tag
    }

    /// Where the operand at a position is kept, and what it says about a value of a type.
    pub(crate) fn operand_tag(&mut self, ty: TypeId, position: usize) -> (TagId, Shown) {
        let key = (self.storage(ty), self.view(ty), position);
        let tag = match self.testing.operands.get(&key) {
            Some(&known) => known,
            None => {
                let name = format!("operand'{}", self.testing.operands.len());
                let tag = self.add_tag(&name, key.0, key.1, None, None);
                self.testing.operands.insert(key, tag);
                tag
            }
        };
        let output = self.hir.tag(tag).name.clone();
        let form = self.form(ty);
        (tag, Shown { output, form })
    }

    fn form(&self, ty: TypeId) -> Form {
        match self.types.base(ty) {
            TypeKind::Enum(index) => {
                let def = &self.types.enums[*index as usize];
                let names = def.values.iter().map(|(name, value)| {
                    let bits = Const::Int(*value).bits(def.base);
                    (self.text(*name).to_owned(), bits)
                });
                Form::Named(names.collect())
            }
            TypeKind::Text { wide, .. } => Form::Quoted(quote(*wide)),
            TypeKind::Elementary(el) if el.view() == View::Character => {
                Form::Quoted(quote(el.bits() > 8))
            }
            TypeKind::Reference(..) | TypeKind::Interface(_) | TypeKind::Null => Form::Reference,
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Elementary(_)
            | TypeKind::Subrange { .. }
            | TypeKind::Array { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Struct(_)
            | TypeKind::Instance(_)
            | TypeKind::Alias(_) => Form::Plain,
        }
    }

    /// Notes a check; gives its number.
    pub(crate) fn add_check(&mut self, check: Check) -> u64 {
        self.testing.checks.push(check);
        self.testing.checks.len() as u64
    }

    /// The tags of a function, if some test mocks it.
    pub(crate) fn mocked_function(&mut self, function: PouId) -> Option<MockedFunction> {
        let pou = self.pou(function);
        let function = pou.template.unwrap_or(function);
        let result = pou.result?;
        let known = *self.testing.functions.get(&function)?;
        if known.is_some() {
            return known;
        }
        let name = format!("mock'{}", self.text(self.pou(function).name));
        let name = self.unique_unit_name(name);
        let flag = self.hidden_tag(&name, Elementary::Bool, View::Number);
        let (storage, view) = (self.storage(result), self.view(result));
        let value = self.add_tag(&format!("{name}'value"), storage, view, None, None);
        let made = Some(MockedFunction { flag, value });
        self.testing.functions.insert(function, made);
        made
    }

    /// The tests of the program and what they check.
    pub(crate) fn suite(&mut self) -> Suite {
        let cases = std::mem::take(&mut self.testing.cases);
        let described = |case: &Case| Test {
            tag: case.tag,
            ..self.described(case.test)
        };
        let tests = cases.iter().map(described).collect();
        Suite {
            tests,
            checks: std::mem::take(&mut self.testing.checks),
        }
    }
}

fn quote(wide: bool) -> char {
    if wide { '"' } else { '\'' }
}

fn whole_or_base(tag: TagId, base: bool) -> Place {
    let whole = Place::whole(tag);
    if base {
        whole.step(Step::Field(0))
    } else {
        whole
    }
}

fn point(name: &str, tag: TagId) -> hir::IoPoint {
    hir::IoPoint {
        name: name.to_owned(),
        place: Place::whole(tag),
    }
}
