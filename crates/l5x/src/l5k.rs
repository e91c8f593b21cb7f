//! Tag data as a bracketed list: `[1,-2.5,[3,'text$00'],16#ff]`, values in storage order.

use crate::context::Context;
use iecc_ast::L5kValue;
use iecc_diag::Code;
use iecc_source::{MappedText, Spanned};

/// How deep lists may nest.
const MAX_DEPTH: usize = 64;

/// Reads a list or a lone value; `None` for an empty text or after a message.
pub(crate) fn read(text: &MappedText, context: &mut Context<'_>) -> Option<L5kValue> {
    if text.text().is_empty() {
        return None;
    }
    match (List { text, at: 0 }).read() {
        Ok(value) => Some(value),
        Err(Mistake { code, at, message }) => {
            context.report(code, text.span(at..at), message);
            None
        }
    }
}

struct Mistake {
    code: Code,
    at: usize,
    message: &'static str,
}

struct List<'t> {
    text: &'t MappedText,
    at: usize,
}

impl List<'_> {
    /// Keeps the open lists on a stack of its own, so that nesting cannot exhaust the thread's.
    fn read(mut self) -> Result<L5kValue, Mistake> {
        let mut open: Vec<(usize, Vec<L5kValue>)> = Vec::new();
        loop {
            self.skip_blanks();
            let mut value = if self.take(b'[') {
                open.push((self.at - 1, Vec::new()));
                if open.len() > MAX_DEPTH {
                    return Err(self.mistake(Code::E5004, "lists nest deeper than 64 levels"));
                }
                self.skip_blanks();
                if !self.take(b']') {
                    continue;
                }
                self.closed(open.pop().expect("a list was just opened"))
            } else {
                self.scalar()?
            };
            loop {
                self.skip_blanks();
                let Some((start, mut values)) = open.pop() else {
                    return self.at_end(value);
                };
                values.push(value);
                if self.take(b',') {
                    open.push((start, values));
                    break;
                }
                if !self.take(b']') {
                    return Err(self.mistake(Code::E5007, "expected `,` or `]` in the list"));
                }
                value = self.closed((start, values));
            }
        }
    }

    fn closed(&self, (start, values): (usize, Vec<L5kValue>)) -> L5kValue {
        L5kValue::List(values, self.text.span(start..self.at))
    }

    fn at_end(&self, value: L5kValue) -> Result<L5kValue, Mistake> {
        if self.at == self.bytes().len() {
            return Ok(value);
        }
        Err(self.mistake(Code::E5007, "text behind the end of the value"))
    }

    fn scalar(&mut self) -> Result<L5kValue, Mistake> {
        let start = self.at;
        if self.take(b'\'') {
            self.string()?;
        } else {
            let rest = &self.bytes()[start..];
            self.at += rest.iter().take_while(|byte| !is_separator(**byte)).count();
        }
        if self.at == start {
            return Err(self.mistake(Code::E5007, "expected a value"));
        }
        let text = self.text.text()[start..self.at].to_owned();
        Ok(L5kValue::Scalar(Spanned::new(
            text,
            self.text.span(start..self.at),
        )))
    }

    /// Up to and with the closing quote; `$` takes the next character with it.
    fn string(&mut self) -> Result<(), Mistake> {
        loop {
            match self.bytes().get(self.at) {
                None => return Err(self.mistake(Code::E5007, "the string is not closed")),
                Some(b'$') => self.at = (self.at + 2).min(self.bytes().len()),
                Some(b'\'') => break self.at += 1,
                Some(_) => self.at += 1,
            }
        }
        Ok(())
    }

    fn bytes(&self) -> &[u8] {
        self.text.text().as_bytes()
    }

    fn skip_blanks(&mut self) {
        let rest = &self.bytes()[self.at..];
        self.at += rest
            .iter()
            .take_while(|byte| byte.is_ascii_whitespace())
            .count();
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.bytes().get(self.at) == Some(&byte);
        self.at += usize::from(found);
        found
    }

    fn mistake(&self, code: Code, message: &'static str) -> Mistake {
        Mistake {
            code,
            at: self.at,
            message,
        }
    }
}

fn is_separator(byte: u8) -> bool {
    byte.is_ascii_whitespace() || matches!(byte, b',' | b'[' | b']' | b'\'')
}

#[cfg(test)]
mod tests {
    use super::*;
    use iecc_diag::Diagnostics;
    use iecc_source::FileId;

    fn parse(text: &str) -> Result<L5kValue, (Code, usize)> {
        let mut diagnostics = Diagnostics::new();
        let mapped = MappedText::verbatim(FileId::from_index(0), 0, text);
        let value = read(
            &mapped,
            &mut Context {
                diagnostics: &mut diagnostics,
            },
        );
        value.ok_or_else(|| {
            let error = diagnostics.iter().next().expect("a message");
            (
                error.code,
                error.primary.as_ref().unwrap().span.range().start,
            )
        })
    }

    fn shape(value: &L5kValue) -> String {
        match value {
            L5kValue::Scalar(text) => text.node.clone(),
            L5kValue::List(values, _) => {
                format!(
                    "<{}>",
                    values.iter().map(shape).collect::<Vec<_>>().join(" ")
                )
            }
        }
    }

    #[test]
    fn lists_nest_and_strings_hold_anything() {
        let shape = |text: &str| parse(text).map(|value| shape(&value));
        assert_eq!(
            shape("[1,-2.5e-3,\n\t[3,'a$',]b$$'],16#ff]"),
            Ok("<1 -2.5e-3 <3 'a$',]b$$'> 16#ff>".into())
        );
        assert_eq!(shape("0"), Ok("0".into()));
        assert_eq!(shape("[ ]"), Ok("<>".into()));
        assert_eq!(shape("[[],[]]"), Ok("<<> <>>".into()));
    }

    #[test]
    fn mistakes_are_pointed_at() {
        assert_eq!(parse("[1,2"), Err((Code::E5007, 4)));
        assert_eq!(parse("[1 2]"), Err((Code::E5007, 3)));
        assert_eq!(parse("[1,]"), Err((Code::E5007, 3)));
        assert_eq!(parse("['ab]"), Err((Code::E5007, 5)));
        assert_eq!(parse("1]"), Err((Code::E5007, 1)));
        assert_eq!(parse("['é$"), Err((Code::E5007, 5)));
        assert_eq!(
            parse(&"[".repeat(100_000)),
            Err((Code::E5004, MAX_DEPTH + 1))
        );
    }
}
