//! Comparison of requested outputs with independent computations: emitted functions evaluated with dual numbers, and
//! identities of the equations.

#![allow(
    clippy::reversed_empty_ranges,
    reason = "models without inputs have loops over none"
)]

mod dual;
mod evaluators;
mod lanes;
mod models;
mod rounded;
mod tracked;

use dual::Dual;
use eomgen_codegen::program::evaluator::Point as EvaluatorPoint;
use proptest::prelude::*;
use tracked::Tracked;

/// Source of random numbers with magnitudes between 1e-5 and 1.
struct NumberSource<'a> {
    numbers: &'a [f64],
    next: usize,
}

impl NumberSource<'_> {
    /// Returns the next number, uniform from -1 to 1.
    fn even(&mut self) -> f64 {
        self.next += 1;
        self.numbers[(self.next - 1) % self.numbers.len()]
    }

    fn number(&mut self) -> f64 {
        let exponent = 2.5 * (self.even() - 1.0);
        self.even() * 10_f64.powf(exponent)
    }

    fn array<const N: usize>(&mut self) -> [f64; N] {
        std::array::from_fn(|_| self.number())
    }
}

/// Returns more random numbers than any of the models needs.
fn numbers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0_f64, 331)
}

type TrackedDual = Dual<Tracked>;

fn dual_number(value: f64, slope: f64) -> TrackedDual {
    Dual {
        value: Tracked::exact(value),
        slope: Tracked::exact(slope),
    }
}

fn dual_numbers<const N: usize>(numbers: &[f64; N], direction: &[f64; N]) -> [TrackedDual; N] {
    std::array::from_fn(|i| dual_number(numbers[i], direction[i]))
}

fn unit<const N: usize>(index: usize) -> [f64; N] {
    std::array::from_fn(|i| f64::from(u8::from(i == index)))
}

fn slopes<const N: usize>(duals: &[TrackedDual; N]) -> [Tracked; N] {
    duals.map(|dual| dual.slope)
}

const MAX_RELATIVE_DIFFERENCE: f64 = 1e-12;

/// Maximum difference of two numbers, in bounds of the rounding error of the expected number. The compared number is
/// computed by other operations on the same quantities; its rounding error may be eight times as large.
const MAX_ROUNDING_RATIO: f64 = 9.0;

fn assert_agree(what: &str, found: &[f64], expected: &[Tracked]) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.len(), expected.len());
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected.number).abs();
        prop_assert!(
            error
                <= MAX_RELATIVE_DIFFERENCE * expected.number.abs()
                    + MAX_ROUNDING_RATIO * expected.error,
            "{what}, {i}: {found:e} and {expected:?}"
        );
    }
    Ok(())
}

fn column<const R: usize, const C: usize>(matrix: &[[f64; C]; R], index: usize) -> [f64; R] {
    matrix.map(|row| row[index])
}

/// Returns the values of a struct's fields in the order of `names`, parsed from its debug output.
fn parse_fields<const N: usize>(fields: &impl std::fmt::Debug, names: &[&str; N]) -> [f64; N] {
    let printed = format!("{fields:?}");
    std::array::from_fn(|i| {
        let field = format!(" {}: ", names[i]);
        let start = printed.find(&field).expect("a field") + field.len();
        let end = printed[start..].find([',', ' ']).expect("an end") + start;
        printed[start..end].parse().expect("a number")
    })
}

macro_rules! checks {
    ($($module:ident),*) => {$(
        mod $module {
            use super::*;
            use crate::models::$module as model;
            use model::{DEGREES_OF_FREEDOM, INPUTS, PARAMETERS, STATES};

            struct Point {
                t: f64,
                state: [f64; STATES],
                inputs: [f64; INPUTS],
                parameters: [f64; PARAMETERS],
                coefficients: model::Coefficients,
            }

            /// Draws a point with a positive definite mass matrix.
            fn point(drawn: &mut NumberSource<'_>) -> Result<Point, TestCaseError> {
                let defaults = defaults();
                let parameters: [f64; PARAMETERS] =
                    std::array::from_fn(|i| defaults[i] * (1.0 + 0.1 * drawn.even()));
                let point = Point {
                    t: drawn.number(),
                    state: drawn.array(),
                    inputs: drawn.array(),
                    coefficients: model::Coefficients::prepare(&parameters.into()),
                    parameters,
                };
                prop_assume!(point.rates().iter().all(|rate| rate.is_finite()));
                Ok(point)
            }

            fn defaults() -> [f64; PARAMETERS] {
                parse_fields(&model::Parameters::default(), &model::PARAMETER_NAMES)
            }

            impl Point {
                fn rates(&self) -> [f64; STATES] {
                    model::rates(self.t, &self.state, &self.inputs.into(), &self.coefficients)
                }

                /// Returns the directional derivatives of rates and observables with respect to states, inputs and
                /// parameters.
                fn along(
                    &self,
                    state: &[f64; STATES],
                    inputs: &[f64; INPUTS],
                    parameters: &[f64; PARAMETERS],
                ) -> ([Tracked; STATES], [Tracked; model::OBSERVABLES]) {
                    let t = dual_number(self.t, 0.0);
                    let state = dual_numbers(&self.state, state);
                    let inputs = dual_numbers(&self.inputs, inputs).into();
                    let parameters = dual_numbers(&self.parameters, parameters).into();
                    let coefficients = model::Coefficients::prepare(&parameters);
                    let rates = model::rates(t, &state, &inputs, &coefficients);
                    let observables = model::observables(t, &state, &inputs, &coefficients);
                    (slopes(&rates), slopes(&observables))
                }
            }

            proptest! {
                #![proptest_config(ProptestConfig::with_cases(24))]

                #[test]
                fn jacobians_match_dual_numbers(numbers in numbers()) {
                    let p = point(&mut NumberSource { numbers: &numbers, next: 0 })?;
                    let (t, x, u, c) = (p.t, &p.state, &p.inputs.into(), &p.coefficients);
                    let (still, held, fixed) = ([0.0; STATES], [0.0; INPUTS], [0.0; PARAMETERS]);
                    let rates: [[f64; STATES]; STATES] =
                        model::RATES_BY_STATE.dense(&model::rates_by_state(t, x, u, c));
                    let observables: [[f64; STATES]; model::OBSERVABLES] =
                        model::OBSERVABLES_BY_STATE.dense(&model::observables_by_state(t, x, u, c));
                    for i in 0..STATES {
                        let (by_rates, by_observables) = p.along(&unit(i), &held, &fixed);
                        assert_agree("rates by state", &column(&rates, i), &by_rates)?;
                        assert_agree("observables by state", &column(&observables, i), &by_observables)?;
                    }
                    let rates: [[f64; INPUTS]; STATES] =
                        model::RATES_BY_INPUTS.dense(&model::rates_by_inputs(t, x, u, c));
                    let observables: [[f64; INPUTS]; model::OBSERVABLES] =
                        model::OBSERVABLES_BY_INPUTS.dense(&model::observables_by_inputs(t, x, u, c));
                    for i in 0..INPUTS {
                        let (by_rates, by_observables) = p.along(&still, &unit(i), &fixed);
                        assert_agree("rates by inputs", &column(&rates, i), &by_rates)?;
                        assert_agree("observables by inputs", &column(&observables, i), &by_observables)?;
                    }
                    let rates: [[f64; PARAMETERS]; STATES] =
                        model::RATES_BY_PARAMETERS.dense(&model::rates_by_parameters(t, x, u, c));
                    let observables: [[f64; PARAMETERS]; model::OBSERVABLES] =
                        model::OBSERVABLES_BY_PARAMETERS.dense(&model::observables_by_parameters(t, x, u, c));
                    for i in 0..PARAMETERS {
                        let (by_rates, by_observables) = p.along(&still, &held, &unit(i));
                        let name = model::PARAMETER_NAMES[i];
                        assert_agree(&format!("rates by {name}"), &column(&rates, i), &by_rates)?;
                        assert_agree(&format!("observables by {name}"), &column(&observables, i), &by_observables)?;
                    }
                }

                #[test]
                fn products_match_the_jacobian(numbers in numbers()) {
                    let mut drawn = NumberSource { numbers: &numbers, next: 0 };
                    let p = point(&mut drawn)?;
                    let (t, x, u, c) = (p.t, &p.state, &p.inputs.into(), &p.coefficients);
                    let (dx, du): ([f64; STATES], [f64; INPUTS]) = (drawn.array(), drawn.array());
                    let product = model::jacobian_vector_product(t, x, u, c, &dx, &du.into());
                    let (expected, _) = p.along(&dx, &du, &[0.0; PARAMETERS]);
                    assert_agree("direction", &product, &expected)?;
                    // The product of the weighted gradient with a direction equals the weighted derivative along the
                    // direction.
                    let weights: [f64; STATES] = drawn.array();
                    let (by_state, by_inputs) = model::vector_jacobian_product(t, x, u, c, &weights);
                    let weighted = |rates: &[Tracked; STATES]| {
                        let products = rates.iter().zip(&weights);
                        products.fold(Tracked::exact(0.0), |sum, (rate, weight)| {
                            sum + Tracked::exact(*weight) * *rate
                        })
                    };
                    let (still, held, fixed) = ([0.0; STATES], [0.0; INPUTS], [0.0; PARAMETERS]);
                    let expected: [Tracked; STATES] =
                        std::array::from_fn(|i| weighted(&p.along(&unit(i), &held, &fixed).0));
                    assert_agree("weights", &by_state, &expected)?;
                    let expected: [Tracked; INPUTS] =
                        std::array::from_fn(|i| weighted(&p.along(&still, &unit(i), &fixed).0));
                    assert_agree("weights by inputs", &parse_fields(&by_inputs, &model::INPUT_NAMES), &expected)?;
                    let by_parameters = model::vector_jacobian_product_by_parameters(t, x, u, c, &weights);
                    let expected: [Tracked; PARAMETERS] =
                        std::array::from_fn(|i| weighted(&p.along(&still, &held, &unit(i)).0));
                    assert_agree("weights by parameters", &by_parameters, &expected)?;
                }

                #[test]
                fn inverse_dynamics_inverts_forward_dynamics(numbers in numbers()) {
                    let mut drawn = NumberSource { numbers: &numbers, next: 0 };
                    let p = point(&mut drawn)?;
                    let (t, x, u, c) = (p.t, &p.state, &p.inputs.into(), &p.coefficients);
                    let rates = p.rates();
                    let a: [f64; DEGREES_OF_FREEDOM] =
                        std::array::from_fn(|i| rates[DEGREES_OF_FREEDOM + i]);
                    let mass = model::mass_matrix(t, x, u, c);
                    let missing = model::inverse_dynamics(t, x, u, c, &a);
                    let bias = model::bias_forces(t, x, u, c);
                    // The recursive sweep sums in another order, so results agree only up to rounding.
                    let held = model::inverse_dynamics(t, x, u, c, &[0.0; DEGREES_OF_FREEDOM]);
                    for i in 0..DEGREES_OF_FREEDOM {
                        let inertia: f64 = (0..DEGREES_OF_FREEDOM).map(|j| (mass[i][j] * a[j]).abs()).sum();
                        prop_assert!(
                            missing[i].abs() <= 1e-9 * (inertia + bias[i].abs()),
                            "{i}: {:e} of {inertia:e} and {:e}", missing[i], bias[i]
                        );
                    }
                    // For other accelerations, the forces differ by M times the difference of the accelerations.
                    let b: [f64; DEGREES_OF_FREEDOM] = drawn.array();
                    let forces = model::inverse_dynamics(t, x, u, c, &b);
                    for i in 0..DEGREES_OF_FREEDOM {
                        let inertia: Vec<f64> = (0..DEGREES_OF_FREEDOM).map(|j| mass[i][j] * b[j]).collect();
                        let scale: f64 = inertia.iter().map(|x| x.abs()).sum::<f64>() + bias[i].abs();
                        let expected = inertia.iter().sum::<f64>() + bias[i];
                        prop_assert!((forces[i] - expected).abs() <= 1e-13 * scale);
                        prop_assert!((held[i] - bias[i]).abs() <= 1e-13 * scale);
                    }
                }

                #[test]
                fn mass_matrix_is_the_hessian_of_the_energy(numbers in numbers()) {
                    let p = point(&mut NumberSource { numbers: &numbers, next: 0 })?;
                    let mass = model::mass_matrix(p.t, &p.state, &p.inputs.into(), &p.coefficients);
                    let number = |x: f64| Dual { value: dual_number(x, 0.0), slope: dual_number(0.0, 0.0) };
                    let parameters = p.parameters.map(number).into();
                    let (inputs, c) = (p.inputs.map(number).into(), model::Coefficients::prepare(&parameters));
                    for i in 0..DEGREES_OF_FREEDOM {
                        let row: [Tracked; DEGREES_OF_FREEDOM] = std::array::from_fn(|j| {
                            let mut state = p.state.map(number);
                            state[DEGREES_OF_FREEDOM + i].value.slope = Tracked::exact(1.0);
                            state[DEGREES_OF_FREEDOM + j].slope = dual_number(1.0, 0.0);
                            model::energy(number(p.t), &state, &inputs, &c).slope.slope
                        });
                        assert_agree("mass matrix", &mass[i], &row)?;
                        let column = column(&mass, i);
                        assert_agree("its transpose", &column, &row)?;
                    }
                }

                #[test]
                fn guard_rates_match_derivative_along_the_motion(numbers in numbers()) {
                    let p = point(&mut NumberSource { numbers: &numbers, next: 0 })?;
                    let found = model::guard_rates(p.t, &p.state, &p.inputs.into(), &p.coefficients);
                    let t = dual_number(p.t, 1.0);
                    let state = dual_numbers(&p.state, &p.rates());
                    let parameters = dual_numbers(&p.parameters, &[0.0; PARAMETERS]).into();
                    let coefficients = model::Coefficients::prepare(&parameters);
                    let guards = model::guards(t, &state, &dual_numbers(&p.inputs, &[0.0; INPUTS]).into(), &coefficients);
                    assert_agree("guards", &found, &slopes(&guards))?;
                }

                #[test]
                fn all_evaluations_give_same_bits(numbers in numbers()) {
                    let mut drawn = NumberSource { numbers: &numbers, next: 0 };
                    let p = point(&mut drawn)?;
                    let (t, x, u, c) = (p.t, &p.state, &p.inputs.into(), &p.coefficients);
                    let (dx, du): ([f64; STATES], [f64; INPUTS]) = (drawn.array(), drawn.array());
                    let weights: [f64; STATES] = drawn.array();
                    let a: [f64; DEGREES_OF_FREEDOM] = drawn.array();
                    let (by_state, by_inputs) = model::vector_jacobian_product(t, x, u, c, &weights);
                    let expected = [
                        model::inverse_dynamics(t, x, u, c, &a).to_vec(),
                        model::guard_rates(t, x, u, c).to_vec(),
                        model::jacobian_vector_product(t, x, u, c, &dx, &du.into()).to_vec(),
                        by_state.to_vec(),
                        parse_fields(&by_inputs, &model::INPUT_NAMES).to_vec(),
                        model::vector_jacobian_product_by_parameters(t, x, u, c, &weights).to_vec(),
                        model::rates_by_state(t, x, u, c).to_vec(),
                        model::rates_by_inputs(t, x, u, c).to_vec(),
                        model::rates_by_parameters(t, x, u, c).to_vec(),
                        model::observables_by_state(t, x, u, c).to_vec(),
                        model::observables_by_inputs(t, x, u, c).to_vec(),
                        model::observables_by_parameters(t, x, u, c).to_vec(),
                    ];
                    evaluators::with_both(crate::models::specifications::$module, |both| {
                    for evaluator in both {
                        evaluator.prepare(&p.parameters);
                        let point = EvaluatorPoint { t, state: x, inputs: &p.inputs };
                        let mut found = expected.clone().map(|numbers| vec![f64::NAN; numbers.len()]);
                        let [inverse, guards, forward, state, inputs, by_parameters, jacobians @ ..] = &mut found;
                        prop_assert!(evaluator.inverse_dynamics(point, &a, inverse));
                        prop_assert!(evaluator.guard_rates(point, guards));
                        prop_assert!(evaluator.jacobian_vector_product(point, (&dx, &du), forward));
                        prop_assert!(evaluator.vector_jacobian_product(point, &weights, (state, inputs)));
                        prop_assert!(evaluator.vector_jacobian_product_by_parameters(point, &weights, by_parameters));
                        for (place, nonzeros) in jacobians.iter_mut().enumerate() {
                            prop_assert!(evaluator.jacobian(place, point, nonzeros));
                        }
                        for (expected, found) in expected.iter().zip(&found) {
                            let bits = |numbers: &[f64]| -> Vec<u64> { numbers.iter().map(|x| x.to_bits()).collect() };
                            prop_assert_eq!(bits(expected), bits(found));
                        }
                    }
                    Ok(())
                    })?;
                }

                #[test]
                fn linearisation_predicts_small_changes(numbers in numbers()) {
                    let mut drawn = NumberSource { numbers: &numbers, next: 0 };
                    let p = point(&mut drawn)?;
                    let found = model::linearise(p.t, &p.state, &p.inputs.into(), &p.coefficients);
                    prop_assert_eq!(found.rates, p.rates());
                    let (dx, du): ([f64; STATES], [f64; INPUTS]) = (drawn.array(), drawn.array());
                    let (rates, observables) = p.along(&dx, &du, &[0.0; PARAMETERS]);
                    let product = |by_state: &[f64; STATES], by_inputs: &[f64; INPUTS]| -> f64 {
                        let state: f64 = by_state.iter().zip(&dx).map(|(a, b)| a * b).sum();
                        state + by_inputs.iter().zip(&du).map(|(a, b)| a * b).sum::<f64>()
                    };
                    let predicted: Vec<f64> = found.A.iter().zip(&found.B).map(|(a, b)| product(a, b)).collect();
                    assert_agree("rates", &predicted, &rates)?;
                    let predicted: Vec<f64> = found.C.iter().zip(&found.D).map(|(c, d)| product(c, d)).collect();
                    assert_agree("observables", &predicted, &observables)?;
                }
            }
        }
    )*};
}

checks!(
    arm_rigid,
    arm,
    arm_of_nine_modes,
    rig,
    beam,
    double_pendulum,
    cart,
    furuta,
    pendulum,
    emps,
    exponential_taper,
    printed_basis,
    two_fields,
    functions,
    nonquadratic_kinetic,
    rheonomic,
    lever_mass_turning,
    centrifugal_stiffening
);
