//! Units that no source has: a program instance with its connections, a block with its own task.

use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir;
use crate::hir::code::{Call, ExprKind, PathId, PathStep, Root, StmtKind};
use crate::st::analysis::Analysis;
use crate::st::resolve::TypeScope;
use crate::st::signature::{PouId, Storage, UnitId, Var};
use crate::st::types::TypeId;
use iecc_ast::st::{self, ProgramElement, SectionKind};
use iecc_diag::Code as Message;
use iecc_source::TextRange;

/// What a program instance is connected to.
#[derive(Debug, Clone)]
pub(crate) struct Connections {
    /// The unit that says so.
    pub unit: UnitId,
    /// What it says.
    pub elements: Vec<ProgramElement>,
    /// Where.
    pub range: TextRange,
}

impl Connections {
    /// No connections.
    pub(crate) fn none(unit: UnitId) -> Self {
        Self {
            unit,
            elements: Vec::new(),
            range: TextRange::default(),
        }
    }
}

impl Analysis<'_> {
    /// A unit without parameters that runs a program instance: inputs, the program, outputs.
    pub(crate) fn program_call(
        &mut self,
        program: PouId,
        tag: hir::TagId,
        name: &str,
        connections: &Connections,
    ) -> hir::PouId {
        let callee = self.want(program);
        let unit = connections.unit;
        let mut body = Body::outside(self, unit);
        let refs = body.connect_inputs(program, tag, connections);
        body.call_unit(callee, tag, Vec::new(), refs, connections.range);
        body.connect_outputs(program, tag, connections);
        body.code.body = std::mem::take(&mut body.pending);
        let code = std::mem::take(&mut body.code);
        let span = self.pou(program).span;
        self.synthetic(format!("{name}'"), code, span)
    }

    /// A unit without parameters that runs a block somewhere in the state.
    pub(crate) fn block_run(
        &mut self,
        block: PouId,
        place: &hir::Place,
        name: &str,
        unit: UnitId,
    ) -> hir::PouId {
        let callee = self.want(block);
        let mut body = Body::outside(self, unit);
        let steps = place.path.iter().map(|step| match *step {
            hir::Step::Field(field) => PathStep::Field(field),
            hir::Step::Index(index) => PathStep::Index(index),
            hir::Step::Bit(first) => PathStep::Bits { first, count: 1 },
        });
        let steps = steps.collect();
        body.call_unit(callee, place.tag, steps, Vec::new(), TextRange::default());
        body.code.body = std::mem::take(&mut body.pending);
        let code = std::mem::take(&mut body.code);
        let span = self.pou(block).span;
        self.synthetic(format!("{name}'"), code, span)
    }
}

impl<'b, 'a> Body<'b, 'a> {
    /// Surroundings of code that stands in a configuration.
    pub(super) fn outside(an: &'b mut Analysis<'a>, unit: UnitId) -> Self {
        let namespace = an.units[unit.index()].namespace;
        let scope = TypeScope {
            unit,
            namespace,
            bindings: None,
            pou: None,
        };
        Self::new(an, scope)
    }

    fn call_unit(
        &mut self,
        callee: hir::PouId,
        tag: hir::TagId,
        steps: Vec<PathStep>,
        given: Vec<PathId>,
        range: TextRange,
    ) {
        let this = self.add_path(Root::Tag(tag), steps, range);
        let call = self.add_call(Call {
            callee,
            refs: std::iter::once(this).chain(given).collect(),
            args: Vec::new(),
            outputs: Vec::new(),
        });
        let value = self.add_expr(ExprKind::Call(call), hir::Elementary::Bool, range);
        self.before(StmtKind::Eval(value), range);
    }

    /// Stores inputs; gives the places of in-outs in their order.
    fn connect_inputs(
        &mut self,
        program: PouId,
        tag: hir::TagId,
        connections: &Connections,
    ) -> Vec<PathId> {
        let mut refs = vec![None; self.an.call_shape(program).refs.len()];
        let mut given: Vec<iecc_ast::Symbol> = Vec::new();
        for element in &connections.elements {
            let ProgramElement::Source { variable, source } = *element else {
                continue;
            };
            let Some(var) = self.connected(program, variable) else {
                continue;
            };
            if given.contains(&var.name) {
                let range = self.arena()[variable].range;
                let message = format!("`{}` is connected twice", self.text(var.name));
                self.error(Message::E1003, range, message);
                continue;
            }
            given.push(var.name);
            match (&var.storage, var.section) {
                (Storage::Ref(position), SectionKind::InOut) => {
                    refs[*position as usize - 1] = self.in_out(&var, source);
                }
                (Storage::Field(field), SectionKind::Input) => {
                    let value = self.sized(source, var.ty);
                    let target = field_of(tag, *field);
                    self.store(&target, var.ty, &value, value.range);
                }
                _ => {
                    let range = self.arena()[variable].range;
                    let message = format!("`{}` is no input", self.text(var.name));
                    self.error(Message::E6043, range, message);
                }
            }
        }
        for var in &self.an.pou(program).vars.clone() {
            if var.section == SectionKind::InOut && !given.contains(&var.name) {
                let message = format!("in-out `{}` is not connected", self.text(var.name));
                let span = match connections.range == TextRange::default() {
                    true => self.an.pou(program).span,
                    false => self.span(connections.range),
                };
                self.an.error(Message::E3015, span, message);
            }
        }
        refs.into_iter().flatten().collect()
    }

    fn connect_outputs(&mut self, program: PouId, tag: hir::TagId, connections: &Connections) {
        for element in &connections.elements {
            let ProgramElement::Sink { variable, sink } = *element else {
                continue;
            };
            let Some(var) = self.connected(program, variable) else {
                continue;
            };
            let (Storage::Field(field), SectionKind::Output) = (&var.storage, var.section) else {
                let range = self.arena()[variable].range;
                let message = format!("`{}` is no output", self.text(var.name));
                self.error(Message::E6043, range, message);
                continue;
            };
            let from = Operand {
                kind: OperandKind::Place(field_of(tag, *field)),
                ty: var.ty,
                range: self.arena()[variable].range,
            };
            let to = self.sized(sink, var.ty);
            if let Some(place) = self.writable(&to) {
                self.store(&place, to.ty, &from, from.range);
            }
        }
    }

    /// An address takes the type of what it is connected to, if that has its width.
    fn sized(&mut self, id: st::Id<st::Expr>, ty: TypeId) -> Operand {
        let written = self.arena()[id];
        if let st::ExprKind::Direct(_) = written.kind
            && let Some(address) = self.an.address(self.unit, id)
        {
            let bits = self.an.types.elementary(ty).map(|el| u64::from(el.bits()));
            let want = (bits == Some(address.bits)).then_some(ty);
            return self.direct(id, want, written.range);
        }
        self.expr(id, Some(ty))
    }

    fn connected(&mut self, program: PouId, id: st::Id<st::Expr>) -> Option<Var> {
        let written = self.arena()[id];
        let st::ExprKind::Name(name) = written.kind else {
            let message = "inputs and outputs of the program are connected as a whole";
            self.error(Message::E6043, written.range, message);
            return None;
        };
        if let Some(var) = self.an.pou(program).var(name).cloned() {
            return (var.ty != TypeId::ERROR).then_some(var);
        }
        let program_name = self.text(self.an.pou(program).name);
        let message = format!("program `{program_name}` has no `{}`", self.text(name));
        self.error(Message::E1019, written.range, message);
        None
    }
}

fn field_of(tag: hir::TagId, field: u32) -> Place {
    Place {
        root: Root::Tag(tag),
        steps: vec![PathStep::Field(field)],
        rights: Rights::All,
    }
}
