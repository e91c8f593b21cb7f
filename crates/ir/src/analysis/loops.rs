//! Natural loops: a header and all blocks that reach a jump back to it without passing it.

use super::{Cfg, Dominators};
use crate::Block;
use std::collections::BTreeSet;

/// One loop. Loops that share a header are one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Loop {
    /// The block every way into the loop passes.
    pub header: Block,
    /// Blocks that jump back to the header.
    pub latches: Vec<Block>,
    /// All blocks of the loop, header included.
    pub blocks: BTreeSet<Block>,
}

/// All loops of a function.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Loops {
    /// Natural loops, by header in reverse postorder.
    pub natural: Vec<Loop>,
    /// A jump back to a block that does not dominate its source: the graph is irreducible.
    pub irreducible: Option<(Block, Block)>,
}

impl Loops {
    /// Finds the loops of a function.
    pub fn new(cfg: &Cfg, dominators: &Dominators) -> Self {
        let mut loops = Self::default();
        let order = cfg.reverse_postorder();
        let mut position = cranelift_entity::SecondaryMap::with_default(0usize);
        for (index, &block) in order.iter().enumerate() {
            position[block] = index;
        }
        for &header in order {
            let back = cfg.predecessors(header).iter().copied();
            let back =
                back.filter(|&from| cfg.is_reachable(from) && position[from] >= position[header]);
            let (latches, entries): (Vec<_>, Vec<_>) =
                back.partition(|&from| dominators.dominates(header, from));
            if let Some(&from) = entries.first() {
                loops.irreducible.get_or_insert((from, header));
            }
            if !latches.is_empty() {
                let blocks = body(cfg, header, &latches);
                loops.natural.push(Loop {
                    header,
                    latches,
                    blocks,
                });
            }
        }
        loops
    }

    /// Whether the function has no loop of any kind.
    pub fn is_empty(&self) -> bool {
        self.natural.is_empty() && self.irreducible.is_none()
    }
}

fn body(cfg: &Cfg, header: Block, latches: &[Block]) -> BTreeSet<Block> {
    let mut blocks = BTreeSet::from([header]);
    let mut stack = latches.to_vec();
    while let Some(block) = stack.pop() {
        if blocks.insert(block) {
            stack.extend(
                cfg.predecessors(block)
                    .iter()
                    .filter(|&&b| cfg.is_reachable(b)),
            );
        }
    }
    blocks
}
