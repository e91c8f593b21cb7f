//! The block of memory that holds one controller: a header, the state region, and room for what a
//! fault must bring back and for locals. Machine code has no other memory, so whoever owns the block owns the
//! controller, and there may be any number of them.

use crate::plan::Plan;
use crate::writes::{Span, Writes};
use iecc_ir::{Image, Module};

/// Where things lie in a block, all of it known before compilation.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// Bytes of the state region.
    pub(crate) state_len: usize,
    /// What a scan may change, if a fault can abandon it; else nothing.
    pub(crate) saved: Vec<Span>,
    /// Bytes for locals that do not lie on the stack.
    local_bytes: usize,
    /// Bytes from the start of the state that may be read: a reference that is absent reads there.
    readable: usize,
}

/// Alignment of a block: that of its header, the strictest there is.
pub(crate) const ALIGNMENT: usize = 8;

impl Block {
    /// Time of the last scan without a fault, `u64`.
    pub(crate) const LAST_NS: i32 = 0;
    /// Instructions a scan may execute, about; `i64`.
    pub(crate) const WORK_LIMIT: i32 = 8;
    /// 1 after the first scan without a fault, `u32`.
    pub(crate) const STARTED: i32 = 16;
    /// After a fault: number of the origin plus 1, or 0 if it is unknown; `u32`.
    pub(crate) const FAULT_ORIGIN: i32 = 20;
    /// The state region.
    pub(crate) const STATE: usize = 24;

    pub(crate) fn new(module: &Module, plan: &Plan, writes: &Writes) -> Self {
        let bytes = |count: u64| usize::try_from(count).expect("verified programs are bounded");
        Self {
            state_len: module.image.bytes().len(),
            saved: match plan.facts(module.scan).can_fault {
                true => writes.spans(),
                false => Vec::new(),
            },
            local_bytes: bytes(plan.local_bytes),
            readable: bytes(plan.state_bytes),
        }
    }

    /// Where the first saved byte lies.
    pub(crate) fn saved_at(&self) -> usize {
        (Self::STATE + self.state_len).next_multiple_of(ALIGNMENT)
    }

    /// Bytes that are saved.
    pub(crate) fn saved_len(&self) -> usize {
        self.saved.iter().map(|span| span.len as usize).sum()
    }

    /// Where the locals lie: behind all that is read as state.
    pub(crate) fn locals_at(&self) -> usize {
        let saved_end = self.saved_at() + self.saved_len();
        let end = saved_end.max(Self::STATE + self.readable);
        end.next_multiple_of(ALIGNMENT)
    }

    /// Bytes of the whole block.
    pub(crate) fn len(&self) -> usize {
        (self.locals_at() + self.local_bytes).next_multiple_of(ALIGNMENT)
    }

    /// A block before the first scan.
    pub(crate) fn initial(&self, image: &Image, work_limit: i64) -> Vec<u8> {
        let mut bytes = vec![0; self.len()];
        bytes[Self::STATE..][..self.state_len].copy_from_slice(image.bytes());
        bytes[Self::WORK_LIMIT as usize..][..8].copy_from_slice(&work_limit.to_ne_bytes());
        bytes
    }
}
