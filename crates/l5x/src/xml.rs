//! An XML document as a tree of borrowed pieces that know where they stand.
//!
//! Well-formedness is checked completely enough that a cut-off or mangled file gives exactly one
//! message (E5001), and nesting is bounded (E5004). Nodes live in one vector, so dropping a
//! document does not recurse. Entities of the standard are decoded, others are errors; a DTD is
//! not read.

use crate::entities::{decode, entity};
use iecc_ast::Name;
use iecc_diag::{Code, Diagnostic};
use iecc_source::{FileId, MappedText, Span, Spanned};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// How deep elements may nest.
pub(crate) const MAX_DEPTH: usize = 128;

/// How many attributes one element may have. Exports have some seventy at most; the check for
/// doubled names takes quadratic time.
const MAX_ATTRIBUTES: usize = 1024;

/// A parsed document with one root element.
pub(crate) struct Document<'t> {
    file: FileId,
    nodes: Vec<Node<'t>>,
    attributes: Vec<Attribute<'t>>,
    root: usize,
}

struct Node<'t> {
    kind: Kind<'t>,
    next_sibling: Option<u32>,
}

enum Kind<'t> {
    Element(ElementNode<'t>),
    /// Character data as it stands.
    Text {
        text: &'t str,
        start: u32,
        cdata: bool,
    },
    Entity {
        value: char,
        start: u32,
        end: u32,
    },
}

struct ElementNode<'t> {
    name: &'t str,
    start: u32,
    /// End of the start tag.
    tag_end: u32,
    end: u32,
    first_attribute: u32,
    attribute_count: u32,
    first_child: Option<u32>,
}

struct Attribute<'t> {
    name: &'t str,
    /// Between the quotes, entities not decoded.
    raw: &'t str,
    start: u32,
}

impl<'t> Document<'t> {
    /// Parses a text, which may begin with a byte order mark.
    pub(crate) fn parse(file: FileId, text: &'t str) -> Result<Self, Box<Diagnostic>> {
        let document = Self {
            file,
            nodes: Vec::new(),
            attributes: Vec::new(),
            root: 0,
        };
        let body = text.strip_prefix('\u{feff}').unwrap_or(text);
        let reader = Reader::from_str(body);
        Parser {
            text,
            body,
            reader,
            document,
            open: Vec::new(),
            last: None,
            has_root: false,
        }
        .run()
    }

    /// The root element.
    pub(crate) fn root(&self) -> Element<'_> {
        Element {
            document: self,
            index: self.root,
        }
    }
}

/// An element of a document.
#[derive(Clone, Copy)]
pub(crate) struct Element<'d> {
    document: &'d Document<'d>,
    index: usize,
}

impl<'d> Element<'d> {
    fn node(self) -> &'d ElementNode<'d> {
        match &self.document.nodes[self.index].kind {
            Kind::Element(node) => node,
            Kind::Text { .. } | Kind::Entity { .. } => unreachable!("elements index element nodes"),
        }
    }

    /// The tag name.
    pub(crate) fn name(self) -> &'d str {
        self.node().name
    }

    /// From `<` of the start tag to `>` of the end tag.
    pub(crate) fn span(self) -> Span {
        Span::new(self.document.file, self.node().start, self.node().end)
    }

    /// The start tag.
    pub(crate) fn tag_span(self) -> Span {
        Span::new(self.document.file, self.node().start, self.node().tag_end)
    }

    /// All attributes in file order, decoded.
    pub(crate) fn attributes(self) -> impl Iterator<Item = (&'d str, Name)> + use<'d> {
        let node = self.node();
        let first = node.first_attribute as usize;
        let list = &self.document.attributes[first..first + node.attribute_count as usize];
        list.iter()
            .map(move |attribute| (attribute.name, attribute.value(self.document.file)))
    }

    /// The decoded value of an attribute.
    pub(crate) fn attribute(self, name: &str) -> Option<Name> {
        let node = self.node();
        let first = node.first_attribute as usize;
        let list = &self.document.attributes[first..first + node.attribute_count as usize];
        let found = list.iter().find(|attribute| attribute.name == name)?;
        Some(found.value(self.document.file))
    }

    fn child_nodes(self) -> impl Iterator<Item = (usize, &'d Node<'d>)> + use<'d> {
        let nodes = &self.document.nodes;
        let mut next = self.node().first_child;
        std::iter::from_fn(move || {
            let index = next? as usize;
            next = nodes[index].next_sibling;
            Some((index, &nodes[index]))
        })
    }

    /// Child elements in file order.
    pub(crate) fn children(self) -> impl Iterator<Item = Element<'d>> + use<'d> {
        let document = self.document;
        self.child_nodes()
            .filter_map(move |(index, node)| match node.kind {
                Kind::Element(_) => Some(Element { document, index }),
                Kind::Text { .. } | Kind::Entity { .. } => None,
            })
    }

    /// Child elements with a name.
    pub(crate) fn children_named(
        self,
        name: &'static str,
    ) -> impl Iterator<Item = Element<'d>> + use<'d> {
        self.children().filter(move |child| child.name() == name)
    }

    /// The first child element with a name.
    pub(crate) fn child(self, name: &'static str) -> Option<Element<'d>> {
        self.children_named(name).next()
    }

    /// The text directly inside. Where there is CDATA, blank text around it is layout of the XML
    /// and left out.
    pub(crate) fn text(self) -> MappedText {
        let node = self.node();
        let content = Span::new(self.document.file, node.tag_end, node.end.max(node.tag_end));
        let mut text = MappedText::empty(content);
        let only_cdata = self.has_cdata_in_blank();
        for (_, node) in self.child_nodes() {
            match node.kind {
                Kind::Text { cdata: false, .. } if only_cdata => {}
                Kind::Text {
                    text: piece, start, ..
                } => text.push_verbatim(piece, start),
                Kind::Entity { value, start, end } => {
                    text.push_decoded(value.encode_utf8(&mut [0; 4]), start..end);
                }
                Kind::Element(_) => {}
            }
        }
        text
    }

    fn has_cdata_in_blank(self) -> bool {
        let mut cdata_found = false;
        for (_, node) in self.child_nodes() {
            match node.kind {
                Kind::Text { cdata: true, .. } => cdata_found = true,
                Kind::Text {
                    text, cdata: false, ..
                } if text.trim().is_empty() => {}
                Kind::Text { .. } | Kind::Entity { .. } => return false,
                Kind::Element(_) => {}
            }
        }
        cdata_found
    }
}

impl Attribute<'_> {
    fn value(&self, file: FileId) -> Name {
        let span = Span::new(file, self.start, self.start + self.raw.len() as u32);
        let value = decode(self.raw).expect("attribute entities were checked by the parser");
        Spanned::new(value, span)
    }
}

struct Parser<'t> {
    /// The whole file, which positions count in.
    text: &'t str,
    /// The file behind its byte order mark.
    body: &'t str,
    reader: Reader<&'t [u8]>,
    document: Document<'t>,
    /// Indexes of the open elements, outermost first.
    open: Vec<usize>,
    /// The last node closed or added at the innermost open level.
    last: Option<usize>,
    has_root: bool,
}

type Step = Result<(), Box<Diagnostic>>;

impl<'t> Parser<'t> {
    fn run(mut self) -> Result<Document<'t>, Box<Diagnostic>> {
        // Start and end tags are matched here, where both places are known.
        self.reader.config_mut().check_end_names = false;
        self.reader.config_mut().allow_unmatched_ends = true;
        loop {
            let start = self.position();
            match self.reader.read_event() {
                Ok(Event::Eof) => break,
                Ok(event) => self.event(event, start)?,
                Err(error) => return Err(self.syntax_error(&error)),
            }
        }
        self.at_end()?;
        Ok(self.document)
    }

    fn event(&mut self, event: Event<'t>, start: u32) -> Step {
        let end = self.position();
        match event {
            Event::Start(tag) => self.start(&tag, start, end),
            Event::Empty(tag) => {
                self.start(&tag, start, end)?;
                self.close(end);
                Ok(())
            }
            Event::End(tag) => self.end(tag.name().as_ref(), start, end),
            Event::Text(_) => self.character_data(start, end, false),
            // `<![CDATA[` and `]]>`
            Event::CData(_) => self.character_data(start + 9, end - 3, true),
            Event::GeneralRef(_) => self.entity(start, end),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => Ok(()),
            Event::Eof => unreachable!("handled by the caller"),
        }
    }

    /// Offset in the file of what the reader reads next.
    fn position(&self) -> u32 {
        let read = usize::try_from(self.reader.buffer_position()).unwrap_or(self.body.len());
        (self.text.len() - self.body.len() + read.min(self.body.len())) as u32
    }

    fn span(&self, start: u32, end: u32) -> Span {
        Span::new(self.document.file, start, end)
    }

    fn malformed(&self, span: Span, message: impl Into<String>) -> Box<Diagnostic> {
        Box::new(Diagnostic::new(Code::E5001, span, message))
    }

    fn start(&mut self, tag: &BytesStart<'_>, start: u32, end: u32) -> Step {
        if self.open.is_empty() && self.has_root {
            let span = self.span(start, end);
            return Err(self.malformed(span, "a second root element begins here"));
        }
        if self.open.len() >= MAX_DEPTH {
            let message = format!("elements nest deeper than {MAX_DEPTH} levels");
            return Err(Box::new(Diagnostic::new(
                Code::E5004,
                self.span(start, end),
                message,
            )));
        }
        let first_attribute = self.document.attributes.len() as u32;
        self.attributes(tag, start, end)?;
        let attribute_count = self.document.attributes.len() as u32 - first_attribute;
        let name_length = tag.name().as_ref().len();
        let element = ElementNode {
            name: &self.text[start as usize + 1..start as usize + 1 + name_length],
            start,
            tag_end: end,
            end,
            first_attribute,
            attribute_count,
            first_child: None,
        };
        if element.name.is_empty() {
            return Err(self.malformed(self.span(start, end), "a tag has no name"));
        }
        let index = self.add(Kind::Element(element));
        if self.open.is_empty() {
            (self.document.root, self.has_root) = (index, true);
        }
        self.open.push(index);
        self.last = None;
        Ok(())
    }

    fn attributes(&mut self, tag: &BytesStart<'_>, start: u32, end: u32) -> Step {
        // Offsets of slices of the tag, whose text begins behind `<`.
        let base = tag.as_ptr() as usize;
        let offset = |part: &str| start as usize + 1 + (part.as_ptr() as usize - base);
        for (count, attribute) in tag.attributes().enumerate() {
            if count >= MAX_ATTRIBUTES {
                let message = format!("an element has more than {MAX_ATTRIBUTES} attributes");
                return Err(self.malformed(self.span(start, end), message));
            }
            let attribute = match attribute {
                Ok(attribute) => attribute,
                Err(error) => {
                    let message = format!("attribute is malformed: {error}");
                    return Err(self.malformed(self.span(start, end), message));
                }
            };
            let std::borrow::Cow::Borrowed(value) = attribute.value else {
                unreachable!("attributes of borrowed text are borrowed")
            };
            let (name_at, value_at) = (offset(attribute.key.as_ref()), offset(value));
            let value = &self.text[value_at..value_at + value.len()];
            if let Err(bad) = decode(value) {
                let at = (value_at + bad.start) as u32;
                return Err(self.unknown_entity(at, (value_at + bad.end) as u32));
            }
            let name = &self.text[name_at..name_at + attribute.key.as_ref().len()];
            let attribute = Attribute {
                name,
                raw: value,
                start: value_at as u32,
            };
            self.document.attributes.push(attribute);
        }
        Ok(())
    }

    fn end(&mut self, name: &str, start: u32, end: u32) -> Step {
        let span = self.span(start, end);
        let Some(&open) = self.open.last() else {
            return Err(self.malformed(span, format!("`</{name}>` closes nothing")));
        };
        let opened = Element {
            document: &self.document,
            index: open,
        };
        if opened.name() != name.trim_end() {
            let message = format!("found `</{name}>`, expected `</{}>`", opened.name());
            let diagnostic = Diagnostic::new(Code::E5001, span, message)
                .also(opened.tag_span(), "this element is still open");
            return Err(Box::new(diagnostic));
        }
        self.close(end);
        Ok(())
    }

    fn close(&mut self, end: u32) {
        let index = self.open.pop().expect("an element is open");
        if let Kind::Element(element) = &mut self.document.nodes[index].kind {
            element.end = end;
        }
        self.last = Some(index);
    }

    fn character_data(&mut self, start: u32, end: u32, cdata: bool) -> Step {
        let text = &self.text[start as usize..end as usize];
        if self.open.is_empty() {
            return self.outside(text, start, cdata);
        }
        if !text.is_empty() {
            self.last = Some(self.add(Kind::Text { text, start, cdata }));
        }
        Ok(())
    }

    /// Around the root element only white space may stand.
    fn outside(&mut self, text: &str, start: u32, cdata: bool) -> Step {
        let blank = text.len() - text.trim_start().len();
        if blank == text.len() && !cdata {
            return Ok(());
        }
        let at = start + blank as u32;
        let span = self.span(at, start + text.trim_end().len().max(blank) as u32);
        if self.has_root {
            return Err(self.malformed(span, "text behind the end of the document"));
        }
        let message = "this is not XML: an L5X export begins with `<?xml` or `<RSLogix5000Content`";
        let span = Span::new(span.file, at, at + first_line_length(&text[blank..]));
        Err(Box::new(Diagnostic::new(Code::E5002, span, message)))
    }

    fn entity(&mut self, start: u32, end: u32) -> Step {
        let name = &self.text[start as usize + 1..end as usize - 1];
        let Some(value) = entity(name) else {
            return Err(self.unknown_entity(start, end));
        };
        if self.open.is_empty() {
            return Err(self.malformed(self.span(start, end), "text outside the root element"));
        }
        self.last = Some(self.add(Kind::Entity { value, start, end }));
        Ok(())
    }

    fn unknown_entity(&self, start: u32, end: u32) -> Box<Diagnostic> {
        let text = &self.text[start as usize..end as usize];
        let diagnostic = self.malformed(self.span(start, end), format!("unknown entity `{text}`"));
        Box::new(diagnostic.note("a literal `&` is written `&amp;`"))
    }

    fn add(&mut self, kind: Kind<'t>) -> usize {
        let index = self.document.nodes.len();
        self.document.nodes.push(Node {
            kind,
            next_sibling: None,
        });
        if let Some(last) = self.last {
            self.document.nodes[last].next_sibling = Some(index as u32);
        } else if let Some(&parent) = self.open.last()
            && let Kind::Element(parent) = &mut self.document.nodes[parent].kind
        {
            parent.first_child = Some(index as u32);
        }
        index
    }

    fn syntax_error(&self, error: &quick_xml::Error) -> Box<Diagnostic> {
        let bom = self.text.len() - self.body.len();
        let read = usize::try_from(self.reader.error_position()).unwrap_or(self.body.len());
        let mut at = (bom + read).min(self.text.len());
        while !self.text.is_char_boundary(at) {
            at -= 1;
        }
        let end = at as u32 + first_line_length(&self.text[at..]);
        self.malformed(self.span(at as u32, end), error.to_string())
    }

    fn at_end(&self) -> Step {
        let end = self.text.len() as u32;
        let span = self.span(end, end);
        if let Some(&open) = self.open.last() {
            let opened = Element {
                document: &self.document,
                index: open,
            };
            let message = format!("the file ends before `</{}>`", opened.name());
            let diagnostic = Diagnostic::new(Code::E5001, span, message)
                .also(opened.tag_span(), "this element is still open")
                .note("the file seems to be cut off");
            return Err(Box::new(diagnostic));
        }
        if self.has_root {
            return Ok(());
        }
        let message = "the file holds no XML element, expected `<RSLogix5000Content>`";
        Err(Box::new(Diagnostic::new(Code::E5002, span, message)))
    }
}

/// Bytes up to the line end, at most some tens, for a label.
fn first_line_length(text: &str) -> u32 {
    let line = text.split(['\r', '\n']).next().unwrap_or("");
    line.char_indices().nth(60).map_or(line.len(), |(at, _)| at) as u32
}

#[cfg(test)]
mod tests;
