//! The program `iecc`.

fn main() {}
