//! What one scan hands to the functions of the program, and at which offsets they find it.
//!
//! The context lies on the stack of the entry (`entry.rs`), which fills it anew for each scan.
//! Functions of the program change the last two fields only.

/// Offsets of the fields; each takes eight bytes, and a number of 32 bits lies in the first four.
pub(crate) struct ScanContext;

impl ScanContext {
    /// Address of the input region.
    pub(crate) const INPUTS: i32 = 0;
    /// Address of the output region.
    pub(crate) const OUTPUTS: i32 = 8;
    /// Address of the memory for the locals that do not lie on the stack.
    pub(crate) const LOCALS: i32 = 16;
    /// The time of the scan.
    pub(crate) const NOW_NS: i32 = 24;
    /// The time of the scan before it, or its own in the first.
    pub(crate) const PREVIOUS_NS: i32 = 32;
    /// Instructions that metered functions may still execute, `i64`; below 0 the scan ends.
    pub(crate) const BUDGET: i32 = 40;
    /// After a fault: number of the origin plus 1, or 0 if it is unknown; `u32`.
    pub(crate) const FAULT_ORIGIN: i32 = 48;
    /// Bytes of all fields.
    pub(crate) const BYTES: u32 = 56;
}
