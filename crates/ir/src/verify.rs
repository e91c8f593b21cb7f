//! The rules a module keeps. Everything behind the verifier relies on them.
//!
//! Module
//!  1. Names of structs, of fields in a struct, of functions, of reference parameters and locals of a
//!     function and (ignoring ASCII case) of aliases are unique; no reference or local is called
//!     `state`, `input` or `output`.
//!  2. Arrays have at least one element; each region has at most `MAX_REGION_BYTES`, the locals of all
//!     functions together have at most `MAX_LOCAL_BYTES`; the image has the size of the state region and `i1` bytes in it are 0 or 1.
//!     A view fits the scalars of its field; a field of structs has the plain one. A field has at most as many
//!     first numbers as dimensions, the last one is not 0, and the numbers of all elements fit `i64`.
//!  3. `scan` and `prescan` have no parameters and no results.
//!  4. Aliases are static places of the state.
//!  5. No function calls itself, directly or through others.
//!
//! Function
//!  6. There is an entry block; nothing jumps to it.
//!  7. Every block of the layout has a terminator; jumps go to blocks of the layout.
//!  8. Every value is defined once, before its use in its block or in a dominating block. In
//!     unreachable blocks the order is free.
//!  9. A jump passes as many arguments as the target has parameters, of the same types; `return`
//!     passes the results of the function.
//! 10. Operands and results have the types of the op table; a constant has no bits above its width.
//! 11. `brif` and `select` test an `i1`; `switch` has an integer and unequal cases within its width.
//!
//! Memory and time
//! 12. A place follows its types; constant indices and bits are inside the bounds; index values are
//!     `i32`, addresses `i64`. `address` takes no bit and nothing of an input, an output or a local, and
//!     gives an `i64`.
//! 13. Loads and stores move one scalar or bit of the result's or operand's type; `copy` moves and
//!     `clear` makes 0 whole scalars, structs and arrays, not bits, between places of one type.
//!     Inputs are not written to, outputs not read.
//! 14. A call passes one place per reference, of the same type, no input or output, and
//!     not ending in a bit; one value per parameter; its results are those of the callee.
//! 15. `elapsed` keeps its time in an `i64` that is no input or output; units are at least 1 ns;
//!     `elapsed` and `step` give `i32` or `i64`.

use crate::analysis::{Cfg, Dominators};
use crate::{
    Block, FieldDef, FuncId, Function, Inst, InstData, Layout, MAX_LOCAL_BYTES, MAX_REGION_BYTES,
    MemType, Module, Origin, Place, PlaceType, Projection, Root, Target, Terminator, Type, Value,
    ValueDef, View,
};
use cranelift_entity::{EntityRef, EntitySet, SecondaryMap};
use std::collections::BTreeSet;
use std::fmt;
use std::ops::Deref;

/// A module that keeps the rules. Back ends accept nothing else.
#[derive(Debug, Clone, Copy)]
pub struct Verified<'m>(&'m Module);

impl Deref for Verified<'_> {
    type Target = Module;

    fn deref(&self) -> &Module {
        self.0
    }
}

/// A broken rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VerifyError {
    /// Number of the rule in the list of `verify.rs`.
    pub rule: u8,
    /// The function it is broken in.
    pub function: Option<String>,
    /// What is wrong.
    pub message: String,
    /// Where the code comes from.
    pub origin: Option<Origin>,
}

impl fmt::Display for VerifyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.function {
            Some(name) => write!(f, "rule {}: @{name}: {}", self.rule, self.message),
            None => write!(f, "rule {}: {}", self.rule, self.message),
        }
    }
}

/// Checks all rules and reports every one that is broken.
pub fn verify(module: &Module) -> Result<Verified<'_>, Vec<VerifyError>> {
    let mut errors = Vec::new();
    ModuleCheck {
        module,
        errors: &mut errors,
    }
    .run();
    // Function rules presuppose sane types.
    if errors.is_empty() {
        for func in module.funcs.values() {
            FunctionCheck::new(module, func, &mut errors).run();
        }
    }
    if errors.is_empty() {
        Ok(Verified(module))
    } else {
        Err(errors)
    }
}

struct ModuleCheck<'m, 'e> {
    module: &'m Module,
    errors: &'e mut Vec<VerifyError>,
}

impl ModuleCheck<'_, '_> {
    fn error(&mut self, rule: u8, message: String) {
        self.errors.push(VerifyError {
            rule,
            function: None,
            message,
            origin: None,
        });
    }

    fn unique<'n>(&mut self, what: &str, names: impl Iterator<Item = &'n str>) {
        let mut seen = BTreeSet::new();
        for name in names {
            if !seen.insert(name) {
                self.error(1, format!("{what} {name:?} is defined twice"));
            }
        }
    }

    fn run(&mut self) {
        let module = self.module;
        self.unique(
            "struct",
            module.types.structs.values().map(|def| def.name.as_str()),
        );
        for def in module.types.structs.values() {
            self.unique("field", def.fields.iter().map(|field| field.name.as_str()));
            def.fields.iter().for_each(|field| self.view(field));
        }
        self.unique(
            "function",
            module.funcs.values().map(|func| func.name.as_str()),
        );
        let folded: Vec<String> = module
            .names
            .iter()
            .map(|(name, _)| name.to_ascii_lowercase())
            .collect();
        self.unique("name", folded.iter().map(String::as_str));
        self.regions();
        self.aliases();
        self.entry_points();
        self.recursion();
    }

    fn view(&mut self, field: &FieldDef) {
        let (mut ty, mut lows) = (field.ty, field.lows.iter());
        while let MemType::Array(id) = ty {
            let array = self.module.types.array_type(id);
            let low = lows.next().copied().unwrap_or(0);
            if low.checked_add(i64::from(array.len)).is_none() {
                self.error(
                    2,
                    format!("elements of field {:?} have no numbers", field.name),
                );
            }
            ty = array.element;
        }
        if lows.next().is_some() || field.lows.last() == Some(&0) {
            self.error(
                2,
                format!("field {:?} has too many first numbers", field.name),
            );
        }
        let fits = match ty {
            MemType::Scalar(scalar) => field.view.fits(scalar),
            MemType::Struct(_) | MemType::Array(_) => field.view == View::Plain,
        };
        if !fits {
            let (name, view) = (&field.name, field.view.name());
            self.error(2, format!("field {name:?} cannot be seen as {view}"));
        }
    }

    fn regions(&mut self) {
        let module = self.module;
        if module.types.arrays().any(|array| array.len == 0) {
            self.error(2, "an array has no elements".to_owned());
        }
        let layout = Layout::new(&module.types);
        for (name, id) in [
            ("state", module.state),
            ("input", module.input),
            ("output", module.output),
        ] {
            let size = layout.size(&module.types, MemType::Struct(id));
            if size > MAX_REGION_BYTES {
                self.error(
                    2,
                    format!(
                        "region {name} has {size} bytes, at most {MAX_REGION_BYTES} are allowed"
                    ),
                );
            }
        }
        self.local_bytes(&layout);
        let size = layout.size(&module.types, MemType::Struct(module.state));
        if size != module.image.bytes().len() as u64 {
            self.error(
                2,
                format!(
                    "the image has {} bytes, the state {size}",
                    module.image.bytes().len()
                ),
            );
        } else if size <= MAX_REGION_BYTES {
            self.image_bits(&layout);
        }
    }

    fn local_bytes(&mut self, layout: &Layout) {
        let module = self.module;
        let sizes = module.funcs.values();
        let sizes = sizes.map(|func| layout.locals(&module.types, func).1);
        let size = sizes.fold(0, u64::saturating_add);
        if size > MAX_LOCAL_BYTES {
            self.error(
                2,
                format!("all locals have {size} bytes, at most {MAX_LOCAL_BYTES} are allowed"),
            );
        }
    }

    fn image_bits(&mut self, layout: &Layout) {
        let module = self.module;
        let mut bad = None;
        let state = MemType::Struct(module.state);
        layout.for_each_leaf(
            &module.types,
            &Place::root(Root::State),
            state,
            &mut |_, offset, ty| {
                if ty == Type::I1 && module.image.bytes()[offset as usize] > 1 {
                    bad = Some(offset);
                }
            },
        );
        if let Some(offset) = bad {
            self.error(
                2,
                format!("the i1 at byte {offset} of the image is neither 0 nor 1"),
            );
        }
    }

    fn aliases(&mut self) {
        for (name, place) in &self.module.names {
            let state = MemType::Struct(self.module.state);
            let legal = place.root == Root::State
                && place.is_static()
                && Place::walk(&self.module.types, state, &place.path).is_some();
            if !legal {
                self.error(
                    4,
                    format!("name {name:?} is not a static place of the state"),
                );
            }
        }
    }

    fn entry_points(&mut self) {
        for id in [Some(self.module.scan), self.module.prescan]
            .into_iter()
            .flatten()
        {
            match self.module.funcs.get(id) {
                None => self.error(3, format!("{id} does not exist")),
                Some(func) if func.layout.is_empty() => {}
                Some(func) => {
                    if !(func.refs.is_empty()
                        && func.results.is_empty()
                        && func.param_types().is_empty())
                    {
                        self.error(3, format!("@{} has parameters or results", func.name));
                    }
                }
            }
        }
    }

    /// Depth-first over calls, without recursion of our own.
    fn recursion(&mut self) {
        let (mut done, mut open) = (EntitySet::<FuncId>::new(), EntitySet::<FuncId>::new());
        for root in self.module.funcs.keys() {
            if done.contains(root) {
                continue;
            }
            open.insert(root);
            let mut path = vec![(root, callees(self.module, root))];
            while let Some((func, rest)) = path.last_mut() {
                let (func, next) = (*func, rest.pop());
                match next {
                    Some(callee) if open.contains(callee) => {
                        let name = &self.module.funcs[callee].name;
                        self.error(5, format!("@{name} calls itself"));
                    }
                    Some(callee) if done.contains(callee) => {}
                    Some(callee) => {
                        open.insert(callee);
                        path.push((callee, callees(self.module, callee)));
                    }
                    None => {
                        done.insert(func);
                        open.remove(func);
                        path.pop();
                    }
                }
            }
        }
    }
}

fn callees(module: &Module, id: FuncId) -> Vec<FuncId> {
    let known = |callee: &FuncId| module.funcs.get(*callee).is_some();
    let called: BTreeSet<FuncId> = module.funcs[id].calls().filter(known).collect();
    called.into_iter().collect()
}

struct FunctionCheck<'m, 'e> {
    module: &'m Module,
    func: &'m Function,
    errors: &'e mut Vec<VerifyError>,
    origin: Option<Origin>,
    /// Block and position (0 = parameter, n = behind the n-th instruction) of each definition.
    defined: SecondaryMap<Value, Option<(Block, u32)>>,
    live: EntitySet<Block>,
}

impl<'m, 'e> FunctionCheck<'m, 'e> {
    fn new(module: &'m Module, func: &'m Function, errors: &'e mut Vec<VerifyError>) -> Self {
        let mut live = EntitySet::new();
        for &block in &func.layout {
            live.insert(block);
        }
        Self {
            module,
            func,
            errors,
            origin: None,
            defined: SecondaryMap::new(),
            live,
        }
    }

    fn error(&mut self, rule: u8, message: String) {
        let function = Some(self.func.name.clone());
        self.errors.push(VerifyError {
            rule,
            function,
            message,
            origin: self.origin,
        });
    }

    fn run(&mut self) {
        let before = self.errors.len();
        self.shape();
        if self.errors.len() > before {
            return;
        }
        self.definitions();
        let cfg = Cfg::new(self.func);
        let dominators = Dominators::new(&cfg);
        for &block in &self.func.layout {
            self.block(block, &cfg, &dominators);
        }
    }

    /// Rules 1, 6 and 7: what the control flow analysis presupposes.
    fn shape(&mut self) {
        let func = self.func;
        let mut names = BTreeSet::from(["state", "input", "output"]);
        let refs = func.refs.values().map(|data| &data.name);
        for name in refs.chain(func.locals.values().map(|data| &data.name)) {
            if !names.insert(name) {
                self.error(
                    1,
                    format!("reference or local {name:?} has a name that is taken"),
                );
            }
        }
        let Some(&entry) = func.layout.first() else {
            return self.error(6, "the function has no block".to_owned());
        };
        if self.live.iter().count() != func.layout.len() {
            self.error(7, "a block stands twice in the layout".to_owned());
        }
        for &block in &func.layout {
            let Some(terminator) = &func.block(block).terminator else {
                self.error(7, format!("{block} has no terminator"));
                continue;
            };
            for target in terminator.targets() {
                if target.block == entry {
                    self.error(6, format!("{block} jumps to the entry"));
                }
                if !self.live.contains(target.block) {
                    self.error(
                        7,
                        format!(
                            "{block} jumps to {}, which is not in the layout",
                            target.block
                        ),
                    );
                }
            }
        }
    }

    fn definitions(&mut self) {
        let func = self.func;
        for &block in &func.layout {
            let data = func.block(block);
            for (index, &param) in data.params.iter().enumerate() {
                self.define(param, ValueDef::Param(block, index as u32), (block, 0));
            }
            for (position, &inst) in data.insts.iter().enumerate() {
                for (index, &value) in func.results_of(inst).iter().enumerate() {
                    let def = ValueDef::Result(inst, index as u32);
                    self.define(value, def, (block, position as u32 + 1));
                }
            }
        }
    }

    fn define(&mut self, value: Value, def: ValueDef, at: (Block, u32)) {
        if self.defined[value].is_some() || self.func.value_def(value) != def {
            self.error(8, format!("{value} is defined twice"));
        }
        self.defined[value] = Some(at);
    }

    fn block(&mut self, block: Block, cfg: &Cfg, dominators: &Dominators) {
        let func = self.func;
        for (position, &inst) in func.block(block).insts.iter().enumerate() {
            self.origin = func.origin(inst);
            for value in func.inst(inst).values() {
                self.use_of(value, block, position as u32, cfg, dominators);
            }
            self.inst(inst);
        }
        let data = func.block(block);
        self.origin = data.terminator_origin;
        let terminator = func.terminator(block);
        for value in terminator.values() {
            self.use_of(value, block, data.insts.len() as u32, cfg, dominators);
        }
        self.terminator(terminator);
    }

    fn use_of(
        &mut self,
        value: Value,
        block: Block,
        position: u32,
        cfg: &Cfg,
        dominators: &Dominators,
    ) {
        let legal = value.index() < self.func.value_count()
            && match self.defined[value] {
                None => false,
                Some(_) if !cfg.is_reachable(block) => true,
                Some((at, defined)) if at == block => defined <= position,
                Some((at, _)) => dominators.dominates(at, block),
            };
        if !legal {
            self.error(
                8,
                format!("{value} is used in {block} but not defined on every way there"),
            );
        }
    }

    fn ty(&self, value: Value) -> Type {
        self.func.value_type(value)
    }

    fn same(&mut self, rule: u8, what: &str, found: &[Type], expected: &[Type]) {
        if found != expected {
            self.error(
                rule,
                format!("{what} has types {found:?}, expected {expected:?}"),
            );
        }
    }

    fn inst(&mut self, inst: Inst) {
        let func = self.func;
        let results: Vec<Type> = func.results_of(inst).iter().map(|&v| self.ty(v)).collect();
        match func.inst(inst) {
            InstData::Const { ty, bits } => {
                self.same(10, "const", &results, &[*ty]);
                if bits & !ty.mask() != 0 {
                    self.error(10, format!("const {bits:#x} has bits above {ty}"));
                }
            }
            InstData::Unary { op, arg } => {
                let ty = self.ty(*arg);
                self.table(op.name(), op.class().accepts(ty), &[ty]);
                self.same(10, op.name(), &results, &[ty]);
            }
            InstData::Binary { op, args } => {
                let types = args.map(|v| self.ty(v));
                self.table(
                    op.name(),
                    op.class().accepts(types[0]) && types[0] == types[1],
                    &types,
                );
                self.same(10, op.name(), &results, &types[..1]);
            }
            InstData::Compare { op, args } => {
                let types = args.map(|v| self.ty(v));
                self.table(
                    op.name(),
                    op.class().accepts(types[0]) && types[0] == types[1],
                    &types,
                );
                self.same(10, op.name(), &results, &[Type::I1]);
            }
            InstData::Convert { op, to, arg } => {
                let from = self.ty(*arg);
                self.table(op.name(), op.accepts(from, *to), &[from, *to]);
                self.same(10, op.name(), &results, &[*to]);
            }
            InstData::Select { cond, args } => {
                let types = args.map(|v| self.ty(v));
                self.same(
                    11,
                    "the condition of select",
                    &[self.ty(*cond)],
                    &[Type::I1],
                );
                self.same(10, "select", &types[1..], &types[..1]);
                self.same(10, "select", &results, &types[..1]);
            }
            InstData::Copy { to, from } => self.copy(to, from, &results),
            InstData::Address { place } => {
                let found = self.place_type(place);
                let is_state = place.root.may_alias();
                if found == Some(PlaceType::Bit) || !is_state {
                    self.error(
                        12,
                        "the address of something else than state is taken".to_owned(),
                    );
                }
                self.same(12, "address", &results, &[Type::I64]);
            }
            InstData::Clear { place } => {
                self.memory_place(place);
                self.written(place);
                self.same(13, "clear", &results, &[]);
            }
            InstData::Load { place } => {
                let loaded = self.scalar_place(place);
                self.same(13, "load", &results, loaded.as_slice());
                self.read(place);
            }
            InstData::Store { place, value } => {
                let stored = self.scalar_place(place);
                self.same(13, "store", &[self.ty(*value)], stored.as_slice());
                self.same(13, "store", &results, &[]);
                self.written(place);
            }
            InstData::Now => self.same(10, "now", &results, &[Type::I64]),
            InstData::Elapsed { place, unit_ns, ty } => {
                let kept = self.scalar_place(place);
                self.same(
                    15,
                    "the time kept by elapsed",
                    kept.as_slice(),
                    &[Type::I64],
                );
                if matches!(place.root, Root::Input | Root::Output)
                    || matches!(place.path.last(), Some(Projection::Bit(_)))
                {
                    self.error(
                        15,
                        "elapsed keeps its time in an input, an output or a bit".to_owned(),
                    );
                }
                self.unit(*unit_ns, *ty, &results);
            }
            InstData::Step { unit_ns, ty } => self.unit(*unit_ns, *ty, &results),
            InstData::Call { func, refs, args } => self.call(*func, refs, args, &results),
        }
    }

    fn table(&mut self, name: &str, legal: bool, types: &[Type]) {
        if !legal {
            self.error(10, format!("{name} does not take {types:?}"));
        }
    }

    fn unit(&mut self, unit_ns: u64, ty: Type, results: &[Type]) {
        if unit_ns == 0 || !matches!(ty, Type::I32 | Type::I64) {
            self.error(
                15,
                "a time needs a unit of at least 1 ns and type i32 or i64".to_owned(),
            );
        }
        self.same(15, "a time", results, &[ty]);
    }

    fn place_type(&mut self, place: &Place) -> Option<PlaceType> {
        if let Root::Deref { value, .. } = place.root {
            self.same(12, "an address", &[self.ty(value)], &[Type::I64]);
        }
        for value in place.index_values() {
            self.same(12, "an index", &[self.ty(value)], &[Type::I32]);
        }
        let start = self.module.root_type(self.func, place.root);
        let found = start.and_then(|start| Place::walk(&self.module.types, start, &place.path));
        if found.is_none() {
            self.error(
                12,
                format!("{place:?} does not follow its types or leaves the bounds"),
            );
        }
        found
    }

    fn scalar_place(&mut self, place: &Place) -> Option<Type> {
        let found = self.place_type(place)?;
        let scalar = found.scalar();
        if scalar.is_none() {
            self.error(13, "a whole struct or array is moved".to_owned());
        }
        scalar
    }

    fn read(&mut self, place: &Place) {
        if place.root == Root::Output {
            self.error(13, "an output is loaded".to_owned());
        }
    }

    fn written(&mut self, place: &Place) {
        if place.root == Root::Input {
            self.error(13, "an input is stored to".to_owned());
        }
    }

    /// What lies at a place that must not be a bit.
    fn memory_place(&mut self, place: &Place) -> Option<MemType> {
        match self.place_type(place)? {
            PlaceType::Mem(ty) => Some(ty),
            PlaceType::Bit => {
                self.error(13, "a single bit is copied or cleared".to_owned());
                None
            }
        }
    }

    fn copy(&mut self, to: &Place, from: &Place, results: &[Type]) {
        if let (Some(to), Some(from)) = (self.memory_place(to), self.memory_place(from))
            && to != from
        {
            self.error(
                13,
                "copy moves between places of different types".to_owned(),
            );
        }
        self.read(from);
        self.written(to);
        self.same(13, "copy", results, &[]);
    }

    fn call(&mut self, callee: FuncId, refs: &[Place], args: &[Value], results: &[Type]) {
        let module = self.module;
        let Some(callee) = module.funcs.get(callee) else {
            return self.error(14, format!("{callee} does not exist"));
        };
        if refs.len() != callee.refs.len() {
            self.error(
                14,
                format!(
                    "@{} takes {} references, {} are passed",
                    callee.name,
                    callee.refs.len(),
                    refs.len()
                ),
            );
        }
        for (place, param) in refs.iter().zip(callee.refs.values()) {
            let found = self.place_type(place);
            if found.is_some() && found != Some(PlaceType::Mem(param.ty)) {
                self.error(
                    14,
                    format!(
                        "reference {} of @{} is passed another type",
                        param.name, callee.name
                    ),
                );
            }
            if matches!(place.root, Root::Input | Root::Output) {
                self.error(14, "a reference to an input or output is passed".to_owned());
            }
        }
        let found: Vec<Type> = args.iter().map(|&v| self.ty(v)).collect();
        if !callee.layout.is_empty() {
            self.same(14, "the arguments", &found, &callee.param_types());
        }
        self.same(14, "the call", results, &callee.results);
    }

    fn terminator(&mut self, terminator: &Terminator) {
        for target in terminator.targets() {
            self.target(target);
        }
        match terminator {
            Terminator::Jump(_) | Terminator::Fault(_) => {}
            Terminator::Brif { cond, .. } => {
                self.same(11, "the condition of brif", &[self.ty(*cond)], &[Type::I1]);
            }
            Terminator::Switch { value, cases, .. } => {
                let ty = self.ty(*value);
                let unique: BTreeSet<u64> = cases.iter().map(|(bits, _)| *bits).collect();
                let fits = unique.iter().all(|bits| bits & !ty.mask() == 0);
                if !ty.is_int() || unique.len() != cases.len() || !fits {
                    self.error(
                        11,
                        "switch needs an integer and unequal cases within its width".to_owned(),
                    );
                }
            }
            Terminator::Return(values) => {
                let types: Vec<Type> = values.iter().map(|&v| self.ty(v)).collect();
                let func = self.func;
                self.same(9, "return", &types, &func.results);
            }
        }
    }

    fn target(&mut self, target: &Target) {
        let params = &self.func.block(target.block).params;
        let expected: Vec<Type> = params.iter().map(|&v| self.ty(v)).collect();
        let found: Vec<Type> = target.args.iter().map(|&v| self.ty(v)).collect();
        self.same(
            9,
            &format!("the jump to {}", target.block),
            &found,
            &expected,
        );
    }
}
