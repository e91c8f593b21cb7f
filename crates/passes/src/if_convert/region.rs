//! The blocks between a block and its immediate dominator, without those inside inner choices.

use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::{Cfg, Dominators};
use iecc_ir::{Block, Function, Terminator, Value};
use std::collections::BTreeMap;

/// Order and dominance, forwards and backwards, of a function without loops and faults and with
/// one return.
#[derive(Debug)]
pub(super) struct Regions {
    cfg: Cfg,
    dominators: Dominators,
    position: SecondaryMap<Block, usize>,
    /// By position: that of the closest block through which every way on leads.
    follower: Vec<usize>,
}

impl Regions {
    /// Computes them. Reverse postorder is a topological order here and ends with the return.
    pub(super) fn of(func: &Function) -> Self {
        let cfg = Cfg::new(func);
        let dominators = Dominators::new(&cfg);
        let order = cfg.reverse_postorder();
        let mut position = SecondaryMap::new();
        for (index, &block) in order.iter().enumerate() {
            position[block] = index;
        }
        let mut follower = vec![order.len() - 1; order.len()];
        for index in (0..order.len() - 1).rev() {
            let successors = cfg.successors(order[index]).iter();
            let common = successors
                .map(|&block| position[block])
                .reduce(|a, b| meeting_point(&follower, a, b));
            follower[index] = common.expect("only the last block returns");
        }
        Self {
            cfg,
            dominators,
            position,
            follower,
        }
    }

    /// All blocks, each behind its predecessors.
    pub(super) fn order(&self) -> &[Block] {
        self.cfg.reverse_postorder()
    }

    /// The immediate dominator of a block other than the entry.
    pub(super) fn dominator(&self, block: Block) -> Block {
        self.dominators
            .immediate(block)
            .expect("a block other than the entry")
    }

    /// Whether every scan runs the block.
    pub(super) fn always_runs(&self, block: Block) -> bool {
        let last = *self.order().last().expect("functions have an entry");
        self.dominators.dominates(block, last)
    }

    /// Whether every way on from `block` leads through `later`, and through nothing closer.
    pub(super) fn follows(&self, block: Block, later: Block) -> bool {
        self.follower[self.position[block]] == self.position[later]
    }

    /// The ways from `start` to `goal`, which it dominates immediately.
    pub(super) fn walk(
        &self,
        terminators: &SecondaryMap<Block, Option<Terminator>>,
        start: Block,
        goal: Block,
    ) -> Walk {
        let mut ways = Vec::new();
        let mut exits_of: BTreeMap<usize, Vec<Exit>> = BTreeMap::new();
        let mut pending = vec![self.position[start]];
        while let Some(at) = pending.pop() {
            if exits_of.contains_key(&at) {
                continue;
            }
            let exits = self.exits(terminators, at, goal, &mut ways);
            pending.extend(exits.iter().filter_map(|exit| match exit {
                Exit::Step(position) => Some(*position),
                Exit::Goal(_) | Exit::Missed => None,
            }));
            exits_of.insert(at, exits);
        }
        // The last first, so that every step stands behind those it leads to.
        let index: BTreeMap<usize, usize> = exits_of.keys().rev().copied().zip(0..).collect();
        let steps = exits_of.into_iter().rev().map(|(at, mut exits)| {
            for exit in &mut exits {
                if let Exit::Step(position) = exit {
                    *exit = Exit::Step(index[position]);
                }
            }
            Step {
                block: self.order()[at],
                exits,
            }
        });
        Walk {
            steps: steps.collect(),
            ways,
        }
    }

    /// A block that tells the ways apart: if it ran, the way taken is one of those with the given
    /// mark, else one of the others. All with the mark come through it, and the others come from
    /// blocks before it, which it cannot reach. Tries the closest candidates.
    pub(super) fn split(&self, walk: &Walk, marks: &[bool]) -> Option<(Block, bool)> {
        let from = |mark: bool| {
            let ways = walk.ways.iter().zip(marks);
            ways.filter(move |(_, m)| **m == mark)
                .map(|((block, _), _)| *block)
        };
        [true, false].into_iter().find_map(|mark| {
            let first = from(mark).min_by_key(|&block| self.position[block])?;
            let candidates = [Some(first), self.dominators.immediate(first)];
            let splits = |block: &Block| {
                from(mark).all(|way| self.dominators.dominates(*block, way))
                    && from(!mark).all(|way| self.position[way] < self.position[*block])
            };
            let found = candidates.into_iter().flatten().find(splits);
            found.map(|block| (block, mark))
        })
    }

    /// Where the targets of a block lead, with positions for steps. A block whose ways all meet
    /// again before the goal leads to where they meet.
    fn exits(
        &self,
        terminators: &SecondaryMap<Block, Option<Terminator>>,
        at: usize,
        goal: Block,
        ways: &mut Vec<(Block, usize)>,
    ) -> Vec<Exit> {
        let goal_position = self.position[goal];
        if self.follower[at] < goal_position {
            return vec![Exit::Step(self.follower[at])];
        }
        let block = self.order()[at];
        let terminator = terminators[block].as_ref().expect("blocks have an end");
        let exits = terminator.targets().into_iter().enumerate();
        let exits = exits.map(|(index, target)| {
            if target.block == goal {
                ways.push((block, index));
                Exit::Goal(ways.len() - 1)
            } else if self.position[target.block] > goal_position {
                Exit::Missed
            } else {
                Exit::Step(self.position[target.block])
            }
        });
        exits.collect()
    }
}

/// The closest block that follows both, like the common dominator of two blocks.
fn meeting_point(follower: &[usize], mut a: usize, mut b: usize) -> usize {
    while a != b {
        if a < b {
            a = follower[a];
        } else {
            b = follower[b];
        }
    }
    a
}

/// Where a target leads.
#[derive(Debug, Clone, Copy)]
pub(super) enum Exit {
    /// Into the goal, by this way.
    Goal(usize),
    /// To this step of the walk.
    Step(usize),
    /// Past the goal.
    Missed,
}

/// A block on the way, with one exit for each of its targets, or one for all.
#[derive(Debug)]
pub(super) struct Step {
    pub(super) block: Block,
    pub(super) exits: Vec<Exit>,
}

/// The ways from a block to a later one.
#[derive(Debug)]
pub(super) struct Walk {
    steps: Vec<Step>,
    ways: Vec<(Block, usize)>,
}

impl Walk {
    /// Every step behind those it leads to; the start is the last.
    pub(super) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// How many jumps lead into the goal.
    pub(super) fn ways_in(&self) -> usize {
        self.ways.len()
    }

    /// What each way passes for a parameter of the goal.
    pub(super) fn arguments<'t>(
        &'t self,
        terminators: &'t SecondaryMap<Block, Option<Terminator>>,
        param: usize,
    ) -> impl Iterator<Item = Value> + 't {
        self.ways.iter().map(move |&(block, target)| {
            let terminator = terminators[block].as_ref().expect("blocks have an end");
            terminator.targets()[target].args[param]
        })
    }
}
