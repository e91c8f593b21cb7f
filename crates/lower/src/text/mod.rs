//! Bodies in text: statements and expressions to blocks and values.
//!
//! A body becomes one function: its references are reference parameters, its first locals take the
//! values of a call, its results are those of the function.
//!
//! * Elementary locals are SSA variables, unless a call gets a reference to them; all others are
//!   memory of the activation. Both are 0 at its start.
//! * Everything is evaluated where it stands, from left to right; the value of an assignment before
//!   the indices of its target.
//! * What a language calls an error is tested for here and nowhere else, see [`fault`].
//!
//! The nesting of bodies is bounded by that of the source, so walks recurse.

mod convert;
mod expr;
mod fault;
mod initial;
mod loops;
mod place;
mod stmt;

use crate::Lowering;
use crate::types::{elementary, result_types, scalar};
use iecc_ir::{
    Block as IrBlock, Function, FunctionBuilder, Local as IrLocal, Origin, Type, Variable,
};
use iecc_sema::hir::code::{Block, ExprKind, LocalId, PathId, Root};
use iecc_sema::hir::{self, Code, Pou};
use iecc_source::Span;
use place::Located;
use std::sync::Arc;

/// The function of a unit.
pub(crate) fn unit<'p>(lowering: &mut Lowering<'p>, pou: &'p Pou, code: &'p Code) -> Function {
    let count = code.params as usize;
    let params: Vec<Type> = code.locals[..count]
        .iter()
        .map(|local| scalar(elementary(local.ty)))
        .collect();
    let mut unit = Unit {
        builder: FunctionBuilder::new(pou.name.clone(), &params, &result_types(pou)),
        program: lowering.program,
        lowering,
        code,
        locals: Vec::with_capacity(code.locals.len()),
        label: Arc::from(pou.name.as_str()),
        origin: None,
        loops: Vec::new(),
        around: Vec::new(),
    };
    unit.at(pou.span);
    unit.declare();
    unit.take_parameters(count);
    unit.block(&code.body);
    if unit.builder.is_open() {
        unit.leave();
    }
    unit.builder.finish()
}

/// Where a local is kept.
#[derive(Debug, Clone, Copy)]
enum Storage {
    Variable(Variable),
    Memory(IrLocal),
}

/// Where EXIT and CONTINUE of a loop go.
#[derive(Debug, Clone, Copy)]
struct Loop {
    behind: IrBlock,
    next: IrBlock,
}

struct Unit<'l, 'p> {
    lowering: &'l mut Lowering<'p>,
    program: &'p hir::Program,
    code: &'p Code,
    builder: FunctionBuilder,
    locals: Vec<Storage>,
    label: Arc<str>,
    origin: Option<Origin>,
    /// Those around the statement, the innermost last.
    loops: Vec<Loop>,
    /// Structures that are being given their initial values, the innermost last.
    around: Vec<Located>,
}

/// A name that the text form does not take for a region.
fn place_name(name: &str) -> String {
    if ["state", "input", "output"].contains(&name) {
        format!("{name}'")
    } else {
        name.to_owned()
    }
}

impl<'p> Unit<'_, 'p> {
    fn declare(&mut self) {
        for param in &self.code.refs {
            let ty = self.lowering.types.mem_type(param.ty);
            self.builder.add_ref(place_name(&param.name), ty);
        }
        let referred = self.referred_to();
        for (local, referred) in self.code.locals.iter().zip(referred) {
            self.locals.push(match local.ty {
                hir::Type::Elementary(ty) if !referred => {
                    Storage::Variable(self.builder.declare(scalar(ty)))
                }
                hir::Type::Elementary(_) | hir::Type::Struct(_) | hir::Type::Array(_) => {
                    let ty = self.lowering.types.mem_type(local.ty);
                    Storage::Memory(self.builder.local(place_name(&local.name), ty))
                }
            });
        }
    }

    /// For each local whether something needs it as memory.
    fn referred_to(&self) -> Vec<bool> {
        let mut referred = vec![false; self.code.locals.len()];
        let mut refer = |path: PathId| {
            if let Root::Local(local) = self.code.path(path).root {
                referred[local.index()] = true;
            }
        };
        for call in &self.code.calls {
            call.refs.iter().copied().for_each(&mut refer);
        }
        for expr in &self.code.exprs {
            if let ExprKind::Elapsed(path)
            | ExprKind::ElapsedUnits(path)
            | ExprKind::Address(path) = expr.kind
            {
                refer(path);
            }
        }
        referred
    }

    fn take_parameters(&mut self, count: usize) {
        for index in 0..count {
            let value = self.builder.param(index);
            let at = self.local(LocalId(index as u32));
            self.write(&at, value);
        }
    }

    /// Leaves the function with the values that its results have here.
    fn leave(&mut self) {
        let mut values = Vec::with_capacity(self.code.results.len());
        for &local in &self.code.results {
            let at = self.local(local);
            values.push(self.read(&at));
        }
        self.builder.ret(values);
    }

    /// Statements in order; what stands behind one that leaves is not reached.
    fn block(&mut self, block: &'p Block) {
        let around = self.origin;
        for &stmt in block {
            self.stmt(stmt);
            if !self.builder.is_open() {
                break;
            }
        }
        self.origin = around;
        self.builder.set_origin(around);
    }

    /// Everything built from now on comes from here.
    fn at(&mut self, span: Span) {
        self.origin = Some(self.lowering.shared_origin(&self.label, Some(span)));
        self.builder.set_origin(self.origin);
    }

    /// A block that is jumped to from nowhere else.
    fn go_on(&mut self, block: IrBlock) {
        self.builder.seal(block);
        self.builder.switch_to(block);
    }

    /// Jumps, unless the place here is not reached.
    fn jump(&mut self, block: IrBlock) {
        if self.builder.is_open() {
            self.builder.jump(block);
        }
    }
}
