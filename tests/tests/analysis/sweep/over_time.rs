//! Comparison of measures over time (`max`, `rms`, `final`) with closed forms of responses, impacts and pulses, and
//! with rows of `simulate`.

use std::f64::consts::SQRT_2;

use eomgen_compiled_model::{
    CompiledModel, Measurement, Motion, Orders, Quantity, Request, Solver, Statistic,
};
use eomgen_sweep::{Sweep, SweepRequest};
use eomgen_tests::models::{load, path};
use eomgen_tests::program::run_accepted;

use super::sweep_folder::{SweepFolder, accept, column, expect_rejection, table};

/// Returns the amplitude of the forced response, m.
fn amplitude(damping: f64, omega: f64) -> f64 {
    let (m, k, force) = (1.0, 4.0, 3.0);
    force / (k - m * omega * omega).hypot(damping * omega)
}

#[test]
fn forced_response_has_closed_form_amplitude() {
    let place = SweepFolder::new();
    let wide = ["--vary", "c=400:4000:4:log", "--vary", "omega=1:3:3"];
    let long = ["--transient", "60", "--periods", "3"];
    let measures = ["--measure", "max:x,rms:x,max:x_dot"];
    accept(&place.sweep("map", &[&wide[..], &long, &measures].concat()));
    let table = table(&place.path_to("map"));
    let (c, omega) = (column(&table, "c"), column(&table, "omega"));
    assert!(
        (c[3] / c[0] - 10.0_f64.powf(1.0 / 3.0)).abs() < 1e-14,
        "{c:?}"
    );
    assert_eq!(c.len(), 12);
    for point in 0..12 {
        let expected = amplitude(1e-3 * c[point], omega[point]);
        let near = |name: &str, right: f64, within: f64| {
            let found = column(&table, name)[point];
            assert!(
                (found / right - 1.0).abs() < within,
                "{name}: {found}, expected {right}"
            );
        };
        near("max:x", expected, 1e-9);
        near("max:x_dot", expected * omega[point], 1e-9);
        near("rms:x", expected / SQRT_2, 1e-8);
        assert_eq!(column(&table, "max:x_status")[point], 0.0);
    }
    for name in ["max_x", "rms_x", "max_x_dot"] {
        assert!(
            place
                .path_to("map")
                .join(format!("map_{name}.png"))
                .exists(),
            "{name}"
        );
    }
}

/// Several statistics of one motion are bit-identical to separate measurements and need one simulation.
#[test]
fn measures_of_one_motion_are_bit_identical_to_separate_measures() {
    let model = CompiledModel::derive(load("planetary_arm"), Orders::Declared).expect("a model");
    let run = model.with_declared_parameters().expect("values");
    let (times, inputs) = ([0.0, 0.1], run.default_inputs());
    let measurement = |quantity: Quantity, statistic: Statistic| Measurement {
        quantity,
        statistic,
        begin: 0.02,
        typical_size: model.typical_size(quantity),
    };
    let all = [
        measurement(Quantity::State(0), Statistic::Maximum),
        measurement(Quantity::State(0), Statistic::RootMeanSquare),
        measurement(Quantity::Observable(0), Statistic::RootMeanSquare),
    ];
    for solver in [Solver::Exact, Solver::Rk] {
        let request = Request {
            initial: run.initial_state(),
            times: &times,
            inputs: &inputs,
            solver,
            tolerance: 1e-9,
            max_step: f64::INFINITY,
            audit: false,
        };
        let measure = |own: &[Measurement]| {
            let motion = run.simulate_measured(&request, own, &mut |_| {});
            motion.expect("a motion")
        };
        let together = measure(&all);
        let alone = all.map(|own| measure(&[own]).measured[0].expect("a number").to_bits());
        let found = together
            .measured
            .iter()
            .map(|own| own.expect("a number").to_bits());
        assert_eq!(found.collect::<Vec<_>>(), alone, "{solver}");
        let work = |motion: &Motion| {
            let work = motion.trajectory.statistics;
            (work.steps, work.evaluations)
        };
        assert_eq!(work(&together), work(&measure(&all[..1])), "{solver}");
    }
}

/// Consecutive measures over time share one simulation of each point.
#[test]
fn sweep_simulates_each_point_once_for_all_measures_over_time() {
    let request = |measures: &[&str]| SweepRequest {
        vary: vec!["b_sp=10e-6:50e-6:2".to_owned()],
        measures: measures.iter().map(|name| (*name).to_owned()).collect(),
        until: Some(0.01),
        ..SweepRequest::default()
    };
    let counts = |measures: &[&str]| {
        let sweep = Sweep::new(&load("planetary_arm"), request(measures)).expect("a sweep");
        let found = sweep.measures().expect("measures");
        let described = found.iter().map(|own| own.describe().len());
        described.collect::<Vec<_>>()
    };
    assert_eq!(
        counts(&["max:x_sp", "rms:x_sp", "final:x_c", "max:tip"]),
        [4]
    );
    assert_eq!(counts(&["max:x_sp", "lyapunov", "rms:x_sp"]), [1, 1, 1]);
}

#[test]
fn measures_over_time_match_fine_grid() {
    let place = SweepFolder::new();
    let arm = path("planetary_arm").display().to_string();
    let (out, rows) = (place.path_to("arm"), place.path_to("arm.csv"));
    let [out, rows] = [out, rows].map(|path| path.display().to_string());
    run_accepted(&[
        "sweep",
        &arm,
        "--order",
        "2",
        "--vary",
        "b_sp=10e-6:50e-6:3",
        "--until",
        "0.3",
        "--measure",
        "max:tip,rms:tip,final:x_sp_dot",
        "--out",
        &out,
    ]);
    run_accepted(&[
        "simulate",
        &arm,
        "--order",
        "2",
        "--set",
        "b_sp=30e-6",
        "--until",
        "0.3",
        "--interval",
        "1e-5",
        "--out",
        &rows,
    ]);
    let text = std::fs::read_to_string(rows).expect("rows");
    let mut lines = text.lines().map(|line| line.split(','));
    let names: Vec<&str> = lines.next().expect("a header").collect();
    let numbers: Vec<Vec<f64>> = lines
        .map(|line| {
            line.map(|number| number.parse().expect("a number"))
                .collect()
        })
        .collect();
    let course = |name: &str| {
        let place = names
            .iter()
            .position(|known| *known == name)
            .expect("a column");
        numbers.iter().map(move |row| row[place])
    };
    let table = table(&place.path_to("arm"));
    let found = |name: &str| column(&table, name)[1];
    let near = |name: &str, right: f64, within: f64| {
        let found = found(name);
        assert!(
            (found / right - 1.0).abs() < within,
            "{name}: {found}, expected {right}"
        );
        assert!(right.abs() > 1e-6, "{name}: nothing moves");
    };
    near("max:tip", course("tip").fold(f64::MIN, f64::max), 1e-6);
    let last = course("x_sp_dot").next_back().expect("rows");
    // The parameter differs in the last bit, and meshes open and close.
    near("final:x_sp_dot", last, 1e-9);
    let squares: Vec<f64> = course("tip").map(|x| x * x).collect();
    let ends = 0.5 * (squares[0] + squares[30_000]);
    let rms = ((squares.iter().sum::<f64>() - ends) / 30_000.0).sqrt();
    near("rms:tip", rms, 1e-6);
}

/// Mass between two stiff walls. The term with `h` makes the model nonlinear, so that the exact solver is not used.
const STOPPED: &str = r#"
[model]
name = "stopped"
[parameters]
m = { value = 1, unit = "kg", min = 0 }
k = { value = 1e8, unit = "N/m" }
b = { value = 0.5, unit = "m" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
walls = "1/2*k*deadzone(x, b)^2"
[observables]
contact_force = "k*deadzone(x, b)"
"#;

const BALL: &str = r#"
[model]
name = "ball"
[parameters]
m = { value = 1, unit = "kg", min = 0 }
g = { value = 10, unit = "m/s^2" }
e = { value = 0.8, unit = "1" }
[coordinates]
y = { unit = "m", initial = 1.25 }
[kinetic]
mass = "1/2*m*dot(y)^2"
[potential]
weight = "m*g*y"
[impacts]
floor = { when = "y", restitution = "e" }
[observables]
fall = "-dot(y)"
"#;

const DAMPED: &str = r#"
[model]
name = "damped"
[parameters]
m = { value = 1, unit = "kg", min = 0 }
c = { value = 0.5, unit = "N s/m" }
k = { value = 4, unit = "N/m" }
F = { value = 1000, unit = "N" }
begin = { value = 1.2345, unit = "s" }
width = { value = 1e-5, unit = "s" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
drive = "u"
"#;

/// Adds a cubic spring of zero stiffness, so that only the general solvers support the model.
fn with_cubic_spring(specification: &str) -> String {
    let declared = "[parameters]\nh = { value = 0, unit = \"N/m^3\" }";
    let cubic = "[potential]\ncubic = \"1/4*h*x^4\"";
    specification
        .replace("[parameters]", declared)
        .replace("[potential]", cubic)
}

/// Runs a sweep of a specification and returns the columns of these measures.
fn sweep_columns(specification: &str, options: &[&str], measures: &[&str]) -> Vec<Vec<f64>> {
    let place = SweepFolder::new();
    let [spec, out] = ["own.toml", "map"].map(|name| place.path_to(name).display().to_string());
    std::fs::write(&spec, specification).expect("a specification");
    let asked = measures.join(",");
    let all = [
        &["sweep", &spec, "--out", &out, "--measure", &asked],
        options,
    ]
    .concat();
    run_accepted(&all);
    let table = table(&place.path_to("map"));
    let columns = measures.iter().map(|name| column(&table, name).to_vec());
    columns.collect()
}

fn assert_near(found: f64, right: f64, within: f64) {
    assert!(
        (found / right - 1.0).abs() < within,
        "{found}, expected {right}"
    );
}

#[test]
fn maximum_velocity_is_just_before_an_impact() {
    let options = ["--vary", "e=0.5:0.9:3", "--until", "1.2"];
    let found = sweep_columns(BALL, &options, &["max:fall", "max:y_dot", "rms:fall"]);
    for (point, e) in [0.5, 0.7, 0.9].into_iter().enumerate() {
        // The ball falls for 0.5 s to the speed 5 m/s, then rises with 5 e m/s.
        assert_near(found[0][point], 5.0, 1e-9);
        assert_near(found[1][point], 5.0 * e, 1e-9);
        let mut square = 5.0_f64.powi(3) / 30.0;
        let (mut rest, mut speed) = (0.7_f64, 5.0 * e);
        while rest > 0.0 {
            let flight = rest.min(0.2 * speed);
            square += (speed.powi(3) - (speed - 10.0 * flight).powi(3)) / 30.0;
            rest -= flight;
            speed *= e;
        }
        assert_near(found[2][point], (square / 1.2).sqrt(), 1e-8);
    }
}

#[test]
fn peak_force_of_a_stiff_contact_between_samples_is_measured() {
    let measures = ["max:contact_force", "rms:contact_force"];
    let options = [
        "--vary",
        "b=0.3:0.5:2",
        "--state",
        "x_dot=1",
        "--until",
        "0.8",
    ];
    for specification in [STOPPED.to_owned(), with_cubic_spring(STOPPED)] {
        let found = sweep_columns(&specification, &options, &measures);
        for (largest, rms) in found[0].iter().zip(&found[1]) {
            // The contact lasts half a period of 1e4 rad/s; the force has the amplitude v sqrt(k m).
            assert_near(*largest, 1e4, 1e-7);
            let square = 1e8 * 0.5 * std::f64::consts::PI * 1e-4;
            assert_near(*rms, (square / 0.8).sqrt(), 1e-7);
        }
        assert_eq!(found[0].len(), 2);
    }
}

#[test]
fn decaying_oscillation_and_narrow_pulse_have_closed_forms() {
    let (a, until) = (0.25_f64, 5.0_f64);
    let w = (4.0 - a * a).sqrt();
    // x = exp(-a t) (cos(w t) + a/w sin(w t)), from x = 1.
    let square = |t: f64| {
        let (cosine, sine) = ((2.0 * w * t).cos(), (2.0 * w * t).sin());
        let (p, q) = (1.0 - (a / w).powi(2), 2.0 * a / w);
        let decay = (-2.0 * a * t).exp();
        let mean = -(1.0 + (a / w).powi(2)) / (4.0 * a);
        let swing = p * (w * sine - a * cosine) - q * (w * cosine + a * sine);
        decay * (mean + swing / (4.0 * (a * a + w * w)))
    };
    let rms = ((square(until) - square(0.0)) / until).sqrt();
    // The rate has its maximum at tan(w t) = w/a.
    let greatest = 2.0 * (-a * (w / a).atan() / w).exp();
    let released = ["--vary", "F=1:2:2", "--state", "x=-1", "--until", "5"];
    let pulse = [
        "--vary",
        "F=1:2:2",
        "--input",
        "u=F*(above(t-begin)-above(t-begin-width))",
    ];
    let pulse = [&pulse[..], &["--until", "5"]].concat();
    for specification in [DAMPED.to_owned(), with_cubic_spring(DAMPED)] {
        let found = sweep_columns(&specification, &released, &["rms:x", "max:x_dot"]);
        assert_near(found[0][0], rms, 1e-8);
        assert_near(found[1][0], greatest, 1e-8);
        let found = sweep_columns(&specification, &pulse, &["max:drive", "rms:drive"]);
        for (point, force) in [1.0, 2.0].into_iter().enumerate() {
            assert_near(found[0][point], force, 1e-12);
            // The times of the jumps have rounding errors relative to the step, which is much longer than the pulse.
            assert_near(found[1][point], force * (1e-5_f64 / 5.0).sqrt(), 1e-7);
        }
    }
}

/// Undamped oscillator, x = sin t, and observables with narrow peaks at x = a.
const PEAKS: &str = r#"
[model]
name = "peaks"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 1, unit = "N/m" }
a = { value = 0.9, unit = "m" }
d = { value = 5, unit = "mm" }
[coordinates]
x = { unit = "m", initial_rate = 1 }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[observables]
penetration = "max(x - a, 0)"
beyond = "above(x - a)"
bell = "exp(-((x - a)/d)^2)"
steep = "(x/a)^200"
"#;

#[test]
fn narrow_peaks_between_steps_are_measured() {
    let options = ["--vary", "a=0.9:0.99:3", "--until", "6"];
    let measures = [
        "max:penetration",
        "rms:penetration",
        "max:beyond",
        "rms:beyond",
        "max:bell",
        "max:steep",
    ];
    for specification in [PEAKS.to_owned(), with_cubic_spring(PEAKS)] {
        let found = sweep_columns(&specification, &options, &measures);
        for (point, a) in [0.9_f64, 0.945, 0.99].into_iter().enumerate() {
            // x exceeds a over an angle of 2 `half`.
            let half = a.acos();
            let sine = half.sin();
            let square = half + sine * a - 4.0 * a * sine + 2.0 * a * a * half;
            assert!((found[0][point] - (1.0 - a)).abs() < 1e-7, "{found:?}");
            assert!(
                (found[1][point] - (square / 6.0).sqrt()).abs() < 1e-7,
                "{found:?}"
            );
            assert_eq!(found[2][point], 1.0);
            assert_near(found[3][point], (half / 3.0).sqrt(), 1e-6);
            assert_near(found[4][point], 1.0, 1e-7);
            assert_near(found[5][point], a.powi(-200), 1e-6);
        }
    }
}

#[test]
fn maxima_of_long_motions_do_not_depend_on_their_time() {
    let spec = DAMPED.replace(
        "drive = \"u\"",
        "drive = \"u\"\nsquare = \"x^2\"\nsize = \"abs(x)\"",
    );
    let measures = ["max:x", "max:square", "max:size", "max:x_dot"];
    let mut first: Option<Vec<f64>> = None;
    for until in ["8", "16", "31", "60", "177", "600"] {
        let options = ["--vary", "F=1:2:2", "--state", "x_dot=1", "--until", until];
        let found = sweep_columns(&spec, &options, &measures);
        let found: Vec<f64> = found.iter().map(|column| column[0]).collect();
        assert_near(found[1], found[0] * found[0], 1e-9);
        assert_near(found[2], found[0], 1e-9);
        assert_near(found[3], 1.0, 1e-12);
        for (one, other) in found.iter().zip(first.get_or_insert(found.clone())) {
            assert_near(*one, *other, 1e-9);
        }
    }
}

#[test]
fn invalid_measures_are_rejected() {
    let place = SweepFolder::new();
    for (more, what) in [
        (
            &["--measure", "max:y"][..],
            "no observable, coordinate or rate `y`",
        ),
        (&["--measure", "max:enrgy"], "`energy`"),
        (&["--measure", "mean:x"], "max:NAME"),
        (&["--measure", "max:x", "--until", "-1"], "--until"),
        (&["--measure", "max:x", "--until", "nan"], "--until"),
        (
            &["--measure", "max:x", "--frequency", "w"],
            "--frequency NAME",
        ),
        (&["--measure", "max:x,max:x", "--until", "1"], "`max:x`"),
    ] {
        let message =
            expect_rejection(&place.sweep("map", &[&["--vary", "k=1:2:2"][..], more].concat()));
        assert!(message.contains(what), "{more:?}: {message}");
    }
    for range in ["0:1:3:log", "-1:1:3:log", "1:2:3:lin", "1:2:3:4:5"] {
        let vary = format!("k={range}");
        let message =
            expect_rejection(&place.sweep("map", &["--vary", &vary, "--measure", "max:x"]));
        assert!(message.contains("FROM:TO:COUNT:log"), "{message}");
    }
}
