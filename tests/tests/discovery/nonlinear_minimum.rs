//! Test that a fit of a nonlinear model converges to the minimum of the cost and reports the standard deviations at the
//! minimum.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;

use eomgen_discover::fit::null_model::fit_null_model;
use eomgen_discover::model::problem::EstimationProblem;
use eomgen_discover::model::unknowns::UnknownKind;
use eomgen_model_spec::source::Source;
use eomgen_records::read_dataset;
use eomgen_tests::random_numbers::NormalNumbers;
use eomgen_tests::runge_kutta::integrate;

const SPECIFICATION: &str = r#"
[model]
name = "beam"
[parameters]
EI = { value = 0.5, unit = "N m^2" }
c = { value = 0.8, unit = "N s/m^2" }
k_3 = { value = 4000, unit = "N/m^3" }
mu = { value = 1, unit = "kg/m" }
l = { value = 1, unit = "m" }
[fields.w]
along = "s"
from = 0
to = "l"
basis = "pinned_pinned"
coordinates = "q"
order = 3
unit = "m"
[inputs]
u = { unit = "N" }
[kinetic]
beam = "integral(1/2*mu*dot(w)^2, w)"
[potential]
beam = "integral(1/2*EI*diff(w, s, 2)^2, w)"
spring = "1/4*k_3*at(w, l/2)^4"
[dissipation]
beam = "integral(1/2*c*dot(w)^2, w)"
[forces]
push = { on = "at(w, l/3)", value = "u" }
[observables]
middle = "at(w, l/2)"
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[inputs.u]
column = "u"
unit = "N"
[channels.middle]
column = "middle"
unit = "m"
noise = 0.01
gain = { sd = 0 }
bias = { sd = 0 }
delay = { sd = 0 }
[uncertain]
EI = { relative = 0.5 }
c = { relative = 0.5 }
k_3 = { relative = 0.5 }
[windows]
length = "record"
"#;

const NOISE: f64 = 0.01;
const SAMPLE: f64 = 0.01;

/// Returns the rates of three modes of a beam with EI = 0.3 N m^2, c = 0.3 N s/m^2 and k_3 = 8000 N/m^3.
fn rates(state: [f64; 6], u: f64) -> [f64; 6] {
    let middle = state[0] - state[2];
    let acceleration = |mode: usize| {
        let number = mode as f64 + 1.0;
        let shape_at_middle = [1.0, 0.0, -1.0][mode];
        let force = u * (number * PI / 3.0).sin() - 8000.0 * middle.powi(3) * shape_at_middle;
        2.0 * force - 0.3 * (number * PI).powi(4) * state[mode] - 0.3 * state[mode + 3]
    };
    let [a, b, c] = [0, 1, 2].map(acceleration);
    [state[3], state[4], state[5], a, b, c]
}

/// Returns a record from rest by classical Runge-Kutta steps.
fn simulate_record(normal: &mut NormalNumbers, turn: f64) -> String {
    let mut state = [0.0; 6];
    let mut text = "t,u,middle\n".to_owned();
    for number in 0..600 {
        let t = SAMPLE * f64::from(number);
        let u = 8.0 * ((5.0 * t + turn).cos() - 0.6 * (13.0 * t + turn).sin());
        let measured = state[0] - state[2] + NOISE * normal.draw();
        writeln!(text, "{t:.3},{u:.12},{measured:.12}").expect("a text");
        integrate(&mut state, SAMPLE, 20, |state| rates(*state, u));
    }
    text
}

#[test]
fn weakly_determined_parameters_of_a_beam_reach_the_minimum() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut normal = NormalNumbers::new(4242);
    for (name, turn) in [("train.csv", 0.3), ("test.csv", 1.7)] {
        let text = simulate_record(&mut normal, turn);
        fs::write(folder.path().join(name), text).expect("a file");
    }
    let path = folder.path().join("dataset.toml");
    fs::write(&path, DATASET).expect("a file");
    let source = Source::new("beam.toml", SPECIFICATION);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let dataset = read_dataset(&path, &model).unwrap_or_else(|refusal| panic!("{refusal}"));
    let problem = EstimationProblem::new(&dataset, None, "beam.toml", SPECIFICATION);
    let fit = fit_null_model(&problem, SPECIFICATION).expect("a fit");
    // The expected minimum is from Gauss-Newton steps with the simulation that generated the record.
    let expected = [
        ("EI", 0.299721, 6.1519e-4),
        ("c", 0.286236, 9.3425e-3),
        ("k_3", 7970.897, 50.0006),
    ];
    let expected = expected.map(|(name, value, sd)| {
        let kind = UnknownKind::Parameter(name.to_owned());
        let mut unknowns = fit.unknowns();
        let found = unknowns.find(|(_, unknown)| unknown.kind == kind);
        (found.expect("a parameter").0, name, value, sd)
    });
    for (id, name, value, sd) in expected {
        let error = (fit.train.estimate.theta[id] - value) / sd;
        assert!(error.abs() < 0.08, "{name}: {error} standard deviations");
        let ratio = fit.sd[id] / sd;
        assert!((ratio - 1.0).abs() < 0.02, "{name}: {ratio}");
    }
}
