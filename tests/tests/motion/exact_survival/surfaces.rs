//! Tests of elastic stops, compared with closed forms: impacts, grazing, initial states on the stop, and a million
//! switches.

use eomgen_sim::ode::SolveError;
use eomgen_sim::piecewise_linear::ExactError;
use eomgen_tests::motions::{Spec, TestMotion, difference, grid};

/// Returns a ball that falls onto a spring at x = 0.
fn ball(height: f64, speed: f64) -> Spec {
    Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k", 1e6, "N/m")
        .parameter("g", 9.81, "m/s^2")
        .parameter("zero", 0.0, "m")
        .coordinate("x", [height, speed])
        .kinetic("1/2*m*dot(x)^2")
        .potential("m*g*x + 1/2*k*min(x, zero)^2")
}

#[test]
fn bouncing_ball_matches_closed_form() {
    let (w, g) = (1e3_f64, 9.81_f64);
    for height in [1e-6, 1e-3, 0.05, 1.0, 30.0] {
        let fall = (2.0 * height / g).sqrt();
        let speed = g * fall;
        let entry = (speed / w).atan2(g / (w * w));
        let contact = 2.0 * (std::f64::consts::PI - entry) / w;
        let period = 2.0 * fall + contact;
        let bounces = 10.0;
        let times: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k) * period).collect();
        let subject = TestMotion::new(ball(height, 0.0).model(), 0);
        let motion = subject.simulate_exactly((0.0, bounces * period), &times);
        let deepest = -g / (w * w) - ((speed / w).powi(2) + (g / (w * w)).powi(2)).sqrt();
        for (k, state) in motion.states.iter().enumerate() {
            let wanted = if k % 2 == 0 { height } else { deepest };
            println!(
                "height {height:e}, {k}: {:e}, expected {wanted:e}",
                state[0]
            );
            assert!(
                (state[0] - wanted).abs() < 1e-11 * height.max(-deepest),
                "{height:e} {k}: {}, expected {wanted}",
                state[0]
            );
        }
        assert_eq!(motion.events.len(), 20, "{height:e}");
    }
}

#[test]
fn ball_touching_ceiling_matches_closed_form() {
    // Without the ceiling, the ball would rise `above` m higher than the ceiling. It falls back immediately.
    for (speed, above) in [
        (1.0, 1e-3),
        (1.0, 1e-6),
        (1.0, 1e-9),
        (0.01, 1e-7),
        (3.0, 1e-2),
    ] {
        let g = 9.81;
        let b = speed * speed / (2.0 * g) - above;
        let spec = Spec::default()
            .parameter("m", 1.0, "kg")
            .parameter("k", 100.0, "N/m")
            .parameter("g", g, "m/s^2")
            .parameter("b", b, "m")
            .coordinate("x", [0.0, speed])
            .kinetic("1/2*m*dot(x)^2")
            .potential("m*g*x + 1/2*k*max(x - b, 0*b)^2");
        // Above the ceiling y'' = -g - k y until y = 0 again; then the fall is symmetric to the rise.
        let (at, hit) = ((2.0 * above / g).sqrt(), (2.0 * above * g).sqrt());
        let arrival = speed / g - at;
        let w = 10.0;
        let contact = 2.0 * ((hit / w).atan2(g / (w * w))) / w;
        let end = 2.0 * arrival + contact;
        let motion = TestMotion::new(spec.model(), 0).simulate_exactly((0.0, end), &[end]);
        let [x, v] = motion.final_state[..] else {
            panic!("two states")
        };
        println!(
            "{speed} m/s, {above:e} m above: x = {x:e}, v + speed = {:e}",
            v + speed
        );
        // The duration of a shallow contact is the square root of a small number, which amplifies rounding errors.
        let rounding = 1e-14 * speed * speed / hit;
        assert!(x.abs() < 1e-12 + speed * rounding && (v + speed).abs() < 1e-12 + g * rounding);
        assert_eq!(motion.events.len(), 2);
    }
}

#[test]
fn start_on_a_stop_matches_closed_form() {
    // The mass is initially at rest on the stop, and a force presses it onto the stop: y'' = F/m - 2 zeta w y' - w^2 y.
    for zeta in [0.01, 0.1, 0.5] {
        for (w, b) in [(100.0, 1e-3), (1e4, 25e-6), (1e4, 0.0)] {
            let spec = Spec::default()
                .parameter("m", 2.0, "kg")
                .parameter("k", 2.0 * w * w, "N/m")
                .parameter("c", 4.0 * zeta * w, "N s/m")
                .parameter("b", b, "m")
                .parameter("F", 3.0, "N")
                .coordinate("x", [b, 0.0])
                .kinetic("1/2*m*dot(x)^2")
                .potential("1/2*k*deadzone(x, b)^2")
                .force("x", "F - c*contact(x, b)*dot(x)");
            let until = 20.0 / w;
            let times = grid(until, 50);
            let motion = TestMotion::new(spec.model(), 0).simulate_exactly((0.0, until), &times);
            let fast = w * (1.0 - zeta * zeta).sqrt();
            let closed = |t: &f64| {
                let (sine, cosine) = (fast * t).sin_cos();
                let decay = (-zeta * w * t).exp();
                let still = 3.0 / (2.0 * w * w);
                vec![
                    still * (1.0 - decay * (cosine + zeta * w / fast * sine)),
                    still * decay * w * w / fast * sine,
                ]
            };
            let wanted: Vec<Vec<f64>> = times.iter().map(closed).collect();
            let mut found = motion.states.clone();
            found.iter_mut().for_each(|y| y[0] -= b);
            let error = difference(&found, &wanted, 1e-3 * b);
            println!("zeta = {zeta}, w = {w}, b = {b:e}: {error:.1e}");
            assert!(
                error < 1e-11,
                "zeta = {zeta}, w = {w}, b = {b:e}: {error:e}"
            );
        }
    }
}

/// Returns a mass on a spring between stops at +- b. The amplitude without stops is b (1 + more).
fn oscillator_between_stops(more: f64, c: f64) -> Spec {
    let (w, b) = (50.0, 1e-3);
    Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k_0", w * w, "N/m")
        .parameter("k", 1e6, "N/m")
        .parameter("c", c, "N s/m")
        .parameter("b", b, "m")
        .coordinate("x", [0.0, b * w * (1.0 + more)])
        .kinetic("1/2*m*dot(x)^2")
        .potential("1/2*k_0*x^2 + 1/2*k*deadzone(x, b)^2")
        .force("x", "-c*contact(x, b)*dot(x)")
}

#[test]
fn grazing_a_stop_conserves_energy() {
    let times = grid(1.0, 200);
    for more in [-1e-3, -1e-9, -1e-14, -1e-15] {
        let motion = TestMotion::new(oscillator_between_stops(more, 100.0).model(), 0)
            .simulate_exactly((0.0, 1.0), &times);
        let a = 1e-3 * (1.0 + more);
        let wanted: Vec<Vec<f64>> = times
            .iter()
            .map(|t| vec![a * (50.0 * t).sin(), 50.0 * a * (50.0 * t).cos()])
            .collect();
        let error = difference(&motion.states, &wanted, 0.0);
        println!(
            "{more:e} above: {error:.1e}, {} switches",
            motion.events.len()
        );
        assert!(error < 1e-12, "{more:e}: {error:e}");
        assert!(more > -1e-14 || motion.events.is_empty());
    }
    for more in [0.0, 3e-16, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3] {
        // Without damping the energy is conserved.
        let motion = TestMotion::new(oscillator_between_stops(more, 0.0).model(), 0)
            .simulate_exactly((0.0, 1.0), &times);
        let energy = |y: &Vec<f64>| {
            let over = (y[0].abs() - 1e-3).max(0.0);
            0.5 * (y[1] * y[1] + 2500.0 * y[0] * y[0] + 1e6 * over * over)
        };
        let whole = energy(&motion.states[0]);
        let worst = motion
            .states
            .iter()
            .map(|y| (energy(y) / whole - 1.0).abs())
            .fold(0.0, f64::max);
        println!(
            "{more:e} beyond: energy {worst:.1e}, {} switches",
            motion.events.len()
        );
        assert!(worst < 1e-12, "{more:e}: {worst:e}");
        // There are 15 half periods per second (16 with a stiff stop) with two switches each.
        assert!(
            more < 1e-14 || (30..=34).contains(&motion.events.len()),
            "{more:e}"
        );
        // The contacts are so short that the effect of damping is within this bound.
        let damped = TestMotion::new(oscillator_between_stops(more, 100.0).model(), 0)
            .simulate_exactly((0.0, 1.0), &times);
        let lost = difference(&damped.states, &motion.states, 0.0);
        println!("{more:e} beyond: effect of damping {lost:.1e}");
        assert!(
            lost < 1e-12 + 1e4 * more.powf(1.0).max(0.0) + 100.0 * more.powf(1.5),
            "{more:e}: {lost:e}"
        );
    }
}

#[test]
fn million_switches_match_closed_form() {
    // Free flights of duration 2 b/v between elastic stops alternate with contacts of half a period.
    let (w, b, v) = (1e3, 1e-3, 1.0);
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k", w * w, "N/m")
        .parameter("b", b, "m")
        .coordinate("x", [0.0, v])
        .kinetic("1/2*m*dot(x)^2")
        .potential("1/2*k*deadzone(x, b)^2");
    let half = 2.0 * b / v + std::f64::consts::PI / w;
    // There are two switches per half period. The end is a quarter of a free flight after the middle position.
    let until = 500_000.0 * half + 0.5 * b / v;
    let subject = TestMotion::new(spec.model(), 0);
    let motion = subject.simulate_exactly((0.0, until), &[until]);
    let [x, speed] = motion.final_state[..] else {
        panic!("two states")
    };
    println!(
        "{:?}: x off by {:e}, v by {:e}",
        motion.statistics,
        x - 0.5 * b,
        speed - v
    );
    assert_eq!(motion.events.len(), 1_000_000);
    // The rounding errors of all half periods are equal, so they add up.
    assert!((x - 0.5 * b).abs() < 1e-6 * b && (speed - v).abs() < 1e-10);
    // The solver may take at most two steps per switch.
    let work = motion.statistics;
    assert!(work.steps <= 2_000_000, "{work:?}");
}

#[test]
fn too_many_switches_are_rejected() {
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k", 1e6, "N/m")
        .parameter("b", 1e-6, "m")
        .coordinate("x", [0.0, 1.0])
        .kinetic("1/2*m*dot(x)^2")
        .potential("1/2*k*deadzone(x, b)^2");
    let subject = TestMotion::new(spec.model(), 0);
    let mut propagator = subject.propagator().expect("a propagator");
    propagator.max_switch_rate = 100.0;
    let refused = propagator.simulate(
        &subject.initial,
        (0.0, 1e7),
        &[],
        &subject.inputs,
        &mut |_| {},
    );
    let Err(error @ ExactError::Stopped(SolveError::TooManySwitches { t, rate, .. })) = refused
    else {
        panic!("{refused:?}");
    };
    println!("{error}");
    assert!(t < 20.0 && rate == 100.0 && error.to_string().contains("1e2"));
}

#[test]
fn accumulating_switches_end() {
    // The time between switches decreases by a constant factor. The switches accumulate at about t = 1 + sqrt(2); then
    // the mass remains at rest.
    for dry in [0.5, 0.1] {
        let spec = Spec::default()
            .parameter("m", 1.0, "kg")
            .parameter("F", 1.0, "N")
            .parameter("T", dry, "N")
            .coordinate("x", [1.0, 0.0])
            .kinetic("1/2*m*dot(x)^2")
            .force("x", "-F*sign(x) - T*sign(dot(x))");
        let ended = TestMotion::new(spec.model(), 0).try_simulate_exactly((0.0, 100.0), &[100.0]);
        println!(
            "dry {dry}: {:?}",
            ended
                .as_ref()
                .map(|m| (m.final_state.clone(), m.events.len(), m.statistics))
        );
        match ended {
            Ok(motion) => assert!(motion.final_state.iter().all(|y| y.abs() < 1e-9)),
            Err(error) => assert!(
                matches!(
                    error,
                    ExactError::Stopped(SolveError::TooManySwitches { .. })
                ),
                "{error}"
            ),
        }
    }
    // With a damper, each period is slightly shorter than the previous one, and the motion never ends.
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("F", 1.0, "N")
        .parameter("c", 1.0, "N s/m")
        .coordinate("x", [1.0, 0.0])
        .kinetic("1/2*m*dot(x)^2")
        .force("x", "-F*sign(x) - c*dot(x)");
    let ended = TestMotion::new(spec.model(), 0).try_simulate_exactly((0.0, 50.0), &[50.0]);
    println!(
        "damper: {:?}",
        ended
            .as_ref()
            .map(|m| (m.final_state.clone(), m.events.len(), m.statistics))
    );
    match ended {
        Ok(motion) => assert!(motion.final_state.iter().all(|y| y.abs() < 1e-4)),
        Err(error) => assert!(
            matches!(
                error,
                ExactError::Stopped(SolveError::TooManySwitches { .. })
            ),
            "{error}"
        ),
    }
}

#[test]
fn samples_at_a_switch_match_closed_form() {
    // The mass reaches the stop at exactly 1 s; in one case the time span ends at this time.
    let spec = Spec::default()
        .parameter("m", 1.0, "kg")
        .parameter("k", 100.0, "N/m")
        .parameter("b", 1.0, "m")
        .coordinate("x", [0.0, 1.0])
        .kinetic("1/2*m*dot(x)^2")
        .potential("1/2*k*deadzone(x, b)^2");
    let subject = TestMotion::new(spec.model(), 0);
    let up = 1.0_f64.next_up();
    let down = 1.0_f64.next_down();
    for times in [
        vec![1.0],
        vec![down, 1.0, up],
        vec![1.0; 5],
        vec![0.0, 0.0, 1.0],
    ] {
        for end in [*times.last().expect("a time"), 1.5] {
            let motion = subject.simulate_exactly((0.0, end), &times);
            for (t, state) in times.iter().zip(&motion.states) {
                assert!((state[0] - t).abs() < 1e-15, "{t}: {state:?}");
            }
        }
    }
    let all = subject.simulate_exactly((0.0, 30.0), &[]);
    let times: Vec<f64> = all.events.iter().map(|s| s.t).collect();
    assert!(times.len() > 20);
    let motion = subject.simulate_exactly((0.0, 30.0), &times);
    for state in &motion.states {
        assert!((state[0].abs() - 1.0).abs() < 1e-13, "{state:?}");
    }
    for (count, end) in times.iter().enumerate() {
        for end in [end.next_down(), *end, end.next_up()] {
            let motion = subject.simulate_exactly((0.0, end), &[0.5 * end, end, end]);
            assert!((motion.final_state[0].abs() - 1.0).abs() < 1e-13, "{count}");
            assert_eq!(motion.states[2], motion.final_state);
        }
    }
}
