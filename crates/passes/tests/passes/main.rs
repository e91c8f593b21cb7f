//! Every pass on small modules, worked out by hand.

mod check;
mod cse;
mod dce;
mod fold;
mod inline;
mod size;
mod software;
