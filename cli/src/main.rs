//! The `eomgen` program.
fn main() {}
