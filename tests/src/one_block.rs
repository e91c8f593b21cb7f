//! Random modules in the form hardware takes: one block, integers, static places. Every operation
//! of the table that such a scan can hold appears, at every width, with wide and narrow numbers.

use crate::rng::Rng;
use crate::stimulus::random_bits;
use iecc_ir::{
    BinaryOp, CompareOp, ConvertOp, FieldDef, Function, FunctionBuilder, Image, Index, InstData,
    Layout, MemType, Module, OperandClass, Place, Root, StructId, Type, TypeTable, UnaryOp, Value,
};

const INTEGERS: [Type; 5] = [Type::I1, Type::I8, Type::I16, Type::I32, Type::I64];

/// Units of time the modules count.
pub const UNITS_NS: [u64; 3] = [1_000, 1_000_000, 3_000_000];

/// A module of a seed with about `ops` operations.
pub fn one_block_module(seed: u64, ops: usize) -> Module {
    let mut rng = Rng::new(seed);
    let mut types = TypeTable::default();
    let regions = ["state", "input", "output"].map(|name| region(&mut types, name, &mut rng));
    let layout = Layout::new(&types);
    let mut image = Image::zero(&layout, &types, regions[0].0);
    for (index, &ty) in regions[0].1.iter().enumerate() {
        let place = Place::root(Root::State).field(index as u32);
        // Mostly small, so that ranges stay narrow.
        let bits = if rng.one_in(3) {
            random_bits(ty, &mut rng)
        } else {
            rng.next_u64() & 3
        };
        image.set_place(&layout, &types, regions[0].0, &place, bits & ty.mask());
    }
    let mut generator = Generator {
        builder: FunctionBuilder::new("scan", &[], &[]),
        values: Vec::new(),
        rng,
    };
    generator.body(&regions, ops);
    let mut funcs = cranelift_entity::PrimaryMap::new();
    let scan = funcs.push(by_steps(generator.builder.finish()));
    let [state, input, output] = regions.map(|(id, _)| id);
    Module {
        name: "random".to_owned(),
        types,
        state,
        input,
        output,
        image,
        funcs,
        scan,
        prescan: None,
        names: Vec::new(),
        origins: cranelift_entity::PrimaryMap::new(),
    }
}

/// The builder is for front ends and knows `elapsed` only; hardware sees `step` in its place.
fn by_steps(mut func: Function) -> Function {
    for inst in func.block(func.entry()).insts.clone() {
        if let InstData::Elapsed { unit_ns, ty, .. } = *func.inst(inst) {
            *func.inst_mut(inst) = InstData::Step { unit_ns, ty };
        }
    }
    func
}

fn region(types: &mut TypeTable, name: &str, rng: &mut Rng) -> (StructId, Vec<Type>) {
    let fields: Vec<Type> = (0..6 + rng.below(6)).map(|_| rng.pick(&INTEGERS)).collect();
    let def = fields.iter().enumerate().map(|(index, &ty)| {
        let name = format!("{}{index}", &name[..1]);
        FieldDef::new(name, MemType::Scalar(ty))
    });
    (types.add_struct(name, def.collect()), fields)
}

struct Generator {
    builder: FunctionBuilder,
    values: Vec<Value>,
    rng: Rng,
}

impl Generator {
    fn body(&mut self, regions: &[(StructId, Vec<Type>); 3], ops: usize) {
        let [(_, state), (_, input), (_, output)] = regions;
        for (root, fields) in [(Root::State, state), (Root::Input, input)] {
            for (index, &ty) in fields.iter().enumerate() {
                let value = self.builder.load(Place::root(root).field(index as u32), ty);
                self.values.push(value);
            }
        }
        for unit in UNITS_NS {
            let ty = self.rng.pick(&[Type::I32, Type::I64]);
            if self.rng.one_in(2) {
                let value = self.builder.elapsed(Place::root(Root::State), unit, ty);
                self.values.push(value);
            }
        }
        for _ in 0..ops {
            let value = self.operation();
            self.values.push(value);
        }
        self.bits(state, output);
        self.stores(Root::State, state);
        self.stores(Root::Output, output);
        self.builder.ret(Vec::new());
    }

    /// Bits of words, read and written.
    fn bits(&mut self, state: &[Type], output: &[Type]) {
        for (root, fields) in [(Root::State, state), (Root::Output, output)] {
            for (index, ty) in fields.iter().enumerate() {
                if *ty == Type::I1 || !self.rng.one_in(4) {
                    continue;
                }
                let bit = Index::Const(self.rng.below(ty.bits() as usize) as u32);
                let place = Place::root(root).field(index as u32).bit(bit);
                if root == Root::State {
                    let value = self.builder.load(place.clone(), Type::I1);
                    self.values.push(value);
                }
                let value = self.value(Type::I1);
                self.builder.store(place, value);
            }
        }
    }

    fn stores(&mut self, root: Root, fields: &[Type]) {
        for (index, &ty) in fields.iter().enumerate() {
            if self.rng.one_in(8) {
                continue;
            }
            let mut value = self.value(ty);
            if root == Root::State && ty != Type::I1 && self.rng.one_in(2) {
                // Bounded, so that range analysis finds something.
                let mask = self.builder.constant(ty, self.rng.pick(&[1, 7, 0x5f]));
                value = self.builder.binary(BinaryOp::And, value, mask);
            }
            self.builder
                .store(Place::root(root).field(index as u32), value);
        }
    }

    /// A value of a type: a recent one if there is one, else converted or constant.
    fn value(&mut self, ty: Type) -> Value {
        let fitting = |v: &&Value| self.builder.value_type(**v) == ty;
        let candidates: Vec<Value> = self.values.iter().filter(fitting).copied().collect();
        if candidates.is_empty() || self.rng.one_in(6) {
            return self.constant(ty);
        }
        let recent = candidates.len().saturating_sub(6);
        if self.rng.one_in(3) {
            self.rng.pick(&candidates)
        } else {
            self.rng.pick(&candidates[recent..])
        }
    }

    fn constant(&mut self, ty: Type) -> Value {
        let bits = random_bits(ty, &mut self.rng);
        self.builder.constant(ty, bits)
    }

    fn operation(&mut self) -> Value {
        match self.rng.below(8) {
            0 => self.unary(),
            1..=3 => self.binary(),
            4 => self.compare(),
            5 => self.convert(),
            _ => self.select(),
        }
    }

    fn integer(&mut self, class: OperandClass) -> Type {
        let first = usize::from(class == OperandClass::Int);
        self.rng.pick(&INTEGERS[first..])
    }

    fn unary(&mut self) -> Value {
        let op = self.rng.pick(&[UnaryOp::Not, UnaryOp::Neg]);
        let ty = self.integer(op.class());
        let arg = self.value(ty);
        self.builder.unary(op, arg)
    }

    fn binary(&mut self) -> Value {
        let ops: Vec<BinaryOp> = BinaryOp::ALL
            .iter()
            .copied()
            .filter(|op| op.class() != OperandClass::Float)
            .collect();
        let op = self.rng.pick(&ops);
        let ty = self.integer(op.class());
        let left = self.value(ty);
        let division = [
            BinaryOp::Sdiv,
            BinaryOp::Udiv,
            BinaryOp::Srem,
            BinaryOp::Urem,
        ];
        let shift = [BinaryOp::Shl, BinaryOp::Ushr, BinaryOp::Sshr];
        let right = if division.contains(&op) {
            self.constant(ty)
        } else if shift.contains(&op) && self.rng.one_in(2) {
            // Counts near the width, where shifts become interesting.
            let count = self.rng.below(ty.bits() as usize + 2) as u64;
            self.builder.constant(ty, count)
        } else {
            self.value(ty)
        };
        self.builder.binary(op, left, right)
    }

    fn compare(&mut self) -> Value {
        let ops: Vec<CompareOp> = CompareOp::ALL
            .iter()
            .copied()
            .filter(|op| op.class() != OperandClass::Float)
            .collect();
        let op = self.rng.pick(&ops);
        let ty = self.integer(op.class());
        let (left, right) = (self.value(ty), self.value(ty));
        self.builder.compare(op, left, right)
    }

    fn convert(&mut self) -> Value {
        loop {
            let op = self
                .rng
                .pick(&[ConvertOp::Trunc, ConvertOp::Zext, ConvertOp::Sext]);
            let (from, to) = (self.rng.pick(&INTEGERS), self.rng.pick(&INTEGERS));
            if op.accepts(from, to) {
                let arg = self.value(from);
                return self.builder.convert(op, to, arg);
            }
        }
    }

    fn select(&mut self) -> Value {
        let ty = self.rng.pick(&INTEGERS);
        let (condition, yes, no) = (self.value(Type::I1), self.value(ty), self.value(ty));
        self.builder.select(condition, yes, no)
    }
}
