//! Tags and what their names stand for.
//!
//! Names are looked up in the program, then in the controller, then among the tags that modules
//! bring; case is ignored. Aliases are resolved when they are used, chain by chain without
//! recursion; a chain that comes back to itself is an error.

use super::Analysis;
use super::reference::parse_alias_target;
use super::types::{duplicate, fold};
use crate::hir::{self, Place, TagId};
use iecc_ast::Name;
use iecc_ast::logix::{ModuleTag, Tag, TagKind, Usage};
use iecc_ast::rung::Reference;
use iecc_diag::{Code, Diagnostic, closest};
use std::collections::{BTreeMap, BTreeSet};

/// Upper bound of all state together; far above any controller's memory.
const MAX_STATE_BYTES: u64 = 64 << 20;

/// What a name stands for.
#[derive(Debug, Clone)]
pub(crate) enum Symbol<'p> {
    /// Storage.
    Tag(TagId, &'p Tag),
    /// Another name, by position in the list of aliases.
    Alias(usize),
    /// Declared, but it cannot be used: the rest of a sentence says why.
    Unusable(String, &'p Name),
}

/// Another name for a place.
#[derive(Debug)]
pub(crate) struct Alias<'p> {
    pub(crate) tag: &'p Tag,
    /// The program it is declared in.
    pub(crate) program: Option<usize>,
    state: AliasState,
}

#[derive(Debug, Clone, PartialEq)]
enum AliasState {
    New,
    Open,
    /// `None` after an error, which was reported.
    Done(Option<Place>),
}

/// A tag that a module brings.
#[derive(Debug)]
pub(crate) struct ModuleSymbol<'p> {
    pub(crate) tag: &'p ModuleTag,
    /// The module's name, if it is inhibited.
    pub(crate) inhibited: Option<&'p Name>,
    /// Its storage, made on first use.
    pub(crate) storage: Option<Result<TagId, String>>,
}

/// All names.
#[derive(Debug, Default)]
pub(crate) struct Symbols<'p> {
    controller: BTreeMap<String, Symbol<'p>>,
    programs: Vec<BTreeMap<String, Symbol<'p>>>,
    pub(crate) aliases: Vec<Alias<'p>>,
    pub(crate) modules: BTreeMap<String, ModuleSymbol<'p>>,
    pub(crate) first_scan: Option<TagId>,
}

impl<'p> Symbols<'p> {
    fn scope(&mut self, program: Option<usize>) -> &mut BTreeMap<String, Symbol<'p>> {
        match program {
            Some(index) => &mut self.programs[index],
            None => &mut self.controller,
        }
    }

    /// The spelling of every name that can be used in a program, for suggestions.
    fn visible(&self, program: Option<usize>) -> Vec<&str> {
        let own = program.map(|index| &self.programs[index]);
        let scopes = own.into_iter().chain([&self.controller]);
        let tags = scopes.flat_map(|scope| scope.values().map(|symbol| self.spelling(symbol)));
        tags.chain(
            self.modules
                .values()
                .map(|module| module.tag.name.node.as_str()),
        )
        .collect()
    }

    fn spelling<'s>(&'s self, symbol: &'s Symbol<'p>) -> &'s str {
        match symbol {
            Symbol::Tag(_, tag) => &tag.name.node,
            Symbol::Alias(index) => &self.aliases[*index].tag.name.node,
            Symbol::Unusable(_, name) => &name.node,
        }
    }

    /// Whether the controller or any program declares a tag with this name.
    pub(crate) fn is_declared(&self, name: &str) -> bool {
        let name = fold(name);
        self.controller.contains_key(&name)
            || self.programs.iter().any(|scope| scope.contains_key(&name))
    }
}

impl<'p> Analysis<'p> {
    /// Declares every tag of the project.
    pub(crate) fn declare(&mut self) {
        let project = self.project;
        self.symbols.programs = vec![BTreeMap::new(); project.programs.len()];
        let shared = shared_names(project);
        for tag in &project.tags {
            self.declare_tag(tag, None, tag.name.node.clone());
        }
        for (index, program) in project.programs.iter().enumerate() {
            for tag in &program.tags {
                let name = if shared.contains(&fold(&tag.name.node)) {
                    format!("{}.{}", program.name.node, tag.name.node)
                } else {
                    tag.name.node.clone()
                };
                self.declare_tag(tag, Some(index), name);
            }
        }
        self.declare_modules();
        self.check_size();
    }

    fn declare_modules(&mut self) {
        let project = self.project;
        for module in &project.modules {
            for tag in &module.tags {
                let symbol = ModuleSymbol {
                    tag,
                    inhibited: module.inhibited.then_some(&module.name),
                    storage: None,
                };
                let symbols = &mut self.symbols.modules;
                symbols.entry(fold(&tag.name.node)).or_insert(symbol);
            }
        }
    }

    fn declare_tag(&mut self, tag: &'p Tag, program: Option<usize>, state_name: String) {
        let key = fold(&tag.name.node);
        if let Some(first) = self.symbols.scope(program).get(&key).cloned() {
            let first = self.declaration(&first);
            self.report(duplicate("tag", &tag.name, first));
            return;
        }
        let symbol = self.symbol(tag, program, state_name);
        self.symbols.scope(program).insert(key, symbol);
    }

    fn declaration(&self, symbol: &Symbol<'p>) -> &'p Name {
        match symbol {
            Symbol::Tag(_, tag) => &tag.name,
            Symbol::Alias(index) => &self.symbols.aliases[*index].tag.name,
            Symbol::Unusable(_, name) => name,
        }
    }

    fn symbol(&mut self, tag: &'p Tag, program: Option<usize>, name: String) -> Symbol<'p> {
        match tag.kind {
            TagKind::Alias(_) => {
                self.symbols.aliases.push(Alias {
                    tag,
                    program,
                    state: AliasState::New,
                });
                Symbol::Alias(self.symbols.aliases.len() - 1)
            }
            TagKind::Base | TagKind::Produced | TagKind::Consumed => {
                match self.storage_type(tag, program) {
                    Ok(ty) => Symbol::Tag(self.add_tag(tag, ty, name), tag),
                    Err(reason) => Symbol::Unusable(reason, &tag.name),
                }
            }
        }
    }

    fn storage_type(&mut self, tag: &Tag, program: Option<usize>) -> Result<hir::Type, String> {
        if tag.kind == TagKind::Consumed {
            return Err(
                "is consumed from another controller, which is not compiled yet".to_owned(),
            );
        }
        if tag.kind == TagKind::Produced {
            return Err("is produced for other controllers, which is not compiled yet".to_owned());
        }
        if program.is_some() && tag.usage == Usage::InOut {
            return Err("is an InOut parameter of a program, which is not compiled yet".to_owned());
        }
        if tag.safety {
            return Err("is a safety tag: safety logic is not compiled".to_owned());
        }
        match &tag.data_type {
            Some(name) => self.types.resolve(&name.node, &tag.dimensions),
            None => Err("has no data type in the file".to_owned()),
        }
    }

    fn add_tag(&mut self, tag: &Tag, ty: hir::Type, name: String) -> TagId {
        let before = std::mem::take(&mut self.diagnostics);
        let initial = self.initial_values(ty, &tag.initial, tag.constant);
        let found = std::mem::replace(&mut self.diagnostics, before);
        if !found.is_empty() {
            self.unread_values
                .insert(TagId::from_index(self.tags.len()), found);
        }
        if tag.initial.decorated.is_none() && tag.initial.l5k.is_none() {
            self.without_data.insert(TagId::from_index(self.tags.len()));
        }
        if tag.constant {
            self.constants.insert(TagId::from_index(self.tags.len()));
        }
        self.push_tag(hir::Tag {
            view: crate::hir::View::Number,
            init: None,
            name,
            ty,
            initial,
            span: Some(tag.name.span),
        })
    }

    pub(crate) fn push_tag(&mut self, tag: hir::Tag) -> TagId {
        self.tags.push(tag);
        TagId::from_index(self.tags.len() - 1)
    }

    fn check_size(&mut self) {
        let mut total = 0u64;
        for tag in &self.tags {
            total = total.saturating_add(self.types.bytes(tag.ty));
            if total > MAX_STATE_BYTES {
                let message = format!("the tags together are larger than {MAX_STATE_BYTES} bytes");
                let diagnostic = match tag.span {
                    Some(span) => Diagnostic::new(Code::E2007, span, message),
                    None => Diagnostic::without_place(Code::E2007, message),
                };
                self.diagnostics.push(diagnostic);
                self.tags.clear();
                return;
            }
        }
    }

    /// What the base name of a reference stands for; reports when it stands for nothing usable.
    pub(crate) fn base(&mut self, program: Option<usize>, reference: &Reference) -> Option<Base> {
        let key = fold(&reference.base.node);
        if let Some(other) = &reference.program {
            let index = self.program_named(other)?;
            let symbol = self.symbols.programs[index].get(&key).cloned();
            return match symbol {
                Some(symbol) => self.use_symbol(&symbol, &reference.base),
                None => self.unknown(Some(index), reference),
            };
        }
        let own = program.and_then(|index| self.symbols.programs[index].get(&key));
        let symbol = own.or_else(|| self.symbols.controller.get(&key)).cloned();
        if let Some(symbol) = symbol {
            return self.use_symbol(&symbol, &reference.base);
        }
        if self.symbols.modules.contains_key(&key) {
            return self.module_tag(&key, &reference.base).map(Base::Tag);
        }
        if let Some(flag) = key.strip_prefix("s:") {
            return self.system_flag(flag, &reference.base).map(Base::Tag);
        }
        self.unknown(program, reference)
    }

    fn program_named(&mut self, name: &Name) -> Option<usize> {
        let programs = &self.project.programs;
        let found = programs
            .iter()
            .position(|program| program.name.node.eq_ignore_ascii_case(&name.node));
        if found.is_none() {
            let message = format!("there is no program `{}`", name.node);
            let diagnostic = Diagnostic::new(Code::E1009, name.span, message);
            self.report_once(format!("program {}", fold(&name.node)), diagnostic);
        }
        found
    }

    fn use_symbol(&mut self, symbol: &Symbol<'p>, used: &Name) -> Option<Base> {
        match symbol {
            Symbol::Tag(id, _) => {
                if !self.silent
                    && let Some(found) = self.unread_values.remove(id)
                {
                    self.diagnostics.append(found);
                }
                Some(Base::Tag(*id))
            }
            Symbol::Alias(index) => Some(Base::Alias(*index)),
            Symbol::Unusable(reason, declared) => {
                let message = format!("`{}` {reason}", used.node);
                let diagnostic = Diagnostic::new(Code::E2010, used.span, message)
                    .also(declared.span, "the tag is declared here");
                self.report_once(format!("unusable {:?}", declared.span), diagnostic);
                None
            }
        }
    }

    fn unknown(&mut self, program: Option<usize>, reference: &Reference) -> Option<Base> {
        let name = &reference.base;
        let key = format!("unknown {program:?} {}", fold(&name.node));
        if self.reported.contains(&key) {
            return None;
        }
        let message = match program {
            Some(index) => format!(
                "there is no tag `{}` in program `{}` or in the controller",
                name.node, self.project.programs[index].name.node
            ),
            None => format!("there is no tag `{}` in the controller", name.node),
        };
        let mut diagnostic = Diagnostic::new(Code::E1001, name.span, message).label("not declared");
        if let Some(near) = closest(&name.node, self.symbols.visible(program)) {
            diagnostic = diagnostic.fix(format!("did you mean `{near}`?"), name.span, near);
        } else if name.node.contains(':') {
            diagnostic = diagnostic.note("no module of the file brings a tag with this name");
        }
        self.report_once(key, diagnostic);
        None
    }

    /// The bits that the controller keeps about itself. Of these only the first scan is compiled.
    fn system_flag(&mut self, flag: &str, used: &Name) -> Option<TagId> {
        if flag != "fs" {
            let message = format!("the status flag `{}` is not compiled yet", used.node);
            let diagnostic = Diagnostic::new(Code::E5029, used.span, message)
                .note("of the status flags, `S:FS` (first scan) is");
            self.report_once(format!("flag {flag}"), diagnostic);
            return None;
        }
        if self.symbols.first_scan.is_none() {
            let id = self.push_tag(hir::Tag {
                view: crate::hir::View::Number,
                init: None,
                name: "S:FS".to_owned(),
                ty: hir::Type::Elementary(hir::Elementary::Bool),
                initial: vec![(Vec::new(), 1)],
                span: None,
            });
            self.symbols.first_scan = Some(id);
        }
        self.symbols.first_scan
    }

    /// The place an alias stands for; `None` after an error, which is reported once.
    pub(crate) fn alias_place(&mut self, alias: usize) -> Option<Place> {
        let (mut chain, mut at): (Vec<(usize, Reference)>, usize) = (Vec::new(), alias);
        let mut place = loop {
            match self.symbols.aliases[at].state.clone() {
                AliasState::Done(place) => break place,
                AliasState::Open => {
                    self.alias_cycle(at, &chain);
                    break None;
                }
                AliasState::New => {}
            }
            self.symbols.aliases[at].state = AliasState::Open;
            let Some(target) = self.alias_target(at) else {
                self.symbols.aliases[at].state = self.alias_state(None);
                break None;
            };
            let base = self.base(self.symbols.aliases[at].program, &target);
            chain.push((at, target));
            match base {
                Some(Base::Alias(next)) => at = next,
                Some(Base::Tag(tag)) => break Some(Place::whole(tag)),
                None => break None,
            }
        };
        while let Some((alias, target)) = chain.pop() {
            place = place.and_then(|place| self.members(place, &target));
            self.symbols.aliases[alias].state = self.alias_state(place.clone());
        }
        place
    }

    /// What was not reported is not done.
    fn alias_state(&self, place: Option<Place>) -> AliasState {
        if self.silent && place.is_none() {
            AliasState::New
        } else {
            AliasState::Done(place)
        }
    }

    fn alias_target(&mut self, alias: usize) -> Option<Reference> {
        let tag = self.symbols.aliases[alias].tag;
        let TagKind::Alias(target) = &tag.kind else {
            unreachable!("only aliases are in the list")
        };
        let parsed = target.as_ref().and_then(parse_alias_target);
        if parsed.is_none() {
            let name = &tag.name;
            let (span, message) = match target {
                Some(target) => (
                    target.span,
                    format!(
                        "the alias `{}` stands for `{}`, which is not a tag or part of one",
                        name.node, target.node
                    ),
                ),
                None => (
                    name.span,
                    format!("the alias `{}` does not say what it stands for", name.node),
                ),
            };
            self.report(Diagnostic::new(Code::E1005, span, message));
        }
        parsed
    }

    fn alias_cycle(&mut self, at: usize, chain: &[(usize, Reference)]) {
        let start = chain.iter().position(|(alias, _)| *alias == at);
        let cycle = &chain[start.expect("an open alias is on the chain")..];
        let names: Vec<&str> = cycle
            .iter()
            .take(8)
            .map(|(alias, _)| self.symbols.aliases[*alias].tag.name.node.as_str())
            .collect();
        let message = format!(
            "the alias `{}` stands for itself: {} -> {}",
            names[0],
            names.join(" -> "),
            names[0]
        );
        let span = self.symbols.aliases[at].tag.name.span;
        let diagnostic = Diagnostic::new(Code::E1004, span, message)
            .note("let one of these aliases stand for a tag with storage");
        self.report(diagnostic);
    }

    /// The place of an alias that was resolved without error.
    pub(crate) fn resolved_alias(&self, alias: usize) -> Option<Place> {
        match &self.symbols.aliases[alias].state {
            AliasState::Done(place) => place.clone(),
            AliasState::New | AliasState::Open => None,
        }
    }

    /// All other names of places: aliases, and program tags by `Program.tag`.
    pub(crate) fn other_names(&self) -> Vec<(String, Place)> {
        let mut names: BTreeMap<String, (String, Place)> = BTreeMap::new();
        let mut add = |name: String, place: Place| {
            names.entry(fold(&name)).or_insert((name, place));
        };
        for alias in &self.symbols.aliases {
            if let AliasState::Done(Some(place)) = &alias.state {
                add(alias.tag.name.node.clone(), place.clone());
                if let Some(program) = alias.program {
                    let program = &self.project.programs[program].name.node;
                    add(format!("{program}.{}", alias.tag.name.node), place.clone());
                }
            }
        }
        for (index, scope) in self.symbols.programs.iter().enumerate() {
            let program = &self.project.programs[index].name.node;
            for symbol in scope.values() {
                if let Symbol::Tag(id, tag) = symbol {
                    add(format!("{program}.{}", tag.name.node), Place::whole(*id));
                }
            }
        }
        let taken: BTreeSet<String> = self.tags.iter().map(|tag| fold(&tag.name)).collect();
        names
            .into_iter()
            .filter(|(key, _)| !taken.contains(key) && !hides_member(key, &taken))
            .map(|(_, entry)| entry)
            .collect()
    }
}

/// Whether `a.b` would read as a member of a tag `a`.
fn hides_member(name: &str, tags: &BTreeSet<String>) -> bool {
    name.split_once('.')
        .is_some_and(|(base, _)| tags.contains(base))
}

/// Names that more than one scope declares, folded: storage is then named `Program.tag`.
fn shared_names(project: &iecc_ast::logix::Project) -> BTreeSet<String> {
    let controller = project.tags.iter().map(|tag| (None, tag));
    let programs = project
        .programs
        .iter()
        .enumerate()
        .flat_map(|(index, program)| program.tags.iter().map(move |tag| (Some(index), tag)));
    let mut first: BTreeMap<String, Option<usize>> = BTreeMap::new();
    let mut shared = BTreeSet::new();
    for (scope, tag) in controller.chain(programs) {
        let key = fold(&tag.name.node);
        if *first.entry(key.clone()).or_insert(scope) != scope {
            shared.insert(key);
        }
    }
    shared
}

/// What the first name of a reference stands for.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Base {
    /// Storage.
    Tag(TagId),
    /// An alias, by position.
    Alias(usize),
}
