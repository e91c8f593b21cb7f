//! What the tests share: where outside data lies, a replayable random source, and mutators that
//! fuzz targets use as well.

pub mod check;
pub mod mutate;
pub mod rng;
pub mod rung_text;
pub mod shared;
