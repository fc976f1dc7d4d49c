//! Comparison of the exact solver with the general solvers over short times. The machines are the arm, and small
//! machines of springs, stops and dry friction, with random parameters over decades.
//!
//! The uncertainty of the general solvers is the difference between tolerances and between methods. The exact solver
//! may differ by twice the uncertainty plus rounding. A second method is needed, because one method can miss an event
//! that is much shorter than a step.

use eomgen_compiled_model::{CompiledModel, Orders, Solver};
use eomgen_sim::ode::{Method, SolveError, Trajectory};
use eomgen_sim::piecewise_linear::ExactError;
use eomgen_tests::models::load;
use eomgen_tests::motions::{Spec, TestMotion, difference, grid};
use proptest::prelude::*;

/// Maximum number of steps and trial steps of the exact solver in one motion.
const MAX_EXACT_STEPS: u64 = 100_000;

/// Deviation due to rounding, amplified by switches, relative to the largest magnitude of each
/// state.
const MAX_ROUNDING: f64 = 1e-10;

fn config() -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(64)
    }
}

fn exact(subject: &TestMotion, until: f64, times: &[f64]) -> Result<Trajectory, ExactError> {
    let motion = subject.try_simulate_exactly((0.0, until), times)?;
    let work = motion.statistics;
    assert!(work.steps + work.trial_steps < MAX_EXACT_STEPS, "{work:?}");
    Ok(motion)
}

fn compare_solvers(subject: &TestMotion, until: f64, smallest: f64) -> Result<(), TestCaseError> {
    let times = grid(until, 16);
    let exact = match exact(subject, until, &times) {
        Ok(motion) => motion,
        // The motion has too many switches for any solver.
        Err(ExactError::Stopped(SolveError::TooManySwitches { .. })) => return Ok(()),
        Err(error) => return Err(TestCaseError::fail(error.to_string())),
    };
    prop_assert_eq!(&exact.times, &times);
    let general = |tolerance: f64| subject.simulate_generally((0.0, until), &times, tolerance);
    let adams = subject.simulate_by_method(Method::Adams, (0.0, until), &times, 1e-12);
    let (Ok(coarse), Ok(fine), Ok(adams)) = (general(1e-10), general(1e-12), adams) else {
        // The motion slides on a switching surface, or the model is too stiff for the general solver.
        return Ok(());
    };
    let differs = |other: &Trajectory| difference(&other.states, &fine.states, smallest);
    let doubt = differs(&coarse).max(differs(&adams));
    let found = difference(&exact.states, &fine.states, smallest);
    prop_assert!(
        found <= 2.0 * doubt + MAX_ROUNDING,
        "difference {:e}, uncertainty {:e}, {} switches",
        found,
        doubt,
        exact.events.len()
    );
    Ok(())
}

fn log_uniform(low: f64, high: f64) -> impl Strategy<Value = f64> + Clone {
    (low.log10()..high.log10()).prop_map(|power| 10.0_f64.powf(power))
}

/// Returns zero in one of five cases.
fn sometimes_zero(of: impl Strategy<Value = f64>) -> impl Strategy<Value = f64> {
    (of, 0..5_u32).prop_map(|(value, die)| if die == 0 { 0.0 } else { value })
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn exact_matches_general_solver_for_random_arms(
        stiffness in [log_uniform(1e5, 1e9), log_uniform(1e5, 1e9)],
        damping in [sometimes_zero(log_uniform(1.0, 3e3)), sometimes_zero(log_uniform(1.0, 3e3))],
        play in [sometimes_zero(log_uniform(1e-9, 1e-3)), sometimes_zero(log_uniform(1e-9, 1e-3))],
        masses in [log_uniform(0.04, 4.0), log_uniform(0.06, 6.0)],
        motor in (sometimes_zero(log_uniform(0.01, 100.0)), sometimes_zero(log_uniform(0.01, 100.0)), sometimes_zero(log_uniform(1e-12, 1.0))),
        omega in sometimes_zero(log_uniform(0.1, 1e5)),
        order in 0..7_usize,
        deflections in [-2.0..2.0_f64, -2.0..2.0_f64],
        rates in [-0.3..0.3_f64, -0.3..0.3_f64],
    ) {
        let values = [
            ("k_sp", stiffness[0]), ("k_pr", stiffness[1]), ("c_sp", damping[0]), ("c_pr", damping[1]),
            ("b_sp", play[0]), ("b_pr", play[1]), ("M_s", masses[0]), ("M_p", masses[1]),
            ("a_m", motor.0), ("F_w", motor.1), ("b_m", motor.2), ("omega", omega),
        ];
        let model = load("planetary_arm").with_parameters(&values).expect("values within bounds");
        let subject = TestMotion::new(model, order);
        let mut initial = subject.initial.clone();
        let half = initial.len() / 2;
        for mesh in 0..2 {
            initial[mesh] = deflections[mesh] * play[mesh].max(1e-6);
            initial[half + mesh] = rates[mesh];
        }
        compare_solvers(&subject.with_initial_state(&initial), 5e-4, 1e-6)?;
    }
}

/// The play is crossed within 1e-4 of the damper's settling time. A search over a long interval covers a large part of
/// the decay.
#[test]
fn exact_matches_general_solver_for_play_with_strong_damper() {
    let values = [
        ("k_sp", 1e5),
        ("k_pr", 464350152.82289267),
        ("c_sp", 2759.6205921774285),
        ("c_pr", 0.0),
        ("b_sp", 0.0),
        ("b_pr", 1.5318330730572323e-9),
        ("M_s", 0.0853419369296616),
        ("M_p", 0.14667898205208466),
        ("a_m", 0.0),
        ("F_w", 0.0),
        ("b_m", 0.0),
        ("omega", 0.0),
    ];
    let model = load("planetary_arm").with_parameters(&values);
    let subject = TestMotion::new(model.expect("values within bounds"), 0);
    let mut initial = subject.initial.clone();
    let half = initial.len() / 2;
    initial[half + 1] = -0.29280426769815593;
    let subject = subject.with_initial_state(&initial);
    compare_solvers(&subject, 5e-4, 1e-6).expect("the same motion");
}

#[derive(Clone, Debug)]
enum Term {
    Spring(f64),
    Damper(f64),
    Stop(f64, f64, f64),
    OneSided(f64, f64),
    Dry(f64),
    Push(f64, f64, f64),
    /// Spring whose deflection is filtered (low-pass), optionally with backlash.
    Late(f64, f64, f64),
}

fn term() -> impl Strategy<Value = Term> {
    prop_oneof![
        log_uniform(1.0, 1e4).prop_map(Term::Spring),
        log_uniform(0.01, 10.0).prop_map(Term::Damper),
        (
            log_uniform(100.0, 1e6),
            sometimes_zero(log_uniform(0.1, 30.0)),
            sometimes_zero(log_uniform(1e-6, 1e-1))
        )
            .prop_map(|(k, c, b)| Term::Stop(k, c, b)),
        (log_uniform(100.0, 1e6), -0.1..0.1_f64).prop_map(|(k, b)| Term::OneSided(k, b)),
        log_uniform(0.01, 10.0).prop_map(Term::Dry),
        (
            log_uniform(0.1, 100.0),
            sometimes_zero(log_uniform(0.1, 1e3)),
            -3.0..3.0_f64
        )
            .prop_map(|(force, omega, phi)| Term::Push(force, omega, phi)),
        (
            log_uniform(1.0, 1e3),
            log_uniform(1e-3, 1.0),
            sometimes_zero(log_uniform(1e-4, 1e-2))
        )
            .prop_map(|(k, tau, b)| Term::Late(k, tau, b)),
    ]
}

/// Returns a machine of up to three masses; each term acts on one mass or between two.
fn machine(masses: &[f64], starts: &[[f64; 2]; 3], terms: &[(Term, usize, usize)]) -> Spec {
    let mut spec = Spec::default();
    for (place, mass) in masses.iter().enumerate() {
        spec = spec
            .parameter(&format!("m_{place}"), *mass, "kg")
            .coordinate(&format!("x_{place}"), starts[place])
            .kinetic(&format!("1/2*m_{place}*dot(x_{place})^2"));
    }
    for (index, (term, on, other)) in terms.iter().enumerate() {
        let (on, other) = (on % masses.len(), other % masses.len());
        let x = if on == other {
            format!("x_{on}")
        } else {
            format!("(x_{on} - x_{other})")
        };
        let v = if on == other {
            format!("dot(x_{on})")
        } else {
            format!("(dot(x_{on}) - dot(x_{other}))")
        };
        let name = |letter: &str| format!("{letter}_t{index}");
        let (k, c, b, w) = (name("k"), name("c"), name("b"), name("w"));
        let force;
        (spec, force) = match term {
            Term::Spring(stiffness) => (spec.parameter(&k, *stiffness, "N/m"), format!("-{k}*{x}")),
            Term::Damper(damping) => (spec.parameter(&c, *damping, "N s/m"), format!("-{c}*{v}")),
            Term::Stop(stiffness, damping, play) => (
                spec.parameter(&k, *stiffness, "N/m")
                    .parameter(&c, *damping, "N s/m")
                    .parameter(&b, *play, "m"),
                format!("-{k}*deadzone({x}, {b}) - {c}*contact({x}, {b})*{v}"),
            ),
            Term::OneSided(stiffness, place) => (
                spec.parameter(&k, *stiffness, "N/m")
                    .parameter(&b, *place, "m"),
                format!("-{k}*(max({x}, {b}) - {b})"),
            ),
            Term::Dry(level) => (spec.parameter(&k, *level, "N"), format!("-{k}*sign({v})")),
            Term::Push(force, omega, phi) => (
                spec.parameter(&k, *force, "N")
                    .parameter(&w, *omega, "rad/s")
                    .parameter(&b, *phi, "rad"),
                format!("{k}*sin({w}*t + {b})"),
            ),
            Term::Late(stiffness, tau, play) => (
                spec.parameter(&k, *stiffness, "N/m")
                    .parameter(&c, *tau, "s")
                    .parameter(&b, *play, "m")
                    .state(&w, &format!("({x} - {w})/{c}")),
                format!("-{k}*deadzone({w}, {b})"),
            ),
        };
        spec = spec.force(&format!("x_{on}"), &force);
        if on != other && !matches!(term, Term::Push(..)) {
            spec = spec.force(&format!("x_{other}"), &format!("-({force})"));
        }
    }
    spec
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn exact_matches_general_solver_for_random_machines(
        masses in proptest::collection::vec(log_uniform(0.1, 10.0), 1..=3),
        starts in [[-0.1..0.1_f64, -1.0..1.0_f64], [-0.1..0.1_f64, -1.0..1.0_f64], [-0.1..0.1_f64, -1.0..1.0_f64]],
        terms in proptest::collection::vec((term(), 0..3_usize, 0..3_usize), 1..=6),
    ) {
        let subject = TestMotion::new(machine(&masses, &starts, &terms).model(), 0);
        compare_solvers(&subject, 0.3, 1e-4)?;
    }
}

/// Two masses in frictional contact move together and are loaded through a filter. The rounding error of the friction
/// force between them must not cause a relative rate.
#[test]
fn exact_matches_general_solver_for_sticking_masses_with_filter() {
    let terms = [
        (Term::Dry(6.116930067280249), 1, 0),
        (Term::Damper(1.0), 0, 1),
        (Term::Late(5.527418861885961, 1.0, 0.0), 0, 2),
        (Term::Stop(100.0, 0.0, 0.1), 0, 0),
    ];
    let starts = [[0.0, 0.0], [-0.05756814641021024, 0.0], [0.0, 0.0]];
    let spec = machine(&[1.0, 0.12259264311719222, 1.0], &starts, &terms);
    compare_solvers(&TestMotion::new(spec.model(), 0), 0.3, 1e-4).expect("the same motion");
}

/// A filtered spring with a short time constant connects two slow masses, one of them with drag.
#[test]
fn exact_matches_general_solver_for_fast_filter() {
    let terms = [
        (Term::Late(1.0, 0.0011986461370879227, 0.0), 0, 1),
        (Term::Damper(0.016923112823417547), 1, 1),
        (Term::Push(1.0, 0.0, 0.0), 0, 0),
    ];
    let spec = machine(
        &[3.609018783178681, 9.921373460567043],
        &[[0.0; 2]; 3],
        &terms,
    );
    compare_solvers(&TestMotion::new(spec.model(), 0), 0.3, 1e-4).expect("the same motion");
}

/// The machine is a mass on a one-sided spring, with friction against a free mass, and a separate oscillator. Its
/// eigenvalues are symmetric.
#[test]
fn exact_matches_general_solver_for_symmetric_eigenvalues() {
    let terms = [
        (Term::Dry(9.559507392151577), 0, 1),
        (Term::Spring(15.020480209025736), 2, 2),
        (Term::OneSided(100.0, 0.0), 1, 1),
    ];
    let starts = [[0.0, 0.0], [0.0, 0.633536162812156], [0.0, 0.0]];
    let spec = machine(&[1.0, 1.0, 0.7818489250388482], &starts, &terms);
    compare_solvers(&TestMotion::new(spec.model(), 0), 0.3, 1e-4).expect("the same motion");
}

/// The implicit solver uses the models' Jacobians and is compared with the most accurate solver for each model.
#[test]
fn radau_matches_best_solver_on_shipped_models() {
    for (name, until, reference) in [
        ("planetary_arm", 0.1, Solver::Exact),
        ("double_pendulum", 1.0, Solver::Rk),
        ("two_link_arm", 0.2, Solver::Rk),
        ("cart_two_arms", 0.2, Solver::Rk),
    ] {
        let path = eomgen_tests::models::path(name);
        let model = CompiledModel::load(&path, Orders::Declared).expect("a model");
        let instance = model.with_declared_parameters().expect("an instance");
        let times = grid(until, 16);
        let inputs = instance.default_inputs();
        let by = |solver| {
            let motion = instance.simulate(instance.initial_state(), &times, &inputs, solver);
            motion.expect("a motion").trajectory
        };
        let (found, expected) = (by(Solver::Radau), by(reference));
        assert_eq!(found.events.len(), expected.events.len(), "{name}");
        let off = difference(&found.states, &expected.states, 1e-9);
        println!("{name}: {off:e}, {:?}", found.statistics);
        assert!(off < 1e-6, "{name}: {off:e}");
    }
}
