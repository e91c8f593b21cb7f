//! Facts about the control flow of one function: predecessors and order ([`Cfg`]), dominators
//! ([`Dominators`]), loops ([`Loops`]); all without recursion, so deep graphs are harmless. And facts
//! about numbers: the form in which they are kept ([`Ranges`]), arithmetic on them ([`interval`]), and what follows
//! from the branches and loops of one function ([`LocalRanges`]). And in which order functions call one
//! another ([`callees_first`]).

mod calls;
mod cfg;
mod dominators;
pub mod interval;
mod local_ranges;
mod loops;
mod ranges;
mod trips;

pub use calls::callees_first;
pub use cfg::Cfg;
pub use dominators::Dominators;
pub use local_ranges::{Counted, LocalRanges, Trips};
pub use loops::{Loop, Loops};
pub use ranges::{Range, Ranges};
