//! Which hand-written equations belong to a model, as references for its certificate. The
//! equations themselves are in [`crate::reference`].

use model_spec::model::Model;

use crate::reference::closed_forms::{self, Situation};
use crate::reference::equation_10::{self, ShaftMotion};
use crate::reference::equation_22::{Coefficients, Equation22};
use crate::reference::{Evaluation, PlanetaryArmParameters, equation_12};
use crate::validate::certify::Reference;

/// The paper's time scale omega_n = sqrt(k_sp/M_sp), in rad/s, and displacement scale b_c, in m.
const PAPER_SCALES: (f64, f64) = (3.0885e4, 25e-6);

/// The specifications that were written out by hand. A model of the same name may follow
/// other conventions; only these very texts are known to be the same machines.
const SHIPPED: [&str; 8] = [
    include_str!("../../model-spec/models/planetary_arm.toml"),
    include_str!("../../model-spec/models/double_pendulum.toml"),
    include_str!("../../model-spec/models/cart_two_arms.toml"),
    include_str!("../../model-spec/models/furuta_pendulum.toml"),
    include_str!("../../model-spec/models/hub_beam_tip_mass.toml"),
    include_str!("../../model-spec/models/pendulum.toml"),
    include_str!("../../model-spec/models/emps.toml"),
    include_str!("../../model-spec/models/two_link_arm.toml"),
];

/// The references for `model` at `order` with parameter values in SI; none for a model
/// that nobody has written by hand.
pub fn references(model: &Model, order: usize, values: &[f64]) -> Vec<Reference> {
    if !SHIPPED.contains(&&*model.source.text) {
        return Vec::new();
    }
    if model.name == "planetary_arm" {
        return arm_parameters(model, values).map_or_else(Vec::new, |p| arm(p, order));
    }
    closed_form(model, order, values).into_iter().collect()
}

/// Eq. (12) and Eq. (10) for the rigid arm; Eq. (22) in SI and in the paper's scales for the flexible one.
fn arm(parameters: PlanetaryArmParameters, order: usize) -> Vec<Reference> {
    if order == 0 {
        return vec![
            reference(
                "equation_12",
                move |t, state, _, accelerations| match <&[f64; 6]>::try_from(state) {
                    Ok(state) => {
                        equation_12::corrected(&parameters, t, state).deviation(accelerations)
                    }
                    Err(_) => f64::INFINITY,
                },
            ),
            reference("equation_10", move |t, state, _, accelerations| {
                shaft_motion(&parameters, state, accelerations).map_or(f64::INFINITY, |motion| {
                    equation_10::corrected(&parameters, t, &motion).worst()
                })
            }),
        ];
    }
    let coefficients = Coefficients::new(&parameters, order);
    let mut found = vec![reference(
        "equation_22",
        move |t, state, _, accelerations| {
            coefficients
                .evaluate(t, state)
                .map_or(f64::INFINITY, |expected| expected.deviation(accelerations))
        },
    )];
    found.extend(scaled(&parameters, order));
    found
}

/// The shafts' angles, rates and accelerations, Eq. (1) to (5).
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
        // Nothing depends on where the arm points. Angles of a turned arm would cost the mesh
        // deflections, differences of a micrometre, six digits.
        angle: shafts(state[0], state[1], 0.0),
        rate: shafts(state[3], state[4], state[5]),
        acceleration: shafts(a, b, c),
    })
}

/// Eq. (22) in dimensionless form; its order is fixed when it is compiled.
fn scaled(parameters: &PlanetaryArmParameters, order: usize) -> Option<Reference> {
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
    let (omega_n, b_c) = PAPER_SCALES;
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

/// The textbook equations of the model's name, if its parameters fit them.
fn closed_form(model: &Model, order: usize, values: &[f64]) -> Option<Reference> {
    let form = closed_forms::find(&model.name)?;
    let parameters: Vec<(String, f64)> = model
        .parameters
        .iter()
        .map(|parameter| parameter.name.clone())
        .zip(values.iter().copied())
        .collect();
    let names: Vec<String> = model
        .inputs
        .iter()
        .map(|input| input.name.clone())
        .collect();
    let evaluate = move |state: &[f64], inputs: &[f64]| {
        form(&Situation {
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
    let rest = vec![0.0; 2 * (model.coordinates.len() + modes)];
    let still = vec![0.0; model.inputs.len()];
    evaluate(&rest, &still).ok()?;
    Some(reference(
        "closed_form",
        move |_, state, inputs, accelerations| {
            evaluate(state, inputs)
                .map_or(f64::INFINITY, |expected| expected.deviation(accelerations))
        },
    ))
}

/// The arm's parameters by their names; `None` if one is missing.
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
