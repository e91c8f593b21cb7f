//! Routines, programs, types, aliases, pending edits and I/O points.

use iecc_diag::Code;
use iecc_driver::FrontOptions;
use iecc_ir::{Region, StructId};
use iecc_sema::logix::{Edits, Init};
use iecc_tests::ladder::{Bench, Source, compile_xml};

fn export() -> FrontOptions {
    FrontOptions {
        init: Init::Export,
        ..FrontOptions::default()
    }
}

fn edits(edits: Edits) -> FrontOptions {
    FrontOptions {
        edits,
        ..FrontOptions::default()
    }
}

#[test]
fn a_routine_that_is_not_called_is_frozen_not_cleared() {
    let source = Source::rungs(&["XIC(call)JSR(Sub,0)OTE(behind);"])
        .tags("call BOOL; a BOOL; x BOOL; s BOOL; o BOOL; behind BOOL")
        .routine("Sub", &["XIC(a)OTE(x);", "XIC(a)ONS(s)OTE(o);"]);
    Bench::new(&source).run(
        "prescan      | x=0 s=1
         call=1 a=0   | x=0 s=0 behind=1
         a=1          | x=1 s=1 o=1
         call=0 a=0   | x=1 s=1 o=1 behind=0
         call=1       | x=0 s=0 o=0",
    );
}

#[test]
fn a_call_passes_values_in_and_out_by_value() {
    let source = Source::rungs(&["JSR(Double,2,n,on,m,off);"])
        .tags("n INT; on BOOL; m DINT; off BOOL; p INT; flag BOOL; r DINT; inverse BOOL")
        .routine(
            "Double",
            &[
                "SBR(p,flag)NOP();",
                "ADD(p,p,r);",
                "XIO(flag)OTE(inverse);",
                "MOV(0,p);",
                "RET(r,inverse);",
            ],
        );
    Bench::new(&source).run(
        "n=21 on=1 | m=42 off=0 p=0 n=21
         n=-4 on=0 | m=-8 off=1",
    );
}

#[test]
fn literals_take_the_type_of_the_parameter() {
    let source = Source::rungs(&["JSR(Sub,2,-1,2.5,m);"])
        .tags("m DINT; p SINT; q LREAL")
        .routine("Sub", &["SBR(p,q);", "RET(7);"]);
    Bench::new(&source).run("| p=-1 q=2.5 m=7");
}

#[test]
fn extra_inputs_are_ignored() {
    let source = Source::rungs(&["JSR(Sub,2,n,n);"])
        .tags("n DINT; p DINT")
        .routine("Sub", &["SBR(p);"]);
    Bench::new(&source).run("n=3 | p=3");
}

#[test]
fn ret_leaves_the_routine_when_true() {
    let source = Source::rungs(&["JSR(Sub,0);"])
        .tags("a BOOL; x DINT; y DINT")
        .routine("Sub", &["ADD(x,1,x);", "XIC(a)RET();", "ADD(y,1,y);"]);
    Bench::new(&source).run(
        "a=0 | x=1 y=1
         a=1 | x=2 y=1
         a=0 | x=3 y=2",
    );
}

#[test]
fn the_main_routine_may_return_early() {
    let source = Source::rungs(&["XIC(a)RET();", "ADD(x,1,x);"]).tags("a BOOL; x DINT");
    Bench::new(&source).run("a=1 | x=0\n a=0 | x=1");
}

#[test]
fn a_value_that_was_expected_but_not_returned_is_a_fault() {
    let source = Source::rungs(&["ADD(n,1,n);", "JSR(Sub,0,m);"])
        .tags("a BOOL; n DINT; m DINT")
        .routine("Sub", &["XIC(a)RET(n);"]);
    let mut bench = Bench::new(&source);
    bench.run("a=1 | n=1 m=1\n a=1 | n=2 m=2");
    bench.run("a=1 | n=3 m=3");
    let mut bench = Bench::new(&source);
    assert!(bench.scan_faults(), "the routine ends without RET");
    bench.run("prescan | n=0 m=0");
}

#[test]
fn a_routine_may_be_called_twice_in_a_scan() {
    let source = Source::rungs(&["JSR(Sub,0);", "XIC(again)JSR(Sub,0);"])
        .tags("again BOOL; n DINT")
        .routine("Sub", &["ADD(n,1,n);"]);
    Bench::new(&source).run("again=0 | n=1\n again=1 | n=3");
}

#[test]
fn calls_nest_as_deep_as_the_program_has_routines() {
    let mut source = Source::rungs(&["JSR(R0,0);"]).tags("n DINT");
    for depth in 0..500 {
        let call = format!("JSR(R{},0);", depth + 1);
        source = source.routine(&format!("R{depth}"), &[&call]);
    }
    let source = source.routine("R500", &["ADD(n,1,n);"]);
    Bench::new(&source).run("| n=1\n | n=2");
}

#[test]
fn programs_run_in_the_order_of_the_task_and_unscheduled_ones_never() {
    let source = Source::rungs(&["ADD(n,1,n);"])
        .tags("n DINT; a DINT; b DINT; never DINT")
        .program("B", "", &["ADD(n,10,n);", "MOV(n,b);"], true)
        .program("A", "", &["ADD(n,100,n);", "MOV(n,a);"], true)
        .program("Idle", "", &["ADD(never,1,never);"], false);
    Bench::new(&source).run("| n=111 b=11 a=111 never=0");
}

#[test]
fn a_program_tag_hides_a_controller_tag() {
    let source = Source::rungs(&["MOV(1,x);"])
        .tags("x DINT")
        .program_tags("x DINT")
        .program("Other", "", &["MOV(2,x);"], true);
    let mut bench = Bench::new(&source);
    let names: Vec<&str> = bench.module().types.structs[bench.module().state]
        .fields
        .iter()
        .map(|field| field.name.as_str())
        .collect();
    assert_eq!(names, ["x", "Main.x"]);
    bench.run("| x=2 Main.x=1");
}

#[test]
fn aliases_stand_for_tags_members_bits_and_other_aliases() {
    let source = Source::rungs(&[
        "XIC(start)OTE(lamp);",
        "MOV(5,preset);",
        "XIC(chain)OTE(o);",
    ])
    .tags("w INT; t TIMER; a DINT[3]; o BOOL")
    .alias("start", "w.2")
    .alias("lamp", "w.3")
    .alias("preset", "t.PRE")
    .alias("chain", "link.1")
    .alias("link", "element")
    .alias("element", "a[2]");
    Bench::new(&source).run(
        "w=4 a[2]=2 | w=12 t.PRE=5 o=1
         w=8 a[2]=1 | w=0 o=0",
    );
}

const VALVE: &str = "<DataType Name=\"Valve\" Family=\"NoFamily\" Class=\"User\">\n<Members>\n\
    <Member Name=\"ZZZZZZZZZZValve0\" DataType=\"SINT\" Dimension=\"0\" Radix=\"Decimal\" Hidden=\"true\"/>\n\
    <Member Name=\"Open\" DataType=\"BIT\" Dimension=\"0\" Radix=\"Decimal\" Hidden=\"false\" Target=\"ZZZZZZZZZZValve0\" BitNumber=\"0\"/>\n\
    <Member Name=\"Fault\" DataType=\"BIT\" Dimension=\"0\" Radix=\"Decimal\" Hidden=\"false\" Target=\"ZZZZZZZZZZValve0\" BitNumber=\"1\"/>\n\
    <Member Name=\"Delay\" DataType=\"TIMER\" Dimension=\"0\" Radix=\"NullType\" Hidden=\"false\"/>\n\
    <Member Name=\"Steps\" DataType=\"INT\" Dimension=\"3\" Radix=\"Decimal\" Hidden=\"false\"/>\n\
    </Members>\n</DataType>\n";

#[test]
fn members_of_user_types_are_places_of_their_own() {
    let source = Source::rungs(&[
        "XIC(run)OTE(v[1].Open)TON(v[1].Delay,?,?);",
        "XIO(v[1].Open)OTE(v[1].Fault);",
        "MOV(300,v[0].Steps[2]);",
    ])
    .types(VALVE)
    .tags("run BOOL; v Valve[2]");
    Bench::new(&source).run(
        "run=0 | v[1].Open=0 v[1].Fault=1 v[0].Fault=0
         run=1 | v[1].Open=1 v[1].Fault=0 v[1].Delay.EN=1 v[0].Steps[2]=300 v[1].Steps[2]=0",
    );
}

#[test]
fn exported_values_reach_members_elements_and_presets() {
    let tag = "<Tag Name=\"v\" TagType=\"Base\" DataType=\"Valve\"><Data Format=\"Decorated\">\
        <Structure DataType=\"Valve\"><DataValueMember Name=\"Open\" DataType=\"BOOL\" Value=\"0\"/>\
        <DataValueMember Name=\"Fault\" DataType=\"BOOL\" Value=\"1\"/>\
        <StructureMember Name=\"Delay\" DataType=\"TIMER\"><DataValueMember Name=\"PRE\" DataType=\"DINT\" Value=\"250\"/>\
        <DataValueMember Name=\"ACC\" DataType=\"DINT\" Value=\"7\"/></StructureMember>\
        <ArrayMember Name=\"Steps\" DataType=\"INT\" Dimensions=\"3\" Radix=\"Hex\">\
        <Element Index=\"[0]\" Value=\"16#ffff\"/><Element Index=\"[2]\" Value=\"16#0010\"/></ArrayMember>\
        </Structure></Data></Tag>";
    let source = Source::rungs(&["NOP();"]).types(VALVE).tag_xml(tag);
    Bench::with(&source, &export()).run(
        "prescan | v.Open=0 v.Fault=1 v.Delay.PRE=250 v.Delay.ACC=7 v.Steps[0]=-1 v.Steps[2]=16",
    );
    Bench::new(&source).run("prescan | v.Fault=0 v.Delay.PRE=250 v.Delay.ACC=0 v.Steps[2]=0");
}

#[test]
fn values_without_names_are_read_for_plain_tags_and_timers() {
    let source = Source::rungs(&["NOP();"]).tag_xml(
        "<Tag Name=\"n\" TagType=\"Base\" DataType=\"DINT\"><Data Format=\"L5K\"><![CDATA[12]]></Data></Tag>\
         <Tag Name=\"a\" TagType=\"Base\" DataType=\"INT\" Dimensions=\"2\"><Data Format=\"L5K\"><![CDATA[[3,-4]]]></Data></Tag>\
         <Tag Name=\"c\" TagType=\"Base\" DataType=\"COUNTER\"><Data Format=\"L5K\"><![CDATA[[536870912,9,9]]]></Data></Tag>",
    );
    Bench::with(&source, &export())
        .run("prescan | n=12 a[0]=3 a[1]=-4 c.PRE=9 c.ACC=9 c.DN=1 c.CU=0 c.OV=0");
}

#[test]
fn values_without_names_are_read_in_the_order_of_storage() {
    // The hidden SINT first: bit 0 is Open, bit 1 Fault.
    let source = Source::rungs(&["NOP();"]).types(VALVE).tag_xml(
        "<Tag Name=\"v\" TagType=\"Base\" DataType=\"Valve\"><Data Format=\"L5K\">\
         <![CDATA[[2,[-536870912,500,20],[7,8,9]]]]></Data></Tag>\
         <Tag Name=\"s\" TagType=\"Base\" DataType=\"STRING\"><Data Format=\"L5K\">\
         <![CDATA[[2,'Hi$00$00']]]></Data></Tag>",
    );
    Bench::with(&source, &export()).run(
        "prescan | v.Open=0 v.Fault=1 v.Delay.EN=1 v.Delay.TT=1 v.Delay.DN=1 v.Delay.PRE=500
         prescan | v.Delay.ACC=20 v.Steps[0]=7 v.Steps[2]=9 s.LEN=2 s.DATA[0]=72 s.DATA[1]=105",
    );
    Bench::new(&source).run("prescan | v.Fault=0 v.Delay.PRE=500 v.Delay.ACC=0 s.LEN=0");
}

#[test]
fn a_value_that_cannot_be_read_is_an_error_where_the_tag_is_used() {
    let tag = "<Tag Name=\"n\" TagType=\"Base\" DataType=\"SINT\"><Data Format=\"Decorated\">\
        <DataValue DataType=\"SINT\" Value=\"300\"/></Data></Tag>";
    let unused = Source::rungs(&["NOP();"]).tag_xml(tag);
    assert_eq!(compile_xml(&unused.xml(), &export()).1, []);
    let used = Source::rungs(&["CLR(n)CLR(n);"]).tag_xml(tag);
    assert_eq!(compile_xml(&used.xml(), &export()).1, [Code::E2008]);
    assert_eq!(compile_xml(&used.xml(), &FrontOptions::default()).1, []);
}

fn edited() -> Source {
    Source::new()
        .tags("n DINT")
        .edit("N", "ADD(n,1,n);")
        .edit("IR", "ADD(n,10,n);")
        .edit("R", "ADD(n,100,n);")
        .edit("I", "ADD(n,1000,n);")
        .edit("D", "ADD(n,10000,n);")
        .edit("e", "ADD(n,100000,n);")
}

#[test]
fn pending_edits_run_on_the_side_that_was_active_or_is_asked_for() {
    Bench::new(&edited()).run("| n=10101");
    Bench::new(&edited().test_edits()).run("| n=1011");
    Bench::with(&edited(), &edits(Edits::Test)).run("| n=1011");
    Bench::with(&edited().test_edits(), &edits(Edits::Original)).run("| n=10101");
    let (_, codes) = compile_xml(&edited().xml(), &FrontOptions::default());
    assert_eq!(codes, [Code::E5032]);
}

/// A digital input word with two comments, a digital output word, and an analog input.
const MODULES: &str = "<Module Name=\"Chassis\" ParentModule=\"Local\" ParentModPortId=\"1\"><Ports>\
    <Port Id=\"1\" Address=\"2\" Type=\"Compact\" Upstream=\"true\"/></Ports><Communications><Connections>\
    <Connection Name=\"In\" RPI=\"2000\" Type=\"Input\"><InputTag><Comments>\
    <Comment Operand=\".DATA.0\"><![CDATA[Start button]]></Comment>\
    <Comment Operand=\".DATA.1\"><![CDATA[heater]]></Comment>\
    <Comment Operand=\".DATA.2\"><![CDATA[same]]></Comment>\
    <Comment Operand=\".DATA.3\"><![CDATA[SAME]]></Comment></Comments>\
    <Data Format=\"Decorated\"><Structure DataType=\"AB:DI:I:0\">\
    <DataValueMember Name=\"Fault\" DataType=\"DINT\" Value=\"0\"/>\
    <DataValueMember Name=\"Data\" DataType=\"INT\" Radix=\"Binary\" Value=\"2#0000_0000_0010_0000\"/>\
    </Structure></Data></InputTag></Connection></Connections></Communications></Module>\
    <Module Name=\"Out\" ParentModule=\"Local\" ParentModPortId=\"1\"><Ports>\
    <Port Id=\"1\" Address=\"3\" Type=\"Compact\" Upstream=\"true\"/></Ports><Communications><Connections>\
    <Connection Name=\"Out\" RPI=\"2000\" Type=\"Output\"><OutputTag>\
    <Data Format=\"Decorated\"><Structure DataType=\"AB:DO:O:0\">\
    <DataValueMember Name=\"Data\" DataType=\"INT\" Value=\"0\"/></Structure></Data></OutputTag>\
    </Connection></Connections></Communications></Module>\
    <Module Name=\"Drive\" ParentModule=\"Net\" ParentModPortId=\"2\"><Ports>\
    <Port Id=\"2\" Address=\"10.0.0.5\" Type=\"Ethernet\" Upstream=\"true\"/></Ports><Communications><Connections>\
    <Connection Name=\"Speed\" RPI=\"20000\" Type=\"Input\"><InputTag>\
    <Data Format=\"Decorated\"><Structure DataType=\"AB:Drive:I:0\">\
    <DataValueMember Name=\"Speed\" DataType=\"REAL\" Value=\"0.0\"/></Structure></Data></InputTag>\
    </Connection></Connections></Communications></Module>";

fn fields(bench: &Bench, region: Region) -> Vec<&str> {
    let id: StructId = bench.module().region(region);
    let fields = &bench.module().types.structs[id].fields;
    fields.iter().map(|field| field.name.as_str()).collect()
}

#[test]
fn points_are_named_by_alias_then_comment_then_address() {
    // `heater` is a tag and `same` stands twice, so these comments give no names.
    let source = Source::rungs(&[
        "XIC(Local:2:I.Data.0)XIC(local:2:i.DATA.1)OTE(Lamp);",
        "XIC(Local:2:I.Data.2)XIC(Local:2:I.Data.3)OTE(Local:3:O.Data.4);",
        "GRT(Drive:I.Speed,2.5)OTE(heater);",
    ])
    .modules(MODULES)
    .tags("heater BOOL")
    .alias("Lamp", "Local:3:O.Data.0");
    let mut bench = Bench::new(&source);
    let inputs = fields(&bench, Region::Input);
    assert_eq!(
        inputs,
        [
            "Start_button",
            "Local:2:I.Data.1",
            "Local:2:I.Data.2",
            "Local:2:I.Data.3",
            "Drive:I.Speed"
        ]
    );
    assert_eq!(fields(&bench, Region::Output), ["Lamp", "Local:3:O.Data.4"]);
    bench.run(
        "Start_button=1                          | Lamp=0 heater=0
         Local:2:I.Data.1=1 Drive:I.Speed=3.0    | Lamp=1 heater=1 Local:3:O.Data=1
         Local:2:I.Data.2=1 Local:2:I.Data.3=1   | Local:3:O.Data.4=1 Local:3:O.Data=17",
    );
}

#[test]
fn a_word_used_as_a_whole_is_one_point() {
    let source = Source::rungs(&[
        "MOV(Local:2:I.Data,Local:3:O.Data);",
        "XIC(Local:2:I.Data.5)OTE(Local:3:O.Data.0);",
    ])
    .modules(MODULES);
    let mut bench = Bench::new(&source);
    assert_eq!(fields(&bench, Region::Input), ["Local:2:I.Data"]);
    assert_eq!(fields(&bench, Region::Output), ["Local:3:O.Data"]);
    bench.run(
        "Local:2:I.Data=32 | Local:3:O.Data=33
         Local:2:I.Data=-2 | Local:3:O.Data=-1
         Local:2:I.Data=2  | Local:3:O.Data=2",
    );
}

#[test]
fn an_output_reads_back_what_was_written_and_an_input_is_latched_anew() {
    let source = Source::rungs(&[
        "XIC(Local:2:I.Data.0)OTE(Local:3:O.Data.1);",
        "XIC(Local:3:O.Data.1)OTE(back);",
        "OTU(Local:2:I.Data.0);",
        "XIC(Local:2:I.Data.0)OTE(seen);",
    ])
    .modules(MODULES)
    .tags("back BOOL; seen BOOL");
    Bench::new(&source).run(
        "Start_button=1 | back=1 seen=0 Local:3:O.Data.1=1
                        | back=1 seen=0
         Start_button=0 | back=0",
    );
}

#[test]
fn other_names_lead_to_places() {
    let source = Source::rungs(&["XIC(Local:2:I.Data.0)OTE(x);"])
        .modules(MODULES)
        .program_tags("x BOOL")
        .alias("Go", "Local:2:I.Data.0")
        .alias("unused", "Local:3:O.Data");
    let bench = Bench::new(&source);
    let names: Vec<&str> = bench
        .module()
        .names
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    assert_eq!(names, ["Go", "Main.x", "unused"]);
}

#[test]
fn every_error_of_a_file_is_reported_once() {
    let source = Source::rungs(&[
        "XIC(nothere)OTE(a);",
        "XIC(nothere)OTE(a.1);",
        "TON(a,?,?)CTU(t);",
        "FOO(a)SIN(n,n);",
        "MOV(n,5)MOV(a,n);",
    ])
    .tags("a BOOL; n DINT; t TIMER");
    let (module, codes) = compile_xml(&source.xml(), &FrontOptions::default());
    assert!(module.is_err());
    assert_eq!(
        codes,
        [
            Code::E1001, // nothere, the first time
            Code::E2003, // a BOOL has no bit 1
            Code::E2001, // TON of a BOOL
            Code::E5020, // CTU with one operand
            Code::E1008, // FOO
            Code::E5021, // SIN
            Code::E2001, // 5 is no destination
            Code::E2001, // a BOOL is no number
        ]
    );
}

#[test]
fn what_cannot_be_compiled_is_only_a_warning_where_it_never_runs() {
    let idle = ["SIN(n,n);", "MOV(n[i],n);"];
    let source =
        Source::rungs(&["NOP();"])
            .tags("n DINT; i DINT")
            .program("Idle", "", &idle[..1], false);
    let (module, codes) = compile_xml(&source.xml(), &FrontOptions::default());
    assert!(module.is_ok());
    assert_eq!(codes, [Code::E6023, Code::E5021]);
    // A mistake stays one.
    let source = Source::rungs(&["NOP();"]).tags("n DINT; i DINT").program(
        "Idle",
        "",
        &["MOV(m,n);"],
        false,
    );
    assert!(
        compile_xml(&source.xml(), &FrontOptions::default())
            .0
            .is_err()
    );
}

#[test]
fn recursion_is_refused_with_the_way_it_goes() {
    let source = Source::rungs(&["JSR(A,0);"])
        .routine("A", &["JSR(B,0);"])
        .routine("B", &["JSR(A,0);"]);
    let (module, codes) = compile_xml(&source.xml(), &FrontOptions::default());
    let errors = module.unwrap_err();
    assert!(errors.contains("A -> B -> A"), "{errors}");
    assert_eq!(codes, [Code::E5027]);
}

#[test]
fn five_thousand_rungs_are_compiled() {
    let rungs: Vec<String> = (0..5_000)
        .map(|n| format!("XIC(a[{}])ADD(n,1,n)OTE(a[{}]);", n % 32, (n + 1) % 32))
        .collect();
    let rungs: Vec<&str> = rungs.iter().map(String::as_str).collect();
    let mut bench = Bench::new(&Source::rungs(&rungs).tags("a BOOL[32]; n DINT"));
    bench.run("a[0]=1 | n=5000");
}
