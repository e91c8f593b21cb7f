//! Indices that turn out to be constants: the place becomes static, or the access vanishes if it
//! lies outside (a load gives 0, a store does nothing; that is what places mean). A copy from outside
//! becomes a clear.

use super::simplify::Rewriter;
use iecc_ir::{
    Function, Index, Inst, InstData, MemType, Module, Place, Projection, Root, StructId, Type,
};

/// The structs of the regions.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Regions {
    state: StructId,
    input: StructId,
    output: StructId,
}

impl Regions {
    /// Those of a module.
    pub(crate) fn of(module: &Module) -> Self {
        Self {
            state: module.state,
            input: module.input,
            output: module.output,
        }
    }

    /// What lies at a root.
    pub(crate) fn root_type(self, func: &Function, root: Root) -> MemType {
        match root {
            Root::State => MemType::Struct(self.state),
            Root::Input => MemType::Struct(self.input),
            Root::Output => MemType::Struct(self.output),
            Root::Ref(param) => func.refs[param].ty,
            Root::Local(local) => func.locals[local].ty,
            Root::Deref { ty, .. } => ty,
        }
    }
}

/// What became of an access.
pub(super) enum Access {
    /// No index is constant that was not before.
    Unchanged,
    /// Some are now.
    Fixed,
    /// The access is outside the bounds and has no effect.
    Outside,
}

/// Turns index values that are constants into constant indices.
pub(super) fn fix_indices(rewriter: &mut Rewriter<'_>, inst: Inst) -> Access {
    let mut data = rewriter.func.inst(inst).clone();
    let access = match &mut data {
        InstData::Load { place } | InstData::Store { place, .. } | InstData::Clear { place } => {
            fix(rewriter, place)
        }
        InstData::Copy { to, from } => match (fix(rewriter, to), fix(rewriter, from)) {
            (Access::Outside, _) => Access::Outside,
            (_, Access::Outside) => {
                data = InstData::Clear { place: to.clone() };
                Access::Fixed
            }
            (Access::Unchanged, Access::Unchanged) => Access::Unchanged,
            (Access::Fixed, _) | (_, Access::Fixed) => Access::Fixed,
        },
        InstData::Elapsed { place, .. } | InstData::Address { place } => {
            inside_only(fix(rewriter, place))
        }
        InstData::Call { refs, .. } => {
            let fixed = refs
                .iter_mut()
                .map(|place| inside_only(fix(rewriter, place)));
            let any = fixed.fold(false, |any, access| any | matches!(access, Access::Fixed));
            if any {
                Access::Fixed
            } else {
                Access::Unchanged
            }
        }
        InstData::Const { .. }
        | InstData::Unary { .. }
        | InstData::Binary { .. }
        | InstData::Compare { .. }
        | InstData::Convert { .. }
        | InstData::Select { .. }
        | InstData::Now
        | InstData::Step { .. } => Access::Unchanged,
    };
    if matches!(access, Access::Fixed) {
        *rewriter.func.inst_mut(inst) = data;
    }
    access
}

/// A call, `elapsed` or `address` with an index outside has other effects; it keeps its index value.
fn inside_only(access: Access) -> Access {
    match access {
        Access::Outside => Access::Unchanged,
        Access::Unchanged | Access::Fixed => access,
    }
}

/// Leaves the place as it is if an index is outside.
fn fix(rewriter: &Rewriter<'_>, place: &mut Place) -> Access {
    if place.is_static() {
        return Access::Unchanged;
    }
    let mut fixed = place.clone();
    let mut any = false;
    let start = rewriter.regions.root_type(rewriter.func, place.root);
    for position in 0..fixed.path.len() {
        let step = fixed.path[position];
        let (Projection::Index(Index::Value(value)) | Projection::Bit(Index::Value(value))) = step
        else {
            continue;
        };
        let Some(bits) = rewriter.constant(value) else {
            continue;
        };
        let Ok(index) = u32::try_from(Type::I32.signed(bits)) else {
            return Access::Outside;
        };
        fixed.path[position] = with_constant(step, index);
        if Place::walk(rewriter.types, start, &fixed.path[..=position]).is_none() {
            return Access::Outside;
        }
        any = true;
    }
    *place = fixed;
    if any {
        Access::Fixed
    } else {
        Access::Unchanged
    }
}

fn with_constant(step: Projection, index: u32) -> Projection {
    match step {
        Projection::Index(_) => Projection::Index(Index::Const(index)),
        Projection::Bit(_) => Projection::Bit(Index::Const(index)),
        Projection::Field(_) => step,
    }
}
