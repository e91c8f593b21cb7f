//! Which blocks lie apart from the rest of the machine code.
//!
//! In a loop, what goes into an inner loop lies behind everything else if a round may also leave that out: a
//! round without the inner loop then goes straight on and jumps once, and a jump more is nothing for a round
//! with it.

use cranelift_entity::{EntitySet, SecondaryMap};
use iecc_ir::analysis::{Cfg, Dominators, Loop, Loops};
use iecc_ir::{Block, Function, Terminator};

/// The blocks of a function that lie apart.
pub(crate) fn blocks_aside(
    func: &Function,
    cfg: &Cfg,
    dominators: &Dominators,
    loops: &Loops,
) -> EntitySet<Block> {
    let mut headers = EntitySet::new();
    headers.extend(loops.natural.iter().map(|each| each.header));
    let mut loop_of_side = SecondaryMap::<Block, Option<&Loop>>::new();
    for outer in &loops.natural {
        for side in sides(func, cfg, dominators, outer, &headers) {
            loop_of_side[side] = Some(outer);
        }
    }
    // Closest dominators come first.
    let mut aside = EntitySet::new();
    for &block in cfg.reverse_postorder() {
        let above = dominators.immediate(block).and_then(|b| loop_of_side[b]);
        if let Some(outer) = above.filter(|outer| outer.blocks.contains(&block)) {
            loop_of_side[block] = Some(outer);
        }
        if loop_of_side[block].is_some() {
            aside.insert(block);
        }
    }
    aside
}

/// Where the branches of a loop go into one of its inner loops, if their other way does not.
fn sides(
    func: &Function,
    cfg: &Cfg,
    dominators: &Dominators,
    outer: &Loop,
    headers: &EntitySet<Block>,
) -> Vec<Block> {
    let leading_in = leading_in(dominators, outer, headers);
    // The condition of the inner loop itself is no choice: most rounds go into it.
    let is_side = |side: Block, from: Block| {
        cfg.predecessors(side) == [from] && !headers.contains(side) && leading_in.contains(side)
    };
    let mut found = Vec::new();
    for &from in &outer.blocks {
        let Terminator::Brif {
            then, otherwise, ..
        } = func.terminator(from)
        else {
            continue;
        };
        for (side, other) in [(then, otherwise), (otherwise, then)].map(|(a, b)| (a.block, b.block))
        {
            let stays = outer.blocks.contains(&other) && !leading_in.contains(other);
            if stays && outer.blocks.contains(&side) && is_side(side, from) {
                found.push(side);
            }
        }
    }
    found
}

/// The blocks of a loop that dominate the header of an inner loop.
fn leading_in(
    dominators: &Dominators,
    outer: &Loop,
    headers: &EntitySet<Block>,
) -> EntitySet<Block> {
    let mut leading = EntitySet::new();
    let inner = outer.blocks.iter().copied();
    for header in inner.filter(|&block| block != outer.header && headers.contains(block)) {
        let mut at = Some(header);
        while let Some(block) = at.filter(|&block| block != outer.header && leading.insert(block)) {
            at = dominators.immediate(block);
        }
    }
    leading
}

#[cfg(test)]
mod tests {
    use super::*;
    use iecc_ir::parse_module;

    /// The numbers of the blocks of `@s` that lie apart.
    fn aside(body: &str) -> Vec<usize> {
        let text = format!(
            "module m\nstate {{ n: i32, a: [9 x i1] }}\nscan @s\nfn @s[]() -> () {{\n{body}}}\n"
        );
        let module = parse_module(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let func = &module.funcs[module.scan];
        let cfg = Cfg::new(func);
        let dominators = Dominators::new(&cfg);
        let loops = Loops::new(&cfg, &dominators);
        let aside = blocks_aside(func, &cfg, &dominators, &loops);
        let blocks = func.layout.iter().enumerate();
        let apart = blocks.filter(|&(_, &block)| aside.contains(block));
        apart.map(|(number, _)| number).collect()
    }

    /// Rounds of b1 either go to b5 at once, or through b2, b3 (a loop of its own) and b4.
    #[test]
    fn what_goes_into_an_inner_loop_lies_apart() {
        let text = "b0:
  v0: i32 = const 1
  jump b1(v0)
b1(v1: i32):
  v2: i1 = load state.a[v1]
  brif v2, b5, b2
b2:
  v3: i32 = add v1, v1
  jump b3(v3)
b3(v4: i32):
  v5: i32 = add v4, v1
  v6: i1 = slt v5, v1
  brif v6, b3(v5), b4
b4:
  store state.n, v5
  jump b5
b5:
  v7: i32 = add v1, v0
  v8: i1 = slt v7, v0
  brif v8, b1(v7), b6
b6:
  return
";
        assert_eq!(aside(text), [2, 3, 4]);
    }

    /// b1 only asks whether the loop b2 is entered; without it, b0 to b3 lie as they are written.
    #[test]
    fn a_loop_behind_its_own_condition_stays() {
        let text = "b0:
  v0: i32 = const 1
  jump b1(v0)
b1(v1: i32):
  v2: i1 = load state.a[v1]
  brif v2, b3, b2(v1)
b2(v3: i32):
  v4: i32 = add v3, v1
  v5: i1 = slt v4, v1
  brif v5, b2(v4), b3
b3:
  v6: i32 = add v1, v0
  v7: i1 = slt v6, v0
  brif v7, b1(v6), b4
b4:
  return
";
        assert_eq!(aside(text), [0; 0]);
    }

    /// Both ways of b1 go into a loop, and outside of loops nothing is worth moving.
    #[test]
    fn a_branch_stays_if_no_way_is_shorter() {
        let text = "b0:
  v0: i32 = const 1
  v1: i1 = load state.a[0]
  brif v1, b7, b1(v0)
b1(v2: i32):
  v3: i1 = load state.a[v2]
  brif v3, b2, b4
b2:
  jump b3
b3:
  v4: i1 = load state.a[1]
  brif v4, b3, b6
b4:
  jump b5
b5:
  v5: i1 = load state.a[2]
  brif v5, b5, b6
b6:
  v6: i32 = add v2, v0
  v7: i1 = slt v6, v0
  brif v7, b1(v6), b7
b7:
  return
";
        assert_eq!(aside(text), [0; 0]);
    }
}
