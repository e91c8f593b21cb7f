//! Pragmas. `{attribute 'name'}` of CODESYS is heeded where it changes what a program means,
//! passed over where it is about tools alone, and refused where its meaning is not compiled. What nobody
//! knows gives a warning.

use crate::st::analysis::Analysis;
use crate::st::signature::UnitId;
use iecc_ast::st::{Pragma, TypeDecl};
use iecc_diag::{Code, Diagnostic};
use iecc_source::{Span, TextRange};

/// Attributes that are heeded: lists and enumerations that are named with their values,
/// enumerations that are no numbers, structures whose size is not told.
pub(crate) const QUALIFIED_ONLY: &str = "qualified_only";
/// See [`QUALIFIED_ONLY`].
pub(crate) const STRICT: &str = "strict";
/// See [`QUALIFIED_ONLY`].
pub(crate) const PACK_MODE: &str = "pack_mode";

/// Attributes that change what happens at run time, and why they are refused.
const REFUSED: [(&str, &str); 12] = [
    (
        "call_after_init",
        "methods are not called before the first scan",
    ),
    (
        "call_after_global_init_slot",
        "functions are not called before the first scan",
    ),
    ("call_after_online_change_slot", "there is no online change"),
    ("call_on_type_change", "there is no online change"),
    (
        "global_init_slot",
        "global variables have no order of initialisation",
    ),
    ("init_on_onlchange", "there is no online change"),
    (
        "initialize_on_call",
        "inputs keep their values from call to call",
    ),
    (
        "instance-path",
        "strings do not get the path of their instance",
    ),
    (
        "no_virtual_actions",
        "actions of derived blocks override those of the base",
    ),
    (
        "is_connected",
        "a block does not know what it is called with",
    ),
    (
        "io_function_block",
        "blocks are not run by the I/O configuration",
    ),
    ("enable_dynamic_creation", "nothing is created at run time"),
];

/// Attributes about tools: symbols, views, checks, links. They mean nothing to the program.
const HARMLESS: [&str; 43] = [
    "analysis",
    "analysis:report-multiple-instance-calls",
    "conditionalshow",
    "const_non_replaced",
    "const_replaced",
    "dataflow",
    "displaymode",
    "estimated-stack-usage",
    "expandfully",
    "externalvisibility",
    "global_init_on_online_change",
    "hide",
    "hide_all_locals",
    "is_global",
    "linkalways",
    "mirroring",
    "monitoring",
    "monitoring_encoding",
    "monitoring_instead",
    "no-exit",
    "no_assign",
    "no_assign_warning",
    "no_check",
    "no_copy",
    "no_init",
    "no_instance_in_retain",
    "no_explicit_call",
    "noflow",
    "obsolete",
    "opaque",
    "parameter",
    "parameterstringof",
    "pin_presentation_order_inputs",
    "pin_presentation_order_outputs",
    "pingroup",
    "processvalue",
    // It lets 'instance-path' work, which is refused.
    "reflection",
    "subsequent",
    "symbol",
    "to_string",
    "tooltip",
    "warning disable",
    "wording",
];

/// Words with which pragmas about tools begin.
const HARMLESS_WORDS: [&str; 12] = [
    "region",
    "endregion",
    "info",
    "text",
    "warning",
    "analysis",
    "flow",
    "noflow",
    "library_public",
    "not_bp",
    "nobp",
    "nonpersistent",
];

/// Words of compilation under a condition. Those that follow IF get no message of their own.
const CONDITIONAL: [&str; 3] = ["if", "define", "undefine"];
const CONDITIONAL_REST: [&str; 3] = ["elsif", "else", "end_if"];

/// The name of an attribute.
fn attribute(pragma: &Pragma) -> Option<&str> {
    let rest = behind_word(&pragma.text, "attribute")?.strip_prefix('\'')?;
    rest.split_once('\'').map(|(name, _)| name.trim())
}

/// What stands behind a word with which a text begins.
fn behind_word<'t>(text: &'t str, word: &str) -> Option<&'t str> {
    let text = text.trim_start();
    let (first, rest) = text.split_at_checked(word.len())?;
    let ends = !rest.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
    (ends && first.eq_ignore_ascii_case(word)).then(|| rest.trim_start())
}

fn first_word(text: &str) -> &str {
    let text = text.trim_start();
    let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    &text[..end.unwrap_or(text.len())]
}

impl Analysis<'_> {
    /// Whether what begins at a place of a unit has an attribute. Pragmas before it belong to it, back
    /// to the end of the type before.
    pub(crate) fn has_attribute(&self, unit: UnitId, start: u32, name: &str) -> bool {
        if !self.options.codesys || self.is_library(unit) {
            return false;
        }
        let unit = self.unit(unit);
        let ends = unit.arena.all::<TypeDecl>().iter();
        let ends = ends.map(|decl| decl.range.end).filter(|end| *end <= start);
        let from = ends.max().unwrap_or(0);
        let mut before = unit
            .pragmas
            .iter()
            .filter(|pragma| from <= pragma.range.start && pragma.range.end <= start);
        before.any(|pragma| attribute(pragma).is_some_and(|own| own.eq_ignore_ascii_case(name)))
    }

    /// Looks at the pragmas of every unit of the user.
    pub(crate) fn check_pragmas(&mut self) {
        for index in self.first_user_unit..self.units.len() as u32 {
            let unit = self.unit(UnitId(index));
            for pragma in &unit.pragmas {
                self.check_pragma(UnitId(index), pragma);
            }
        }
    }

    fn check_pragma(&mut self, unit: UnitId, pragma: &Pragma) {
        let span = self.span(unit, pragma.range);
        if let Some(rest) = behind_word(&pragma.text, "iecc") {
            let key = first_word(rest.trim_start_matches(':'));
            self.meaningless(span, format!("iecc has no pragma `{key}`"));
        } else if let Some(name) = attribute(pragma) {
            self.check_attribute(unit, pragma.range, name);
        } else if self.options.codesys {
            self.check_word(span, &pragma.text);
        }
    }

    fn check_attribute(&mut self, unit: UnitId, range: TextRange, name: &str) {
        let span = self.span(unit, range);
        if !self.options.codesys {
            self.foreign(unit, range, "an attribute pragma");
            return;
        }
        let same = |known: &str| known.eq_ignore_ascii_case(name);
        if let Some((_, why)) = REFUSED.iter().find(|(known, _)| same(known)) {
            let message = format!("attribute '{name}' is not compiled: {why}");
            self.error(Code::E8002, span, message);
            return;
        }
        let heeded = [QUALIFIED_ONLY, STRICT, PACK_MODE];
        let about_tools = name.starts_with("Tc") || name.starts_with("OPC.");
        let known = HARMLESS.iter().chain(&heeded).any(|known| same(known));
        if !known && !about_tools {
            self.meaningless(span, format!("nothing is known of attribute '{name}'"));
        }
    }

    fn check_word(&mut self, span: Span, text: &str) {
        let word = first_word(text);
        let is = |known: &&str| known.eq_ignore_ascii_case(word);
        if CONDITIONAL.iter().any(&is) {
            let message = "what is compiled under a condition is not compiled here";
            let note = "keep the text that counts, and take the other out";
            self.report(Diagnostic::new(Code::E8002, span, message).note(note));
        } else if word.eq_ignore_ascii_case("error") {
            let message = format!("the source reports an error: {}", text.trim());
            self.error(Code::E8002, span, message);
        } else if !HARMLESS_WORDS.iter().chain(&CONDITIONAL_REST).any(is) {
            self.meaningless(span, format!("nothing is known of pragma `{word}`"));
        }
    }

    fn meaningless(&mut self, span: Span, message: String) {
        let note = "it is passed over; the program means the same without it";
        self.warn(Diagnostic::new(Code::E8003, span, message).note(note));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(text: &str) -> Option<String> {
        let pragma = Pragma {
            text: text.into(),
            range: TextRange::default(),
        };
        attribute(&pragma).map(str::to_owned)
    }

    #[test]
    fn attributes_have_a_name_in_quotes() {
        assert_eq!(name("attribute 'strict'").as_deref(), Some("strict"));
        assert_eq!(name(" ATTRIBUTE 'a' := 'b' ").as_deref(), Some("a"));
        assert_eq!(name("attributes 'a'"), None);
        assert_eq!(name("attribute strict"), None);
        assert_eq!(name("attribute 'strict"), None);
    }

    #[test]
    fn words_end_where_letters_end() {
        assert_eq!(behind_word(" iecc: x", "iecc"), Some(": x"));
        assert_eq!(behind_word("ieccx: y", "iecc"), None);
        assert_eq!(behind_word("ß", "iecc"), None);
        assert_eq!(first_word(" warning 'x'"), "warning");
        assert_eq!(first_word(""), "");
    }
}
