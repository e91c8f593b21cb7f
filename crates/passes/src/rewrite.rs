//! What several passes do to a function: replace values, drop blocks and parameters.

use cranelift_entity::{SecondaryMap, packed_option::PackedOption};
use iecc_ir::analysis::Cfg;
use iecc_ir::{Function, Target, Terminator, Value};

/// Values that are to be read in place of others. Follows chains, so a replacement may itself be
/// replaced later.
#[derive(Debug, Default)]
pub(crate) struct Replacements {
    map: SecondaryMap<Value, PackedOption<Value>>,
    any: bool,
}

impl Replacements {
    /// Says that `by` is to be read in place of `value`.
    pub(crate) fn replace(&mut self, value: Value, by: Value) {
        let by = self.find(by);
        debug_assert_ne!(value, by, "a value cannot replace itself");
        self.map[value] = by.into();
        self.any = true;
    }

    /// What is to be read for `value`.
    pub(crate) fn find(&mut self, value: Value) -> Value {
        let mut last = value;
        while let Some(next) = self.map[last].expand() {
            last = next;
        }
        let mut at = value;
        while let Some(next) = self.map[at].expand() {
            self.map[at] = last.into();
            at = next;
        }
        last
    }

    /// Replaces every use in the function. Says whether there was something to replace.
    pub(crate) fn apply(mut self, func: &mut Function) -> bool {
        if self.any {
            func.map_uses(|value| self.find(value));
        }
        self.any
    }
}

/// Takes the blocks the entry does not lead to out of the layout. Says whether there were any.
pub(crate) fn remove_unreachable(func: &mut Function) -> bool {
    let before = func.layout.len();
    let cfg = Cfg::new(func);
    func.layout.retain(|&block| cfg.is_reachable(block));
    func.layout.len() != before
}

/// Whether a function has a loop.
pub(crate) fn goes_back(func: &Function) -> bool {
    // Without branches there is none.
    if func.layout.len() == 1 {
        return matches!(func.terminator(func.entry()), Terminator::Jump(_));
    }
    Cfg::new(func).jumps_back().next().is_some()
}

/// Makes all returns jump to one.
pub(crate) fn join_returns(func: &mut Function) {
    let returns: Vec<_> = func
        .layout
        .iter()
        .copied()
        .filter(|&block| matches!(func.terminator(block), Terminator::Return(_)))
        .collect();
    if returns.len() < 2 {
        return;
    }
    let join = func.add_block();
    let results = func.results.clone();
    let params = results.iter().map(|&ty| func.add_param(join, ty)).collect();
    func.set_terminator(join, Terminator::Return(params), None);
    for block in returns {
        let origin = func.block(block).terminator_origin;
        let Terminator::Return(args) = func.terminator(block).clone() else {
            panic!("only returns are joined")
        };
        let jump = Terminator::Jump(Target { block: join, args });
        func.set_terminator(block, jump, origin);
    }
}
