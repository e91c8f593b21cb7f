//! The hardware of a program: ports, registers, dividers, and the nets that reach an output.
//! Whatever cannot be seen at an output is not part of it.

use crate::clock::Divider;
use crate::facts::whole;
use crate::names::place_text;
use crate::net::{Net, Netlist, Op, Source, Word};
use crate::options::Options;
use crate::scan::{Scan, lower};
use cranelift_entity::EntitySet;
use iecc_ir::analysis::Range;
use iecc_ir::{Layout, MemType, Module, Place, Region, Root, Type};
use std::collections::BTreeMap;

/// An input or output of the module.
#[derive(Debug, Clone)]
pub(crate) struct Port {
    /// The public name.
    pub(crate) name: String,
    /// Byte offset in its region.
    pub(crate) offset: u64,
    pub(crate) ty: Type,
}

/// An input port.
#[derive(Debug, Clone)]
pub(crate) struct InputPort {
    pub(crate) port: Port,
    /// The net of its value in the scan, if anything depends on it.
    pub(crate) net: Option<Net>,
}

/// An output port.
#[derive(Debug, Clone)]
pub(crate) struct OutputPort {
    pub(crate) port: Port,
    /// The register that drives it; without one it is 0 for ever.
    pub(crate) register: Option<usize>,
}

/// What a register is for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Keeps a scalar of the state.
    State(Place),
    /// Keeps an output that equals no state register, by position.
    Output(usize),
}

/// A register.
#[derive(Debug, Clone)]
pub(crate) struct Register {
    pub(crate) purpose: Purpose,
    /// The tag as the user writes it.
    pub(crate) tag: String,
    pub(crate) ty: Type,
    pub(crate) range: Range,
    pub(crate) initial: u64,
    /// Its value in the scan, if anything reads it.
    pub(crate) net: Option<Net>,
    pub(crate) next: Net,
}

impl Register {
    /// Number of bits.
    pub(crate) fn width(&self) -> u32 {
        self.range.bits()
    }

    /// Whether the highest bit is a sign.
    pub(crate) fn signed(&self) -> bool {
        self.range.is_signed()
    }
}

/// A tick divider.
#[derive(Debug, Clone)]
pub(crate) struct StepUnit {
    pub(crate) unit_ns: u64,
    pub(crate) divider: Divider,
    /// The net of the step in the scan; a base that only feeds other units has none.
    pub(crate) net: Option<Net>,
    /// Counts the ticks of the unit at this position, so many for each of its own.
    pub(crate) counts: Option<(usize, u64)>,
}

/// Everything the text is made from.
pub(crate) struct Design {
    pub(crate) netlist: Netlist,
    pub(crate) inputs: Vec<InputPort>,
    pub(crate) outputs: Vec<OutputPort>,
    pub(crate) registers: Vec<Register>,
    pub(crate) units: Vec<StepUnit>,
    /// Nets that reach an output.
    pub(crate) live: EntitySet<Net>,
    /// State the scan touches that reaches no output, and state that never changes, by tag.
    pub(crate) unseen: Vec<String>,
    pub(crate) fixed: Vec<(String, i64)>,
}

/// The ports of a region: one for every scalar of its fields.
pub(crate) fn ports(module: &Module, region: Region) -> Vec<(Place, Port)> {
    let (root, id) = match region {
        Region::Input => (Root::Input, module.input),
        Region::Output => (Root::Output, module.output),
        Region::State => panic!("the state has no ports"),
    };
    let layout = Layout::new(&module.types);
    let mut found = Vec::new();
    let ty = MemType::Struct(id);
    layout.for_each_leaf(
        &module.types,
        &Place::root(root),
        ty,
        &mut |place, offset, ty| {
            let name = place_text(module, place);
            found.push((place.clone(), Port { name, offset, ty }));
        },
    );
    found
}

/// Builds the hardware of a program that passed the check.
pub(crate) fn design(module: &Module, options: &Options) -> Design {
    let mut scan = lower(module, options);
    let mut registers = state_registers(module, &mut scan);
    let outputs = outputs(module, &mut scan, &mut registers);
    let (live, used) = liveness(&scan.netlist, &registers, &outputs);
    let (unseen, fixed) = leftovers(module, &scan, &used);
    let inputs = inputs(module, &scan, &live);
    let units = units(&scan, options, &live);
    let (registers, outputs) = keep(registers, outputs, &used, &live);
    Design {
        netlist: scan.netlist,
        inputs,
        outputs,
        registers,
        units,
        live,
        unseen,
        fixed,
    }
}

/// One register per state leaf that is stored, in order of [`Source::Register`] where it is one.
fn state_registers(module: &Module, scan: &mut Scan) -> Vec<Register> {
    let mut registers = Vec::new();
    for (index, place) in scan.registers.clone().iter().enumerate() {
        let leaf = scan.facts.leaves[place].clone();
        let (width, signed) = (leaf.range.bits(), leaf.range.is_signed());
        let net = scan.netlist.source(Source::Register(index as u32), width);
        // What is never stored was read as a constant; its source stays unused.
        let word = scan.memory.get(place).copied();
        let word = word.unwrap_or(Word { net, signed });
        registers.push(Register {
            purpose: Purpose::State(place.clone()),
            tag: place_text(module, place),
            ty: leaf.ty,
            range: leaf.range,
            initial: leaf.initial,
            net: Some(net),
            next: scan.netlist.fit(word, width),
        });
    }
    registers
}

/// Outputs share a register that starts at 0 and always holds the same number; others get one.
fn outputs(module: &Module, scan: &mut Scan, registers: &mut Vec<Register>) -> Vec<OutputPort> {
    let mut outputs = Vec::new();
    for (position, (place, port)) in ports(module, Region::Output).into_iter().enumerate() {
        let register = scan.memory.get(&place).copied().and_then(|word| {
            let all = scan.netlist.fit(word, port.ty.bits());
            if scan.netlist.as_const(all) == Some(0) {
                return None;
            }
            let shared = shared_register(&mut scan.netlist, registers, &port, all);
            Some(shared.unwrap_or_else(|| {
                let register = output_register(scan, &port, position, word);
                registers.push(register);
                registers.len() - 1
            }))
        });
        outputs.push(OutputPort { port, register });
    }
    outputs
}

fn shared_register(
    netlist: &mut Netlist,
    registers: &[Register],
    port: &Port,
    all: Net,
) -> Option<usize> {
    let bits = port.ty.bits();
    registers.iter().position(|register| {
        if register.initial != 0 || register.width() > bits {
            return false;
        }
        let word = Word {
            net: register.next,
            signed: register.signed(),
        };
        netlist.fit(word, bits) == all
    })
}

fn output_register(scan: &mut Scan, port: &Port, position: usize, word: Word) -> Register {
    let bits = scan.netlist.width(word.net);
    // The range of the bits kept, which holds the initial 0.
    let range = match (word.signed, bits) {
        (true, _) => Range::new(i64::MIN >> (64 - bits), i64::MAX >> (64 - bits)),
        (false, 64) => Range::of_type(Type::I64),
        (false, _) => Range::new(0, i64::MAX >> (63 - bits)),
    };
    let next = scan.netlist.fit(word, range.bits());
    Register {
        purpose: Purpose::Output(position),
        tag: port.name.clone(),
        ty: port.ty,
        range,
        initial: 0,
        net: None,
        next,
    }
}

/// Nets and registers that reach an output.
fn liveness(
    netlist: &Netlist,
    registers: &[Register],
    outputs: &[OutputPort],
) -> (EntitySet<Net>, Vec<bool>) {
    let mut live = EntitySet::new();
    let mut used = vec![false; registers.len()];
    let mut nets = Vec::new();
    for output in outputs {
        if let Some(index) = output.register
            && !std::mem::replace(&mut used[index], true)
        {
            nets.push(registers[index].next);
        }
    }
    while let Some(net) = nets.pop() {
        if !live.insert(net) {
            continue;
        }
        if let Op::Source(Source::Register(index)) = netlist.op(net)
            && !std::mem::replace(&mut used[index as usize], true)
        {
            nets.push(registers[index as usize].next);
        }
        nets.extend(netlist.op(net).operands());
    }
    (live, used)
}

fn leftovers(module: &Module, scan: &Scan, used: &[bool]) -> (Vec<String>, Vec<(String, i64)>) {
    let (mut unseen, mut fixed) = (Vec::new(), Vec::new());
    for (place, used) in scan.registers.iter().zip(used) {
        let leaf = &scan.facts.leaves[place];
        let tag = place_text(module, place);
        if !leaf.stored {
            fixed.push((tag, leaf.range.lo));
        } else if !used {
            unseen.push(tag);
        }
    }
    (unseen, fixed)
}

fn inputs(module: &Module, scan: &Scan, live: &EntitySet<Net>) -> Vec<InputPort> {
    let sources = live_sources(&scan.netlist, live);
    let port = |(place, port): (Place, Port)| {
        let known = scan.inputs.iter().position(|known| *known == whole(&place));
        let net = known.and_then(|index| sources.get(&Source::Input(index as u32)).copied());
        InputPort { port, net }
    };
    let ports = ports(module, Region::Input);
    ports.into_iter().map(port).collect()
}

fn live_sources(netlist: &Netlist, live: &EntitySet<Net>) -> BTreeMap<Source, Net> {
    let nets = netlist.nets().filter(|&net| live.contains(net));
    nets.filter_map(|net| netlist.as_source(net).map(|source| (source, net)))
        .collect()
}

/// The dividers of the units in use, finest first. Coarser units count the ticks of the finest
/// one where it ticks at most once per clock and goes into them.
fn units(scan: &Scan, options: &Options, live: &EntitySet<Net>) -> Vec<StepUnit> {
    let sources = live_sources(&scan.netlist, live);
    let mut wanted: BTreeMap<u64, Option<Net>> = BTreeMap::new();
    for (index, &unit_ns) in scan.units.iter().enumerate() {
        if let Some(&net) = sources.get(&Source::Step(index as u32)) {
            wanted.insert(unit_ns, Some(net));
        }
    }
    if let (Some(base), false) = (options.tick_ns, wanted.is_empty()) {
        wanted.entry(base).or_insert(None);
    }
    let mut units: Vec<StepUnit> = Vec::new();
    for (unit_ns, net) in wanted {
        let divider = Divider::new(options.clock, unit_ns).expect("checked");
        let base = units.first();
        let counts =
            base.filter(|base| base.divider.whole == 0 && unit_ns.is_multiple_of(base.unit_ns));
        let counts = counts.map(|base| (0, unit_ns / base.unit_ns));
        units.push(StepUnit {
            unit_ns,
            divider,
            net,
            counts,
        });
    }
    units
}

/// Drops what is not used and renumbers.
fn keep(
    registers: Vec<Register>,
    mut outputs: Vec<OutputPort>,
    used: &[bool],
    live: &EntitySet<Net>,
) -> (Vec<Register>, Vec<OutputPort>) {
    let mut position = vec![0; registers.len()];
    let mut kept = Vec::new();
    for (index, mut register) in registers.into_iter().enumerate() {
        if used[index] {
            position[index] = kept.len();
            register.net = register.net.filter(|&net| live.contains(net));
            kept.push(register);
        }
    }
    for output in &mut outputs {
        output.register = output.register.map(|index| position[index]);
    }
    (kept, outputs)
}
