//! Hosts of emitted code and of the engine. In one binary they run in parallel: each waits for
//! compilers, installers, browsers or schedulers.

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
