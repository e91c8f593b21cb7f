//! The blocks of the standard library against the state machines that define them, over random
//! inputs: skipped scans, two calls in a scan, presets that change, times of scans that do not.

use iecc_tests::rng::Rng;
use iecc_tests::st_run::{Scan, run};

/// Compares what a program gives with what a model gives, scan for scan, on all engines.
fn compare(text: &str, inputs: &[&str], outputs: &[&str], scans: &[Scan], model: &[Vec<u64>]) {
    run(text, inputs, outputs, scans, |engine, index, values| {
        let given: Vec<u64> = values.iter().map(|value| value[0]).collect();
        assert_eq!(given, model[index], "{engine} scan {index} of\n{text}");
    });
}

/// A timer as the reference state machines of the standard's diagrams have it.
#[derive(Default)]
struct Timer {
    running: bool,
    /// TP: the pulse is over, the input still TRUE. TOF: the input was TRUE.
    armed: bool,
    before: bool,
    started: i64,
    q: bool,
    et: i64,
}

impl Timer {
    fn start(&mut self, now: i64) {
        (self.running, self.started) = (true, now);
    }

    /// ET as time goes on; whether it is over.
    fn passes(&mut self, now: i64, preset: i64) -> bool {
        let over = now - self.started >= preset;
        self.et = if over { preset } else { now - self.started };
        over
    }

    fn pulse(&mut self, now: i64, input: bool, preset: i64) {
        if !self.running && !self.armed && input && !self.before {
            self.start(now);
            (self.et, self.q) = (0, true);
        }
        if self.running && self.passes(now, preset) {
            (self.running, self.armed, self.q) = (false, true, false);
        }
        if self.armed && !input {
            (self.armed, self.et) = (false, 0);
        }
        self.before = input;
    }

    fn on_delay(&mut self, now: i64, input: bool, preset: i64) {
        if !input {
            (self.running, self.q, self.et) = (false, false, 0);
            return;
        }
        if !self.running {
            self.start(now);
            self.q = false;
        }
        if !self.q {
            self.q = self.passes(now, preset);
        }
    }

    fn off_delay(&mut self, now: i64, input: bool, preset: i64) {
        if input {
            (self.running, self.armed, self.q, self.et) = (false, true, true, 0);
            return;
        }
        if !self.armed {
            return;
        }
        if !self.running {
            self.start(now);
        }
        if self.passes(now, preset) {
            (self.armed, self.running, self.q) = (false, false, false);
        }
    }

    fn values(&self) -> Vec<u64> {
        vec![u64::from(self.q), self.et as u64]
    }
}

fn below(rng: &mut Rng, bound: usize) -> u64 {
    rng.below(bound) as u64
}

/// Random scans of a timer: the input, the preset in ns, and how often it is called.
fn timer_scans(seed: u64) -> Vec<Scan> {
    let mut rng = Rng::new(seed);
    let (mut now_ns, mut input, mut preset) = (1_000 + below(&mut rng, 1_000), 0, 5);
    let mut scans = Vec::new();
    for _ in 0..400 {
        now_ns += if below(&mut rng, 5) == 0 {
            below(&mut rng, 30)
        } else {
            below(&mut rng, 4)
        };
        if below(&mut rng, 4) == 0 {
            input = below(&mut rng, 2);
        }
        if below(&mut rng, 12) == 0 {
            preset = below(&mut rng, 20) as i64 - 3;
        }
        let calls = [0, 1, 1, 1, 1, 2][below(&mut rng, 6) as usize];
        scans.push(Scan {
            now_ns,
            inputs: vec![input, preset as u64, calls],
        });
    }
    scans
}

#[test]
fn timers_are_the_reference_state_machines() {
    type Step = fn(&mut Timer, i64, bool, i64);
    let kinds: [(&str, Step); 3] = [
        ("TP", Timer::pulse),
        ("TON", Timer::on_delay),
        ("TOF", Timer::off_delay),
    ];
    for (name, step) in kinds {
        for (suffix, time) in [("", "TIME"), ("_TIME", "TIME"), ("_LTIME", "LTIME")] {
            let text = format!(
                "PROGRAM Main\nVAR_INPUT x : BOOL; p : {time}; n : INT; END_VAR\n\
                 VAR t : {name}{suffix}; i : INT; END_VAR\n\
                 FOR i := 1 TO n DO t(IN := x, PT := p); END_FOR;\nEND_PROGRAM\n"
            );
            for seed in 0..6 {
                let scans = timer_scans(seed);
                let mut timer = Timer::default();
                let mut model = Vec::new();
                for scan in &scans {
                    let preset = (scan.inputs[1] as i64).max(0);
                    for _ in 0..scan.inputs[2] {
                        step(&mut timer, scan.now_ns as i64, scan.inputs[0] == 1, preset);
                    }
                    model.push(timer.values());
                }
                compare(&text, &["x", "p", "n"], &["t.Q", "t.ET"], &scans, &model);
            }
        }
    }
}

/// Random scans with bits that change now and then.
fn bit_scans(seed: u64, bits: usize) -> Vec<Scan> {
    let mut rng = Rng::new(seed);
    let mut inputs = vec![0; bits];
    let mut scans = Vec::new();
    for scan in 0..300 {
        for input in &mut inputs {
            if below(&mut rng, 3) == 0 {
                *input = below(&mut rng, 2);
            }
        }
        scans.push(Scan {
            now_ns: scan * 1_000_000,
            inputs: inputs.clone(),
        });
    }
    scans
}

#[test]
fn counters_count_edges_up_to_the_limits_of_their_type() {
    let kinds: [(&str, i128, i128); 5] = [
        ("INT", -32_768, 32_767),
        ("DINT", i128::from(i32::MIN), i128::from(i32::MAX)),
        ("LINT", i128::from(i64::MIN), i128::from(i64::MAX)),
        ("UDINT", 0, i128::from(u32::MAX)),
        ("ULINT", 0, i128::from(u64::MAX)),
    ];
    for (ty, least, largest) in kinds {
        // Presets at both limits and between, so that counting meets the limits too.
        for preset in [2, least + 1, largest - 1] {
            let text = format!(
                "PROGRAM Main\nVAR_INPUT u, d, r, l : BOOL; END_VAR\n\
                 VAR a : CTU_{ty}; b : CTD_{ty}; c : CTUD_{ty}; END_VAR\n\
                 a(CU := u, R := r, PV := {preset});\n\
                 b(CD := d, LD := l, PV := {preset});\n\
                 c(CU := u, CD := d, R := r, LD := l, PV := {preset});\nEND_PROGRAM\n"
            );
            let scans = bit_scans(preset as u64, 4);
            let (mut before, mut up, mut down, mut both) = ([0, 0], 0_i128, 0_i128, 0_i128);
            let mut model = Vec::new();
            for scan in &scans {
                let [u, d, r, l] = scan.inputs[..] else {
                    unreachable!("four bits");
                };
                let (rises, falls) = (u > before[0], d > before[1]);
                before = [u, d];
                up = if r == 1 {
                    0
                } else {
                    (up + i128::from(rises)).min(largest)
                };
                down = if l == 1 {
                    preset
                } else {
                    (down - i128::from(falls)).max(least)
                };
                both = match (r, l) {
                    (1, _) => 0,
                    (_, 1) => preset,
                    _ if rises && falls => both,
                    _ => (both + i128::from(rises) - i128::from(falls)).clamp(least, largest),
                };
                let mask = u64::MAX >> (64 - (largest - least).ilog2() - 1);
                let bits = |value: i128| value as u64 & mask;
                let flag = |value: bool| u64::from(value);
                model.push(vec![
                    bits(up),
                    flag(up >= preset),
                    bits(down),
                    flag(down <= 0),
                    bits(both),
                    flag(both >= preset),
                    flag(both <= 0),
                ]);
            }
            let outputs = ["a.CV", "a.Q", "b.CV", "b.Q", "c.CV", "c.QU", "c.QD"];
            compare(&text, &["u", "d", "r", "l"], &outputs, &scans, &model);
        }
    }
}

#[test]
fn bistables_and_edges_follow_their_equations() {
    let text = "PROGRAM Main\nVAR_INPUT s, r : BOOL; END_VAR\n\
                VAR a : SR; b : RS; c : R_TRIG; d : F_TRIG; END_VAR\n\
                a(SET1 := s, R := r);\nb(S := s, RESET1 := r);\nc(CLK := s);\nd(CLK := s);\n\
                END_PROGRAM\n";
    let scans = bit_scans(7, 2);
    let (mut set, mut reset, mut rose, mut fell) = (false, false, false, false);
    let mut model = Vec::new();
    for scan in &scans {
        let (s, r) = (scan.inputs[0] == 1, scan.inputs[1] == 1);
        set = s || !r && set;
        reset = !r && (s || reset);
        let (up, down) = (s && !rose, !s && !fell);
        (rose, fell) = (s, !s);
        model.push([set, reset, up, down].map(u64::from).to_vec());
    }
    compare(
        text,
        &["s", "r"],
        &["a.Q1", "b.Q1", "c.Q", "d.Q"],
        &scans,
        &model,
    );
}
