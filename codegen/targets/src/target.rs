//! Languages and interfaces of emitted files.

/// Language or interface of emitted files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Rust, `no_std`, without dependencies: `lib.rs`.
    Rust,
    /// C99 that is also C++: `NAME.c` and `NAME.h`.
    C99,
    /// Device functions of CUDA C++: `NAME.cuh`.
    Cuda,
    /// External functions of CasADi: `NAME_casadi.c`.
    Casadi,
    /// Model for acados: `NAME_acados.py` with the functions of [`Target::Casadi`].
    Acados,
    /// Functional mock-up unit, FMI 2.0: `NAME.fmu`.
    Fmu2,
    /// Functional mock-up unit, FMI 3.0: `NAME.fmu`.
    Fmu3,
}

impl Target {
    /// Every target.
    pub const ALL: [Self; 7] = [
        Self::Rust,
        Self::C99,
        Self::Cuda,
        Self::Casadi,
        Self::Acados,
        Self::Fmu2,
        Self::Fmu3,
    ];

    /// Returns true if the files contain the functions for CasADi.
    pub fn has_casadi_functions(self) -> bool {
        matches!(self, Self::Casadi | Self::Acados)
    }

    /// Returns true for functional mock-up units.
    pub fn is_unit(self) -> bool {
        matches!(self, Self::Fmu2 | Self::Fmu3)
    }

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rust => "rust",
            Self::C99 => "c99",
            Self::Cuda => "cuda",
            Self::Casadi => "casadi",
            Self::Acados => "acados",
            Self::Fmu2 => "fmu2",
            Self::Fmu3 => "fmu3",
        }
    }
}
