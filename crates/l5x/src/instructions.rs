//! Add-On Instructions, plain and encrypted.

use crate::context::{Context, description};
use crate::xml::Element;
use crate::{routines, tags};
use iecc_ast::logix::AddOnInstruction;

/// An `<AddOnInstructionDefinition>`, or an `<EncodedData>` that stands in for one and shows the
/// signature only.
pub(crate) fn instruction(
    element: Element<'_>,
    context: &mut Context<'_>,
) -> Option<AddOnInstruction> {
    let parameters = element.children_named("Parameters");
    let parameters = parameters.flat_map(|list| list.children_named("Parameter"));
    let locals = element.children_named("LocalTags");
    let locals = locals.flat_map(|list| list.children_named("LocalTag"));
    Some(AddOnInstruction {
        name: context.required(element, "Name")?,
        role: context.role(element),
        revision: element.attribute("Revision"),
        parameters: parameters
            .filter_map(|p| tags::parameter(p, context))
            .collect(),
        locals: locals
            .filter_map(|tag| tags::local_tag(tag, context))
            .collect(),
        routines: routines::routines(element, context),
        execute_prescan: context.boolean(element, "ExecutePrescan"),
        execute_postscan: context.boolean(element, "ExecutePostscan"),
        execute_enable_in_false: context.boolean(element, "ExecuteEnableInFalse"),
        encoded: element.name() == "EncodedData",
        safety: context.safety(element),
        description: description(element, "Description"),
        span: element.span(),
    })
}
