//! Cuts the tokens of a file at the boundaries of units, so that a mistake in one unit never
//! reaches the next, and a unit whose text did not change need not be read again.
//!
//! Namespaces are not cut out whole: their opening and closing words are fragments of their own,
//! and what stands between them are units like any other.

use super::lexer::Tokens;
use super::repair::{is_misspelt_closer, misspelt_unit};
use super::token::{Kind, Token};
use iecc_source::ContentHash;
use std::ops::Range;

/// A piece of a file: one unit, or what stands between units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fragment {
    /// What it is.
    pub kind: FragmentKind,
    /// Its tokens, those of comments and pragmas before it included.
    pub tokens: Range<usize>,
    /// First byte in the file.
    pub start: u32,
    /// One behind the last byte.
    pub end: u32,
    /// The hash of its text.
    pub hash: ContentHash,
}

/// What a fragment is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FragmentKind {
    /// A unit that this keyword opens.
    Unit(Kind),
    /// `NAMESPACE` and its name.
    NamespaceOpen,
    /// `END_NAMESPACE`.
    NamespaceClose,
    /// Tokens that belong to no unit.
    Stray,
    /// Comments and pragmas behind the last unit.
    Trailing,
}

/// Cuts a file into fragments. Every token is in one of them, and they are in order.
pub fn slice(tokens: &Tokens<'_>) -> Vec<Fragment> {
    let mut slicer = Slicer {
        tokens,
        fragments: Vec::new(),
        first: 0,
        open: None,
    };
    slicer.run();
    slicer.fragments
}

struct Slicer<'a, 't> {
    tokens: &'a Tokens<'t>,
    fragments: Vec<Fragment>,
    /// The first token that is in no fragment yet.
    first: usize,
    /// What the tokens since `first` are.
    open: Option<FragmentKind>,
}

impl Slicer<'_, '_> {
    fn run(&mut self) {
        let mut at = 0;
        while at < self.tokens.list.len() {
            at = self.step(at);
        }
        self.close(at);
        if self.first < at {
            self.open = Some(FragmentKind::Trailing);
            self.close(at);
        }
    }

    /// Takes the token at an index; gives the index of the next.
    fn step(&mut self, at: usize) -> usize {
        let kind = self.tokens.list[at].kind;
        if kind.is_trivia() {
            return at + 1;
        }
        if let Some(kind) = self.misspelt_unit(at) {
            self.close_before(at);
            return self.open_fragment(kind, at);
        }
        if self.opens_unit(kind, at) {
            self.close_before(at);
            return self.open_fragment(kind, at);
        }
        match self.open {
            Some(FragmentKind::Unit(opener))
                if closes(opener, kind) || self.misspelt_closer(opener, at) =>
            {
                let end = self.behind_semicolon(at);
                self.close(end);
                end
            }
            Some(_) => at + 1,
            None => {
                self.open = Some(FragmentKind::Stray);
                at + 1
            }
        }
    }

    /// The unit that a word outside of all units was meant to open.
    fn misspelt_unit(&self, at: usize) -> Option<Kind> {
        let token = self.tokens.list[at];
        let outside = self.open.is_none() && token.kind == Kind::Word && self.next_is_name(at);
        outside.then(|| misspelt_unit(self.tokens.slice(token)))?
    }

    /// Whether a word was meant to close a unit, with a word behind it that was meant to open the next.
    fn misspelt_closer(&self, opener: Kind, at: usize) -> bool {
        let token = self.tokens.list[at];
        let opens = |next: &Token| {
            next.kind == Kind::Word && misspelt_unit(self.tokens.slice(*next)).is_some()
        };
        token.kind == Kind::Word
            && is_misspelt_closer(self.tokens.slice(token), opener)
            && self.following(at).next().is_some_and(opens)
    }

    fn open_fragment(&mut self, kind: Kind, at: usize) -> usize {
        let (kind, end) = match kind {
            Kind::Namespace => (FragmentKind::NamespaceOpen, self.behind_name(at + 1)),
            Kind::EndNamespace => (FragmentKind::NamespaceClose, self.behind_semicolon(at)),
            kind => {
                self.open = Some(FragmentKind::Unit(kind));
                return at + 1;
            }
        };
        self.open = Some(kind);
        self.close(end);
        end
    }

    /// Whether a keyword opens a unit here, also where the one before is not closed.
    fn opens_unit(&self, kind: Kind, at: usize) -> bool {
        let inside = match self.open {
            Some(FragmentKind::Unit(opener)) => Some(opener),
            Some(_) | None => None,
        };
        let named = || self.next_is_name(at);
        match kind {
            Kind::Function | Kind::FunctionBlock | Kind::Class | Kind::Interface => {
                inside.is_none() || named()
            }
            Kind::Program if inside == Some(Kind::Configuration) => {
                named() && !self.is_instance(at)
            }
            Kind::Program | Kind::Configuration => inside.is_none() || named(),
            Kind::Type => inside.is_none() || named() && self.declares_type(at),
            Kind::Namespace => inside.is_none() || named(),
            Kind::EndNamespace => true,
            Kind::VarGlobal | Kind::VarConfig => matches!(inside, None | Some(Kind::Type)),
            Kind::Using => inside.is_none(),
            // They are keywords only where they can be nothing else.
            Kind::Test | Kind::Setup | Kind::Teardown => true,
            _ => false,
        }
    }

    /// Whether a name follows, perhaps behind FINAL, ABSTRACT and the like.
    fn next_is_name(&self, at: usize) -> bool {
        self.following(at)
            .find(|token| !token.kind.is_modifier())
            .is_some_and(|token| token.kind == Kind::Word)
    }

    /// `PROGRAM name WITH task : type` or `PROGRAM name : type`, perhaps with a slip in it: what tells
    /// it from a unit is that there is a colon or semicolon before any section or assignment.
    fn is_instance(&self, at: usize) -> bool {
        const LONGEST: usize = 16;
        let mut kinds = self.following(at).take(LONGEST).map(|token| token.kind);
        let end = kinds.find(|&kind| {
            kind.opens_section()
                || matches!(
                    kind,
                    Kind::With | Kind::Colon | Kind::Semicolon | Kind::Assign | Kind::EndProgram
                )
        });
        matches!(end, Some(Kind::With | Kind::Colon | Kind::Semicolon))
    }

    /// `TYPE name :`, where a variable named `type` would be `type : …`.
    fn declares_type(&self, at: usize) -> bool {
        let mut next = self.following(at).filter(|token| !token.kind.is_modifier());
        next.nth(1).is_some_and(|token| token.kind == Kind::Colon)
    }

    fn following(&self, at: usize) -> impl Iterator<Item = &Token> {
        let rest = self.tokens.list[at + 1..].iter();
        rest.filter(|token| !token.kind.is_trivia())
    }

    /// The index behind a semicolon that follows, or behind the token itself.
    fn behind_semicolon(&self, at: usize) -> usize {
        let list = &self.tokens.list;
        let mut next = at + 1;
        while next < list.len() && list[next].kind.is_trivia() {
            next += 1;
        }
        match list.get(next) {
            Some(token) if token.kind == Kind::Semicolon => next + 1,
            Some(_) | None => at + 1,
        }
    }

    /// The index behind the name of a namespace.
    fn behind_name(&self, mut at: usize) -> usize {
        let list = &self.tokens.list;
        let mut end = at;
        while let Some(token) = list.get(at) {
            let names = matches!(token.kind, Kind::Word | Kind::Dot | Kind::Internal);
            if !names && !token.kind.is_trivia() {
                break;
            }
            at += 1;
            end = if names { at } else { end };
        }
        end
    }

    /// Ends the open fragment before a unit; comments before the unit belong to the unit.
    fn close_before(&mut self, at: usize) {
        let mut end = at;
        while end > self.first && self.tokens.list[end - 1].kind.is_trivia() {
            end -= 1;
        }
        self.close(end);
    }

    fn close(&mut self, end: usize) {
        let Some(kind) = self.open.take() else {
            return;
        };
        let list = &self.tokens.list[self.first..end];
        let (Some(first), Some(last)) = (list.first(), list.last()) else {
            return;
        };
        let (start, stop) = (first.start, last.end);
        self.fragments.push(Fragment {
            kind,
            tokens: self.first..end,
            start,
            end: stop,
            hash: ContentHash::of(&self.tokens.text[start as usize..stop as usize]),
        });
        self.first = end;
    }
}

/// Whether a word ends a unit. The end of another kind of unit does as well: whoever writes
/// `END_FUNCTION` behind a function block means that.
fn closes(opener: Kind, kind: Kind) -> bool {
    match opener {
        Kind::Using => kind == Kind::Semicolon,
        Kind::VarGlobal | Kind::VarConfig => kind == Kind::EndVar,
        _ => kind.closes_unit(),
    }
}
