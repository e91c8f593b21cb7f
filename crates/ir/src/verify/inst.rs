//! Rules of instructions: types, places, calls, time.

use super::function::FunctionCheck;
use crate::{FuncId, Inst, InstData, MemType, Place, PlaceType, Projection, Root, Type, Value};

impl FunctionCheck<'_, '_> {
    pub(super) fn inst(&mut self, inst: Inst) {
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
}
