//! Tests of closed contacts with friction but without normal force, and of sticking in any unit of the coordinates.

use eomgen_compiled_model::Solver;
use eomgen_tests::motions::{grid, simulate_to_end};
use eomgen_tests::random_numbers::Numbers;

const SETTINGS: (f64, f64) = (1e-9, f64::INFINITY);

/// Returns masses, stiffness, initial distance and specification of two blocks. One block hits the other from below
/// without restitution, and both continue upwards. Then a spring along the contact pulls them. The coordinates are
/// rotated, with `c = cos(al)` and `s = sin(al)`.
fn colliding_blocks(numbers: &mut Numbers, angle: f64, gravity: f64) -> ([f64; 4], String) {
    let mut between = |low: f64, high: f64| low + 0.5 * (high - low) * (1.0 + numbers.symmetric());
    let (lower, upper) = (between(0.3, 2.0), between(0.3, 2.0));
    let (stiffness, distance) = (between(20.0, 200.0), between(0.05, 0.3));
    let (friction, speed) = (between(0.1, 0.9), between(0.2, 1.0));
    let (sin, cos) = angle.sin_cos();
    let text = format!(
        "[model]\nname = \"blocks\"\n[parameters]\n\
         m0 = {{ value = {lower:?}, unit = \"kg\" }}\nm1 = {{ value = {upper:?}, unit = \"kg\" }}\n\
         k = {{ value = {stiffness:?}, unit = \"N/m\" }}\ng = {{ value = {gravity:?}, unit = \"m/s^2\" }}\n\
         mu = {{ value = {friction:?} }}\nc = {{ value = {cos:?} }}\ns = {{ value = {sin:?} }}\n\
         [coordinates]\n\
         a0 = {{ unit = \"m\", initial_rate = {:?} }}\nb0 = {{ unit = \"m\", initial_rate = {:?} }}\n\
         a1 = {{ unit = \"m\", initial = {:?} }}\nb1 = {{ unit = \"m\", initial = {:?} }}\n\
         [definitions]\n\
         x0 = \"c*a0 - s*b0\"\ny0 = \"s*a0 + c*b0\"\nx1 = \"c*a1 - s*b1\"\ny1 = \"s*a1 + c*b1\"\n\
         [kinetic]\n\
         T = \"1/2*m0*(dot(x0)^2 + dot(y0)^2) + 1/2*m1*(dot(x1)^2 + dot(y1)^2)\"\n\
         [potential]\nweight = \"m0*g*y0 + m1*g*y1\"\nspring = \"1/2*k*(x1 - x0)^2\"\n\
         [impacts]\n\
         contact = {{ when = \"y1 - y0\", restitution = 0, friction = \"mu\", slip = \"dot(x1) - dot(x0)\" }}\n",
        speed * sin,
        speed * cos,
        distance * cos,
        -distance * sin
    );
    ([lower, upper, stiffness, distance], text)
}

#[test]
fn contact_without_normal_force_has_no_friction() {
    let times = grid(1.0, 20);
    for case in 0..12 {
        for angle in [0.0, 0.5, 1.1] {
            for gravity in [0.0, 9.81] {
                let numbers = &mut Numbers(case + 1);
                let ([lower, upper, stiffness, distance], text) =
                    colliding_blocks(numbers, angle, gravity);
                let frequency = (stiffness * (1.0 / lower + 1.0 / upper)).sqrt();
                let (sin, cos) = angle.sin_cos();
                for solver in [Solver::Rk, Solver::Radau] {
                    let motion = simulate_to_end(&text, &times, solver, SETTINGS);
                    for (t, state) in times.iter().zip(&motion.trajectory.states) {
                        let found = cos * (state[2] - state[0]) - sin * (state[3] - state[1]);
                        let expected = distance * (frequency * t).cos();
                        assert!(
                            (found - expected).abs() < 1e-6 * distance,
                            "{solver}, {angle} rad, {t} s: {found}, not {expected}\n{text}"
                        );
                    }
                }
            }
        }
    }
}

/// A block on a floor sticks and slips under a harmonic load. The coordinates are `size` times the positions.
#[test]
fn friction_that_holds_takes_few_evaluations_in_any_unit() {
    let times = grid(1.5, 30);
    for solver in [Solver::Rk, Solver::Radau] {
        let mut ends = Vec::new();
        for size in [1e-3, 1.0, 1e3, 1e6] {
            let text = format!(
                "[model]\nname = \"block\"\n[parameters]\n\
                 m = {{ value = 1.5, unit = \"kg\" }}\nA = {{ value = 10, unit = \"N\" }}\n\
                 w = {{ value = 5, unit = \"1/s\" }}\nN = {{ value = 14.3, unit = \"N\" }}\n\
                 k = {{ value = 112, unit = \"N/m\" }}\nmu = {{ value = 0.649 }}\nc = {{ value = {size:?} }}\n\
                 [coordinates]\nX = {{ unit = \"m\" }}\nY = {{ unit = \"m\" }}\n\
                 [definitions]\nx = \"X/c\"\ny = \"Y/c\"\n\
                 [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[potential]\nspring = \"1/2*k*x^2\"\n\
                 [forces]\npress = {{ on = \"y\", value = \"-N\" }}\ndrive = {{ on = \"x\", value = \"A*sin(w*t)\" }}\n\
                 [impacts]\n\
                 floor = {{ when = \"y\", restitution = 0.5, friction = \"mu\", slip = \"dot(x)\" }}\n"
            );
            let motion = simulate_to_end(&text, &times, solver, SETTINGS);
            let evaluations = motion.trajectory.statistics.evaluations;
            assert!(evaluations < 20_000, "{solver}, {size}: {evaluations}");
            ends.push(motion.trajectory.states.last().expect("a state")[0] / size);
        }
        for end in &ends {
            assert!((end - ends[1]).abs() < 1e-8, "{solver}: {ends:?}");
        }
    }
}

/// A ladder rests on a rough floor and against a rough wall. Its initial rates are rounding errors of an earlier
/// motion.
#[test]
fn ladder_with_rates_of_rounding_size_remains_at_rest() {
    for rate in [0.0, 1e-45, 1e-30, 1e-20, 1e-14] {
        for until in [0.2, 0.5, 1.0] {
            for size in [1.0, 1e3] {
                let text = format!(
                    "[model]\nname = \"ladder\"\n[parameters]\n\
                     m = {{ value = 1, unit = \"kg\" }}\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n\
                     J = {{ value = 0.0833, unit = \"kg m^2\" }}\na = {{ value = 0.5, unit = \"m\" }}\n\
                     mu = {{ value = 0.861 }}\nn = {{ value = {size:?} }}\n\
                     [coordinates]\n\
                     X = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
                     Y = {{ unit = \"m\", initial = {:?}, initial_rate = {:?} }}\n\
                     h = {{ unit = \"rad\", initial = 0.5355, initial_rate = {:?} }}\n\
                     [definitions]\n\
                     floor_x = \"X/n + a*cos(h)\"\nfloor_y = \"Y/n - a*sin(h)\"\n\
                     wall_x = \"X/n - a*cos(h)\"\nwall_y = \"Y/n + a*sin(h)\"\n\
                     [kinetic]\nT = \"1/2*m*(dot(X)^2 + dot(Y)^2)/n^2 + 1/2*J*dot(h)^2\"\n\
                     [potential]\nweight = \"m*g*Y/n\"\n\
                     [impacts]\n\
                     floor = {{ when = \"floor_y\", restitution = 0, friction = \"mu\", slip = \"dot(floor_x)\" }}\n\
                     wall = {{ when = \"wall_x\", restitution = 0, friction = \"mu\", slip = \"dot(wall_y)\" }}\n",
                    size * 0.5 * 0.5355_f64.cos(),
                    -2.5 * size * rate,
                    size * 0.5 * 0.5355_f64.sin(),
                    1.5 * size * rate,
                    0.8 * rate
                );
                for solver in [Solver::Rk, Solver::Radau] {
                    let times = grid(until, 10);
                    let motion = simulate_to_end(&text, &times, solver, SETTINGS);
                    let end = motion.trajectory.states.last().expect("a state");
                    assert!((end[2] - 0.5355).abs() < 1e-12, "{solver}, {rate}: {end:?}");
                }
            }
        }
    }
}
