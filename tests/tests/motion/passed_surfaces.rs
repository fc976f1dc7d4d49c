//! Tests of a mass thrown at a narrow disc. A solver must not step over the disc with any step size.

use eomgen_compiled_model::{CompiledModel, Motion, Orders, Request, Solver};

const FLIGHT: &str = r#"
[model]
name = "throw"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
r = { value = 0.1, unit = "m" }
a = { value = 0, unit = "m" }
b = { value = 0, unit = "m" }
k = { value = 1e5, unit = "N/m" }
[coordinates]
x = { unit = "m" }
y = { unit = "m" }
[kinetic]
t = "1/2*m*(dot(x)^2 + dot(y)^2)"
"#;

const POTENTIAL: &str = r#"
[potential]
weight = "m*g*y"
"#;

/// Disc as an impact, and elastic discs.
const DISCS: [&str; 3] = [
    "[impacts]\nhit = { when = \"norm([x - a, y - b]) - r\", restitution = 1 }\n",
    "disc = \"1/2*k*min(sqrt((x - a)^2 + (y - b)^2) - r, 0)^2\"\n",
    "disc = \"1/2*k*max(r - norm([x - a, y - b]), 0)^2\"\n",
];

/// Random throw: initial speeds, position and radius of the disc.
struct Throw {
    speeds: [f64; 2],
    disc: [f64; 2],
    radius: f64,
    /// Smallest distance between the trajectory and the surface of the disc.
    least: f64,
    /// Time of the first contact; `None` if the mass misses the disc.
    contact: Option<f64>,
}

const DURATION: f64 = 2.0;

impl Throw {
    fn new(number: u32) -> Self {
        let random = |k: f64| (f64::from(number + 1) * k).fract();
        let speeds = [20.0 * random(0.618_034) + 1.0, 30.0 * random(0.732_051)];
        let flight = |t: f64| [speeds[0] * t, speeds[1] * t - 0.5 * 9.81 * t * t];
        let near = flight(DURATION * (0.1 + 0.8 * random(0.414_214)));
        let radius = 1e-3 * 300.0_f64.powf(random(0.259_921));
        let turn = std::f64::consts::TAU * random(0.442_25);
        let aside = 1.6 * radius * random(0.709_976);
        let disc = [near[0] + aside * turn.cos(), near[1] + aside * turn.sin()];
        let gap = |t: f64| {
            let [x, y] = flight(t);
            (x - disc[0]).hypot(y - disc[1]) - radius
        };
        let times = (0..=400_000).map(|k| DURATION * f64::from(k) / 4e5);
        let least = times.clone().map(gap).fold(f64::INFINITY, f64::min);
        let contact = times.clone().find(|t| gap(*t) < 0.0).map(|late| {
            let (mut early, mut late) = (late - DURATION / 4e5, late);
            for _ in 0..60 {
                let middle = 0.5 * (early + late);
                match gap(middle) < 0.0 {
                    true => late = middle,
                    false => early = middle,
                }
            }
            late
        });
        Self {
            speeds,
            disc,
            radius,
            least,
            contact,
        }
    }

    fn simulate(&self, model: &CompiledModel, solver: Solver, tolerance: f64) -> Motion {
        let values = [("r", self.radius), ("a", self.disc[0]), ("b", self.disc[1])];
        let run = model.with_parameters(&values).expect("parameters");
        let initial = [0.0, 0.0, self.speeds[0], self.speeds[1]];
        let inputs = run.default_inputs();
        let request = Request {
            initial: &initial,
            times: &[0.0, DURATION],
            inputs: &inputs,
            solver,
            tolerance,
            max_step: f64::INFINITY,
            audit: false,
        };
        let motion = run.simulate_until_stop(&request, &mut |_| {});
        motion.expect("a motion")
    }
}

#[test]
fn no_throw_passes_through_disc() {
    let mut hits = 0;
    for (kind, disc) in DISCS.iter().enumerate() {
        let text = format!("{FLIGHT}{POTENTIAL}{disc}");
        let model = CompiledModel::from_text("throw.toml", &text, Orders::Declared)
            .unwrap_or_else(|error| panic!("{error}"));
        for number in 0..70 {
            let throw = Throw::new(number);
            if throw.least.abs() < 1e-5 {
                continue;
            }
            hits += usize::from(throw.contact.is_some());
            for (solver, tolerance) in [
                (Solver::Rk, 1e-9),
                (Solver::Rk, 1e-6),
                (Solver::Radau, 1e-9),
            ] {
                let motion = throw.simulate(&model, solver, tolerance);
                let case = format!("disc {kind}, throw {number}, {solver:?} at {tolerance:e}");
                assert!(
                    motion.early_stop.is_none(),
                    "{case}: {:?}",
                    motion.early_stop
                );
                let first = motion.trajectory.events.first().map(|switch| switch.t);
                match (throw.contact, first) {
                    (None, None) => {}
                    (Some(expected), Some(t)) => {
                        assert!(
                            (t - expected).abs() < 1e3 * tolerance,
                            "{case}: {t} {expected}"
                        );
                    }
                    other => panic!("{case}: {other:?}, least distance {:e}", throw.least),
                }
            }
        }
    }
    assert!(hits > 90, "{hits} hits");
}
