//! Assignment of the hand-written equations in [`crate::reference`] to models, for certificates.

use eomgen_model_spec::model::Model;
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;

use crate::equation_comparison::first_difference;
use crate::reference::closed_forms::{self, StateAndParameters};
use crate::reference::equation_10::{self, ShaftMotion};
use crate::reference::equation_22::{Coefficients, Equation22};
use crate::reference::{Evaluation, PlanetaryArmParameters, equation_12};
use eomgen_validate::certificate::Check;
use eomgen_validate::certify::{Reference, ReferenceEquations};
use eomgen_validate::checks::ROW_TOLERANCE;

/// Time scale omega_n = sqrt(k_sp/M_sp), rad/s, and displacement scale b_c, m, of the paper.
const TIME_AND_LENGTH_SCALES: (f64, f64) = (3.0885e4, 25e-6);

/// Specifications with hand-written equations. A model is compared by its equations and not by its
/// name, because a model of the same name may follow other conventions.
const SPECIFICATIONS_WITH_REFERENCES: [&str; 14] = [
    models::PLANETARY_ARM.text,
    models::DOUBLE_PENDULUM.text,
    models::CART_TWO_ARMS.text,
    models::CHAPLYGIN_SLEIGH.text,
    models::CRANE.text,
    models::FURUTA_PENDULUM.text,
    models::HUB_BEAM_TIP_MASS.text,
    models::LOUDSPEAKER.text,
    models::PENDULUM.text,
    models::EMPS.text,
    models::PUMA_560.text,
    models::QUADROTOR_SLUNG_LOAD.text,
    models::SHAFT_AND_DISC.text,
    models::TWO_LINK_ARM.text,
];

/// Derived parameters of the arm that its hand-written equations take as given.
const GIVEN_DERIVED_PARAMETERS: [&str; 3] = ["I_s", "I_p", "I_c"];

/// Returns the hand-written equations for `model` at `order`, with parameter values in SI.
pub fn reference_equations(model: &Model, order: usize, values: &[f64]) -> ReferenceEquations {
    let known = match matching_specification(model) {
        Ok(known) => known,
        Err(reason) => return absent_reference("reference", reason),
    };
    if known.name == "planetary_arm" {
        return match arm_parameters(model, values) {
            Some(parameters) => arm_references(parameters, order),
            None => absent_reference("reference", "a parameter is missing".to_owned()),
        };
    }
    match closed_form(&known, model, order, values) {
        Ok(reference) => ReferenceEquations {
            references: vec![reference],
            not_applicable: Vec::new(),
        },
        Err(reason) => absent_reference("reference closed_form", reason),
    }
}

fn absent_reference(name: &str, reason: String) -> ReferenceEquations {
    ReferenceEquations {
        references: Vec::new(),
        not_applicable: vec![Check::not_applicable(name, ROW_TOLERANCE, reason)],
    }
}

/// Returns the shipped specification with the equations of `model`, or the reason that none
/// matches.
fn matching_specification(model: &Model) -> Result<Model, String> {
    let mut reason = format!("there are no hand-written equations of {}", model.name);
    for text in SPECIFICATIONS_WITH_REFERENCES {
        let Ok(checked) = eomgen_model_spec::check(Source::new("a shipped specification", text))
        else {
            continue;
        };
        let known = checked.model;
        let all: Vec<&str> = known.parameters.iter().map(|p| p.name.as_str()).collect();
        let given = match known.name.as_str() {
            "planetary_arm" => &GIVEN_DERIVED_PARAMETERS[..],
            _ => &all,
        };
        match first_difference(model, &known, given) {
            None => return Ok(known),
            Some(found) if known.name == model.name => {
                reason = format!(
                    "the equations differ from the hand-written ones of {}: {found}",
                    known.name
                );
            }
            Some(_) => {}
        }
    }
    Err(reason)
}

/// Returns Eq. (12) and Eq. (10) for the rigid arm, or Eq. (22) in SI and in the scales of the
/// paper for the flexible arm.
fn arm_references(parameters: PlanetaryArmParameters, order: usize) -> ReferenceEquations {
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
        // The equations do not depend on the angle of the arm. Angles of a turned arm would cost
        // six digits of the mesh deflections, which are differences of a micrometre.
        angle: shafts(state[0], state[1], 0.0),
        rate: shafts(state[3], state[4], state[5]),
        acceleration: shafts(a, b, c),
    })
}

/// Returns Eq. (22) in dimensionless form, for orders fixed at compile time.
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

/// Returns the textbook equations of `known` with the values of `model`, or the reason that they do
/// not apply.
fn closed_form(
    known: &Model,
    model: &Model,
    order: usize,
    values: &[f64],
) -> Result<Reference, String> {
    let form = closed_forms::find_closed_form(&known.name).ok_or("there is no closed form")?;
    // A parameter of this model only is in none of the equations.
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
    evaluate(&rest, &still).map_err(|unfit| unfit.to_string())?;
    Ok(reference(
        "closed_form",
        move |_, state, inputs, accelerations| {
            evaluate(state, inputs)
                .map_or(f64::INFINITY, |expected| expected.deviation(accelerations))
        },
    ))
}

/// Returns the parameters of the arm by their names, or `None` if one is missing.
pub fn arm_parameters(model: &Model, values: &[f64]) -> Option<PlanetaryArmParameters> {
    let value = |name: &str| {
        let place = model
            .parameters
            .iter()
            .position(|parameter| parameter.name == name)?;
        values.get(place).copied()
    };
    Some(PlanetaryArmParameters {
        k_sp: value("k_sp")?,
        k_pr: value("k_pr")?,
        c_sp: value("c_sp")?,
        c_pr: value("c_pr")?,
        b_sp: value("b_sp")?,
        b_pr: value("b_pr")?,
        m_p: value("m_p")?,
        I_s: value("I_s")?,
        I_p: value("I_p")?,
        I_c: value("I_c")?,
        rho: value("rho")?,
        A: value("A")?,
        l: value("l")?,
        E: value("E")?,
        I: value("I")?,
        alpha: value("alpha")?,
        z_s: value("z_s")?,
        z_p: value("z_p")?,
        z_r: value("z_r")?,
        m: value("m")?,
        a_m: value("a_m")?,
        b_m: value("b_m")?,
        F_w: value("F_w")?,
        omega: value("omega")?,
    })
}
