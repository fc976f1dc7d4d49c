//! Comparison with closed forms for a body with dry friction that a closed contact moves or stops. The body must not
//! remain sticking after its speed crosses zero together with the contact, or after the speed of the belt below it
//! crosses zero.

use std::f64::consts::PI;

use eomgen_compiled_model::{CompiledModel, Orders, Request, Solver};
use eomgen_tests::random_numbers::Numbers;

const SOLVERS: [Solver; 3] = [Solver::Auto, Solver::Rk, Solver::Radau];

/// Block on rough ground that is pressed against a wall. The wall or the ground oscillates with amplitude `a` (m or
/// m/s) and angular frequency `w`.
struct Block {
    mass: f64,
    pressure: f64,
    friction: f64,
    amplitude: f64,
    frequency: f64,
    /// Expression of the wall's position.
    wall: &'static str,
    /// Expression of the ground's speed.
    ground: &'static str,
}

impl Block {
    fn text(&self, length: f64) -> String {
        let Self {
            mass,
            pressure,
            friction,
            amplitude,
            frequency,
            wall,
            ground,
        } = self;
        format!(
            r#"
[model]
name = "block"
[parameters]
m = {{ value = {mass}, unit = "kg" }}
P = {{ value = {pressure}, unit = "N" }}
F = {{ value = {friction}, unit = "N" }}
a = {{ value = {amplitude}, unit = "m" }}
w = {{ value = {frequency}, unit = "1/s" }}
r = {{ value = {length}, unit = "m" }}
[coordinates]
x = {{ unit = "1" }}
[kinetic]
k = "1/2*m*r^2*dot(x)^2"
[forces]
press = {{ on = "x", value = "-P*r" }}
rub = {{ on = "x", value = "-F*r*sign(r*dot(x) - {ground})" }}
[impacts]
wall = {{ when = "r*x - {wall}", restitution = 0 }}
"#
        )
    }

    /// Compares the motion from rest with the expected positions of the block in m. The unit of the coordinate is
    /// `length` m.
    fn compare(&self, length: f64, until: f64, wanted: impl Fn(f64) -> f64) {
        let text = self.text(length);
        let model = CompiledModel::from_text("block.toml", &text, Orders::Declared);
        let model = model.unwrap_or_else(|error| panic!("{error}"));
        let run = model.with_declared_parameters().expect("an instance");
        let times: Vec<f64> = (0..=50).map(|k| until * f64::from(k) / 50.0).collect();
        let largest = times.iter().map(|t| wanted(*t).abs()).fold(0.0, f64::max);
        for solver in SOLVERS {
            let request = Request {
                initial: run.initial_state(),
                times: &times,
                inputs: &run.default_inputs(),
                solver,
                tolerance: 1e-10,
                max_step: f64::INFINITY,
                audit: true,
            };
            let motion = run.simulate_until_stop(&request, &mut |_| {});
            let motion = motion.expect("a motion");
            assert_eq!(motion.early_stop, None, "{solver}: {text}");
            for (t, state) in times.iter().zip(&motion.trajectory.states) {
                let error = (length * state[0] - wanted(*t)).abs();
                assert!(
                    error <= 1e-7 * largest,
                    "{solver}, {t} s: {error:.1e} m of {largest:.1e} m: {text}"
                );
            }
            let audit = motion.audit.expect("an audit");
            assert!(!audit.has_failed(), "{solver}: {audit:?} {text}");
        }
    }
}

/// Draws random blocks with this ratio of pressing force to friction.
fn draw_blocks(
    seed: u64,
    [least, most]: [f64; 2],
    (wall, ground): (&'static str, &'static str),
) -> impl Iterator<Item = Block> {
    let mut random = Numbers(seed);
    (0..12).map(move |_| {
        let mut draw = |low: f64, high: f64| low + 0.5 * (high - low) * (1.0 + random.symmetric());
        let friction = draw(1.0, 8.0);
        Block {
            mass: draw(0.3, 3.0),
            pressure: friction * draw(least, most),
            friction,
            amplitude: draw(0.05, 0.5),
            frequency: draw(2.0, 9.0),
            wall,
            ground,
        }
    })
}

const LENGTHS: [f64; 3] = [1.0, 1e-3, 1e3];

#[test]
fn block_stays_at_rest_when_the_wall_reverses() {
    let blocks = draw_blocks(41, [0.1, 0.9], ("a*sin(w*t)", "0*a*w"));
    for (block, length) in blocks.zip(LENGTHS.into_iter().cycle()) {
        let Block {
            amplitude,
            frequency,
            ..
        } = block;
        let turn = 0.5 * PI / frequency;
        // While the wall decelerates, the block must not leave it.
        let slows_faster = (block.pressure + block.friction) / block.mass;
        if amplitude * frequency.powi(2) < slows_faster {
            block.compare(length, 4.0 * turn, |t| {
                amplitude * (frequency * t.min(turn)).sin()
            });
        }
    }
}

#[test]
fn reversing_belt_moves_the_block_away_from_the_wall() {
    let blocks = draw_blocks(42, [0.1, 0.9], ("0*a", "-a*w*sin(w*t)"));
    for (block, length) in blocks.zip(LENGTHS.into_iter().cycle()) {
        let Block {
            amplitude,
            frequency,
            ..
        } = block;
        let turn = PI / frequency;
        let acceleration = (block.friction - block.pressure) / block.mass;
        // For some time the block is slower than the belt.
        let until = turn + 0.1 / frequency;
        if acceleration < 0.9 * amplitude * frequency.powi(2) {
            block.compare(length, until, |t| {
                0.5 * acceleration * (t - turn).max(0.0).powi(2)
            });
        }
    }
}

#[test]
fn smoothly_starting_belt_moves_the_block_away_from_the_wall() {
    let blocks = draw_blocks(43, [0.1, 0.6], ("0*a", "a*w*(w*t)^2"));
    for (block, length) in blocks.zip(LENGTHS.into_iter().cycle()) {
        let Block {
            amplitude,
            frequency,
            ..
        } = block;
        // The block sticks to the belt while the acceleration of the belt is small.
        let limit = (block.friction - block.pressure) / block.mass;
        let length_of_rest = 0.9 * limit / (2.0 * amplitude * frequency.powi(2));
        let until = length_of_rest.min(1.0) / frequency;
        block.compare(length, until, |t| amplitude * (frequency * t).powi(3) / 3.0);
    }
}
