//! Tags of controllers, programs and Add-On Instructions.

use crate::context::{Context, description, localized_text};
use crate::data;
use crate::xml::Element;
use iecc_ast::logix::{Comment, Parameter, Tag, TagKind, Usage};

/// A `<Tag>`.
pub(crate) fn tag(element: Element<'_>, context: &mut Context<'_>) -> Option<Tag> {
    any_tag(element, "Data", context)
}

/// A `<LocalTag>` of an Add-On Instruction.
pub(crate) fn local_tag(element: Element<'_>, context: &mut Context<'_>) -> Option<Tag> {
    any_tag(element, "DefaultData", context)
}

/// A `<Parameter>` of an Add-On Instruction.
pub(crate) fn parameter(element: Element<'_>, context: &mut Context<'_>) -> Option<Parameter> {
    let tag = any_tag(element, "DefaultData", context)?;
    context.required(element, "Usage")?;
    Some(Parameter {
        usage: tag.usage,
        required: context.boolean(element, "Required"),
        visible: context.boolean(element, "Visible"),
        tag,
    })
}

fn any_tag(
    element: Element<'_>,
    data_element: &'static str,
    context: &mut Context<'_>,
) -> Option<Tag> {
    let connection = element
        .child("ProduceInfo")
        .or_else(|| element.child("ConsumeInfo"));
    Some(Tag {
        name: context.required(element, "Name")?,
        role: context.role(element),
        kind: kind(element, context),
        data_type: element.attribute("DataType"),
        dimensions: context.dimensions(element, "Dimensions"),
        radix: element.attribute("Radix"),
        constant: context.boolean(element, "Constant"),
        usage: usage(element, context),
        safety: context.safety(element),
        connection: connection.map(data::parameters),
        description: description(element, "Description"),
        comments: comments(element, context),
        initial: data::initial(element, data_element, context),
        span: element.span(),
    })
}

fn kind(element: Element<'_>, context: &mut Context<'_>) -> TagKind {
    let alias = element
        .attribute("AliasFor")
        .filter(|alias| !alias.node.is_empty());
    let Some(kind) = element.attribute("TagType") else {
        return alias.map_or(TagKind::Base, |alias| TagKind::Alias(Some(alias)));
    };
    match kind.node.as_str() {
        "Base" => TagKind::Base,
        "Alias" => TagKind::Alias(alias),
        "Produced" => TagKind::Produced,
        "Consumed" => TagKind::Consumed,
        _ => {
            context.malformed(
                "TagType",
                &kind,
                "`Base`, `Alias`, `Produced` or `Consumed`",
            );
            TagKind::Base
        }
    }
}

fn usage(element: Element<'_>, context: &mut Context<'_>) -> Usage {
    let Some(usage) = element.attribute("Usage") else {
        return Usage::Local;
    };
    match usage.node.as_str() {
        "Input" => Usage::Input,
        "Output" => Usage::Output,
        "InOut" => Usage::InOut,
        "Public" => Usage::Public,
        // Studio writes both for a program tag that is no parameter.
        "Normal" | "Local" | "" => Usage::Local,
        _ => {
            context.malformed(
                "Usage",
                &usage,
                "`Input`, `Output`, `InOut`, `Public` or `Local`",
            );
            Usage::Local
        }
    }
}

/// The comments on parts of a tag.
pub(crate) fn comments(element: Element<'_>, context: &mut Context<'_>) -> Vec<Comment> {
    let comments = element
        .children_named("Comments")
        .flat_map(|list| list.children_named("Comment"));
    comments
        .filter_map(|comment| {
            let operand = context.required(comment, "Operand")?;
            Some(Comment {
                operand,
                text: localized_text(comment),
            })
        })
        .collect()
}
