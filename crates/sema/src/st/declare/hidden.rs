//! Names that no source spells: accessors of properties are methods `Name.GET` and `Name.SET`, and
//! what a method keeps in its instance (VAR_INST) is a variable `Method.name` of the block. With the dot
//! they are no names a user could write, and read well in messages.

use crate::st::analysis::Analysis;
use crate::st::signature::PouId;
use iecc_ast::st::{Declarations, File, List, Member, SectionKind, Unit, UnitKind, VarSection};
use iecc_ast::{Names, Symbol};

/// The accessors of a property that a class, block or interface has or inherits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Property {
    /// Reading.
    pub get: Option<PouId>,
    /// Writing.
    pub set: Option<PouId>,
}

/// The names of the accessors of properties with one name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Accessors {
    pub get: Symbol,
    pub set: Symbol,
}

/// Gives the hidden names of the members in some files their symbols. To be called before the
/// analysis, which cannot add names.
pub fn intern_hidden(names: &mut Names, files: &[File]) {
    for unit in files.iter().flat_map(|file| &file.units) {
        let UnitKind::Pou(pou) = &unit.kind else {
            continue;
        };
        for member in &unit.arena[pou.members] {
            let own = names.text(member.name().name).to_owned();
            match member {
                Member::Method(method) => intern_kept(names, unit, method.sections, &own),
                Member::Property(property) => {
                    for (word, accessor) in [("GET", property.get), ("SET", property.set)] {
                        let own = format!("{own}.{word}");
                        names.intern(&own);
                        if let Some(accessor) = accessor {
                            intern_kept(names, unit, accessor.sections, &own);
                        }
                    }
                }
                Member::Action(_) => {}
            }
        }
    }
}

fn intern_kept(names: &mut Names, unit: &Unit, sections: List<VarSection>, own: &str) {
    for section in &unit.arena[sections] {
        let (SectionKind::Instance, Declarations::Variables(variables)) =
            (section.kind, section.declarations)
        else {
            continue;
        };
        for ident in unit.arena[variables]
            .iter()
            .flat_map(|decl| &unit.arena[decl.names])
        {
            let name = format!("{own}.{}", names.text(ident.name));
            names.intern(&name);
        }
    }
}

impl Analysis<'_> {
    /// The name of a part of something.
    pub(crate) fn hidden_name(&self, of: Symbol, part: &str) -> Symbol {
        let name = format!("{}.{part}", self.text(of));
        self.names
            .find(&name)
            .expect("hidden names are entered first")
    }

    /// The property with a name, its own or inherited.
    pub(crate) fn property(&self, of: PouId, name: Symbol) -> Option<Property> {
        let accessors = self.accessors.get(&name)?;
        let found = Property {
            get: self.method(of, accessors.get),
            set: self.method(of, accessors.set),
        };
        (found.get.is_some() || found.set.is_some()).then_some(found)
    }
}
