//! Documents that the parser accepts or refuses, and places in them.

use super::*;

fn parse(text: &str) -> Result<Document<'_>, Box<Diagnostic>> {
    Document::parse(FileId::from_index(0), text)
}

/// The message for a text with what stands under its place.
fn message(text: &str) -> (Code, String, &str) {
    let Err(error) = parse(text) else {
        panic!("{text} is accepted")
    };
    let span = error.primary.as_ref().unwrap().span;
    (error.code, error.message, &text[span.range()])
}

#[test]
fn values_and_texts_know_their_place_behind_a_byte_order_mark() {
    let text = "\u{feff}<a x='1 &lt; 2' y=\"\">\r\n<![CDATA[b & c]]>\n</a>";
    let document = parse(text).unwrap();
    let root = document.root();
    let x = root.attribute("x").unwrap();
    assert_eq!(
        (x.node.as_str(), &text[x.span.range()]),
        ("1 < 2", "1 &lt; 2")
    );
    let y = root.attribute("y").unwrap();
    assert_eq!(
        y.span.range(),
        text.find("\">").unwrap()..text.find("\">").unwrap()
    );
    let content = root.text();
    assert_eq!(
        content.text(),
        "b & c",
        "white space around CDATA is layout"
    );
    assert_eq!(&text[content.span(2..3).range()], "&");
    assert_eq!(&text[root.span().range()], &text[3..]);
}

#[test]
fn text_with_entities_maps_to_the_file() {
    let text = "<a>XIC(&#x61;)&amp;&amp;b</a>";
    let document = parse(text).unwrap();
    let content = document.root().text();
    assert_eq!(content.text(), "XIC(a)&&b");
    assert_eq!(&text[content.span(4..5).range()], "&#x61;");
    assert_eq!(&text[content.span(7..9).range()], "&amp;b");
}

#[test]
fn children_are_found_in_order() {
    let document =
        parse("<?xml version='1.0'?><!-- c --><a>t<b/><c i='1'><b/></c><c/></a>\n").unwrap();
    let names: Vec<_> = document.root().children().map(Element::name).collect();
    assert_eq!(names, ["b", "c", "c"]);
    let first = document.root().child("c").unwrap();
    assert_eq!(
        first.attributes().map(|(name, _)| name).collect::<Vec<_>>(),
        ["i"]
    );
    assert!(first.child("b").is_some());
}

#[test]
fn each_malformed_document_gives_one_message_at_its_place() {
    let e5001 = |message: &str, under| (Code::E5001, message.to_owned(), under);
    assert_eq!(
        message("<a><b></a>"),
        e5001("found `</a>`, expected `</b>`", "</a>")
    );
    assert_eq!(message("<a><b>"), e5001("the file ends before `</b>`", ""));
    assert_eq!(
        message("<a>x&foo;</a>"),
        e5001("unknown entity `&foo;`", "&foo;")
    );
    assert_eq!(message("<a b='&x'/>"), e5001("unknown entity `&`", "&"));
    assert_eq!(
        message("<a/><b/>"),
        e5001("a second root element begins here", "<b/>")
    );
    assert_eq!(
        message("<a/>text"),
        e5001("text behind the end of the document", "text")
    );
    assert_eq!(message("</a>"), e5001("`</a>` closes nothing", "</a>"));
    assert_eq!(message("<a b=1/>").0, Code::E5001);
    assert_eq!(message("<a b='1' b='2'/>").0, Code::E5001);
    assert_eq!(message("<a><![CDATA[open").0, Code::E5001);
    assert_eq!(message("<a b='open").0, Code::E5001);
    assert_eq!(message("<>").0, Code::E5001);
}

#[test]
fn what_is_no_xml_at_all_is_no_l5x() {
    assert_eq!(message("hello\nworld").0, Code::E5002);
    assert_eq!(message("hello\nworld").2, "hello");
    assert_eq!(message("").0, Code::E5002);
    assert_eq!(message("\u{feff}  \n").0, Code::E5002);
}

#[test]
fn the_number_of_attributes_is_bounded() {
    let attributes = |n: usize| (0..n).map(|i| format!(" a{i}=''")).collect::<String>();
    let element = |n: usize| format!("<a{}/>", attributes(n));
    assert!(parse(&element(MAX_ATTRIBUTES)).is_ok());
    assert_eq!(message(&element(MAX_ATTRIBUTES + 1)).0, Code::E5001);
}

#[test]
fn nesting_is_bounded() {
    let nested = |n: usize| format!("{}{}", "<a>".repeat(n), "</a>".repeat(n));
    assert!(parse(&nested(MAX_DEPTH)).is_ok());
    assert_eq!(message(&nested(MAX_DEPTH + 1)).0, Code::E5004);
    assert_eq!(message(&"<a>".repeat(100_000)).0, Code::E5004);
}
