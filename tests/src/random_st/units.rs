//! Units: functions, blocks, classes with their relatives, and the program.

use super::Generator;
use super::scope::{Variable, routes};
use super::signatures::{Param, Signature, Unit, Way};
use super::types::{Elementary, Type, Types};

/// How deep statements nest.
const DEPTH: u32 = 2;

/// What a body sees, beside what it declares itself.
#[derive(Debug, Clone, Default)]
pub(super) struct Frame {
    pub(super) variables: Vec<Variable>,
    pub(super) counters: Vec<(String, Elementary)>,
}

impl Frame {
    pub(super) fn add(&mut self, name: &str, ty: Type, write: bool, keeps: bool) {
        self.variables.push(Variable {
            name: name.to_owned(),
            ty,
            write,
            keeps,
        });
    }

    fn add_params(&mut self, params: &[Param]) {
        self.add("ENO", Type::BOOL, true, false);
        for param in params {
            self.add(&param.name, param.ty, param.way != Way::In, false);
        }
    }
}

/// Parameters that are more than a part of one call of the body.
fn seen_by_methods(params: &[Param]) -> Vec<Param> {
    let seen = params.iter();
    let seen = seen.filter(|param| param.way != Way::InOut && param.edge.is_empty());
    seen.cloned().collect()
}

impl Generator<'_> {
    pub(super) fn types_section(&mut self) {
        let declarations = self.types.declare(self.rng);
        if declarations.is_empty() {
            return;
        }
        let start = self.draft.position();
        self.put("TYPE\n");
        for declaration in declarations {
            let start = self.draft.position();
            self.put(&format!("{declaration}\n"));
            self.draft.mark(start, "");
        }
        self.put("END_TYPE\n");
        self.draft.mark(start, "");
    }

    pub(super) fn function(&mut self, index: usize) {
        let start = self.draft.position();
        let result = match self.rng.below(8) {
            0 => None,
            1 => Some(self.types.any(self.rng)),
            _ => Some(self.types.value(self.rng)),
        };
        let mut signature = self.signature(&format!("f{index}"), result, true);
        let name = signature.name.clone();
        self.head("FUNCTION", &signature);
        let mut frame = Frame::default();
        frame.add_params(&signature.params);
        if let Some(ty) = result {
            frame.add(&name, ty, true, false);
        }
        self.locals(&mut frame, "VAR", false);
        signature.cost = self.body(frame, 3);
        self.put("END_FUNCTION\n");
        self.draft.mark(start, "");
        self.functions.push(signature);
    }

    /// `FUNCTION f : INT` with its parameters.
    fn head(&mut self, words: &str, signature: &Signature) {
        self.put(&format!("{words} {}", signature.name));
        if let Some(ty) = signature.result {
            let ty = self.types.written(ty);
            self.put(&format!(" : {ty}"));
        }
        self.put("\n");
        self.params(&signature.params);
    }

    fn params(&mut self, params: &[Param]) {
        let sections = [
            ("VAR_INPUT", Way::In),
            ("VAR_OUTPUT", Way::Out),
            ("VAR_IN_OUT", Way::InOut),
        ];
        for (word, way) in sections {
            let chosen: Vec<Param> = params.iter().filter(|p| p.way == way).cloned().collect();
            if chosen.is_empty() {
                continue;
            }
            self.put(&format!("{word}\n"));
            for param in chosen {
                if param.edge.is_empty() {
                    self.declaration(&param.name, param.ty, way != Way::InOut);
                } else {
                    self.put(&format!("  {} : BOOL {};\n", param.name, param.edge));
                }
            }
            self.put("END_VAR\n");
        }
    }

    pub(super) fn declaration(&mut self, name: &str, ty: Type, may_begin: bool) {
        let start = self.draft.position();
        let written = self.types.written(ty);
        self.put(&format!("  {name} : {written}"));
        if may_begin && self.rng.one_in(3) {
            let initial = self.draft.position();
            if let Some(value) = self.initial_value(ty) {
                self.put(&format!(" := {value}"));
                self.draft.mark(initial, "");
            }
        }
        self.put(";\n");
        self.draft.mark(start, "");
    }

    /// Random parameters; the first is an INT, so that every body has one.
    fn signature(&mut self, name: &str, result: Option<Type>, in_outs: bool) -> Signature {
        let mut params = vec![Param::new("a", Type::INT, Way::In)];
        let kinds = [("b", Way::In, 3), ("o", Way::Out, 2), ("io", Way::InOut, 2)];
        for (prefix, way, most) in kinds {
            if way == Way::InOut && !in_outs {
                continue;
            }
            for index in 0..self.rng.below(most) {
                let ty = match self.rng.below(6) {
                    0 | 1 if way == Way::InOut => Type::Instance(self.rng.below(self.units.len())),
                    2 if way == Way::InOut => Type::Open(Types::elementary(self.rng)),
                    _ => self.types.any(self.rng),
                };
                params.push(Param::new(&format!("{prefix}{index}"), ty, way));
            }
        }
        Signature {
            name: name.to_owned(),
            result,
            params,
            cost: 0,
        }
    }

    /// Variables of a body, what its loops count in included.
    pub(super) fn locals(&mut self, frame: &mut Frame, word: &str, keeps: bool) {
        self.put(&format!("{word}\n"));
        for index in 0..1 + self.rng.below(if keeps { 6 } else { 3 }) {
            let ty = self.types.any(self.rng);
            let name = format!("v{index}");
            self.declaration(&name, ty, true);
            frame.add(&name, ty, true, keeps);
        }
        if keeps && self.rng.one_in(2) {
            self.references(frame);
        }
        self.put("END_VAR\n");
        // Where faults do not stop, a block may run on an instance that is not there and keeps nothing;
        // its loops must end even so.
        self.put(if keeps { "VAR_TEMP\n" } else { "VAR\n" });
        self.counters(frame);
        self.put("END_VAR\n");
    }

    /// What loops count in.
    fn counters(&mut self, frame: &mut Frame) {
        use Elementary::{Dint, Int, Lint, Sint, Uint, Usint};
        for index in 0..2 {
            let ty = self.rng.pick(&[Int, Int, Dint, Sint, Usint, Uint, Lint]);
            let name = format!("c{index}");
            self.declaration(&name, Type::Elementary(ty), false);
            frame.add(&name, Type::Elementary(ty), false, false);
            frame.counters.push((name, ty));
        }
        self.declaration("guard", Type::INT, false);
    }

    /// References to what some variables are.
    fn references(&mut self, frame: &mut Frame) {
        let targets: Vec<Type> = frame.variables.iter().map(|v| v.ty).collect();
        for index in 0..1 + self.rng.below(2) {
            let target = self.rng.pick(&targets);
            let ty = self.types.reference_to(target);
            let name = format!("r{index}");
            self.declaration(&name, ty, false);
            frame.add(&name, ty, true, true);
        }
    }

    /// Statements; says how many it executes at most.
    pub(super) fn body(&mut self, frame: Frame, size: usize) -> u64 {
        let units = std::mem::take(&mut self.units);
        self.routes = routes(&frame.variables, &self.types, &units);
        self.units = units;
        self.counters = frame.counters;
        (self.cost, self.turns, self.loops) = (1, 1, 0);
        self.left = size + self.rng.below(size);
        if self
            .routes
            .iter()
            .any(|route| matches!(route.ty, Type::Reference(_)))
        {
            for _ in 0..2 {
                let start = self.draft.position();
                self.refer();
                self.draft.mark(start, "");
            }
        }
        while self.left > 0 {
            self.statement(DEPTH);
        }
        self.cost
    }

    /// A block; it may extend the one before, whose parameters and methods it then has.
    pub(super) fn block_unit(&mut self, index: usize) {
        let start = self.draft.position();
        let base = self.units.len() - 1;
        let is_block = self.units[base].body.is_some();
        let extends = base >= self.standard && is_block && self.rng.one_in(2);
        let mut signature = self.signature(&format!("Block{index}"), None, true);
        if extends {
            return self.derived_block(base, &signature.name);
        }
        if self.rng.one_in(3) {
            let mut edge = Param::new("edge", Type::BOOL, Way::In);
            edge.edge = self.rng.pick(&["R_EDGE", "F_EDGE"]);
            signature.params.push(edge);
        }
        self.head("FUNCTION_BLOCK", &signature);
        let mut inner = Frame::default();
        self.instances_section(&mut inner, 2);
        self.locals(&mut inner, "VAR", true);
        let mut frame = inner.clone();
        frame.add_params(&signature.params);
        let mut seen = inner;
        seen.add_params(&seen_by_methods(&signature.params));
        let methods = self.methods(&seen);
        signature.cost = self.body(frame, 4);
        self.put("END_FUNCTION_BLOCK\n");
        self.draft.mark(start, "");
        self.types.instances.push(signature.name.clone());
        self.units.push(Unit {
            body: Some(signature),
            methods,
            is_interface: false,
            above: Vec::new(),
        });
    }

    /// A block that has all its parameters of another one, and runs its body now and then.
    fn derived_block(&mut self, base: usize, name: &str) {
        let start = self.draft.position();
        let base_name = self.types.instances[base].clone();
        let unit = self.units[base].clone();
        self.put(&format!("FUNCTION_BLOCK {name} EXTENDS {base_name}\n"));
        let mut frame = Frame::default();
        self.put("VAR_OUTPUT\n");
        self.declaration("more", Type::INT, true);
        self.put("END_VAR\n");
        frame.add("more", Type::INT, true, false);
        let body = unit.body.expect("blocks have one");
        let mut seen = frame.clone();
        seen.add_params(&seen_by_methods(&body.params));
        // What is behind an edge is seen by the body that declares it only.
        let params = body.params.iter().filter(|param| param.edge.is_empty());
        frame.add_params(&params.cloned().collect::<Vec<_>>());
        let mut methods = Vec::new();
        for method in unit.methods {
            methods.push(if self.rng.one_in(2) {
                self.method("METHOD PUBLIC OVERRIDE", method, seen.clone())
            } else {
                method
            });
        }
        self.put("VAR_TEMP\n");
        self.declaration("t0", Type::INT, false);
        self.put("END_VAR\n");
        let super_call = self.draft.position();
        self.put("SUPER();\n");
        self.draft.mark(super_call, "");
        let cost = self.body(frame, 2) + body.cost;
        self.put("END_FUNCTION_BLOCK\n");
        self.draft.mark(start, "");
        self.types.instances.push(name.to_owned());
        let mut params = body.params;
        params.push(Param::new("more", Type::INT, Way::Out));
        let mut above = unit.above;
        above.push(base);
        self.units.push(Unit {
            body: Some(Signature {
                name: name.to_owned(),
                result: None,
                params,
                cost,
            }),
            methods,
            is_interface: false,
            above,
        });
    }

    fn methods(&mut self, seen: &Frame) -> Vec<Signature> {
        let count = self.rng.pick(&[0, 0, 1, 2]);
        let methods = (0..count).map(|index| {
            let result = self.rng.one_in(2).then(|| self.types.value(self.rng));
            let signature = self.signature(&format!("m{index}"), result, true);
            self.method("METHOD PUBLIC", signature, seen.clone())
        });
        methods.collect()
    }

    /// A method; its own names hide those of the unit.
    fn method(&mut self, words: &str, mut signature: Signature, seen: Frame) -> Signature {
        let start = self.draft.position();
        self.head(words, &signature);
        let mut own = Frame::default();
        own.add_params(&signature.params);
        if let Some(ty) = signature.result {
            own.add(&signature.name, ty, true, false);
        }
        self.locals(&mut own, "VAR", false);
        let hidden: Vec<String> = own.variables.iter().map(|v| v.name.clone()).collect();
        let seen = seen.variables.into_iter();
        let seen = seen.filter(|variable| !hidden.contains(&variable.name));
        own.variables.extend(seen);
        signature.cost = self.body(own, 2);
        self.put("END_METHOD\n");
        self.draft.mark(start, "");
        signature
    }

    /// Instances of blocks that exist already.
    pub(super) fn instances_section(&mut self, frame: &mut Frame, most: usize) {
        self.put("VAR\n");
        for index in 0..self.rng.below(most + 1) {
            // The program's own blocks more often than the many of the library.
            let own = self.units.len() > self.standard && self.rng.one_in(2);
            let first = if own { self.standard } else { 0 };
            let at = first + self.rng.below(self.units.len() - first);
            let name = format!("i{index}");
            let start = self.draft.position();
            let unit = &self.types.instances[at];
            let (written, ty) = if self.rng.one_in(4) && !self.units[at].is_interface {
                let written = format!("ARRAY [1..2] OF {unit}");
                (written.clone(), self.array_of(written, Type::Instance(at)))
            } else {
                (unit.clone(), Type::Instance(at))
            };
            self.put(&format!("  {name} : {written};\n"));
            self.draft.mark(start, "");
            frame.add(&name, ty, false, true);
        }
        self.put("END_VAR\n");
    }

    fn array_of(&mut self, written: String, element: Type) -> Type {
        self.types.arrays.push(super::types::Array {
            written,
            bounds: vec![(1, 2)],
            element,
        });
        Type::Array(self.types.arrays.len() - 1)
    }

    /// An interface, a class that implements it, and one that extends this and overrides.
    pub(super) fn relatives(&mut self) {
        let result = Some(self.types.value(self.rng));
        let prototype = self.signature("act", result, true);
        let interface = self.interface(&prototype);
        let base = self.class(
            "Base",
            " IMPLEMENTS Acting",
            "",
            &prototype,
            vec![interface],
        );
        let above = vec![interface, base];
        self.class("Derived", " EXTENDS Base", " OVERRIDE", &prototype, above);
    }

    fn interface(&mut self, prototype: &Signature) -> usize {
        self.put("INTERFACE Acting\n");
        self.head("METHOD", prototype);
        self.put("END_METHOD\nEND_INTERFACE\n");
        self.types.instances.push("Acting".to_owned());
        self.units.push(Unit {
            body: None,
            methods: Vec::new(),
            is_interface: true,
            above: Vec::new(),
        });
        self.units.len() - 1
    }

    fn class(
        &mut self,
        name: &str,
        relation: &str,
        words: &str,
        prototype: &Signature,
        above: Vec<usize>,
    ) -> usize {
        let start = self.draft.position();
        self.put(&format!("CLASS {name}{relation}\nVAR\n"));
        let mut seen = Frame::default();
        let prefix = if above.len() > 1 { "d" } else { "b" };
        for index in 0..1 + self.rng.below(2) {
            let ty = self.types.any(self.rng);
            let variable = format!("{prefix}_{index}");
            self.declaration(&variable, ty, true);
            seen.add(&variable, ty, true, true);
        }
        self.put("END_VAR\n");
        let words = format!("METHOD PUBLIC{words}");
        let method = self.method(&words, prototype.clone(), seen);
        self.put("END_CLASS\n");
        self.draft.mark(start, "");
        // A call behind the interface may run any of them.
        let interface = above[0];
        let known = self.units[interface].methods.first();
        let cost = known.map_or(0, |known| known.cost).max(method.cost);
        let dispatched = Signature { cost, ..method };
        self.units[interface].methods = vec![dispatched.clone()];
        self.types.instances.push(name.to_owned());
        self.units.push(Unit {
            body: None,
            methods: vec![dispatched],
            is_interface: false,
            above,
        });
        self.units.len() - 1
    }
}
