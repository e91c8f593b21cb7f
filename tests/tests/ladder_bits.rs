//! Ladder bits, one-shots and the flow of condition, each row worked out from the vendor's rules.

use iecc_tests::ladder::{Bench, Source, check};

#[test]
fn contacts_pass_the_bit_or_its_inverse() {
    check(
        "a BOOL; no BOOL; nc BOOL",
        &["XIC(a)OTE(no);", "XIO(a)OTE(nc);"],
        "a=0 | no=0 nc=1
         a=1 | no=1 nc=0",
    );
}

#[test]
fn a_false_rung_clears_ote_but_not_otl_and_otu() {
    check(
        "a BOOL; b BOOL; e BOOL; l BOOL; u BOOL",
        &["XIC(a)OTE(e)OTL(l);", "XIC(b)OTU(l)OTU(u);"],
        "prescan     | l=0 u=0
         u=1         | e=0 l=0 u=1
         a=1         | e=1 l=1 u=1
         a=0         | e=0 l=1
         b=1         | l=0 u=0
         b=0         | l=0 u=0",
    );
}

#[test]
fn prescan_clears_ote_and_keeps_latches() {
    let source =
        Source::rungs(&["AFI()OTE(e)OTL(l)OTU(u);"]).tags("e BOOL = 1; l BOOL = 1; u BOOL = 1");
    let options = iecc_driver::FrontOptions {
        init: iecc_sema::logix::Init::Export,
        ..Default::default()
    };
    Bench::with(&source, &options).run(
        "prescan | e=0 l=1 u=1
                 | e=0 l=1 u=1",
    );
}

#[test]
fn ons_passes_for_one_scan_and_prescan_blocks_a_rung_that_is_true_at_once() {
    check(
        "a BOOL; s BOOL; o BOOL",
        &["XIC(a)ONS(s)OTE(o);"],
        "prescan | s=1
         a=1     | o=0 s=1
         a=1     | o=0 s=1
         a=0     | o=0 s=0
         a=1     | o=1 s=1
         a=1     | o=0 s=1",
    );
}

#[test]
fn two_ons_that_share_a_storage_bit_interact() {
    // The first ONS sets the bit, so the second sees no edge; it clears what the first stored.
    check(
        "a BOOL; b BOOL; s BOOL; x BOOL; y BOOL",
        &["XIC(a)ONS(s)OTE(x);", "XIC(b)ONS(s)OTE(y);"],
        "a=0 b=0 | x=0 y=0 s=0
         a=1 b=1 | x=1 y=0 s=1
         b=0     | x=0 y=0 s=0
         a=1     | x=1 y=0 s=0",
    );
}

#[test]
fn osr_shows_a_rising_edge_and_passes_its_condition_on() {
    check(
        "a BOOL; s BOOL; o BOOL; p BOOL",
        &["XIC(a)OSR(s,o)OTE(p);"],
        "prescan | s=1 o=0
         a=1     | o=0 s=1 p=1
         a=0     | o=0 s=0 p=0
         a=1     | o=1 s=1 p=1
         a=1     | o=0 s=1 p=1",
    );
}

#[test]
fn osf_shows_a_falling_edge() {
    check(
        "a BOOL; s BOOL; o BOOL; p BOOL",
        &["XIC(a)OSF(s,o)OTE(p);"],
        "prescan | s=0 o=0
         a=0     | o=0 s=0
         a=1     | o=0 s=1 p=1
         a=0     | o=1 s=0 p=0
         a=0     | o=0 s=0",
    );
}

#[test]
fn every_leg_of_a_branch_runs_also_behind_a_true_one() {
    check(
        "a BOOL; b BOOL; x BOOL; y BOOL; any BOOL",
        &["[XIC(a)OTE(x) ,XIC(b)OTE(y) ]OTE(any);"],
        "a=1 b=1 | x=1 y=1 any=1
         a=1 b=0 | x=1 y=0 any=1
         a=0 b=1 | x=0 y=1 any=1
         a=0 b=0 | x=0 y=0 any=0",
    );
}

#[test]
fn instructions_of_a_false_branch_run_their_false_path() {
    check(
        "run BOOL; a BOOL; x BOOL; t TIMER PRE=1000",
        &["XIC(run)[OTE(x) ,TON(t,?,?) ];"],
        "run=1  | x=1 t.EN=1
         run=0  | x=0 t.EN=0",
    );
}

#[test]
fn an_empty_leg_is_a_wire() {
    check(
        "n DINT; o BOOL",
        &["[EQU(n,5) , ]OTE(o);"],
        "n=0 | o=1
         n=5 | o=1",
    );
}

#[test]
fn nested_branches_and_a_branch_without_choice() {
    check(
        "a BOOL; b BOOL; c BOOL; o BOOL; p BOOL",
        &[
            "XIC(a)[XIC(b)[XIC(c) ,XIO(c) ] ,XIC(c) ]OTE(o);",
            "[XIC(a) ]OTE(p);",
        ],
        "a=1 b=1 c=0 | o=1 p=1
         a=1 b=0 c=1 | o=1
         a=1 b=0 c=0 | o=0
         a=0 b=1 c=1 | o=0 p=0",
    );
}

#[test]
fn a_contact_behind_a_coil_sees_what_the_coil_did() {
    check(
        "a BOOL; x BOOL; o BOOL; p BOOL",
        &["XIC(a)OTU(x)XIC(x)OTE(o);", "XIC(a)OTL(x)XIC(x)OTE(p);"],
        "a=0 x=1 | o=0 p=0
         a=1 x=1 | o=0 p=1 x=1",
    );
}

#[test]
fn the_last_coil_of_a_bit_wins_and_rungs_between_see_the_first() {
    check(
        "a BOOL; b BOOL; x BOOL; between BOOL",
        &["XIC(a)OTE(x);", "XIC(x)OTE(between);", "XIC(b)OTE(x);"],
        "a=1 b=0 | between=1 x=0
         a=0 b=1 | between=0 x=1",
    );
}

#[test]
fn afi_makes_false_and_nop_passes_on() {
    check(
        "x BOOL; y BOOL; z BOOL",
        &["AFI()OTE(x);", "NOP()OTE(y);", "OTE(z);", "NOP();", ";"],
        "| x=0 y=1 z=1",
    );
}

#[test]
fn mnemonics_and_names_ignore_case() {
    check(
        "Motor BOOL; START BOOL",
        &["xic(Start)Ote(mOTOR);"],
        "START=1 | Motor=1",
    );
}

#[test]
fn bits_of_words_are_read_and_written_one_by_one() {
    check(
        "w INT; d DINT; s SINT; o BOOL",
        &[
            "XIC(w.3)OTE(d.31);",
            "XIC(w.15)OTL(s.7);",
            "XIC(d.31)OTE(o);",
        ],
        "w=8      | d=-2147483648 s=0 o=1
         w=-32768 | d=0 s=-128 o=0
         w=0      | d=0 s=-128",
    );
}

#[test]
fn first_scan_is_true_once() {
    check(
        "n DINT; o BOOL",
        &["XIC(S:FS)ADD(n,1,n);", "XIC(S:FS)OTE(o);"],
        "prescan | n=0
                 | n=1 o=1
         3:      | n=1 o=0",
    );
}
