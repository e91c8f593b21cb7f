//! Names and the ways from them: members, elements, bits, references.

mod element;
mod part;
mod pointer;
mod reference;

pub(crate) use part::{enter_bits, shared_bytes};

use super::property::Target;
use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::code::{LocalId, PathStep, Root};
use crate::st::constant::Const;
use crate::st::signature::{Def, PouId, Storage, Var};
use crate::st::types::{TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, ExprKind as Written, PouKind, SectionKind};
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// A path to something, or an enumerator.
    pub(crate) fn place(&mut self, id: st::Id<st::Expr>, want: Option<TypeId>) -> Operand {
        let written = self.arena()[id];
        let range = written.range;
        match written.kind {
            Written::Name(name) => self.name(name, range, want),
            Written::Member { base, member } => self.member(base, member, range, want),
            Written::Index { base, indices } => self.index(base, indices, range),
            Written::Part { base, part } => self.part(base, part, range),
            Written::Deref(base) => self.deref(base, range),
            Written::This => self.this(range),
            Written::Direct(_) => self.direct(id, None, range),
            Written::Super => self.error(Message::E3003, range, "SUPER stands in calls only"),
            Written::Literal(_)
            | Written::Typed { .. }
            | Written::Null
            | Written::Ref(_)
            | Written::Call { .. }
            | Written::Unary { .. }
            | Written::Binary { .. }
            | Written::ArrayValue(_)
            | Written::Repeat { .. }
            | Written::StructValue(_)
            | Written::Error => self.expr(id, want),
        }
    }

    /// What a name stands for.
    fn name(&mut self, name: Symbol, range: TextRange, want: Option<TypeId>) -> Operand {
        if let Some(operand) = self.own_name(name, range) {
            return operand;
        }
        if let Some(eno) = self.eno
            && name == self.an.words.eno
        {
            return self.place_operand(
                Root::Local(eno),
                Vec::new(),
                Rights::All,
                TypeId::BOOL,
                range,
            );
        }
        if name == self.an.words.en && self.pou.is_some() {
            // The body runs only when it is TRUE.
            return Operand::constant(Const::Int(1), TypeId::BOOL, range);
        }
        if let Some(ty) = want
            && !self.is_qualified(ty)
            && let Some(operand) = self.find_enumerator(ty, name, range)
        {
            return operand;
        }
        match self.an.enumerators.get(&name).map(Vec::as_slice) {
            Some(&[(ty, value)]) => {
                return Operand::constant(Const::Int(value), ty, range);
            }
            Some(several) => {
                let several = several.to_vec();
                return self.ambiguous_enumerator(name, &several, range);
            }
            None => {}
        }
        let Some(defs) = self.an.found_name(self.unit, self.namespace, name, range) else {
            return Operand::error(range);
        };
        let def = defs.first().copied();
        let text = self.text(name);
        match def {
            Some(Def::Global(id)) => self.global(id, name, range),
            Some(Def::Pou(pou)) if self.an.pou(pou).kind == PouKind::Program => {
                self.program(pou, range)
            }
            Some(Def::Pou(_)) => {
                let message = format!("`{text}` is called with parentheses");
                self.error(Message::E3004, range, message)
            }
            Some(Def::Type(_) | Def::Namespace(_)) => {
                let message = format!("`{text}` is no variable");
                self.error(Message::E1012, range, message)
            }
            None => self.unknown_name(name, range),
        }
    }

    fn unknown_name(&mut self, name: Symbol, range: TextRange) -> Operand {
        let message = format!("no variable is named `{}`", self.text(name));
        let mut diagnostic = Diagnostic::new(Message::E1012, self.span(range), message);
        let mut candidates = self.an.visible(self.namespace);
        let mut at = self.pou;
        while let Some(pou) = at {
            let pou = self.an.pou(pou);
            candidates.extend(pou.vars.iter().map(|var| var.name));
            at = pou.owner.or(pou.extends.first().copied());
        }
        let mut enums = self.an.types.enums.iter().filter(|def| def.qualified);
        let home = enums.find(|def| def.values.iter().any(|(known, _)| *known == name));
        if let Some(home) = home.and_then(|def| def.name) {
            let (home, text) = (self.text(home), self.text(name));
            let note = format!("it is a value of `{home}`, which is named with it: {home}.{text}");
            diagnostic = diagnostic.note(note);
        } else if let Some(close) = self.an.similar(name, candidates) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
        Operand::error(range)
    }

    /// A variable of the unit, of what it belongs to, or of what that extends.
    fn own_name(&mut self, name: Symbol, range: TextRange) -> Option<Operand> {
        let pou = self.pou?;
        if let Some(index) = self.an.pou(pou).by_name.get(&name).copied() {
            return Some(self.own_variable(pou, index as usize, range));
        }
        let signature = self.an.pou(pou);
        if signature.result_name == name
            && let Some(ty) = signature.result
        {
            return Some(self.result_variable(ty, range));
        }
        self.member_of_this(name, range)
    }

    fn result_variable(&mut self, ty: TypeId, range: TextRange) -> Operand {
        let root = match (self.result, self.result_ref) {
            (Some(local), _) => Root::Local(local),
            (None, Some(reference)) => Root::Ref(reference),
            (None, None) => return Operand::error(range),
        };
        self.place_operand(root, Vec::new(), Rights::All, ty, range)
    }

    fn own_variable(&mut self, pou: PouId, index: usize, range: TextRange) -> Operand {
        let var = self.an.pou(pou).vars[index].clone();
        let pou_home = self.an.pou(pou).owner.unwrap_or(pou);
        match &var.storage {
            Storage::Local => match self.local_of(index) {
                Some(local) => {
                    let rights = own_rights(&var);
                    self.place_operand(Root::Local(local), Vec::new(), rights, var.ty, range)
                }
                None => self.not_constant(range),
            },
            Storage::Ref(reference) => {
                let rights = own_rights(&var);
                self.place_operand(Root::Ref(*reference), Vec::new(), rights, var.ty, range)
            }
            Storage::Field(_) if var.edge.is_some() => match self.local_of(index) {
                Some(local) => {
                    let rights = Rights::OwnInput;
                    self.place_operand(Root::Local(local), Vec::new(), rights, var.ty, range)
                }
                None => self.not_constant(range),
            },
            Storage::Field(_) | Storage::Global(_) | Storage::Const(_) | Storage::Located(_) => {
                let this = self.this_as(pou_home);
                self.instance_variable(this.root, this.steps, &var, false, range)
            }
        }
    }

    fn local_of(&self, index: usize) -> Option<LocalId> {
        self.locals.get(index).copied().flatten()
    }

    fn not_constant(&mut self, range: TextRange) -> Operand {
        self.error(Message::E2030, range, "a constant is needed here")
    }

    /// A variable of an instance at a place.
    pub(super) fn instance_variable(
        &mut self,
        root: Root,
        mut steps: Vec<PathStep>,
        var: &Var,
        outside: bool,
        range: TextRange,
    ) -> Operand {
        match &var.storage {
            Storage::Const(value) => Operand::constant(value.clone(), var.ty, range),
            Storage::Field(_) if var.edge.is_some() && !outside => {
                let name = self.text(var.name);
                let message = format!("the edge of `{name}` can be seen in the body only");
                self.error(Message::E1013, range, message)
            }
            Storage::Field(field) => {
                steps.push(PathStep::Field(*field));
                let rights = if outside {
                    outside_rights(var)
                } else {
                    own_rights(var)
                };
                self.place_operand(root, steps, rights, var.ty, range)
            }
            Storage::Global(id) => {
                let id = *id;
                self.global_place(id, var.constant, range)
            }
            Storage::Located(address) => {
                let rights = match address.area {
                    st::Area::Input => Rights::OwnInput,
                    st::Area::Output | st::Area::Memory => own_rights(var),
                };
                let address = *address;
                self.at_address(address, var.ty, rights, range)
            }
            // What is wrong with its declaration was reported there.
            Storage::Local | Storage::Ref(_) if var.ty == TypeId::ERROR => Operand::error(range),
            Storage::Local | Storage::Ref(_) => {
                let message = format!("`{}` exists only while the block runs", self.text(var.name));
                self.error(Message::E1013, range, message)
            }
        }
    }

    pub(super) fn place_operand(
        &mut self,
        root: Root,
        steps: Vec<PathStep>,
        rights: Rights,
        ty: TypeId,
        range: TextRange,
    ) -> Operand {
        if self.constant_only {
            return self.not_constant(range);
        }
        if ty == TypeId::ERROR {
            return Operand::error(range);
        }
        let place = Place {
            root,
            steps,
            rights,
        };
        let operand = Operand {
            kind: OperandKind::Place(place),
            ty,
            range,
        };
        match self.an.types.implicit_target(ty) {
            Some(target) => self.follow(&operand, target, range),
            None => operand,
        }
    }

    /// A global variable named without VAR_EXTERNAL.
    fn global(
        &mut self,
        id: crate::st::signature::GlobalId,
        name: Symbol,
        range: TextRange,
    ) -> Operand {
        if self.pou.is_none() || self.an.options.codesys || self.in_test() {
            return self.global_place(id, false, range);
        }
        let text = self.text(name);
        self.an.complete_global(id);
        let ty = self.type_name(self.an.global(id).ty);
        let message = format!("`{text}` is a global variable that this unit does not declare");
        let note = format!("declare it: VAR_EXTERNAL {text} : {ty}; END_VAR");
        let other = self.an.global(id).span;
        let diagnostic = Diagnostic::new(Message::E1014, self.span(range), message);
        self.report(diagnostic.also(other, "declared here").note(note));
        Operand::error(range)
    }

    fn global_place(
        &mut self,
        id: crate::st::signature::GlobalId,
        constant: bool,
        range: TextRange,
    ) -> Operand {
        self.an.complete_global(id);
        let global = self.an.global(id).clone();
        if let Some(value) = global.value {
            return Operand::constant(value, global.ty, range);
        }
        if global.ty == TypeId::ERROR {
            return Operand::error(range);
        }
        let Some(spot) = global.spot else {
            return self.not_constant(range);
        };
        let rights = if constant || global.constant {
            Rights::Constant
        } else if self.an.is_input(id) {
            Rights::OwnInput
        } else {
            Rights::All
        };
        self.place_operand(Root::Tag(spot.tag), spot.steps, rights, global.ty, range)
    }

    /// What lies at an address.
    pub(super) fn at_address(
        &mut self,
        address: crate::st::address::Address,
        ty: TypeId,
        rights: Rights,
        range: TextRange,
    ) -> Operand {
        if self.constant_only {
            return self.not_constant(range);
        }
        match self.an.spot(address, ty) {
            Some(spot) => self.place_operand(Root::Tag(spot.tag), spot.steps, rights, ty, range),
            None => {
                let (text, name) = (address.text(), self.type_name(ty));
                let message = format!("{name} at {text}, which others overlap, is not compiled");
                self.error(Message::E2010, range, message)
            }
        }
    }

    /// A direct address, as a value of a type of its width or as bits.
    pub(super) fn direct(
        &mut self,
        id: st::Id<st::Expr>,
        want: Option<TypeId>,
        range: TextRange,
    ) -> Operand {
        let Some(address) = self.an.address(self.unit, id) else {
            if self.an.is_partly(self.unit, id) {
                let message = "an address with `*` stands behind AT only";
                return self.error(Message::E3003, range, message);
            }
            return Operand::error(range);
        };
        let rights = match address.area {
            st::Area::Input => Rights::OwnInput,
            st::Area::Output | st::Area::Memory => Rights::All,
        };
        let ty = want.unwrap_or(address.plain_type());
        self.at_address(address, ty, rights, range)
    }

    /// `base.member`.
    fn member(
        &mut self,
        base: st::Id<st::Expr>,
        member: st::Ident,
        range: TextRange,
        want: Option<TypeId>,
    ) -> Operand {
        match self.member_target(base, member, range, want) {
            Target::Place(operand) => operand,
            Target::Property(property) => self.read_property(property, range),
        }
    }

    /// `base.member`, of what was looked at.
    pub(super) fn member_of(
        &mut self,
        base: Operand,
        member: st::Ident,
        range: TextRange,
    ) -> Operand {
        if base.is_error() {
            return base;
        }
        let OperandKind::Place(place) = &base.kind else {
            let message = format!("{} has no members", self.type_name(base.ty));
            return self.error(Message::E1002, member.range, message);
        };
        let (mut steps, root, rights) = (place.steps.clone(), place.root, place.rights);
        match self.an.types.base(base.ty).clone() {
            TypeKind::Struct(index) => {
                let def = &self.an.types.structs[index as usize];
                let Some(&position) = def.by_name.get(&member.name) else {
                    let candidates = def.members.iter().map(|m| m.name).collect();
                    return self.no_member(base.ty, member, candidates);
                };
                let ty = def.members[position as usize].ty;
                let first = def.overlay.as_ref().map(|o| o.first[position as usize]);
                match first {
                    Some(first) => steps.extend(self.an.overlay_steps(first, ty)),
                    None => steps.push(PathStep::Field(position)),
                }
                self.place_operand(root, steps, rights, ty, range)
            }
            TypeKind::Instance(pou) => {
                let place = place.clone();
                self.instance_member(pou, &place, member, range)
            }
            TypeKind::Error
            | TypeKind::Nothing
            | TypeKind::UntypedInt
            | TypeKind::UntypedReal
            | TypeKind::Null
            | TypeKind::Elementary(_)
            | TypeKind::Text { .. }
            | TypeKind::Enum(_)
            | TypeKind::Subrange { .. }
            | TypeKind::Array { .. }
            | TypeKind::OpenArray { .. }
            | TypeKind::Interface(_)
            | TypeKind::Reference(..)
            | TypeKind::Alias(_) => {
                let message = format!("{} has no members", self.type_name(base.ty));
                self.error(Message::E1002, member.range, message)
            }
        }
    }

    pub(super) fn no_member(
        &mut self,
        ty: TypeId,
        member: st::Ident,
        candidates: Vec<Symbol>,
    ) -> Operand {
        let name = self.text(member.name);
        let message = format!("{} has no member `{name}`", self.type_name(ty));
        let mut diagnostic = Diagnostic::new(Message::E1002, self.span(member.range), message);
        if let Some(close) = self.an.similar(member.name, candidates) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
        Operand::error(member.range)
    }

    /// `namespace.name` and `Enumeration.Value`; `None` if the base is something else.
    pub(super) fn qualified(
        &mut self,
        base: st::Id<st::Expr>,
        member: st::Ident,
        range: TextRange,
        _want: Option<TypeId>,
    ) -> Option<Operand> {
        if let Written::Name(name) = self.arena()[base].kind
            && self.own_symbol(name)
        {
            return None;
        }
        let def = self
            .an
            .path(self.unit, self.namespace, base)?
            .first()
            .copied()?;
        match def {
            Def::Namespace(namespace) => {
                if self.an.found(self.unit, self.namespace, base).is_none() {
                    return Some(Operand::error(range));
                }
                let Some(inner) = self
                    .an
                    .found_in(self.unit, self.namespace, namespace, member)
                else {
                    return Some(Operand::error(range));
                };
                Some(match inner.first().copied() {
                    Some(Def::Global(id)) => self.global_place(id, false, range),
                    Some(Def::Pou(pou)) if self.an.pou(pou).kind == PouKind::Program => {
                        self.program(pou, range)
                    }
                    Some(_) => {
                        let message = format!("`{}` is no variable", self.text(member.name));
                        self.error(Message::E1012, range, message)
                    }
                    None => {
                        let message = format!("the namespace has no `{}`", self.text(member.name));
                        self.error(Message::E1012, member.range, message)
                    }
                })
            }
            Def::Type(id) => {
                let ty = self.an.declared_type(id);
                let is_enum = matches!(self.an.types.base(ty), TypeKind::Enum(_));
                if is_enum && !self.an.options.codesys && !self.an.is_library(self.unit) {
                    let what = "a value of an enumeration behind a dot";
                    self.an.foreign(self.unit, range, what);
                    return Some(Operand::error(range));
                }
                is_enum.then(|| self.enumerator_of(ty, member.name, range))
            }
            Def::Pou(_) | Def::Global(_) => None,
        }
    }

    /// Whether the unit itself knows a name.
    pub(super) fn own_symbol(&self, name: Symbol) -> bool {
        let Some(pou) = self.pou else { return false };
        let mut at = Some(pou);
        while let Some(id) = at {
            let signature = self.an.pou(id);
            if signature.by_name.contains_key(&name) || self.an.property(id, name).is_some() {
                return true;
            }
            at = signature.owner.or(signature.extends.first().copied());
        }
        false
    }

    /// An enumerator of a type.
    pub(super) fn enumerator_of(&mut self, ty: TypeId, name: Symbol, range: TextRange) -> Operand {
        if let Some(operand) = self.find_enumerator(ty, name, range) {
            return operand;
        }
        if ty == TypeId::ERROR {
            return Operand::error(range);
        }
        let type_name = self.type_name(ty);
        let message = format!("{type_name} has no value `{}`", self.text(name));
        let mut diagnostic = Diagnostic::new(Message::E1016, self.span(range), message);
        if let Some(def) = self.an.types.enumeration(ty) {
            let candidates: Vec<Symbol> = def.values.iter().map(|(name, _)| *name).collect();
            if let Some(close) = self.an.similar(name, candidates) {
                diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
            }
        }
        self.report(diagnostic);
        Operand::error(range)
    }

    fn find_enumerator(&self, ty: TypeId, name: Symbol, range: TextRange) -> Option<Operand> {
        let def = self.an.types.enumeration(ty)?;
        let (_, value) = def.values.iter().find(|(known, _)| *known == name)?;
        let ty = self.an.types.strip(ty);
        Some(Operand::constant(Const::Int(*value), ty, range))
    }

    /// Whether the values of an enumeration are named with it alone.
    fn is_qualified(&self, ty: TypeId) -> bool {
        let enumeration = self.an.types.enumeration(ty);
        enumeration.is_some_and(|def| def.qualified)
    }

    fn ambiguous_enumerator(
        &mut self,
        name: Symbol,
        of: &[(TypeId, i128)],
        range: TextRange,
    ) -> Operand {
        let text = self.text(name);
        let types: Vec<String> = of
            .iter()
            .map(|(ty, _)| format!("{}#{text}", self.type_name(*ty)))
            .collect();
        let message = format!("`{text}` is a value of several enumerations");
        let diagnostic = Diagnostic::new(Message::E1017, self.span(range), message);
        self.report(diagnostic.note(format!("write {}", types.join(" or "))));
        Operand::error(range)
    }

    /// `base^`.
    fn deref(&mut self, base: st::Id<st::Expr>, range: TextRange) -> Operand {
        if self.an.options.codesys && self.arena()[base].kind == Written::This {
            return self.this(range);
        }
        let base = self.place(base, None);
        if base.is_error() {
            return base;
        }
        match self.an.types.target(base.ty) {
            Some(target) => self.follow(&base, target, range),
            None => {
                let message = format!("{} is no reference", self.type_name(base.ty));
                self.error(Message::E2034, range, message)
            }
        }
    }

    /// What a reference stands for.
    pub(super) fn follow(
        &mut self,
        reference: &Operand,
        target: TypeId,
        range: TextRange,
    ) -> Operand {
        if let Some(pou) = self.an.types.instance(target) {
            self.an.complete(pou);
        }
        let address = self.raw(reference);
        if let OperandKind::Place(place) = &reference.kind {
            self.followed.insert(address, place.clone());
        }
        let ty = self.an.storage(target);
        let root = Root::Deref {
            address,
            ty,
            checked: false,
        };
        self.place_operand(root, Vec::new(), Rights::All, target, range)
    }

    /// Whether a unit is one that a path can call as a function.
    pub(super) fn is_function(&self, pou: PouId) -> bool {
        self.an.pou(pou).kind == PouKind::Function
    }
}

/// What a unit may do with its own variable.
fn own_rights(var: &Var) -> Rights {
    if var.constant {
        return Rights::Constant;
    }
    match var.section {
        SectionKind::Input => Rights::OwnInput,
        SectionKind::Var
        | SectionKind::Output
        | SectionKind::InOut
        | SectionKind::Temp
        | SectionKind::External
        | SectionKind::Global
        | SectionKind::Access
        | SectionKind::Config
        | SectionKind::Static
        | SectionKind::Instance => Rights::All,
    }
}

/// What others may do with a variable of an instance.
fn outside_rights(var: &Var) -> Rights {
    if var.constant && var.section != SectionKind::Input {
        return Rights::Constant;
    }
    match var.section {
        SectionKind::Output => Rights::OtherOutput,
        SectionKind::Var
        | SectionKind::Input
        | SectionKind::InOut
        | SectionKind::Temp
        | SectionKind::External
        | SectionKind::Global
        | SectionKind::Access
        | SectionKind::Config
        | SectionKind::Static
        | SectionKind::Instance => Rights::All,
    }
}
