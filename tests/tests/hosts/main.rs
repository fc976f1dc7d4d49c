//! The hosts of emitted code and of the engine, one beside the other: each spends much of its time
//! waiting for compilers, installers, browsers and schedulers.

mod c99;
mod casadi;
mod fmi;
mod page;
mod python;
mod slurm;
