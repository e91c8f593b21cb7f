//! Wires the pipeline.

pub mod run;
