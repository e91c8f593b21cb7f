//! Paths as users write them outside programs: in options and on the command line.

use crate::hir::{BASE, Place, Program, Step, TagId, Type};

/// The place a path names.
pub(crate) fn place(program: &Program, path: &str) -> Option<Place> {
    let path = path.trim();
    // Names may themselves contain dots, so each prefix that ends at a step is tried.
    let ends = path.match_indices(['.', '[']).map(|(index, _)| index);
    ends.chain([path.len()]).find_map(|end| {
        let start = named(program, &path[..end])?;
        follow(program, start, &path[end..])
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

fn follow(program: &Program, mut place: Place, mut rest: &str) -> Option<Place> {
    while !rest.is_empty() {
        let indexed = rest.starts_with('[');
        let body = &rest[1..];
        let end = if indexed {
            body.find(']')?
        } else {
            body.find(['.', '[']).unwrap_or(body.len())
        };
        place = if indexed {
            indexes(program, place, &body[..end])?
        } else {
            member(program, place, &body[..end])?
        };
        rest = &body[end + usize::from(indexed)..];
    }
    Some(place)
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
