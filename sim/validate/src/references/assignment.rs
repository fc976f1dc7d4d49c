//! Assignment of hand-written equations to models, by comparison of the equations of motion.

use eomgen_model_spec::model::Model;
use eomgen_model_spec::models;

use super::closed_forms::{CLOSED_FORMS, ClosedForm, StateAndParameters};
use super::equation_comparison::first_difference;
use super::evaluation::Evaluation;
use super::planetary_arm::dimensionless_equation_22::Equation22;
use super::planetary_arm::equation_10::{self, ShaftMotion};
use super::planetary_arm::equation_12;
use super::planetary_arm::equation_22::Coefficients;
use super::planetary_arm::parameters::PlanetaryArmParameters;
use crate::certificate::Check;
use crate::certify::{Reference, ReferenceEquations};
use crate::checks::ROW_TOLERANCE;

/// Scales of the paper: omega_n = sqrt(k_sp/M_sp) in rad/s for the time, and b_c in m for displacements.
const TIME_AND_LENGTH_SCALES: (f64, f64) = (3.0885e4, 25e-6);

/// Derived parameters of the arm whose values the hand-written equations use as given constants.
const GIVEN_DERIVED_PARAMETERS: [&str; 3] = ["I_s", "I_p", "I_c"];

/// Returns the hand-written equations for `model` at `order`, with parameter values in SI.
///
/// The equations decide, not the name, because a model of the same name may follow other conventions.
pub fn reference_equations(model: &Model, order: usize, values: &[f64]) -> ReferenceEquations {
    let mut reason = format!("there are no hand-written equations for {}", model.name);
    let arm = std::iter::once((&models::PLANETARY_ARM, None));
    let machines = CLOSED_FORMS
        .iter()
        .map(|(shipped, form)| (shipped, Some(*form)));
    for (shipped, form) in arm.chain(machines) {
        let Ok(checked) = eomgen_model_spec::check(shipped.source()) else {
            continue;
        };
        let known = checked.model;
        let all: Vec<&str> = known.parameters.iter().map(|p| p.name.as_str()).collect();
        let given = match form {
            None => &GIVEN_DERIVED_PARAMETERS[..],
            Some(_) => &all,
        };
        match (first_difference(model, &known, given), form) {
            (None, None) => return arm_references(model, order, values),
            (None, Some(form)) => return closed_form(form, &known, model, order, values),
            (Some(found), _) if is_version_of(model, &known) => {
                reason = format!(
                    "the equations differ from the hand-written ones of {}: {found}",
                    known.name
                );
            }
            (Some(_), _) => {}
        }
    }
    absent_reference("reference", reason)
}

/// Returns true if `model` and `known` have the same name and the same coordinates. The name is not sufficient, because
/// another machine may have the same name.
fn is_version_of(model: &Model, known: &Model) -> bool {
    let coordinates = |model: &Model| -> Vec<String> {
        let coordinates = model.coordinates.iter();
        coordinates.map(|own| own.name.clone()).collect()
    };
    model.name == known.name && coordinates(model) == coordinates(known)
}

fn absent_reference(name: &str, reason: String) -> ReferenceEquations {
    ReferenceEquations {
        references: Vec::new(),
        not_applicable: vec![Check::not_applicable(name, ROW_TOLERANCE, reason)],
    }
}

/// Returns Eq. (12) and Eq. (10) for the rigid arm, or Eq. (22) in SI and in the scales of the
/// paper for the flexible arm.
fn arm_references(model: &Model, order: usize, values: &[f64]) -> ReferenceEquations {
    let Some(parameters) = PlanetaryArmParameters::from_names(named_values(model, values)) else {
        return absent_reference("reference", "a parameter is missing".to_owned());
    };
    if order == 0 {
        return ReferenceEquations {
            references: rigid_arm(parameters),
            not_applicable: Vec::new(),
        };
    }
    let coefficients = Coefficients::new(&parameters, order);
    let mut found = ReferenceEquations {
        references: vec![reference(
            "equation_22",
            move |t, state, _, accelerations| {
                coefficients
                    .evaluate(t, state)
                    .map_or(f64::INFINITY, |expected| expected.deviation(accelerations))
            },
        )],
        not_applicable: Vec::new(),
    };
    match dimensionless_reference(&parameters, order) {
        Some(reference) => found.references.push(reference),
        None => found.not_applicable.push(Check::not_applicable(
            "reference equation_22_dimensionless",
            ROW_TOLERANCE,
            "written out for 1 to 8, 16, 32, 64 and 128 modes",
        )),
    }
    found
}

fn rigid_arm(parameters: PlanetaryArmParameters) -> Vec<Reference> {
    vec![
        reference(
            "equation_12",
            move |t, state, _, accelerations| match <&[f64; 6]>::try_from(state) {
                Ok(state) => equation_12::corrected_accelerations(&parameters, t, state)
                    .deviation(accelerations),
                Err(_) => f64::INFINITY,
            },
        ),
        reference("equation_10", move |t, state, _, accelerations| {
            shaft_motion(&parameters, state, accelerations).map_or(f64::INFINITY, |motion| {
                equation_10::corrected_residuals(&parameters, t, &motion).worst()
            })
        }),
    ]
}

/// Computes angles, rates and accelerations of the shafts, Eq. (1) to (5).
fn shaft_motion(
    parameters: &PlanetaryArmParameters,
    state: &[f64],
    accelerations: &[f64],
) -> Option<ShaftMotion> {
    let state = <&[f64; 6]>::try_from(state).ok()?;
    let [a, b, c] = *<&[f64; 3]>::try_from(accelerations).ok()?;
    let shafts = |x_sp: f64, x_pr: f64, x_c: f64| {
        [
            (x_sp + x_pr + 2.0 * x_c) / parameters.r_s(),
            (x_pr + x_c) / parameters.r_p(),
            x_c / parameters.r_c_cos_alpha(),
        ]
    };
    Some(ShaftMotion {
        // The equations do not depend on the angle of the arm, so it is set to 0. Mesh deflections of micrometres are
        // differences of angles; with large angles they would lose six digits.
        angle: shafts(state[0], state[1], 0.0),
        rate: shafts(state[3], state[4], state[5]),
        acceleration: shafts(a, b, c),
    })
}

/// Returns Eq. (22) in dimensionless form; `None` if the order is not among the orders fixed at compile time.
fn dimensionless_reference(parameters: &PlanetaryArmParameters, order: usize) -> Option<Reference> {
    macro_rules! at_orders {
        ($($s:literal)*) => {
            match order {
                $($s => Some(scaled_reference::<$s>(parameters)),)*
                _ => None,
            }
        };
    }
    at_orders!(1 2 3 4 5 6 7 8 16 32 64 128)
}

fn scaled_reference<const S: usize>(parameters: &PlanetaryArmParameters) -> Reference {
    let (omega_n, b_c) = TIME_AND_LENGTH_SCALES;
    let equation = Equation22::<S>::new(parameters, omega_n, b_c);
    let scales = Coefficients::new(parameters, S);
    reference(
        "equation_22_dimensionless",
        move |t, state, _, accelerations| {
            let (positions, rates) = state.split_at(state.len() / 2);
            let scaled: Vec<f64> = positions
                .iter()
                .map(|x| x / b_c)
                .chain(rates.iter().map(|v| v / (b_c * omega_n)))
                .collect();
            let mut out = vec![0.0; scaled.len()];
            equation.rates(omega_n * t, &scaled, &mut out);
            let Some(dimensional) = scales.evaluate(t, state) else {
                return f64::INFINITY;
            };
            let expected = Evaluation {
                accelerations: out[positions.len()..]
                    .iter()
                    .map(|a| a * b_c * omega_n * omega_n)
                    .collect(),
                scales: dimensional.scales,
            };
            expected.deviation(accelerations)
        },
    )
}

fn reference(
    name: &str,
    deviation: impl Fn(f64, &[f64], &[f64], &[f64]) -> f64 + 'static,
) -> Reference {
    Reference {
        name: name.to_owned(),
        deviation: Box::new(deviation),
    }
}

/// Returns the textbook equations of `known` with the values of `model`, or the reason why they do not apply.
fn closed_form(
    form: ClosedForm,
    known: &Model,
    model: &Model,
    order: usize,
    values: &[f64],
) -> ReferenceEquations {
    // A parameter that only this model has appears in none of the equations.
    let stands = |name: &str| known.parameters.iter().any(|own| own.name == name);
    let parameters: Vec<(String, f64)> = model
        .parameters
        .iter()
        .map(|parameter| parameter.name.clone())
        .zip(values.iter().copied())
        .filter(|(name, _)| stands(name))
        .collect();
    let names: Vec<String> = model
        .inputs
        .iter()
        .map(|input| input.name.clone())
        .collect();
    let evaluate = move |state: &[f64], inputs: &[f64]| {
        form(&StateAndParameters {
            parameter: &|name| {
                parameters
                    .iter()
                    .find(|(own, _)| own == name)
                    .map(|(_, value)| *value)
            },
            input: &|name| {
                inputs
                    .get(names.iter().position(|own| own == name)?)
                    .copied()
            },
            order,
            state,
        })
    };
    let modes: usize = order * model.fields.len();
    let rest = vec![0.0; 2 * (model.coordinates.len() + modes) + model.states.len()];
    let still = vec![0.0; model.inputs.len()];
    if let Err(unfit) = evaluate(&rest, &still) {
        return absent_reference("reference closed_form", unfit.to_string());
    }
    let deviation = move |_: f64, state: &[f64], inputs: &[f64], accelerations: &[f64]| {
        evaluate(state, inputs).map_or(f64::INFINITY, |expected| expected.deviation(accelerations))
    };
    ReferenceEquations {
        references: vec![reference("closed_form", deviation)],
        not_applicable: Vec::new(),
    }
}

/// Returns a function from the name of a parameter to its value.
fn named_values<'m>(model: &'m Model, values: &'m [f64]) -> impl Fn(&str) -> Option<f64> + 'm {
    move |name| {
        let mut parameters = model.parameters.iter().zip(values);
        parameters
            .find(|(parameter, _)| parameter.name == name)
            .map(|(_, value)| *value)
    }
}
