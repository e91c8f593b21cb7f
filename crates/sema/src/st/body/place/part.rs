//! Parts of bit strings as ends of places: a part of a part is a part of the whole, and one of a value in
//! bytes lies at bytes of its own. So bits always end a place, and there is one step of them.

use crate::hir::Elementary;
use crate::hir::code::PathStep;
use crate::st::body::Place;

/// Goes on to `count` bits from `first` of what the steps lead to.
pub(crate) fn enter_bits(steps: &mut Vec<PathStep>, first: u32, count: u32) {
    match steps.last().copied() {
        Some(PathStep::Bits { first: outer, .. }) => {
            steps.pop();
            let first = outer + first;
            steps.push(PathStep::Bits { first, count });
        }
        Some(PathStep::Bytes { offset, .. }) => {
            steps.pop();
            enter_bytes(steps, offset + first / 8, first % 8, count);
        }
        Some(
            PathStep::Field(_)
            | PathStep::Index(_)
            | PathStep::IndexBy { .. }
            | PathStep::Character { .. },
        )
        | None => steps.push(PathStep::Bits { first, count }),
    }
}

/// What a place is, if it is no piece of memory of its own that something could refer to.
pub(crate) fn shared_bytes(place: &Place) -> Option<&'static str> {
    match place.steps.last()? {
        PathStep::Bits { .. } => Some("a part of a bit string"),
        PathStep::Bytes { .. } => Some("a value that shares its bytes with others"),
        PathStep::Field(_)
        | PathStep::Index(_)
        | PathStep::IndexBy { .. }
        | PathStep::Character { .. } => None,
    }
}

fn enter_bytes(steps: &mut Vec<PathStep>, offset: u32, bit: u32, count: u32) {
    let bytes = |ty| PathStep::Bytes { offset, ty };
    match count {
        1 => {
            steps.push(PathStep::Index(offset));
            steps.push(PathStep::Bits { first: bit, count });
        }
        8 => steps.push(PathStep::Index(offset)),
        16 => steps.push(bytes(Elementary::Uint)),
        32 => steps.push(bytes(Elementary::Udint)),
        _ => unreachable!("parts have 1, 8, 16 or 32 bits"),
    }
}
