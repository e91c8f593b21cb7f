//! Instances of blocks, classes and programs: what they are made of and hold at the start.

use crate::hir::{InitId, code::Init};
use crate::st::analysis::Analysis;
use crate::st::resolve::TypeScope;
use crate::st::signature::{PouId, Storage, Var};
use crate::st::types::{Parts, TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, ArgumentKind, ModifierKind, SectionKind};
use iecc_diag::{Code, Diagnostic};

/// One field of the structure of an instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum InstancePart {
    /// The number of its type.
    TypeNumber,
    /// Whether it is a mock, and how often it was called.
    Mock,
    /// The instance of what is extended.
    Base(PouId),
    /// A variable, by its position in the signature.
    Var(usize),
    /// What an input with an edge was before.
    Edge(usize),
}

/// Initial values that the declaration of an instance gives, by who declares the variable.
type Given = Vec<(PouId, usize, st::Id<st::Expr>)>;

impl Analysis<'_> {
    /// The field of the first variable of an instance.
    pub(crate) fn first_field(&self, pou: PouId) -> u32 {
        if self.base_of(pou).is_some() {
            return 1;
        }
        u32::from(self.holds_number(pou)) + u32::from(self.testing.mocks)
    }

    /// The hidden number of an instance that may be a mock: how many steps lead to the root of what
    /// it extends, and its field there.
    pub(crate) fn mock_field(&self, pou: PouId) -> Option<(usize, u32)> {
        let lineage = self.lineage(pou);
        let root = *lineage.last().expect("begins with the unit");
        let field = u32::from(self.holds_number(root));
        self.testing.mocks.then_some((lineage.len() - 1, field))
    }

    /// What the structure of an instance is made of; positions are those of its fields.
    pub(crate) fn instance_parts(&self, pou: PouId) -> Vec<InstancePart> {
        let sig = self.pou(pou);
        let mut parts = Vec::new();
        if self.holds_number(pou) {
            parts.push(InstancePart::TypeNumber);
        }
        if self.testing.mocks && self.base_of(pou).is_none() {
            parts.push(InstancePart::Mock);
        }
        parts.extend(self.base_of(pou).map(InstancePart::Base));
        let mut fields: Vec<(u32, InstancePart)> = Vec::new();
        for (index, var) in sig.vars.iter().enumerate() {
            if let Storage::Field(field) = var.storage {
                fields.push((field, InstancePart::Var(index)));
                if var.edge.is_some() {
                    fields.push((field + 1, InstancePart::Edge(index)));
                }
            }
        }
        fields.sort_by_key(|(field, _)| *field);
        parts.extend(fields.into_iter().map(|(_, part)| part));
        parts
    }

    /// A variable of a class or block or of what it extends, and who declares it.
    pub(crate) fn instance_var(&self, pou: PouId, name: Symbol) -> Option<(PouId, usize)> {
        self.lineage(pou).into_iter().find_map(|id| {
            let index = self.pou(id).by_name.get(&name)?;
            Some((id, *index as usize))
        })
    }

    /// What an instance without initial values of its own holds at the start.
    pub(crate) fn instance_default(&mut self, pou: PouId) -> Option<InitId> {
        self.instance_init(None, pou, pou, &Vec::new())
    }

    /// `(a := 1, b := 2)` for an instance.
    pub(crate) fn instance_value(
        &mut self,
        scope: TypeScope<'_>,
        arguments: st::List<st::Argument>,
        pou: PouId,
    ) -> Option<InitId> {
        let arena = &self.unit(scope.unit).arena;
        let mut given = Given::new();
        for argument in &arena[arguments] {
            let (ArgumentKind::Input(name), Some(value)) = (argument.kind, argument.value) else {
                continue;
            };
            match self.instance_var(pou, name.name) {
                Some((of, index)) => {
                    self.may_initialise(scope, of, index, name);
                    given.push((of, index, value));
                }
                None => {
                    let lineage = self.lineage(pou);
                    let vars = lineage.iter().flat_map(|id| self.pou(*id).vars.iter());
                    let candidates = vars.map(|var| var.name).collect();
                    let ty = self.types.intern(TypeKind::Instance(pou));
                    self.no_such_member(scope, ty, name, candidates);
                }
            }
        }
        self.instance_init(Some(scope), pou, pou, &given)
    }

    /// Only inputs, outputs and public variables may get other initial values.
    fn may_initialise(&mut self, scope: TypeScope<'_>, of: PouId, index: usize, name: st::Ident) {
        let var = &self.pou(of).vars[index];
        let open = matches!(var.section, SectionKind::Input | SectionKind::Output)
            || self.options.codesys
            || var.access == Some(ModifierKind::Public);
        if open {
            return;
        }
        let declared = self.span(self.pou(of).unit, var.range);
        let text = self.text(name.name);
        let message = format!("`{text}` is not PUBLIC, so an instance cannot give it a value");
        let span = self.span(scope.unit, name.range);
        let diagnostic = Diagnostic::new(Code::E1015, span, message);
        self.report(diagnostic.also(declared, "declared here"));
    }

    /// The initial value of the part `pou` of an instance of type `of`. Recursion is bounded by the
    /// length of chains.
    fn instance_init(
        &mut self,
        scope: Option<TypeScope<'_>>,
        pou: PouId,
        of: PouId,
        given: &Given,
    ) -> Option<InitId> {
        let mut parts = Vec::new();
        for (position, part) in (0..).zip(self.instance_parts(pou)) {
            let init = match part {
                InstancePart::TypeNumber => {
                    let number = u64::from(self.type_number(of));
                    Some(self.init(Init::Bits(number)))
                }
                InstancePart::Base(base) => self.instance_init(scope, base, of, given),
                InstancePart::Var(index) => {
                    let var = self.pou(pou).vars[index].clone();
                    let own = given
                        .iter()
                        .find(|(declares, at, _)| (*declares, *at) == (pou, index));
                    match (own, scope) {
                        (Some((.., expr)), Some(scope)) => self.value_of(scope, *expr, var.ty),
                        (Some(_), None) | (None, _) => self.declared_value(&var),
                    }
                }
                InstancePart::Mock => None,
                // F_EDGE sees a falling edge only after the input was TRUE.
                InstancePart::Edge(_) => None,
            };
            parts.extend(init.map(|init| (position, init)));
        }
        self.struct_init(parts)
    }

    fn declared_value(&mut self, var: &Var) -> Option<InitId> {
        match var.initial {
            Some(initial) => self.initial_value(initial, var.ty),
            None => self.default_init(var.ty),
        }
    }

    /// The class or block with a type number that a type holds an instance of, if any.
    pub(crate) fn numbered_inside(&self, ty: TypeId) -> Option<PouId> {
        self.instance_inside(ty, &|pou| {
            let own = self.is_numbered(pou).then_some(pou);
            own.or_else(|| {
                let vars = self.pou(pou).vars.iter();
                vars.filter(|var| matches!(var.storage, Storage::Field(_)))
                    .find_map(|var| self.numbered_inside(var.ty))
            })
        })
    }

    /// The first answer about an instance that a type holds, also in arrays and structures. Recursion
    /// is bounded by the nesting of types.
    pub(crate) fn instance_inside(
        &self,
        ty: TypeId,
        ask: &dyn Fn(PouId) -> Option<PouId>,
    ) -> Option<PouId> {
        match self.types.parts(ty) {
            Parts::Variables(pou) => ask(pou),
            Parts::Elements { element, .. } => self.instance_inside(element, ask),
            Parts::Members(def) => {
                let mut members = def.members.iter();
                members.find_map(|m| self.instance_inside(m.ty, ask))
            }
            Parts::None => None,
        }
    }
}
