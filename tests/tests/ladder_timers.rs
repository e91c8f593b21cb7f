//! Timers and counters in ladder, each row worked out from the vendor's rules.

use iecc_driver::{FrontOptions, TimerBase};
use iecc_sema::logix::Init;
use iecc_tests::ladder::{Bench, Source, check};

const EXPORT: Init = Init::Export;

fn exported(tags: &str, rungs: &[&str], script: &str) {
    let options = FrontOptions {
        init: EXPORT,
        ..FrontOptions::default()
    };
    Bench::with(&Source::rungs(rungs).tags(tags), &options).run(script);
}

#[test]
fn ton_delays_switching_on() {
    // The enabling scan adds no time. ACC stops where it reached PRE.
    check(
        "a BOOL; t TIMER PRE=25",
        &["XIC(a)TON(t,?,?);"],
        "prescan | t.EN=0 t.TT=0 t.DN=0 t.ACC=0 t.PRE=25
         a=0     | t.EN=0 t.TT=0 t.DN=0 t.ACC=0
         a=1     | t.EN=1 t.TT=1 t.DN=0 t.ACC=0
                 | t.EN=1 t.TT=1 t.DN=0 t.ACC=10
                 | t.EN=1 t.TT=1 t.DN=0 t.ACC=20
                 | t.EN=1 t.TT=0 t.DN=1 t.ACC=30
         3:      | t.EN=1 t.TT=0 t.DN=1 t.ACC=30
         a=0     | t.EN=0 t.TT=0 t.DN=0 t.ACC=0",
    );
}

#[test]
fn ton_passes_its_condition_on() {
    check(
        "a BOOL; o BOOL; t TIMER PRE=25",
        &["XIC(a)TON(t,?,?)OTE(o);"],
        "a=1 | o=1 t.DN=0
         a=0 | o=0",
    );
}

#[test]
fn a_preset_of_0_is_done_in_the_first_true_scan() {
    check(
        "a BOOL; t TIMER",
        &["XIC(a)TON(t,?,?);"],
        "a=0 | t.DN=0
         a=1 | t.EN=1 t.TT=0 t.DN=1 t.ACC=0",
    );
}

#[test]
fn a_preset_reached_exactly_is_done() {
    check(
        "a BOOL; t TIMER PRE=10",
        &["XIC(a)TON(t,?,?);"],
        "a=1 | t.TT=1 t.DN=0
             | t.TT=0 t.DN=1 t.ACC=10",
    );
}

#[test]
fn writing_dn_pauses_a_ton() {
    // TT stays as it was; the time of the pause is not added afterwards.
    check(
        "a BOOL; t TIMER PRE=1000",
        &["XIC(a)TON(t,?,?);"],
        "a=1     | t.ACC=0
                 | t.ACC=10
         t.DN=1  | t.ACC=10 t.EN=1 t.TT=1 t.DN=1
         5:      | t.ACC=10
         t.DN=0  | t.ACC=20 t.DN=0",
    );
}

#[test]
fn a_preset_may_change_while_timing() {
    check(
        "a BOOL; t TIMER PRE=1000",
        &["XIC(a)TON(t,?,?);"],
        "a=1      |
                  | t.ACC=10 t.DN=0
         t.PRE=15 | t.ACC=20 t.DN=1",
    );
}

#[test]
fn the_accumulator_stops_at_the_largest_number() {
    check(
        "a BOOL; t TIMER PRE=2147483647",
        &["XIC(a)TON(t,?,?);"],
        "a=1              | t.ACC=0
         t.ACC=2147483640 | t.ACC=2147483647 t.DN=1 t.TT=0
                          | t.ACC=2147483647 t.DN=1",
    );
}

#[test]
fn fractions_of_a_unit_are_not_lost() {
    // Scans 10 ms apart but for one: boundaries of whole milliseconds are counted.
    check(
        "a BOOL; t TIMER PRE=1000",
        &["XIC(a)TON(t,?,?);"],
        "a=1   | t.ACC=0
         +1ms  | t.ACC=1
         +100ms| t.ACC=101
               | t.ACC=111",
    );
}

#[test]
fn rto_keeps_what_it_accumulated() {
    check(
        "a BOOL; r BOOL; t TIMER PRE=25",
        &["XIC(a)RTO(t,?,?);", "XIC(r)RES(t);"],
        "a=1 | t.EN=1 t.TT=1 t.ACC=0
             | t.ACC=10
         a=0 | t.EN=0 t.TT=0 t.DN=0 t.ACC=10
         3:  | t.ACC=10
         a=1 | t.EN=1 t.TT=1 t.ACC=10
             | t.ACC=20 t.DN=0
             | t.ACC=30 t.DN=1 t.TT=0
         a=0 | t.EN=0 t.TT=0 t.DN=1 t.ACC=30
         r=1 | t.ACC=0 t.DN=0 t.PRE=25",
    );
}

#[test]
fn prescan_keeps_the_accumulator_of_rto_and_done_returns_with_the_rung() {
    exported(
        "a BOOL; t TIMER PRE=25 ACC=30 EN=1 DN=1",
        &["XIC(a)RTO(t,?,?);"],
        "prescan | t.EN=0 t.TT=0 t.DN=0 t.ACC=30
         a=0     | t.DN=0 t.ACC=30
         a=1     | t.EN=1 t.DN=1 t.TT=0 t.ACC=30",
    );
}

#[test]
fn prescan_resets_ton() {
    exported(
        "a BOOL; t TIMER PRE=25 ACC=30 EN=1 DN=1",
        &["XIC(a)TON(t,?,?);"],
        "prescan | t.EN=0 t.TT=0 t.DN=0 t.ACC=0 t.PRE=25",
    );
}

#[test]
fn tof_delays_switching_off() {
    // The falling scan only starts; the comparison comes with the next.
    check(
        "a BOOL; t TIMER PRE=15",
        &["XIC(a)TOF(t,?,?);"],
        "prescan | t.EN=0 t.TT=0 t.DN=0 t.ACC=15
         2:      | t.EN=0 t.TT=0 t.DN=0 t.ACC=15
         a=1     | t.EN=1 t.TT=0 t.DN=1 t.ACC=0
                 | t.EN=1 t.TT=0 t.DN=1 t.ACC=0
         a=0     | t.EN=0 t.TT=1 t.DN=1 t.ACC=0
                 | t.EN=0 t.TT=1 t.DN=1 t.ACC=10
                 | t.EN=0 t.TT=0 t.DN=0 t.ACC=20
                 | t.EN=0 t.TT=0 t.DN=0 t.ACC=20
         a=1     | t.EN=1 t.DN=1 t.ACC=0",
    );
}

#[test]
fn tof_starts_anew_when_the_rung_is_true_again() {
    check(
        "a BOOL; t TIMER PRE=100",
        &["XIC(a)TOF(t,?,?);"],
        "a=1 | t.DN=1
         a=0 | t.ACC=0
         2:  | t.DN=1 t.TT=1
         a=1 | t.ACC=0 t.TT=0 t.DN=1
         a=0 | t.ACC=0 t.TT=1
             | t.ACC=10",
    );
}

#[test]
fn tof_with_a_preset_of_0_is_off_one_scan_after_falling() {
    check(
        "a BOOL; t TIMER",
        &["XIC(a)TOF(t,?,?);"],
        "a=1 | t.DN=1
         a=0 | t.DN=1 t.TT=1
             | t.DN=0 t.TT=0",
    );
}

#[test]
fn a_timer_in_a_routine_that_is_not_called_catches_up() {
    let source = Source::rungs(&["XIC(call)JSR(Sub,0);"])
        .tags("call BOOL; t TIMER PRE=1000")
        .routine("Sub", &["TON(t,?,?);"]);
    Bench::new(&source).run(
        "call=1 | t.ACC=0 t.EN=1
                | t.ACC=10
         call=0 | t.ACC=10 t.EN=1 t.TT=1
         2:     | t.ACC=10
         call=1 | t.ACC=50",
    );
}

#[test]
fn timers_may_count_other_units() {
    let source = Source::rungs(&["TON(slow,?,?);", "TON(fast,?,?);"])
        .tags("slow TIMER PRE=1000; fast TIMER PRE=100000");
    let options = FrontOptions {
        timer_base: TimerBase {
            timers: vec![("FAST".to_owned(), 1_000)],
            ..TimerBase::default()
        },
        ..FrontOptions::default()
    };
    Bench::with(&source, &options).run(
        "| slow.ACC=0 fast.ACC=0
         | slow.ACC=10 fast.ACC=10000",
    );
}

#[test]
fn a_preset_in_the_operand_counts_only_where_the_tag_has_no_data() {
    check(
        "a BOOL; t TIMER; u TIMER PRE=5; c COUNTER",
        &[
            "XIC(a)TON(t,20,0);",
            "XIC(a)TON(u,20,0);",
            "XIC(a)CTU(c,7,0);",
        ],
        "prescan | t.PRE=20 u.PRE=5 c.PRE=7",
    );
}

#[test]
fn ctu_counts_rising_conditions_beyond_its_preset() {
    check(
        "a BOOL; c COUNTER PRE=2",
        &["XIC(a)CTU(c,?,?);"],
        "prescan | c.CU=1 c.ACC=0 c.DN=0
         a=0     | c.CU=0 c.ACC=0
         a=1     | c.CU=1 c.ACC=1 c.DN=0
         2:      | c.CU=1 c.ACC=1 c.DN=0
         a=0     | c.CU=0 c.ACC=1
         a=1     | c.ACC=2 c.DN=1
         a=0     | c.ACC=2 c.DN=1
         a=1     | c.ACC=3 c.DN=1",
    );
}

#[test]
fn ctu_does_not_count_a_rung_that_is_true_in_the_first_scan() {
    check(
        "a BOOL; c COUNTER PRE=2",
        &["XIC(a)CTU(c,?,?);"],
        "a=1 | c.ACC=0 c.CU=1
         a=0 | c.ACC=0
         a=1 | c.ACC=1",
    );
}

#[test]
fn ctu_sets_done_again_when_the_preset_changes_on_a_false_rung() {
    check(
        "a BOOL; c COUNTER PRE=2",
        &["XIC(a)CTU(c,?,?);"],
        "a=0        | c.DN=0
         c.PRE=0    | c.DN=1
         c.PRE=1    | c.DN=0",
    );
}

#[test]
fn ctu_wraps_into_overflow_which_forces_done() {
    check(
        "a BOOL; c COUNTER PRE=5",
        &["XIC(a)CTU(c,?,?);"],
        "a=0                  |
         c.ACC=2147483647 a=1 | c.ACC=-2147483648 c.OV=1 c.UN=0 c.DN=1
         a=0                  | c.OV=1 c.DN=1",
    );
}

#[test]
fn ctd_counts_down_and_underflow_clears_done() {
    check(
        "a BOOL; c COUNTER PRE=-1",
        &["XIC(a)CTD(c,?,?);"],
        "prescan               | c.CD=1
         a=0                   | c.CD=0 c.ACC=0 c.DN=1
         a=1                   | c.CD=1 c.ACC=-1 c.DN=1
         a=0                   | c.CD=0
         a=1                   | c.ACC=-2 c.DN=0
         a=0                   |
         c.ACC=-2147483648 a=1 | c.ACC=2147483647 c.UN=1 c.OV=0 c.DN=0",
    );
}

#[test]
fn overflow_and_underflow_undo_each_other() {
    check(
        "up BOOL; down BOOL; c COUNTER PRE=0",
        &["XIC(up)CTU(c,?,?);", "XIC(down)CTD(c,?,?);"],
        "                      |
         c.ACC=2147483647 up=1 | c.ACC=-2147483648 c.OV=1 c.UN=0 c.DN=1
         down=1                | c.ACC=2147483647 c.OV=0 c.UN=0 c.DN=1
         down=0 up=0           |
         c.ACC=-2147483648 down=1 | c.ACC=2147483647 c.OV=0 c.UN=1 c.DN=0
         up=1                  | c.ACC=-2147483648 c.OV=0 c.UN=0 c.DN=0",
    );
}

#[test]
fn res_clears_a_counter_and_a_rung_that_stays_true_counts_again() {
    check(
        "a BOOL; r BOOL; c COUNTER PRE=1",
        &["XIC(a)CTU(c,?,?);", "XIC(r)RES(c);"],
        "        |
         a=1     | c.ACC=1 c.DN=1
         r=1     | c.ACC=0 c.DN=0 c.CU=0 c.PRE=1
         r=0     | c.ACC=1 c.CU=1 c.DN=1",
    );
}

#[test]
fn res_clears_a_control_but_its_length() {
    exported(
        "r BOOL; c CONTROL LEN=9 POS=4 EN=1 DN=1 ER=1",
        &["XIC(r)RES(c);"],
        "r=0 | c.POS=4 c.EN=1 c.DN=1
         r=1 | c.LEN=9 c.POS=0 c.EN=0 c.DN=0 c.ER=0",
    );
}

#[test]
fn a_cold_start_keeps_presets_and_constants_only() {
    let constant = "<Tag Name=\"k\" TagType=\"Base\" DataType=\"DINT\" Constant=\"true\">\
        <Data Format=\"Decorated\"><DataValue DataType=\"DINT\" Value=\"7\"/></Data></Tag>";
    let source = Source::rungs(&["NOP();"])
        .tags("n DINT = 5; t TIMER PRE=25 ACC=3; c COUNTER PRE=9 ACC=4; x CONTROL LEN=8 POS=2")
        .tag_xml(constant);
    Bench::new(&source).run("prescan | n=0 t.PRE=25 t.ACC=0 c.PRE=9 c.ACC=0 x.LEN=8 x.POS=0 k=7");
    let options = FrontOptions {
        init: EXPORT,
        ..FrontOptions::default()
    };
    Bench::with(&source, &options)
        .run("prescan | n=5 t.PRE=25 t.ACC=3 c.PRE=9 c.ACC=4 x.LEN=8 x.POS=2 k=7");
}
