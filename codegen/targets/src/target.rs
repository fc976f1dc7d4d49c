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
    /// Functional mock-up unit, FMI 2.0: `NAME.fmu`.
    Fmu2,
    /// Functional mock-up unit, FMI 3.0: `NAME.fmu`.
    Fmu3,
}

impl Target {
    /// Every target.
    pub const ALL: [Self; 6] = [
        Self::Rust,
        Self::C99,
        Self::Cuda,
        Self::Casadi,
        Self::Fmu2,
        Self::Fmu3,
    ];

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
            Self::Fmu2 => "fmu2",
            Self::Fmu3 => "fmu3",
        }
    }
}
