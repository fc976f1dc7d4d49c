//! Counts of the benchmarks: instructions, operations, contenders.

mod contenders;
mod instructions;
mod rigid_trees;
