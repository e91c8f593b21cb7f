//! What a name without anything before it stands for: a variable of the unit, an enumerator, a global
//! variable, a program.

use crate::hir::code::{LocalId, Root};
use crate::st::body::{Body, Operand, Rights};
use crate::st::constant::Const;
use crate::st::signature::{Def, PouId, Storage};
use crate::st::types::TypeId;
use iecc_ast::Symbol;
use iecc_ast::st::PouKind;
use iecc_diag::{Code as Message, Diagnostic};
use iecc_source::TextRange;

impl Body<'_, '_> {
    /// What a name stands for.
    pub(super) fn name(&mut self, name: Symbol, range: TextRange, want: Option<TypeId>) -> Operand {
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
            && (!self.is_qualified(ty) || self.names_itself(ty, range))
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
            Some(def) if self.an.is_damaged(def) => Operand::error(range),
            Some(Def::Pou(_) | Def::Type(_)) if self.an.unit(self.unit).lost_names => {
                Operand::error(range)
            }
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
        if self.an.is_missing(name) || self.an.unit(self.unit).lost_names {
            return Operand::error(range);
        }
        let message = format!("no variable is named `{}`", self.text(name));
        let mut diagnostic = Diagnostic::new(Message::E1012, self.span(range), message);
        let mut candidates = self.an.visible(self.namespace);
        candidates.retain(|candidate| !self.is_library_unit(*candidate));
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
        } else if let Some(note) = word_from_elsewhere(self.text(name)) {
            diagnostic = diagnostic.note(note);
        } else if let Some(close) = self.an.similar(name, candidates) {
            diagnostic = diagnostic.note(format!("did you mean `{close}`?"));
        }
        self.report(diagnostic);
        Operand::error(range)
    }

    /// Whether a name is that of a function or block of the library, which is no variable.
    fn is_library_unit(&self, name: Symbol) -> bool {
        let defs = self.an.lookup(self.namespace, name);
        let library = |def: &Def| match def {
            Def::Pou(pou) => self.an.is_library(self.an.pou(*pou).unit),
            Def::Type(_) | Def::Global(_) | Def::Namespace(_) => false,
        };
        defs.first().is_some_and(library)
    }

    /// A variable of the unit, of what it belongs to, or of what that extends.
    fn own_name(&mut self, name: Symbol, range: TextRange) -> Option<Operand> {
        let pou = self.pou?;
        if !self.an.pou(pou).by_name.contains_key(&name) {
            self.an.constant_ahead(pou, name);
        }
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
        if var.ty == TypeId::ERROR {
            return Operand::error(range);
        }
        match &var.storage {
            Storage::Local => match self.local_of(index) {
                Some(local) => {
                    let rights = self.own_rights(&var);
                    self.place_operand(Root::Local(local), Vec::new(), rights, var.ty, range)
                }
                None => self.not_constant(range),
            },
            Storage::Ref(reference) => {
                let rights = self.own_rights(&var);
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

    pub(super) fn global_place(
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

    /// Whether the unit itself knows a name.
    pub(crate) fn own_symbol(&self, name: Symbol) -> bool {
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
}

/// What words of other languages are here.
fn word_from_elsewhere(name: &str) -> Option<&'static str> {
    const WORDS: [(&str, &str); 9] = [
        (
            "BREAK",
            "EXIT leaves a loop; the statements of a CASE end before the next label",
        ),
        (
            "DEFAULT",
            "what has no label of its own stands behind ELSE, without a colon",
        ),
        (
            "OTHERWISE",
            "what has no label of its own stands behind ELSE, without a colon",
        ),
        (
            "NEXT",
            "CONTINUE begins the next pass of a loop; END_FOR ends FOR",
        ),
        ("ENDIF", "a block ends with END_IF"),
        ("NIL", "a reference to nothing is NULL"),
        ("NONE", "a reference to nothing is NULL"),
        ("SELF", "the instance itself is THIS"),
        (
            "BEGIN",
            "statements stand between THEN, DO or ELSE and the END_ of their block",
        ),
    ];
    let known = WORDS
        .iter()
        .find(|(word, _)| name.eq_ignore_ascii_case(word));
    known.map(|(_, note)| *note)
}
