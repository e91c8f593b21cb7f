//! One hand-written export with at least one of everything; what is in it is stated here again.
#![expect(clippy::disallowed_methods, reason = "tests read files")]

use iecc_ast::logix::{
    ModuleTagDirection, Project, RoutineBody, RungKind, Tag, TagKind, TaskKind, Usage, Use,
};
use iecc_ast::{L5kValue, Name, Value, ValueKind};
use iecc_diag::{Code, Diagnostics};
use iecc_source::SourceMap;
use iecc_tests::mutate::SAMPLE;
use std::path::Path;

/// Reads a text that must have no mistakes.
fn read(text: &str) -> (SourceMap, Project) {
    let mut map = SourceMap::new();
    let file = map.add("sample.L5X", text);
    let mut diagnostics = Diagnostics::new();
    let project = iecc_l5x::read(file, map.file(file).text(), &mut diagnostics);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    (map, project.expect("no mistakes"))
}

fn sample() -> Project {
    read(SAMPLE).1
}

fn node(name: &Option<Name>) -> &str {
    name.as_ref().map_or("", |name| &name.node)
}

fn tag<'p>(project: &'p Project, name: &str) -> &'p Tag {
    project
        .tags
        .iter()
        .find(|tag| tag.name.node == name)
        .expect(name)
}

/// A value in short: `{name:value}` for structures, `[index=value]` for arrays.
fn short(value: &Value) -> String {
    let list = |items: Vec<String>| items.join(" ");
    match &value.kind {
        ValueKind::Scalar(text) => text.node.clone(),
        ValueKind::Struct(members) => {
            let member = |(name, value): &(Name, Value)| format!("{}:{}", name.node, short(value));
            format!("{{{}}}", list(members.iter().map(member).collect()))
        }
        ValueKind::Array {
            dimensions,
            elements,
        } => {
            let element =
                |(index, value): &(Vec<u32>, Value)| format!("{index:?}={}", short(value));
            format!(
                "{dimensions:?}[{}]",
                list(elements.iter().map(element).collect())
            )
        }
    }
}

#[test]
fn the_project_and_its_controller() {
    let project = sample();
    assert_eq!(node(&project.software_revision), "35.01");
    assert_eq!(node(&project.target_type), "Controller");
    assert!(!project.contains_context);
    let controller = &project.controller;
    assert_eq!(
        (controller.name.node.as_str(), controller.role),
        ("Press", Some(Use::Target))
    );
    assert_eq!(controller.firmware, Some((35, 11)));
    assert_eq!(node(&controller.major_fault_program), "Rescue");
    assert_eq!(controller.power_loss_program, None);
    assert_eq!(
        controller.sfc_options.each_ref().map(node),
        ["CurrentActive", "MostRecent", "DontScan"]
    );
    let ends = project.parameter_connections[0]
        .endpoints
        .each_ref()
        .map(|end| end.node.as_str());
    assert_eq!(ends, ["\\Main.width", "Drive:I1.Width"]);
}

#[test]
fn data_types_keep_hidden_storage_and_bits() {
    let project = sample();
    let [motor, label] = &project.data_types[..] else {
        panic!("two types")
    };
    assert!(!motor.is_string && label.is_string);
    let [hidden, run, speed] = &motor.members[..] else {
        panic!("three members")
    };
    assert!(hidden.hidden && hidden.dimension.is_none());
    let (target, bit) = run.bit_of.as_ref().unwrap();
    assert_eq!((target.node.as_str(), *bit), ("ZZZZMotor0", 0));
    assert_eq!(
        run.description.as_ref().unwrap().text(),
        "The motor runs",
        "first language"
    );
    assert_eq!(
        (speed.dimension, speed.data_type.node.as_str()),
        (Some(4), "REAL")
    );
}

#[test]
fn module_tags_are_named_by_slot_or_by_module() {
    use ModuleTagDirection::{Configuration, Input, Output};
    let project = sample();
    let tags = project.modules.iter().flat_map(|module| &module.tags);
    let tags: Vec<_> = tags
        .map(|tag| (tag.name.node.as_str(), tag.direction, tag.rack_alias))
        .collect();
    assert_eq!(
        tags,
        [
            ("Local:2:C", Configuration, false),
            ("Local:2:I", Input, false),
            ("Drive:I1", Input, false),
            ("Drive:O1", Output, false),
            ("Drive:I", Input, true),
        ]
    );
    let inputs = &project.modules[1];
    assert_eq!(
        inputs.tags[0].initial.hex.as_ref().unwrap().node,
        [0x0a, 0, 0xff, 0x10]
    );
    let input = &inputs.tags[1];
    assert_eq!(input.data_type.as_deref(), Some("AB:1769_IQ16:I:0"));
    assert_eq!(input.packet_interval_us, Some(2000));
    let comments = input
        .comments
        .iter()
        .map(|c| (c.operand.node.as_str(), c.text.text()));
    assert_eq!(
        comments.collect::<Vec<_>>(),
        [(".DATA.0", "Start"), (".DATA.1", "Stop & hold")]
    );
    let drive = &project.modules[2];
    assert!(drive.inhibited && drive.slot().is_none());
    assert!(drive.tags[1].initial.forces.is_some());
}

#[test]
fn instructions_keep_parameters_and_whether_they_are_encoded() {
    let project = sample();
    let [pulse, secret] = &project.instructions[..] else {
        panic!("two instructions")
    };
    assert!(pulse.execute_prescan && !pulse.execute_postscan && !pulse.encoded);
    assert!(secret.encoded && secret.routines.is_empty() && secret.parameters.len() == 1);
    let [enable, width, out] = &pulse.parameters[..] else {
        panic!("three parameters")
    };
    assert_eq!((enable.usage, enable.required), (Usage::Input, false));
    assert!(width.required && width.visible);
    assert_eq!(short(width.tag.initial.decorated.as_ref().unwrap()), "250");
    assert!(matches!(&out.tag.kind, TagKind::Alias(Some(target)) if target.node == "Status.3"));
    assert_eq!(pulse.locals[0].name.node, "Status");
}

#[test]
fn tags_keep_every_form_of_their_value() {
    let project = sample();
    let TagKind::Alias(Some(target)) = &tag(&project, "start").kind else {
        panic!("an alias")
    };
    assert_eq!(target.node, "Local:2:I.Data.0");
    let hold = tag(&project, "hold");
    assert_eq!(hold.initial.hex.as_ref().unwrap().node.len(), 12);
    assert_eq!(
        short(hold.initial.decorated.as_ref().unwrap()),
        "{PRE:10000 ACC:0 EN:0}"
    );
    assert_eq!(hold.comments[0].operand.node, ".PRE");
    let table = tag(&project, "table");
    assert!(table.constant);
    assert_eq!(table.dimensions, [2, 3]);
    assert_eq!(
        short(table.initial.decorated.as_ref().unwrap()),
        "[2, 3][[0, 0]=1 [1, 2]=6]"
    );
    assert!(matches!(&table.initial.l5k, Some(L5kValue::List(values, _)) if values.len() == 6));
    let motors = tag(&project, "motors").initial.decorated.as_ref().unwrap();
    assert_eq!(short(motors), "[1][[0]={Run:1 Speed:[4][[0]=1.5]}]");
    let label = tag(&project, "label").initial.string.as_ref().unwrap();
    assert_eq!(
        (label.length, label.text.node.as_str()),
        (Some(4), "'ab$'c'")
    );
    let ask = tag(&project, "ask").initial.parameters.as_ref().unwrap();
    assert_eq!(ask.element.node, "MessageParameters");
    assert_eq!(ask.attributes[1].0, "RequestedLength");
    let remote = tag(&project, "remote");
    assert_eq!(remote.kind, TagKind::Consumed);
    assert_eq!(
        remote.connection.as_ref().unwrap().attributes[1].1.node,
        "count"
    );
}

#[test]
fn programs_hold_routines_of_every_kind() {
    let project = sample();
    let [main, rescue] = &project.programs[..] else {
        panic!("two programs")
    };
    assert!(main.test_edits && !main.disabled && !main.is_phase);
    assert!(rescue.disabled && rescue.is_phase);
    assert_eq!(
        (node(&main.main_routine), &main.fault_routine),
        ("Control", &None)
    );
    assert_eq!(main.tags[0].usage, Usage::Input);
    let [control, text, blocks, chart, hidden] = &main.routines[..] else {
        panic!("five")
    };
    assert!(matches!(blocks.body, RoutineBody::FunctionBlock(_)));
    assert!(matches!(chart.body, RoutineBody::SequentialChart(_)));
    assert!(matches!(hidden.body, RoutineBody::Encoded(_)));
    let RoutineBody::Ladder(rungs) = &control.body else {
        panic!("ladder")
    };
    let kinds: Vec<_> = rungs.iter().map(|rung| (rung.number, rung.kind)).collect();
    assert_eq!(
        kinds,
        [
            (0, RungKind::Normal),
            (1, RungKind::InsertReplace),
            (2, RungKind::Replace)
        ]
    );
    assert_eq!(rungs[0].comment.as_ref().unwrap().text(), "starts");
    assert_eq!(
        rungs[0].text.text(),
        "XIC(start)[XIO(hold.DN) , ]TON(hold,?,?);"
    );
    let RoutineBody::StructuredText(text) = &text.body else {
        panic!("structured text")
    };
    let lines: Vec<_> = text.original.iter().map(|line| line.text.text()).collect();
    assert_eq!(
        lines,
        ["IF width < 5 THEN", "  width := 5;", "", "END_IF; // a & b"]
    );
}

#[test]
fn places_are_exact_in_rungs_with_entities() {
    let (map, project) = read(SAMPLE);
    let RoutineBody::Ladder(rungs) = &project.programs[0].routines[0].body else {
        panic!("ladder")
    };
    let rung = rungs[2].body.as_ref().unwrap();
    assert_eq!(rung.to_string(), "CMP(width<5&&width>1)NOP();");
    let [cmp, nop] = &rung.instructions()[..] else {
        panic!("two instructions")
    };
    assert_eq!(
        map.slice(cmp.operands[0].span),
        "width&lt;5 &amp;&amp; width&gt;1"
    );
    assert_eq!(map.slice(nop.span), "NOP()");
    let place = map.start(nop.span);
    let line = SAMPLE
        .lines()
        .position(|line| line.contains("NOP()"))
        .unwrap();
    assert_eq!(place.line as usize, line + 1);
    assert_eq!(
        place.column as usize,
        SAMPLE.lines().nth(line).unwrap().find("NOP()").unwrap() + 1
    );
}

#[test]
fn tasks_keep_their_kind_and_order() {
    let project = sample();
    let [slow, idle, hit] = &project.tasks[..] else {
        panic!("three tasks")
    };
    assert!(matches!(&slow.kind, TaskKind::Periodic { rate_ms } if node(rate_ms) == "12.5"));
    assert_eq!(
        (slow.priority, slow.programs[0].node.as_str()),
        (Some(5), "Main")
    );
    assert!(slow.disable_update_outputs);
    assert!(idle.inhibited && idle.kind == TaskKind::Continuous);
    assert!(
        matches!(&hit.kind, TaskKind::Event { timeout_enabled: true, trigger, .. }
        if node(trigger) == "EVENT Instruction Only")
    );
}

#[test]
fn byte_order_mark_line_ends_and_a_missing_declaration_change_nothing() {
    let plain = sample();
    let declaration = SAMPLE.lines().next().unwrap();
    for text in [
        format!("\u{feff}{SAMPLE}"),
        SAMPLE.replace('\n', "\r\n"),
        SAMPLE.replacen(declaration, "", 1),
    ] {
        let (_, project) = read(&text);
        assert_eq!(shape(&project), shape(&plain));
    }
}

/// Names and rung texts of a project, which do not depend on places.
fn shape(project: &Project) -> Vec<String> {
    let tags = project.tags.iter().map(|tag| tag.name.node.clone());
    let rungs = project
        .programs
        .iter()
        .flat_map(|program| &program.routines);
    let rungs = rungs.filter_map(|routine| match &routine.body {
        RoutineBody::Ladder(rungs) => Some(rungs),
        RoutineBody::StructuredText(_)
        | RoutineBody::FunctionBlock(_)
        | RoutineBody::SequentialChart(_)
        | RoutineBody::Encoded(_)
        | RoutineBody::Unknown(_) => None,
    });
    tags.chain(
        rungs
            .flatten()
            .map(|rung| rung.body.as_ref().unwrap().to_string()),
    )
    .collect()
}

/// The codes of all messages for a text.
fn codes(text: &str) -> Vec<Code> {
    let mut map = SourceMap::new();
    let file = map.add("bad.L5X", text);
    let mut diagnostics = Diagnostics::new();
    iecc_l5x::read(file, text, &mut diagnostics);
    diagnostics
        .iter()
        .map(|diagnostic| diagnostic.code)
        .collect()
}

#[test]
fn every_mistake_in_a_file_is_found_in_one_run() {
    let text = SAMPLE
        .replace("XIC(EnableIn)OTE(Status.3);", "XIC(EnableIn OTE(Status.3);")
        .replace("Pulse(p1,300);", "Pulse(p1,300)")
        .replace(
            "Name=\"hold\" TagType=\"Base\"",
            "Name=\"hold\" TagType=\"Odd\"",
        )
        .replace("<Data>00 00", "<Data>0x 00")
        .replace("[1,2,3,4,5,6]", "[1,2,3,4,5,6")
        .replace("Type=\"IR\"", "Type=\"ZZ\"")
        .replace("BitNumber=\"0\"", "BitNumber=\"first\"");
    let mut found = codes(&text);
    found.sort();
    use Code::{E5003, E5006, E5007};
    assert_eq!(found, [E5003, E5003, E5006, E5006, E5006, E5007, E5007]);
}

#[test]
fn a_file_cut_off_anywhere_gives_exactly_one_message() {
    let end = SAMPLE.rfind('>').unwrap();
    for cut in (0..end).step_by(7) {
        let found = codes(&SAMPLE[..cut]);
        assert_eq!(found.len(), 1, "cut at {cut}: {found:?}");
        assert!(
            matches!(found[0], Code::E5001 | Code::E5002),
            "cut at {cut}: {found:?}"
        );
    }
}

#[test]
fn the_example_of_each_code_gives_that_code_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("codes");
    use Code::{E5001, E5002, E5003, E5004, E5005, E5006, E5007};
    for code in [E5001, E5002, E5003, E5004, E5005, E5006, E5007] {
        let path = folder.join(format!("{code}.L5X"));
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(codes(&text), [code], "{}", path.display());
    }
}
