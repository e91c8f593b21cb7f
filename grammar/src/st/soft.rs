//! Words that are keywords among certain other words only, and names everywhere else.
//!
//! Each rule asks for neighbours between which a name could not stand in a program that is right,
//! so no name is ever taken for a keyword. They hold in all dialects: what CODESYS alone has is
//! refused later, in words that name the switch.

use super::token::{Kind, Token};

/// Makes the words at these indices keywords where they can be nothing else.
pub(crate) fn decide(list: &mut [Token], soft: &[(u32, Kind)]) {
    let mut open = Open::default();
    for &(index, keyword) in soft {
        let index = index as usize;
        let around = Around {
            before: neighbour(list[..index].iter().rev()),
            after: neighbour(list[index + 1..].iter()),
            touches_equal: touches_equal(list, index),
        };
        if open.is_keyword(keyword, &around) {
            open.count(keyword);
            list[index].kind = keyword;
            merge_sign(list, index);
        }
    }
}

/// What stands around a word, trivia left aside.
struct Around {
    before: Option<Kind>,
    after: Option<Kind>,
    /// Whether `=` follows without white space.
    touches_equal: bool,
}

fn neighbour<'t>(tokens: impl Iterator<Item = &'t Token>) -> Option<Kind> {
    let mut kinds = tokens.map(|token| token.kind);
    kinds.find(|kind| !kind.is_trivia())
}

fn touches_equal(list: &[Token], index: usize) -> bool {
    list.get(index + 1)
        .is_some_and(|next| next.kind == Kind::Equal && next.start == list[index].end)
}

/// What is open whose words count only inside.
#[derive(Default)]
struct Open {
    properties: u32,
    unions: u32,
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
            Kind::Pointer | Kind::Reference => {
                after(&[Kind::To]) && before(&[Kind::Colon, Kind::Of, Kind::To, Kind::RefTo])
            }
            Kind::Property => !named && before_name,
            Kind::VarStat | Kind::VarInst => !named && (before_name || after(&[Kind::EndVar])),
            Kind::Persistent => {
                around
                    .before
                    .is_some_and(|kind| kind.opens_section() || kind.is_modifier())
                    && !after(&[Kind::Colon, Kind::Comma, Kind::At])
            }
            Kind::Union => before(&[Kind::Colon]) && after(&[Kind::Word, Kind::EndUnion]),
            Kind::EndUnion => self.unions > 0,
            Kind::EndProperty => self.properties > 0,
            Kind::Get | Kind::Set => self.properties > 0 && !named && !after(&IN_EXPRESSION),
            Kind::EndGet | Kind::EndSet => self.properties > 0 && !named,
            _ => unreachable!("{kind:?} is not soft"),
        }
    }

    fn count(&mut self, kind: Kind) {
        if kind == Kind::Property {
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

/// A word before one of these is part of an expression or the target of an assignment.
const IN_EXPRESSION: [Kind; 18] = [
    Kind::Assign,
    Kind::OpenParen,
    Kind::OpenBracket,
    Kind::CloseParen,
    Kind::CloseBracket,
    Kind::Comma,
    Kind::Dot,
    Kind::Caret,
    Kind::Colon,
    Kind::Equal,
    Kind::NotEqual,
    Kind::Plus,
    Kind::Minus,
    Kind::Star,
    Kind::Slash,
    Kind::Then,
    Kind::Do,
    Kind::Semicolon,
];

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
