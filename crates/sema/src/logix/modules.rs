//! Tags that modules bring, typed from their data in the export.
//!
//! Storage is made on first use, so what no program names costs nothing. The BOOL members that
//! some modules show for bits of a word are leaves of their own, as the export lists them.

use super::{Analysis, Init};
use crate::hir::{self, Elementary, MemberDef, TagId, Type};
use iecc_ast::logix::{ModuleTag, ModuleTagDirection};
use iecc_ast::{Name, Value, ValueKind};
use iecc_diag::{Code, Diagnostic};

impl<'p> Analysis<'p> {
    /// The storage of a module's tag; reports once when there can be none.
    pub(crate) fn module_tag(&mut self, key: &str, used: &Name) -> Option<TagId> {
        let symbol = &self.symbols.modules[key];
        let tag = symbol.tag;
        if let Some(module) = symbol.inhibited {
            let message = format!(
                "the module `{}` is inhibited; it is compiled as if it were not",
                module.node
            );
            let diagnostic =
                Diagnostic::new(Code::E6031, module.span, message).also(used.span, "used here");
            self.report_once(format!("inhibited {key}"), diagnostic);
        }
        let symbol = &self.symbols.modules[key];
        let storage = match symbol.storage.clone() {
            Some(storage) => storage,
            None => {
                let storage = self.make_module_tag(tag);
                let symbol = self.symbols.modules.get_mut(key).expect("just read");
                symbol.storage = Some(storage.clone());
                storage
            }
        };
        match storage {
            Ok(id) => Some(id),
            Err(reason) => {
                let message = format!("`{}` {reason}", used.node);
                let diagnostic = Diagnostic::new(Code::E6024, used.span, message)
                    .also(tag.span, "the module's tag is defined here");
                self.report_once(format!("module {key}"), diagnostic);
                None
            }
        }
    }

    fn make_module_tag(&mut self, tag: &'p ModuleTag) -> Result<TagId, String> {
        if tag.rack_alias {
            return Err(
                "is a part of its rack adapter's tag, which is not compiled yet".to_owned(),
            );
        }
        let Some(value) = &tag.initial.decorated else {
            return Err("has no decorated data in the export that would give its type".to_owned());
        };
        let ty = self.module_type(value)?;
        let constant = tag.direction == ModuleTagDirection::Configuration;
        let initial = if constant || self.options.init == Init::Export {
            self.initial_values(ty, &tag.initial, constant)
        } else {
            Vec::new()
        };
        Ok(self.push_tag(hir::Tag {
            view: crate::hir::View::Number,
            init: None,
            name: tag.name.node.clone(),
            ty,
            initial,
            span: Some(tag.span),
        }))
    }

    /// Recursion is bounded by the reader's bound on the depth of data.
    fn module_type(&mut self, value: &Value) -> Result<Type, String> {
        match &value.kind {
            ValueKind::Scalar(_) => Elementary::parse(&value.data_type)
                .map(Type::Elementary)
                .ok_or_else(|| {
                    format!(
                        "contains the type `{}`, which is not compiled yet",
                        value.data_type
                    )
                }),
            ValueKind::Struct(members) => {
                let predefined = self.types.resolve(&value.data_type, &[]);
                if let Ok(ty @ Type::Struct(_)) = predefined {
                    return Ok(ty);
                }
                let mut defs: Vec<MemberDef> = Vec::with_capacity(members.len());
                for (name, member) in members {
                    let ty = self.module_type(member)?;
                    if !defs
                        .iter()
                        .any(|def| def.name.eq_ignore_ascii_case(&name.node))
                    {
                        defs.push(MemberDef {
                            view: crate::hir::View::Number,
                            name: name.node.clone(),
                            ty,
                            hidden: false,
                        });
                    }
                }
                self.types.module_struct(&value.data_type, defs)
            }
            ValueKind::Array {
                dimensions,
                elements,
            } => {
                let element = match elements.first() {
                    Some((
                        _,
                        Value {
                            kind: ValueKind::Struct(_),
                            ..
                        },
                    )) => self.module_type(&elements[0].1)?,
                    Some(_) | None => self.types.resolve(&value.data_type, &[])?,
                };
                self.types.array_of(element, dimensions)
            }
        }
    }
}

/// The module tag that a storage mirrors, if it does.
impl<'p> Analysis<'p> {
    pub(crate) fn module_of(&self, id: TagId) -> Option<&'p ModuleTag> {
        self.symbols
            .modules
            .values()
            .find(|symbol| symbol.storage == Some(Ok(id)))
            .map(|symbol| symbol.tag)
    }

    /// Refuses a write to a constant, and to a module's configuration, which would have to reach the
    /// module.
    pub(crate) fn check_write(&mut self, place: &hir::Place, span: iecc_source::Span) {
        if self.constants.contains(&place.tag) {
            let name = self.display(place);
            let message = format!("`{name}` is a constant and cannot be changed by the program");
            let mut diagnostic = Diagnostic::new(Code::E2006, span, message);
            if let Some(declared) = self.tags[place.tag.index()].span {
                diagnostic = diagnostic.also(declared, "declared as a constant here");
            }
            self.report(diagnostic);
            return;
        }
        let Some(module) = self.module_of(place.tag) else {
            return;
        };
        if module.direction == ModuleTagDirection::Configuration {
            let name = self.display(place);
            let message =
                format!("`{name}` configures a module and cannot be changed by the program");
            self.report(Diagnostic::new(Code::E6025, span, message));
        }
    }
}
