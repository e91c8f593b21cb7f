//! Parses one unit: as it stands if it is right, else mended, with recovery from what is left.

use super::build::{Build, SyntaxError};
use super::declared::declared;
use super::depth::nesting_error;
use super::explain::Explain;
use super::feed::{Feed, Located, feed};
use super::foreign::translated;
use super::lexer::Tokens;
use super::repair::repair;
use super::slice::{Fragment, FragmentKind};
use super::token::Kind;
use crate::generated::st::UnitParser;
use iecc_ast::st::{Arena, ScopeId, Unit, UnitKind};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::Span;

/// Parses one fragment. Its scope is that of the file; whoever knows better changes it.
pub fn parse_unit(tokens: &Tokens<'_>, fragment: &Fragment, diagnostics: &mut Diagnostics) -> Unit {
    let mut found = Diagnostics::new();
    let feed = feed(tokens, fragment, &mut found);
    let mut lost_names = fragment.kind == FragmentKind::Stray;
    let (kind, arena) = match fragment.kind {
        FragmentKind::Unit(opener) => {
            let read = parse(tokens, fragment, opener, &feed, &mut found);
            lost_names = read.lost_names;
            (read.kind, read.arena)
        }
        FragmentKind::Trailing => (UnitKind::Nothing, Arena::new()),
        FragmentKind::Stray => {
            stray(tokens, &feed.tokens, &mut found);
            let mut build = Build::new(tokens, fragment.start, false);
            let kind = damaged_unit(&mut build, Kind::Type, &feed);
            (kind, build.arena)
        }
        FragmentKind::NamespaceOpen | FragmentKind::NamespaceClose => {
            (UnitKind::Nothing, Arena::new())
        }
    };
    found.sort();
    let has_errors = found.has_errors();
    diagnostics.append(found);
    Unit {
        file: tokens.file,
        start: fragment.start,
        hash: fragment.hash,
        declared: declared(tokens, &feed, fragment.start, &kind, &arena),
        scope: ScopeId::FILE,
        kind,
        arena,
        pragmas: feed.pragmas,
        has_errors,
        lost_names,
    }
}

/// What the parser made of a unit.
struct Read {
    kind: UnitKind,
    arena: Arena,
    /// As in [`Unit`].
    lost_names: bool,
}

fn parse(
    tokens: &Tokens<'_>,
    fragment: &Fragment,
    opener: Kind,
    feed: &Feed,
    found: &mut Diagnostics,
) -> Read {
    if let Some(diagnostic) = nesting_error(tokens.file, &feed.tokens) {
        found.push(diagnostic);
        let mut build = Build::new(tokens, fragment.start, false);
        return Read {
            kind: damaged_unit(&mut build, opener, feed),
            arena: build.arena,
            lost_names: true,
        };
    }
    let mut build = Build::new(tokens, fragment.start, true);
    if let Ok(kind) = run(&mut build, &feed.tokens) {
        found.append(build.diagnostics);
        return Read {
            kind,
            arena: build.arena,
            lost_names: false,
        };
    }
    let feed = &translated(tokens, feed, found);
    let repaired = repair(tokens, opener, feed, found);
    let mut build = Build::new(tokens, fragment.start, false);
    build.unbalanced.clone_from(&repaired.brackets);
    let kind = match run(&mut build, &repaired.tokens) {
        Ok(kind) => kind,
        Err(error) => {
            if !build.has_too_many_errors() {
                build.errors.push(error);
            }
            build.lost_names = true;
            damaged_unit(&mut build, opener, feed)
        }
    };
    let explain = Explain {
        tokens,
        feed: &repaired.tokens,
    };
    let news = build
        .errors
        .iter()
        .filter(|error| !repaired.is_known(error, feed));
    news.for_each(|error| found.push(explain.error(error)));
    found.append(build.diagnostics);
    Read {
        kind,
        arena: build.arena,
        lost_names: build.lost_names || repaired.unsorted,
    }
}

fn damaged_unit(build: &mut Build<'_, '_>, opener: Kind, feed: &Feed) -> UnitKind {
    match feed.tokens[..] {
        [(start, ..), .., (.., end)] => build.damaged_unit(opener, start, end),
        _ => UnitKind::Error,
    }
}

fn run(build: &mut Build<'_, '_>, tokens: &[Located]) -> Result<UnitKind, SyntaxError> {
    UnitParser::new().parse(build, tokens.iter().copied().map(Ok))
}

fn stray(tokens: &Tokens<'_>, list: &[Located], found: &mut Diagnostics) {
    let Some(&(start, token, end)) = list.first() else {
        return;
    };
    let text = tokens.slice(token);
    let span = Span::new(tokens.file, start, end);
    let message = format!("`{text}` stands outside of every unit");
    let expected = if text.eq_ignore_ascii_case("TEST") {
        "expected a title behind it: TEST 'title'"
    } else {
        "expected FUNCTION, FUNCTION_BLOCK, PROGRAM, TYPE, CLASS, INTERFACE, NAMESPACE, CONFIGURATION, VAR_GLOBAL or TEST"
    };
    let diagnostic = Diagnostic::new(Code::E0030, span, message).label(expected);
    found.push(diagnostic);
}
