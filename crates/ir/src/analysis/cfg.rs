//! Predecessors and reverse postorder.

use crate::{Block, Function};
use cranelift_entity::{EntitySet, SecondaryMap};
use smallvec::SmallVec;

/// The control flow graph of a function as it stood when computed.
#[derive(Debug, Clone)]
pub struct Cfg {
    predecessors: SecondaryMap<Block, SmallVec<[Block; 2]>>,
    successors: SecondaryMap<Block, SmallVec<[Block; 2]>>,
    order: Vec<Block>,
    reachable: EntitySet<Block>,
}

impl Cfg {
    /// Computes the graph. Blocks without terminator have no successors.
    pub fn new(func: &Function) -> Self {
        let mut cfg = Self {
            predecessors: SecondaryMap::new(),
            successors: SecondaryMap::new(),
            order: Vec::new(),
            reachable: EntitySet::new(),
        };
        cfg.predecessors.resize(func.block_count());
        cfg.successors.resize(func.block_count());
        for &block in &func.layout {
            let Some(terminator) = &func.block(block).terminator else {
                continue;
            };
            for target in terminator.targets() {
                // All jumps of a block are entered in one go, so a second one finds it last.
                if cfg.predecessors[target.block].last() != Some(&block) {
                    cfg.successors[block].push(target.block);
                    cfg.predecessors[target.block].push(block);
                }
            }
        }
        cfg.walk(func);
        cfg
    }

    fn walk(&mut self, func: &Function) {
        let Some(&entry) = func.layout.first() else {
            return;
        };
        // Last successor first, so that in the reversed order the first one comes first.
        let mut stack = vec![(entry, self.successors[entry].len())];
        self.reachable.insert(entry);
        while let Some((block, left)) = stack.pop() {
            if left == 0 {
                self.order.push(block);
                continue;
            }
            stack.push((block, left - 1));
            let successor = self.successors[block][left - 1];
            if self.reachable.insert(successor) {
                stack.push((successor, self.successors[successor].len()));
            }
        }
        self.order.reverse();
    }

    /// Blocks that jump to `block`, each once, in layout order.
    pub fn predecessors(&self, block: Block) -> &[Block] {
        &self.predecessors[block]
    }

    /// Blocks that `block` jumps to, each once, in text order.
    pub fn successors(&self, block: Block) -> &[Block] {
        &self.successors[block]
    }

    /// Reachable blocks in reverse postorder: the entry first, and without loops every block
    /// after its predecessors.
    pub fn reverse_postorder(&self) -> &[Block] {
        &self.order
    }

    /// Reachable blocks that jump to themselves or to a block before them in reverse postorder.
    /// Without loops there are none.
    pub fn jumps_back(&self) -> impl Iterator<Item = Block> + '_ {
        let mut position = SecondaryMap::with_default(0);
        for (index, &block) in self.order.iter().enumerate() {
            position[block] = index;
        }
        self.order.iter().copied().filter(move |&block| {
            let mut successors = self.successors[block].iter();
            successors.any(|&to| position[to] <= position[block])
        })
    }

    /// Whether the entry leads to the block.
    pub fn is_reachable(&self, block: Block) -> bool {
        self.reachable.contains(block)
    }
}
