//! Units of the library as they are written: their parameters, pragmas, and the instances made of them.

use crate::st::analysis::Analysis;
use crate::st::body::library::generic::Generic;
use crate::st::body::library::{Parameter, ParameterType};
use crate::st::signature::{Bindings, NamespaceId, PouId, Var};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{
    self, Declarations, Direction, ExprKind as Written, TypeKind as WrittenType, UnitKind,
};

impl Analysis<'_> {
    /// The functions of the library with a name.
    pub(crate) fn stdlib_functions(&self, name: &str) -> Vec<PouId> {
        let Some(symbol) = self.names.find(name) else {
            return Vec::new();
        };
        let defs = self.lookup_in(NamespaceId::LIBRARY, symbol);
        defs.iter()
            .filter_map(|def| match def {
                crate::st::signature::Def::Pou(pou) => Some(*pou),
                crate::st::signature::Def::Type(_)
                | crate::st::signature::Def::Global(_)
                | crate::st::signature::Def::Namespace(_) => None,
            })
            .collect()
    }

    /// The parameters of a library function as they are written.
    pub(crate) fn stdlib_parameters(&self, function: PouId) -> Vec<Parameter> {
        let unit = self.unit(self.pou(function).unit);
        let UnitKind::Pou(pou) = &unit.kind else {
            return Vec::new();
        };
        let mut parameters = Vec::new();
        for section in &unit.arena[pou.sections] {
            let Declarations::Variables(variables) = section.declarations else {
                continue;
            };
            let Some(direction) = section.kind.direction() else {
                continue;
            };
            for decl in &unit.arena[variables] {
                let ty = self.parameter_type(&unit.arena, decl.ty);
                for ident in &unit.arena[decl.names] {
                    parameters.push(Parameter {
                        name: ident.name,
                        output: direction == Direction::Out,
                        ty: ty.clone(),
                    });
                }
            }
        }
        parameters
    }

    fn parameter_type(&self, arena: &st::Arena, ty: st::Id<st::TypeSpec>) -> ParameterType {
        let WrittenType::Named(path) = arena[ty].kind else {
            return ParameterType::Written(ty);
        };
        let Written::Name(name) = arena[path].kind else {
            return ParameterType::Written(ty);
        };
        let text = self.text(name).to_ascii_uppercase();
        match Generic::ALL.iter().find(|(generic, _)| *generic == text) {
            Some((_, class)) => ParameterType::Generic(name, *class),
            None if text == "STRING" => ParameterType::OpenText { wide: false },
            None if text == "WSTRING" => ParameterType::OpenText { wide: true },
            None => ParameterType::Written(ty),
        }
    }

    /// The parameter of a library unit that has this as its second name, in CODESYS or anywhere.
    pub(crate) fn parameter_alias(&self, pou: PouId, name: Symbol) -> Option<Symbol> {
        let pou = self.pou(pou);
        if !self.is_library(pou.unit) {
            return None;
        }
        let quoted = format!("'{}'", self.text(name).to_ascii_uppercase());
        let pragmas = self.unit(pou.unit).pragmas.iter();
        let heeded = |text: &str| self.options.codesys || !text.ends_with("of codesys");
        let mut aliases = pragmas
            .filter(|pragma| pragma.text.contains("alias") && heeded(pragma.text.trim_end()));
        let pragma = aliases.find(|pragma| pragma.text.contains(&quoted))?;
        let behind = pou
            .vars
            .iter()
            .filter(|var| var.range.start >= pragma.range.end);
        behind.min_by_key(|var| var.range.start).map(|var| var.name)
    }

    /// The result that a library function declares.
    pub(crate) fn stdlib_result(&mut self, function: PouId, bindings: &Bindings) -> Option<TypeId> {
        let pou = self.pou(function);
        let (unit, namespace) = (pou.unit, pou.namespace);
        let UnitKind::Pou(written) = &self.unit(unit).kind else {
            return None;
        };
        let scope = crate::st::resolve::TypeScope {
            unit,
            namespace,
            bindings: Some(bindings),
            pou: None,
        };
        written.result.map(|ty| self.type_of_spec(scope, ty))
    }

    /// The generic type that the result of a library function has.
    pub(in crate::st::body) fn stdlib_generic_result(&self, function: PouId) -> Option<Symbol> {
        let unit = self.unit(self.pou(function).unit);
        let UnitKind::Pou(pou) = &unit.kind else {
            return None;
        };
        match self.parameter_type(&unit.arena, pou.result?) {
            ParameterType::Generic(name, _) => Some(name),
            ParameterType::OpenText { .. } | ParameterType::Written(_) => None,
        }
    }

    /// The elementary type that the result of a library function has by name.
    pub(in crate::st::body) fn stdlib_elementary_result(&self, function: PouId) -> Option<TypeId> {
        let unit = self.unit(self.pou(function).unit);
        let UnitKind::Pou(pou) = &unit.kind else {
            return None;
        };
        self.elementary_spec(&unit.arena, pou.result?)
    }

    /// The elementary type that a parameter of a library function has by name.
    pub(in crate::st::body) fn stdlib_elementary(
        &self,
        function: PouId,
        position: usize,
    ) -> Option<TypeId> {
        let unit = self.unit(self.pou(function).unit);
        match self.stdlib_parameters(function).get(position)?.ty {
            ParameterType::Written(spec) => self.elementary_spec(&unit.arena, spec),
            ParameterType::Generic(..) | ParameterType::OpenText { .. } => None,
        }
    }

    fn elementary_spec(&self, arena: &st::Arena, spec: st::Id<st::TypeSpec>) -> Option<TypeId> {
        let WrittenType::Named(path) = arena[spec].kind else {
            return None;
        };
        let Written::Name(name) = arena[path].kind else {
            return None;
        };
        self.elementary_names.get(&name).copied()
    }

    /// A type that a library function names.
    pub(crate) fn stdlib_type(&mut self, function: PouId, spec: st::Id<st::TypeSpec>) -> TypeId {
        let pou = self.pou(function);
        let scope = crate::st::resolve::TypeScope {
            unit: pou.unit,
            namespace: pou.namespace,
            bindings: None,
            pou: None,
        };
        self.type_of_spec(scope, spec)
    }

    /// Whether the library says something of a function.
    pub(crate) fn pragma(&self, function: PouId, word: &str) -> bool {
        let unit = self.unit(self.pou(function).unit);
        unit.pragmas.iter().any(|pragma| pragma.text.contains(word))
    }

    /// The operation a library function stands for.
    pub(crate) fn intrinsic(&self, function: PouId) -> Option<&str> {
        let unit = self.units[self.pou(function).unit.index()].unit;
        unit.pragmas.iter().find_map(|pragma| {
            let (_, rest) = pragma.text.split_once("intrinsic")?;
            let (_, rest) = rest.split_once('\'')?;
            rest.split_once('\'').map(|(name, _)| name)
        })
    }

    /// Whether parameters of a unit are arrays whose bounds are those of the arguments.
    pub(crate) fn has_open_arrays(&self, pou: PouId) -> bool {
        let mut vars = self.pou(pou).vars.iter();
        vars.any(|var| matches!(self.types.base(var.ty), TypeKind::OpenArray { .. }))
    }

    /// A library function with its generic names bound.
    pub(crate) fn instance(&mut self, function: PouId, bindings: Bindings) -> PouId {
        if bindings == Bindings::default() {
            self.complete(function);
            return function;
        }
        let key = (function, bindings);
        if let Some(&known) = self.instances.get(&key) {
            return known;
        }
        let mut pou = self.pou(function).clone();
        pou.bindings = key.1.clone();
        pou.template = Some(function);
        pou.state = crate::st::signature::State::Declared;
        pou.vars.clear();
        pou.by_name.clear();
        let made = self.add_pou(pou);
        self.instances.insert(key, made);
        self.complete(made);
        made
    }

    /// Inputs, outputs and in-outs in order.
    pub(crate) fn parameters(&self, pou: PouId) -> Vec<Var> {
        let vars = self.pou(pou).vars.iter();
        let passed = vars.filter(|var| var.section.direction().is_some());
        passed.cloned().collect()
    }

    /// `INT_TO_REAL`: TO_REAL and INT, a conversion. `ADD_INT`: ADD and INT, none.
    pub(crate) fn typed_name(&self, name: Symbol) -> Option<(String, TypeId, bool)> {
        let text = self.text(name).to_ascii_uppercase();
        for marker in ["_TO_BCD_", "_BCD_TO_", "_TRUNC_", "_TO_"] {
            if let Some((source, target)) = text.split_once(marker)
                && let Some(ty) = self.named_elementary(source)
            {
                return Some((format!("{}{target}", &marker[1..]), ty, true));
            }
        }
        let (function, ty) = text.rsplit_once('_')?;
        Some((function.to_owned(), self.named_elementary(ty)?, false))
    }

    pub(crate) fn named_elementary(&self, name: &str) -> Option<TypeId> {
        let symbol = self.names.find(name)?;
        self.elementary_names.get(&symbol).copied()
    }
}
