//! Other names for inputs and outputs, chosen by users.

use iecc_diag::{Code, Diagnostic, Diagnostics, closest};
use iecc_ir::{FieldDef, Module};
use iecc_source::Spanned;

/// Another name for an input or output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rename {
    /// The new name.
    pub name: Spanned<String>,
    /// The name it would have.
    pub point: Spanned<String>,
}

/// Gives inputs and outputs their new names; `None` after mistakes. All names are exchanged at once.
pub(crate) fn rename(
    module: &mut Module,
    renames: &[Rename],
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let mistakes = mistakes(module, renames);
    if !mistakes.is_empty() {
        diagnostics.append(mistakes);
        return None;
    }
    for region in [module.input, module.output] {
        for field in &mut module.types.structs[region].fields {
            let rename = renames.iter().find(|rename| is_point(rename, field));
            if let Some(rename) = rename {
                field.name.clone_from(&rename.name.node);
            }
        }
    }
    Some(())
}

fn is_point(rename: &Rename, field: &FieldDef) -> bool {
    field.name.eq_ignore_ascii_case(&rename.point.node)
}

fn points(module: &Module) -> impl Iterator<Item = &FieldDef> + Clone {
    let regions = [module.input, module.output].into_iter();
    regions.flat_map(|region| &module.types.structs[region].fields)
}

fn mistakes(module: &Module, renames: &[Rename]) -> Diagnostics {
    let mut found = Diagnostics::new();
    for (index, rename) in renames.iter().enumerate() {
        if !points(module).any(|field| is_point(rename, field)) {
            found.push(unknown(module, &rename.point));
        }
        let before = &renames[..index];
        let same = |a: &Spanned<String>, b: &Spanned<String>| a.node.eq_ignore_ascii_case(&b.node);
        if let Some(first) = before
            .iter()
            .find(|other| same(&other.point, &rename.point))
        {
            let message = format!("`{}` gets two names", rename.point.node);
            let twice = Diagnostic::new(Code::E6064, rename.point.span, message);
            found.push(twice.also(first.point.span, "the other is here"));
        }
        if let Some(first) = before.iter().find(|other| same(&other.name, &rename.name)) {
            let message = format!("`{}` is given to two points", rename.name.node);
            let twice = Diagnostic::new(Code::E6064, rename.name.span, message);
            found.push(twice.also(first.name.span, "the other is here"));
        } else if is_taken(module, renames, &rename.name.node) {
            let message = format!("`{}` is the name of something else", rename.name.node);
            found.push(Diagnostic::new(Code::E6064, rename.name.span, message));
        }
    }
    found
}

fn unknown(module: &Module, point: &Spanned<String>) -> Diagnostic {
    let message = format!("no input or output is named `{}`", point.node);
    let diagnostic = Diagnostic::new(Code::E6009, point.span, message);
    let known = points(module).map(|field| field.name.as_str());
    match closest(&point.node, known) {
        Some(name) => diagnostic.note(format!("did you mean `{name}`?")),
        None => diagnostic.note("`iecc run` shows the names of all as the columns of its trace"),
    }
}

/// Whether a name stands for a tag, or for a point that keeps its name.
fn is_taken(module: &Module, renames: &[Rename], name: &str) -> bool {
    let same = |other: &str| other.eq_ignore_ascii_case(name);
    let keeps = |field: &&FieldDef| !renames.iter().any(|rename| is_point(rename, field));
    let tags = &module.types.structs[module.state].fields;
    points(module).filter(keeps).any(|field| same(&field.name))
        || tags.iter().any(|field| same(&field.name))
        || module.names.iter().any(|(other, _)| same(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use iecc_ir::parse_module;
    use iecc_source::{FileId, Span};

    const MODULE: &str = "module m
state { motor: i1 }
input { a: i1, b: i1 }
output { c: i1 }
name Pump = state.motor
scan @s
fn @s[]() -> () {
b0:
  return
}
";

    fn renamed(names: &[(&str, &str)]) -> Result<Vec<String>, Vec<Code>> {
        let mut module = parse_module(MODULE).unwrap();
        let place = Span::point(FileId::from_index(0), 0);
        let spanned = |text: &str| Spanned::new(text.to_owned(), place);
        let renames = names.iter().map(|(name, point)| Rename {
            name: spanned(name),
            point: spanned(point),
        });
        let renames: Vec<Rename> = renames.collect();
        let mut found = Diagnostics::new();
        match rename(&mut module, &renames, &mut found) {
            Some(()) => Ok(points(&module).map(|field| field.name.clone()).collect()),
            None => Err(found.iter().map(|d| d.code).collect()),
        }
    }

    #[test]
    fn points_get_new_names_all_at_once() {
        let names = |list: [&str; 3]| Ok(list.map(str::to_owned).to_vec());
        assert_eq!(renamed(&[("Start", "A")]), names(["Start", "b", "c"]));
        assert_eq!(renamed(&[("a", "b"), ("b", "a")]), names(["b", "a", "c"]));
    }

    #[test]
    fn names_that_are_taken_and_points_that_are_not_there_are_refused() {
        for (names, code) in [
            (&[("x", "nothing")][..], Code::E6009),
            (&[("c", "a")], Code::E6064),
            (&[("MOTOR", "a")], Code::E6064),
            (&[("pump", "a")], Code::E6064),
            (&[("x", "a"), ("X", "b")], Code::E6064),
            (&[("x", "a"), ("y", "A")], Code::E6064),
        ] {
            assert_eq!(renamed(names), Err(vec![code]), "{names:?}");
        }
    }
}
