//! What one scan hands to machine code, and at which offsets the code finds it.

use std::mem::offset_of;

/// Filled anew for each scan. Machine code reads all but the last two fields, which it also
/// changes.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct ScanContext {
    /// The input region.
    pub(crate) inputs: *const u8,
    /// The output region.
    pub(crate) outputs: *mut u8,
    /// Memory for the locals that do not lie on the stack.
    pub(crate) locals: *mut u8,
    /// The time of the scan.
    pub(crate) now_ns: u64,
    /// The time of the scan before it, or its own in the first.
    pub(crate) previous_ns: u64,
    /// Instructions that metered functions may still execute; below 0 the scan ends.
    pub(crate) budget: i64,
    /// After a fault: number of the origin plus 1, or 0 if it is unknown.
    pub(crate) fault_origin: u32,
}

impl ScanContext {
    pub(crate) const INPUTS: i32 = offset_of!(ScanContext, inputs) as i32;
    pub(crate) const OUTPUTS: i32 = offset_of!(ScanContext, outputs) as i32;
    pub(crate) const LOCALS: i32 = offset_of!(ScanContext, locals) as i32;
    pub(crate) const NOW_NS: i32 = offset_of!(ScanContext, now_ns) as i32;
    pub(crate) const PREVIOUS_NS: i32 = offset_of!(ScanContext, previous_ns) as i32;
    pub(crate) const BUDGET: i32 = offset_of!(ScanContext, budget) as i32;
    pub(crate) const FAULT_ORIGIN: i32 = offset_of!(ScanContext, fault_origin) as i32;
}
