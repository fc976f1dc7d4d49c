//! Tests that results do not depend on the origin or the unit of the time. The records are closed-form motions of an
//! oscillator under piecewise constant forces and of a pendulum with given motion.

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program::{Texts, run_accepted, run_on_texts};
use serde_json::Value;

const OSCILLATOR: &str = r#"
[model]
name = "oscillator"
[parameters]
m = { value = 2, unit = "kg" }
c = { value = 0.4, unit = "N s/m" }
k = { value = 800, unit = "N/m" }
r = { value = 0.05, unit = "m" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[definitions]
turned = "x/r"
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
angle = "-turned"
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "UNIT"
[inputs.u]
column = "u"
unit = "N"
[channels.x]
column = "x"
unit = "mm"
noise = 0.01
[initial]
state = "rest"
[uncertain]
k = { relative = 0.05 }
[windows]
length = 1
"#;

/// Standard deviation of the noise of the position, in m.
const NOISE: f64 = 1e-5;

/// Sample times of a record, in ns.
#[derive(Clone, Copy)]
struct Times {
    origin: i128,
    step: i128,
    /// Unit of the time column, and its length in ns.
    unit: (&'static str, i128),
}

impl Times {
    const fn from_zero(step: i128) -> Self {
        Self {
            origin: 0,
            step,
            unit: ("s", 1_000_000_000),
        }
    }

    /// Returns the time of a sample as decimal text.
    fn write(&self, sample: i128) -> String {
        let (t, (_, unit)) = (self.origin + sample * self.step, self.unit);
        let decimals = unit.ilog10() as usize;
        match decimals {
            0 => t.to_string(),
            _ => format!("{}.{:0decimals$}", t / unit, t % unit),
        }
    }
}

/// Returns position and speed after a time under a constant force.
fn swing([x, v]: [f64; 2], force: f64, time: f64) -> [f64; 2] {
    let (m, c, k) = (2.0, 0.4, 800.0);
    let decay = c / (2.0 * m);
    let turn = f64::sqrt(k / m - decay * decay);
    let (sin, cos) = (turn * time).sin_cos();
    let (a, shrink) = (x - force / k, (-decay * time).exp());
    let b = (v + decay * a) / turn;
    [
        force / k + shrink * (a * cos + b * sin),
        shrink * ((b * turn - decay * a) * cos - (a * turn + decay * b) * sin),
    ]
}

/// Returns a record of t, u, x in mm, and the counts of an angular encoder with 1024 values.
fn oscillator_record(
    times: Times,
    samples: i128,
    seed: f64,
    write: &dyn Fn(i128) -> String,
) -> String {
    let mut noise = LogisticNoise::new(NOISE, 0.21 + 0.05 * seed);
    let (mut state, mut text) = ([0.0; 2], "t,u,x,n\n".to_owned());
    for sample in 0..samples {
        let t = (sample * times.step) as f64 * 1e-9;
        let waves =
            [1.3, 2.1, 4.7].map(|f: f64| 4.0 * (std::f64::consts::TAU * f * t + seed * f).sin());
        let u = waves.iter().sum::<f64>();
        let x = state[0] + noise.draw();
        let counts = (-x / 0.05 * 1e5 / std::f64::consts::TAU)
            .round()
            .rem_euclid(1024.0);
        text += &format!("{},{u:?},{:.6},{counts}\n", write(sample), 1e3 * x);
        state = swing(state, u, times.step as f64 * 1e-9);
    }
    text
}

fn compare_oscillator(
    dataset: &str,
    times: Times,
    samples: i128,
    write: &dyn Fn(i128) -> String,
) -> Value {
    run_on_texts(
        "compare",
        Texts {
            specification: OSCILLATOR,
            dataset: &dataset.replace("UNIT", times.unit.0),
            train: &oscillator_record(times, samples, 1.0, write),
            test: &oscillator_record(times, samples, 2.0, write),
        },
    )
}

fn estimate(document: &Value, parameter: &str) -> [f64; 2] {
    let found = &document["refitted"][parameter];
    ["value", "sd"].map(|key| found[key].as_f64().expect("a number"))
}

/// Asserts that two comparisons agree to within a hundredth of a standard deviation.
fn assert_same(one: &Value, other: &Value, parameters: &[&str], what: &str) {
    assert_eq!(one["verdict"], "no_significant_gap", "{what} {one:#}");
    assert_eq!(one["verdict"], other["verdict"], "{what} {other:#}");
    for parameter in parameters {
        let ([a, sd], [b, _]) = (estimate(one, parameter), estimate(other, parameter));
        assert!(
            (a - b).abs() < 0.01 * sd,
            "{what}: {parameter} {a} {b} +- {sd}"
        );
    }
}

/// Units of the time, with their length in ns.
const UNITS: [(&str, i128); 4] = [
    ("s", 1_000_000_000),
    ("ms", 1_000_000),
    ("us", 1_000),
    ("ns", 1),
];

/// Origins in s: the start, a machine's clock, and Unix times.
const ORIGINS: [i128; 4] = [0, 30_000_000, 1_700_000_000, 4_000_000_000];

#[test]
fn estimates_do_not_depend_on_origin_and_unit_of_time() {
    let mut drawn = LogisticNoise::new(1.0, 0.37);
    for step in [5_000_000, 2_500_000] {
        let usual = Times::from_zero(step);
        let right = compare_oscillator(DATASET, usual, 1500, &|k| usual.write(k));
        let [k, sd] = estimate(&right, "k");
        assert!((k - 800.0).abs() < 4.0 * sd, "{k} +- {sd}");
        for unit in UNITS {
            for origin in ORIGINS {
                let more = (drawn.draw().abs() * 1e8) as i128 * 10;
                let times = Times {
                    origin: origin * 1_000_000_000 + more,
                    step,
                    unit,
                };
                let found = compare_oscillator(DATASET, times, 1500, &|k| times.write(k));
                assert_same(
                    &right,
                    &found,
                    &["k"],
                    &format!("{} {}", times.write(0), unit.0),
                );
            }
        }
    }
}

#[test]
fn rounded_doubles_of_even_times_are_even() {
    let usual = Times::from_zero(3_000_000);
    let right = compare_oscillator(DATASET, usual, 1500, &|k| usual.write(k));
    for origin in [1.7e9 + 0.123_456, 1.7e9] {
        let of = move |sample: i128| origin + sample as f64 * 0.003;
        let printed = compare_oscillator(DATASET, usual, 1500, &|k| format!("{:.18e}", of(k)));
        assert_same(&right, &printed, &["k"], "all digits");
        let shortest = compare_oscillator(DATASET, usual, 1500, &|k| of(k).to_string());
        assert_same(&right, &shortest, &["k"], "shortest digits");
    }
}

#[test]
fn parts_of_a_file_use_the_time_of_the_file() {
    let usual = Times::from_zero(5_000_000);
    let part = |from: &str, to: &str| {
        DATASET.replace(
            "[\"train.csv\"]",
            &format!("[{{ file = \"train.csv\", from = {from}, to = {to} }}]"),
        )
    };
    let right = compare_oscillator(&part("0.5", "6.5"), usual, 1500, &|k| usual.write(k));
    let times = Times {
        origin: 1_700_000_000_000_000_000,
        unit: UNITS[1],
        ..usual
    };
    let dataset = part("1700000000500", "1700000006500");
    let found = compare_oscillator(&dataset, times, 1500, &|k| times.write(k));
    assert_same(&right, &found, &["k"], "part");
}

const PENDULUM: &str = r#"
[model]
name = "pendulum"
[parameters]
J = { value = 0.12, unit = "kg m^2" }
c = { value = 0.2, unit = "N m s" }
w = { value = 2, unit = "N m" }
[coordinates]
q = { unit = "rad" }
[inputs]
tau = { unit = "N m" }
[kinetic]
turning = "1/2*J*dot(q)^2"
[potential]
weight = "-w*cos(q)"
[dissipation]
bearing = "1/2*c*dot(q)^2"
[forces]
motor = { on = "q", value = "tau" }
"#;

const GIVEN_MOTION: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "UNIT"
[motion.q]
column = "q"
unit = "rad"
[channels.torque]
column = "tau"
unit = "N m"
noise = 0.02
observable = "tau"
gain = { sd = 0 }
bias = { sd = 0 }
delay = { sd = 0 }
[uncertain]
J = { relative = 0.05 }
c = { relative = 0.05 }
w = { relative = 0.05 }
"#;

/// Returns a record of t, q and tau.
fn pendulum_record(samples: i128, seed: f64, write: &dyn Fn(i128) -> String) -> String {
    let mut noise = LogisticNoise::new(0.02, 0.3 + 0.1 * seed);
    let mut text = "t,q,tau\n".to_owned();
    for sample in 0..samples {
        let t = 0.002 * sample as f64;
        let [mut q, mut v, mut a] = [0.0; 3];
        for (f, size) in [(0.4, 1.2), (0.9, 0.5), (1.7, 0.25)] {
            let rate = std::f64::consts::TAU * f;
            let (sin, cos) = (rate * t + seed * f).sin_cos();
            q += size * sin;
            v += size * rate * cos;
            a -= size * rate * rate * sin;
        }
        let tau = 0.12 * a + 0.2 * v + 2.0 * q.sin() + noise.draw();
        text += &format!("{},{q:.12},{tau:.8}\n", write(sample));
    }
    text
}

#[test]
fn given_motion_does_not_depend_on_origin_and_unit_of_time() {
    let compare = |unit: &str, write: &dyn Fn(i128) -> String| {
        run_on_texts(
            "compare",
            Texts {
                specification: PENDULUM,
                dataset: &GIVEN_MOTION.replace("UNIT", unit),
                train: &pendulum_record(2000, 1.0, write),
                test: &pendulum_record(2000, 2.0, write),
            },
        )
    };
    let usual = Times::from_zero(2_000_000);
    let right = compare("s", &|k| usual.write(k));
    for unit in UNITS {
        let times = Times {
            origin: 1_712_345_678_912_000_000,
            unit,
            ..usual
        };
        let found = compare(unit.0, &|k| times.write(k));
        assert_same(&right, &found, &["J", "c", "w"], unit.0);
    }
    // The logger accumulates the time in doubles and misses rows.
    let added = |k: i128| 1.7e9 + 0.002 * (k + 40 * i128::from(k > 900)) as f64;
    let found = compare("s", &|k| format!("{:.18e}", added(k)));
    let jumping = |k: i128| format!("{:.3}", 0.002 * (k + 40 * i128::from(k > 900)) as f64);
    assert_same(&compare("s", &jumping), &found, &["J", "c", "w"], "doubles");
}

#[test]
fn wrapped_observable_starts_on_the_branch_of_the_initial_state() {
    // Depending on the noise, the counter starts just below 0 or at a few counts.
    let dataset = DATASET.replace(
        "[initial]",
        "[channels.angle]\ncolumn = \"n\"\nunit = \"1\"\nwrap = 1024\nnoise = 4\n\
         gain = { mean = 15915.494309189535, sd = 0 }\n[initial]",
    );
    let times = Times::from_zero(1_000_000);
    for offset in [0.0, 1000.0, 500.0] {
        let shifted = |text: String| {
            let lines = text.lines().map(|line| match line.rsplit_once(',') {
                Some((others, count)) if !line.starts_with('t') => {
                    let count: f64 = count.parse().expect("a count");
                    format!("{others},{}\n", (count + offset).rem_euclid(1024.0))
                }
                _ => format!("{line}\n"),
            });
            lines.collect::<String>()
        };
        let zero = format!("bias = {{ mean = {offset:.1}, sd = 0 }}\n[initial]");
        let found = run_on_texts(
            "compare",
            Texts {
                specification: OSCILLATOR,
                dataset: &dataset.replace("UNIT", "s").replace("[initial]", &zero),
                train: &shifted(oscillator_record(times, 3000, 1.0, &|k| times.write(k))),
                test: &shifted(oscillator_record(times, 3000, 2.0, &|k| times.write(k))),
            },
        );
        assert_eq!(found["verdict"], "no_significant_gap", "{offset} {found:#}");
    }
}

#[test]
fn thirty_samples_per_period_are_sufficient() {
    // The natural frequency is 3.2 Hz, the input contains frequencies up to 4.7 Hz, and the sampling rate is 1 kHz.
    let times = Times::from_zero(1_000_000);
    for every in [2, 5, 7] {
        let dataset = DATASET.replace(
            "unit = \"UNIT\"",
            &format!("unit = \"UNIT\"\nevery = {every}"),
        );
        let found = compare_oscillator(&dataset, times, 6000, &|k| times.write(k));
        assert_eq!(found["verdict"], "no_significant_gap", "{every} {found:#}");
        let [k, sd] = estimate(&found, "k");
        assert!((k - 800.0).abs() < 4.0 * sd, "{every}: {k} +- {sd}");
    }
}

#[test]
fn simulation_reaches_the_last_sample_of_a_record_with_unix_times() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(place("spec.toml"), OSCILLATOR).expect("a file");
    for unit in &UNITS[..3] {
        let times = Times {
            origin: 1_700_000_000_000_000_000,
            step: 5_000_000,
            unit: *unit,
        };
        let record = oscillator_record(times, 1200, 1.0, &|k| times.write(k));
        std::fs::write(place("train.csv"), record).expect("a file");
        std::fs::write(place("dataset.toml"), DATASET.replace("UNIT", unit.0)).expect("a file");
        for more in [
            &["--interval", "0.005"][..],
            &[],
            &["--until", "1700000005.995"],
        ] {
            let (spec, dataset, out) = (place("spec.toml"), place("dataset.toml"), place("a.csv"));
            let fixed = ["simulate", &spec, "--record", &dataset, "--out", &out];
            run_accepted(&[&fixed[..], more].concat());
            let table = std::fs::read_to_string(&out).expect("a table");
            assert_eq!(table.lines().count(), 1201, "{} {more:?}", unit.0);
        }
    }
}
