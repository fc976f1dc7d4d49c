//! What a program is called at.

/// What a call is made at.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Time, in s.
    pub t: f64,
    /// State: coordinates, modes, and the rates of both.
    pub state: &'a [f64],
    /// Inputs in the order of the program.
    pub inputs: &'a [f64],
}
