//! Tests of the residual force. A carriage pulls a second carriage by a spring, and a hidden force acts on the second
//! one. The motion is integrated by hand-written equations; the model has springs and dampers only.

use eomgen_records::read_dataset;
use std::fs;
use std::path::Path;

use eomgen_discover::fit::null_model::fit_null_model;
use eomgen_discover::model::problem::EstimationProblem;
use eomgen_discover::residual_force::estimate_residual_force;
use eomgen_discover::residual_force::types::{
    ForceKind, Profile, ResidualForce, SimpleFunction, SimpleTerm,
};
use eomgen_discover::residual_force::wording::describe_residual_force;
use eomgen_model_spec::source::Source;

const SPECIFICATION: &str = r#"
[model]
name = "two_carriages"

[parameters]
m = { value = 1.5, unit = "kg", min = 0 }
k = { value = 400, unit = "N/m", min = 0 }
c = { value = 3, unit = "N s/m", min = 0 }

[coordinates]
p = { unit = "m", doc = "the driven carriage" }
q = { unit = "m", doc = "the one that is dragged" }

[inputs]
force = { unit = "N" }

[kinetic]
driven = "1/2*m*dot(p)^2"
dragged = "1/2*m*dot(q)^2"

[potential]
spring = "1/2*k*(p - q)^2"

[dissipation]
spring = "1/2*c*(dot(p) - dot(q))^2"
guides = "1/2*c*(dot(p)^2 + dot(q)^2)"

[forces]
motor = { on = "p", value = "force" }
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.force]
column = "force"
unit = "N"
hold = "zero-order"

[channels.p]
column = "p"
unit = "m"
noise = 1e-5

[channels.q]
column = "q"
unit = "m"
noise = 1e-5

[initial]
state = "rest"

[windows]
length = 0.4
start = "fitted"
"#;

/// Returns a record with a hidden force on the second carriage, a function of the carriage's rate and position.
fn record(hidden: &dyn Fn(f64, f64) -> f64, turn: f64) -> String {
    let (m, k, c) = (1.5, 400.0, 3.0);
    let step = 0.002;
    let parts = 20;
    let mut state = [0.0_f64; 4];
    let mut noise = 0.37_f64;
    let mut text = "t,force,p,q\n".to_owned();
    for sample in 0..2000 {
        let t = step * f64::from(sample);
        let force = 25.0 * (4.0 * t + turn).sin() + 12.0 * (11.0 * t * (1.0 + 0.1 * turn)).cos();
        let mut drawn = || {
            // The sum of twelve numbers of the logistic map is nearly normal.
            let sum: f64 = (0..12)
                .map(|_| {
                    noise = (noise * 997.0 + 0.123_456_7).fract();
                    noise
                })
                .sum();
            1e-5 * (sum - 6.0)
        };
        let (a, b) = (state[0] + drawn(), state[1] + drawn());
        text += &format!("{t:.3},{force:.12},{a:.9},{b:.9}\n");
        let rates = |[p, q, v, w]: [f64; 4]| {
            let spring = k * (p - q) + c * (v - w);
            [
                v,
                w,
                (force - spring - c * v) / m,
                (spring - c * w + hidden(w, q)) / m,
            ]
        };
        for _ in 0..parts {
            let h = step / f64::from(parts);
            let first = rates(state);
            let middle = rates(std::array::from_fn(|i| state[i] + 0.5 * h * first[i]));
            state = std::array::from_fn(|i| state[i] + h * middle[i]);
        }
    }
    text
}

fn force_from_records(hidden: &dyn Fn(f64, f64) -> f64) -> ResidualForce {
    residual_force_with(hidden, SPECIFICATION)
}

fn residual_force_with(hidden: &dyn Fn(f64, f64) -> f64, specification: &str) -> ResidualForce {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("a file");
    write("dataset.toml", DATASET);
    write("train.csv", &record(hidden, 0.0));
    write("test.csv", &record(hidden, 1.0));
    residual_force_in(folder.path(), specification)
}

fn residual_force_in(folder: &Path, specification: &str) -> ResidualForce {
    let model = eomgen_model_spec::check(Source::new("two_carriages.toml", specification));
    let model = model.expect("a valid specification").model;
    let dataset = read_dataset(&folder.join("dataset.toml"), &model).expect("a valid dataset");
    let problem = EstimationProblem::new(&dataset, None, "two_carriages.toml", specification);
    let fit = fit_null_model(&problem, specification).expect("a fit");
    estimate_residual_force(&problem, &fit, None).expect("neighbouring motions")
}

/// Asserts that a profile matches a function within four standard deviations plus a tenth of the largest force (for the
/// smoothing). Returns the number of points with a standard deviation below a fifth of the largest force.
fn assert_matches(profile: &Profile, of: impl Fn(usize, f64) -> f64, largest: f64) -> usize {
    let mut known = 0;
    for (number, at) in profile.arguments.iter().enumerate() {
        let (value, sd) = (profile.values[number], profile.sd[number]);
        if sd > 0.0 && sd < 0.2 * largest {
            let off = (value - of(number, *at)).abs();
            assert!(off < 4.0 * sd + 0.1 * largest, "{value} +- {sd} at {at}");
            known += 1;
        }
    }
    known
}

#[test]
fn dry_friction_appears_as_residual_force_on_its_carriage() {
    let friction = |rate: f64, _: f64| -2.0 * (rate / 1e-4).tanh();
    let force = force_from_records(&friction);
    println!("{}", describe_residual_force(&force));
    assert_eq!(force.equations[force.best_equation].name, "q");
    let Some(ForceKind::Rate(parts)) = &force.kind else {
        panic!("{:?}", force.kind);
    };
    let SimpleTerm {
        value: size, sd, ..
    } = parts
        .iter()
        .find(|part| part.function == SimpleFunction::Sign)
        .expect("a sign");
    assert!((size + 2.0).abs() < 4.0 * sd && *sd < 0.2, "{size} +- {sd}");
    assert!(
        describe_residual_force(&force).contains("a force on q: "),
        "{}",
        describe_residual_force(&force)
    );
    let bends = force.rate.arguments.len() / 2;
    let side = |number: usize, _: f64| if number < bends { 2.0 } else { -2.0 };
    assert!(assert_matches(&force.rate, side, 2.0) >= bends);
}

/// With a weak nonlinear spring, the model is integrated by Runge-Kutta steps. Responses are computed by adding small
/// forces to the motion.
#[test]
fn nonlinear_model_gives_the_same_residual_force() {
    let stiffening = SPECIFICATION
        .replace(
            "[coordinates]",
            "b = { value = 1e-3, unit = \"N/m^3\" }\n\n[coordinates]",
        )
        .replace(
            "[dissipation]",
            "stiffening = \"1/4*b*p^4\"\n\n[dissipation]",
        );
    let friction = |rate: f64, _: f64| -2.0 * (rate / 1e-4).tanh();
    let (linear, other) = (
        force_from_records(&friction),
        residual_force_with(&friction, &stiffening),
    );
    assert_eq!(other.equations[other.best_equation].name, "q");
    let pairs = linear.rate.values.iter().zip(&other.rate.values);
    for ((a, b), sd) in pairs.zip(&linear.rate.sd) {
        // Both responses are of first order; they differ because steps end at different times near switches.
        assert!(
            *sd > 0.4 || (a - b).abs() < 0.04 + 0.5 * sd,
            "{a} {b} +- {sd}"
        );
    }
}

#[test]
fn spring_appears_as_residual_force_on_its_carriage() {
    let force = force_from_records(&|_, place| -40.0 * place);
    println!("{}", describe_residual_force(&force));
    assert_eq!(force.equations[force.best_equation].name, "q");
    let Some(ForceKind::Position(parts)) = &force.kind else {
        panic!("{:?}", force.kind);
    };
    let SimpleTerm {
        value: size, sd, ..
    } = parts
        .iter()
        .find(|part| part.function == SimpleFunction::Linear)
        .expect("a line");
    assert!(
        (size + 40.0).abs() < 4.0 * sd && *sd < 4.0,
        "{size} +- {sd}"
    );
    let largest = force
        .position
        .arguments
        .iter()
        .map(|at| 40.0 * at.abs())
        .fold(0.0, f64::max);
    assert!(assert_matches(&force.position, |_, at| -40.0 * at, largest) >= 5);
}

#[test]
fn complete_model_has_no_significant_residual_force() {
    let force = force_from_records(&|_, _| 0.0);
    assert_eq!(force.kind, None, "{}", describe_residual_force(&force));
    assert_eq!(
        describe_residual_force(&force),
        "No force in a single equation is significant."
    );
}
