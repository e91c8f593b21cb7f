//! What a unit shows to others, as a hash: its text without comments and the statements of its
//! bodies. Where it is the same before and after a change, nothing but statements and comments changed.

use super::feed::Feed;
use super::lexer::Tokens;
use iecc_ast::st::{Arena, Block, Member, TypeSpec, UnitKind, VarDecl, VarSection};
use iecc_source::{ContentHash, TextRange};

/// The hash of the declarations of a unit that begins at a byte of the file.
pub(super) fn declared(
    tokens: &Tokens<'_>,
    feed: &Feed,
    start: u32,
    kind: &UnitKind,
    arena: &Arena,
) -> ContentHash {
    let mut bodies = statements(kind, arena).into_iter().peekable();
    let mut pragmas = feed.pragmas.iter().peekable();
    let mut outside = String::new();
    for &(first, token, _) in &feed.tokens {
        let first = first - start;
        while bodies.next_if(|body| body.end <= first).is_some() {}
        if bodies.peek().is_none_or(|body| first < body.start) {
            while let Some(pragma) = pragmas.next_if(|pragma| pragma.range.start < first) {
                outside.push_str(&pragma.text);
                outside.push('\0');
            }
            outside.push_str(tokens.slice(token));
            outside.push(' ');
        }
    }
    pragmas.for_each(|pragma| outside.push_str(&pragma.text));
    outside.push_str(&shape(kind, arena));
    ContentHash::of(&outside)
}

/// From the first to the last statement of each body, in order.
fn statements(kind: &UnitKind, arena: &Arena) -> Vec<TextRange> {
    let bodies = kind.bodies(arena).into_iter();
    let ranges = bodies.filter_map(|body| match &arena[body] {
        [] => None,
        [first, .., last] => Some(arena[*first].range.to(arena[*last].range)),
        [only] => Some(arena[*only].range),
    });
    let mut ranges: Vec<TextRange> = ranges.collect();
    ranges.sort_unstable();
    ranges
}

/// Which bodies are empty, and how much is declared: after a mistake the same text may be read as
/// more or less.
fn shape(kind: &UnitKind, arena: &Arena) -> String {
    let mut shape: String = kind.bodies(arena).into_iter().map(empty_mark).collect();
    let counts = [
        arena.count::<VarSection>(),
        arena.count::<VarDecl>(),
        arena.count::<TypeSpec>(),
        arena.count::<Member>(),
    ];
    for count in counts {
        shape.push_str(&format!(" {count}"));
    }
    shape
}

fn empty_mark(body: Block) -> char {
    if body.is_empty() { '0' } else { '1' }
}
