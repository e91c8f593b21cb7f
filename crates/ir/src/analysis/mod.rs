//! Facts about the control flow of one function: predecessors and order ([`Cfg`]), dominators
//! ([`Dominators`]), loops ([`Loops`]); all without recursion, so deep graphs are harmless. And the
//! form in which facts about numbers are kept ([`Ranges`]).

mod cfg;
mod dominators;
mod loops;
mod ranges;

pub use cfg::Cfg;
pub use dominators::Dominators;
pub use loops::{Loop, Loops};
pub use ranges::{Range, Ranges};
