//! Names of states and switching functions, for messages.

use eomgen_model_spec::argument::Argument;

/// Name of a switching function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Formula whose sign changes at the surface.
    pub formula: String,
    /// Kind of quantity that the formula computes.
    pub kind: SurfaceKind,
}

/// Quantity whose sign a switching surface depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// A function of the state.
    Function,
    /// A speed at which the system does not stick, as under dry friction with a solver that does not support
    /// it.
    Speed,
    /// A speed at which the system can stick.
    HeldSpeed,
    /// The distance of a contact.
    Distance,
}

/// Reason why a solver does not support sticking.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UnsupportedSticking {
    /// The model does not determine the holding force.
    #[default]
    Formula,
    /// The Adams method needs the preceding steps.
    Adams,
    /// The exact solver crosses the surface again and again.
    Exact,
}

/// Names of a system's states, coordinates first, and of its switching functions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Names<'a> {
    /// Names of the states, in their order.
    pub states: &'a [String],
    /// Names of the switching functions, in their order.
    pub surfaces: &'a [Surface],
    /// Reason why sticking is not supported.
    pub unsupported_sticking: UnsupportedSticking,
}

impl Names<'_> {
    /// Returns the name of a state.
    pub(crate) fn state_name(&self, index: usize) -> String {
        match self.states.get(index) {
            Some(name) => format!("`{name}`"),
            None => format!("state variable {index}"),
        }
    }

    /// Returns the condition on a switching surface.
    pub(crate) fn surface_condition(&self, index: usize) -> String {
        match self.surfaces.get(index) {
            Some(surface) => format!("`{}` is zero", surface.formula),
            None => format!("switching function {index} is zero"),
        }
    }

    /// Returns cause and remedy if a motion does not leave a surface, as far as the surface is known.
    pub(crate) fn sticking_reason(&self, index: usize) -> String {
        match self.surfaces.get(index).map(|surface| surface.kind) {
            Some(SurfaceKind::Speed) => {
                let (reason, cure) = match self.unsupported_sticking {
                    UnsupportedSticking::Adams => {
                        ("by the solver adams", "use the solver rk, or ".to_owned())
                    }
                    UnsupportedSticking::Exact => (
                        "by the exact solver here",
                        format!(
                            "use the general solver ({}), or ",
                            Argument::Solver.with_text("rk")
                        ),
                    ),
                    UnsupportedSticking::Formula => (
                        "for a speed with a jump, a piecewise function of the state or an exponent",
                        String::new(),
                    ),
                };
                format!("{STICKING_CAUSE} {reason}; {cure}{SMOOTH_LAW_REMEDY}")
            }
            Some(SurfaceKind::HeldSpeed) => format!("{RESTARTING_CAUSE}; {SMOOTH_LAW_REMEDY}"),
            Some(SurfaceKind::Function | SurfaceKind::Distance) => CHATTERING_CAUSE.to_owned(),
            None => "replace the jump by a steep smooth function".to_owned(),
        }
    }
}

/// Cause: sticking under dry friction.
const STICKING_CAUSE: &str =
    "it sticks, as a body at rest under dry friction, which is not supported";

/// Cause: sticking that begins and ends too often.
const RESTARTING_CAUSE: &str = "it comes to rest and starts again without end";

/// Remedy: a smooth friction law.
const SMOOTH_LAW_REMEDY: &str =
    "write a smooth law, such as tanh(v/v_0) with a small speed v_0 instead of sign(v)";

/// Cause: chattering at a force that jumps at a position.
const CHATTERING_CAUSE: &str = "it chatters, because the forces on both sides lead back to it. Replace the \
    jump by a continuous force over a small distance, such as a stiff spring";
