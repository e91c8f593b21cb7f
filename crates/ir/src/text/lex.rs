//! Tokens of the text form, each with its offset; whatever is none is refused.

/// Units of time and their lengths in nanoseconds.
pub(super) const UNITS: [(&str, u64); 4] = [
    ("ns", 1),
    ("us", 1_000),
    ("ms", 1_000_000),
    ("s", 1_000_000_000),
];

/// Whether a name needs no quotes.
pub(super) fn is_plain(name: &str) -> bool {
    let mut bytes = name.bytes();
    bytes
        .next()
        .is_some_and(|b| b.is_ascii_alphabetic() || b == b'_')
        && bytes.all(|b| b.is_ascii_alphanumeric() || b == b'_')
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Token {
    Word(String),
    Quoted(String),
    /// A number as written, with any unit or exponent attached: `-7`, `0x1f`, `1.5e3`, `10ms`.
    Number(String),
    /// `-> .. { } [ ] ( ) : , = . @`
    Punct(&'static str),
    End,
}

impl Token {
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Word(text) | Self::Number(text) => format!("`{text}`"),
            Self::Quoted(text) => format!("\"{text}\""),
            Self::Punct(text) => format!("`{text}`"),
            Self::End => "the end of the text".to_owned(),
        }
    }
}

const PUNCTUATION: [&str; 13] = [
    "->", "..", "{", "}", "[", "]", "(", ")", ":", ",", "=", ".", "@",
];

/// Splits the text into tokens with their byte offsets; the last is `End`. Errors carry the offset
/// and what is wrong there.
pub(super) fn tokens(text: &str) -> Result<Vec<(usize, Token)>, (usize, String)> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let (length, token) = match c {
            ';' => (rest.find('\n').unwrap_or(rest.len()), None),
            c if c.is_whitespace() => (c.len_utf8(), None),
            '"' => quoted(rest)
                .map(|(n, s)| (n, Some(Token::Quoted(s))))
                .map_err(|m| (at, m))?,
            c if c.is_ascii_alphabetic() || c == '_' => {
                let length = run(rest, |b| b.is_ascii_alphanumeric() || b == b'_');
                (length, Some(Token::Word(rest[..length].to_owned())))
            }
            c if c.is_ascii_digit()
                || (c == '-' && rest[1..].starts_with(|c: char| c.is_ascii_digit())) =>
            {
                let length = number(rest);
                (length, Some(Token::Number(rest[..length].to_owned())))
            }
            _ => {
                let punct = PUNCTUATION.into_iter().find(|p| rest.starts_with(p));
                let punct = punct.ok_or_else(|| (at, format!("unexpected character {c:?}")))?;
                (punct.len(), Some(Token::Punct(punct)))
            }
        };
        tokens.extend(token.map(|token| (at, token)));
        at += length;
    }
    tokens.push((at, Token::End));
    Ok(tokens)
}

fn run(text: &str, accept: impl Fn(u8) -> bool) -> usize {
    text.bytes().position(|b| !accept(b)).unwrap_or(text.len())
}

/// Length of a number: digits and letters, one `.` followed by a digit, a sign behind `e`.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let hex = text.trim_start_matches('-').starts_with("0x");
    let mut end = 1;
    while let Some(&byte) = bytes.get(end) {
        let next_is_digit = bytes.get(end + 1).is_some_and(u8::is_ascii_digit);
        let sign = !hex && (byte == b'-' || byte == b'+') && matches!(bytes[end - 1], b'e' | b'E');
        let point = byte == b'.' && next_is_digit && !text[..end].contains('.');
        if !(byte.is_ascii_alphanumeric() || sign || point) {
            break;
        }
        end += 1;
    }
    end
}

fn quoted(text: &str) -> Result<(usize, String), String> {
    let mut out = String::new();
    let mut chars = text.char_indices().skip(1);
    while let Some((at, c)) = chars.next() {
        match c {
            '"' => return Ok((at + 1, out)),
            '\\' => match chars.next() {
                Some((_, c @ ('"' | '\\'))) => out.push(c),
                Some((_, 'u')) => out.push(escape(&mut chars)?),
                _ => return Err("unknown escape in a quoted name".to_owned()),
            },
            c => out.push(c),
        }
    }
    Err("quoted name without an end".to_owned())
}

fn escape(chars: &mut impl Iterator<Item = (usize, char)>) -> Result<char, String> {
    let digits: String = chars
        .map(|(_, c)| c)
        .skip_while(|&c| c == '{')
        .take_while(|&c| c != '}')
        .collect();
    let code = u32::from_str_radix(&digits, 16)
        .ok()
        .and_then(char::from_u32);
    code.ok_or_else(|| "unknown escape in a quoted name".to_owned())
}
