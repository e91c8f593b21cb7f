//! What the tests share: where outside data lies, a replayable random source, mutators that fuzz
//! targets use as well, file tests in the text form of the IR, and the comparison of engines.

pub mod cases;
pub mod check;
pub mod corpus;
pub mod damage;
pub mod differential;
pub mod examples;
pub mod filetest;
pub mod ladder;
pub mod leaves;
pub mod mutate;
pub mod one_block;
pub mod random_ir;
pub mod random_st;
pub mod rng;
pub mod rung_text;
pub mod runs;
pub mod shared;
pub mod st_run;
pub mod st_text;
pub mod stimulus;
pub mod tools;
