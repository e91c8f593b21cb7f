//! Where the variables of a unit live, and what a call of it passes: instances and what is more than one
//! number by reference, numbers by value.

use crate::st::analysis::Analysis;
use crate::st::signature::{PouId, Storage, Var};
use iecc_ast::st::{self, SectionKind, UnitKind};

/// How a unit is called. Positions are those of its variables.
#[derive(Debug, Clone, Default)]
pub(crate) struct CallShape {
    /// Whether the first reference is the instance.
    pub instance: bool,
    /// Passed by reference, in order; then the result, if it is no number.
    pub refs: Vec<usize>,
    /// Whether the result is the last reference.
    pub result_by_ref: bool,
    /// Passed by value.
    pub params: Vec<usize>,
    /// Given back: the result first, if it is a number.
    pub results: Vec<usize>,
    /// Whether the first result is that of the function.
    pub result_by_value: bool,
    /// Whether ENO is the last result.
    pub eno: bool,
}

impl Analysis<'_> {
    /// In-outs of a base are passed with every call of what extends it.
    pub(super) fn inherit_in_outs(&mut self, id: PouId, base: PouId) {
        let inherited: Vec<Var> = self
            .pou(base)
            .section(SectionKind::InOut)
            .cloned()
            .collect();
        let UnitKind::Pou(written) = &self.unit(self.pou(id).unit).kind else {
            return;
        };
        for mut var in inherited {
            let open = &self.pou(id).bindings.open;
            if let Some((_, ty)) = open.iter().find(|(name, _)| *name == var.name) {
                var.ty = *ty;
            }
            var.range = written.name.range;
            var.storage = Storage::Local;
            self.add_var(id, var);
        }
    }

    /// Inputs, outputs and in-outs of a unit and of what it extends, the base first.
    pub(crate) fn all_parameters(&self, id: PouId) -> Vec<Var> {
        let mut parameters: Vec<Var> = Vec::new();
        for level in self.lineage(id).into_iter().rev() {
            for var in &self.pou(level).vars {
                let passed = var.section.direction().is_some();
                if !passed {
                    continue;
                }
                match parameters.iter_mut().find(|known| known.name == var.name) {
                    // The same in-out, nearer to the unit.
                    Some(known) => *known = var.clone(),
                    None => parameters.push(var.clone()),
                }
            }
        }
        parameters
    }

    /// Says where each variable lives.
    pub(super) fn place_vars(&mut self, id: PouId) {
        let instances = self.pou(id).has_instances();
        let (mut field, mut reference) = (self.first_field(id), u32::from(instances));
        if self.pou(id).owner.is_some() {
            reference = 1;
        }
        for index in 0..self.pou(id).vars.len() {
            let var = &self.pou(id).vars[index];
            if var.storage != Storage::Local {
                continue;
            }
            let scalar = self.types.is_scalar(var.ty);
            let storage = match var.section {
                SectionKind::InOut => Storage::Ref(0),
                SectionKind::Input | SectionKind::Output if !instances && !scalar => {
                    Storage::Ref(0)
                }
                SectionKind::Input | SectionKind::Output | SectionKind::Var if instances => {
                    Storage::Field(field)
                }
                SectionKind::Var
                | SectionKind::Input
                | SectionKind::Output
                | SectionKind::Temp
                | SectionKind::External
                | SectionKind::Global
                | SectionKind::Access
                | SectionKind::Config
                | SectionKind::Static
                | SectionKind::Instance => Storage::Local,
            };
            let edge = var.edge.is_some();
            let storage = match storage {
                Storage::Ref(_) => {
                    reference += 1;
                    Storage::Ref(reference - 1)
                }
                Storage::Field(_) => {
                    field += 1 + u32::from(edge);
                    Storage::Field(field - 1 - u32::from(edge))
                }
                other @ (Storage::Local
                | Storage::Global(_)
                | Storage::Const(_)
                | Storage::Located(_)) => other,
            };
            self.pous[id.index()].vars[index].storage = storage;
        }
    }

    /// How a unit is called; its signature must be complete.
    pub(crate) fn call_shape(&self, id: PouId) -> CallShape {
        let pou = self.pou(id);
        let mut shape = CallShape {
            instance: pou.has_instances() || pou.owner.is_some(),
            ..CallShape::default()
        };
        for (index, var) in pou.vars.iter().enumerate() {
            match (&var.storage, var.section) {
                (Storage::Ref(_), _) => shape.refs.push(index),
                (Storage::Local, SectionKind::Input) => shape.params.push(index),
                (Storage::Local, SectionKind::Output) => shape.results.push(index),
                _ => {}
            }
        }
        if let Some(result) = pou.result {
            let scalar = self.types.is_scalar(result);
            (shape.result_by_value, shape.result_by_ref) = (scalar, !scalar);
        }
        shape.eno = self.uses_eno(id);
        shape
    }

    /// Whether a body changes its ENO. All bodies of a unit count as one.
    fn uses_eno(&self, id: PouId) -> bool {
        let unit = self.pou(id).unit;
        if let Some(known) = self.eno_units.borrow().get(&unit) {
            return *known;
        }
        let arena = &self.unit(unit).arena;
        let eno = st::ExprKind::Name(self.words.eno);
        let uses = arena.all::<st::Expr>().iter().any(|expr| expr.kind == eno);
        self.eno_units.borrow_mut().insert(unit, uses);
        uses
    }
}
