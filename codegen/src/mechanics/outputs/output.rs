//! What can be asked for beside rates, observables, energy, power, guards and mass matrix,
//! which are always there. How it is derived is in `derive`.

/// An output on request: a function that is derived and emitted where it is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Output {
    /// c - f of M q'' + c = f.
    BiasForces,
    /// M a + c - f for any accelerations a: the forces that are missing for them.
    InverseDynamics,
    /// Time derivatives of the guards.
    GuardRates,
    /// Jacobians of rates and observables by state, inputs and parameters.
    Jacobians,
    /// Products of the rates' Jacobian with a direction, and of weights with the Jacobian.
    Products,
    /// A, B, C and D about a point; brings the Jacobians with it.
    Linearisation,
    /// The number of a state's regime, and the rates in a regime with every branch decided.
    Regimes,
    /// The derivative of the rates by the time. Not asked for by name: it is the column that
    /// what calls from elsewhere misses in the Jacobians.
    TimeDerivatives,
    /// The Jacobian of the gradient of the weighted rates by time, state, inputs and parameters:
    /// the second derivatives that optimisers ask for. Brings the products with it.
    Hessians,
    /// Every function a second time as `inlined_...`, for lanes: to be compiled with the code
    /// around it for registers that are known at run time.
    Lanes,
}

impl Output {
    /// Every output that is emitted in every language.
    pub const ALL: [Self; 8] = [
        Self::BiasForces,
        Self::InverseDynamics,
        Self::GuardRates,
        Self::Jacobians,
        Self::Products,
        Self::Linearisation,
        Self::Regimes,
        Self::Lanes,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::BiasForces => "bias_forces",
            Self::InverseDynamics => "inverse_dynamics",
            Self::GuardRates => "guard_rates",
            Self::Jacobians => "jacobians",
            Self::Products => "products",
            Self::Linearisation => "linearisation",
            Self::Regimes => "regimes",
            Self::TimeDerivatives => "time_derivatives",
            Self::Hessians => "hessians",
            Self::Lanes => "lanes",
        }
    }

    /// The names of all, for messages.
    pub fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }
}

/// A name that is no output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownOutput {
    /// The name.
    pub name: String,
}

impl std::fmt::Display for UnknownOutput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names = Output::names();
        write!(f, "`{}` is not known; known are {names}", self.name)
    }
}

impl std::error::Error for UnknownOutput {}

impl std::str::FromStr for Output {
    type Err = UnknownOutput;

    fn from_str(name: &str) -> Result<Self, UnknownOutput> {
        let known = Self::ALL.into_iter().find(|output| output.name() == name);
        known.ok_or_else(|| UnknownOutput {
            name: name.to_owned(),
        })
    }
}
