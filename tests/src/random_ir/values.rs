//! Random values: constants, variables, loads, and operations on them.

use super::body::Body;
use super::places::{Route, Step};
use crate::stimulus::random_bits;
use iecc_ir::{
    BinaryOp, CompareOp, ConvertOp, Index, MemType, Place, PlaceType, Root, Type, UnaryOp, Value,
};

/// How deep expressions nest.
const DEPTH: u32 = 4;

impl Body<'_> {
    /// A value of a type.
    pub(super) fn value(&mut self, ty: Type) -> Value {
        self.expression(ty, DEPTH)
    }

    fn expression(&mut self, ty: Type, depth: u32) -> Value {
        if depth == 0 || self.rng.one_in(5) {
            return self.leaf(ty);
        }
        self.spend(1);
        match self.rng.below(9) {
            0 => self.select(ty, depth - 1),
            1 => self.unary(ty, depth - 1),
            2 | 3 if ty == Type::I1 => self.compare(depth - 1),
            2 | 3 => self.convert(ty, depth - 1),
            4 => self.load(ty),
            5 if ty == Type::I64 && self.options.addresses && self.rng.one_in(3) => self.address(),
            5 if ty == Type::I64 && self.options.now => self.builder.now(),
            6 if matches!(ty, Type::I32 | Type::I64) => self.time(ty),
            _ => self.binary(ty, depth - 1),
        }
    }

    fn leaf(&mut self, ty: Type) -> Value {
        match self.rng.below(4) {
            0 => self.constant(ty),
            1 => self.load(ty),
            _ => self.variable(ty),
        }
    }

    pub(super) fn constant(&mut self, ty: Type) -> Value {
        let bits = random_bits(ty, self.rng);
        self.spend(1);
        self.builder.constant(ty, bits)
    }

    fn variable(&mut self, ty: Type) -> Value {
        let variables: Vec<_> = self.variables_of(ty).collect();
        let variable = self.rng.pick(&variables);
        self.builder.read(variable)
    }

    fn select(&mut self, ty: Type, depth: u32) -> Value {
        let cond = self.expression(Type::I1, depth);
        let (yes, no) = (self.expression(ty, depth), self.expression(ty, depth));
        self.builder.select(cond, yes, no)
    }

    fn unary(&mut self, ty: Type, depth: u32) -> Value {
        let ops = UnaryOp::ALL.iter().copied();
        let ops: Vec<_> = ops.filter(|op| op.class().accepts(ty)).collect();
        let (op, arg) = (self.rng.pick(&ops), self.expression(ty, depth));
        self.builder.unary(op, arg)
    }

    fn binary(&mut self, ty: Type, depth: u32) -> Value {
        let division = self.options.division;
        let ops = BinaryOp::ALL.iter().copied();
        let ops = ops.filter(|op| op.class().accepts(ty) && (division || !is_division(*op)));
        let ops: Vec<_> = ops.collect();
        let op = self.rng.pick(&ops);
        let (left, right) = (self.expression(ty, depth), self.expression(ty, depth));
        self.builder.binary(op, left, right)
    }

    fn compare(&mut self, depth: u32) -> Value {
        let ty = self.random_type();
        let ops = CompareOp::ALL.iter().copied();
        let ops: Vec<_> = ops.filter(|op| op.class().accepts(ty)).collect();
        let op = self.rng.pick(&ops);
        let (left, right) = (self.expression(ty, depth), self.expression(ty, depth));
        self.builder.compare(op, left, right)
    }

    fn convert(&mut self, to: Type, depth: u32) -> Value {
        let from = self.random_type();
        let ops = ConvertOp::ALL.iter().copied();
        let ops: Vec<_> = ops.filter(|op| op.accepts(from, to)).collect();
        if ops.is_empty() {
            return self.leaf(to);
        }
        let (op, arg) = (self.rng.pick(&ops), self.expression(from, depth));
        self.builder.convert(op, to, arg)
    }

    /// `elapsed` or `step`, in a unit of any size.
    fn time(&mut self, ty: Type) -> Value {
        let unit_ns = self
            .rng
            .pick(&[1, 7, 1_000, 1_000_000, 10_000_000, u64::MAX]);
        match (self.rng.one_in(2), self.options.elapsed, self.options.step) {
            (true, true, _) | (false, true, false) => {
                let place = self.place(|route| {
                    let whole = !matches!(route.steps.last(), Some(Step::Bit(_)));
                    whole && route.is_value(Type::I64) && route.is_kept()
                });
                match place {
                    Some(place) => self.builder.elapsed(place, unit_ns, ty),
                    None => self.constant(ty),
                }
            }
            (_, _, true) => self.builder.step(unit_ns, ty),
            (_, false, false) => self.constant(ty),
        }
    }

    fn address(&mut self) -> Value {
        let is_memory = |route: &Route| matches!(route.end, PlaceType::Mem(_));
        let is_state = |route: &Route| matches!(route.root, Root::State | Root::Ref(_));
        match self.place(|route| is_memory(route) && is_state(route)) {
            Some(place) => self.builder.address(place),
            None => self.constant(Type::I64),
        }
    }

    fn load(&mut self, ty: Type) -> Value {
        self.spend(1);
        // Inputs are few but are what makes a module lively.
        let inputs = self.rng.one_in(3);
        let place = self
            .place(|route| inputs && route.root == Root::Input && route.is_value(ty))
            .or_else(|| self.place(|route| route.is_value(ty) && route.root != Root::Output));
        match place {
            Some(place) => self.builder.load(place, ty),
            None => self.constant(ty),
        }
    }

    /// A place for a reference: as often as not one whose index may be out of bounds.
    pub(super) fn referenced_place(&mut self, ty: MemType) -> Place {
        let fits = |route: &Route| route.end == PlaceType::Mem(ty) && route.is_kept();
        let in_array = |route: &Route| matches!(route.steps.last(), Some(Step::Element(_)));
        let element = self.rng.one_in(2);
        let element = element.then(|| self.place(|route| fits(route) && in_array(route)));
        let place = element.flatten().or_else(|| self.shared_place(fits));
        place.expect("the state holds every type")
    }

    /// A place that fits; every other time the first such field of the state, so that the places of
    /// different functions and statements are often the same.
    pub(super) fn shared_place(&mut self, fits: impl Fn(&Route) -> bool) -> Option<Place> {
        let favourite = |route: &Route| route.root == Root::State && route.steps.len() == 1;
        let favourite = self
            .routes
            .iter()
            .find(|route| favourite(route) && fits(route));
        match favourite.map(|route| route.steps[0]) {
            Some(Step::Field(field)) if self.rng.one_in(2) => {
                Some(Place::root(Root::State).field(field))
            }
            Some(Step::Field(_) | Step::Element(_) | Step::Bit(_)) | None => self.place(fits),
        }
    }

    /// A place that fits, its indices filled in.
    pub(super) fn place(&mut self, fits: impl Fn(&Route) -> bool) -> Option<Place> {
        Some(self.place_and_end(fits)?.0)
    }

    /// A place that fits, and what lies there.
    pub(super) fn place_and_end(
        &mut self,
        fits: impl Fn(&Route) -> bool,
    ) -> Option<(Place, PlaceType)> {
        let routes: Vec<usize> = (0..self.routes.len())
            .filter(|&i| fits(&self.routes[i]))
            .collect();
        if routes.is_empty() {
            return None;
        }
        let route = self.routes[self.rng.pick(&routes)].clone();
        let end = route.end;
        let mut place = Place::root(route.root);
        for step in route.steps {
            place = match step {
                Step::Field(field) => place.field(field),
                Step::Element(len) => place.index(self.index(len)),
                Step::Bit(width) => place.bit(self.index(width)),
            };
        }
        Some((self.perhaps_by_address(place), end))
    }

    /// Now and then the address of a place, or of a part of the way to it, in its stead; now and then
    /// something close to that.
    fn perhaps_by_address(&mut self, place: Place) -> Place {
        let rarely = self.options.addresses && self.rng.one_in(10);
        if !rarely || !matches!(place.root, Root::State | Root::Ref(_)) {
            return place;
        }
        let (start, cut) = (
            self.root_type(place.root),
            self.rng.below(place.path.len() + 1),
        );
        let found = Place::walk(&self.module.types, start, &place.path[..cut]);
        let Some(PlaceType::Mem(ty)) = found else {
            return place;
        };
        let before = Place {
            root: place.root,
            path: place.path[..cut].to_vec(),
        };
        let mut value = self.builder.address(before);
        if self.rng.one_in(4) {
            let distance = self
                .rng
                .pick(&[1, 4, 8, 40, 1 << 20, u64::MAX, u64::MAX - 7]);
            let distance = self.builder.constant(Type::I64, distance);
            value = self.builder.binary(BinaryOp::Add, value, distance);
        }
        self.spend(3);
        Place::root(Root::Deref { value, ty }).join(&place.path[cut..])
    }

    fn root_type(&self, root: Root) -> MemType {
        match root {
            Root::Ref(param) => self.refs[param.as_u32() as usize],
            Root::State | Root::Input | Root::Output | Root::Local(_) | Root::Deref { .. } => {
                MemType::Struct(self.module.state)
            }
        }
    }

    /// Mostly inside the bounds; a value may be anything.
    fn index(&mut self, len: u32) -> Index {
        if !self.options.dynamic_places || self.rng.one_in(2) {
            return Index::Const(self.rng.below(len as usize) as u32);
        }
        let value = self.leaf(Type::I32);
        if self.rng.one_in(3) {
            return Index::Value(value);
        }
        let reach = len.next_power_of_two() << self.rng.below(2);
        let mask = u64::from(reach - 1);
        let mask = self.builder.constant(Type::I32, mask);
        self.spend(2);
        Index::Value(self.builder.binary(BinaryOp::And, value, mask))
    }
}

fn is_division(op: BinaryOp) -> bool {
    matches!(
        op,
        BinaryOp::Sdiv | BinaryOp::Udiv | BinaryOp::Srem | BinaryOp::Urem
    )
}
