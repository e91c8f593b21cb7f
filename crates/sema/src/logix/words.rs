//! Numbers in messages: one thing and several are said as people say them.

/// `1 value`, `2 values`.
pub(crate) fn count_of(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        n => format!("{n} {what}s"),
    }
}

/// `1 is`, `2 are`.
pub(crate) fn are(count: usize) -> String {
    match count {
        1 => "1 is".to_owned(),
        n => format!("{n} are"),
    }
}
