//! Test that the errors of fixed steps do not bias the estimates of a fit, for any small noise.

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
name = "chain"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 400, unit = "N/m" }
c = { value = 1, unit = "N s/m" }
k_3 = { value = 1e5, unit = "N/m^3" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
masses = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
springs = "1/2*k*x^2 + 1/2*k*(y - x)^2 + 1/4*k_3*(y - x)^4"
[dissipation]
dampers = "1/2*c*dot(x)^2 + 1/2*c*(dot(y) - dot(x))^2"
[forces]
push = { on = "x", value = "u" }
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
[channels.x]
column = "x"
unit = "m"
noise = 2e-6
[channels.y]
column = "y"
unit = "m"
noise = 2e-6
[uncertain]
k_3 = { relative = 10 }
[windows]
length = 0.5
"#;

const NOISE_M: f64 = 2e-6;
const SAMPLE_S: f64 = 0.0025;
/// Cubic stiffness of the machine, N/m^3.
const CUBIC_STIFFNESS: f64 = 2e6;

/// Returns the rates of the two masses.
fn rates([x, y, dx, dy]: [f64; 4], u: f64) -> [f64; 4] {
    let deflection = y - x;
    let force = 400.0 * deflection + CUBIC_STIFFNESS * deflection.powi(3) + (dy - dx);
    [dx, dy, u - 400.0 * x - dx + force, -force]
}

/// Returns a record from rest by classical Runge-Kutta steps. The input grows from zero.
fn simulate_record(normal: &mut NormalNumbers, turn: f64) -> String {
    let mut state = [0.0; 4];
    let mut text = "t,u,x,y\n".to_owned();
    for number in 0..1001 {
        let t = SAMPLE_S * f64::from(number);
        let u = 8.0 * t.min(1.0) * ((15.0 * t + turn).cos() - 0.8 * (37.0 * t + turn).sin());
        let [x, y] = [0, 1].map(|place| state[place] + NOISE_M * normal.draw());
        writeln!(text, "{t:.4},{u:.12},{x:.12},{y:.12}").expect("a text");
        integrate(&mut state, SAMPLE_S, 20, |state| rates(*state, u));
    }
    text
}

#[test]
fn cubic_spring_with_low_noise_is_estimated_without_bias() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut normal = NormalNumbers::new(77);
    for (name, turn) in [("train.csv", 0.3), ("test.csv", 1.7)] {
        let text = simulate_record(&mut normal, turn);
        fs::write(folder.path().join(name), text).expect("a file");
    }
    let path = folder.path().join("dataset.toml");
    fs::write(&path, DATASET).expect("a file");
    let source = Source::new("chain.toml", SPECIFICATION);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let dataset = read_dataset(&path, &model).unwrap_or_else(|refusal| panic!("{refusal}"));
    let problem = EstimationProblem::new(&dataset, None, "chain.toml", SPECIFICATION);
    let fit = fit_null_model(&problem, SPECIFICATION).expect("a fit");
    let kind = UnknownKind::Parameter("k_3".to_owned());
    let mut unknowns = fit.unknowns();
    let found = unknowns.find(|(_, unknown)| unknown.kind == kind);
    let (id, _) = found.expect("a parameter");
    let error = (fit.train.estimate.theta[id] - CUBIC_STIFFNESS) / fit.sd[id];
    assert!(error.abs() < 3.0, "{error} standard deviations");
    for (records, rms) in [("training", fit.train.rms), ("test", fit.test.rms)] {
        assert!(rms < 1.03, "{records}: {rms}");
    }
}
