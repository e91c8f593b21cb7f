//! Replaces `elapsed` by counting the scan's own steps.
//!
//! `elapsed P` is the time since the instance last ran. Hardware has no clock to subtract: the
//! place is made to hold the units that have passed since instead. Every scan begins with
//! `P += step`; `elapsed P` becomes "take P, then 0". An instance that runs in every scan leaves
//! 0 behind always, which state promotion sees: `P` vanishes and the elapsed time is the step.
//!
//! Works on a scan whose calls are inlined. A place is left alone if it is used in any other way,
//! with two units, or starts at another time than 0; a target then refuses the `elapsed`.

use crate::scan_form::is_scan_inlined;
use iecc_ir::{
    BinaryOp, Block, CompareOp, ConvertOp, Function, Inst, InstData, Layout, Module, Place, Root,
    Type, Value,
};
use std::collections::{BTreeMap, BTreeSet};

/// Runs the pass.
pub(crate) fn run(module: &mut Module) {
    if !is_scan_inlined(module) {
        return;
    }
    let clocks = clocks(module);
    let scan = module.scan;
    let func = &mut module.funcs[scan];
    replace_elapsed(func, &clocks);
    let entry = func.entry();
    let mut prologue = Vec::new();
    for (place, unit_ns) in &clocks {
        accumulate(func, place, *unit_ns, &mut prologue);
    }
    let insts = &mut func.block_mut(entry).insts;
    prologue.append(insts);
    *insts = prologue;
}

/// The places that `elapsed` alone uses, and their units.
fn clocks(module: &Module) -> BTreeMap<Place, u64> {
    let func = &module.funcs[module.scan];
    let layout = Layout::new(&module.types);
    let mut clocks: BTreeMap<&Place, Option<u64>> = BTreeMap::new();
    let mut others = Others::default();
    for &inst in func
        .layout
        .iter()
        .flat_map(|&block| &func.block(block).insts)
    {
        match func.inst(inst) {
            InstData::Elapsed { place, unit_ns, .. }
                if place.root == Root::State && place.is_static() =>
            {
                let unit = clocks.entry(place).or_insert(Some(*unit_ns));
                if *unit != Some(*unit_ns) {
                    *unit = None;
                }
            }
            data => data
                .places()
                .into_iter()
                .for_each(|place| others.add(place)),
        }
    }
    let starts_at_zero = |place: &Place| {
        module
            .image
            .get_place(&layout, &module.types, module.state, place)
            .bits
            == 0
    };
    clocks
        .into_iter()
        .filter(|(place, _)| starts_at_zero(place) && !others.may_overlap(place))
        .filter_map(|(place, unit)| Some((place.clone(), unit?)))
        .collect()
}

/// Places that are used otherwise, asked for by thousands of clocks.
#[derive(Default)]
struct Others<'f> {
    fixed: BTreeSet<&'f Place>,
    /// With index values; all values are made one, as they may be anything.
    dynamic: BTreeSet<Place>,
}

impl<'f> Others<'f> {
    fn add(&mut self, place: &'f Place) {
        if place.is_static() {
            self.fixed.insert(place);
            return;
        }
        let mut blurred = place.clone();
        let any = Value::from_u32(0);
        blurred.values_mut().for_each(|value| *value = any);
        self.dynamic.insert(blurred);
    }

    /// Whether one of them is this scalar, a bit of it, or may be.
    fn may_overlap(&self, scalar: &Place) -> bool {
        let next = self.fixed.range::<&Place, _>(&scalar..).next();
        next.is_some_and(|other| other.may_overlap(scalar))
            || self.dynamic.iter().any(|other| other.may_overlap(scalar))
    }
}

/// `P := min(P + step, 2^63 - 1)`, at the start of the scan. Both are at most 2^63 - 1, so a sum
/// that is too large reads as negative.
fn accumulate(func: &mut Function, place: &Place, unit_ns: u64, out: &mut Vec<Inst>) {
    let mut emit = |data, ty: &[Type]| {
        let inst = func.make_inst(data, ty, None);
        out.push(inst);
        (inst, func.results_of(inst).first().copied())
    };
    let mut value = |data| emit(data, &[Type::I64]).1.expect("has a result");
    let pending = value(InstData::Load {
        place: place.clone(),
    });
    let step = value(InstData::Step {
        unit_ns,
        ty: Type::I64,
    });
    let sum = value(InstData::Binary {
        op: BinaryOp::Add,
        args: [pending, step],
    });
    let top = value(InstData::Const {
        ty: Type::I64,
        bits: i64::MAX as u64,
    });
    let zero = value(InstData::Const {
        ty: Type::I64,
        bits: 0,
    });
    let wrapped = emit(
        InstData::Compare {
            op: CompareOp::Slt,
            args: [sum, zero],
        },
        &[Type::I1],
    )
    .1;
    let cond = wrapped.expect("has a result");
    let bounded = emit(
        InstData::Select {
            cond,
            args: [top, sum],
        },
        &[Type::I64],
    )
    .1;
    emit(
        InstData::Store {
            place: place.clone(),
            value: bounded.expect("has a result"),
        },
        &[],
    );
}

fn replace_elapsed(func: &mut Function, clocks: &BTreeMap<Place, u64>) {
    for block in func.layout.clone() {
        let insts = std::mem::take(&mut func.block_mut(block).insts);
        for inst in insts {
            match func.inst(inst).clone() {
                InstData::Elapsed { place, ty, .. } if clocks.contains_key(&place) => {
                    take_pending(func, block, inst, &place, ty);
                }
                _ => func.block_mut(block).insts.push(inst),
            }
        }
    }
}

/// Puts "load, store 0, bound to the type" where `inst` stood; `inst` becomes the last of it and
/// keeps its result.
fn take_pending(func: &mut Function, block: Block, inst: Inst, place: &Place, ty: Type) {
    let origin = func.origin(inst);
    let mut append = |data, ty| {
        let inst = func.append_inst(block, data, &[ty], origin);
        func.result(inst)
    };
    let pending = append(
        InstData::Load {
            place: place.clone(),
        },
        Type::I64,
    );
    let zero = append(
        InstData::Const {
            ty: Type::I64,
            bits: 0,
        },
        Type::I64,
    );
    let (value, zero) = match ty {
        Type::I32 => (bound_to_i32(&mut append, pending), zero),
        _ => (pending, zero),
    };
    func.append_inst(
        block,
        InstData::Store {
            place: place.clone(),
            value: zero,
        },
        &[],
        origin,
    );
    *func.inst_mut(inst) = match ty {
        Type::I32 => InstData::Convert {
            op: ConvertOp::Trunc,
            to: Type::I32,
            arg: value,
        },
        _ => InstData::Binary {
            op: BinaryOp::Add,
            args: [value, zero],
        },
    };
    func.block_mut(block).insts.push(inst);
}

fn bound_to_i32(append: &mut impl FnMut(InstData, Type) -> Value, pending: Value) -> Value {
    let top = append(
        InstData::Const {
            ty: Type::I64,
            bits: i32::MAX as u64,
        },
        Type::I64,
    );
    let fits = append(
        InstData::Compare {
            op: CompareOp::Sle,
            args: [pending, top],
        },
        Type::I1,
    );
    append(
        InstData::Select {
            cond: fits,
            args: [pending, top],
        },
        Type::I64,
    )
}
