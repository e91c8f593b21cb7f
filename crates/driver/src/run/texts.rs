//! Strings: structures of a length and characters, which people see as one value.

use super::names::type_of;
use iecc_ir::{Index, MemType, Module, Place, PlaceType, Projection, Type};

/// Members of a string, in their order.
const STRING_MEMBERS: [&str; 2] = ["LEN", "DATA"];

/// What a place holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One value.
    Scalar(Type),
    /// A string: its length, then so many characters.
    Text {
        /// Type of the characters.
        character: Type,
        /// How many it can hold.
        capacity: usize,
    },
}

/// What a place holds, if that is a value or a string.
pub(super) fn shape(module: &Module, place: &Place) -> Option<Shape> {
    let ty = type_of(module, place)?;
    if let Some(scalar) = ty.scalar() {
        return Some(Shape::Scalar(scalar));
    }
    let PlaceType::Mem(MemType::Struct(id)) = ty else {
        return None;
    };
    let fields = &module.types.structs[id].fields;
    let named = fields
        .iter()
        .map(|field| field.name.as_str())
        .eq(STRING_MEMBERS);
    let MemType::Array(data) = fields.get(1)?.ty else {
        return None;
    };
    let data = module.types.array_type(data);
    let MemType::Scalar(character) = data.element else {
        return None;
    };
    let capacity = data.len as usize;
    named.then_some(Shape::Text {
        character,
        capacity,
    })
}

/// If the first place is the length of a string and all its characters follow: how many.
pub(super) fn characters_behind(module: &Module, places: &[Place]) -> usize {
    let Some((length, behind)) = places.split_first() else {
        return 0;
    };
    let Some((Projection::Field(0), path)) = length.path.split_last() else {
        return 0;
    };
    let string = Place {
        root: length.root,
        path: path.to_vec(),
    };
    let Some(Shape::Text { capacity, .. }) = shape(module, &string) else {
        return 0;
    };
    let is_character = |(index, place): (u32, &Place)| {
        let end = [Projection::Field(1), Projection::Index(Index::Const(index))];
        place.root == string.root && place.path.strip_prefix(path) == Some(end.as_slice())
    };
    let mut characters = (0..).zip(behind.iter().take(capacity));
    if behind.len() >= capacity && characters.all(is_character) {
        capacity
    } else {
        0
    }
}
