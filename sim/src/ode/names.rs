//! What the numbers in an error stand for, in the words of the specification.

/// A switching function as people know it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// What changes its sign.
    pub formula: String,
    /// Whether it is a speed, as that of dry friction is.
    pub is_speed: bool,
}

/// Why a solver does not follow a motion that dry friction holds at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unfollowed {
    /// The model does not tell which force holds.
    #[default]
    Formula,
    /// The method of Adams goes on from the steps before.
    Adams,
    /// The model has impacts.
    Impacts,
}

/// The names of a system's state variables, coordinates first, and its switching functions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Names<'a> {
    /// In the order of the state.
    pub states: &'a [String],
    /// In the order of the switching functions.
    pub surfaces: &'a [Surface],
    /// Why a motion at rest is not followed.
    pub unfollowed: Unfollowed,
}

impl Names<'_> {
    /// A state variable, a coordinate or a rate.
    pub(crate) fn state(&self, index: usize) -> String {
        match self.states.get(index) {
            Some(name) => format!("`{name}`"),
            None => format!("state variable {index}"),
        }
    }

    /// Where a switching function vanishes.
    pub(crate) fn surface(&self, index: usize) -> String {
        match self.surfaces.get(index) {
            Some(surface) => format!("`{}` is zero", surface.formula),
            None => format!("switching function {index} is zero"),
        }
    }

    /// What to do where a motion does not leave a surface, as far as it is known what that is.
    pub(crate) fn held(&self, index: usize) -> String {
        match self.surfaces.get(index).map(|surface| surface.is_speed) {
            Some(true) => {
                let (reason, cure) = match self.unfollowed {
                    Unfollowed::Adams => ("the solver adams", "take the solver rk, or "),
                    Unfollowed::Impacts => ("a model with impacts", ""),
                    Unfollowed::Formula => {
                        ("a speed that holds piecewise functions or an exponent", "")
                    }
                };
                format!("{STICKS} {reason}; {cure}{SMOOTH}")
            }
            Some(false) => CHATTERS.to_owned(),
            None => "replace the jump there by a steep smooth function".to_owned(),
        }
    }
}

/// Dry friction and its like.
const STICKS: &str =
    "there it sticks, as dry friction holds a body at rest, which is not supported for";

/// The law to write instead.
const SMOOTH: &str = "write a smooth law, tanh(v/v_0) with a small speed v_0 in place of sign(v)";

/// A force that jumps at a place.
const CHATTERS: &str = "there it chatters, as the forces on both sides lead back to it. Let what \
    jumps there grow over a small distance instead, as a stiff spring does";
