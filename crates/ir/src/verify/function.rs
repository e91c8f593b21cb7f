//! Rules of functions: blocks, definitions before uses, jumps.

use super::VerifyError;
use crate::analysis::{Cfg, Dominators};
use crate::{Block, Function, Module, Origin, Target, Terminator, Type, Value, ValueDef};
use cranelift_entity::{EntityRef, EntitySet, SecondaryMap};
use std::collections::BTreeSet;

pub(super) struct FunctionCheck<'m, 'e> {
    pub(super) module: &'m Module,
    pub(super) func: &'m Function,
    pub(super) errors: &'e mut Vec<VerifyError>,
    pub(super) origin: Option<Origin>,
    /// Block and position (0 = parameter, n = behind the n-th instruction) of each definition.
    pub(super) defined: SecondaryMap<Value, Option<(Block, u32)>>,
    pub(super) live: EntitySet<Block>,
}

impl<'m, 'e> FunctionCheck<'m, 'e> {
    pub(super) fn new(
        module: &'m Module,
        func: &'m Function,
        errors: &'e mut Vec<VerifyError>,
    ) -> Self {
        let mut live = EntitySet::new();
        for &block in &func.layout {
            live.insert(block);
        }
        Self {
            module,
            func,
            errors,
            origin: None,
            defined: SecondaryMap::new(),
            live,
        }
    }

    pub(super) fn error(&mut self, rule: u8, message: String) {
        let function = Some(self.func.name.clone());
        self.errors.push(VerifyError {
            rule,
            function,
            message,
            origin: self.origin,
        });
    }

    pub(super) fn run(&mut self) {
        let before = self.errors.len();
        self.shape();
        if self.errors.len() > before {
            return;
        }
        self.definitions();
        let cfg = Cfg::new(self.func);
        let dominators = Dominators::new(&cfg);
        for &block in &self.func.layout {
            self.block(block, &cfg, &dominators);
        }
    }

    /// Rules 1, 6 and 7: what the control flow analysis presupposes.
    fn shape(&mut self) {
        let func = self.func;
        let mut names = BTreeSet::from(["state", "input", "output"]);
        let refs = func.refs.values().map(|data| &data.name);
        for name in refs.chain(func.locals.values().map(|data| &data.name)) {
            if !names.insert(name) {
                self.error(
                    1,
                    format!("reference or local {name:?} has a name that is taken"),
                );
            }
        }
        let Some(&entry) = func.layout.first() else {
            return self.error(6, "the function has no block".to_owned());
        };
        if self.live.iter().count() != func.layout.len() {
            self.error(7, "a block stands twice in the layout".to_owned());
        }
        for &block in &func.layout {
            let Some(terminator) = &func.block(block).terminator else {
                self.error(7, format!("{block} has no terminator"));
                continue;
            };
            for target in terminator.targets() {
                if target.block == entry {
                    self.error(6, format!("{block} jumps to the entry"));
                }
                if !self.live.contains(target.block) {
                    self.error(
                        7,
                        format!(
                            "{block} jumps to {}, which is not in the layout",
                            target.block
                        ),
                    );
                }
            }
        }
    }

    fn definitions(&mut self) {
        let func = self.func;
        for &block in &func.layout {
            let data = func.block(block);
            for (index, &param) in data.params.iter().enumerate() {
                self.define(param, ValueDef::Param(block, index as u32), (block, 0));
            }
            for (position, &inst) in data.insts.iter().enumerate() {
                for (index, &value) in func.results_of(inst).iter().enumerate() {
                    let def = ValueDef::Result(inst, index as u32);
                    self.define(value, def, (block, position as u32 + 1));
                }
            }
        }
    }

    fn define(&mut self, value: Value, def: ValueDef, at: (Block, u32)) {
        if self.defined[value].is_some() || self.func.value_def(value) != def {
            self.error(8, format!("{value} is defined twice"));
        }
        self.defined[value] = Some(at);
    }

    fn block(&mut self, block: Block, cfg: &Cfg, dominators: &Dominators) {
        let func = self.func;
        for (position, &inst) in func.block(block).insts.iter().enumerate() {
            self.origin = func.origin(inst);
            for value in func.inst(inst).values() {
                self.use_of(value, block, position as u32, cfg, dominators);
            }
            self.inst(inst);
        }
        let data = func.block(block);
        self.origin = data.terminator_origin;
        let terminator = func.terminator(block);
        for value in terminator.values() {
            self.use_of(value, block, data.insts.len() as u32, cfg, dominators);
        }
        self.terminator(terminator);
    }

    fn use_of(
        &mut self,
        value: Value,
        block: Block,
        position: u32,
        cfg: &Cfg,
        dominators: &Dominators,
    ) {
        let legal = value.index() < self.func.value_count()
            && match self.defined[value] {
                None => false,
                Some(_) if !cfg.is_reachable(block) => true,
                Some((at, defined)) if at == block => defined <= position,
                Some((at, _)) => dominators.dominates(at, block),
            };
        if !legal {
            self.error(
                8,
                format!("{value} is used in {block} but not defined on every way there"),
            );
        }
    }

    pub(super) fn ty(&self, value: Value) -> Type {
        self.func.value_type(value)
    }

    pub(super) fn same(&mut self, rule: u8, what: &str, found: &[Type], expected: &[Type]) {
        if found != expected {
            self.error(
                rule,
                format!("{what} has types {found:?}, expected {expected:?}"),
            );
        }
    }

    fn terminator(&mut self, terminator: &Terminator) {
        for target in terminator.targets() {
            self.target(target);
        }
        match terminator {
            Terminator::Jump(_) | Terminator::Fault(_) => {}
            Terminator::Brif { cond, .. } => {
                self.same(11, "the condition of brif", &[self.ty(*cond)], &[Type::I1]);
            }
            Terminator::Switch { value, cases, .. } => {
                let ty = self.ty(*value);
                let unique: BTreeSet<u64> = cases.iter().map(|(bits, _)| *bits).collect();
                let fits = unique.iter().all(|bits| bits & !ty.mask() == 0);
                if !ty.is_int() || unique.len() != cases.len() || !fits {
                    self.error(
                        11,
                        "switch needs an integer and unequal cases within its width".to_owned(),
                    );
                }
            }
            Terminator::Return(values) => {
                let types: Vec<Type> = values.iter().map(|&v| self.ty(v)).collect();
                let func = self.func;
                self.same(9, "return", &types, &func.results);
            }
        }
    }

    fn target(&mut self, target: &Target) {
        let params = &self.func.block(target.block).params;
        let expected: Vec<Type> = params.iter().map(|&v| self.ty(v)).collect();
        let found: Vec<Type> = target.args.iter().map(|&v| self.ty(v)).collect();
        self.same(
            9,
            &format!("the jump to {}", target.block),
            &found,
            &expected,
        );
    }
}
