//! R_EDGE and F_EDGE: at each start of the body an R_TRIG or F_TRIG looks at the input, given in
//! the call or not, and the body sees its Q.

use super::{Body, Place, Rights};
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
        for (index, var) in vars.iter().enumerate() {
            let (Some(edge), Storage::Field(field)) = (var.edge, &var.storage) else {
                continue;
            };
            if let Some(local) = self.locals[index] {
                self.sample_edge(edge, *field, local, var.range, body);
            }
        }
    }

    fn sample_edge(
        &mut self,
        edge: Edge,
        field: u32,
        local: LocalId,
        range: TextRange,
        body: &mut Block,
    ) {
        let not_was = self.load_field(field + 1, range);
        let not_was = self.inverted(not_was, range);
        let level = self.level(edge, field, range);
        let kind = ExprKind::Binary(BinaryOp::And, level, not_was);
        let seen = self.add_expr(kind, Elementary::Bool, range);
        let path = self.add_path(Root::Local(local), Vec::new(), range);
        body.push(self.add_stmt(StmtKind::Assign(path, seen), range));
        let level = self.level(edge, field, range);
        let path = self.add_path(Root::Ref(0), vec![PathStep::Field(field + 1)], range);
        body.push(self.add_stmt(StmtKind::Assign(path, level), range));
    }

    fn level(&mut self, edge: Edge, field: u32, range: TextRange) -> ExprId {
        let now = self.load_field(field, range);
        match edge {
            Edge::Rising => now,
            Edge::Falling => self.inverted(now, range),
        }
    }

    fn load_field(&mut self, field: u32, range: TextRange) -> ExprId {
        let place = Place {
            root: Root::Ref(0),
            steps: vec![PathStep::Field(field)],
            rights: Rights::All,
        };
        let path = self.path_of(&place, range);
        self.add_expr(ExprKind::Load(path), Elementary::Bool, range)
    }

    fn inverted(&mut self, value: ExprId, range: TextRange) -> ExprId {
        let kind = ExprKind::Unary(crate::hir::code::UnaryOp::Not, value);
        self.add_expr(kind, Elementary::Bool, range)
    }
}
