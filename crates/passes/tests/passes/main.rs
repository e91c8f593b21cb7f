//! Every pass on small modules, worked out by hand.

mod check;
mod inline;
