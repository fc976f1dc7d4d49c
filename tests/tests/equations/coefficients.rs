//! Tests of the named coefficients a_01 .. in the arm's specification: they equal the hand-written coefficients of Eq.
//! (22) and are sufficient to assemble the equations.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_tests::models::{load, samples, variant};
use eomgen_validate::references::planetary_arm::equation_22::{Coefficients, ModeRow};
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;
use eomgen_validate::sampler::Sample;

/// Maximum relative deviation. Both sides have the errors of tens of roundings, and a_16 loses a digit by cancellation.
const TOLERANCE: f64 = 1e-12;

const ORDERS: [usize; 3] = [1, 4, 16];

/// Derived variant whose observables are the named coefficients.
struct NamedCoefficients {
    names: Vec<String>,
    evaluator: Evaluator,
}

impl NamedCoefficients {
    fn at_order(order: usize) -> Self {
        let derived = variant(&load("planetary_arm"), order);
        let mut program = derived.evaluator.program().clone();
        program.observable_values = program.coefficient_values.clone();
        Self {
            names: derived
                .equations
                .coefficients
                .iter()
                .map(|c| c.name.clone())
                .collect(),
            evaluator: Evaluator::new(program),
        }
    }

    /// Returns the coefficients at a sample by name: a single number, one number per mode, or a matrix of modes.
    fn coefficients_at(&mut self, sample: &Sample) -> impl Fn(&str) -> Vec<f64> + use<> {
        let point = Point {
            t: sample.time,
            state: &sample.state,
            inputs: &sample.inputs,
        };
        self.evaluator
            .observables(point, &mut vec![f64::NAN; self.names.len()]);
        let values = &self.evaluator.program().coefficient_values;
        let numbers = values
            .iter()
            .map(|value| self.evaluator.slice(*value).to_vec());
        let named: Vec<(String, Vec<f64>)> = self.names.iter().cloned().zip(numbers).collect();
        move |name| {
            let found = named.iter().find(|(known, _)| known == name);
            found
                .unwrap_or_else(|| panic!("no coefficient {name}"))
                .1
                .clone()
        }
    }
}

/// Returns the hand-written coefficient that has the name `name` in the specification; q in a name denotes the modes.
fn hand_written(coefficients: &Coefficients, name: &str, t: f64) -> Option<Vec<f64>> {
    let c = coefficients;
    let one = |value: f64| Some(vec![value]);
    let modes = |value: fn(&ModeRow) -> f64| Some(c.modes.iter().map(value).collect());
    match name {
        "a_01" => one(c.a_01),
        "a_0q" => Some(c.a_0.clone()),
        "a_11" => one(c.a_11(t)),
        "a_12" | "a_12_pr" => one(c.a_12),
        "a_13" => one(c.a_13),
        "a_14" => one(c.a_14),
        "a_15" => one(c.a_15),
        "a_16" => one(c.a_16),
        "a_17" => one(c.a_17),
        "a_1q" | "a_2q" => Some(c.a_18.clone()),
        "a_21" => one(c.a_21),
        "a_22" => one(c.a_22),
        "a_23" => one(c.a_23),
        "a_24" => one(c.a_24),
        "a_30" => one(c.a_30),
        "a_3q" => Some(c.a_3.clone()),
        "a_35" => one(c.a_35),
        "a_36" => one(c.a_36),
        "a_37" => one(c.a_37),
        "a_38" => one(c.a_38),
        "a_q0" => modes(|row| row.a_0),
        "a_qq" => Some(c.modes.iter().flat_map(|row| row.a.clone()).collect()),
        "a_q5" => modes(|row| row.a_5),
        "a_q6" => modes(|row| row.a_6),
        "a_q7" => modes(|row| row.a_7),
        "a_q8" => modes(|row| row.a_8),
        _ => None,
    }
}

#[test]
fn named_coefficients_match_equation_22() {
    for order in ORDERS {
        let mut named = NamedCoefficients::at_order(order);
        let coefficients = Coefficients::new(&PlanetaryArmParameters::default(), order);
        let sample = &samples(&load("planetary_arm"), order, 1, 1)[0];
        let derived = named.coefficients_at(sample);
        for name in &named.names {
            let expected = hand_written(&coefficients, name, sample.time)
                .unwrap_or_else(|| panic!("{name} is not compared"));
            let found = derived(name);
            assert_eq!(found.len(), expected.len(), "{name} at order {order}");
            for (found, expected) in found.iter().zip(&expected) {
                let deviation = (found - expected).abs() / expected.abs();
                assert!(
                    deviation <= TOLERANCE,
                    "{name}: {found:e}, expected {expected:e}"
                );
            }
        }
        assert_eq!(named.names.len(), 28, "{:?}", named.names);
    }
}

/// Quantities that the coefficients multiply: the paper's f_k and f_c, and the modes.
struct Quantities {
    rates: [f64; 3],
    springs: [f64; 2],
    dampers: [f64; 2],
    modes: Vec<f64>,
}

impl Quantities {
    fn from_sample(sample: &Sample, order: usize) -> Self {
        let PlanetaryArmParameters { b_sp, b_pr, .. } = PlanetaryArmParameters::default();
        let (positions, rates) = sample.state.split_at(3 + order);
        let spring = |p: f64, b: f64| if p.abs() > b { p - b * p.signum() } else { 0.0 };
        let damper = |p: f64, v: f64, b: f64| if p.abs() > b { v } else { 0.0 };
        Self {
            rates: [rates[0], rates[1], rates[2]],
            springs: [spring(positions[0], b_sp), spring(positions[1], b_pr)],
            dampers: [
                damper(positions[0], rates[0], b_sp),
                damper(positions[1], rates[1], b_pr),
            ],
            modes: positions[3..].to_vec(),
        }
    }

    /// Returns the four mesh terms of a row; `names` are their coefficients.
    fn mesh_terms(&self, a: &impl Fn(&str) -> Vec<f64>, names: [&str; 4], mode: usize) -> Vec<f64> {
        let quantities = [
            self.springs[0],
            self.dampers[0],
            self.springs[1],
            self.dampers[1],
        ];
        names
            .iter()
            .zip(quantities)
            .map(|(name, by)| a(name)[mode] * by)
            .collect()
    }

    fn mode_terms(&self, factors: &[f64]) -> Vec<f64> {
        factors
            .iter()
            .zip(&self.modes)
            .map(|(factor, q)| factor * q)
            .collect()
    }
}

/// Returns the terms of every row of Eq. (22), divided by the coefficient of the row's acceleration.
fn rows(a: &impl Fn(&str) -> Vec<f64>, by: &Quantities) -> Vec<Vec<f64>> {
    let one = |name: &str| a(name)[0];
    let [x_sp, x_pr, x_c] = by.rates;
    let motor = vec![
        one("a_11"),
        one("a_12") * x_sp,
        one("a_12_pr") * x_pr,
        one("a_13") * x_c,
    ];
    let mut rows = vec![
        [
            motor,
            by.mesh_terms(a, ["a_14", "a_15", "a_16", "a_17"], 0),
            by.mode_terms(&a("a_1q")),
        ]
        .concat(),
        [
            by.mesh_terms(a, ["a_21", "a_22", "a_23", "a_24"], 0),
            by.mode_terms(&a("a_2q")),
        ]
        .concat(),
    ];
    let carrier = [
        by.mesh_terms(a, ["a_35", "a_36", "a_37", "a_38"], 0),
        by.mode_terms(&a("a_3q")),
    ]
    .concat();
    rows.push(carrier.iter().map(|term| term / one("a_30")).collect());
    let (inertias, matrix) = (a("a_q0"), a("a_qq"));
    for (mode, inertia) in inertias.iter().enumerate() {
        let own = &matrix[mode * inertias.len()..(mode + 1) * inertias.len()];
        let row = [
            by.mesh_terms(a, ["a_q5", "a_q6", "a_q7", "a_q8"], mode),
            by.mode_terms(own),
        ]
        .concat();
        rows.push(row.iter().map(|term| term / inertia).collect());
    }
    rows
}

#[test]
fn named_coefficients_assemble_the_equations() {
    let model = load("planetary_arm");
    for order in ORDERS {
        let mut named = NamedCoefficients::at_order(order);
        let mut evaluator = variant(&model, order).evaluator;
        for sample in samples(&model, order, 7, 10) {
            let mut rates = vec![f64::NAN; sample.state.len()];
            let point = Point {
                t: sample.time,
                state: &sample.state,
                inputs: &sample.inputs,
            };
            evaluator.rates(point, &mut rates);
            let rows = rows(
                &named.coefficients_at(&sample),
                &Quantities::from_sample(&sample, order),
            );
            assert_eq!(rows.len(), 3 + order);
            for (row, acceleration) in rows.iter().zip(&rates[3 + order..]) {
                let sum: f64 = row.iter().sum();
                let largest = row
                    .iter()
                    .fold(0.0_f64, |scale, term| scale.max(term.abs()));
                let deviation = (sum - acceleration).abs() / largest;
                assert!(
                    deviation <= TOLERANCE,
                    "order {order}: {sum}, expected {acceleration}"
                );
            }
        }
    }
}
