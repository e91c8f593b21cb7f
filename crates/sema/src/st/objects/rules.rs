//! The rules of classes, blocks and interfaces: what may override what, what has to be there.

use crate::st::analysis::Analysis;
use crate::st::signature::{Part, PouId, Storage, Var};
use crate::st::types::TypeId;
use iecc_ast::Symbol;
use iecc_ast::st::{self, ModifierKind, PouKind, SectionKind, UnitKind};
use iecc_diag::{Code, Diagnostic};

impl Analysis<'_> {
    /// Checks a class, block or interface whose signature and methods are complete.
    pub(crate) fn check_inheritance(&mut self, id: PouId) {
        let pou = self.pou(id);
        if pou.part != Part::Whole || pou.receiver.is_some() {
            return;
        }
        match pou.kind {
            PouKind::Interface => self.check_interface(id),
            PouKind::Class | PouKind::FunctionBlock => self.check_class(id),
            PouKind::Function | PouKind::Program => self.check_plain(id),
        }
    }

    fn is(&self, id: PouId, modifier: ModifierKind) -> bool {
        self.pou(id).modifiers.contains(&modifier)
    }

    fn kind_word(&self, id: PouId) -> &'static str {
        match self.pou(id).kind {
            PouKind::Class => "class",
            PouKind::FunctionBlock => "block",
            PouKind::Interface => "interface",
            PouKind::Function => "function",
            PouKind::Program => "program",
        }
    }

    fn check_plain(&mut self, id: PouId) {
        let word = self.kind_word(id);
        self.check_members_of_function(id);
        for modifier in [ModifierKind::Abstract, ModifierKind::Final] {
            if self.is(id, modifier) {
                let span = self.pou(id).span;
                let message = format!("a {word} cannot be {}", modifier.as_str());
                self.error(Code::E1048, span, message);
            }
        }
    }

    /// A function has no instance that members could work on.
    fn check_members_of_function(&mut self, id: PouId) {
        if self.pou(id).kind != PouKind::Function {
            if !self.pou(id).members.is_empty() {
                self.check_properties(id);
            }
            return;
        }
        for (name, member) in self.pou(id).members.clone() {
            let (text, span) = (self.text(name), self.pou(member).span);
            let message = format!("`{text}` cannot belong to a function, which has no instances");
            self.error(Code::E1011, span, message);
        }
    }

    fn check_class(&mut self, id: PouId) {
        if self.is(id, ModifierKind::Abstract) && self.is(id, ModifierKind::Final) {
            self.contradiction(id);
        }
        if self.pou(id).kind == PouKind::Class {
            self.check_no_body(id);
        }
        self.check_variables(id);
        self.check_properties(id);
        for (name, method) in self.pou(id).members.clone() {
            self.check_method_of(id, name, method);
        }
        self.check_all_there(id);
    }

    fn contradiction(&mut self, id: PouId) {
        let span = self.pou(id).span;
        let message = "ABSTRACT and FINAL contradict: what is abstract has to be extended";
        self.error(Code::E1048, span, message);
    }

    fn check_no_body(&mut self, id: PouId) {
        let unit = self.unit(self.pou(id).unit);
        let UnitKind::Pou(written) = &unit.kind else {
            return;
        };
        if let Some(&first) = unit.arena[written.body].first() {
            let span = unit.span(unit.arena[first].range);
            let message = "a class has no statements of its own, only methods";
            self.error(Code::E1048, span, message);
        }
    }

    /// No variable has the name of a method or of anything that is inherited.
    fn check_variables(&mut self, id: PouId) {
        let base = self.base_of(id);
        let unit = self.pou(id).unit;
        for var in self.pou(id).vars.clone() {
            let span = self.span(unit, var.range);
            let own = self.pou(id).members.iter().find(|(n, _)| *n == var.name);
            if let Some((_, method)) = own {
                let first = self.pou(*method).span;
                self.declared_twice(var.name, first, span);
                continue;
            }
            let Some(base) = base else { continue };
            if let Some((of, index)) = self.instance_var(base, var.name) {
                let inherited = self.pou(of).vars[index].clone();
                let passed_on = inherited.section == SectionKind::InOut
                    && matches!(var.storage, Storage::Ref(_))
                    && var.range != inherited.range;
                if !passed_on || self.writes_in_out(id, var.name) {
                    let first = self.span(self.pou(of).unit, inherited.range);
                    if self.is_test(unit) {
                        self.declared_twice(var.name, span, first);
                        continue;
                    }
                    self.inherited_twice(var.name, span, first);
                }
            } else if let Some(method) = self.method(base, var.name) {
                let first = self.pou(method).span;
                self.inherited_twice(var.name, span, first);
            }
        }
    }

    /// Whether a unit itself declares an in-out with this name.
    fn writes_in_out(&self, id: PouId, name: Symbol) -> bool {
        let unit = self.unit(self.pou(id).unit);
        let UnitKind::Pou(written) = &unit.kind else {
            return false;
        };
        let sections = unit.arena[written.sections].iter();
        sections
            .filter_map(|section| match section.declarations {
                st::Declarations::Variables(variables) => Some(variables),
                st::Declarations::Accesses(_) | st::Declarations::Instances(_) => None,
            })
            .flat_map(|variables| unit.arena[variables].iter())
            .flat_map(|decl| unit.arena[decl.names].iter())
            .any(|ident| ident.name == name)
    }

    fn inherited_twice(&mut self, name: Symbol, span: iecc_source::Span, first: iecc_source::Span) {
        let message = format!("`{}` is inherited already", self.text(name));
        let diagnostic = Diagnostic::new(Code::E1049, span, message);
        self.report(diagnostic.also(first, "declared here"));
    }

    fn check_method_of(&mut self, id: PouId, name: Symbol, method: PouId) {
        self.check_twice(id, name, method);
        self.check_called_by_nobody(name, method);
        let (is_abstract, is_final) = (
            self.is(method, ModifierKind::Abstract),
            self.is(method, ModifierKind::Final),
        );
        let span = self.pou(method).span;
        let text = self.text(name);
        if is_abstract && is_final {
            self.contradiction(method);
        }
        if is_abstract && self.is(method, ModifierKind::Private) {
            let message = "PRIVATE and ABSTRACT contradict: nothing could override the method";
            self.error(Code::E1048, span, message);
        }
        if is_abstract && !self.is(id, ModifierKind::Abstract) {
            let message = format!("`{text}` is ABSTRACT, so its {} is too", self.kind_word(id));
            let note = format!("write {} ABSTRACT", self.pou(id).kind.as_str());
            self.report(Diagnostic::new(Code::E1047, span, message).note(note));
        }
        if is_abstract {
            self.check_no_statements(method);
        }
        self.check_override(id, name, method);
    }

    /// CODESYS calls some methods by itself.
    fn check_called_by_nobody(&mut self, name: Symbol, method: PouId) {
        let text = self.text(name);
        let special = ["FB_init", "FB_reinit", "FB_exit"];
        if !self.options.codesys || !special.iter().any(|word| word.eq_ignore_ascii_case(text)) {
            return;
        }
        let message = format!("`{text}` would be called by itself, which is not compiled");
        let note =
            "give variables initial values, and call a method of another name in the first scan";
        let diagnostic = Diagnostic::new(Code::E8002, self.pou(method).span, message);
        self.report(diagnostic.note(note));
    }

    fn check_twice(&mut self, id: PouId, name: Symbol, method: PouId) {
        let members = &self.pou(id).members;
        let first = members.iter().find(|(known, _)| *known == name);
        if let Some(&(_, first)) = first.filter(|(_, first)| *first != method) {
            let (span, first) = (self.pou(method).span, self.pou(first).span);
            self.declared_twice(name, span, first);
        }
    }

    /// A prototype has no statements.
    fn check_no_statements(&mut self, method: PouId) {
        let Some(body) = self.written_statements(method) else {
            return;
        };
        let unit = self.unit(self.pou(method).unit);
        if let Some(&first) = unit.arena[body].first() {
            let span = unit.span(unit.arena[first].range);
            let name = self.text(self.pou(method).name);
            let message = format!("`{name}` is a prototype, which has no statements");
            self.error(Code::E1048, span, message);
        }
    }

    fn check_override(&mut self, id: PouId, name: Symbol, method: PouId) {
        let overrides = self.is(method, ModifierKind::Override);
        let span = self.pou(method).span;
        let text = self.text(name);
        let Some(base) = self.base_of(id) else {
            if overrides {
                let message = format!("there is no `{text}` to override");
                self.error(Code::E1050, span, message);
            }
            return;
        };
        if let Some((of, index)) = self.instance_var(base, name) {
            let first = self.span(self.pou(of).unit, self.pou(of).vars[index].range);
            self.inherited_twice(name, span, first);
            return;
        }
        match self.method(base, name) {
            Some(other) => self.check_overridden(method, other, overrides),
            None if overrides => {
                let base = self.text(self.pou(base).name);
                let message = format!("`{base}` has no `{text}` to override");
                self.error(Code::E1050, span, message);
            }
            None => {}
        }
    }

    fn check_overridden(&mut self, method: PouId, other: PouId, overrides: bool) {
        let (span, first) = (self.pou(method).span, self.pou(other).span);
        let text = self.text(self.pou(method).name);
        let problem = if self.is(other, ModifierKind::Final) {
            let message = format!("`{text}` is FINAL in the base, so nothing can override it");
            Diagnostic::new(Code::E1045, span, message)
        } else if !overrides && !self.options.codesys {
            let message = format!("`{text}` is inherited; a method that replaces it says OVERRIDE");
            Diagnostic::new(Code::E1050, span, message).note("write METHOD … OVERRIDE")
        } else if self.access_word(method) != self.access_word(other) {
            let message = format!(
                "`{text}` is {} here but {} in the base",
                self.access_word(method),
                self.access_word(other)
            );
            Diagnostic::new(Code::E1051, span, message)
        } else if let Some(why) = self.difference(method, other) {
            let message = format!("`{text}` does not fit what it overrides: {why}");
            Diagnostic::new(Code::E1051, span, message)
        } else {
            return;
        };
        self.report(problem.also(first, "overridden here"));
    }

    fn access_word(&self, method: PouId) -> &'static str {
        let default = if self.options.codesys {
            ModifierKind::Public
        } else {
            ModifierKind::Protected
        };
        let mut modifiers = self.pou(method).modifiers.iter();
        let access = modifiers.find(|modifier| is_access(**modifier));
        access.copied().unwrap_or(default).as_str()
    }

    /// How the signatures of two methods differ, if they do.
    fn difference(&self, method: PouId, other: PouId) -> Option<String> {
        let (own, theirs) = (self.pou(method), self.pou(other));
        let result = |ty: Option<TypeId>| ty.map(|ty| self.types.strip(ty));
        if result(own.result) != result(theirs.result) {
            let name = |ty: Option<TypeId>| match ty {
                Some(ty) => format!("the result {}", self.type_name(ty)),
                None => "no result".to_owned(),
            };
            let (own, theirs) = (name(own.result), name(theirs.result));
            return Some(format!("it has {own} but {theirs} is needed"));
        }
        let (own, theirs) = (parameters(&own.vars), parameters(&theirs.vars));
        for (index, needed) in theirs.iter().enumerate() {
            let name = self.text(needed.name);
            let Some(given) = own.get(index) else {
                return Some(format!("parameter `{name}` is missing"));
            };
            if given.name != needed.name {
                let given = self.text(given.name);
                return Some(format!(
                    "parameter `{given}` stands where `{name}` is needed"
                ));
            }
            if given.section != needed.section {
                let (given, needed) = (given.section.as_str(), needed.section.as_str());
                return Some(format!("`{name}` is a {given} but a {needed} is needed"));
            }
            if self.types.strip(given.ty) != self.types.strip(needed.ty) {
                let (given, needed) = (self.type_name(given.ty), self.type_name(needed.ty));
                return Some(format!("`{name}` is a {given} but a {needed} is needed"));
            }
        }
        let extra = own.get(theirs.len())?;
        Some(format!(
            "parameter `{}` is one too many",
            self.text(extra.name)
        ))
    }

    /// Every prototype of the interfaces, and every abstract method unless the class is abstract,
    /// has a body.
    fn check_all_there(&mut self, id: PouId) {
        let mut names: Vec<(Symbol, PouId)> = Vec::new();
        for level in self.lineage(id) {
            for interface in self.pou(level).implements.clone() {
                for ancestor in self.with_ancestors(interface) {
                    names.extend(self.pou(ancestor).members.iter().copied());
                }
            }
        }
        let mut seen: Vec<Symbol> = Vec::new();
        for (name, prototype) in names {
            if !seen.contains(&name) {
                seen.push(name);
                self.check_implemented(id, name, prototype);
            }
        }
        if !self.is(id, ModifierKind::Abstract) {
            self.check_abstract_methods(id);
        }
    }

    fn check_implemented(&mut self, id: PouId, name: Symbol, prototype: PouId) {
        let text = self.text(name);
        let first = self.pou(prototype).span;
        let (own, span) = (self.text(self.pou(id).name), self.pou(id).span);
        let Some(method) = self.method(id, name) else {
            let interface = self.pou(prototype).owner.unwrap_or(prototype);
            let interface = self.text(self.pou(interface).name);
            let message = format!("`{own}` has no method `{text}`, which `{interface}` promises");
            let diagnostic = Diagnostic::new(Code::E1052, span, message);
            self.report(diagnostic.also(first, "promised here"));
            return;
        };
        // What is inherited is reported where it is not told already.
        let inherited = self.pou(method).owner != Some(id);
        let span = if inherited {
            span
        } else {
            self.pou(method).span
        };
        let problem = match (self.difference(method, prototype), self.access_word(method)) {
            (Some(why), _) => {
                let message = format!("`{text}` does not fit its prototype: {why}");
                Diagnostic::new(Code::E1051, span, message)
            }
            (None, access @ ("PRIVATE" | "PROTECTED")) => {
                let message =
                    format!("`{text}` is {access}, but a method of an interface is PUBLIC");
                Diagnostic::new(Code::E1051, span, message)
            }
            (None, _) => return,
        };
        self.report(problem.also(first, "promised here"));
    }

    fn check_abstract_methods(&mut self, id: PouId) {
        let mut seen: Vec<Symbol> = Vec::new();
        for level in self.lineage(id).into_iter().skip(1) {
            for (name, method) in self.pou(level).members.clone() {
                let runs = self.method(id, name) == Some(method);
                if !runs || !self.is(method, ModifierKind::Abstract) || seen.contains(&name) {
                    continue;
                }
                seen.push(name);
                let (own, text) = (self.text(self.pou(id).name), self.text(name));
                let message = format!("`{own}` does not override the abstract method `{text}`");
                let first = self.pou(method).span;
                let diagnostic = Diagnostic::new(Code::E1047, self.pou(id).span, message);
                let diagnostic = diagnostic.also(first, "abstract here");
                self.report(diagnostic.note("override it, or make this ABSTRACT too"));
            }
        }
    }

    fn check_interface(&mut self, id: PouId) {
        for modifier in [ModifierKind::Abstract, ModifierKind::Final] {
            if self.is(id, modifier) {
                let span = self.pou(id).span;
                let message = format!("an interface cannot be {}", modifier.as_str());
                self.error(Code::E1048, span, message);
            }
        }
        self.check_properties(id);
        for (name, method) in self.pou(id).members.clone() {
            self.check_twice(id, name, method);
            self.check_no_statements(method);
            self.check_prototype(method);
            for base in self.pou(id).extends.clone() {
                self.check_prototype_twice(base, name, method);
            }
        }
        self.check_bases_agree(id);
    }

    /// A prototype is public, and nothing else.
    fn check_prototype(&mut self, method: PouId) {
        let pou = self.pou(method);
        let Some(&modifier) = pou.modifiers.first() else {
            return;
        };
        let span = pou.span;
        let message = format!("a prototype of an interface has no {}", modifier.as_str());
        self.error(Code::E1048, span, message);
    }

    fn check_prototype_twice(&mut self, base: PouId, name: Symbol, method: PouId) {
        if let Some(other) = self.method(base, name) {
            let (span, first) = (self.pou(method).span, self.pou(other).span);
            self.inherited_twice(name, span, first);
        }
    }

    /// What several bases promise under one name must be the same.
    fn check_bases_agree(&mut self, id: PouId) {
        let mut known: Vec<(Symbol, PouId)> = Vec::new();
        for ancestor in self.with_ancestors(id).into_iter().skip(1) {
            for (name, method) in self.pou(ancestor).members.clone() {
                let Some(&(_, other)) = known.iter().find(|(n, _)| *n == name) else {
                    known.push((name, method));
                    continue;
                };
                if let Some(why) = self.difference(method, other) {
                    let text = self.text(name);
                    let message = format!("`{text}` is inherited twice and differs: {why}");
                    let span = self.pou(id).span;
                    let first = self.pou(other).span;
                    let diagnostic = Diagnostic::new(Code::E1049, span, message);
                    self.report(diagnostic.also(first, "one of them"));
                }
            }
        }
    }

    /// Reports a variable whose type has no instances, or that would be gone while something may
    /// still look at it. Gives the type that it counts as from there on.
    pub(crate) fn check_instance(&mut self, id: PouId, section: SectionKind, var: &Var) -> TypeId {
        if section == SectionKind::InOut || section == SectionKind::External {
            return var.ty;
        }
        let span = self.span(self.pou(id).unit, var.range);
        if let Some(of) = self.abstract_inside(var.ty) {
            let name = self.text(self.pou(of).name);
            let message = format!("`{name}` is ABSTRACT and has no instances");
            let diagnostic = Diagnostic::new(Code::E1046, span, message);
            self.report(diagnostic.also(self.pou(of).span, "declared here"));
            return TypeId::ERROR;
        }
        let kept = self.pou(id).has_instances() && section != SectionKind::Temp;
        if !kept && let Some(of) = self.numbered_inside(var.ty) {
            let name = self.text(self.pou(of).name);
            let message = format!(
                "an instance of `{name}` cannot live for one call only: references could outlive it"
            );
            let note = "declare it in VAR of a program, block or class, or pass it as VAR_IN_OUT";
            self.report(Diagnostic::new(Code::E1053, span, message).note(note));
            return TypeId::ERROR;
        }
        var.ty
    }

    /// The abstract class or block that a type holds an instance of, if any.
    fn abstract_inside(&self, ty: TypeId) -> Option<PouId> {
        self.instance_inside(ty, &|pou| {
            self.is(pou, ModifierKind::Abstract).then_some(pou)
        })
    }
}

/// What a call passes, in order.
fn parameters(vars: &[Var]) -> Vec<&Var> {
    let passed = vars.iter().filter(|var| var.section.direction().is_some());
    passed.collect()
}

fn is_access(modifier: ModifierKind) -> bool {
    matches!(
        modifier,
        ModifierKind::Public
            | ModifierKind::Protected
            | ModifierKind::Private
            | ModifierKind::Internal
    )
}
