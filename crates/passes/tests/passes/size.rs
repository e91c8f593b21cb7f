//! Programs of awkward shape stay small: work and results grow with the program, not faster.

use crate::check::{module, same_behaviour};
use iecc_ir::Module;
use iecc_passes::{CHANGE_STATE, HARDWARE, Settings, run};
use std::fmt::Write;

/// Instructions of the scan after the passes for hardware.
fn hardware_size(before: &Module) -> usize {
    let mut after = before.clone();
    let keep = HARDWARE.iter().filter(|name| !CHANGE_STATE.contains(name));
    for pass in keep {
        run(pass, &mut after, &Settings::default()).unwrap();
    }
    same_behaviour(before, &after, true, "at the end");
    let scan = &after.funcs[after.scan];
    assert_eq!(scan.layout.len(), 1);
    scan.block(scan.entry()).insts.len()
}

/// `n[i] := i; IF x < i THEN RETURN`, again and again: each store depends on all branches before it.
fn early_returns(count: usize) -> Module {
    let end = count + 1;
    let mut text = format!(
        "module m\nstate {{ n: [{count} x i32] }}\ninput {{ x: i32 }}\noutput {{ }}\nscan @scan\n\
         fn @scan[]() -> () {{\nb0:\n  v0: i32 = load input.x\n  jump b1\n"
    );
    for step in 0..count {
        let (block, number, less) = (step + 1, 2 * step + 1, 2 * step + 2);
        let next = block + 1;
        writeln!(
            text,
            "b{block}:\n  v{number}: i32 = const {step}\n  store state.n[{step}], v{number}\n  \
             v{less}: i1 = slt v0, v{number}\n  brif v{less}, b{last}, b{next}",
            last = end + 1,
        )
        .unwrap();
    }
    writeln!(
        text,
        "b{end}:\n  jump b{last}\nb{last}:\n  return\n}}",
        last = end + 1
    )
    .unwrap();
    module(&text)
}

#[test]
fn a_chain_of_early_returns_grows_with_its_length_only() {
    let sizes = [20, 40].map(|count| hardware_size(&early_returns(count)));
    assert!(sizes[1] < 2 * sizes[0] + 20, "{sizes:?}");
}

/// Every choice between two sums depends on the one before: written out by path, 2^40 sums.
#[test]
fn choices_after_choices_do_not_multiply() {
    let mut text = String::from(
        "module m\nstate { n: i32 }\ninput { c: [40 x i1], x: i32 }\noutput { y: i32 }\nscan @scan\n\
         fn @scan[]() -> () {\nb0:\n  v0: i32 = load input.x\n  jump b1(v0)\n",
    );
    for step in 0..40 {
        let (block, arm, value) = (2 * step + 1, 2 * step + 2, 3 * step + 1);
        let (next, cond, sum) = (block + 2, value + 1, value + 2);
        writeln!(
            text,
            "b{block}(v{value}: i32):\n  v{cond}: i1 = load input.c[{step}]\n  \
             brif v{cond}, b{arm}, b{next}(v{value})\n\
             b{arm}:\n  v{sum}: i32 = mul v{value}, v{value}\n  jump b{next}(v{sum})"
        )
        .unwrap();
    }
    text += "b81(v121: i32):\n  store output.y, v121\n  return\n}\n";
    let size = hardware_size(&module(&text));
    // A load, a product and a choice for each; the first load and the store.
    assert_eq!(size, 3 * 40 + 2);
}
