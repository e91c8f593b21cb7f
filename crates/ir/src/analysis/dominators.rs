//! Dominator tree, after Cooper, Harvey, Kennedy, "A Simple, Fast Dominance Algorithm" (2001).

use super::Cfg;
use crate::Block;
use cranelift_entity::SecondaryMap;

const UNREACHABLE: u32 = u32::MAX;

/// Which blocks every way from the entry passes. Unreachable blocks dominate nothing and are
/// dominated by nothing.
#[derive(Debug, Clone)]
pub struct Dominators {
    /// Position in reverse postorder, or `UNREACHABLE`.
    position: SecondaryMap<Block, u32>,
    /// Immediate dominator by position; the entry's is itself.
    immediate: Vec<u32>,
    /// Numbers of entering and leaving each block, by position, in a walk over the tree: a block
    /// dominates those whose interval lies in its own. Chains of thousands of blocks are common,
    /// so climbing them for every question would be quadratic.
    interval: Vec<(u32, u32)>,
    order: Vec<Block>,
}

impl Dominators {
    /// Computes the tree.
    pub fn new(cfg: &Cfg) -> Self {
        let order = cfg.reverse_postorder().to_vec();
        let mut position = SecondaryMap::with_default(UNREACHABLE);
        for (index, &block) in order.iter().enumerate() {
            position[block] = index as u32;
        }
        let immediate = vec![UNREACHABLE; order.len()];
        let mut dominators = Self {
            position,
            immediate,
            interval: Vec::new(),
            order,
        };
        if !dominators.order.is_empty() {
            dominators.immediate[0] = 0;
            while dominators.improve(cfg) {}
        }
        dominators.number();
        dominators
    }

    /// A block stands behind its immediate dominator in reverse postorder. So sizes of subtrees
    /// add up backwards, and forwards each block takes its share of the dominator's interval.
    fn number(&mut self) {
        let count = self.order.len();
        let mut size = vec![1; count];
        for index in (1..count).rev() {
            size[self.immediate[index] as usize] += size[index];
        }
        let mut free = vec![0; count];
        self.interval = vec![(0, 0); count];
        for index in 0..count {
            let dominator = self.immediate[index] as usize;
            let start = if index == 0 { 0 } else { free[dominator] };
            free[dominator] = start + size[index];
            free[index] = start + 1;
            self.interval[index] = (start, start + size[index]);
        }
    }

    fn improve(&mut self, cfg: &Cfg) -> bool {
        let mut changed = false;
        for index in 1..self.order.len() {
            let predecessors = cfg.predecessors(self.order[index]).iter();
            let known = predecessors
                .map(|&block| self.position[block])
                .filter(|&p| p != UNREACHABLE && self.immediate[p as usize] != UNREACHABLE);
            let common = known
                .reduce(|a, b| self.intersect(a, b))
                .expect("reachable block");
            changed |= self.immediate[index] != common;
            self.immediate[index] = common;
        }
        changed
    }

    fn intersect(&self, mut a: u32, mut b: u32) -> u32 {
        while a != b {
            while a > b {
                a = self.immediate[a as usize];
            }
            while b > a {
                b = self.immediate[b as usize];
            }
        }
        a
    }

    /// The closest block that dominates `block`, other than itself; `None` for the entry and for
    /// unreachable blocks.
    pub fn immediate(&self, block: Block) -> Option<Block> {
        match self.position[block] {
            0 | UNREACHABLE => None,
            position => Some(self.order[self.immediate[position as usize] as usize]),
        }
    }

    /// Whether every way from the entry to `b` passes `a`. A reachable block dominates itself.
    pub fn dominates(&self, a: Block, b: Block) -> bool {
        let (a, b) = (self.position[a], self.position[b]);
        if a == UNREACHABLE || b == UNREACHABLE {
            return false;
        }
        let (start, end) = self.interval[a as usize];
        (start..end).contains(&self.interval[b as usize].0)
    }

    /// The closest block that dominates both reachable blocks.
    pub fn common(&self, a: Block, b: Block) -> Block {
        self.order[self.intersect(self.position[a], self.position[b]) as usize]
    }
}
