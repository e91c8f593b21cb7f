//! Words that are keywords among certain other words only, and names everywhere else.
//!
//! Each rule asks for neighbours between which a name could not stand in a program that is right,
//! so no name is ever taken for a keyword. They hold in all dialects: what CODESYS alone has is
//! refused later, in words that name the switch.

use super::token::{Kind, Token};

/// Makes the words at these indices keywords where they can be nothing else.
pub(crate) fn decide(list: &mut [Token], soft: &[(u32, Kind)]) {
    // What is an operator shows whether the word before it is a name.
    let (operators, words): (Vec<_>, Vec<_>) = soft
        .iter()
        .copied()
        .partition(|(_, keyword)| is_operator(*keyword));
    let mut open = Open::default();
    for (index, keyword) in operators.into_iter().chain(words) {
        decide_one(list, index as usize, keyword, &mut open);
    }
}

fn is_operator(keyword: Kind) -> bool {
    matches!(
        keyword,
        Kind::LatchAssign | Kind::UnlatchAssign | Kind::Ref | Kind::AndThen | Kind::OrElse
    )
}

fn decide_one(list: &mut [Token], index: usize, keyword: Kind, open: &mut Open) {
    let around = Around {
        before: neighbour(list[..index].iter().rev()),
        after: neighbour(list[index + 1..].iter()),
        touches_equal: touches_equal(list, index),
        begins_unit: begins_unit(&list[..index]),
    };
    if open.is_keyword(keyword, &around) {
        open.count(keyword);
        list[index].kind = keyword;
        merge_sign(list, index);
    }
}

/// What stands around a word, trivia left aside.
struct Around {
    before: Option<Kind>,
    after: Option<Kind>,
    /// Whether `=` follows without white space.
    touches_equal: bool,
    /// Whether a unit has ended before it, or the file begins.
    begins_unit: bool,
}

fn neighbour<'t>(tokens: impl Iterator<Item = &'t Token>) -> Option<Kind> {
    let mut kinds = tokens.map(|token| token.kind);
    kinds.find(|kind| !kind.is_trivia())
}

fn touches_equal(list: &[Token], index: usize) -> bool {
    list.get(index + 1)
        .is_some_and(|next| next.kind == Kind::Equal && next.start == list[index].end)
}

fn begins_unit(before: &[Token]) -> bool {
    let kinds = before.iter().rev().map(|token| token.kind);
    let mut kinds = kinds.filter(|kind| !kind.is_trivia()).peekable();
    let closed = kinds.next_if_eq(&Kind::Semicolon).is_some();
    kinds.next().map_or(!closed, Kind::closes_unit)
}

/// What is open whose words count only inside.
#[derive(Default)]
struct Open {
    properties: u32,
    unions: u32,
    tests: u32,
}

impl Open {
    fn is_keyword(&self, kind: Kind, around: &Around) -> bool {
        let before = |kinds: &[Kind]| around.before.is_some_and(|kind| kinds.contains(&kind));
        let after = |kinds: &[Kind]| around.after.is_some_and(|kind| kinds.contains(&kind));
        let behind_operand = around.before.is_some_and(Kind::ends_operand);
        let named = before(&NAMED_BEFORE);
        let before_name = after(&[Kind::Word]) || around.after.is_some_and(Kind::is_modifier);
        match kind {
            Kind::LatchAssign | Kind::UnlatchAssign | Kind::Ref => {
                behind_operand && around.touches_equal
            }
            Kind::AndThen | Kind::OrElse => behind_operand,
            Kind::Pointer | Kind::Reference => after(&[Kind::To]) && before(&TYPE_BEFORE),
            Kind::Property => !named && before_name,
            Kind::VarStat | Kind::VarInst => !named && (before_name || after(&[Kind::EndVar])),
            Kind::Persistent => {
                around
                    .before
                    .is_some_and(|kind| kind.opens_section() || kind.is_modifier())
                    && !after(&[Kind::Colon, Kind::Comma, Kind::At])
            }
            Kind::Union => before(&TYPE_BEFORE) && after(&[Kind::Word, Kind::EndUnion]),
            Kind::EndUnion => self.unions > 0,
            Kind::EndProperty => self.properties > 0,
            Kind::Get | Kind::Set => {
                let begins = behind_operand || before(&[Kind::EndGet, Kind::EndSet]);
                let empty = begins && after(&[Kind::Semicolon]);
                let holds = around.after.is_some_and(begins_accessor);
                self.properties > 0 && !named && (empty || holds)
            }
            Kind::EndGet | Kind::EndSet => self.properties > 0 && !named,
            // `RESOURCE name ON name`; two names never stand side by side elsewhere.
            Kind::On => before(&[Kind::Word]) && after(&[Kind::Word]),
            Kind::Test => after(&[Kind::String, Kind::OpenString]),
            Kind::Setup | Kind::Teardown => {
                let modified = around.before.is_some_and(Kind::is_modifier);
                let holds = around.after.is_some_and(Kind::opens_section);
                around.begins_unit || holds && !named && !modified
            }
            Kind::EndTest | Kind::EndSetup | Kind::EndTeardown => self.tests > 0 && !named,
            Kind::Mock | Kind::MockFunction => !named && after(&[Kind::Word]),
            Kind::Returns => before(&[Kind::Word]),
            _ => unreachable!("{kind:?} is not soft"),
        }
    }

    fn count(&mut self, kind: Kind) {
        if kind.opens_test() {
            self.tests += 1;
        } else if kind == Kind::Property {
            self.properties += 1;
        } else if kind == Kind::EndProperty {
            self.properties -= 1;
        } else if kind == Kind::Union {
            self.unions += 1;
        } else if kind == Kind::EndUnion {
            self.unions -= 1;
        }
    }
}

/// Behind these a type may follow.
const TYPE_BEFORE: [Kind; 4] = [Kind::Colon, Kind::Of, Kind::To, Kind::RefTo];

/// Behind these a name must follow, or an expression.
const NAMED_BEFORE: [Kind; 24] = [
    Kind::Dot,
    Kind::Colon,
    Kind::Comma,
    Kind::Assign,
    Kind::Arrow,
    Kind::OpenParen,
    Kind::OpenBracket,
    Kind::Function,
    Kind::FunctionBlock,
    Kind::Program,
    Kind::Class,
    Kind::Interface,
    Kind::Method,
    Kind::Namespace,
    Kind::Property,
    Kind::Action,
    Kind::Task,
    Kind::Extends,
    Kind::Implements,
    Kind::Plus,
    Kind::Minus,
    Kind::Not,
    Kind::Public,
    Kind::Private,
];

/// What may stand first in GET or SET. No name that is part of an expression stands before it.
fn begins_accessor(kind: Kind) -> bool {
    let ends = matches!(kind, Kind::EndGet | Kind::EndSet);
    let statement = matches!(
        kind,
        Kind::Word
            | Kind::Direct
            | Kind::This
            | Kind::Super
            | Kind::If
            | Kind::Case
            | Kind::For
            | Kind::While
            | Kind::Repeat
            | Kind::Return
            | Kind::Exit
            | Kind::Continue
    );
    ends || statement || kind.is_modifier() || kind.opens_section()
}

/// Makes one token of `S` and `=`.
fn merge_sign(list: &mut [Token], index: usize) {
    let assigns = matches!(
        list[index].kind,
        Kind::LatchAssign | Kind::UnlatchAssign | Kind::Ref
    );
    if !assigns {
        return;
    }
    if list[index].kind == Kind::Ref {
        list[index].kind = Kind::BindAssign;
    }
    list[index].end += 1;
    list[index + 1].kind = Kind::Merged;
}
