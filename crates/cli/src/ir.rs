//! `iecc ir`: the module of a program as text, as lowered or after a pass.

use crate::messages::Messages;
use crate::program::Program;
use crate::terminal;
use clap::ValueEnum;
use iecc_driver::{After, NoSuchPlace, Pipeline, list_passes, show};

/// Show the step language of a program, as lowered or after a pass
#[derive(Debug, clap::Args)]
#[command(after_help = format!("Passes:\n{}", list_passes()))]
pub(crate) struct Arguments {
    #[command(flatten)]
    program: Program,

    /// Run the pipeline up to the first run of this pass; PASS:2 means its second run
    #[arg(long, value_name = "PASS", value_parser = parse_after)]
    after: Option<After>,

    /// Run this pipeline, to its end unless --after stops it [default with --after: hardware]
    #[arg(long, value_enum)]
    pipeline: Option<PipelineChoice>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum PipelineChoice {
    /// For targets that are hardware
    Hardware,
    /// For engines that run instructions one after the other
    Software,
}

fn parse_after(text: &str) -> Result<After, String> {
    let (pass, run) = text.split_once(':').unwrap_or((text, "1"));
    let run = run.parse().map_err(|_| format!("`{run}` is no number"))?;
    Ok(After {
        pass: pass.to_owned(),
        run,
    })
}

pub(crate) fn run(arguments: &Arguments, messages: &mut Messages) -> Result<(), NoSuchPlace> {
    let Some((compiled, _)) = arguments.program.compile(messages) else {
        return Ok(());
    };
    terminal::print(&show(
        compiled.module,
        arguments.pipeline(),
        arguments.after.as_ref(),
    )?);
    Ok(())
}

impl Arguments {
    fn pipeline(&self) -> Option<Pipeline> {
        match (self.pipeline, &self.after) {
            (Some(PipelineChoice::Hardware), _) | (None, Some(_)) => Some(Pipeline::Hardware),
            (Some(PipelineChoice::Software), _) => Some(Pipeline::Software),
            (None, None) => None,
        }
    }
}
