//! All places a function can name, by what lies there.

use super::types::{LAST, timer_field};
use iecc_ir::{Local, MemType, Module, PlaceType, RefParam, Root, Type};

/// A step of a [`Route`].
#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    Field(u32),
    /// An element of an array of this length.
    Element(u32),
    /// A bit of an integer of this width.
    Bit(u32),
}

/// A place whose indices are still open.
#[derive(Debug, Clone)]
pub(super) struct Route {
    pub(super) root: Root,
    pub(super) steps: Vec<Step>,
    pub(super) end: PlaceType,
    /// Only loaded: inputs, and timers outside their own statement.
    pub(super) is_constant: bool,
}

impl Route {
    /// Whether it leads into memory that is kept from scan to scan and may be changed.
    pub(super) fn is_kept(&self) -> bool {
        match self.root {
            Root::State | Root::Ref(_) | Root::Local(_) => !self.is_constant,
            Root::Input | Root::Output | Root::Deref { .. } => false,
        }
    }

    /// Whether it ends in a value of the type.
    pub(super) fn is_value(&self, ty: Type) -> bool {
        self.end.scalar() == Some(ty)
    }
}

/// Every route from every region, reference and local of a function, but for the times timers keep.
pub(super) fn routes(module: &Module, refs: &[MemType], locals: &[MemType]) -> Vec<Route> {
    let regions = [
        (Root::State, module.state),
        (Root::Input, module.input),
        (Root::Output, module.output),
    ];
    let mut routes = Vec::new();
    for (root, id) in regions {
        Collector::new(module, root, &mut routes).collect(MemType::Struct(id));
    }
    let refs = (0..).zip(refs);
    let refs = refs.map(|(index, &ty)| (Root::Ref(RefParam::from_u32(index)), ty));
    let locals = (0..).zip(locals);
    let locals = locals.map(|(index, &ty)| (Root::Local(Local::from_u32(index)), ty));
    for (root, ty) in refs.chain(locals) {
        // The same chance for a reference or local as for the state, which has many more places.
        for _ in 0..4 {
            Collector::new(module, root, &mut routes).collect(ty);
        }
    }
    routes
}

struct Collector<'a> {
    module: &'a Module,
    root: Root,
    steps: Vec<Step>,
    in_timer: bool,
    routes: &'a mut Vec<Route>,
}

impl<'a> Collector<'a> {
    fn new(module: &'a Module, root: Root, routes: &'a mut Vec<Route>) -> Self {
        Self {
            module,
            root,
            steps: Vec::new(),
            in_timer: false,
            routes,
        }
    }

    fn add(&mut self, end: PlaceType) {
        self.routes.push(Route {
            root: self.root,
            steps: self.steps.clone(),
            end,
            is_constant: self.in_timer || self.root == Root::Input,
        });
    }

    fn collect(&mut self, ty: MemType) {
        self.add(PlaceType::Mem(ty));
        match ty {
            MemType::Scalar(scalar) if scalar.is_int() && scalar != Type::I1 => {
                self.steps.push(Step::Bit(scalar.bits()));
                self.add(PlaceType::Bit);
                self.steps.pop();
            }
            MemType::Scalar(_) => {}
            MemType::Struct(id) => {
                let first_timer = timer_field(&self.module.types, self.module.state, 0);
                for (index, field) in self.module.types.structs[id].fields.iter().enumerate() {
                    let index = index as u32;
                    if self.in_timer && index == LAST {
                        continue;
                    }
                    let outside = self.in_timer;
                    self.in_timer |= id == self.module.state && index >= first_timer;
                    self.step(Step::Field(index), field.ty);
                    self.in_timer = outside;
                }
            }
            MemType::Array(id) => {
                let array = self.module.types.array_type(id);
                self.step(Step::Element(array.len), array.element);
            }
        }
    }

    fn step(&mut self, step: Step, ty: MemType) {
        self.steps.push(step);
        self.collect(ty);
        self.steps.pop();
    }
}
