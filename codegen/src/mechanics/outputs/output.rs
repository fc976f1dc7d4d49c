//! Outputs that can be requested in addition to rates, observables, energy, power, guards and mass matrix.

/// Function that is derived and emitted on request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Output {
    /// Bias forces c - f of M q'' + c = f.
    BiasForces,
    /// Inverse dynamics M a + c - f: the additional forces for given accelerations a.
    InverseDynamics,
    /// Time derivatives of the guards.
    GuardRates,
    /// Jacobians of rates and observables by state, inputs and parameters.
    Jacobians,
    /// Jacobians of rates and observables by state.
    StateJacobians,
    /// Jacobians of rates and observables by inputs.
    InputJacobians,
    /// Jacobians of rates and observables by parameters.
    ParameterJacobians,
    /// Products of the Jacobian of the rates with a direction (forward) and with weights (reverse).
    Products,
    /// Matrices A, B, C and D of a linearisation; includes the Jacobians.
    Linearisation,
    /// Number of the regime of a state, and a function that computes the rates in a given regime without comparisons.
    Regimes,
    /// Derivative of the rates with respect to time. It cannot be requested by name; external interfaces add it to the
    /// Jacobians.
    TimeDerivatives,
    /// Derivatives of rates and observables along a direction of state and inputs. It cannot be requested by name;
    /// linearisations evaluate it along every variable.
    Tangents,
    /// Jacobian of the gradient of the weighted rates by time, state, inputs and parameters, for optimisers.
    /// Includes the products.
    Hessians,
    /// Products and the Jacobians of observables, guards, impacts and constraints by state, inputs and parameters. It
    /// cannot be requested by name; gradients of trajectories evaluate it.
    TrajectoryGradients,
    /// One step of the classical Runge-Kutta method of order 4.
    Step,
    /// A second version of every function, `inlined_...`, for 8-wide SIMD. It is inlined into the calling code, which
    /// selects the instruction set at run time.
    Lanes,
}

impl Output {
    /// Outputs that can be requested by name.
    pub const ALL: [Self; 12] = [
        Self::BiasForces,
        Self::InverseDynamics,
        Self::GuardRates,
        Self::Jacobians,
        Self::StateJacobians,
        Self::InputJacobians,
        Self::ParameterJacobians,
        Self::Products,
        Self::Linearisation,
        Self::Regimes,
        Self::Step,
        Self::Lanes,
    ];

    /// Returns the name in requests.
    pub fn name(self) -> &'static str {
        match self {
            Self::BiasForces => "bias_forces",
            Self::InverseDynamics => "inverse_dynamics",
            Self::GuardRates => "guard_rates",
            Self::Jacobians => "jacobians",
            Self::StateJacobians => "jacobians:states",
            Self::InputJacobians => "jacobians:inputs",
            Self::ParameterJacobians => "jacobians:parameters",
            Self::Products => "products",
            Self::Linearisation => "linearisation",
            Self::Regimes => "regimes",
            Self::TimeDerivatives => "time_derivatives",
            Self::Tangents => "tangents",
            Self::Hessians => "hessians",
            Self::TrajectoryGradients => "trajectory_gradients",
            Self::Step => "step",
            Self::Lanes => "lanes",
        }
    }

    /// Returns true if this request includes the Jacobians by the variables of `suffix`: `state`, `inputs` or
    /// `parameters`.
    pub fn includes_jacobians_by(self, suffix: &str) -> bool {
        match self {
            Self::Jacobians | Self::Linearisation => true,
            Self::StateJacobians => suffix == "state",
            Self::InputJacobians => suffix == "inputs",
            Self::ParameterJacobians => suffix == "parameters",
            _ => false,
        }
    }

    /// Returns the names of all outputs, for messages.
    pub fn names() -> String {
        Self::ALL.map(Self::name).join(", ")
    }
}

/// Error for a name that is not an output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownOutput {
    /// Name in the request.
    pub name: String,
}

impl std::fmt::Display for UnknownOutput {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names = Output::names();
        write!(f, "unknown output `{}`; use one of {names}", self.name)
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
