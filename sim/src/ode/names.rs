//! What the numbers in an error stand for, in the words of the specification.

/// A switching function as people know it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// What changes its sign.
    pub formula: String,
    /// Whether it is a speed, as that of dry friction is.
    pub is_speed: bool,
}

/// The names of a system's state variables, coordinates first, and its switching functions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Names<'a> {
    /// In the order of the state.
    pub states: &'a [String],
    /// In the order of the switching functions.
    pub surfaces: &'a [Surface],
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
    pub(crate) fn held(&self, index: usize) -> &'static str {
        match self.surfaces.get(index).map(|surface| surface.is_speed) {
            Some(true) => STICKS,
            Some(false) => CHATTERS,
            None => "replace the jump there by a steep smooth function",
        }
    }
}

/// Dry friction and its like.
const STICKS: &str = "there it sticks, as dry friction holds a body at rest, which is not followed \
    here (by adams, with impacts, where the speed holds piecewise functions, and for exponents). \
    Take the solver rk in place of adams, else write a smooth law, tanh(v/v_0) with a small speed v_0 for sign(v)";

/// A force that jumps at a place.
const CHATTERS: &str = "there it chatters, as the forces on both sides lead back to it. Let what \
    jumps there grow over a small distance instead, as a stiff spring does";
