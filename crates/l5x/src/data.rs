//! Tag values: `Decorated` trees, hex images, L5K lists, strings and attribute lists.

use crate::context::Context;
use crate::l5k;
use crate::xml::Element;
use iecc_ast::{Initial, Name, Parameters, StringData, Value, ValueKind};
use iecc_diag::Code;
use iecc_source::{MappedText, Spanned};

/// All forms of the value that stand in children named `Data` or `DefaultData`.
pub(crate) fn initial(
    element: Element<'_>,
    data_element: &'static str,
    context: &mut Context<'_>,
) -> Initial {
    let forces = element.child("ForceData").map(Element::span);
    let mut initial = Initial {
        forces,
        ..Initial::default()
    };
    for data in element.children_named(data_element) {
        let format = data.attribute("Format").map(|format| format.node);
        match format.as_deref() {
            None => initial.hex = hex(data, context),
            Some("Decorated") => initial.decorated = decorated(data, context),
            Some("L5K") => initial.l5k = l5k::read(&data.text().trimmed(), context),
            Some("String") => initial.string = string(data, context),
            Some(_) => initial.parameters = data.children().next().map(parameters),
        }
    }
    initial
}

/// An element as the list of its attributes.
pub(crate) fn parameters(element: Element<'_>) -> Parameters {
    let attributes = element
        .attributes()
        .map(|(name, value)| (name.to_owned(), value))
        .collect();
    let name = Spanned::new(element.name().to_owned(), element.tag_span());
    Parameters {
        element: name,
        attributes,
    }
}

fn string(data: Element<'_>, context: &mut Context<'_>) -> Option<StringData> {
    let length = context.number(data, "Length");
    Some(StringData {
        length,
        text: as_name(&data.text().trimmed()),
    })
}

fn as_name(text: &MappedText) -> Name {
    Spanned::new(text.text().to_owned(), text.span(0..text.text().len()))
}

fn hex(data: Element<'_>, context: &mut Context<'_>) -> Option<Spanned<Vec<u8>>> {
    let text = data.text();
    let mut bytes = Vec::with_capacity(text.text().len() / 3);
    for digits in text.text().split_ascii_whitespace() {
        if let Some(byte) = hex_byte(digits) {
            bytes.push(byte);
            continue;
        }
        let at = digits.as_ptr() as usize - text.text().as_ptr() as usize;
        let message = format!("`{digits}` is not a byte of two hexadecimal digits");
        context.report(Code::E5007, text.span(at..at + digits.len()), message);
        return None;
    }
    Some(Spanned::new(bytes, data.span()))
}

fn hex_byte(digits: &str) -> Option<u8> {
    let is_hex = digits.len() == 2 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    if is_hex {
        u8::from_str_radix(digits, 16).ok()
    } else {
        None
    }
}

fn decorated(data: Element<'_>, context: &mut Context<'_>) -> Option<Value> {
    value(data.children().next()?, "", context)
}

/// The value of an element; `data_type` is what the parent says where the element does not.
/// Recurses at most as deep as elements nest.
fn value(element: Element<'_>, data_type: &str, context: &mut Context<'_>) -> Option<Value> {
    let own_type = element.attribute("DataType").map(|name| name.node);
    let data_type = own_type.unwrap_or_else(|| data_type.to_owned());
    let kind = match element.name() {
        "DataValue" | "DataValueMember" => ValueKind::Scalar(scalar(element)),
        "Structure" | "StructureMember" => ValueKind::Struct(members(element, context)),
        "Array" | "ArrayMember" => array(element, &data_type, context),
        "Element" => return array_element(element, data_type, context),
        _ => {
            let message = format!("`<{}>` is not known in tag data", element.name());
            context.report(Code::E5007, element.tag_span(), message);
            return None;
        }
    };
    Some(Value {
        data_type,
        kind,
        span: element.span(),
    })
}

/// Numbers stand in an attribute, strings in CDATA.
fn scalar(element: Element<'_>) -> Name {
    element
        .attribute("Value")
        .unwrap_or_else(|| as_name(&element.text().trimmed()))
}

fn members(element: Element<'_>, context: &mut Context<'_>) -> Vec<(Name, Value)> {
    element
        .children()
        .filter_map(|member| {
            Some((
                context.required(member, "Name")?,
                value(member, "", context)?,
            ))
        })
        .collect()
}

fn array(element: Element<'_>, data_type: &str, context: &mut Context<'_>) -> ValueKind {
    let dimensions = context.dimensions(element, "Dimensions");
    let elements = element
        .children()
        .filter_map(|item| Some((index(item, context)?, value(item, data_type, context)?)))
        .collect();
    ValueKind::Array {
        dimensions,
        elements,
    }
}

/// `[2]` or `[1,2,3]`.
fn index(element: Element<'_>, context: &mut Context<'_>) -> Option<Vec<u32>> {
    let index = context.required(element, "Index")?;
    let inner = index
        .node
        .strip_prefix('[')
        .and_then(|text| text.strip_suffix(']'));
    let parsed = inner.and_then(|inner| {
        inner
            .split(',')
            .map(|part| part.trim().parse().ok())
            .collect()
    });
    if parsed.is_none() {
        context.malformed("Index", &index, "an array index such as `[0]`");
    }
    parsed
}

/// An element is a scalar, or holds the structure that is the value.
fn array_element(
    element: Element<'_>,
    data_type: String,
    context: &mut Context<'_>,
) -> Option<Value> {
    if element.attribute("Value").is_none()
        && let Some(child) = element.children().next()
    {
        return value(child, &data_type, context);
    }
    Some(Value {
        data_type,
        kind: ValueKind::Scalar(scalar(element)),
        span: element.span(),
    })
}
