//! Pipelines of passes, and the text of a module after any of them.

use iecc_ir::{Module, print_module};
use iecc_passes::{HARDWARE, HARDWARE_SPEED, PASSES, SOFTWARE, Settings, run_pipeline};
use std::fmt;
use std::ops::Range;

/// A list of passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pipeline {
    /// For targets that are hardware.
    Hardware,
    /// For hardware, after that: keeps more state to be faster.
    HardwareSpeed,
    /// For engines that run instructions one after the other.
    Software,
}

impl Pipeline {
    /// The names of its passes, in order.
    pub fn passes(self) -> &'static [&'static str] {
        match self {
            Self::Hardware => HARDWARE,
            Self::HardwareSpeed => HARDWARE_SPEED,
            Self::Software => SOFTWARE,
        }
    }

    /// Runs all of it.
    pub(crate) fn run(self, module: &mut Module, settings: &Settings) {
        run_passes(module, self.passes(), settings);
    }

    /// Runs some of the passes that a module goes through.
    pub(crate) fn run_part(self, module: &mut Module, part: Range<usize>, settings: &Settings) {
        run_passes(module, &self.whole()[part], settings);
    }

    /// All passes a module goes through on the way to an engine or target.
    fn whole(self) -> Vec<&'static str> {
        match self {
            Self::Hardware | Self::HardwareSpeed => [HARDWARE, HARDWARE_SPEED].concat(),
            Self::Software => SOFTWARE.to_vec(),
        }
    }
}

fn run_passes(module: &mut Module, passes: &[&str], settings: &Settings) {
    run_pipeline(module, passes, settings, &mut |_, _| {})
        .expect("pipelines list passes that exist");
}

/// A place in a pipeline: after this run of this pass.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct After {
    /// The pass.
    pub pass: String,
    /// Which of its runs, from 1.
    pub run: usize,
}

/// The pipeline has no such place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoSuchPlace {
    pipeline: Pipeline,
    after: After,
}

impl fmt::Display for NoSuchPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let After { pass, run } = &self.after;
        let passes = self.pipeline.whole();
        let runs = passes.iter().filter(|name| *name == pass);
        match runs.count() {
            0 => write!(f, "the pipeline has no pass `{pass}`; ")?,
            runs => write!(f, "the pipeline runs `{pass}` {runs} times, not {run}; ")?,
        }
        write!(f, "it is {}", passes.join(", "))
    }
}

impl std::error::Error for NoSuchPlace {}

/// Prints a module: as it is, or after a pipeline, run to its end or to the place given. For hardware
/// one scan runs in every clock of 50 MHz.
///
/// # Errors
/// The pipeline has no such place.
pub fn show(
    mut module: Module,
    pipeline: Option<Pipeline>,
    after: Option<&After>,
) -> Result<String, NoSuchPlace> {
    if let Some(pipeline) = pipeline {
        let passes = pipeline.whole();
        let end = match after {
            None => passes.len(),
            Some(after) => place(&passes, after).ok_or_else(|| NoSuchPlace {
                pipeline,
                after: after.clone(),
            })?,
        };
        pipeline.run_part(&mut module, 0..end, &Settings::default());
    }
    Ok(print_module(&module))
}

/// How many passes run up to a place.
fn place(passes: &[&str], after: &After) -> Option<usize> {
    let mut runs = (1..).zip(passes).filter(|(_, name)| **name == after.pass);
    runs.nth(after.run.checked_sub(1)?).map(|(count, _)| count)
}

/// Every pass with what it does, a line each.
pub fn list_passes() -> String {
    let width = PASSES.iter().map(|pass| pass.name.len()).max().unwrap_or(0);
    let line = |pass: &iecc_passes::Pass| format!("{:width$}  {}\n", pass.name, pass.what);
    PASSES.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::{After, Pipeline, show};
    use iecc_ir::parse_module;

    #[test]
    fn a_module_is_shown_after_all_passes_and_after_each() {
        let text = "module m\nscan @scan\n\nfn @scan[]() -> () {\nb0:\n  return\n}\n";
        let module = parse_module(text).expect("it is well-formed");
        for pipeline in [
            Pipeline::Hardware,
            Pipeline::HardwareSpeed,
            Pipeline::Software,
        ] {
            let whole = show(module.clone(), Some(pipeline), None).expect("the pipeline ends");
            let (pass, run) = {
                let passes = pipeline.whole();
                let last = *passes.last().expect("there are passes");
                let runs = passes.iter().filter(|pass| **pass == last).count();
                (last.to_owned(), runs)
            };
            let after = show(module.clone(), Some(pipeline), Some(&After { pass, run }));
            assert_eq!(after.as_deref(), Ok(whole.as_str()), "{pipeline:?}");
        }
    }
}
