//! Results in the XML of JUnit, which CI servers read: a suite for each file, a case for each test.

use super::{Failure, TestProgram, TestResult};
use iecc_diag::render_text;
use iecc_source::{FileId, SourceMap};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::io;
use std::time::Duration;

/// The results of tests as a document.
pub fn junit(map: &SourceMap, program: &TestProgram, results: &[TestResult]) -> String {
    let mut writer = Writer::new_with_indent(Vec::new(), b' ', 2);
    write(&mut writer, map, program, results).expect("writing to memory");
    let mut text = String::from_utf8(writer.into_inner()).expect("made of strings");
    text.push('\n');
    text
}

type Out = Writer<Vec<u8>>;

fn write(
    writer: &mut Out,
    map: &SourceMap,
    program: &TestProgram,
    results: &[TestResult],
) -> io::Result<()> {
    writer.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let file_of = |result: &TestResult| program.tests()[result.position].file;
    let suites: Vec<&[TestResult]> = results.chunk_by(|a, b| file_of(a) == file_of(b)).collect();
    let counts = Counts::of(results);
    let element = writer
        .create_element("testsuites")
        .with_attribute(("name", "iecc"));
    counts.attributes(element).write_inner_content(|writer| {
        for suite in &suites {
            write_suite(writer, map, program, file_of(&suite[0]), suite)?;
        }
        Ok(())
    })?;
    Ok(())
}

fn write_suite(
    writer: &mut Out,
    map: &SourceMap,
    program: &TestProgram,
    file: FileId,
    results: &[TestResult],
) -> io::Result<()> {
    let name = printable(map.file(file).name());
    let element = writer
        .create_element("testsuite")
        .with_attribute(("name", name.as_str()));
    Counts::of(results)
        .attributes(element)
        .write_inner_content(|writer| {
            for result in results {
                write_case(writer, map, program, &name, result)?;
            }
            Ok(())
        })?;
    Ok(())
}

fn write_case(
    writer: &mut Out,
    map: &SourceMap,
    program: &TestProgram,
    class: &str,
    result: &TestResult,
) -> io::Result<()> {
    let title = printable(&program.tests()[result.position].title);
    let time = seconds(result.time);
    let element = writer.create_element("testcase").with_attributes([
        ("name", title.as_str()),
        ("classname", class),
        ("time", time.as_str()),
    ]);
    match &result.failure {
        None => element.write_empty()?,
        Some(failure) => {
            element.write_inner_content(|writer| write_failure(writer, map, failure))?
        }
    };
    Ok(())
}

/// An assertion that did not hold is a failure, a fault an error.
fn write_failure(writer: &mut Out, map: &SourceMap, failure: &Failure) -> io::Result<()> {
    let word = if failure.fault { "error" } else { "failure" };
    let diagnostic = &failure.diagnostic;
    let label = diagnostic.primary.as_ref().map(|label| label.text.as_str());
    let message = match label {
        Some(label) if !label.is_empty() => format!("{}: {label}", diagnostic.message),
        Some(_) | None => diagnostic.message.clone(),
    };
    let (message, text) = (
        printable(&message),
        printable(&render_text(map, diagnostic, false)),
    );
    let attributes = [
        ("message", message.as_str()),
        ("type", diagnostic.code.as_str()),
    ];
    writer
        .create_element(word)
        .with_attributes(attributes)
        .write_text_content(BytesText::new(&text))?;
    Ok(())
}

/// How many tests there are, and how long they took.
struct Counts {
    tests: usize,
    failures: usize,
    errors: usize,
    time: Duration,
}

impl Counts {
    fn of(results: &[TestResult]) -> Self {
        let failed = |fault: bool| {
            let failures = results.iter().filter_map(|result| result.failure.as_ref());
            failures.filter(|failure| failure.fault == fault).count()
        };
        Self {
            tests: results.len(),
            failures: failed(false),
            errors: failed(true),
            time: results.iter().map(|result| result.time).sum(),
        }
    }

    fn attributes<'w>(
        &self,
        element: quick_xml::writer::ElementWriter<'w, Vec<u8>>,
    ) -> quick_xml::writer::ElementWriter<'w, Vec<u8>> {
        let numbers = [
            ("tests", self.tests.to_string()),
            ("failures", self.failures.to_string()),
            ("errors", self.errors.to_string()),
            ("time", seconds(self.time)),
        ];
        element.with_attributes(numbers.iter().map(|(name, value)| (*name, value.as_str())))
    }
}

fn seconds(time: Duration) -> String {
    format!("{:.6}", time.as_secs_f64())
}

/// Without the characters that XML does not have.
fn printable(text: &str) -> String {
    let shown = |c: char| {
        let fits = matches!(c, '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'..);
        if fits { c } else { '\u{fffd}' }
    };
    text.chars().map(shown).collect()
}
