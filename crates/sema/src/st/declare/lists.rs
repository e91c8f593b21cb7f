//! Lists of global variables (CODESYS): `VAR_GLOBAL` outside of everything. A list has the name of its
//! file, and its variables are seen everywhere, as `x` or `List.x`; with the attribute
//! 'qualified_only' as `List.x` alone. A list is a namespace, so paths lead into it like into any other.

use crate::st::analysis::{Analysis, Namespace};
use crate::st::declare::QUALIFIED_ONLY;
use crate::st::signature::{Def, Global, GlobalId, NamespaceId, UnitId};
use iecc_ast::Symbol;
use iecc_ast::st::UnitKind;
use iecc_diag::{Code, Diagnostic};

impl Analysis<'_> {
    /// Declares the variables of all lists, when the other names are known.
    pub(crate) fn declare_lists(&mut self) {
        let mut made: Vec<NamespaceId> = Vec::new();
        for (unit, name) in std::mem::take(&mut self.lists) {
            let name = name.filter(|_| self.options.codesys);
            self.declare_list(unit, name, &mut made);
        }
    }

    fn declare_list(&mut self, unit: UnitId, name: Option<Symbol>, made: &mut Vec<NamespaceId>) {
        let UnitKind::Globals(section) = &self.unit(unit).kind else {
            return;
        };
        let namespace = self.units[unit.index()].namespace;
        let qualified = self.has_attribute(unit, section.range.start, QUALIFIED_ONLY);
        let list = name.and_then(|name| self.list(namespace, name, made));
        if qualified && list.is_none() {
            self.nameless_list(unit, name);
        }
        let first = self.globals.len() as u32;
        match list.filter(|_| qualified) {
            Some(list) => {
                self.units[unit.index()].namespace = list;
                self.declare_globals(unit, list, section);
            }
            None => {
                self.declare_globals(unit, namespace, section);
                for index in first..self.globals.len() as u32 {
                    self.also_in(list, GlobalId(index));
                }
            }
        }
        for global in &mut self.globals[first as usize..] {
            (global.list, global.qualified) = (list.and(name), list.is_some() && qualified);
        }
    }

    /// The namespace of a list; `None` if its name stands for something else.
    fn list(
        &mut self,
        parent: NamespaceId,
        name: Symbol,
        made: &mut Vec<NamespaceId>,
    ) -> Option<NamespaceId> {
        match self.lookup_in(parent, name).first() {
            Some(Def::Namespace(known)) if made.contains(known) => return Some(*known),
            Some(_) => return None,
            None => {}
        }
        let id = NamespaceId(self.namespaces.len() as u32);
        self.namespaces.push(Namespace {
            parent: Some(parent),
            name: Some(name),
            ..Namespace::default()
        });
        let defs = &mut self.namespaces[parent.index()].defs;
        defs.insert(name, vec![Def::Namespace(id)]);
        made.push(id);
        Some(id)
    }

    /// The variables of a list can be named without it, so there is one of each name.
    fn also_in(&mut self, list: Option<NamespaceId>, id: GlobalId) {
        let Some(list) = list else { return };
        let name = self.global(id).name;
        let defs = &mut self.namespaces[list.index()].defs;
        defs.entry(name).or_insert_with(|| vec![Def::Global(id)]);
    }

    fn nameless_list(&mut self, unit: UnitId, name: Option<Symbol>) {
        let UnitKind::Globals(section) = &self.unit(unit).kind else {
            return;
        };
        let span = self.span(unit, section.range);
        let message = "the variables of this list are named with it, and it has no name of its own";
        let note = match name {
            Some(name) => format!(
                "a list has the name of its file; `{}` stands for something else",
                self.text(name)
            ),
            None => "a list has the name of its file, which is no name here".to_owned(),
        };
        self.report(Diagnostic::new(Code::E8002, span, message).note(note));
    }

    /// What a global variable is called from outside of the program.
    pub(crate) fn global_name(&self, global: &Global) -> String {
        if let Some(path) = &global.path {
            return path.clone();
        }
        let own = self.text(global.name);
        match global.list.filter(|_| global.qualified) {
            Some(list) => format!("{}.{own}", self.text(list)),
            None => own.to_owned(),
        }
    }
}
