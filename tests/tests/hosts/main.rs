//! Tests of the hosts of emitted code and of the engine. They are in one binary to run in parallel, because each test
//! waits for compilers, installers, browsers or schedulers.

mod acados;
mod c99;
mod casadi;
mod cuda;
mod fmi;
mod mujoco;
mod page;
mod piecewise;
mod python;
mod slurm;
