//! What bodies in text become: typed programs written by hand, with results worked out by hand, on the
//! reference interpreter.

mod calls;
mod expressions;
mod hand;
mod initial;
mod loops;
mod places;
mod references;
mod statements;
mod tasks;
