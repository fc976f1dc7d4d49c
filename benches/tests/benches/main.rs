//! Tests of the benchmarks: instruction counts, operation counts, agreement of contenders.

mod contenders;
mod instructions;
mod rigid_trees;
