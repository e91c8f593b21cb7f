//! What the IR cannot say yet.

use iecc_ir::{FunctionBuilder, MemType, Place, Root, Value};

/// The address of a place.
pub(super) fn address(_builder: &mut FunctionBuilder, _place: Place) -> Value {
    panic!("the IR has no addresses yet")
}

/// What lies at an address.
pub(super) fn deref(_value: Value, _ty: MemType) -> Root {
    panic!("the IR has no addresses yet")
}
