//! Simulation of the arm, measurements, and propagation of columns along the motion.

use arm::{Coefficients, Inputs, STATES};

pub type State = [f64; STATES];

/// Step size, in s.
pub const STEP: f64 = 1e-5;
/// Number of steps per measurement.
pub const STEPS: usize = 100;
/// Number of measurements.
pub const MEASUREMENTS: usize = 100;
/// Indices of the measured observables and standard deviations of the noise: angle of the sun (rad), angle of the
/// carrier (rad), deflection of the arm's end (m).
pub const MEASURED: [(usize, f64); 3] = [(0, 1e-4), (2, 2e-5), (3, 1e-5)];
/// Torque in N m that keeps the meshes in contact on one side.
pub const TORQUE: f64 = 3.0;
/// Standard deviation of the unknown torque disturbance in N m. The disturbance is drawn for each measurement.
pub const DISTURBANCE: f64 = 0.05;
/// Initial deflections of both meshes in m; both are in contact.
pub const DEFLECTION: f64 = 25.5e-6;
/// Indices and standard deviations of uncertain initial states: deflections of the meshes, displacement of the carrier,
/// two modes (m), and rate of the carrier (m/s).
pub const UNCERTAIN: [(usize, f64); 6] = [
    (0, 1e-7),
    (1, 1e-7),
    (2, 1e-3),
    (3, 1e-4),
    (4, 1e-5),
    (21, 1e-2),
];
/// Generator of approximately standard normal numbers: sums of twelve uniform numbers.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut uniform = || {
            // Knuth's constants of a 64-bit linear congruential generator.
            self.0 = self
                .0
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..12).map(|_| uniform()).sum::<f64>() - 6.0
    }
}

pub fn add_scaled(state: &State, by: f64, rate: &State) -> State {
    std::array::from_fn(|i| state[i] + by * rate[i])
}

/// Computes a Runge-Kutta step of a state and of columns. The columns follow the equations linearised at the state of
/// each stage. `times` multiplies columns by the Jacobian.
pub fn runge_kutta_step(
    arm: &Coefficients,
    t: f64,
    disturbance: f64,
    state: &mut State,
    columns: &mut [State],
    times: impl Fn(f64, &State, &Inputs, &[State]) -> Vec<State>,
) {
    const ALONG: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
    const WEIGHT: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
    let (begin, first) = (*state, columns.to_vec());
    let (mut rate, mut rates) = ([0.0; STATES], vec![[0.0; STATES]; columns.len()]);
    for (along, weight) in ALONG.iter().zip(WEIGHT) {
        let (t, by) = (t + along * STEP, along * STEP);
        let at = add_scaled(&begin, by, &rate);
        let inputs = Inputs {
            u: TORQUE + disturbance,
        };
        let carried: Vec<State> = first
            .iter()
            .zip(&rates)
            .map(|(column, rate)| add_scaled(column, by, rate))
            .collect();
        rate = arm::rates(t, &at, &inputs, arm);
        rates = times(t, &at, &inputs, &carried);
        *state = add_scaled(state, weight * STEP, &rate);
        for (column, rate) in columns.iter_mut().zip(&rates) {
            *column = add_scaled(column, weight * STEP, rate);
        }
    }
}

/// Returns an observable of a state or of a column; the measured observables are linear.
pub fn measured(arm: &Coefficients, t: f64, state: &State, which: usize) -> f64 {
    arm::observables(t, state, &Inputs::default(), arm)[which]
}

/// Returns the initial estimate.
pub fn expected() -> State {
    let mut state = [0.0; STATES];
    (state[0], state[1]) = (DEFLECTION, DEFLECTION);
    state
}

/// Returns the columns S of the initial covariance S S'.
pub fn begin() -> Vec<State> {
    let column = |(which, deviation): &(usize, f64)| {
        let mut column = [0.0; STATES];
        column[*which] = *deviation;
        column
    };
    UNCERTAIN.iter().map(column).collect()
}

/// Simulates the disturbed arm from a state that the filters do not know. Returns state and measurements after each
/// measurement period.
pub fn motion(arm: &Coefficients) -> Vec<(State, [f64; MEASURED.len()])> {
    let mut noise = Noise(7);
    let mut state = expected();
    for (which, deviation) in UNCERTAIN {
        state[which] += deviation * noise.next();
    }
    let mut after = |period: usize| {
        let disturbance = DISTURBANCE * noise.next();
        for count in period * STEPS..(period + 1) * STEPS {
            let t = STEP * count as f64;
            runge_kutta_step(arm, t, disturbance, &mut state, &mut [], |_, _, _, _| {
                Vec::new()
            });
        }
        let t = STEP * ((period + 1) * STEPS) as f64;
        let record = MEASURED
            .map(|(which, deviation)| measured(arm, t, &state, which) + deviation * noise.next());
        (state, record)
    };
    (0..MEASUREMENTS).map(&mut after).collect()
}
