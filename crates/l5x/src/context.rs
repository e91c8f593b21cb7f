//! Attributes as values, and the messages when they are not.

use crate::xml::Element;
use iecc_ast::Name;
use iecc_ast::logix::{Description, Use};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{MappedText, Span};

/// Reads typed attributes and collects messages.
pub(crate) struct Context<'a> {
    pub(crate) diagnostics: &'a mut Diagnostics,
}

impl Context<'_> {
    pub(crate) fn report(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.diagnostics.push(Diagnostic::new(code, span, message));
    }

    /// An attribute without which the element means nothing.
    pub(crate) fn required(&mut self, element: Element<'_>, attribute: &str) -> Option<Name> {
        let found = element.attribute(attribute);
        if found.is_none() {
            let message = format!("`<{}>` has no attribute `{attribute}`", element.name());
            self.report(Code::E5006, element.tag_span(), message);
        }
        found
    }

    /// Says that an attribute has a value nobody knows.
    pub(crate) fn malformed(&mut self, attribute: &str, value: &Name, expected: &str) {
        let message = format!("`{attribute}` is `{}`, expected {expected}", value.node);
        self.report(Code::E5006, value.span, message);
    }

    /// `true` or `false`, also `1` or `0`; false when absent.
    pub(crate) fn boolean(&mut self, element: Element<'_>, attribute: &str) -> bool {
        let Some(value) = element.attribute(attribute) else {
            return false;
        };
        match value.node.to_ascii_lowercase().as_str() {
            "true" | "1" => true,
            "false" | "0" | "" => false,
            _ => {
                self.malformed(attribute, &value, "`true` or `false`");
                false
            }
        }
    }

    /// A number without sign.
    pub(crate) fn number(&mut self, element: Element<'_>, attribute: &str) -> Option<u32> {
        let value = element.attribute(attribute)?;
        let number = value.node.trim().parse().ok();
        if number.is_none() {
            self.malformed(attribute, &value, "a number");
        }
        number
    }

    /// Array lengths, separated by blanks or commas; none for a scalar, whose length is left out
    /// or 0.
    pub(crate) fn dimensions(&mut self, element: Element<'_>, attribute: &str) -> Vec<u32> {
        let Some(value) = element.attribute(attribute) else {
            return Vec::new();
        };
        let parts = value.node.split([' ', ',']).filter(|part| !part.is_empty());
        match parts.map(str::parse).collect::<Result<Vec<u32>, _>>() {
            Ok(lengths) if lengths == [0] => Vec::new(),
            Ok(lengths) => lengths,
            Err(_) => {
                self.malformed(attribute, &value, "array lengths");
                Vec::new()
            }
        }
    }

    /// The role in a partial export.
    pub(crate) fn role(&mut self, element: Element<'_>) -> Option<Use> {
        let value = element.attribute("Use")?;
        match value.node.as_str() {
            "Target" => Some(Use::Target),
            "Context" | "Reference" => Some(Use::Context),
            _ => {
                self.malformed("Use", &value, "`Target` or `Context`");
                None
            }
        }
    }

    /// Whether the element is safety-rated.
    pub(crate) fn safety(&mut self, element: Element<'_>) -> bool {
        let Some(class) = element.attribute("Class") else {
            return false;
        };
        match class.node.as_str() {
            "Safety" => true,
            "Standard" => false,
            _ => {
                self.malformed("Class", &class, "`Standard` or `Safety`");
                false
            }
        }
    }
}

/// The text of an element, or of its first language.
pub(crate) fn localized_text(element: Element<'_>) -> MappedText {
    let localized = element
        .children()
        .find(|child| child.name().starts_with("Localized"));
    localized.unwrap_or(element).text().trimmed()
}

/// The description or comment in a child element.
pub(crate) fn description(element: Element<'_>, child: &'static str) -> Description {
    element.child(child).map(localized_text)
}
