//! Facts about the control flow of one function: predecessors and order ([`Cfg`]), dominators
//! ([`Dominators`]), loops ([`Loops`]); all without recursion, so deep graphs are harmless. And facts
//! about numbers: the form in which they are kept ([`Ranges`]), arithmetic on them ([`interval`]), and what follows
//! from the branches and loops of one function ([`LocalRanges`]).

mod cfg;
mod dominators;
pub mod interval;
mod local_ranges;
mod loops;
mod ranges;
mod trips;

pub use cfg::Cfg;
pub use dominators::Dominators;
pub use local_ranges::{Counted, LocalRanges, Trips};
pub use loops::{Loop, Loops};
pub use ranges::{Range, Ranges};
