//! The tokens of Structured Text, and the tables that make keywords of words.

use super::Dialect;
use iecc_ast::Symbol;

/// One token. Comments and pragmas are tokens as well; white space is what lies between.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: Kind,
    /// The name of a word or of a type prefix, whatever its case; meaningless for others.
    pub symbol: Symbol,
    /// First byte in the file.
    pub start: u32,
    /// One behind the last byte.
    pub end: u32,
}

/// In which dialects a word is a keyword.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Words {
    All,
    /// Not in edition 2, where they are names.
    Edition3,
    /// Reserved by the standard for Sequential Function Chart, names in CODESYS.
    Chart,
    /// A keyword, but in CODESYS only where the words around it leave nothing else.
    SoftInCodesys,
    /// A keyword where the words around it leave nothing else, else a name, in all dialects:
    /// words of CODESYS and of tests, and some that are names of parameters as well.
    Soft,
}

macro_rules! kinds {
    (
        $(#[doc = $text:literal] $other:ident,)*
        keywords
        $($keyword:ident $spelling:literal $words:ident,)*
    ) => {
        /// What a token is.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Kind {
            $(#[doc = $text] $other,)*
            $(#[doc = $spelling] $keyword,)*
        }

        const KEYWORDS: &[(Kind, &str, Words)] = &[
            $((Kind::$keyword, $spelling, Words::$words),)*
        ];
    };
}

kinds! {
    /// A name.
    Word,
    /// A name with letters outside ASCII.
    ForeignWord,
    /// A word and `#`, as in `INT#5`.
    TypePrefix,
    /// Decimal digits.
    Int,
    /// `16#FF`.
    Based,
    /// `1.5`, and `1E5`.
    Real,
    /// Digits with letters behind them.
    BadNumber,
    /// `T#1s`, `DT#…`: with its prefix.
    Time,
    /// With its quotes.
    String,
    /// Without the closing quote.
    OpenString,
    /// `%IX0.1`, and `%X3` behind a dot.
    Direct,
    /// In any form.
    Comment,
    /// `(*` or `/*` without end.
    OpenComment,
    /// `{…}`
    Pragma,
    /// `{` without end.
    OpenPragma,
    /// Part of the token before it.
    Merged,
    /// Bytes that fit no token.
    Unknown,
    /// `(`
    OpenParen,
    /// `)`
    CloseParen,
    /// `[`
    OpenBracket,
    /// `]`
    CloseBracket,
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// `:`
    Colon,
    /// `:=`
    Assign,
    /// `?=`
    AttemptAssign,
    /// `S=`
    LatchAssign,
    /// `R=`
    UnlatchAssign,
    /// `REF=`
    BindAssign,
    /// `=>`
    Arrow,
    /// `.`
    Dot,
    /// `..`
    DotDot,
    /// `^`
    Caret,
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Star,
    /// `/`
    Slash,
    /// `**`
    StarStar,
    /// `&`
    Ampersand,
    /// `=`
    Equal,
    /// `<>`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// Not a token of any text: stands for a statement that could not be read.
    Damaged,

    keywords

    If "IF" All,
    Then "THEN" All,
    Elsif "ELSIF" All,
    Else "ELSE" All,
    EndIf "END_IF" All,
    Case "CASE" All,
    Of "OF" All,
    EndCase "END_CASE" All,
    For "FOR" All,
    To "TO" All,
    By "BY" All,
    Do "DO" All,
    EndFor "END_FOR" All,
    While "WHILE" All,
    EndWhile "END_WHILE" All,
    Repeat "REPEAT" All,
    Until "UNTIL" All,
    EndRepeat "END_REPEAT" All,
    Exit "EXIT" All,
    Continue "CONTINUE" Edition3,
    Return "RETURN" All,
    Not "NOT" All,
    And "AND" All,
    Or "OR" All,
    Xor "XOR" All,
    Mod "MOD" All,
    AndThen "AND_THEN" Soft,
    OrElse "OR_ELSE" Soft,
    True "TRUE" All,
    False "FALSE" All,
    Null "NULL" Edition3,
    This "THIS" Edition3,
    Super "SUPER" Edition3,
    Ref "REF" Edition3,

    Function "FUNCTION" All,
    EndFunction "END_FUNCTION" All,
    FunctionBlock "FUNCTION_BLOCK" All,
    EndFunctionBlock "END_FUNCTION_BLOCK" All,
    Program "PROGRAM" All,
    EndProgram "END_PROGRAM" All,
    Class "CLASS" Edition3,
    EndClass "END_CLASS" Edition3,
    Interface "INTERFACE" Edition3,
    EndInterface "END_INTERFACE" Edition3,
    Method "METHOD" Edition3,
    EndMethod "END_METHOD" Edition3,
    Namespace "NAMESPACE" Edition3,
    EndNamespace "END_NAMESPACE" Edition3,
    Using "USING" Edition3,
    Extends "EXTENDS" Edition3,
    Implements "IMPLEMENTS" Edition3,
    Abstract "ABSTRACT" Edition3,
    Final "FINAL" Edition3,
    Override "OVERRIDE" Edition3,
    Public "PUBLIC" Edition3,
    Protected "PROTECTED" Edition3,
    Private "PRIVATE" Edition3,
    Internal "INTERNAL" Edition3,
    Action "ACTION" All,
    EndAction "END_ACTION" All,
    Property "PROPERTY" Soft,
    EndProperty "END_PROPERTY" Soft,
    Get "GET" Soft,
    EndGet "END_GET" Soft,
    Set "SET" Soft,
    EndSet "END_SET" Soft,

    Type "TYPE" All,
    EndType "END_TYPE" All,
    Struct "STRUCT" All,
    EndStruct "END_STRUCT" All,
    Union "UNION" Soft,
    EndUnion "END_UNION" Soft,
    Array "ARRAY" All,
    RefTo "REF_TO" Edition3,
    Pointer "POINTER" Soft,
    Reference "REFERENCE" Soft,
    Overlap "OVERLAP" Edition3,

    Var "VAR" All,
    VarInput "VAR_INPUT" All,
    VarOutput "VAR_OUTPUT" All,
    VarInOut "VAR_IN_OUT" All,
    VarTemp "VAR_TEMP" All,
    VarExternal "VAR_EXTERNAL" All,
    VarGlobal "VAR_GLOBAL" All,
    VarAccess "VAR_ACCESS" All,
    VarConfig "VAR_CONFIG" All,
    VarStat "VAR_STAT" Soft,
    VarInst "VAR_INST" Soft,
    EndVar "END_VAR" All,
    Constant "CONSTANT" All,
    Retain "RETAIN" All,
    NonRetain "NON_RETAIN" All,
    Persistent "PERSISTENT" Soft,
    At "AT" All,
    REdge "R_EDGE" All,
    FEdge "F_EDGE" All,

    Configuration "CONFIGURATION" All,
    EndConfiguration "END_CONFIGURATION" All,
    Resource "RESOURCE" All,
    EndResource "END_RESOURCE" All,
    On "ON" SoftInCodesys,
    Task "TASK" All,
    With "WITH" All,
    ReadOnly "READ_ONLY" All,
    ReadWrite "READ_WRITE" All,

    Step "STEP" Chart,
    EndStep "END_STEP" Chart,
    InitialStep "INITIAL_STEP" Chart,
    Transition "TRANSITION" Chart,
    EndTransition "END_TRANSITION" Chart,
    From "FROM" Chart,

    Test "TEST" Soft,
    EndTest "END_TEST" Soft,
    Setup "SETUP" Soft,
    EndSetup "END_SETUP" Soft,
    Teardown "TEARDOWN" Soft,
    EndTeardown "END_TEARDOWN" Soft,
    Mock "MOCK" Soft,
    MockFunction "MOCK_FUNCTION" Soft,
    Returns "RETURNS" Soft,
}

impl Kind {
    /// The keyword's spelling; `None` for all that is no keyword.
    pub fn keyword(self) -> Option<&'static str> {
        let first = Kind::If as usize;
        let index = (self as usize).checked_sub(first)?;
        Some(KEYWORDS[index].1)
    }

    /// Whether it is an operator that compares.
    pub(crate) fn compares(self) -> bool {
        matches!(
            self,
            Self::Equal
                | Self::NotEqual
                | Self::Less
                | Self::LessEqual
                | Self::Greater
                | Self::GreaterEqual
        )
    }

    /// Whether the parser never sees it.
    pub fn is_trivia(self) -> bool {
        matches!(
            self,
            Self::Comment | Self::OpenComment | Self::Pragma | Self::OpenPragma | Self::Merged
        )
    }

    /// Whether an operand can end with it, so that no operand can follow.
    pub(crate) fn ends_operand(self) -> bool {
        matches!(
            self,
            Self::Word
                | Self::ForeignWord
                | Self::Int
                | Self::Based
                | Self::Real
                | Self::BadNumber
                | Self::Time
                | Self::String
                | Self::OpenString
                | Self::Direct
                | Self::CloseParen
                | Self::CloseBracket
                | Self::Caret
                | Self::True
                | Self::False
                | Self::Null
                | Self::This
                | Self::Super
        )
    }

    /// Whether it ends a statement that holds others.
    pub(crate) fn ends_block(self) -> bool {
        matches!(
            self,
            Self::EndIf | Self::EndCase | Self::EndFor | Self::EndWhile | Self::EndRepeat
        )
    }

    /// Whether it qualifies a declaration.
    pub(crate) fn is_modifier(self) -> bool {
        matches!(
            self,
            Self::Public
                | Self::Protected
                | Self::Private
                | Self::Internal
                | Self::Final
                | Self::Abstract
                | Self::Override
                | Self::Constant
                | Self::Retain
                | Self::NonRetain
                | Self::Persistent
        )
    }

    /// Whether it opens a test, or what runs before or after tests.
    pub(crate) fn opens_test(self) -> bool {
        matches!(self, Self::Test | Self::Setup | Self::Teardown)
    }

    /// Whether it ends a unit that has an end of its own.
    pub(crate) fn closes_unit(self) -> bool {
        matches!(
            self,
            Self::EndFunction
                | Self::EndFunctionBlock
                | Self::EndProgram
                | Self::EndClass
                | Self::EndInterface
                | Self::EndType
                | Self::EndConfiguration
                | Self::EndTest
                | Self::EndSetup
                | Self::EndTeardown
        )
    }

    /// Whether it opens a section of variables.
    pub(crate) fn opens_section(self) -> bool {
        (Self::Var..=Self::VarInst).contains(&self)
    }
}

/// What each word is, by the index of its symbol.
pub(crate) struct Keywords {
    by_symbol: Vec<Option<(Kind, bool)>>,
}

impl Keywords {
    /// The keywords of a dialect, entered into the names.
    pub(crate) fn new(dialect: Dialect, names: &mut iecc_ast::Names) -> Self {
        let mut by_symbol = Vec::new();
        let mut enter = |spelling: &str, kind, soft| {
            let index = names.intern(spelling).index();
            by_symbol.resize(by_symbol.len().max(index + 1), None);
            by_symbol[index] = Some((kind, soft));
        };
        for &(kind, spelling, words) in KEYWORDS {
            if is_keyword(words, dialect) {
                enter(spelling, kind, is_soft(words, dialect));
            }
        }
        enter("S", Kind::LatchAssign, true);
        enter("R", Kind::UnlatchAssign, true);
        Self { by_symbol }
    }

    /// The kind of a word, and whether it depends on what stands around it.
    pub(crate) fn get(&self, word: Symbol) -> Option<(Kind, bool)> {
        self.by_symbol.get(word.index()).copied().flatten()
    }
}

fn is_soft(words: Words, dialect: Dialect) -> bool {
    match words {
        Words::Soft => true,
        Words::SoftInCodesys => dialect == Dialect::Codesys,
        Words::All | Words::Edition3 | Words::Chart => false,
    }
}

fn is_keyword(words: Words, dialect: Dialect) -> bool {
    match words {
        Words::All | Words::Soft | Words::SoftInCodesys => true,
        Words::Edition3 => dialect != Dialect::IecEdition2,
        Words::Chart => dialect != Dialect::Codesys,
    }
}
