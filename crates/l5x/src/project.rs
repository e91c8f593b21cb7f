//! The root element, the controller, programs and tasks.
//!
//! Accepted: `<RSLogix5000Content …><Controller Name="C">…</Controller></RSLogix5000Content>`.
//! Rejected: any other root element (E5002).

use crate::context::{Context, description};
use crate::xml::Element;
use crate::{instructions, modules, routines, tags, types};
use iecc_ast::Name;
use iecc_ast::logix::{Controller, ParameterConnection, Program, Project, Task, TaskKind};
use iecc_diag::{Code, Diagnostic, Diagnostics};
use iecc_source::{Span, Spanned};

pub(crate) fn read(root: Element<'_>, diagnostics: &mut Diagnostics) -> Option<Project> {
    if root.name() != "RSLogix5000Content" {
        let message = format!(
            "found root element `<{}>`, expected `<RSLogix5000Content>`",
            root.name()
        );
        let diagnostic = Diagnostic::new(Code::E5002, root.tag_span(), message)
            .note("export the project or a part of it as L5X");
        diagnostics.push(diagnostic);
        return None;
    }
    let context = &mut Context { diagnostics };
    let lists = Lists {
        root,
        controller: root.child("Controller"),
    };
    Some(Project {
        software_revision: root.attribute("SoftwareRevision"),
        target_type: root.attribute("TargetType"),
        target_name: root.attribute("TargetName"),
        contains_context: context.boolean(root, "ContainsContext"),
        controller: controller(lists.controller.unwrap_or(root), context),
        data_types: lists.read("DataTypes", "DataType", context, types::data_type),
        instructions: instructions(&lists, context),
        modules: lists.read("Modules", "Module", context, modules::module),
        tags: lists.read("Tags", "Tag", context, tags::tag),
        programs: lists.read("Programs", "Program", context, program),
        tasks: lists.read("Tasks", "Task", context, task),
        parameter_connections: lists.read(
            "ParameterConnections",
            "ParameterConnection",
            context,
            parameter_connection,
        ),
        span: root.span(),
    })
}

/// Where the lists of a project stand: in the controller, but a lone module, type or instruction
/// may also stand directly in the root.
struct Lists<'d> {
    root: Element<'d>,
    controller: Option<Element<'d>>,
}

impl<'d> Lists<'d> {
    fn elements(&self, list: &'static str, item: &'static str) -> Vec<Element<'d>> {
        let holders = self.controller.into_iter().chain([self.root]);
        let listed = holders.flat_map(|holder| holder.children_named(list));
        let listed = listed.flat_map(|list| list.children_named(item));
        listed.chain(self.root.children_named(item)).collect()
    }

    fn read<T>(
        &self,
        list: &'static str,
        item: &'static str,
        context: &mut Context<'_>,
        read: fn(Element<'d>, &mut Context<'_>) -> Option<T>,
    ) -> Vec<T> {
        let elements = self.elements(list, item);
        elements
            .into_iter()
            .filter_map(|element| read(element, context))
            .collect()
    }
}

fn instructions(
    lists: &Lists<'_>,
    context: &mut Context<'_>,
) -> Vec<iecc_ast::logix::AddOnInstruction> {
    const LIST: &str = "AddOnInstructionDefinitions";
    let mut elements = lists.elements(LIST, "AddOnInstructionDefinition");
    elements.extend(lists.elements(LIST, "EncodedData"));
    elements.sort_by_key(|element| element.span().start);
    elements
        .into_iter()
        .filter_map(|element| instructions::instruction(element, context))
        .collect()
}

fn controller(element: Element<'_>, context: &mut Context<'_>) -> Controller {
    let is_controller = element.name() == "Controller";
    let name = element.attribute("Name").filter(|_| is_controller);
    let revision = (
        context.number(element, "MajorRev"),
        context.number(element, "MinorRev"),
    );
    Controller {
        name: name.unwrap_or_else(|| no_name(element)),
        role: context.role(element),
        processor: element.attribute("ProcessorType"),
        firmware: revision.0.zip(revision.1),
        sfc_options: ["SFCExecutionControl", "SFCRestartPosition", "SFCLastScan"]
            .map(|option| element.attribute(option)),
        report_minor_overflow: context.boolean(element, "ReportMinorOverflow"),
        major_fault_program: name_attribute(element, "MajorFaultProgram"),
        power_loss_program: name_attribute(element, "PowerLossProgram"),
        span: element.span(),
    }
}

/// An empty name at the start tag.
pub(crate) fn no_name(element: Element<'_>) -> Name {
    let span = element.tag_span();
    Spanned::new(String::new(), Span::point(span.file, span.end))
}

/// An attribute that names something; an empty one names nothing.
fn name_attribute(element: Element<'_>, attribute: &str) -> Option<Name> {
    element
        .attribute(attribute)
        .filter(|name| !name.node.is_empty())
}

fn program(element: Element<'_>, context: &mut Context<'_>) -> Option<Program> {
    let tags = element
        .children_named("Tags")
        .flat_map(|list| list.children_named("Tag"));
    Some(Program {
        name: context.required(element, "Name")?,
        role: context.role(element),
        main_routine: name_attribute(element, "MainRoutineName"),
        fault_routine: name_attribute(element, "FaultRoutineName"),
        test_edits: context.boolean(element, "TestEdits"),
        disabled: context.boolean(element, "Disabled"),
        is_folder: context.boolean(element, "UseAsFolder"),
        is_phase: is_phase(element, context),
        safety: context.safety(element),
        tags: tags.filter_map(|tag| tags::tag(tag, context)).collect(),
        routines: routines::routines(element, context),
        description: description(element, "Description"),
        span: element.span(),
    })
}

fn is_phase(element: Element<'_>, context: &mut Context<'_>) -> bool {
    let Some(kind) = element.attribute("Type") else {
        return false;
    };
    match kind.node.as_str() {
        "EquipmentPhase" => true,
        "Normal" => false,
        _ => {
            context.malformed("Type", &kind, "`Normal` or `EquipmentPhase`");
            false
        }
    }
}

fn task(element: Element<'_>, context: &mut Context<'_>) -> Option<Task> {
    let scheduled = element.children_named("ScheduledPrograms");
    let scheduled = scheduled.flat_map(|list| list.children_named("ScheduledProgram"));
    Some(Task {
        name: context.required(element, "Name")?,
        kind: task_kind(element, context),
        priority: context.number(element, "Priority"),
        watchdog_ms: element.attribute("Watchdog"),
        disable_update_outputs: context.boolean(element, "DisableUpdateOutputs"),
        inhibited: context.boolean(element, "InhibitTask"),
        programs: scheduled
            .filter_map(|program| context.required(program, "Name"))
            .collect(),
        description: description(element, "Description"),
        span: element.span(),
    })
}

fn task_kind(element: Element<'_>, context: &mut Context<'_>) -> TaskKind {
    let rate_ms = element.attribute("Rate");
    let kind = element.attribute("Type");
    let upper = kind.as_ref().map(|kind| kind.node.to_ascii_uppercase());
    match upper.as_deref() {
        Some("CONTINUOUS") => TaskKind::Continuous,
        Some("PERIODIC") => TaskKind::Periodic { rate_ms },
        Some("EVENT") => event(element, rate_ms, context),
        Some(_) | None => TaskKind::Unknown(kind),
    }
}

fn event(element: Element<'_>, timeout_ms: Option<Name>, context: &mut Context<'_>) -> TaskKind {
    let info = element.child("EventInfo");
    TaskKind::Event {
        trigger: info.and_then(|info| info.attribute("EventTrigger")),
        trigger_tag: info.and_then(|info| name_attribute(info, "EventTag")),
        timeout_ms,
        timeout_enabled: info.is_some_and(|info| context.boolean(info, "EnableTimeout")),
    }
}

fn parameter_connection(
    element: Element<'_>,
    context: &mut Context<'_>,
) -> Option<ParameterConnection> {
    let first = context.required(element, "EndPoint1")?;
    let second = context.required(element, "EndPoint2")?;
    Some(ParameterConnection {
        endpoints: [first, second],
        span: element.span(),
    })
}
