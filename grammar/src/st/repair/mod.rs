//! placeholder
use super::build::SyntaxError;
use super::feed::{Feed, Located};
use super::lexer::Tokens;
use super::token::Kind;
use iecc_diag::Diagnostics;
pub(crate) struct Repaired {
    pub(crate) tokens: Vec<Located>,
}
impl Repaired {
    pub(crate) fn is_known(&self, _e: &SyntaxError, _f: &Feed) -> bool {
        false
    }
}
pub(crate) fn repair(_t: &Tokens<'_>, _o: Kind, feed: &Feed, _d: &mut Diagnostics) -> Repaired {
    Repaired {
        tokens: feed.tokens.clone(),
    }
}
