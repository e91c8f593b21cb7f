//! The numbers of an initial value, one by one.

use crate::hir::code::Init;
use crate::hir::{InitId, Step, Type};
use crate::st::analysis::Analysis;

/// Most numbers that are listed one by one.
const MAX_LEAVES: usize = 1 << 16;

type Leaves = Vec<(Vec<Step>, u64)>;

impl Analysis<'_> {
    /// The way to each number of a type, and its bits, those that are 0 included; `None` if there are
    /// too many, or if one is an address.
    pub(crate) fn init_leaves(&self, init: Option<InitId>, ty: Type) -> Option<Leaves> {
        let mut leaves = Leaves::new();
        self.collect_leaves(init, ty, &mut Vec::new(), &mut leaves)?;
        Some(leaves)
    }

    /// Recursion is bounded by the depth of types.
    fn collect_leaves(
        &self,
        init: Option<InitId>,
        ty: Type,
        path: &mut Vec<Step>,
        leaves: &mut Leaves,
    ) -> Option<()> {
        let init = init.map(|init| self.hir.inits.get(init));
        match ty {
            Type::Elementary(_) => {
                let bits = match init {
                    Some(Init::Bits(bits)) => *bits,
                    Some(Init::Zero) | None => 0,
                    Some(Init::Address(_) | Init::Struct(_) | Init::Array(_)) => return None,
                };
                leaves.push((path.clone(), bits));
                (leaves.len() <= MAX_LEAVES).then_some(())
            }
            Type::Struct(id) => {
                let members = &self.hir.types.struct_def(id).members;
                (0..).zip(members).try_for_each(|(field, member)| {
                    let part = init.and_then(|init| member_init(init, field));
                    path.push(Step::Field(field));
                    let done = self.collect_leaves(part, member.ty, path, leaves);
                    path.pop();
                    done
                })
            }
            Type::Array(id) => {
                let array = self.hir.types.array_def(id);
                (0..array.len).try_for_each(|index| {
                    let part = init.and_then(|init| element_init(init, index));
                    path.push(Step::Index(index));
                    let done = self.collect_leaves(part, array.element, path, leaves);
                    path.pop();
                    done
                })
            }
        }
    }
}

fn member_init(init: &Init, field: u32) -> Option<InitId> {
    match init {
        Init::Struct(members) => {
            let found = members.iter().find(|(member, _)| *member == field);
            found.map(|(_, init)| *init)
        }
        Init::Zero | Init::Bits(_) | Init::Address(_) | Init::Array(_) => None,
    }
}

fn element_init(init: &Init, index: u32) -> Option<InitId> {
    match init {
        Init::Array(runs) => {
            let inside = |run: &&(u32, u32, InitId)| (run.0..run.0 + run.1).contains(&index);
            runs.iter().find(inside).map(|(.., init)| *init)
        }
        Init::Zero | Init::Bits(_) | Init::Address(_) | Init::Struct(_) => None,
    }
}
