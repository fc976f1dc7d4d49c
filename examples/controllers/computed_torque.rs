//! Computed-torque control of the two-link arm with its emitted inverse dynamics, compared with control by the same
//! gains without inverse dynamics. Three arms are controlled: the rigid arm of the controller's model, an arm with a
//! heavier tip, and an arm with flexible links. `rigid` and `flexible` are emitted by `eomgen generate`, see
//! docs/controllers.md.
//!
//! Method: M. W. Spong, S. Hutchinson and M. Vidyasagar, "Robot Modeling and Control", 2006,
//! section 8.3.

/// Step size and sample time of the torques, in s.
const STEP: f64 = 2.5e-4;
/// Duration of the reference motion, in s.
const WAY: f64 = 2.0;
/// Duration of a run, in s.
const DURATION: f64 = 2.5;
/// Start of the reference motion in rad; the arm hangs down.
const BEGIN: [f64; 2] = [-std::f64::consts::FRAC_PI_2, 0.0];
/// End of the reference motion, in rad.
const END: [f64; 2] = [0.3, 1.0];
/// Natural frequency of the critically damped error dynamics of a joint, in rad/s.
const BANDWIDTH: f64 = 20.0;

/// Returns angles, rates and accelerations of both joints at time `t` on the minimum-jerk trajectory.
fn path(t: f64) -> [[f64; 2]; 3] {
    let s = (t / WAY).clamp(0.0, 1.0);
    let along = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    let rate = 30.0 * s * s * (1.0 - s) * (1.0 - s) / WAY;
    let acceleration = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (WAY * WAY);
    let moved = |joint: usize, by: f64| by * (END[joint] - BEGIN[joint]);
    [
        [BEGIN[0] + moved(0, along), BEGIN[1] + moved(1, along)],
        [moved(0, rate), moved(1, rate)],
        [moved(0, acceleration), moved(1, acceleration)],
    ]
}

/// Returns the feedback accelerations for the errors of the joints.
fn back(t: f64, angles: [f64; 2], rates: [f64; 2]) -> [f64; 2] {
    let [wanted, wanted_rates, _] = path(t);
    let back = |j: usize| {
        BANDWIDTH * (BANDWIDTH * (wanted[j] - angles[j]) + 2.0 * (wanted_rates[j] - rates[j]))
    };
    [back(0), back(1)]
}

/// Returns the torques (N m) of the gains without inverse dynamics, with the initial inertia at each joint (kg m^2).
fn gains_alone(arm: &rigid::Coefficients, t: f64, angles: [f64; 2], rates: [f64; 2]) -> [f64; 2] {
    let begin = [BEGIN[0], BEGIN[1], 0.0, 0.0];
    let inertia = rigid::mass_matrix(0.0, &begin, &rigid::Inputs::default(), arm);
    let back = back(t, angles, rates);
    [inertia[0][0] * back[0], inertia[1][1] * back[1]]
}

/// Returns the computed torques (N m) by inverse dynamics of the rigid arm.
fn computed(arm: &rigid::Coefficients, t: f64, angles: [f64; 2], rates: [f64; 2]) -> [f64; 2] {
    let back = back(t, angles, rates);
    let [_, _, ahead] = path(t);
    let accelerations = [ahead[0] + back[0], ahead[1] + back[1]];
    let state = [angles[0], angles[1], rates[0], rates[1]];
    rigid::inverse_dynamics(t, &state, &rigid::Inputs::default(), arm, &accelerations)
}

/// Largest error of both joints during the motion and at the end, in rad.
struct Tracking {
    way: f64,
    end: f64,
}

/// Computes one step of the classical Runge-Kutta method.
fn runge_kutta_step<const N: usize>(
    t: f64,
    state: &[f64; N],
    rates: impl Fn(f64, &[f64; N]) -> [f64; N],
) -> [f64; N] {
    let moved = |by: f64, rate: &[f64; N]| std::array::from_fn(|i| state[i] + by * rate[i]);
    let one = rates(t, state);
    let two = rates(t + STEP / 2.0, &moved(STEP / 2.0, &one));
    let three = rates(t + STEP / 2.0, &moved(STEP / 2.0, &two));
    let four = rates(t + STEP, &moved(STEP, &three));
    std::array::from_fn(|i| state[i] + STEP / 6.0 * (one[i] + 2.0 * (two[i] + three[i]) + four[i]))
}

/// Simulates a machine of `N` states, whose first coordinates are the joints.
fn simulate<const N: usize>(
    law: impl Fn(f64, [f64; 2], [f64; 2]) -> [f64; 2],
    rates: impl Fn(f64, &[f64; N], [f64; 2]) -> [f64; N],
) -> Tracking {
    let mut state = [0.0; N];
    (state[0], state[1]) = (BEGIN[0], BEGIN[1]);
    let mut tracking = Tracking { way: 0.0, end: 0.0 };
    for count in 0..(DURATION / STEP).round() as u32 {
        let t = f64::from(count) * STEP;
        let torques = law(t, [state[0], state[1]], [state[N / 2], state[N / 2 + 1]]);
        state = runge_kutta_step(t, &state, |t, state| rates(t, state, torques));
        let wanted = path(t + STEP)[0];
        tracking.end = (state[0] - wanted[0]).hypot(state[1] - wanted[1]);
        assert!(tracking.end.is_finite(), "the arm is lost at t = {t} s");
        tracking.way = tracking.way.max(tracking.end);
    }
    tracking
}

/// Simulates a machine with both control laws; prints and returns their errors.
fn compare_control_laws<const N: usize>(
    name: &str,
    known: &rigid::Coefficients,
    rates: impl Fn(f64, &[f64; N], [f64; 2]) -> [f64; N],
) -> [Tracking; 2] {
    let alone = simulate(
        |t, angles, speeds| gains_alone(known, t, angles, speeds),
        &rates,
    );
    let computed = simulate(
        |t, angles, speeds| computed(known, t, angles, speeds),
        &rates,
    );
    println!(
        "{name:<20} gains alone {:8.3} mrad, {:8.3} at the end; computed torque {:7.3} mrad, {:7.3} at the end",
        1e3 * alone.way,
        1e3 * alone.end,
        1e3 * computed.way,
        1e3 * computed.end,
    );
    [alone, computed]
}

fn main() {
    let known = rigid::Coefficients::prepare(&rigid::Parameters::default());
    let of = |coefficients: rigid::Coefficients| {
        move |t, state: &[f64; rigid::STATES], u: [f64; 2]| {
            rigid::rates(
                t,
                state,
                &rigid::Inputs {
                    u_1: u[0],
                    u_2: u[1],
                },
                &coefficients,
            )
        }
    };
    let [alone, computed] = compare_control_laws("as known", &known, of(known.clone()));
    assert!(computed.way < 1e-3 && alone.way > 100.0 * computed.way);

    let heavier = rigid::Parameters {
        M_t: 0.36,
        ..rigid::Parameters::default()
    };
    let [alone, computed] = compare_control_laws(
        "tip 20 % heavier",
        &known,
        of(rigid::Coefficients::prepare(&heavier)),
    );
    assert!(computed.way < 0.02 && alone.way > 5.0 * computed.way);

    let bending = flexible::Coefficients::prepare(&flexible::Parameters::default());
    let [alone, computed] = compare_control_laws(
        "links that bend",
        &known,
        |t, state: &[f64; flexible::STATES], u: [f64; 2]| {
            flexible::rates(
                t,
                state,
                &flexible::Inputs {
                    u_1: u[0],
                    u_2: u[1],
                },
                &bending,
            )
        },
    );
    assert!(alone.way > computed.way);
}
