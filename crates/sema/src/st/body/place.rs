//! Names and the ways from them: members, elements, bits, references.

use super::{Body, Operand, OperandKind, Place, Rights};
use crate::hir::code::{BinaryOp, Conversion, ExprKind, LocalId, PathStep, Root};
use crate::st::constant::Const;
use crate::st::elementary::El;
use crate::st::signature::{Def, PouId, Storage, Var};
use crate::st::types::{ReferenceKind, TypeId, TypeKind};
use iecc_ast::Symbol;
use iecc_ast::st::{self, AddressSize, ExprKind as Written, Part, PouKind, SectionKind};
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
            _ => self.expr(id, want),
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
        if signature.name == name
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
        match *self.an.types.base(ty) {
            TypeKind::Reference(ReferenceKind::Implicit, target) => {
                self.follow(&operand, target, range)
            }
            _ => operand,
        }
    }

    /// A global variable named without VAR_EXTERNAL.
    fn global(
        &mut self,
        id: crate::st::signature::GlobalId,
        name: Symbol,
        range: TextRange,
    ) -> Operand {
        if self.pou.is_none() || self.an.options.codesys {
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
        if let Some(operand) = self.qualified(base, member, range, want) {
            return operand;
        }
        let base = self.place(base, None);
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
            _ => {
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
    fn qualified(
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
            if signature.by_name.contains_key(&name) {
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
        if let TypeKind::Enum(index) = *self.an.types.base(ty) {
            let values = &self.an.types.enums[index as usize].values;
            let candidates: Vec<Symbol> = values.iter().map(|(name, _)| *name).collect();
            if let Some(close) = self.an.similar(name, candidates) {
                diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
            }
        }
        self.report(diagnostic);
        Operand::error(range)
    }

    fn find_enumerator(&self, ty: TypeId, name: Symbol, range: TextRange) -> Option<Operand> {
        let TypeKind::Enum(index) = *self.an.types.base(ty) else {
            return None;
        };
        let def = &self.an.types.enums[index as usize];
        let (_, value) = def.values.iter().find(|(known, _)| *known == name)?;
        let ty = self.an.types.strip(ty);
        Some(Operand::constant(Const::Int(*value), ty, range))
    }

    /// Whether the values of an enumeration are named with it alone.
    fn is_qualified(&self, ty: TypeId) -> bool {
        match self.an.types.base(ty) {
            TypeKind::Enum(index) => self.an.types.enums[*index as usize].qualified,
            _ => false,
        }
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

    /// `base[i, j]`, of arrays and strings.
    fn index(
        &mut self,
        base: st::Id<st::Expr>,
        indices: st::List<st::Id<st::Expr>>,
        range: TextRange,
    ) -> Operand {
        let mut at = self.place(base, None);
        if let TypeKind::Array {
            dimensions,
            element,
        } = self.an.types.base(at.ty)
            && (indices.len() < dimensions.len()
                || indices.len() > dimensions.len() && self.an.types.is_scalar(*element))
        {
            let (needed, given) = (dimensions.len(), indices.len());
            let message =
                format!("the array has {needed} dimensions but {given} subscripts are given");
            at = self.error(Message::E2004, range, message);
        }
        for &index in &self.arena()[indices] {
            if at.is_error() {
                // Mistakes in the other subscripts are still reported.
                self.expr(index, None);
                continue;
            }
            at = self.element(at, index, range);
        }
        Operand { range, ..at }
    }

    /// One element of an array, or one character of a string.
    fn element(&mut self, base: Operand, index: st::Id<st::Expr>, range: TextRange) -> Operand {
        let OperandKind::Place(place) = &base.kind else {
            let message = format!("{} has no elements", self.type_name(base.ty));
            return self.error(Message::E2031, base.range, message);
        };
        let (root, mut steps, rights) = (place.root, place.steps.clone(), place.rights);
        match self.an.types.base(base.ty).clone() {
            TypeKind::Array {
                dimensions,
                element,
            } => {
                let (first, inner) = dimensions.split_first().expect("at least one dimension");
                let Some(step) = self.subscript(index, *first) else {
                    return Operand::error(range);
                };
                steps.push(step);
                let ty = if inner.is_empty() {
                    element
                } else {
                    self.an.types.intern(TypeKind::Array {
                        dimensions: inner.into(),
                        element,
                    })
                };
                self.place_operand(root, steps, rights, ty, range)
            }
            TypeKind::Text { wide, length } => {
                let index_range = self.arena()[index].range;
                let operand = self.expr(index, None);
                if operand.is_error() || !self.integer_index(&operand) {
                    return Operand::error(range);
                }
                if let Some(Const::Int(value)) = operand.as_const()
                    && !(1..=i128::from(length)).contains(value)
                {
                    let message = format!("position {value} is not between 1 and {length}");
                    return self.error(Message::E2002, index_range, message);
                }
                let checked = self.unchecked();
                let value = self.raw(&operand);
                steps.push(PathStep::Character { value, checked });
                let el = if wide { El::Wchar } else { El::Char };
                self.place_operand(root, steps, rights, TypeId::of(el), range)
            }
            _ => {
                let message = format!("{} has no elements", self.type_name(base.ty));
                self.error(Message::E2031, base.range, message)
            }
        }
    }

    /// The step to an element.
    fn subscript(&mut self, index: st::Id<st::Expr>, (low, high): (i64, i64)) -> Option<PathStep> {
        let operand = self.expr(index, None);
        if operand.is_error() || !self.integer_index(&operand) {
            return None;
        }
        if let Some(Const::Int(value)) = operand.as_const() {
            let value = *value;
            if !(i128::from(low)..=i128::from(high)).contains(&value) {
                let message = format!("subscript {value} is not between {low} and {high}");
                self.error(Message::E2002, operand.range, message);
                return None;
            }
            return Some(PathStep::Index((value - i128::from(low)) as u32));
        }
        let inside = match self.an.types.base(operand.ty) {
            TypeKind::Subrange {
                low: first,
                high: last,
                ..
            } => i128::from(low) <= *first && *last <= i128::from(high),
            TypeKind::Elementary(el) if el.is_int() => {
                let (first, last) = el.range();
                i128::from(low) <= first && last <= i128::from(high)
            }
            _ => false,
        };
        let checked = inside || self.unchecked();
        let value = self.raw(&operand);
        Some(PathStep::IndexBy {
            value,
            low,
            checked,
        })
    }

    fn integer_index(&mut self, operand: &Operand) -> bool {
        let ty = operand.ty;
        if ty == TypeId::UNTYPED_INT || self.an.types.elementary(ty).is_some_and(El::is_int) {
            return true;
        }
        let message = format!("a subscript is an integer, not {}", self.type_name(ty));
        self.error(Message::E2032, operand.range, message);
        false
    }

    /// Whether the unit is library code that says its subscripts are right.
    fn unchecked(&self) -> bool {
        self.an.is_library(self.unit)
            && self
                .an
                .unit(self.unit)
                .pragmas
                .iter()
                .any(|p| p.text.contains("unchecked"))
    }

    /// `base.%B1`, `base.3`.
    fn part(&mut self, base: st::Id<st::Expr>, part: Part, range: TextRange) -> Operand {
        let base = self.place(base, None);
        if base.is_error() {
            return base;
        }
        let Some(el) = self.an.types.elementary(base.ty).filter(|el| {
            (el.is_bits() && *el != El::Bool) || (self.an.options.codesys && el.is_int())
        }) else {
            let message = format!("{} has no bits that have a name", self.type_name(base.ty));
            return self.error(Message::E2033, range, message);
        };
        let (count, ty) = match part.size {
            AddressSize::Bit => (1, El::Bool),
            AddressSize::Byte => (8, El::Byte),
            AddressSize::Word => (16, El::Word),
            AddressSize::DoubleWord => (32, El::Dword),
            AddressSize::LongWord => (64, El::Lword),
        };
        let first = u64::from(part.index) * u64::from(count);
        if first + u64::from(count) > u64::from(el.bits()) || count == el.bits() {
            let message = format!("{} has no such part", el.name());
            return self.error(Message::E2003, range, message);
        }
        match &base.kind {
            OperandKind::Place(place) => {
                let (root, mut steps, rights) = (place.root, place.steps.clone(), place.rights);
                steps.push(PathStep::Bits {
                    first: first as u32,
                    count,
                });
                self.place_operand(root, steps, rights, TypeId::of(ty), range)
            }
            OperandKind::Const(Const::Int(value)) => {
                let value = (value >> first) & ((1 << count) - 1);
                Operand::constant(Const::Int(value), TypeId::of(ty), range)
            }
            OperandKind::Value(value) => {
                let (value, storage) = (*value, el.storage());
                let by = self.add_const(first, crate::hir::Elementary::Udint, range);
                let kind = ExprKind::Binary(BinaryOp::ShiftRight, value, by);
                let value = self.add_expr(kind, storage, range);
                let kind = ExprKind::Convert(Conversion::Bits, value);
                let value = self.add_expr(kind, ty.storage(), range);
                Operand::value(value, TypeId::of(ty), range)
            }
            OperandKind::Const(_) | OperandKind::Error => Operand::error(range),
        }
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
        match *self.an.types.base(base.ty) {
            TypeKind::Reference(_, target) => self.follow(&base, target, range),
            _ => {
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
        if let TypeKind::Instance(pou) = *self.an.types.base(target) {
            self.an.complete(pou);
        }
        let address = self.raw(reference);
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
        _ => Rights::All,
    }
}

/// What others may do with a variable of an instance.
fn outside_rights(var: &Var) -> Rights {
    if var.constant {
        return Rights::Constant;
    }
    match var.section {
        SectionKind::Output => Rights::OtherOutput,
        _ => Rights::All,
    }
}
