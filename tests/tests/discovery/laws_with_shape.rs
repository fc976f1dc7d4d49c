//! Tests that force laws with a shape or a memory are found. The records are from hand-written equations that contain
//! these laws.

use eomgen_tests::program;
use eomgen_tests::runge_kutta::integrate;
use serde_json::Value;

/// Generator of approximately normal numbers: sums of twelve uniform numbers.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            sum += (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }
}

fn discover(specification: &str, dataset: &str, records: [String; 2]) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| std::fs::write(place(name), text).expect("a file");
    write("machine.toml", specification);
    write("dataset.toml", dataset);
    write("train.csv", &records[0]);
    write("test.csv", &records[1]);
    let paths = ["machine.toml", "dataset.toml", "found"].map(place);
    program::run_on_dataset("discover", paths.each_ref())
}

/// Asserts that only this effect is found, that its values are within a relative tolerance, and that it closes the gap.
fn assert_named(found: &Value, effect: &str, on: &str, sizes: &[(&str, f64)], tolerance: f64) {
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{found:#}");
    assert_eq!(effects[0]["effect"], effect, "{found:#}");
    assert_eq!(effects[0]["on"], on, "{found:#}");
    assert_eq!(effects[0]["status"], "named", "{found:#}");
    for (name, value) in sizes {
        let size = effects[0]["parameters"][name]["value"].as_f64();
        let size = size.expect("a number");
        assert!((size / value - 1.0).abs() < tolerance, "{name}: {size}");
    }
    let closed = found["closure"]["test"].as_f64().expect("a number");
    assert!(closed > 0.98, "{closed}");
}

const AXIS: &str = r#"
[model]
name = "hydraulic_axis"

[parameters]
m = { value = 45, unit = "kg" }
A = { value = 6e-4, unit = "m^2" }
E_V = { value = 4e12, unit = "Pa/m^3" }
K_v = { value = 6e-5, unit = "m^3/(s V)" }
C_l = { value = 3e-12, unit = "m^3/(s Pa)" }
b = { value = 600, unit = "N s/m" }

[coordinates]
x = { unit = "m" }

[inputs]
u = { unit = "V" }

[states]
p = { unit = "Pa", rate = "E_V*(K_v*u - A*dot(x) - C_l*p)" }

[kinetic]
load = "1/2*m*dot(x)^2"

[dissipation]
seals = "1/2*b*dot(x)^2"

[forces]
cylinder = { on = "x", value = "A*p" }
"#;

const AXIS_RECORDS: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.u]
column = "u"
unit = "V"

[channels.x]
column = "x"
unit = "m"
noise = 1e-5

[channels.p]
column = "p"
unit = "Pa"
noise = 2.5e4

[initial]
state = "rest"

[windows]
length = 0.5
"#;

fn axis_record(command: impl Fn(f64) -> f64, seed: u64) -> String {
    let (mut noise, mut state) = (Noise(seed), [0.0; 3]);
    let mut text = "t,u,x,p\n".to_owned();
    for sample in 0..500 {
        let t = 2e-3 * f64::from(sample);
        let u = command(t);
        let [x, _, p] = state;
        let (x, p) = (x + 1e-5 * noise.next(), p + 2.5e4 * noise.next());
        text += &format!("{t:.4},{u:.12e},{x:.10e},{p:.10e}\n");
        let acting = u - u.clamp(-0.22, 0.22);
        integrate(&mut state, 2e-3, 8, |[_, v, p]| {
            let flow = 6e-5 * acting - 6e-4 * v - 3e-12 * p;
            [*v, (6e-4 * p - 600.0 * v) / 45.0, 4e12 * flow]
        });
    }
    text
}

#[test]
fn valve_overlap_is_found() {
    let records = [
        axis_record(|t| 1.2 * (9.0 * t).sin() + 0.8 * (23.0 * t + 1.0).sin(), 1),
        axis_record(|t| 0.9 * (13.0 * t).cos() + 0.7 * (31.0 * t).sin(), 2),
    ];
    let found = discover(AXIS, AXIS_RECORDS, records);
    assert_named(&found, "input_dead_zone", "u", &[("u_0", 0.22)], 0.01);
    assert_curve_of_overlap(&found["curve"]);
}

/// The curve is the part of the command that the overlap of the valve suppresses.
fn assert_curve_of_overlap(curve: &Value) {
    assert_eq!(curve["variable"], "u", "{curve:#}");
    assert_eq!(curve["equation"], "u", "{curve:#}");
    let list = |key: &str| -> Vec<f64> {
        let list = curve[key].as_array().expect("a list");
        list.iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    let (knots, values) = (list("knots"), list("values"));
    assert_eq!(knots.len(), list("band").len());
    for (u, value) in knots.iter().zip(&values) {
        let right = -u.clamp(-0.22, 0.22);
        assert!((value - right).abs() < 0.04, "{u}: {value}, {right}");
    }
}

const STAGE: &str = r#"
[model]
name = "stage"

[parameters]
m = { value = 2.5, unit = "kg", min = 0 }
c = { value = 9, unit = "N s/m", min = 0 }

[coordinates]
x = { unit = "m" }

[inputs]
force = { unit = "N" }

[kinetic]
carriage = "1/2*m*dot(x)^2"

[dissipation]
guides = "1/2*c*dot(x)^2"

[forces]
motor = { on = "x", value = "force" }
"#;

const STAGE_RECORDS: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.force]
column = "F"
unit = "N"

[channels.x]
column = "x"
unit = "mm"
noise = 0.02

[initial]
state = "rest"

[windows]
length = 0.4
"#;

/// Returns a record of the stage. `friction` is the force as a function of the rate and of the deflection of bristles,
/// which yield within 0.15 mm.
fn stage_record(
    force: impl Fn(f64) -> f64,
    friction: impl Fn(f64, f64) -> f64,
    seed: u64,
) -> String {
    let (mut noise, mut state) = (Noise(seed), [0.0; 3]);
    let mut text = "t,F,x\n".to_owned();
    for sample in 0..160 {
        let t = 5e-3 * f64::from(sample);
        let push = force(t);
        let x = 1e3 * state[0] + 0.02 * noise.next();
        text += &format!("{t:.4},{push:.12e},{x:.8e}\n");
        integrate(&mut state, 5e-3, 50, |[_, v, z]| {
            [
                *v,
                (push - 9.0 * v - friction(*v, *z)) / 2.5,
                v - v.abs() * z / 1.5e-4,
            ]
        });
    }
    text
}

fn stage_records(friction: impl Fn(f64, f64) -> f64) -> [String; 2] {
    let train = |t: f64| 3.3 * (7.1 * t).sin() + 2.9 * (2.6 * t + 1.0).sin();
    let test = |t: f64| 2.4 * (5.2 * t + 0.5).sin() + 1.2 * (11.3 * t).sin();
    [
        stage_record(train, &friction, 1),
        stage_record(test, &friction, 2),
    ]
}

#[test]
fn dahl_friction_with_presliding_is_found() {
    let records = stage_records(|_, z| 1.8 * z / 1.5e-4);
    let found = discover(STAGE, STAGE_RECORDS, records);
    let sizes = [("T_b", 1.8), ("p_b", 1.5e-4)];
    assert_named(&found, "bristle_friction", "x", &sizes, 0.05);
}

/// Friction without memory could also be fitted by bristles that yield within a short distance.
#[test]
fn bristles_are_not_fitted_to_friction_without_memory() {
    let records = stage_records(|v, _| 1.8 * v / v.hypot(5e-3));
    let found = discover(STAGE, STAGE_RECORDS, records);
    assert_eq!(
        found["effects"][0]["effect"], "coulomb_friction",
        "{found:#}"
    );
    assert_eq!(found["effects"][0]["on"], "x", "{found:#}");
    let rejected = found["rejected"].as_array().expect("a list");
    let bristles = rejected.iter().find(|r| r["effect"] == "bristle_friction");
    let reason = bristles.expect("scanned bristles")["reason"].as_str();
    let reason = reason.expect("a text");
    assert!(reason.contains("in short segments"), "{reason}");
}

const SPRUNG: &str = r#"
[model]
name = "sprung"

[parameters]
m = { value = 2.5, unit = "kg", min = 0 }
c = { value = 9, unit = "N s/m", min = 0 }
k = { value = 250, unit = "N/m", min = 0 }

[coordinates]
x = { unit = "m" }

[inputs]
force = { unit = "N" }

[kinetic]
carriage = "1/2*m*dot(x)^2"

[potential]
spring = "1/2*k*x^2"

[dissipation]
guides = "1/2*c*dot(x)^2"

[forces]
motor = { on = "x", value = "force" }
"#;

/// Returns a record of a mass on a spring with a stop on one side. The standard deviation of the noise is 0.02 mm.
fn stop_record(force: impl Fn(f64) -> f64, (side, place): (f64, f64), seed: u64) -> String {
    let (mut noise, mut state) = (Noise(seed), [0.0; 2]);
    let mut text = "t,F,x\n".to_owned();
    for sample in 0..300 {
        let t = 5e-3 * f64::from(sample);
        let push = force(t);
        let x = 1e3 * state[0] + 0.02 * noise.next();
        text += &format!("{t:.4},{push:.12e},{x:.8e}\n");
        integrate(&mut state, 5e-3, 50, |[x, v]| {
            let stop = -side * 750.0 * f64::max(side * x - place, 0.0);
            [*v, (push - 9.0 * v - 250.0 * x + stop) / 2.5]
        });
    }
    text
}

/// The stop limits the motion on its side to much less than the largest distance from 0, which is on the other side.
#[test]
fn one_sided_stop_is_found_on_the_side_of_the_smaller_amplitude() {
    for stop in [(-1.0, 0.03), (-1.0, 0.02), (1.0, 0.03)] {
        let (side, place) = stop;
        let train = |t: f64| 9.0 * (8.1 * t).sin() + 5.0 * (15.0 * t + 1.0).sin();
        let test = |t: f64| 8.0 * (9.2 * t + 0.5).sin() + 4.0 * (17.3 * t).sin();
        let records = [stop_record(train, stop, 1), stop_record(test, stop, 2)];
        let found = discover(SPRUNG, STAGE_RECORDS, records);
        assert_named(
            &found,
            "end_stop",
            "spring",
            &[("k_s", 750.0), ("p_s", place)],
            0.05,
        );
        let term = found["effects"][0]["term"].as_str().expect("a term");
        assert!(
            term.contains(if side > 0.0 { "max(" } else { "min(" }),
            "{term}"
        );
    }
}
