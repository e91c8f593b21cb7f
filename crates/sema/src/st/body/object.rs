//! Objects: whose members are seen, which body runs, what references to them may become.

use super::call::Callee;
use super::call::Presence;
use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::code::{Call, ExprId, ExprKind, PathStep, Root, StmtKind};
use crate::hir::{self, Elementary, Type};
use crate::st::signature::{Bindings, Part, PouId, Storage, Var};
use crate::st::signatures::CallShape;
use crate::st::types::TypeKind;
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind as Written, ModifierKind, PouKind, SectionKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::{Span, TextRange};

/// A method or function with what it runs on.
pub(crate) struct Target {
    /// Whose parameters count.
    pub signature: PouId,
    pub run: Run,
    /// What has to hold for the instance to be there.
    pub presence: Presence,
}

/// Which body runs, and on what.
pub(crate) enum Run {
    /// A function.
    Function,
    /// This one, on this instance.
    On { body: PouId, instance: Place },
    /// One that depends on the type of the instance at an address.
    Choose {
        unit: hir::PouId,
        address: ExprId,
        eno: bool,
    },
}

/// Who may use a member.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Access {
    Public,
    Protected,
    Private,
    Internal,
}

impl Access {
    fn of(modifiers: impl IntoIterator<Item = ModifierKind>) -> Option<Self> {
        modifiers.into_iter().find_map(|modifier| match modifier {
            ModifierKind::Public => Some(Self::Public),
            ModifierKind::Protected => Some(Self::Protected),
            ModifierKind::Private => Some(Self::Private),
            ModifierKind::Internal => Some(Self::Internal),
            ModifierKind::Constant
            | ModifierKind::Retain
            | ModifierKind::NonRetain
            | ModifierKind::Persistent
            | ModifierKind::Final
            | ModifierKind::Abstract
            | ModifierKind::Override => None,
        })
    }

    fn as_str(self) -> &'static str {
        match self {
            Self::Public => "PUBLIC",
            Self::Protected => "PROTECTED",
            Self::Private => "PRIVATE",
            Self::Internal => "INTERNAL",
        }
    }
}

/// A function.
pub(super) fn function_target(function: PouId) -> Target {
    Target {
        signature: function,
        run: Run::Function,
        presence: Presence::default(),
    }
}

impl Body<'_, '_> {
    /// How a target is called.
    pub(super) fn shape_of(&self, target: &Target) -> CallShape {
        let shape = self.an.call_shape(target.signature);
        let eno = match &target.run {
            Run::Function => shape.eno,
            Run::On { body, .. } => self.an.call_shape(*body).eno,
            Run::Choose { eno, .. } => *eno,
        };
        CallShape { eno, ..shape }
    }

    /// The body that a call runs.
    pub(super) fn run_unit(&mut self, target: &Target) -> hir::PouId {
        if !self.an.is_library(self.an.pou(target.signature).unit) {
            self.effects += 1;
        }
        match &target.run {
            Run::Function => self.an.want(target.signature),
            Run::On { body, .. } => {
                self.an.complete(*body);
                self.an.want(*body)
            }
            Run::Choose { unit, .. } => *unit,
        }
    }

    /// The class or block that the body belongs to.
    pub(super) fn home(&self) -> Option<PouId> {
        let pou = self.pou?;
        let home = self.an.pou(pou).owner.unwrap_or(pou);
        self.an.pou(home).has_instances().then_some(home)
    }

    /// Whether a place begins with the instance that the body works on.
    fn begins_with_this(&self, place: &Place) -> bool {
        place.root == Root::Ref(0) && self.home().is_some()
    }

    /// The steps from one type to one that it extends.
    fn base_steps(&self, from: PouId, to: PouId) -> impl Iterator<Item = PathStep> + use<> {
        let distance = self.an.base_distance(from, to).unwrap_or(0);
        std::iter::repeat_n(PathStep::Field(0), distance)
    }

    /// The instance the body works on, as a type that it extends or is.
    pub(super) fn this_as(&self, ty: PouId) -> Place {
        let of = self.pou.map_or(ty, |pou| self.an.instance_of(pou));
        Place {
            root: Root::Ref(0),
            steps: self.base_steps(of, ty).collect(),
            rights: Rights::All,
        }
    }

    /// `THIS`.
    pub(super) fn this(&mut self, range: TextRange) -> Operand {
        let Some(home) = self.home() else {
            let message = "THIS stands in blocks, classes and methods only";
            return self.error(Message::E3003, range, message);
        };
        let ty = self.an.types.intern(TypeKind::Instance(home));
        let place = self.this_as(home);
        self.place_operand(place.root, place.steps, place.rights, ty, range)
    }

    /// A variable of the instance that the body works on.
    pub(super) fn member_of_this(&mut self, name: Symbol, range: TextRange) -> Option<Operand> {
        let home = self.home()?;
        let Some((of, index)) = self.an.instance_var(home, name) else {
            return self.own_property(name, range);
        };
        let var = self.an.pou(of).vars[index].clone();
        let in_method = self
            .pou
            .is_some_and(|pou| self.an.pou(pou).part != Part::Whole);
        if in_method && var.edge.is_some() {
            let text = self.text(name);
            let message = format!("methods cannot use `{text}`, whose edge only the body sees");
            return Some(self.error(Message::E1013, range, message));
        }
        if !self.check_variable(&var, of, range) {
            return Some(Operand::error(range));
        }
        let this = self.this_as(of);
        Some(self.instance_variable(this.root, this.steps, &var, false, range))
    }

    /// `base.member`, of an instance.
    pub(super) fn instance_member(
        &mut self,
        pou: PouId,
        place: &Place,
        member: st::Ident,
        range: TextRange,
    ) -> Operand {
        let own = self.an.instance_var(pou, member.name);
        let second = || self.an.parameter_alias(pou, member.name);
        let found = own.or_else(|| self.an.instance_var(pou, second()?));
        let Some((of, index)) = found else {
            return self.no_instance_member(pou, member);
        };
        let var = self.an.pou(of).vars[index].clone();
        // What does not last is told apart from what is hidden.
        let lasting = !matches!(var.storage, Storage::Local | Storage::Ref(_));
        if lasting && !self.check_variable(&var, of, member.range) {
            return Operand::error(range);
        }
        let own = self.begins_with_this(place)
            && place.steps.iter().all(|step| *step == PathStep::Field(0))
            && self.home().is_some_and(|home| home == pou);
        let mut steps = place.steps.clone();
        steps.extend(self.base_steps(pou, of));
        self.instance_variable(place.root, steps, &var, !own, range)
    }

    fn no_instance_member(&mut self, pou: PouId, member: st::Ident) -> Operand {
        let ty = self.an.types.intern(TypeKind::Instance(pou));
        if self.an.method(pou, member.name).is_some() {
            let text = self.text(member.name);
            let message = format!("method `{text}` is called with parentheses");
            return self.error(Message::E3004, member.range, message);
        }
        let lineage = self.an.lineage(pou);
        let vars = lineage.iter().flat_map(|id| self.an.pou(*id).vars.iter());
        let candidates = vars.map(|var| var.name).collect();
        self.no_member(ty, member, candidates)
    }

    fn variable_access(&self, var: &Var) -> Access {
        let passed = var.section.direction().is_some();
        let default = if passed || self.an.options.codesys {
            Access::Public
        } else {
            Access::Protected
        };
        if passed {
            return default;
        }
        Access::of(var.access).unwrap_or(default)
    }

    fn check_variable(&mut self, var: &Var, of: PouId, range: TextRange) -> bool {
        let declared = self.an.span(self.an.pou(of).unit, var.range);
        self.check_access(self.variable_access(var), of, var.name, range, declared)
    }

    fn check_method(&mut self, method: PouId, range: TextRange) -> bool {
        let pou = self.an.pou(method);
        let Some(of) = pou.owner else { return true };
        let default = if self.an.options.codesys || !self.an.pou(of).has_instances() {
            Access::Public
        } else {
            Access::Protected
        };
        let access = Access::of(pou.modifiers.iter().copied()).unwrap_or(default);
        let (name, declared) = (pou.name, pou.span);
        self.check_access(access, of, name, range, declared)
    }

    fn check_access(
        &mut self,
        access: Access,
        of: PouId,
        name: Symbol,
        range: TextRange,
        declared: Span,
    ) -> bool {
        if self.in_test() {
            return true;
        }
        let home = self.home();
        let (allowed, who) = match access {
            Access::Public => (true, "all"),
            Access::Private => (home == Some(of), "its own class or block"),
            Access::Protected => (
                home.is_some_and(|home| self.an.conforms(home, of)),
                "its class or block and what extends it",
            ),
            Access::Internal => {
                let namespace = self.an.home_namespace(self.an.pou(of).namespace);
                (
                    self.an.is_inside(self.namespace, namespace),
                    "its namespace",
                )
            }
        };
        if !allowed && !self.an.has_lost_names(of) {
            let text = self.text(name);
            let message = format!("`{text}` is {}: only {who} can use it", access.as_str());
            let diagnostic = Diagnostic::new(Message::E1015, self.span(range), message);
            self.report(diagnostic.also(declared, "declared here"));
        }
        allowed
    }

    // What runs.

    /// A method by its name alone, of the instance that the body works on.
    pub(super) fn own_method(&mut self, name: Symbol, range: TextRange) -> Option<Callee> {
        let home = self.home()?;
        let signature = self.an.method(home, name)?;
        if !self.check_method(signature, range) {
            return Some(Callee::Mistake);
        }
        let of = self.an.instance_of(self.pou?);
        let this = self.this_as(of);
        let run = self.run(of, &this, Some(name), signature, range);
        Some(Callee::Method(Target {
            signature,
            run,
            presence: Presence::default(),
        }))
    }

    /// `operand.name`, if that is a method.
    pub(super) fn method_callee(&mut self, operand: &Operand, name: st::Ident) -> Option<Callee> {
        let (TypeKind::Instance(of) | TypeKind::Interface(of)) = *self.an.types.base(operand.ty)
        else {
            return None;
        };
        let Some(signature) = self.an.method(of, name.name) else {
            if self.an.pou(of).has_instances() {
                return None;
            }
            self.no_method(of, name);
            return Some(Callee::Mistake);
        };
        if !self.check_method(signature, name.range) {
            return Some(Callee::Mistake);
        }
        let mut presence = Presence::default();
        let run = match (&operand.kind, self.an.pou(of).has_instances()) {
            (OperandKind::Place(place), true) if self.is_this(place, of) => {
                let own = self.pou.map_or(of, |pou| self.an.instance_of(pou));
                let this = self.this_as(own);
                self.run(own, &this, Some(name.name), signature, operand.range)
            }
            (OperandKind::Place(place), true) => {
                let place = self.present(place.clone(), operand.range, &mut presence);
                self.run(of, &place, Some(name.name), signature, operand.range)
            }
            _ => self.run_through(of, operand, name.name, signature, &mut presence),
        };
        Some(Callee::Method(Target {
            signature,
            run,
            presence,
        }))
    }

    /// Whether a place is the whole instance that the body works on.
    fn is_this(&self, place: &Place, ty: PouId) -> bool {
        self.home() == Some(ty)
            && place.root == Root::Ref(0)
            && place.steps == self.this_as(ty).steps
    }

    fn no_method(&mut self, of: PouId, name: st::Ident) {
        if self.an.has_lost_names(of) {
            return;
        }
        let text = self.text(name.name);
        let message = format!("{} has no method `{text}`", self.text(self.an.pou(of).name));
        let mut diagnostic = Diagnostic::new(Message::E1018, self.span(name.range), message);
        let all = self.an.with_ancestors(of);
        let members = all.iter().flat_map(|id| self.an.pou(*id).members.iter());
        let candidates: Vec<Symbol> = members.map(|(name, _)| *name).collect();
        if let Some(close) = self.an.similar(name.name, candidates) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
    }

    /// What runs for a method, or for a call of the block, on the instance at a place.
    pub(super) fn run(
        &mut self,
        of: PouId,
        place: &Place,
        method: Option<Symbol>,
        signature: PouId,
        range: TextRange,
    ) -> Run {
        if self.may_be_derived(place) && method.is_none() {
            self.check_in_outs_of_heirs(of, range);
        }
        if self.may_be_derived(place)
            && let Some(dispatcher) = self.an.dispatcher(of, method, signature)
        {
            let path = self.path_of(place, range);
            return Run::Choose {
                unit: dispatcher.unit,
                address: self.add_expr(ExprKind::Address(path), Elementary::Ulint, range),
                eno: dispatcher.eno,
            };
        }
        let body = self.an.body_of(of, method).unwrap_or(signature);
        self.run_on(body, of, place.clone())
    }

    /// A block that is called as its base gets no more in-outs than the base has.
    fn check_in_outs_of_heirs(&mut self, of: PouId, range: TextRange) {
        let known = self.an.pou(of).section(SectionKind::InOut).count();
        for heir in self.an.concrete_types(of) {
            self.an.complete(heir);
            let pou = self.an.pou(heir);
            let Some(more) = pou.section(SectionKind::InOut).nth(known) else {
                continue;
            };
            let (name, more) = (self.text(pou.name), self.text(more.name));
            let message = format!(
                "this may be a `{name}`, whose in-out `{more}` this call has no argument for"
            );
            self.error(Message::E3016, range, message);
            return;
        }
    }

    fn run_on(&mut self, body: PouId, of: PouId, mut instance: Place) -> Run {
        let wanted = self.an.instance_of(body);
        instance.steps.extend(self.base_steps(of, wanted));
        Run::On { body, instance }
    }

    /// What runs for a method of whatever an interface stands for.
    fn run_through(
        &mut self,
        of: PouId,
        operand: &Operand,
        method: Symbol,
        signature: PouId,
        presence: &mut Presence,
    ) -> Run {
        let root = Root::Deref {
            address: self.raw(operand),
            ty: Type::Elementary(Elementary::Udint),
            checked: false,
        };
        let instance = Place {
            root,
            steps: Vec::new(),
            rights: Rights::All,
        };
        // NULL is to be found here, where the user wrote the call.
        let instance = self.present(instance, operand.range, presence);
        let path = self.path_of(&instance, operand.range);
        let address = self.add_expr(ExprKind::Address(path), Elementary::Ulint, operand.range);
        let dispatcher = self.an.dispatcher(of, Some(method), signature);
        let dispatcher = dispatcher.expect("interfaces always choose");
        Run::Choose {
            unit: dispatcher.unit,
            address,
            eno: dispatcher.eno,
        }
    }

    /// Whether what lies at a place may be an instance of something that extends its type: behind
    /// references, and of in-outs.
    fn may_be_derived(&self, place: &Place) -> bool {
        let passed = match place.root {
            Root::Deref { .. } => true,
            Root::Ref(_) => !self.begins_with_this(place),
            Root::Tag(_) | Root::Local(_) => false,
        };
        passed && place.steps.is_empty()
    }

    /// `SUPER.name`.
    pub(super) fn super_method(&mut self, name: st::Ident, range: TextRange) -> Callee {
        let Some(base) = self.base(range) else {
            return Callee::Mistake;
        };
        let Some(signature) = self.an.method(base, name.name) else {
            self.no_method(base, name);
            return Callee::Mistake;
        };
        if !self.check_method(signature, name.range) {
            return Callee::Mistake;
        }
        if self
            .an
            .pou(signature)
            .modifiers
            .contains(&ModifierKind::Abstract)
        {
            let text = self.text(name.name);
            let message = format!("`{text}` is ABSTRACT in the base, so there is nothing to run");
            self.error(Message::E1046, name.range, message);
            return Callee::Mistake;
        }
        let run = self.run_base(signature);
        Callee::Method(Target {
            signature,
            run,
            presence: Presence::default(),
        })
    }

    fn run_base(&mut self, body: PouId) -> Run {
        let of = self.pou.map_or(body, |pou| self.an.instance_of(pou));
        let body = self.an.body_for(body, of);
        let this = self.this_as(of);
        self.run_on(body, of, this)
    }

    fn base(&mut self, range: TextRange) -> Option<PouId> {
        let base = self.home().and_then(|home| self.an.base_of(home));
        if base.is_none() {
            let message = "SUPER stands in classes and blocks that extend another";
            self.error(Message::E3003, range, message);
        }
        base
    }

    /// `SUPER()`: the body of the base block.
    pub(super) fn super_call(&mut self, arguments: st::List<st::Argument>, range: TextRange) {
        let Some(base) = self.base(range) else { return };
        let in_body = self
            .pou
            .is_some_and(|pou| self.an.pou(pou).part == Part::Whole);
        let message = if self.an.pou(base).kind != PouKind::FunctionBlock {
            "a class has no body that SUPER() could run"
        } else if !in_body {
            "SUPER() stands in the body of a block; methods call SUPER.method()"
        } else if !arguments.is_empty() {
            "SUPER() takes no arguments: the base has the same inputs"
        } else {
            let run = self.run_base(base);
            self.call_base(run, range);
            return;
        };
        self.error(Message::E3003, range, message);
    }

    /// The body of a base for the arrays that this one is for.
    fn with_own_arrays(&mut self, body: PouId) -> PouId {
        if !self.an.has_open_arrays(body) {
            return body;
        }
        let mut bindings = Bindings::default();
        for var in &self.an.pou(body).vars {
            let open = matches!(self.an.types.base(var.ty), TypeKind::OpenArray { .. });
            let own = self.pou.and_then(|pou| self.an.pou(pou).var(var.name));
            if let Some(own) = own.filter(|_| open) {
                bindings.open.push((var.name, self.an.types.strip(own.ty)));
            }
        }
        self.an.instance(body, bindings)
    }

    /// The base body gets the same in-outs.
    fn call_base(&mut self, run: Run, range: TextRange) {
        let Run::On { body, instance } = run else {
            unreachable!("the type of the base is known")
        };
        let body = self.with_own_arrays(body);
        let shape = self.an.call_shape(body);
        let mut refs = vec![self.path_of(&instance, range)];
        for index in shape.refs {
            let name = self.an.pou(body).vars[index].name;
            let own = self.pou.and_then(|pou| self.an.pou(pou).var(name));
            let Some(Storage::Ref(reference)) = own.map(|var| var.storage.clone()) else {
                unreachable!("in-outs are inherited")
            };
            refs.push(self.add_path(Root::Ref(reference), Vec::new(), range));
        }
        let callee = self.an.want(body);
        let call = self.add_call(Call {
            callee,
            refs,
            args: Vec::new(),
            outputs: Vec::new(),
        });
        let value = self.add_expr(ExprKind::Call(call), Elementary::Bool, range);
        self.before(StmtKind::Eval(value), range);
    }

    /// `THIS^` and `SUPER^` of CODESYS, where they are pointers, as `THIS` and `SUPER`.
    pub(super) fn pointed_self(&self, id: st::Id<st::Expr>) -> st::Id<st::Expr> {
        if let Written::Deref(base) = self.arena()[id].kind
            && self.an.options.codesys
            && matches!(self.arena()[base].kind, Written::This | Written::Super)
        {
            return base;
        }
        id
    }
}
