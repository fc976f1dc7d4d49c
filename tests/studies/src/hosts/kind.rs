//! Kinds of machines.

use eomgen_compiled_model::CompiledModel;

/// Kind of a machine: one row of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Smooth,
    Friction,
    PlaneFriction,
    Impacts,
    ContactFriction,
    Constraints,
    Jumps,
    InputFunction,
    Controller,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth or piecewise forces",
            Self::Friction => "dry friction that holds",
            Self::PlaneFriction => "dry friction in a plane",
            Self::Impacts => "impacts",
            Self::ContactFriction => "impacts with contact friction",
            Self::Constraints => "constraints, start violates them",
            Self::Jumps => "energies that jump",
            Self::InputFunction => "input as a function of time",
            Self::Controller => "sampled controllers",
        }
    }

    /// Returns the kind of a model.
    pub fn classify(model: &CompiledModel) -> Self {
        let known = model.model();
        let text = known.source.text.as_ref();
        if !known.controllers.is_empty() {
            Self::Controller
        } else if model.first_corner().is_some() {
            Self::Jumps
        } else if known.impacts.iter().any(|one| one.friction.is_some()) {
            Self::ContactFriction
        } else if text.contains("/norm(") {
            Self::PlaneFriction
        } else if !known.impacts.is_empty() {
            Self::Impacts
        } else if text.contains("sign(") {
            Self::Friction
        } else if !known.constraints.is_empty() {
            Self::Constraints
        } else {
            Self::Smooth
        }
    }
}
