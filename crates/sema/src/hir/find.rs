//! What paths lead to that users write outside of programs.

use super::written::{StepKind, heads, steps};
use crate::hir::{BASE, Place, Program, Step, TagId, Type};

/// The place a path names.
pub(crate) fn place(program: &Program, path: &str) -> Option<Place> {
    let path = path.trim();
    heads(path).find_map(|head| {
        let start = named(program, head)?;
        steps(path, head).try_fold(start, |place, step| follow(program, place, step.kind))
    })
}

fn named(program: &Program, name: &str) -> Option<Place> {
    let tags = &program.tags;
    let tag = tags
        .iter()
        .position(|tag| tag.name.eq_ignore_ascii_case(name));
    if let Some(index) = tag {
        return Some(Place::whole(TagId::from_index(index)));
    }
    let names = program.names.iter();
    let mut found = names.filter(|(other, _)| other.eq_ignore_ascii_case(name));
    found.next().map(|(_, place)| place.clone())
}

fn follow(program: &Program, place: Place, step: StepKind<'_>) -> Option<Place> {
    match step {
        StepKind::Member(name) => member(program, place, name),
        StepKind::Indices(list) => indexes(program, place, list),
        StepKind::Unclosed | StepKind::Stray(_) => None,
    }
}

fn indexes(program: &Program, place: Place, text: &str) -> Option<Place> {
    text.split(',').try_fold(place, |place, index| {
        let index: i64 = index.trim().parse().ok()?;
        match program.type_of(&place) {
            Type::Array(id) => {
                let array = program.types.array_def(id);
                let index = u32::try_from(index.checked_sub(array.low)?).ok()?;
                (index < array.len).then(|| place.step(Step::Index(index)))
            }
            Type::Struct(_) | Type::Elementary(_) => None,
        }
    })
}

fn member(program: &Program, place: Place, name: &str) -> Option<Place> {
    match program.type_of(&place) {
        Type::Struct(id) => {
            let def = program.types.struct_def(id);
            if let Some(index) = def.member(name) {
                return Some(place.step(Step::Field(index)));
            }
            // What is inherited lies in the part that is the base; chains of these are short.
            let base = def.members.first().filter(|first| first.hidden)?;
            let inherits = base.name == BASE;
            inherits.then(|| member(program, place.step(Step::Field(0)), name))?
        }
        Type::Elementary(ty) => {
            let bit: u32 = name.parse().ok()?;
            let exists = ty.is_integer() && bit < ty.bits();
            exists.then(|| place.step(Step::Bit(bit)))
        }
        Type::Array(_) => None,
    }
}
