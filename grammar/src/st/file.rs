//! Parses files: units in their namespaces. A unit whose text did not change since the file was
//! parsed before is taken from there.

use super::Dialect;
use super::feed::{Located, feed};
use super::lexer::{Tokens, lex};
use super::slice::{Fragment, FragmentKind, slice};
use super::token::Kind;
use super::unit::parse_unit;
use iecc_ast::Names;
use iecc_ast::st::{File, Ident, Item, MAX_SCOPE_DEPTH, Scope, ScopeId, Unit, UnitKind};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{ContentHash, FileId, Span, TextRange};
use std::collections::HashMap;

/// Parses a whole file. Every mistake is in `diagnostics`, in the order of their places.
pub fn parse_file(
    file: FileId,
    text: &str,
    dialect: Dialect,
    names: &mut Names,
    diagnostics: &mut Diagnostics,
) -> File {
    let parsed = reparse_file(file, text, dialect, names, None);
    diagnostics.append(parsed.found);
    parsed.file
}

/// A file that was parsed, and what was found.
#[derive(Debug, Clone)]
pub struct Parsed {
    /// The tree.
    pub file: File,
    /// Every mistake, in the order of their places.
    pub found: Diagnostics,
    /// The mistakes in the text of each unit.
    by_unit: Vec<Diagnostics>,
}

/// Parses a file again after its text changed: units whose text did not change are taken from
/// what was parsed before, in the same dialect and with the same names.
pub fn reparse_file(
    file: FileId,
    text: &str,
    dialect: Dialect,
    names: &mut Names,
    before: Option<Parsed>,
) -> Parsed {
    let tokens = lex(file, text, dialect, names);
    let mut assembler = Assembler::new(&tokens, Known::new(before));
    if dialect == Dialect::IecEdition2 {
        nested_comments(&tokens, &mut assembler.found);
    }
    for fragment in &slice(&tokens) {
        assembler.take(fragment);
    }
    assembler.finish()
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

/// Units that were parsed before, by their text.
#[derive(Default)]
struct Known {
    units: HashMap<ContentHash, Vec<(Unit, Diagnostics)>>,
}

impl Known {
    fn new(before: Option<Parsed>) -> Self {
        let mut known = Self::default();
        if let Some(parsed) = before {
            for one in parsed.file.units.into_iter().zip(parsed.by_unit) {
                known.units.entry(one.0.hash).or_default().push(one);
            }
        }
        known
    }

    /// A unit with the text of a fragment, in its place.
    fn take(&mut self, fragment: &Fragment) -> Option<(Unit, Diagnostics)> {
        let (mut unit, found) = self.units.get_mut(&fragment.hash)?.pop()?;
        let (from, to) = (unit.start, fragment.start);
        let mut moved = Diagnostics::new();
        for diagnostic in &found {
            let shift = |offset: u32| offset - from + to;
            moved.push(
                diagnostic
                    .clone()
                    .moved(|span| Span::new(span.file, shift(span.start), shift(span.end))),
            );
        }
        unit.start = to;
        Some((unit, moved))
    }
}

/// Puts units into their namespaces.
struct Assembler<'a, 't> {
    tokens: &'a Tokens<'t>,
    file: File,
    /// The open namespaces, innermost last; the file is the first.
    open: Vec<ScopeId>,
    known: Known,
    found: Diagnostics,
    by_unit: Vec<Diagnostics>,
}

impl<'a, 't> Assembler<'a, 't> {
    fn new(tokens: &'a Tokens<'t>, known: Known) -> Self {
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
            known,
            found: Diagnostics::new(),
            by_unit: Vec::new(),
        }
    }

    fn take(&mut self, fragment: &Fragment) {
        match fragment.kind {
            FragmentKind::NamespaceOpen => self.open_namespace(fragment),
            FragmentKind::NamespaceClose => self.close_namespace(fragment),
            FragmentKind::Unit(_) | FragmentKind::Stray | FragmentKind::Trailing => {
                let (unit, found) = self.unit(fragment);
                if unit.kind != UnitKind::Nothing || !unit.pragmas.is_empty() {
                    self.add(unit);
                    self.by_unit.push(found.clone());
                }
                self.found.append(found);
            }
        }
    }

    fn unit(&mut self, fragment: &Fragment) -> (Unit, Diagnostics) {
        if let Some(known) = self.known.take(fragment) {
            return known;
        }
        let mut found = Diagnostics::new();
        let unit = parse_unit(self.tokens, fragment, &mut found);
        (unit, found)
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

    fn open_namespace(&mut self, fragment: &Fragment) {
        let list = feed(self.tokens, fragment, &mut self.found).tokens;
        let opener = Span::new(self.tokens.file, list[0].0, list[0].2);
        let names = list.iter().filter(|token| token.1.kind == Kind::Word);
        let name: Vec<Ident> = names.map(ident).collect();
        if !is_name(&list) {
            let diagnostic = Diagnostic::new(Code::E0032, opener, "the namespace has no name")
                .label(
                    "expected a name behind it, perhaps of several parts with dots between them",
                );
            self.found.push(diagnostic);
        }
        if self.open.len() > MAX_SCOPE_DEPTH {
            return self.too_deep(opener);
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
    fn too_deep(&mut self, opener: Span) {
        if self.open.len() == MAX_SCOPE_DEPTH + 1 {
            let message = format!("namespaces nest more than {MAX_SCOPE_DEPTH} deep");
            self.found
                .push(Diagnostic::new(Code::E0013, opener, message));
        }
        self.open.push(self.innermost());
    }

    fn close_namespace(&mut self, fragment: &Fragment) {
        let list = feed(self.tokens, fragment, &mut self.found).tokens;
        let closer = Span::new(self.tokens.file, list[0].0, list[0].2);
        if self.open.len() == 1 {
            let message = "END_NAMESPACE ends no namespace";
            let diagnostic = Diagnostic::new(Code::E0012, closer, message);
            return self.found.push(diagnostic);
        }
        let scope = self.scope();
        scope.span = scope.span.to(closer);
        self.open.pop();
    }

    fn finish(mut self) -> Parsed {
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
            self.found.push(diagnostic);
            self.open.pop();
        }
        Parsed {
            file: self.file,
            found: self.found,
            by_unit: self.by_unit,
        }
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
