//! Diagnostics as text for people and as JSON lines for tools.

use crate::excerpt::Excerpt;
use crate::{Diagnostic, Label, Severity};
use codespan_reporting::diagnostic as cs;
use codespan_reporting::term;
use codespan_reporting::term::termcolor::{Buffer, NoColor};
use iecc_source::{FileId, SourceMap, Span};
use serde_json::{Value, json};

/// Renders one diagnostic with its source lines, as a terminal without colours shows it; with
/// `colour` the ANSI codes are included.
pub fn render_text(map: &SourceMap, diagnostic: &Diagnostic, colour: bool) -> String {
    let config = term::Config {
        tab_width: 4,
        ..term::Config::default()
    };
    let files = Excerpt::new(map, diagnostic);
    let message = to_codespan(&files, diagnostic);
    let bytes = if colour {
        let mut buffer = Buffer::ansi();
        term::emit_to_write_style(&mut buffer, &config, &files, &message)
            .expect("writing to memory");
        buffer.into_inner()
    } else {
        let mut buffer = NoColor::new(Vec::new());
        term::emit_to_write_style(&mut buffer, &config, &files, &message)
            .expect("writing to memory");
        buffer.into_inner()
    };
    String::from_utf8_lossy(&bytes).into_owned()
}

fn to_codespan(files: &Excerpt<'_>, diagnostic: &Diagnostic) -> cs::Diagnostic<FileId> {
    let severity = match diagnostic.severity {
        Severity::Warning => cs::Severity::Warning,
        Severity::Error => cs::Severity::Error,
    };
    let primary = diagnostic
        .primary
        .iter()
        .map(|l| label(files, cs::LabelStyle::Primary, l));
    let secondary = diagnostic
        .secondary
        .iter()
        .map(|l| label(files, cs::LabelStyle::Secondary, l));
    let fix = diagnostic
        .fix
        .iter()
        .map(|fix| format!("help: {}", fix.title));
    cs::Diagnostic::new(severity)
        .with_code(diagnostic.code.as_str())
        .with_message(&diagnostic.message)
        .with_labels(primary.chain(secondary).collect())
        .with_notes(diagnostic.notes.iter().cloned().chain(fix).collect())
}

fn label(files: &Excerpt<'_>, style: cs::LabelStyle, label: &Label) -> cs::Label<FileId> {
    cs::Label::new(style, label.span.file, files.shown(label.span)).with_message(&label.text)
}

/// Renders one diagnostic as one line of JSON, without the newline. Keys: `code severity message
/// file line column end_line end_column labels notes fix`; places are 1-based; `file` and the
/// numbers are `null` when the diagnostic has no place.
pub fn render_json(map: &SourceMap, diagnostic: &Diagnostic) -> String {
    let mut object = json!({
        "code": diagnostic.code.as_str(),
        "severity": diagnostic.severity.as_str(),
        "message": diagnostic.message,
        "notes": diagnostic.notes,
    });
    let place = place(map, diagnostic.primary.as_ref().map(|label| label.span));
    let labels: Vec<Value> = diagnostic
        .primary
        .iter()
        .filter(|label| !label.text.is_empty())
        .chain(&diagnostic.secondary)
        .map(|label| with_text(self::place(map, Some(label.span)), "text", &label.text))
        .collect();
    let fix = diagnostic.fix.as_ref().map(|fix| {
        let value = with_text(self::place(map, Some(fix.span)), "title", &fix.title);
        with_text(value, "replacement", &fix.replacement)
    });
    merge(&mut object, place);
    object["labels"] = Value::Array(labels);
    object["fix"] = fix.unwrap_or(Value::Null);
    object.to_string()
}

fn place(map: &SourceMap, span: Option<Span>) -> Value {
    let Some(span) = span else {
        return json!({ "file": null, "line": null, "column": null, "end_line": null, "end_column": null });
    };
    let (start, end) = (map.start(span), map.end(span));
    json!({
        "file": map.file(span.file).name(),
        "line": start.line,
        "column": start.column,
        "end_line": end.line,
        "end_column": end.column,
    })
}

fn with_text(mut object: Value, key: &str, text: &str) -> Value {
    object[key] = Value::from(text);
    object
}

fn merge(object: &mut Value, other: Value) {
    if let (Value::Object(to), Value::Object(from)) = (object, other) {
        to.extend(from);
    }
}
