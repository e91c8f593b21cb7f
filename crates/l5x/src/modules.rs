//! Modules of the I/O tree and the tags they bring.
//!
//! A module in a chassis slot brings `Parent:slot:I`, `:O` and `:C`; any other `Name:I` and so on.
//! Newer modules give the suffix in the connection (`I1`). A `RackConnection` brings tags that are
//! parts of the rack adapter's tag.

use crate::context::{Context, description};
use crate::project::no_name;
use crate::xml::Element;
use crate::{data, tags};
use iecc_ast::Name;
use iecc_ast::logix::{Module, ModuleTag, ModuleTagDirection, Port};
use iecc_source::Spanned;

pub(crate) fn module(element: Element<'_>, context: &mut Context<'_>) -> Option<Module> {
    let mut module = Module {
        name: element
            .attribute("Name")
            .unwrap_or_else(|| no_name(element)),
        role: context.role(element),
        catalog_number: element.attribute("CatalogNumber"),
        parent: element.attribute("ParentModule"),
        parent_port: context.number(element, "ParentModPortId"),
        inhibited: context.boolean(element, "Inhibited"),
        ports: ports(element, context),
        tags: Vec::new(),
        description: description(element, "Description"),
        span: element.span(),
    };
    let found: Vec<_> = element
        .children_named("Communications")
        .flat_map(sources)
        .collect();
    module.tags = found
        .into_iter()
        .map(|source| module_tag(source, &module, context))
        .collect();
    Some(module)
}

fn ports(element: Element<'_>, context: &mut Context<'_>) -> Vec<Port> {
    let ports = element
        .children_named("Ports")
        .flat_map(|list| list.children_named("Port"));
    ports
        .map(|port| Port {
            id: context.number(port, "Id"),
            address: port
                .attribute("Address")
                .filter(|address| !address.node.is_empty()),
            bus: port.attribute("Type"),
            upstream: context.boolean(port, "Upstream"),
        })
        .collect()
}

/// An element that stands for a tag.
struct Source<'d> {
    element: Element<'d>,
    /// The connection it belongs to; none for a configuration tag.
    connection: Option<Element<'d>>,
    form: Form,
}

/// What the element's name says about the tag.
struct Form {
    direction: ModuleTagDirection,
    suffix_attribute: &'static str,
    default_suffix: &'static str,
    rack_alias: bool,
}

fn form(element_name: &str) -> Option<Form> {
    use ModuleTagDirection::{Configuration, Input, Output};
    let form = |direction, suffix_attribute, default_suffix, rack_alias| {
        Some(Form {
            direction,
            suffix_attribute,
            default_suffix,
            rack_alias,
        })
    };
    match element_name {
        "ConfigTag" => form(Configuration, "ConfigTagSuffix", "C", false),
        "InputTag" => form(Input, "InputTagSuffix", "I", false),
        "OutputTag" => form(Output, "OutputTagSuffix", "O", false),
        "InAliasTag" => form(Input, "InputTagSuffix", "I", true),
        "OutAliasTag" => form(Output, "OutputTagSuffix", "O", true),
        _ => None,
    }
}

fn sources(communications: Element<'_>) -> Vec<Source<'_>> {
    let connections = communications
        .children_named("Connections")
        .flat_map(Element::children);
    let connected = connections.flat_map(|connection| {
        connection
            .children()
            .map(move |element| (Some(connection), element))
    });
    let own = communications.children().map(|element| (None, element));
    own.chain(connected)
        .filter_map(|(connection, element)| {
            Some(Source {
                element,
                connection,
                form: form(element.name())?,
            })
        })
        .collect()
}

fn module_tag(source: Source<'_>, module: &Module, context: &mut Context<'_>) -> ModuleTag {
    let Source {
        element,
        connection,
        form,
    } = source;
    let initial = data::initial(element, "Data", context);
    ModuleTag {
        name: tag_name(module, element, connection, &form),
        direction: form.direction,
        data_type: initial
            .decorated
            .as_ref()
            .map(|value| value.data_type.clone()),
        rack_alias: form.rack_alias,
        packet_interval_us: connection.and_then(|connection| context.number(connection, "RPI")),
        initial,
        comments: tags::comments(element, context),
        span: element.span(),
    }
}

fn tag_name(
    module: &Module,
    element: Element<'_>,
    connection: Option<Element<'_>>,
    form: &Form,
) -> Name {
    let suffix = connection
        .unwrap_or(element)
        .attribute(form.suffix_attribute);
    let suffix = suffix.filter(|suffix| !suffix.node.is_empty());
    let text = suffix
        .as_ref()
        .map_or(form.default_suffix, |suffix| &suffix.node);
    let span = suffix
        .as_ref()
        .map_or(module.name.span, |suffix| suffix.span);
    Spanned::new(format!("{}:{text}", module.tag_prefix()), span)
}
