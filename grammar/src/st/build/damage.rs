//! What is left of declarations and units that the parser could not read: their names, with
//! unknown types, so that their uses are no further mistakes.

use super::Build;
use crate::st::token::{Kind, Token};
use iecc_ast::st::{EnumValue, Id, Ident, TypeDecl, TypeKind, TypeSpec, UnitKind, VarDecl};
use std::collections::BTreeSet;

impl<'b, 't> Build<'b, 't> {
    /// Adds the variables of a damaged declaration between two bytes.
    pub(crate) fn damaged_variables(
        &mut self,
        mut list: Vec<VarDecl>,
        start: u32,
        end: u32,
    ) -> Vec<VarDecl> {
        let names = self.leading_names(start, end);
        if !names.is_empty() {
            let ty = self.damaged_type(start, end);
            list.push(self.variable(start, names, None, ty, None, None, end));
        }
        list
    }

    /// Adds the type of a damaged declaration between two bytes.
    pub(crate) fn damaged_types(
        &mut self,
        mut list: Vec<TypeDecl>,
        start: u32,
        end: u32,
    ) -> Vec<TypeDecl> {
        if let Some(&name) = self.leading_names(start, end).first() {
            let ty = self.damaged_type(start, end);
            list.push(self.type_decl(start, name, None, ty, None, end));
        }
        list
    }

    /// What stands for a unit that could not be read at all.
    pub(crate) fn damaged_unit(&mut self, opener: Kind, start: u32, end: u32) -> UnitKind {
        let names: Vec<Ident> = match opener {
            Kind::Function
            | Kind::FunctionBlock
            | Kind::Program
            | Kind::Class
            | Kind::Interface => {
                let mut words = self.tokens_between(start, end).skip(1);
                let name = words.find(|token| !token.kind.is_modifier());
                name.filter(|token| token.kind == Kind::Word)
                    .map(|token| self.ident(token))
                    .into_iter()
                    .collect()
            }
            _ if self.names_unit(start, end) => self.leading_word(start, end),
            Kind::Type => self.declared_names(start, end),
            _ => return UnitKind::Error,
        };
        if names.is_empty() {
            return UnitKind::Error;
        }
        let ty = self.type_spec(start, TypeKind::Error, end);
        let decls = names
            .into_iter()
            .map(|name| self.type_decl(start, name, None, ty, None, end))
            .collect();
        self.types(Vec::new(), decls)
    }

    /// Whether a text begins with a name that is not declared there, as units do behind their opener.
    fn names_unit(&self, start: u32, end: u32) -> bool {
        let mut tokens = self.tokens_between(start, end).map(|token| token.kind);
        tokens.next() == Some(Kind::Word) && tokens.next() != Some(Kind::Colon)
    }

    fn leading_word(&self, start: u32, end: u32) -> Vec<Ident> {
        let first = self.tokens_between(start, end).next();
        first.map(|token| self.ident(token)).into_iter().collect()
    }

    /// Words with a colon behind them.
    fn declared_names(&self, start: u32, end: u32) -> Vec<Ident> {
        let tokens: Vec<Token> = self.tokens_between(start, end).collect();
        let pairs = tokens.windows(2);
        pairs
            .filter(|pair| pair[0].kind == Kind::Word && pair[1].kind == Kind::Colon)
            .map(|pair| self.ident(pair[0]))
            .collect()
    }

    /// The names before each colon, and the first word where there is none.
    fn leading_names(&mut self, start: u32, end: u32) -> Vec<Ident> {
        let tokens: Vec<Token> = self.tokens_between(start, end).collect();
        let mut names: Vec<Ident> = Vec::new();
        for (at, _) in tokens
            .iter()
            .enumerate()
            .filter(|(_, t)| t.kind == Kind::Colon)
        {
            let types = |at: usize| at > 0 && tokens[at - 1].kind == Kind::Colon;
            let before = tokens[..at].iter().enumerate().rev();
            let listed = before.take_while(|(at, token)| is_listed(token.kind) && !types(*at));
            let listed = listed.filter(|(_, token)| token.kind != Kind::Comma);
            names.extend(listed.map(|(_, &token)| self.ident(token)));
        }
        if names.is_empty() {
            let words = tokens
                .iter()
                .take_while(|token| is_word(token.kind) || token.kind == Kind::Comma);
            let words = words.filter(|token| is_word(token.kind));
            names.extend(words.map(|&token| self.ident(token)));
        }
        let mut known = BTreeSet::new();
        names.retain(|name| known.insert(name.name));
        self.lost_names |= names.is_empty() || has_gap(&tokens);
        names
    }

    /// An enumeration keeps its values; all other types are unknown.
    fn damaged_type(&mut self, start: u32, end: u32) -> Id<TypeSpec> {
        let mut behind = self
            .tokens_between(start, end)
            .skip_while(|token| token.kind != Kind::Colon)
            .skip(1);
        let kind = match behind.next().map(|token| token.kind) {
            Some(Kind::OpenParen) => {
                let listed: Vec<Token> = behind
                    .take_while(|token| token.kind != Kind::CloseParen)
                    .collect();
                self.lost_names |= has_gap(&listed);
                let words = listed.into_iter().filter(|token| is_word(token.kind));
                let values: Vec<EnumValue> = words
                    .map(|token| EnumValue {
                        name: self.ident(token),
                        value: None,
                    })
                    .collect();
                TypeKind::Enum {
                    base: None,
                    values: self.arena.list(values),
                }
            }
            _ => TypeKind::Error,
        };
        self.type_spec(start, kind, end)
    }

    fn ident(&self, token: Token) -> Ident {
        Ident {
            name: token.symbol,
            range: self.range(token.start, token.end),
        }
    }

    /// The tokens between two bytes of the file, without comments.
    fn tokens_between(&self, start: u32, end: u32) -> impl Iterator<Item = Token> + use<'b, 't> {
        let tokens: &'b [Token] = &self.tokens.list;
        let first = tokens.partition_point(|token| token.start < start);
        let all = tokens[first..].iter().copied();
        all.take_while(move |token| token.start < end)
            .filter(|token| !token.kind.is_trivia())
    }
}

fn is_word(kind: Kind) -> bool {
    matches!(kind, Kind::Word | Kind::ForeignWord)
}

/// Whether a name is missing in a list.
fn has_gap(tokens: &[Token]) -> bool {
    let comma = |token: &Token| token.kind == Kind::Comma;
    let pairs = tokens.windows(2);
    let gap = |pair: &[Token]| comma(&pair[0]) && (comma(&pair[1]) || pair[1].kind == Kind::Colon);
    tokens.first().is_none_or(comma)
        || tokens.last().is_some_and(comma)
        || pairs.into_iter().any(gap)
}

/// What a list of names before a colon consists of.
fn is_listed(kind: Kind) -> bool {
    is_word(kind) || kind == Kind::Comma || kind.keyword().is_some()
}
