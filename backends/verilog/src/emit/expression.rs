//! Nets as expressions: which ones get a wire of their own, what the wires are called, and how an
//! expression is written without any doubt about precedence, width or sign.
//!
//! A net gets a wire if it is used more than once, if bits are picked from it, if it is the next
//! value of a register, or if its text grows long. Everything else is written where it is used.

use crate::design::Design;
use crate::emit::vector;
use crate::names::Names;
use crate::net::{Gate, Net, Op, Relation, Shift, mask};
use cranelift_entity::SecondaryMap;
use iecc_ir::Origin;
use std::collections::BTreeMap;

/// Longest expression that is written into another one.
const INLINE_LENGTH: usize = 56;

/// How tightly a piece of text binds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Binding {
    /// A name, constant, selection or anything in its own brackets.
    Atom,
    /// A chain of one associative operator.
    Chain(Gate),
    /// Anything else: needs parentheses inside other expressions.
    Loose,
}

#[derive(Debug, Clone)]
struct Text {
    text: String,
    binding: Binding,
}

/// A wire to be declared.
#[derive(Debug, Clone)]
pub(super) struct Wire {
    pub(super) name: String,
    pub(super) width: u32,
    pub(super) text: String,
    pub(super) origin: Option<Origin>,
}

/// The expressions of all live nets.
pub(super) struct Expressions {
    texts: SecondaryMap<Net, Option<Text>>,
    /// In order of evaluation.
    pub(super) wires: Vec<Wire>,
    /// Bits of named nets that are read, by net.
    pub(super) read: BTreeMap<Net, Vec<bool>>,
    /// Names of nets that have one.
    pub(super) named: BTreeMap<Net, String>,
}

/// What the caller knows about names.
pub(super) struct Naming<'a> {
    /// Names of sources.
    pub(super) sources: BTreeMap<Net, String>,
    /// Wished names of next values.
    pub(super) hints: BTreeMap<Net, String>,
    /// Names of wires by what they belong to, without a number.
    pub(super) stem: &'a dyn Fn(Option<Origin>) -> String,
}

/// Writes all live nets of a design. `roots` are read from outside the netlist.
pub(super) fn write(
    design: &Design,
    roots: &[Net],
    naming: &Naming<'_>,
    names: &mut Names,
) -> Expressions {
    let mut writer = Writer {
        design,
        uses: uses(design, roots),
        must_name: SecondaryMap::new(),
        counters: BTreeMap::new(),
        out: Expressions {
            texts: SecondaryMap::new(),
            wires: Vec::new(),
            read: BTreeMap::new(),
            named: BTreeMap::new(),
        },
    };
    for net in design
        .netlist
        .nets()
        .filter(|&net| design.live.contains(net))
    {
        writer.mark(net);
    }
    for &root in roots {
        writer.read_all(root);
    }
    for net in design
        .netlist
        .nets()
        .filter(|&net| design.live.contains(net))
    {
        writer.write(net, naming, names);
    }
    writer.out
}

impl Expressions {
    /// The text of a net, to stand alone.
    pub(super) fn text(&self, net: Net) -> &str {
        &self.texts[net]
            .as_ref()
            .expect("live nets are written")
            .text
    }
}

/// Whether writing the operation costs no hardware, so that it may be repeated.
fn is_wiring(op: Op) -> bool {
    match op {
        Op::Const(_)
        | Op::Source(_)
        | Op::Not(_)
        | Op::Slice(..)
        | Op::ZeroExtend(_)
        | Op::SignExtend(_)
        | Op::Concat(_) => true,
        Op::Gate(..) | Op::Compare(..) | Op::Mux(..) | Op::Shift(..) => false,
    }
}

/// How often each net would be written if nothing had a wire; users stand behind their operands.
fn uses(design: &Design, roots: &[Net]) -> SecondaryMap<Net, u32> {
    let mut uses: SecondaryMap<Net, u32> = SecondaryMap::new();
    for &root in roots {
        uses[root] += 1;
    }
    let live = design.netlist.nets().rev();
    for net in live.filter(|&net| design.live.contains(net)) {
        let op = design.netlist.op(net);
        let times = if is_wiring(op) { uses[net].min(2) } else { 1 };
        for operand in op.operands() {
            uses[operand] += times;
        }
    }
    uses
}

struct Writer<'a> {
    design: &'a Design,
    uses: SecondaryMap<Net, u32>,
    must_name: SecondaryMap<Net, bool>,
    counters: BTreeMap<String, u32>,
    out: Expressions,
}

impl Writer<'_> {
    /// Notes what a net wants of its operands.
    fn mark(&mut self, net: Net) {
        let netlist = &self.design.netlist;
        let width = netlist.width(net);
        match netlist.op(net) {
            Op::Slice(from, low) => {
                self.must_name[from] = true;
                self.read_bits(from, low, width);
            }
            Op::SignExtend(from) => {
                self.must_name[from] |= netlist.width(from) > 1;
                self.read_all(from);
            }
            Op::Shift(Shift::RightSigned, args) => {
                // The operand must be named to be given a sign, and so must the result: beside an
                // unsigned arm of a choice the shift would lose its sign.
                self.must_name[net] = true;
                args.iter().for_each(|&arg| self.read_all(arg));
            }
            op @ (Op::Const(_)
            | Op::Source(_)
            | Op::Not(_)
            | Op::Gate(..)
            | Op::Compare(..)
            | Op::Mux(..)
            | Op::Shift(..)
            | Op::ZeroExtend(_)
            | Op::Concat(_)) => op.operands().iter().for_each(|&arg| self.read_all(arg)),
        }
    }

    fn read_bits(&mut self, net: Net, low: u32, width: u32) {
        let all = self.design.netlist.width(net) as usize;
        let bits = self.out.read.entry(net).or_insert_with(|| vec![false; all]);
        bits[low as usize..(low + width) as usize].fill(true);
    }

    fn read_all(&mut self, net: Net) {
        self.read_bits(net, 0, self.design.netlist.width(net));
    }

    fn write(&mut self, net: Net, naming: &Naming<'_>, names: &mut Names) {
        if let Some(name) = naming.sources.get(&net) {
            return self.name(net, name.clone());
        }
        let text = self.expression(net);
        let wiring = is_wiring(self.design.netlist.op(net));
        let hint = naming
            .hints
            .get(&net)
            .filter(|_| !wiring || self.must_name[net]);
        let long = text.text.len() > INLINE_LENGTH && !wiring;
        let repeated = self.uses[net] > 1 && !wiring;
        if hint.is_none() && !long && !repeated && !self.must_name[net] {
            self.out.texts[net] = Some(text);
            return;
        }
        let node = self.design.netlist.node(net);
        let name = match hint {
            Some(hint) => names.claim(hint),
            None => {
                let stem = (naming.stem)(node.origin);
                let number = self.counters.entry(stem.clone()).or_default();
                *number += 1;
                names.claim(&format!("{stem}_{number}"))
            }
        };
        self.out.wires.push(Wire {
            name: name.clone(),
            width: node.width,
            text: text.text,
            origin: node.origin,
        });
        self.name(net, name);
    }

    fn name(&mut self, net: Net, name: String) {
        self.out.named.insert(net, name.clone());
        self.out.texts[net] = Some(Text {
            text: name,
            binding: Binding::Atom,
        });
    }

    fn text(&self, net: Net) -> &Text {
        self.out.texts[net]
            .as_ref()
            .expect("operands are written first")
    }

    /// The text as an operand.
    fn operand(&self, net: Net) -> String {
        let Text { text, binding } = self.text(net);
        match binding {
            Binding::Atom => text.clone(),
            Binding::Chain(_) | Binding::Loose => format!("({text})"),
        }
    }

    /// The text as a link of a chain of one operator.
    fn link(&self, net: Net, gate: Gate) -> String {
        let Text { text, binding } = self.text(net);
        if *binding == Binding::Chain(gate) {
            text.clone()
        } else {
            self.operand(net)
        }
    }

    fn expression(&self, net: Net) -> Text {
        let netlist = &self.design.netlist;
        let width = netlist.width(net);
        let atom = |text: String| Text {
            text,
            binding: Binding::Atom,
        };
        let loose = |text: String| Text {
            text,
            binding: Binding::Loose,
        };
        match netlist.op(net) {
            Op::Const(bits) => atom(constant(width, bits)),
            Op::Source(_) => panic!("sources have names"),
            Op::Not(a) => atom(format!("~{}", self.operand(a))),
            Op::Gate(gate, args) => self.gate(gate, args),
            Op::Compare(relation, signed, args) => loose(self.compare(relation, signed, args)),
            Op::Mux(condition, [a, b]) => loose(format!(
                "{} ? {} : {}",
                self.operand(condition),
                self.operand(a),
                self.operand(b)
            )),
            Op::Shift(shift, [a, count]) => loose(self.shift(shift, a, count)),
            Op::Slice(from, low) => atom(selection(&self.text(from).text, low, width)),
            Op::ZeroExtend(a) => {
                let zeros = constant(width - netlist.width(a), 0);
                atom(format!("{{{zeros}, {}}}", self.text(a).text))
            }
            Op::SignExtend(a) => atom(self.sign_extension(a, width)),
            Op::Concat([high, low]) => {
                let (high, low) = (&self.text(high).text, &self.text(low).text);
                atom(format!("{{{high}, {low}}}"))
            }
        }
    }

    fn gate(&self, gate: Gate, [a, b]: [Net; 2]) -> Text {
        let netlist = &self.design.netlist;
        let width = netlist.width(b);
        let binding = match gate {
            Gate::And | Gate::Or | Gate::Xor => Binding::Chain(gate),
            Gate::Add | Gate::Sub | Gate::Mul => Binding::Loose,
        };
        let text = match (gate, netlist.as_const(b)) {
            (Gate::Add, Some(bits)) if width > 1 && width <= 128 && bits >> (width - 1) == 1 => {
                // Adding a number that wraps is subtracting a small one.
                let minus = bits.wrapping_neg() & mask(width);
                format!("{} - {}", self.operand(a), constant(width, minus))
            }
            _ => format!(
                "{} {} {}",
                self.link(a, gate),
                symbol(gate),
                self.link(b, gate)
            ),
        };
        Text { text, binding }
    }

    fn compare(&self, relation: Relation, signed: bool, [a, b]: [Net; 2]) -> String {
        let symbol = match relation {
            Relation::Eq => "==",
            Relation::Ne => "!=",
            Relation::Lt => "<",
            Relation::Le => "<=",
            Relation::Gt => ">",
            Relation::Ge => ">=",
        };
        if !signed {
            return format!("{} {symbol} {}", self.operand(a), self.operand(b));
        }
        // Both sides have one width and both are signed, so Verilog compares as meant.
        let [a, b] = [a, b].map(|net| match self.design.netlist.as_const(net) {
            Some(bits) => signed_constant(self.design.netlist.width(net), bits),
            None => format!("$signed({})", self.text(net).text),
        });
        format!("{a} {symbol} {b}")
    }

    fn shift(&self, shift: Shift, a: Net, count: Net) -> String {
        let (a_text, count) = (self.operand(a), self.operand(count));
        match shift {
            Shift::Left => format!("{a_text} << {count}"),
            Shift::Right => format!("{a_text} >> {count}"),
            Shift::RightSigned => format!("$signed({}) >>> {count}", self.text(a).text),
        }
    }

    fn sign_extension(&self, a: Net, width: u32) -> String {
        let from = self.design.netlist.width(a);
        let text = &self.text(a).text;
        if from == 1 {
            return format!("{{{width}{{{text}}}}}");
        }
        let sign = selection(text, from - 1, 1);
        format!("{{{{{}{{{sign}}}}}, {text}}}", width - from)
    }
}

fn symbol(gate: Gate) -> &'static str {
    match gate {
        Gate::And => "&",
        Gate::Or => "|",
        Gate::Xor => "^",
        Gate::Add => "+",
        Gate::Sub => "-",
        Gate::Mul => "*",
    }
}

fn selection(name: &str, low: u32, width: u32) -> String {
    if width == 1 {
        format!("{name}[{low}]")
    } else {
        format!("{name}[{}:{low}]", low + width - 1)
    }
}

/// A sized literal: decimal for numbers people count with, else hexadecimal.
pub(super) fn constant(width: u32, bits: u128) -> String {
    if width == 1 {
        format!("1'b{bits}")
    } else if bits < 1 << 31 {
        format!("{width}'d{bits}")
    } else {
        format!("{width}'h{bits:x}")
    }
}

fn signed_constant(width: u32, bits: u128) -> String {
    let sign = 1u128 << (width - 1);
    let magnitude = bits.wrapping_neg() & mask(width);
    match () {
        () if bits & sign == 0 => format!("{width}'s{}", digits(bits)),
        () if bits == sign => format!("$signed({width}'h{bits:x})"),
        () => format!("-{width}'s{}", digits(magnitude)),
    }
}

fn digits(bits: u128) -> String {
    if bits < 1 << 31 {
        format!("d{bits}")
    } else {
        format!("h{bits:x}")
    }
}

/// `name` or the bits of it that were never read, as text.
pub(super) fn unread(name: &str, read: &[bool]) -> Vec<String> {
    if read.iter().all(|&bit| !bit) {
        return vec![name.to_owned()];
    }
    let mut parts = Vec::new();
    let mut low = 0;
    while low < read.len() {
        let same = read[low..]
            .iter()
            .take_while(|&&bit| bit == read[low])
            .count();
        if !read[low] {
            parts.push(selection(name, low as u32, same as u32));
        }
        low += same;
    }
    parts
}

/// `wire [11:0] name = text;`
pub(super) fn declaration(wire: &Wire) -> String {
    format!("wire {}{} = {};", vector(wire.width), wire.name, wire.text)
}
