//! Parses units and files.

use super::Dialect;
use super::build::{Build, SyntaxError};
use super::depth::nesting_error;
use super::explain::Explain;
use super::feed::{Feed, Located, feed};
use super::lexer::{Tokens, lex};
use super::repair::repair;
use super::slice::{Fragment, FragmentKind, slice};
use super::token::Kind;
use crate::generated::st::UnitParser;
use iecc_ast::Names;
use iecc_ast::st::{Arena, File, Ident, Item, MAX_SCOPE_DEPTH, Scope, ScopeId, Unit, UnitKind};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{FileId, Span, TextRange};

/// Parses a whole file. Every mistake is in `diagnostics`, in the order of their places.
pub fn parse_file(
    file: FileId,
    text: &str,
    dialect: Dialect,
    names: &mut Names,
    diagnostics: &mut Diagnostics,
) -> File {
    let tokens = lex(file, text, dialect, names);
    let mut assembler = Assembler::new(&tokens);
    let mut found = Diagnostics::new();
    if dialect == Dialect::IecEdition2 {
        nested_comments(&tokens, &mut found);
    }
    for fragment in &slice(&tokens) {
        assembler.take(fragment, &mut found);
    }
    let file = assembler.finish(&mut found);
    diagnostics.append(found);
    file
}

/// Comments in comments are of edition 3.
fn nested_comments(tokens: &Tokens<'_>, found: &mut Diagnostics) {
    for &token in tokens
        .list
        .iter()
        .filter(|token| token.kind == Kind::Comment)
    {
        let text = tokens.slice(token);
        let Some(at) = text.get(2..).filter(|_| text.starts_with("(*")) else {
            continue;
        };
        if let Some(at) = at.find("(*") {
            let start = token.start + 2 + at as u32;
            let span = Span::new(tokens.file, start, start + 2);
            let message = "edition 2 has no comments in comments";
            found.push(Diagnostic::new(Code::E0035, span, message));
        }
    }
}

/// Parses one fragment. Its scope is that of the file; whoever knows better changes it.
pub fn parse_unit(tokens: &Tokens<'_>, fragment: &Fragment, diagnostics: &mut Diagnostics) -> Unit {
    let mut found = Diagnostics::new();
    let feed = feed(tokens, fragment, &mut found);
    let (kind, arena) = match fragment.kind {
        FragmentKind::Unit(opener) => parse(tokens, fragment, opener, &feed, &mut found),
        FragmentKind::Trailing => (UnitKind::Nothing, Arena::new()),
        FragmentKind::Stray => {
            stray(tokens, &feed.tokens, &mut found);
            (UnitKind::Error, Arena::new())
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
        scope: ScopeId::FILE,
        kind,
        arena,
        pragmas: feed.pragmas,
        has_errors,
    }
}

fn parse(
    tokens: &Tokens<'_>,
    fragment: &Fragment,
    opener: Kind,
    feed: &Feed,
    found: &mut Diagnostics,
) -> (UnitKind, Arena) {
    if let Some(diagnostic) = nesting_error(tokens.file, &feed.tokens) {
        found.push(diagnostic);
        return (UnitKind::Error, Arena::new());
    }
    let mut build = Build::new(tokens, fragment.start, true);
    if let Ok(kind) = run(&mut build, &feed.tokens) {
        found.append(build.diagnostics);
        return (kind, build.arena);
    }
    let repaired = repair(tokens, opener, feed, found);
    let mut build = Build::new(tokens, fragment.start, false);
    let kind = match run(&mut build, &repaired.tokens) {
        Ok(kind) => kind,
        Err(error) => {
            if !build.has_too_many_errors() {
                build.errors.push(error);
            }
            UnitKind::Error
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
    (kind, build.arena)
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
    let diagnostic = Diagnostic::new(Code::E0030, span, message)
        .label("expected FUNCTION, FUNCTION_BLOCK, PROGRAM, TYPE, CLASS, INTERFACE, NAMESPACE, CONFIGURATION, VAR_GLOBAL or TEST");
    found.push(diagnostic);
}

/// Puts units into their namespaces.
struct Assembler<'a, 't> {
    tokens: &'a Tokens<'t>,
    file: File,
    /// The open namespaces, innermost last; the file is the first.
    open: Vec<ScopeId>,
}

impl<'a, 't> Assembler<'a, 't> {
    fn new(tokens: &'a Tokens<'t>) -> Self {
        let span = Span::new(tokens.file, 0, tokens.text.len() as u32);
        let scope = Scope {
            parent: None,
            name: Vec::new(),
            internal: false,
            items: Vec::new(),
            span,
        };
        let file = File {
            id: tokens.file,
            name: None,
            scopes: vec![scope],
            units: Vec::new(),
        };
        Self {
            tokens,
            file,
            open: vec![ScopeId::FILE],
        }
    }

    fn take(&mut self, fragment: &Fragment, found: &mut Diagnostics) {
        match fragment.kind {
            FragmentKind::NamespaceOpen => self.open_namespace(fragment, found),
            FragmentKind::NamespaceClose => self.close_namespace(fragment, found),
            FragmentKind::Unit(_) | FragmentKind::Stray | FragmentKind::Trailing => {
                let unit = parse_unit(self.tokens, fragment, found);
                if unit.kind != UnitKind::Nothing || !unit.pragmas.is_empty() {
                    self.add(unit);
                }
            }
        }
    }

    fn add(&mut self, mut unit: Unit) {
        unit.scope = self.innermost();
        let index = self.file.units.len() as u32;
        self.file.units.push(unit);
        self.scope().items.push(Item::Unit(index));
    }

    fn innermost(&self) -> ScopeId {
        *self.open.last().expect("the file is always open")
    }

    fn scope(&mut self) -> &mut Scope {
        let id = self.innermost();
        &mut self.file.scopes[id.0 as usize]
    }

    fn open_namespace(&mut self, fragment: &Fragment, found: &mut Diagnostics) {
        let list = feed(self.tokens, fragment, found).tokens;
        let opener = Span::new(self.tokens.file, list[0].0, list[0].2);
        let names = list.iter().filter(|token| token.1.kind == Kind::Word);
        let name: Vec<Ident> = names.map(ident).collect();
        if !is_name(&list) {
            let diagnostic = Diagnostic::new(Code::E0032, opener, "the namespace has no name")
                .label(
                    "expected a name behind it, perhaps of several parts with dots between them",
                );
            found.push(diagnostic);
        }
        if self.open.len() > MAX_SCOPE_DEPTH {
            return self.too_deep(opener, found);
        }
        let scope = Scope {
            parent: Some(self.innermost()),
            name,
            internal: list.iter().any(|token| token.1.kind == Kind::Internal),
            items: Vec::new(),
            span: opener,
        };
        let id = ScopeId(self.file.scopes.len() as u32);
        self.scope().items.push(Item::Scope(id));
        self.file.scopes.push(scope);
        self.open.push(id);
    }

    /// Lets a namespace stand for the one it is in.
    fn too_deep(&mut self, opener: Span, found: &mut Diagnostics) {
        if self.open.len() == MAX_SCOPE_DEPTH + 1 {
            let message = format!("namespaces nest more than {MAX_SCOPE_DEPTH} deep");
            found.push(Diagnostic::new(Code::E0013, opener, message));
        }
        self.open.push(self.innermost());
    }

    fn close_namespace(&mut self, fragment: &Fragment, found: &mut Diagnostics) {
        let list = feed(self.tokens, fragment, found).tokens;
        let closer = Span::new(self.tokens.file, list[0].0, list[0].2);
        if self.open.len() == 1 {
            let message = "END_NAMESPACE ends no namespace";
            return found.push(Diagnostic::new(Code::E0012, closer, message));
        }
        let scope = self.scope();
        scope.span = scope.span.to(closer);
        self.open.pop();
    }

    fn finish(mut self, found: &mut Diagnostics) -> File {
        let end = self.tokens.text.len() as u32;
        while self.open.len() > 1 {
            let scope = self.scope();
            let opener = scope.span;
            scope.span.end = end;
            let diagnostic = Diagnostic::new(Code::E0011, opener, "NAMESPACE is not closed")
                .label("this has no END_NAMESPACE")
                .fix(
                    "close the namespace",
                    Span::point(opener.file, end),
                    "\nEND_NAMESPACE\n",
                );
            found.push(diagnostic);
            self.open.pop();
        }
        self.file
    }
}

fn ident(&(start, token, end): &Located) -> Ident {
    Ident {
        name: token.symbol,
        range: TextRange::new(start, end),
    }
}

/// `NAMESPACE`, perhaps INTERNAL, and words with dots between them.
fn is_name(list: &[Located]) -> bool {
    let mut kinds = list[1..].iter().map(|token| token.1.kind).peekable();
    kinds.next_if_eq(&Kind::Internal);
    let kinds: Vec<Kind> = kinds.collect();
    let alternates = kinds
        .iter()
        .enumerate()
        .all(|(at, &kind)| kind == if at % 2 == 0 { Kind::Word } else { Kind::Dot });
    kinds.len() % 2 == 1 && alternates
}
