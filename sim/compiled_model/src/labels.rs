//! Names, units and sizes for motions of a model and their messages.

use eomgen_codegen::encode_structures;

encode_structures! {
    Labels { state_names, state_units, typical_sizes, impacts, constraints, constraint_excess }
    ImpactLabel { name, unit, coordinates }
    ConstraintLabel { name, unit, is_nonholonomic }
}

/// Names, units and sizes of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Labels {
    pub state_names: Vec<String>,
    /// SI units of the states.
    pub state_units: Vec<String>,
    /// Typical sizes of the states, SI.
    pub typical_sizes: Vec<f64>,
    pub impacts: Vec<ImpactLabel>,
    pub constraints: Vec<ConstraintLabel>,
    /// Number of constraints that depend on others at every state.
    pub constraint_excess: usize,
}

/// Label of an impact.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ImpactLabel {
    pub name: String,
    /// Unit of the distance.
    pub unit: String,
    /// Indices of the coordinates with the dimension of the distance.
    pub coordinates: Vec<usize>,
}

/// Label of a constraint.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ConstraintLabel {
    pub name: String,
    /// Unit of the residual.
    pub unit: String,
    pub is_nonholonomic: bool,
}
