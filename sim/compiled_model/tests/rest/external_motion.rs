//! Tests of motions whose steps are made by an external solver: bounces, rest under friction, release by an input, and
//! continued rest.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_compiled_model::{CompiledModel, DrivenModel};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{ExternalMotion, SurfaceMode};

use crate::compile_text;

type Motion = ExternalMotion<DrivenModel<RefCell<Evaluator>, HeldInputs>>;

const STEP: f64 = 1e-3;

const TOLERANCE: f64 = 1e-9;

fn start(model: &CompiledModel, state: &[f64], modes: &[SurfaceMode]) -> Motion {
    let instance = model.with_declared_parameters().unwrap();
    let evaluator = RefCell::new(instance.evaluator().unwrap());
    let system = instance.driven_model(evaluator, instance.default_inputs(), TOLERANCE);
    ExternalMotion::start(system.unwrap(), (0.0, state), modes, TOLERANCE)
}

fn signs(motion: &mut Motion, t: f64, y: &[f64], surfaces: usize) -> Vec<bool> {
    let mut values = vec![0.0; surfaces];
    motion.event_functions(t, y, &mut values);
    assert!(values.iter().all(|value| *value != 0.0), "{t}: {values:?}");
    values.iter().map(|value| *value > 0.0).collect()
}

/// Makes one step of the classical Runge-Kutta method.
fn advance(motion: &mut Motion, t: f64, y: &[f64], h: f64) -> Vec<f64> {
    let mut rates = |t: f64, y: &[f64]| {
        let mut out = vec![0.0; y.len()];
        motion.rates(t, y, &mut out);
        out
    };
    let moved = |by: f64, rates: &[f64]| -> Vec<f64> {
        y.iter().zip(rates).map(|(y, rate)| y + by * rate).collect()
    };
    let a = rates(t, y);
    let b = rates(t + h / 2.0, &moved(h / 2.0, &a));
    let c = rates(t + h / 2.0, &moved(h / 2.0, &b));
    let d = rates(t + h, &moved(h, &c));
    let mean: Vec<f64> = (0..y.len())
        .map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0)
        .collect();
    moved(h, &mean)
}

/// Continues to a time (s) and locates events by bisection. Returns the number of events.
fn simulate(
    motion: &mut Motion,
    t: &mut f64,
    y: &mut Vec<f64>,
    until: f64,
    surfaces: usize,
) -> usize {
    let mut events = 0;
    while *t < until - 1e-9 {
        let before = signs(motion, *t, y, surfaces);
        let (mut length, mut near) = (STEP.min(until - *t), 0.0);
        let mut end = advance(motion, *t, y, length);
        let has_crossed = signs(motion, *t + length, &end, surfaces) != before;
        if has_crossed {
            for _ in 0..50 {
                let middle = 0.5 * (near + length);
                let inside = advance(motion, *t, y, middle);
                match signs(motion, *t + middle, &inside, surfaces) == before {
                    true => near = middle,
                    false => length = middle,
                }
            }
            end = advance(motion, *t, y, length);
        }
        (*t, *y) = (*t + length, end);
        if motion.complete_step(*t, y) || has_crossed {
            motion.apply_event(*t, y);
            events += 1;
        }
    }
    events
}

#[test]
fn ball_bounces_and_rests_as_in_its_closed_form() {
    let model = compile_text(
        "[model]\nname = \"ball\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
         g = { value = 10, unit = \"m/s^2\" }\n[coordinates]\ny = { unit = \"m\", initial = 0.2 }\n\
         [kinetic]\nt = \"1/2*m*dot(y)^2\"\n[potential]\nv = \"m*g*y\"\n\
         [impacts]\nfloor = { when = \"y\", restitution = 0.5 }\n",
    );
    let (mut t, mut y) = (0.0, vec![0.2, 0.0]);
    let mut motion = start(&model, &y, &[]);
    // The ball hits at 0.2 s with 2 m/s, then after 0.2 s, 0.1 s and so on, and rests from 0.6 s on.
    simulate(&mut motion, &mut t, &mut y, 0.3, 1);
    assert!((y[0] - 0.05).abs() < 1e-9 && y[1].abs() < 1e-8, "{y:?}");
    let events = simulate(&mut motion, &mut t, &mut y, 1.0, 1);
    assert!((5..100).contains(&events), "{events}");
    assert!(y[0].abs() < 1e-9 && y[1].abs() < 1e-9, "{y:?}");
    assert_eq!(motion.modes(), [SurfaceMode::Closed]);
}

#[test]
fn contact_opens_when_friction_reverses_at_an_impact() {
    // Friction on a rod presses a sleeve of twice its mass against a wall until the rod rebounds.
    let model = compile_text(
        "[model]\nname = \"sleeve\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
         F = { value = 3, unit = \"N\" }\n[coordinates]\n\
         a = { unit = \"m\", initial = 1, initial_rate = -4 }\nb = { unit = \"m\" }\n\
         [kinetic]\nt = \"1/2*m*dot(a)^2 + m*dot(b)^2\"\n\
         [definitions]\nf = \"F*sign(dot(a) - dot(b))\"\n[forces]\n\
         rod = { on = \"a\", value = \"-f\" }\nsleeve = { on = \"b\", value = \"f\" }\n\
         [impacts]\nstop = { when = \"a\", restitution = 0.5 }\n\
         wall = { when = \"b\", restitution = 0 }\n",
    );
    let (mut t, mut y) = (0.0, vec![1.0, 0.0, -4.0, 0.0]);
    let mut motion = start(&model, &y, &[]);
    // The rod hits with sqrt(10) m/s and rebounds with half this speed. Both bodies then have a third of the rebound
    // speed.
    let events = simulate(&mut motion, &mut t, &mut y, 1.0, 3);
    let speed = 10.0_f64.sqrt() / 6.0;
    assert!(
        y[2..].iter().all(|rate| (rate - speed).abs() < 1e-8),
        "{y:?}"
    );
    assert!(events < 10, "{events}");
}

#[test]
fn friction_holds_until_an_input_releases_the_block() {
    let model = compile_text(
        "[model]\nname = \"block\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
         k = { value = 40, unit = \"N/m\" }\nF = { value = 3, unit = \"N\" }\n\
         [coordinates]\nx = { unit = \"m\", initial = 0.5 }\n[inputs]\nu = { unit = \"N\" }\n\
         [kinetic]\nt = \"1/2*m*dot(x)^2\"\n[potential]\nv = \"1/2*k*x^2\"\n\
         [forces]\nf = { on = \"x\", value = \"-F*sign(dot(x))\" }\ndrive = { on = \"x\", value = \"u\" }\n",
    );
    let (mut t, mut y) = (0.0, vec![0.5, 0.0]);
    let mut motion = start(&model, &y, &[]);
    simulate(&mut motion, &mut t, &mut y, 4.0, 1);
    // Each half swing loses 2 F/k = 0.15 m: 0.5, -0.35, 0.2, -0.05.
    assert!((y[0] + 0.05).abs() < 1e-9 && y[1].abs() < 1e-12, "{y:?}");
    assert_eq!(motion.modes(), [SurfaceMode::Held]);

    // The friction also holds the mass if rounding moved its speed off zero.
    let beside = [y[0], 1e-13];
    let mut rates = [0.0; 2];
    let mut continued = start(&model, &beside, &motion.modes());
    continued.rates(0.0, &beside, &mut rates);
    assert!(rates[1].abs() < 1e-12, "{rates:?}");
    let mut decided = start(&model, &beside, &[]);
    decided.rates(0.0, &beside, &mut rates);
    assert!((rates[1] + 1.0).abs() < 1e-9, "{rates:?}");

    // Input and spring push with 2 N each, and friction resists with 3 N.
    let jump = HeldInputs::new(vec![t.next_down(), t], vec![0.0, 2.0], 1);
    motion.system_mut().set_inputs(jump.unwrap());
    motion.apply_event(t, &mut y);
    motion.rates(t, &y, &mut rates);
    assert!((rates[1] - 1.0).abs() < 1e-9, "{rates:?}");
}
