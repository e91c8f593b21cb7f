//! Cuts the tests of a program into parts, each a program of its own with a bounded state.
//!
//! Every test has instances of its own, and engines copy the state for every test: with all tests in
//! one program that would take the square of their number.

use crate::front::{check_tests, lowered};
use crate::{FrontOptions, Sources, Tests};
use iecc_diag::Diagnostics;
use iecc_ir::Module;
use iecc_sema::hir::{self, StructId, Type, Types};
use iecc_sema::st::testing::{Suite, Test};
use iecc_source::SourceMap;
use std::collections::BTreeMap;
use std::ops::Range;

/// How large the state of a part may be, if it runs more than one test.
const PART_BYTES: u64 = 8 << 20;

/// Some of the tests, by position, and the module that runs them.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub(super) tests: Range<usize>,
    pub(super) module: Module,
}

/// Compiles the tests of a program; `None` after mistakes.
pub(super) fn compile(
    map: &SourceMap,
    sources: &Sources,
    options: &FrontOptions,
    diagnostics: &mut Diagnostics,
) -> Option<(Vec<Part>, Suite)> {
    let run = |tests| FrontOptions {
        tests,
        ..options.clone()
    };
    let all = run(Tests::RUN_ALL);
    let (program, suite) = check_tests(map, sources, &all, diagnostics)?;
    let mut parts = Vec::new();
    let ranges = ranges(&program, &suite.tests);
    if let [tests] = &ranges[..] {
        let (tests, module) = (tests.clone(), lowered(&program, &all, diagnostics)?);
        parts.push(Part { tests, module });
        return Some((parts, suite));
    }
    drop(program);
    for tests in ranges {
        let some = run(Tests::Run {
            first: tests.start as u32,
            count: tests.len() as u32,
        });
        // Messages are those of the first time.
        let mut known = Diagnostics::new();
        let (program, _) = check_tests(map, sources, &some, &mut known)?;
        let module = lowered(&program, &some, &mut known)?;
        parts.push(Part { tests, module });
    }
    Some((parts, suite))
}

/// The tests of each part.
fn ranges(program: &hir::Program, tests: &[Test]) -> Vec<Range<usize>> {
    let mut sizes = Sizes::default();
    let mut ranges: Vec<Range<usize>> = Vec::new();
    let mut bytes = 0;
    for (position, test) in tests.iter().enumerate() {
        let tag = test.tag.expect("all tests are in the program");
        let more = sizes.of(&program.types, program.tag(tag).ty);
        match ranges.last_mut() {
            Some(last) if bytes + more <= PART_BYTES => {
                last.end = position + 1;
                bytes += more;
            }
            Some(_) | None => {
                ranges.push(position..position + 1);
                bytes = more;
            }
        }
    }
    ranges
}

/// About how many bytes types take, without what is between members.
#[derive(Default)]
struct Sizes {
    structs: BTreeMap<StructId, u64>,
}

impl Sizes {
    /// Recursion is bounded by the nesting of types.
    fn of(&mut self, types: &Types, ty: Type) -> u64 {
        match ty {
            Type::Elementary(elementary) => u64::from(elementary.bits().div_ceil(8)),
            Type::Array(id) => {
                let array = types.array_def(id);
                u64::from(array.len).saturating_mul(self.of(types, array.element))
            }
            Type::Struct(id) => match self.structs.get(&id) {
                Some(&known) => known,
                None => {
                    let members = types.struct_def(id).members.iter();
                    let bytes = members.fold(0, |bytes: u64, member| {
                        bytes.saturating_add(self.of(types, member.ty))
                    });
                    self.structs.insert(id, bytes);
                    bytes
                }
            },
        }
    }
}
