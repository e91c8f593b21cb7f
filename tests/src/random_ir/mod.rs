//! Random modules that keep the verifier's rules: nested branches, switches, loops that end,
//! graphs that no structured program has, calls with references that alias, every value operation,
//! words and their bits, whole structs and arrays, locals, indices in and out of bounds, timers, and now and then a fault.
//!
//! A seed and options always give the same module. A scan of one takes at most some
//! [`MAX_COST`] instructions, so fuel plays no part.

mod body;
mod expressions;
mod places;
mod types;
mod values;

pub use expressions::random_expressions;

use crate::rng::Rng;
use crate::stimulus::random_bits;
use body::Body;
use iecc_ir::{
    FuncId, Image, Layout, MemType, Module, Origin, OriginData, Place, Root, Scalar, Type,
};
use types::RandomTypes;

/// What a module may contain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Options {
    /// Statements of a function, nested ones included.
    pub statements: usize,
    /// Functions beside the scan.
    pub functions: usize,
    /// Loops, and tangled blocks that are no natural loop.
    pub loops: bool,
    /// `fault` terminators.
    pub faults: bool,
    /// Floating-point values.
    pub floats: bool,
    /// Division and remainder.
    pub division: bool,
    /// Indices known only at run time.
    pub dynamic_places: bool,
    /// Addresses: of what lies there, of something else, and of nothing.
    pub addresses: bool,
    /// The absolute time of a scan.
    pub now: bool,
    /// The time since the scan before.
    pub step: bool,
    /// The time since the same code ran, kept in any place, however else that is used.
    pub elapsed: bool,
    /// Timers as front ends make them, with a place for the time that nothing else uses.
    pub timers: bool,
}

impl Options {
    /// Everything the IR has.
    pub const fn all() -> Self {
        Self {
            statements: 24,
            functions: 3,
            loops: true,
            faults: true,
            floats: true,
            division: true,
            dynamic_places: true,
            addresses: true,
            now: true,
            step: true,
            elapsed: true,
            timers: true,
        }
    }

    /// What becomes a scan of one block without anything hardware has to refuse. Its time is that of
    /// timers, and `step`.
    pub fn hardware() -> Self {
        Self {
            loops: false,
            faults: false,
            floats: false,
            division: false,
            dynamic_places: false,
            addresses: false,
            now: false,
            elapsed: false,
            ..Self::all()
        }
    }
}

/// The most instructions a function may take with all it calls.
const MAX_COST: u64 = 20_000;

/// What a caller needs to know of a function that exists already.
#[derive(Debug, Clone)]
struct Signature {
    id: FuncId,
    refs: Vec<MemType>,
    params: Vec<Type>,
    results: Vec<Type>,
    cost: u64,
}

/// The module of a seed.
pub fn random_module(seed: u64, options: &Options) -> Module {
    let rng = &mut Rng::new(seed);
    let types = RandomTypes::new(rng, options);
    let mut module = empty_module(&types, rng);
    let mut callees = Vec::new();
    for index in 0..options.functions.min(1 + rng.below(options.functions + 1)) {
        let refs = types.random_refs(rng);
        let params = types.random_values(rng, 3);
        let results = types.random_values(rng, 2);
        let locals = types.random_locals(rng);
        let mut body = Body::new(&module, &callees, options, rng, &format!("f{index}"));
        body.begin(&refs, &locals, &params, &results);
        let (func, cost) = body.finish();
        let id = module.funcs.push(func);
        callees.push(Signature {
            id,
            refs,
            params,
            results,
            cost,
        });
    }
    for name in ["prescan", "scan"] {
        let locals = types.random_locals(rng);
        let mut body = Body::new(&module, &callees, options, rng, name);
        body.begin(&[], &locals, &[], &[]);
        let (func, _) = body.finish();
        module.scan = module.funcs.push(func);
        if name == "prescan" {
            module.prescan = Some(module.scan);
        }
    }
    module
}

/// A scan whose blocks jump to any later blocks, some statements in each.
pub fn random_graph(seed: u64, blocks: usize) -> Module {
    let rng = &mut Rng::new(seed);
    let options = Options {
        loops: false,
        faults: false,
        addresses: false,
        elapsed: false,
        timers: false,
        ..Options::all()
    };
    let types = RandomTypes::new(rng, &options);
    let mut module = empty_module(&types, rng);
    let locals = types.random_locals(rng);
    let mut body = Body::new(&module, &[], &options, rng, "scan");
    body.begin(&[], &locals, &[], &[]);
    let func = body.finish_graph(blocks);
    module.scan = module.funcs.push(func);
    module
}

/// Regions, a random image, some origins and aliases; no function yet.
fn empty_module(types: &RandomTypes, rng: &mut Rng) -> Module {
    let layout = Layout::new(&types.table);
    let mut image = Image::zero(&layout, &types.table, types.state);
    let state = MemType::Struct(types.state);
    let mut names = Vec::new();
    layout.for_each_leaf(
        &types.table,
        &Place::root(Root::State),
        state,
        &mut |place, offset, ty| {
            // The time a timer keeps starts at 0, as front ends have it.
            if !types.is_timer(place) && rng.one_in(2) {
                image.set(offset, Scalar::new(ty, random_bits(ty, rng)));
            }
            if rng.one_in(8) {
                names.push((format!("Alias:{}", names.len() + 10), place.clone()));
            }
        },
    );
    let mut origins = cranelift_entity::PrimaryMap::<Origin, OriginData>::new();
    for rung in 0..3 {
        let label = format!("Main \"rung\" {rung}");
        origins.push(OriginData {
            label: label.into(),
            span: None,
        });
    }
    Module {
        name: "random".to_owned(),
        types: types.table.clone(),
        state: types.state,
        input: types.input,
        output: types.output,
        image,
        funcs: cranelift_entity::PrimaryMap::new(),
        scan: FuncId::from_u32(0),
        prescan: None,
        names,
        origins,
    }
}
