//! User-defined data types: members in the order of the file, hidden ones as well.

use crate::context::{Context, description};
use crate::xml::Element;
use iecc_ast::Name;
use iecc_ast::logix::{DataMember, DataType};
use iecc_diag::Code;

pub(crate) fn data_type(element: Element<'_>, context: &mut Context<'_>) -> Option<DataType> {
    let members = element
        .children_named("Members")
        .flat_map(|list| list.children_named("Member"));
    Some(DataType {
        name: context.required(element, "Name")?,
        role: context.role(element),
        is_string: is_string(element, context),
        members: members
            .filter_map(|member| data_member(member, context))
            .collect(),
        description: description(element, "Description"),
        span: element.span(),
    })
}

fn is_string(element: Element<'_>, context: &mut Context<'_>) -> bool {
    let Some(family) = element.attribute("Family") else {
        return false;
    };
    match family.node.as_str() {
        "StringFamily" => true,
        "NoFamily" => false,
        _ => {
            context.malformed("Family", &family, "`NoFamily` or `StringFamily`");
            false
        }
    }
}

fn data_member(element: Element<'_>, context: &mut Context<'_>) -> Option<DataMember> {
    let dimensions = context.dimensions(element, "Dimension");
    if dimensions.len() > 1 {
        let message = "a member has one dimension at most";
        context.report(Code::E5006, element.tag_span(), message);
    }
    Some(DataMember {
        name: context.required(element, "Name")?,
        data_type: context.required(element, "DataType")?,
        dimension: dimensions.first().copied(),
        radix: element.attribute("Radix"),
        hidden: context.boolean(element, "Hidden"),
        bit_of: bit_of(element, context),
        description: description(element, "Description"),
        span: element.span(),
    })
}

fn bit_of(element: Element<'_>, context: &mut Context<'_>) -> Option<(Name, u32)> {
    let target = element.attribute("Target")?;
    context.required(element, "BitNumber")?;
    let bit = context.number(element, "BitNumber")?;
    Some((target, bit))
}
