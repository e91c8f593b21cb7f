//! R_EDGE and F_EDGE: at each start of the body an R_TRIG or F_TRIG looks at the input, given in
//! the call or not, and the body sees its Q.

use super::{Body, Place};
use crate::hir::code::{BinaryOp, Block, ExprId, ExprKind, LocalId, PathStep, Root, StmtKind};
use crate::hir::{Elementary, Type};
use crate::st::signature::{PouId, Storage};
use iecc_ast::st::Edge;
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// Locals for what the body sees of its inputs with edges.
    pub(super) fn edge_locals(&mut self, id: PouId) {
        let vars = self.an.pou(id).vars.clone();
        for (index, var) in vars.iter().enumerate() {
            if let (Some(_), Storage::Field(_)) = (var.edge, &var.storage) {
                let name = self.text(var.name);
                let local = self.add_local(name, Type::Elementary(Elementary::Bool));
                self.locals[index] = Some(local);
            }
        }
    }

    /// Looks at the inputs with edges.
    pub(super) fn sample_edges(&mut self, id: PouId, body: &mut Block) {
        let vars = self.an.pou(id).vars.clone();
        // The body of a base may run on what extends it.
        let home = self.an.pou(id).owner.unwrap_or(id);
        for (index, var) in vars.iter().enumerate() {
            let (Some(edge), Storage::Field(field)) = (var.edge, &var.storage) else {
                continue;
            };
            if let Some(local) = self.locals[index] {
                let this = self.this_as(home);
                let input = member(this.clone(), *field);
                let memory = member(this, *field + 1);
                self.sample_edge(edge, [input, memory], local, var.range, body);
            }
        }
    }

    /// What the body sees of an input, whose level of the call before lies in the second place.
    fn sample_edge(
        &mut self,
        edge: Edge,
        [input, memory]: [Place; 2],
        local: LocalId,
        range: TextRange,
        body: &mut Block,
    ) {
        let was = self.load_bool(&memory, range);
        let not_was = self.inverted(was, range);
        let level = self.level(edge, &input, range);
        let kind = ExprKind::Binary(BinaryOp::And, level, not_was);
        let seen = self.add_expr(kind, Elementary::Bool, range);
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        body.push(self.add_stmt(StmtKind::Assign(path, seen), range));
        let level = self.level(edge, &input, range);
        let path = self.path_of(&memory, range);
        body.push(self.add_stmt(StmtKind::Assign(path, level), range));
    }

    fn level(&mut self, edge: Edge, input: &Place, range: TextRange) -> ExprId {
        let now = self.load_bool(input, range);
        match edge {
            Edge::Rising => now,
            Edge::Falling => self.inverted(now, range),
        }
    }

    fn load_bool(&mut self, place: &Place, range: TextRange) -> ExprId {
        let path = self.path_of(place, range);
        self.add_expr(ExprKind::Load(path), Elementary::Bool, range)
    }

    fn inverted(&mut self, value: ExprId, range: TextRange) -> ExprId {
        let kind = ExprKind::Unary(crate::hir::code::UnaryOp::Not, value);
        self.add_expr(kind, Elementary::Bool, range)
    }
}

fn member(mut place: Place, field: u32) -> Place {
    place.steps.push(PathStep::Field(field));
    place
}
