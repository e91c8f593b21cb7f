//! One instruction: its operands are checked against the kinds of its row, and its meaning becomes an
//! operation.

use super::check::Cursor;
use super::operands::{Slot, literal_of};
use super::{Analysis, instructions};
use crate::hir::{
    self, Action, Computation, Condition, Const, Elementary, Op, Operand, Place, ResetKind,
    StructKind, Type,
};
use iecc_ast::rung::{self, Instruction, OperandKind as Written};
use iecc_diag::{Code, Diagnostic};
use instructions::{Calculation, Meaning, OperandKind, Passing, Row};

/// One instruction being checked.
pub(crate) struct Checker<'a> {
    pub(crate) cursor: Cursor<'a>,
    pub(crate) instruction: &'a Instruction,
    pub(crate) row: &'static Row,
    /// It is the first instruction of its routine.
    pub(crate) first: bool,
}

impl<'a> Checker<'a> {
    fn slot(&self, index: usize) -> Slot<'a> {
        Slot {
            program: self.cursor.program(),
            instruction: &self.instruction.mnemonic.node,
            name: self.row.operands[index].0,
            operand: &self.instruction.operands[index],
        }
    }

    pub(crate) fn named_slot(&self, name: &'a str, operand: &'a rung::Operand) -> Slot<'a> {
        Slot {
            program: self.cursor.program(),
            instruction: &self.instruction.mnemonic.node,
            name,
            operand,
        }
    }

    /// Whether every operand is what the table asks for there is checked here, by the table.
    fn checked(&self, analysis: &mut Analysis<'_>) -> Option<Vec<Checked>> {
        let checked: Vec<Option<Checked>> = (0..self.instruction.operands.len())
            .map(|index| self.operand(analysis, index))
            .collect();
        checked.into_iter().collect()
    }

    fn operand(&self, analysis: &mut Analysis<'_>, index: usize) -> Option<Checked> {
        let slot = self.slot(index);
        match self.row.operands[index].1 {
            OperandKind::Bit => analysis.bit_operand(slot).map(Checked::Place),
            OperandKind::BitTarget => analysis.bit_target(slot).map(Checked::Place),
            OperandKind::Number => analysis.number_operand(slot).map(Checked::Value),
            OperandKind::Integer => analysis.integer_operand(slot).map(Checked::Value),
            OperandKind::NumberTarget => analysis.number_target(slot).map(Checked::Target),
            OperandKind::IntegerTarget => analysis.integer_target(slot).map(Checked::Target),
            OperandKind::TimerTag => analysis
                .structure(slot, "a TIMER", &[StructKind::Timer])
                .map(Checked::structure),
            OperandKind::CounterTag => analysis
                .structure(slot, "a COUNTER", &[StructKind::Counter])
                .map(Checked::structure),
            OperandKind::Resettable => {
                let kinds = [StructKind::Timer, StructKind::Counter, StructKind::Control];
                analysis
                    .structure(slot, "a TIMER, COUNTER or CONTROL", &kinds)
                    .map(Checked::structure)
            }
            OperandKind::InTag => in_tag(analysis, slot),
            OperandKind::Variable | OperandKind::Any => {
                unreachable!("checked with the meaning, or refused before")
            }
        }
    }

    pub(crate) fn op(&self, analysis: &mut Analysis<'_>) -> Option<Op> {
        if let Meaning::Control(passing) = self.row.meaning {
            return match passing {
                Passing::Call => self.call(analysis).map(Op::Action),
                Passing::Subroutine => self.subroutine(analysis).map(Op::Condition),
                Passing::Return => self.return_values(analysis).map(Op::Action),
            };
        }
        let checked = self.checked(analysis)?;
        Some(resolve(
            analysis,
            self.row.meaning,
            &mut Taken(checked.into_iter()),
        ))
    }
}

/// A checked operand.
enum Checked {
    Place(Place),
    Structure(Place, StructKind),
    Value(Operand),
    Target((Place, Elementary)),
    /// `?` or the number written instead.
    InTag(Option<Const>),
}

impl Checked {
    fn structure((place, kind): (Place, StructKind)) -> Self {
        Self::Structure(place, kind)
    }
}

/// The checked operands in order; the table guarantees the kinds.
struct Taken(std::vec::IntoIter<Checked>);

impl Taken {
    fn place(&mut self) -> Place {
        match self.0.next() {
            Some(Checked::Place(place) | Checked::Structure(place, _)) => place,
            _ => panic!("the table asks for a place"),
        }
    }

    fn value(&mut self) -> Operand {
        match self.0.next() {
            Some(Checked::Value(value)) => value,
            _ => panic!("the table asks for a value"),
        }
    }

    fn target(&mut self) -> (Place, Elementary) {
        match self.0.next() {
            Some(Checked::Target(target)) => target,
            _ => panic!("the table asks for a destination"),
        }
    }

    fn preset(&mut self) -> Option<Const> {
        match self.0.next() {
            Some(Checked::InTag(number)) => number,
            _ => panic!("the table asks for a preset"),
        }
    }

    fn reset(&mut self) -> Action {
        match self.0.next() {
            Some(Checked::Structure(structure, kind)) => Action::Reset {
                kind: reset_kind(kind),
                structure,
            },
            _ => panic!("the table asks for one of three structures"),
        }
    }
}

fn reset_kind(kind: StructKind) -> ResetKind {
    match kind {
        StructKind::Timer => ResetKind::Timer,
        StructKind::Counter => ResetKind::Counter,
        StructKind::Control => ResetKind::Control,
        StructKind::Text | StructKind::Plain => unreachable!("refused by the kind of the operand"),
    }
}

/// The operation of a meaning with checked operands.
fn resolve(analysis: &mut Analysis<'_>, meaning: Meaning, operands: &mut Taken) -> Op {
    match meaning {
        Meaning::Contact { normally_closed } => Op::Condition(Condition::Contact {
            bit: operands.place(),
            normally_closed,
        }),
        Meaning::OneShot => Op::Condition(Condition::OneShot {
            storage: operands.place(),
        }),
        Meaning::Comparison(op) => {
            let operands = [operands.value(), operands.value()];
            Op::Condition(Condition::Compare {
                op,
                ty: common(&operands),
                operands,
            })
        }
        Meaning::Band => {
            let operands = [operands.value(), operands.value(), operands.value()];
            Op::Condition(Condition::Limit {
                ty: common(&operands),
                operands,
            })
        }
        Meaning::MaskedEqual => {
            let operands = [operands.value(), operands.value(), operands.value()];
            Op::Condition(Condition::MaskedEqual {
                ty: common(&operands),
                operands,
            })
        }
        Meaning::AlwaysFalse => Op::Condition(Condition::AlwaysFalse),
        Meaning::Nothing => Op::Condition(Condition::Nothing),
        Meaning::Coil(kind) => Op::Action(Action::Coil {
            bit: operands.place(),
            kind,
        }),
        Meaning::Edge { falling } => Op::Action(Action::Edge {
            storage: operands.place(),
            output: operands.place(),
            falling,
        }),
        Meaning::Timing(kind) => {
            let timer = operands.place();
            initial_preset(analysis, &timer, operands.preset());
            Op::Action(Action::Timer { kind, timer })
        }
        Meaning::Counting(kind) => {
            let counter = operands.place();
            initial_preset(analysis, &counter, operands.preset());
            Op::Action(Action::Counter { kind, counter })
        }
        Meaning::Reset => Op::Action(operands.reset()),
        Meaning::Compute(calculation) => {
            Op::Action(Action::Compute(computation(calculation, operands)))
        }
        Meaning::Control(_) | Meaning::Refused(_) => {
            unreachable!("checked by themselves, or refused before")
        }
    }
}

fn computation(calculation: Calculation, operands: &mut Taken) -> Computation {
    match calculation {
        Calculation::Single(op) => {
            let source = operands.value();
            Computation::Unary {
                op,
                ty: common(std::slice::from_ref(&source)),
                source,
                destination: operands.target(),
            }
        }
        Calculation::Two(op) => {
            let sources = [operands.value(), operands.value()];
            Computation::Arithmetic {
                op,
                ty: common(&sources),
                operands: sources,
                destination: operands.target(),
            }
        }
        Calculation::Bitwise(op) => {
            let sources = [operands.value(), operands.value()];
            Computation::Logical {
                op,
                ty: common(&sources),
                operands: sources,
                destination: operands.target(),
            }
        }
        Calculation::Zero => Computation::Clear {
            destination: operands.target(),
        },
    }
}

/// The type that operands are promoted to: the highest rank, at least DINT.
fn common(operands: &[Operand]) -> Elementary {
    operands
        .iter()
        .map(Operand::ty)
        .fold(Elementary::Dint, Elementary::max)
}

/// `?`, or a number that the vendor's tools wrote into the tag at download.
fn in_tag(analysis: &mut Analysis<'_>, slot: Slot<'_>) -> Option<Checked> {
    if slot.operand.kind == Written::InTag {
        return Some(Checked::InTag(None));
    }
    if let Some(literal) = literal_of(slot.operand) {
        return analysis
            .literal(literal)
            .map(|number| Checked::InTag(Some(number)));
    }
    let message = format!(
        "the {} of {} is kept in its tag, so `?` or a number is expected",
        slot.name, slot.instruction
    );
    analysis.report(Diagnostic::new(Code::E2001, slot.operand.span, message));
    None
}

/// Values of the tag win over numbers in operands; a tag without values takes the number.
fn initial_preset(analysis: &mut Analysis<'_>, place: &Place, preset: Option<Const>) {
    let Some(Const::Integer { bits, .. }) = preset else {
        return;
    };
    if bits == 0 || !analysis.without_data.contains(&place.tag) {
        return;
    }
    let Type::Struct(id) = analysis.type_of(place) else {
        unreachable!("timers and counters are structures")
    };
    let member = analysis.types.table.struct_def(id).member("PRE");
    let mut path = place.path.clone();
    path.push(hir::Step::Field(member.expect("both have a preset")));
    let initial = &mut analysis.tags[place.tag.index()].initial;
    if !initial.iter().any(|(other, _)| *other == path) {
        initial.push((path, bits));
    }
}
