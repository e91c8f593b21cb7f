//! The switches of the back end.

use crate::board::Board;
use crate::clock::Clock;
use iecc_ir::analysis::Ranges;
use iecc_ir::{Origin, Place};
use std::collections::BTreeMap;

/// Everything that shapes the hardware besides the program.
#[derive(Debug, Clone)]
pub struct Options {
    /// Frequency of `clk`; one scan runs in every clock.
    pub clock: Clock,
    /// The base tick in nanoseconds from which coarser units are counted. Without it the finest unit
    /// the program uses is the base. It changes the hardware, never the results.
    pub tick_ns: Option<u64>,
    /// What values and registers can hold; narrows them. Must be true for this module and for
    /// steps up to [`max_step`](crate::max_step).
    pub ranges: Ranges,
    /// Two registers in front of every input. Only a simulator leaves them out.
    pub synchronisers: bool,
    /// The board to make pins and a project for.
    pub board: Option<Board>,
    /// Tags the passes found to be constant, and their values; for the report.
    pub constants: Vec<(String, String)>,
    /// Why a register is as narrow as it is; for the report.
    pub reasons: BTreeMap<Place, String>,
    /// Source text and comments to print above what they became.
    pub source_comments: BTreeMap<Origin, String>,
    /// Bytes of the input region for each scan the testbench replays.
    pub stimulus: Vec<Vec<u8>>,
}

impl Options {
    /// The usual switches at a clock: synchronisers, no board, no knowledge about ranges.
    pub fn new(clock: Clock) -> Self {
        Self {
            clock,
            tick_ns: None,
            ranges: Ranges::default(),
            synchronisers: true,
            board: None,
            constants: Vec::new(),
            reasons: BTreeMap::new(),
            source_comments: BTreeMap::new(),
            stimulus: Vec::new(),
        }
    }
}
