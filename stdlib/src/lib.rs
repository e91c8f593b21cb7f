//! The standard library: what timers, counters and the like do, as program text.
//!
//! Library code is ordinary code to every pass and back end. For now it is written in the text form
//! of the IR; a module here is linked function by function into the programs that use it.

/// A file of the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct File {
    /// Its path below `stdlib`.
    pub path: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// The instructions of Rockwell ladder that are library code.
pub const ROCKWELL: &[File] = &[
    File {
        path: "rockwell/timers.ir",
        text: include_str!("../rockwell/timers.ir"),
    },
    File {
        path: "rockwell/counters.ir",
        text: include_str!("../rockwell/counters.ir"),
    },
];
