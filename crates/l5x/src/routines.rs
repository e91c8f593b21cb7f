//! Routines: rungs are parsed, structured text is kept by line, diagrams by place.

use crate::context::{Context, description};
use crate::xml::Element;
use iecc_ast::logix::{Routine, RoutineBody, Rung, RungKind, StContent, StLine};
use iecc_diag::Code;
use iecc_grammar::parse_rung;

/// The routines of a program or Add-On Instruction.
pub(crate) fn routines(owner: Element<'_>, context: &mut Context<'_>) -> Vec<Routine> {
    let elements = owner.children_named("Routines").flat_map(Element::children);
    elements
        .filter_map(|element| match element.name() {
            "Routine" => routine(element, context),
            "EncodedData" => encoded(element, context),
            _ => None,
        })
        .collect()
}

fn routine(element: Element<'_>, context: &mut Context<'_>) -> Option<Routine> {
    Some(Routine {
        name: context.required(element, "Name")?,
        role: context.role(element),
        body: body(element, context),
        description: description(element, "Description"),
        span: element.span(),
    })
}

fn encoded(element: Element<'_>, context: &mut Context<'_>) -> Option<Routine> {
    Some(Routine {
        name: context.required(element, "Name")?,
        role: context.role(element),
        body: RoutineBody::Encoded(element.span()),
        description: description(element, "Description"),
        span: element.span(),
    })
}

fn body(element: Element<'_>, context: &mut Context<'_>) -> RoutineBody {
    let written = element.attribute("Type");
    // Context routines may leave out the type; their content tells.
    let kind = written
        .as_ref()
        .map_or_else(|| kind_of_content(element), |kind| &kind.node);
    match kind {
        "RLL" => RoutineBody::Ladder(rungs(element, context)),
        "ST" => RoutineBody::StructuredText(structured_text(element, context)),
        "FBD" => RoutineBody::FunctionBlock(element.span()),
        "SFC" => RoutineBody::SequentialChart(element.span()),
        _ => RoutineBody::Unknown(written),
    }
}

fn kind_of_content(element: Element<'_>) -> &'static str {
    let contents = [
        ("RLLContent", "RLL"),
        ("STContent", "ST"),
        ("FBDContent", "FBD"),
        ("SFCContent", "SFC"),
    ];
    let found = contents
        .iter()
        .find(|(content, _)| element.child(content).is_some());
    found.map_or("", |(_, kind)| kind)
}

fn rungs(element: Element<'_>, context: &mut Context<'_>) -> Vec<Rung> {
    let rungs = element
        .children_named("RLLContent")
        .flat_map(|list| list.children_named("Rung"));
    rungs
        .enumerate()
        .filter_map(|(position, rung)| self::rung(position, rung, context))
        .collect()
}

fn rung(position: usize, element: Element<'_>, context: &mut Context<'_>) -> Option<Rung> {
    let Some(text) = element.child("Text") else {
        context.report(Code::E5006, element.tag_span(), "the rung has no `<Text>`");
        return None;
    };
    let text = text.text().trimmed();
    Some(Rung {
        number: context.number(element, "Number").unwrap_or(position as u32),
        kind: rung_kind(element, context),
        comment: description(element, "Comment"),
        body: parse_rung(&text, context.diagnostics),
        text,
        span: element.span(),
    })
}

fn rung_kind(element: Element<'_>, context: &mut Context<'_>) -> RungKind {
    let Some(written) = element.attribute("Type") else {
        return RungKind::Normal;
    };
    RungKind::parse(&written.node).unwrap_or_else(|| {
        context.malformed(
            "Type",
            &written,
            "a rung type such as `N`, `I`, `D`, `R` or `IR`",
        );
        RungKind::Normal
    })
}

fn structured_text(element: Element<'_>, context: &mut Context<'_>) -> StContent {
    let mut content = StContent::default();
    for version in element.children_named("STContent") {
        let lines = lines(version, context);
        let Some(edit) = version.attribute("OnlineEditType") else {
            content.original = lines;
            continue;
        };
        match edit.node.to_ascii_lowercase().as_str() {
            "original" => content.original = lines,
            "test" | "testedits" => content.test_edits = Some(lines),
            "pending" | "pendingedits" => content.pending_edits = Some(lines),
            _ => context.malformed("OnlineEditType", &edit, "`Original`, `Test` or `Pending`"),
        }
    }
    content
}

fn lines(content: Element<'_>, context: &mut Context<'_>) -> Vec<StLine> {
    let lines = content.children_named("Line").enumerate();
    lines
        .map(|(position, line)| StLine {
            number: context.number(line, "Number").unwrap_or(position as u32),
            text: line.text(),
        })
        .collect()
}
