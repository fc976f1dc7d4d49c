//! Contacts much shorter than a step: an oscillator reaches a stiff wall only near its turning point. Its
//! period is known in closed form, with and without contact.

use std::f64::consts::PI;

use super::systems::FixedSides;
use eomgen_sim::ode::{Method, Settings, System, Trajectory, simulate};

/// x'' = -x - k max(x - wall, 0).
struct Oscillator {
    wall: f64,
    stiffness: f64,
    sides: FixedSides,
}

impl System for Oscillator {
    fn state_count(&self) -> usize {
        2
    }

    fn rates(&self, _: f64, y: &[f64], out: &mut [f64]) {
        let depth = match self.sides.side(0, y[0] - self.wall) {
            1.0 => y[0] - self.wall,
            _ => 0.0,
        };
        out.copy_from_slice(&[y[1], -y[0] - self.stiffness * depth]);
    }

    fn guard_count(&self) -> usize {
        1
    }

    fn guards(&self, _: f64, y: &[f64], out: &mut [f64]) {
        out[0] = y[0] - self.wall;
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        self.sides.fix(sides);
    }
}

/// Returns the period for the amplitude 1: free motion with the angular frequency 1 and a contact with the
/// angular frequency sqrt(1 + k).
fn period(wall: f64, stiffness: f64) -> f64 {
    let speed = ((1.0 - wall) * (1.0 + wall)).sqrt();
    let flight = 2.0 * PI - 2.0 * speed.atan2(wall);
    let frequency = (1.0 + stiffness).sqrt();
    let contact = 2.0 * (speed / frequency).atan2(wall / (1.0 + stiffness)) / frequency;
    flight + contact
}

fn swing(method: Method, tolerance: f64, wall: f64, stiffness: f64, until: f64) -> Trajectory {
    let settings = Settings {
        method,
        ..Settings::with_tolerance(tolerance)
    };
    let system = Oscillator {
        wall,
        stiffness,
        sides: FixedSides::default(),
    };
    let span = (0.0, until);
    simulate(&system, &[0.0, 1.0], span, &[], &settings, &mut |_| {}).expect("a motion")
}

#[test]
fn contact_shorter_than_step_is_detected() {
    const SWINGS: u32 = 20;
    let stiffness = 1e6;
    for method in [Method::DormandPrince853, Method::Adams, Method::Radau] {
        // Penetrations well above the error of the amplitude.
        let depths = [(1e-6, 1e-3), (1e-9, 1e-3), (1e-9, 1e-5)];
        let tight = [1e-3, 1e-5, 1e-7].map(|depth| (1e-12, depth));
        for (tolerance, depth) in depths.into_iter().chain(tight) {
            let wall = 1.0 - depth;
            let until = f64::from(SWINGS) * period(wall, stiffness);
            let motion = swing(method, tolerance, wall, stiffness, until);
            let case = format!("{method:?} at {tolerance:e}, {depth:e} beyond the wall");
            assert_eq!(motion.events.len(), 2 * SWINGS as usize, "{case}");
            let off = motion.final_state[0].abs();
            assert!(tolerance > 1e-12 || off < 1e-6, "{case}: {off:e}");
        }
    }
}

/// The energy is 0.5 J for every distance of the wall from the turning point. The error of each step may reach
/// the tolerance. The energy in a contact is more sensitive by the square root of the stiffness.
#[test]
fn grazing_contact_conserves_energy() {
    let tolerance = 1e-9;
    let depths = [1e-2, 5.5e-5, 4e-5, 1e-5, 3e-8, 1e-10, 1e-12];
    let walls = depths
        .into_iter()
        .flat_map(|depth| [1.0 - depth, 1.0 + depth]);
    for method in [Method::DormandPrince853, Method::Adams, Method::Radau] {
        for stiffness in [1e4_f64, 1e5, 1e6] {
            for wall in walls.clone() {
                let motion = swing(method, tolerance, wall, stiffness, 40.0);
                let (x, v) = (motion.final_state[0], motion.final_state[1]);
                let depth = (x - wall).max(0.0);
                let energy = 0.5 * (v * v + x * x + stiffness * depth * depth);
                let errors = motion.statistics.steps as f64
                    + 2.0 * motion.events.len() as f64 * stiffness.sqrt();
                assert!(
                    (energy - 0.5).abs() < errors * tolerance,
                    "{method:?}, wall at {wall:?}, stiffness {stiffness:e}: {energy:e} J"
                );
            }
        }
    }
}

#[test]
fn swing_short_of_wall_has_no_contact() {
    for method in [Method::DormandPrince853, Method::Adams, Method::Radau] {
        let until = 20.0 * 2.0 * PI;
        let free = swing(method, 1e-9, 2.0, 1e6, until);
        for gap in [1e-2, 1e-4, 1e-6] {
            let motion = swing(method, 1e-9, 1.0 + gap, 1e6, until);
            let case = format!("{method:?}, {gap:e} before the wall");
            assert!(motion.events.is_empty(), "{case}");
            assert!(
                (motion.final_state[0] - free.final_state[0]).abs() < 1e-7,
                "{case}"
            );
        }
        let far = swing(method, 1e-9, 1.01, 1e6, until);
        assert_eq!(
            far.statistics.evaluations, free.statistics.evaluations,
            "{method:?}"
        );
    }
}

/// x'' = 500 before a wall far from the origin, and x'' = 500 - 100 v beyond it, with the speed v.
#[derive(Default)]
struct FarWall(FixedSides);

impl FarWall {
    const PLACE: f64 = 4.117_640_416_056_029;
}

impl System for FarWall {
    fn state_count(&self) -> usize {
        2
    }

    fn rates(&self, _: f64, y: &[f64], out: &mut [f64]) {
        let drag = match self.0.side(0, y[0] - Self::PLACE) {
            1.0 => 100.0 * y[1],
            _ => 0.0,
        };
        out.copy_from_slice(&[y[1], 500.0 - drag]);
    }

    fn guard_count(&self) -> usize {
        1
    }

    fn guards(&self, _: f64, y: &[f64], out: &mut [f64]) {
        out[0] = y[0] - Self::PLACE;
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        self.0.fix(sides);
    }
}

#[test]
fn wall_is_crossed_if_motion_is_below_rounding_of_position() {
    for (method, distance) in [
        (Method::DormandPrince853, 4e-9),
        (Method::DormandPrince853, 4e-12),
        (Method::Radau, 4e-9),
        (Method::Adams, 4e-9),
    ] {
        let settings = Settings {
            method,
            max_steps: 10_000,
            ..Settings::with_tolerance(1e-12)
        };
        let initial = [FarWall::PLACE - distance, 2e-7];
        let motion = simulate(
            &FarWall::default(),
            &initial,
            (0.0, 1e-3),
            &[],
            &settings,
            &mut |_| {},
        );
        let motion = motion.unwrap_or_else(|error| panic!("{method:?} {distance}: {error}"));
        // Beyond the wall v = 5 (1 - exp(-100 t)).
        let before = (2.0 * distance / 500.0_f64).sqrt();
        let entered = 500.0 * before;
        let decayed = (-100.0 * (1e-3 - before)).exp();
        let expected = 5.0 + (entered - 5.0) * decayed;
        let error = (motion.final_state[1] - expected).abs();
        assert!(error < 1e-6, "{method:?} {distance}: {error}");
    }
}
