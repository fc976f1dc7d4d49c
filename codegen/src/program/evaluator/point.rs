/// Time, state and inputs of a call.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Time in s.
    pub t: f64,
    /// State: coordinates, modes, the rates of both, first-order states.
    pub state: &'a [f64],
    /// Inputs in the order of the program.
    pub inputs: &'a [f64],
}
