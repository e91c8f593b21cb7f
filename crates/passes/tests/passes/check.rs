//! One check for every pass: text before, text after; both keep the verifier's rules and do the
//! same when interpreted.

use iecc_interp::Interpreter;
use iecc_ir::{Layout, MemType, Module, Place, Region, Root, Type};
use iecc_ir::{parse_module, print_module, verify};
use iecc_passes::{CHANGE_STATE, Settings, run};
use iecc_target::{Engine, region_bytes};

/// Scans that are compared, and fuel for each: a program that loops for ever does so in both.
const SCANS: usize = 40;
const FUEL: u64 = 100_000;

/// Parses and verifies a module.
pub(crate) fn module(text: &str) -> Module {
    let module = parse_module(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(verify(&module).err(), None, "{text}");
    module
}

/// Runs passes in order. After each the verifier's rules hold and the module does what the text
/// says.
pub(crate) fn optimised(passes: &[&str], text: &str) -> Module {
    let before = module(text);
    let mut after = before.clone();
    let mut same_state = true;
    for pass in passes {
        run(pass, &mut after, &Settings::default()).unwrap();
        same_state &= !CHANGE_STATE.contains(pass);
        same_behaviour(&before, &after, same_state, &format!("after {pass}"));
    }
    after
}

/// The module after the passes must print as `header` and `after`.
pub(crate) fn check(passes: &[&str], header: &str, before: &str, after: &str) {
    let found = optimised(passes, &format!("{header}{before}"));
    let expected = print_module(&module(&format!("{header}{after}")));
    let found = print_module(&found);
    assert!(found == expected, "found:\n{found}\nexpected:\n{expected}");
}

/// Interprets both with the same inputs and times, many of them at the edges of their types, and
/// compares faults, outputs, and on demand the state.
pub(crate) fn same_behaviour(before: &Module, after: &Module, same_state: bool, when: &str) {
    let text = || {
        format!(
            "{when}:\n{}\nbefore:\n{}",
            print_module(after),
            print_module(before)
        )
    };
    let verified = verify(after).unwrap_or_else(|errors| panic!("{errors:?}\n{}", text()));
    let mut old = Interpreter::new(verify(before).expect("verified before")).with_fuel(FUEL);
    let mut new = Interpreter::new(verified).with_fuel(FUEL);
    let mut random = Random(1);
    let mut outputs = [Region::Output; 2].map(|region| region_bytes(before, region));
    let mut now_ns = 0;
    for scan in 0..SCANS {
        let inputs = random_inputs(before, &mut random);
        let results = [
            old.step(now_ns, &inputs, &mut outputs[0]),
            new.step(now_ns, &inputs, &mut outputs[1]),
        ];
        let codes = results.map(|result| result.map_err(|fault| fault.code));
        assert_eq!(codes[0], codes[1], "fault of scan {scan} {}", text());
        assert_eq!(outputs[0], outputs[1], "outputs of scan {scan} {}", text());
        if same_state {
            assert_eq!(
                old.state(),
                new.state(),
                "state after scan {scan} {}",
                text()
            );
        }
        now_ns += random.below(5_000_000);
    }
}

fn random_inputs(module: &Module, random: &mut Random) -> Vec<u8> {
    let layout = Layout::new(&module.types);
    let mut bytes = region_bytes(module, Region::Input);
    let start = Place::root(Root::Input);
    let mut write = |_: &Place, offset: u64, ty: Type| {
        let value = random.bits(ty).to_le_bytes();
        let (offset, width) = (offset as usize, ty.bytes() as usize);
        bytes[offset..offset + width].copy_from_slice(&value[..width]);
    };
    let ty = MemType::Struct(module.input);
    layout.for_each_leaf(&module.types, &start, ty, &mut write);
    bytes
}

/// Numbers that are the same in every run (xorshift64*).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, limit: u64) -> u64 {
        (self.next() >> 33) % limit
    }

    /// Bits of a value, mostly small or at an edge.
    fn bits(&mut self, ty: Type) -> u64 {
        let any = self.next();
        let edge = ty.mask() >> 1;
        let bits = match self.below(8) {
            0 => 0,
            1 => u64::MAX,
            2 => edge,
            3 => edge + 1,
            4 => any,
            5 if ty == Type::F32 => u64::from(1.5f32.to_bits()),
            5 if ty == Type::F64 => (-2.0f64).to_bits(),
            _ => any % 9,
        };
        bits & ty.mask()
    }
}
