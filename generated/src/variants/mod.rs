//! Variants of the family `planetary_arm`, emitted by `eomgen family`. Do not edit: generate again.

#![allow(dead_code)]

#[rustfmt::skip]
pub mod planetary_arm_rigid;
#[rustfmt::skip]
pub mod planetary_arm_order_1;
#[rustfmt::skip]
pub mod planetary_arm_order_2;
#[rustfmt::skip]
pub mod planetary_arm_order_3;
#[rustfmt::skip]
pub mod planetary_arm_order_4;
#[rustfmt::skip]
pub mod planetary_arm_order_5;
#[rustfmt::skip]
pub mod planetary_arm_order_6;
#[rustfmt::skip]
pub mod planetary_arm_order_7;
#[rustfmt::skip]
pub mod planetary_arm_order_8;

/// Model of any order. Each variant implements it by a type such as `MODULE::Parameters`, so that one observer, one
/// solver or one test is generic over all variants. Numbers are in SI.
pub trait Model: Copy + Default {
    /// Names of the states, in their order.
    const STATE_NAMES: &'static [&'static str];
    /// Names of the inputs, in their order.
    const INPUT_NAMES: &'static [&'static str];
    /// Names of the parameters, in their order.
    const PARAMETER_NAMES: &'static [&'static str];
    /// Names of the observables, in their order.
    const OBSERVABLE_NAMES: &'static [&'static str];
    /// Number of degrees of freedom: coordinates and modes.
    const DEGREES_OF_FREEDOM: usize;
    /// Number of switching surfaces.
    const GUARDS: usize;
    /// State, or its rates.
    type State: Copy + AsRef<[f64]> + AsMut<[f64]>;
    /// Observables, in their order.
    type Observables: Copy + AsRef<[f64]>;
    /// Values of the switching functions.
    type Guards: Copy + AsRef<[f64]>;
    /// Inputs.
    type Inputs: Copy;
    /// Prepared coefficients.
    type Coefficients: Copy;
    /// Returns parameters with these values, in the order of `PARAMETER_NAMES`; missing values are 0.
    fn from_numbers(numbers: &[f64]) -> Self;
    /// Returns inputs with these values, in the order of `INPUT_NAMES`; missing values are 0.
    fn inputs(numbers: &[f64]) -> Self::Inputs;
    /// Returns the state with all entries 0.
    fn zero_state() -> Self::State;
    /// Prepares the coefficients; `None` if the mass matrix is not positive definite.
    fn prepare(&self) -> Option<Self::Coefficients>;
    /// Returns the rates of the state.
    fn rates(
        t: f64,
        state: &Self::State,
        inputs: &Self::Inputs,
        coefficients: &Self::Coefficients,
    ) -> Self::State;
    /// Returns the observables.
    fn observables(
        t: f64,
        state: &Self::State,
        inputs: &Self::Inputs,
        coefficients: &Self::Coefficients,
    ) -> Self::Observables;
    /// Returns the values of the switching functions.
    fn guards(
        t: f64,
        state: &Self::State,
        inputs: &Self::Inputs,
        coefficients: &Self::Coefficients,
    ) -> Self::Guards;
    /// Returns kinetic plus potential energy, in J.
    fn energy(
        t: f64,
        state: &Self::State,
        inputs: &Self::Inputs,
        coefficients: &Self::Coefficients,
    ) -> f64;
    /// Returns the power of all non-conservative forces, in W.
    fn power(
        t: f64,
        state: &Self::State,
        inputs: &Self::Inputs,
        coefficients: &Self::Coefficients,
    ) -> f64;
    /// Returns an entry of the mass matrix; `None` if an index is out of range.
    fn mass(
        t: f64,
        state: &Self::State,
        inputs: &Self::Inputs,
        coefficients: &Self::Coefficients,
        entry: (usize, usize),
    ) -> Option<f64>;
}

macro_rules! implement_model {
    ($module:ident) => {
        impl Model for $module::Parameters {
            const STATE_NAMES: &'static [&'static str] = &$module::STATE_NAMES;
            const INPUT_NAMES: &'static [&'static str] = &$module::INPUT_NAMES;
            const PARAMETER_NAMES: &'static [&'static str] = &$module::PARAMETER_NAMES;
            const OBSERVABLE_NAMES: &'static [&'static str] = &$module::OBSERVABLE_NAMES;
            const DEGREES_OF_FREEDOM: usize = $module::DEGREES_OF_FREEDOM;
            const GUARDS: usize = $module::GUARDS;
            type State = [f64; $module::STATES];
            type Observables = [f64; $module::OBSERVABLES];
            type Guards = [f64; $module::GUARDS];
            type Inputs = $module::Inputs;
            type Coefficients = $module::Coefficients;
            fn from_numbers(numbers: &[f64]) -> Self {
                let mut all = [0.0; $module::PARAMETERS];
                all.iter_mut()
                    .zip(numbers)
                    .for_each(|(own, number)| *own = *number);
                Self::from(all)
            }
            fn inputs(numbers: &[f64]) -> Self::Inputs {
                let mut all: [f64; $module::INPUTS] = [0.0; $module::INPUTS];
                all.iter_mut()
                    .zip(numbers)
                    .for_each(|(own, number)| *own = *number);
                $module::Inputs::from(all)
            }
            fn zero_state() -> Self::State {
                [0.0; $module::STATES]
            }
            fn prepare(&self) -> Option<Self::Coefficients> {
                let coefficients = $module::Coefficients::prepare(self);
                if coefficients.positive_definite {
                    Some(coefficients)
                } else {
                    None
                }
            }
            fn rates(
                t: f64,
                state: &Self::State,
                inputs: &Self::Inputs,
                coefficients: &Self::Coefficients,
            ) -> Self::State {
                $module::rates(t, state, inputs, coefficients)
            }
            fn observables(
                t: f64,
                state: &Self::State,
                inputs: &Self::Inputs,
                coefficients: &Self::Coefficients,
            ) -> Self::Observables {
                $module::observables(t, state, inputs, coefficients)
            }
            fn guards(
                t: f64,
                state: &Self::State,
                inputs: &Self::Inputs,
                coefficients: &Self::Coefficients,
            ) -> Self::Guards {
                $module::guards(t, state, inputs, coefficients)
            }
            fn energy(
                t: f64,
                state: &Self::State,
                inputs: &Self::Inputs,
                coefficients: &Self::Coefficients,
            ) -> f64 {
                $module::energy(t, state, inputs, coefficients)
            }
            fn power(
                t: f64,
                state: &Self::State,
                inputs: &Self::Inputs,
                coefficients: &Self::Coefficients,
            ) -> f64 {
                $module::power(t, state, inputs, coefficients)
            }
            fn mass(
                t: f64,
                state: &Self::State,
                inputs: &Self::Inputs,
                coefficients: &Self::Coefficients,
                (row, column): (usize, usize),
            ) -> Option<f64> {
                let matrix = $module::mass_matrix(t, state, inputs, coefficients);
                matrix.get(row).and_then(|row| row.get(column)).copied()
            }
        }
    };
}

implement_model!(planetary_arm_rigid);
implement_model!(planetary_arm_order_1);
implement_model!(planetary_arm_order_2);
implement_model!(planetary_arm_order_3);
implement_model!(planetary_arm_order_4);
implement_model!(planetary_arm_order_5);
implement_model!(planetary_arm_order_6);
implement_model!(planetary_arm_order_7);
implement_model!(planetary_arm_order_8);
