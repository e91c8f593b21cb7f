//! `WHILE c DO body` becomes `IF c THEN REPEAT body UNTIL NOT c`: one jump a round instead of two.
//!
//! The header, which only computes and compares, stays in front of the loop; a copy of it goes behind the
//! body, which becomes a loop of one block. What the header computed and the body reads becomes a parameter
//! of the body.

use iecc_ir::analysis::{Cfg, Loop, Loops};
use iecc_ir::{Block, Function, InstData, Target, Terminator, Value};
use std::collections::{HashMap, HashSet};

/// Most instructions of a header that is copied.
const MAX_HEADER: usize = 8;

/// Rotates every loop of a header and one other block. Says whether there was one.
pub(super) fn rotate(func: &mut Function, cfg: &Cfg, loops: &Loops) -> bool {
    let mut changed = false;
    for each in &loops.natural {
        if let Some(shape) = Shape::of(func, cfg, each) {
            shape.write(func);
            changed = true;
        }
    }
    changed
}

/// A header, the body it leads to, and where else it leads.
struct Shape {
    header: Block,
    body: Block,
    /// Whether the body is run if the condition holds.
    body_if: bool,
}

impl Shape {
    fn of(func: &Function, cfg: &Cfg, each: &Loop) -> Option<Self> {
        let header = each.header;
        let &[body] = each.latches.as_slice() else {
            return None;
        };
        let Terminator::Brif {
            then, otherwise, ..
        } = func.terminator(header)
        else {
            return None;
        };
        let body_if = then.block == body;
        let exit = if body_if { otherwise } else { then };
        let insts = &func.block(header).insts;
        let fits = each.blocks.len() == 2
            && body != header
            && (body_if || otherwise.block == body)
            && exit.block != body
            && cfg.predecessors(body) == [header]
            && func.block(body).params.is_empty()
            && matches!(func.terminator(body), Terminator::Jump(_))
            && insts.len() <= MAX_HEADER
            && insts.iter().all(|&inst| func.inst(inst).is_pure());
        let shape = Self {
            header,
            body,
            body_if,
        };
        (fits && shape.is_closed(func)).then_some(shape)
    }

    /// What the header defines, parameters first.
    fn defined(&self, func: &Function) -> Vec<Value> {
        let data = func.block(self.header);
        let results = data.insts.iter().flat_map(|&inst| func.results_of(inst));
        data.params.iter().chain(results).copied().collect()
    }

    /// Whether only the header and the body read what the header defines, and nobody else what the
    /// body defines. The way out takes what it needs as arguments.
    fn is_closed(&self, func: &Function) -> bool {
        let mut own: HashSet<Value> = self.defined(func).into_iter().collect();
        for &inst in &func.block(self.body).insts {
            own.extend(func.results_of(inst));
        }
        let outside = func
            .layout
            .iter()
            .filter(|&&block| block != self.header && block != self.body);
        let mut outside = outside.copied();
        outside.all(|block| {
            let data = func.block(block);
            let by_inst = data.insts.iter().flat_map(|&inst| func.inst(inst).values());
            let mut read = by_inst.chain(func.terminator(block).values());
            read.all(|value| !own.contains(&value))
        })
    }

    fn write(&self, func: &mut Function) {
        // What the header defines is passed to the body, but for constants, which are the same always.
        let defined = self.defined(func);
        let (params, body) = (func.block(self.header).params.clone(), self.body);
        let passed: Vec<Value> = defined
            .into_iter()
            .filter(|&v| func.constant(v).is_none())
            .collect();
        let types: Vec<_> = passed.iter().map(|&v| func.value_type(v)).collect();
        let inside: Vec<Value> = types
            .into_iter()
            .map(|ty| func.add_param(body, ty))
            .collect();
        let as_param: HashMap<Value, Value> = passed.iter().copied().zip(inside).collect();
        read_as(func, body, &as_param);
        let Terminator::Jump(back) = func.terminator(body).clone() else {
            panic!("the body jumps back")
        };
        // The header once more, behind the body, with what the body passed back.
        let mut again: HashMap<Value, Value> = params.into_iter().zip(back.args).collect();
        for inst in func.block(self.header).insts.clone() {
            let mut data = func.inst(inst).clone();
            data.map_values(|value| again.get(&value).copied().unwrap_or(value));
            let result = func.result(inst);
            if matches!(data, InstData::Const { .. }) {
                continue;
            }
            let (ty, origin) = (func.value_type(result), func.origin(inst));
            let copy = func.append_inst(body, data, &[ty], origin);
            again.insert(result, func.result(copy));
        }
        let mut terminator = func.terminator(self.header).clone();
        self.pass(&mut terminator, &passed);
        let origin = func.block(self.header).terminator_origin;
        func.set_terminator(self.header, terminator.clone(), origin);
        terminator.map_values(|value| again.get(&value).copied().unwrap_or(value));
        func.set_terminator(body, terminator, origin);
    }

    /// Adds arguments to the jump to the body.
    fn pass(&self, terminator: &mut Terminator, passed: &[Value]) {
        let Terminator::Brif {
            then, otherwise, ..
        } = terminator
        else {
            panic!("the header branches")
        };
        let target: &mut Target = if self.body_if { then } else { otherwise };
        target.args.extend(passed);
    }
}

/// Reads other values in one block.
fn read_as(func: &mut Function, block: Block, by: &HashMap<Value, Value>) {
    let read = |value: Value| by.get(&value).copied().unwrap_or(value);
    for inst in func.block(block).insts.clone() {
        func.inst_mut(inst).map_values(read);
    }
    let mut terminator = func.terminator(block).clone();
    terminator.map_values(read);
    let origin = func.block(block).terminator_origin;
    func.set_terminator(block, terminator, origin);
}
