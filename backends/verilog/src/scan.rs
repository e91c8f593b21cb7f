//! The scan function as a netlist: every value becomes a word of exactly the bits that
//! [`Facts`] allow, every memory leaf a source and a next value.

use crate::check::{divisor_of, is_division};
use crate::facts::{Facts, Leaf, bit_of, whole};
use crate::net::{Gate, Net, Netlist, Relation, Shift, Source, Word};
use crate::options::Options;
use cranelift_entity::SecondaryMap;
use iecc_ir::analysis::Range;
use iecc_ir::{
    BinaryOp, CompareOp, ConvertOp, Function, Inst, InstData, Module, Place, Root, Type, UnaryOp,
    Value,
};
use std::collections::BTreeMap;

/// The netlist of a scan and what becomes of memory.
pub(crate) struct Scan {
    pub(crate) netlist: Netlist,
    pub(crate) facts: Facts,
    /// State leaves in order of [`Source::Register`].
    pub(crate) registers: Vec<Place>,
    /// Input leaves in order of [`Source::Input`].
    pub(crate) inputs: Vec<Place>,
    /// Units in nanoseconds in order of [`Source::Step`].
    pub(crate) units: Vec<u64>,
    /// What stored leaves hold at the end.
    pub(crate) memory: BTreeMap<Place, Word>,
}

/// Builds the netlist of a scan function that passed the check.
pub(crate) fn lower(module: &Module, options: &Options) -> Scan {
    let func = &module.funcs[module.scan];
    let facts = Facts::new(module, options);
    let roots = |root: Root| {
        let places = facts.leaves.keys().filter(move |place| place.root == root);
        places.cloned().collect::<Vec<_>>()
    };
    let mut lowering = Lowering {
        func,
        options,
        words: SecondaryMap::new(),
        scan: Scan {
            registers: roots(Root::State),
            inputs: roots(Root::Input),
            netlist: Netlist::default(),
            units: Vec::new(),
            memory: BTreeMap::new(),
            facts,
        },
    };
    for &inst in &func.block(func.entry()).insts {
        lowering.inst(inst);
    }
    lowering.scan
}

pub(crate) struct Lowering<'m> {
    pub(crate) func: &'m Function,
    options: &'m Options,
    words: SecondaryMap<Value, Option<Word>>,
    pub(crate) scan: Scan,
}

impl Lowering<'_> {
    pub(crate) fn net(&mut self) -> &mut Netlist {
        &mut self.scan.netlist
    }

    pub(crate) fn range(&self, value: Value) -> Range {
        self.scan.facts.range(value)
    }

    fn word(&self, value: Value) -> Word {
        self.words[value].expect("operands are demanded and stand before their use")
    }

    /// The low `width` bits of a word.
    pub(crate) fn fit(&mut self, word: Word, width: u32) -> Net {
        self.net().fit(word, width)
    }

    /// The low `width` bits of a value.
    pub(crate) fn bits(&mut self, value: Value, width: u32) -> Net {
        let word = self.word(value);
        self.fit(word, width)
    }

    /// The value read as unsigned, in as few bits as that takes.
    pub(crate) fn unsigned(&mut self, value: Value) -> Net {
        if self.range(value).is_signed() {
            let bits = self.func.value_type(value).bits();
            self.bits(value, bits)
        } else {
            self.word(value).net
        }
    }

    /// The value as a number: plain binary or, if it can be negative, two's complement.
    pub(crate) fn number(&self, value: Value) -> Word {
        self.word(value)
    }

    fn inst(&mut self, inst: Inst) {
        let func = self.func;
        self.net().origin = func.origin(inst);
        let data = func.inst(inst);
        if let InstData::Store { place, value } = data {
            return self.store(place, *value);
        }
        let value = func.result(inst);
        let width = self.scan.facts.width(value);
        if width == 0 {
            return;
        }
        let range = self.range(value);
        let net = match range.as_constant() {
            Some(number) => self.net().constant(width, number as u128),
            None => self.compute(data, width),
        };
        assert_eq!(self.net().width(net), width, "{data:?}");
        let signed = range.is_signed() && width == range.bits();
        self.words[value] = Some(Word { net, signed });
    }

    /// The low `width` bits of what an instruction computes.
    fn compute(&mut self, data: &InstData, width: u32) -> Net {
        match data {
            InstData::Const { bits, .. } => self.net().constant(width, u128::from(*bits)),
            InstData::Unary { op, arg } => self.unary(*op, *arg, width),
            InstData::Binary { op, args } => self.binary(*op, *args, width),
            InstData::Compare { op, args } => self.compare(*op, *args),
            InstData::Convert { op, arg, .. } => self.convert(*op, *arg, width),
            InstData::Select { cond, args } => {
                let condition = self.bits(*cond, 1);
                let (a, b) = (self.bits(args[0], width), self.bits(args[1], width));
                self.net().mux(condition, a, b)
            }
            InstData::Load { place } => self.load(place, width),
            InstData::Step { unit_ns, .. } => self.step(*unit_ns, width),
            InstData::Store { .. }
            | InstData::Copy { .. }
            | InstData::Clear { .. }
            | InstData::Address { .. }
            | InstData::Now
            | InstData::Elapsed { .. }
            | InstData::Call { .. } => panic!("refused by the check"),
        }
    }

    fn unary(&mut self, op: UnaryOp, arg: Value, width: u32) -> Net {
        let a = self.bits(arg, width);
        match op {
            UnaryOp::Not => self.net().not(a),
            UnaryOp::Neg => self.negate(a),
            UnaryOp::Fneg | UnaryOp::Fabs | UnaryOp::Fsqrt => panic!("refused by the check"),
        }
    }

    pub(crate) fn negate(&mut self, a: Net) -> Net {
        let width = self.net().width(a);
        let zero = self.net().constant(width, 0);
        self.net().gate(Gate::Sub, zero, a)
    }

    fn binary(&mut self, op: BinaryOp, [a, b]: [Value; 2], width: u32) -> Net {
        if is_division(op) {
            let divisor = divisor_of(self.func, self.options, b).expect("checked");
            return self.divide(op, a, divisor, width);
        }
        let gate = match op {
            BinaryOp::Add => Gate::Add,
            BinaryOp::Sub => Gate::Sub,
            BinaryOp::Mul => Gate::Mul,
            BinaryOp::And => Gate::And,
            BinaryOp::Or => Gate::Or,
            BinaryOp::Xor => Gate::Xor,
            BinaryOp::Shl => return self.shift_left(a, b, width),
            BinaryOp::Ushr | BinaryOp::Sshr => {
                return self.shift_right(a, b, width, op == BinaryOp::Sshr);
            }
            BinaryOp::Sdiv
            | BinaryOp::Udiv
            | BinaryOp::Srem
            | BinaryOp::Urem
            | BinaryOp::Fadd
            | BinaryOp::Fsub
            | BinaryOp::Fmul
            | BinaryOp::Fdiv => panic!("divided above or refused by the check"),
        };
        let (a, b) = (self.bits(a, width), self.bits(b, width));
        self.net().gate(gate, a, b)
    }

    fn shift_left(&mut self, a: Value, count: Value, width: u32) -> Net {
        let operand = self.bits(a, width);
        let count = self.unsigned(count);
        self.shift(Shift::Left, operand, count)
    }

    fn shift_right(&mut self, a: Value, count: Value, width: u32, arithmetic: bool) -> Net {
        let bits = self.func.value_type(a).bits();
        let range = self.range(a);
        if let Some(by) = self.range(count).as_constant() {
            return self.shift_right_by(a, by, width, arithmetic);
        }
        let signed = arithmetic && range.is_signed();
        let (kind, operand) = if signed {
            (Shift::RightSigned, self.number(a).net)
        } else {
            (Shift::Right, self.unsigned(a))
        };
        let count = self.unsigned(count);
        let net = self.shift(kind, operand, count);
        // The result of the whole operand, of which the low bits are wanted.
        debug_assert!(self.net().width(net) <= bits);
        self.fit(Word { net, signed }, width)
    }

    /// Bits `by..by + width` of the operand filled up to its type and beyond.
    fn shift_right_by(&mut self, a: Value, by: i64, width: u32, arithmetic: bool) -> Net {
        let bits = self.func.value_type(a).bits();
        let by = u32::try_from(by).map_or(bits, |by| by.min(bits));
        if arithmetic {
            let operand = self.bits(a, by + width);
            return self.net().slice(operand, by, width);
        }
        let operand = self.bits(a, (by + width).min(bits));
        let net = if by == bits {
            self.net().constant(1, 0)
        } else {
            self.net().slice(operand, by, width.min(bits - by))
        };
        self.fit(Word { net, signed: false }, width)
    }

    /// A shift by any count: those of the operand's width or more give 0 or the sign.
    fn shift(&mut self, kind: Shift, a: Net, count: Net) -> Net {
        let (width, count_width) = (self.net().width(a), self.net().width(count));
        let enough = width.next_power_of_two().trailing_zeros().max(1);
        if count_width <= enough {
            return self.net().shift(kind, a, count);
        }
        let low = self.net().slice(count, 0, enough);
        let shifted = self.net().shift(kind, a, low);
        let high = self.net().slice(count, enough, count_width - enough);
        let zero = self.net().constant(count_width - enough, 0);
        let too_far = self.net().compare(Relation::Ne, false, high, zero);
        let rest = match kind {
            Shift::Left | Shift::Right => self.net().constant(width, 0),
            Shift::RightSigned => {
                let sign = self.net().slice(a, width - 1, 1);
                self.net().sign_extend(sign, width)
            }
        };
        self.net().mux(too_far, rest, shifted)
    }

    fn compare(&mut self, op: CompareOp, args: [Value; 2]) -> Net {
        let (relation, signed) = match op {
            CompareOp::Eq => (Relation::Eq, true),
            CompareOp::Ne => (Relation::Ne, true),
            CompareOp::Slt => (Relation::Lt, true),
            CompareOp::Sle => (Relation::Le, true),
            CompareOp::Sgt => (Relation::Gt, true),
            CompareOp::Sge => (Relation::Ge, true),
            CompareOp::Ult => (Relation::Lt, false),
            CompareOp::Ule => (Relation::Le, false),
            CompareOp::Ugt => (Relation::Gt, false),
            CompareOp::Uge => (Relation::Ge, false),
            CompareOp::Feq
            | CompareOp::Fne
            | CompareOp::Flt
            | CompareOp::Fle
            | CompareOp::Fgt
            | CompareOp::Fge => panic!("refused by the check"),
        };
        self.relate(relation, signed, args)
    }

    fn convert(&mut self, op: ConvertOp, arg: Value, width: u32) -> Net {
        let from = self.func.value_type(arg);
        match op {
            ConvertOp::Trunc => self.bits(arg, width),
            ConvertOp::Zext => {
                let net = self.bits(arg, width.min(from.bits()));
                self.fit(Word { net, signed: false }, width)
            }
            ConvertOp::Sext if from == Type::I1 => {
                let bit = self.bits(arg, 1);
                self.net().sign_extend(bit, width)
            }
            ConvertOp::Sext => self.bits(arg, width),
            ConvertOp::Promote
            | ConvertOp::Demote
            | ConvertOp::SintToFloat
            | ConvertOp::UintToFloat
            | ConvertOp::FloatToSint
            | ConvertOp::FloatToUint
            | ConvertOp::FloatBits
            | ConvertOp::BitsFloat => panic!("refused by the check"),
        }
    }

    fn step(&mut self, unit_ns: u64, width: u32) -> Net {
        let known = self.scan.units.iter().position(|&unit| unit == unit_ns);
        let index = known.unwrap_or_else(|| {
            self.scan.units.push(unit_ns);
            self.scan.units.len() - 1
        });
        let most = crate::clock::max_step(self.options.clock, unit_ns);
        let bits = (64 - most.leading_zeros()).max(1);
        let net = self.net().source(Source::Step(index as u32), bits);
        self.fit(Word { net, signed: false }, width)
    }

    /// What a leaf holds now.
    fn leaf(&mut self, place: &Place) -> Word {
        if let Some(&word) = self.scan.memory.get(place) {
            return word;
        }
        let leaf = self.scan.facts.leaves[place].clone();
        self.initial_word(place, &leaf)
    }

    /// What a leaf holds when the scan begins.
    fn initial_word(&mut self, place: &Place, leaf: &Leaf) -> Word {
        let width = leaf.range.bits();
        let signed = leaf.range.is_signed();
        let index = |places: &[Place]| {
            let found = places.iter().position(|known| known == place);
            found.expect("leaf is known") as u32
        };
        let source = match place.root {
            Root::State if !leaf.stored => {
                let net = self.net().constant(width, u128::from(leaf.initial));
                return Word { net, signed };
            }
            Root::State => Source::Register(index(&self.scan.registers)),
            Root::Input => Source::Input(index(&self.scan.inputs)),
            Root::Output | Root::Ref(_) | Root::Local(_) | Root::Deref { .. } => {
                panic!("verified and checked: never loaded")
            }
        };
        let net = self.net().source(source, width);
        Word { net, signed }
    }

    fn load(&mut self, place: &Place, width: u32) -> Net {
        let word = self.leaf(&whole(place));
        match bit_of(place) {
            None => self.fit(word, width),
            Some(bit) => {
                let all = self.fit(word, bit + 1);
                self.net().slice(all, bit, 1)
            }
        }
    }

    fn store(&mut self, place: &Place, value: Value) {
        let Some(word) = self.words[value] else {
            return; // Overwritten before anyone looks.
        };
        let leaf = whole(place);
        let word = match bit_of(place) {
            None => word,
            Some(bit) => self.insert_bit(&leaf, bit, word.net),
        };
        self.scan.memory.insert(leaf, word);
    }

    fn insert_bit(&mut self, leaf: &Place, bit: u32, value: Net) -> Word {
        let bits = self.scan.facts.leaves[leaf].ty.bits();
        let old = match leaf.root {
            // Outputs start each scan as they are in the byte region: this is not readable, so a
            // bit store to an output without a whole store before it keeps 0.
            Root::Output if !self.scan.memory.contains_key(leaf) => self.net().constant(bits, 0),
            Root::Output
            | Root::State
            | Root::Input
            | Root::Ref(_)
            | Root::Local(_)
            | Root::Deref { .. } => {
                let word = self.leaf(leaf);
                self.fit(word, bits)
            }
        };
        let mut net = value;
        if bit > 0 {
            let low = self.net().slice(old, 0, bit);
            net = self.net().concat(net, low);
        }
        if bit + 1 < bits {
            let high = self.net().slice(old, bit + 1, bits - bit - 1);
            net = self.net().concat(high, net);
        }
        Word { net, signed: true }
    }
}
