//! Extended Kalman filter for the planetary arm on its test rig, with emitted rates and Jacobians. The state feedback
//! in `controller` uses its estimate.
//!
//! Method: A. Gelb (ed.), "Applied Optimal Estimation", 1974, section 6.1, continuous-discrete filter with sequential
//! updates.
#![no_std]
#![forbid(unsafe_code)]

use arm::{OBSERVABLES, OBSERVABLES_BY_STATE, RATES_BY_STATE, STATES};
use controller::{Coefficients, Inputs, STEP, State, driven, torque};

/// Number of positions, which equals the number of rates.
const HALF: usize = STATES / 2;

/// Square matrix of the state's size, row by row.
type Matrix = [State; STATES];

/// Number of sensors.
pub const SENSORS: usize = 3;
/// Indices of the measured observables: angles of the sun and of the carrier (rad), and deflection of the arm's end
/// (m), measured by a strain gauge.
pub const MEASURED: [usize; SENSORS] = [0, 2, 3];
/// Standard deviations of the sensor noise (rad, rad, m).
pub const DEVIATION: [f64; SENSORS] = [1e-4, 2e-5, 2e-5];

/// Standard deviations of the initial state: deflections of the meshes, displacement of the carrier and modes (m), then
/// their rates (m/s).
const BEGIN: State = [
    3e-5, 3e-5, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1,
];
/// White noise of the mesh forces, as an equivalent deflection in m s^(1/2). It accounts for changes of contact, which
/// the linearisation does not contain.
const FORCES: f64 = 1e-7;

/// Observer: estimate of the state, and covariance of the estimation error.
pub struct Observer {
    /// Estimate of the state.
    pub state: State,
    /// Covariance of the estimation error, SI.
    covariance: Matrix,
    /// Derivatives of the rates by the deflection of each mesh, for both meshes in contact.
    by_meshes: [State; 2],
    /// Number of measured values that were skipped because they were NaN.
    pub left_out: u32,
}

/// Computes the Jacobian of the rates by the state.
fn jacobian(t: f64, state: &State, torque: f64, coefficients: &Coefficients) -> Matrix {
    let inputs = Inputs { u: torque };
    RATES_BY_STATE.dense(&arm::rates_by_state(t, state, &inputs, coefficients))
}

/// Adds `factor` times `from` to `to`.
fn add(to: &mut State, factor: f64, from: &State) {
    for (number, other) in to.iter_mut().zip(from) {
        *number += factor * other;
    }
}

fn transposed(matrix: &Matrix) -> Matrix {
    let mut transposed = [[0.0; STATES]; STATES];
    for (i, row) in transposed.iter_mut().enumerate() {
        for (number, line) in row.iter_mut().zip(matrix) {
            *number = line[i];
        }
    }
    transposed
}

/// Computes one step of the linearised motion for each column of a matrix by the symplectic Euler method: rates first,
/// then positions with the new rates. With this method, amplitudes of oscillations do not grow.
fn propagate_columns(matrix: &Matrix, jacobian: &Matrix) -> Matrix {
    let mut carried = *matrix;
    for i in 0..HALF {
        for (factor, line) in jacobian[HALF + i].iter().zip(matrix) {
            add(&mut carried[HALF + i], STEP * factor, line);
        }
    }
    for i in 0..HALF {
        let rate = carried[HALF + i];
        add(&mut carried[i], STEP, &rate);
    }
    carried
}

impl Observer {
    /// Creates an observer whose initial estimate is at rest.
    pub fn new(coefficients: &Coefficients) -> Self {
        let mut contact = [0.0; STATES];
        (contact[0], contact[1]) = (1e-3, 1e-3);
        let jacobian = jacobian(0.0, &contact, 0.0, coefficients);
        let mut by_meshes = [[0.0; STATES]; 2];
        let mut covariance = [[0.0; STATES]; STATES];
        for i in 0..STATES {
            covariance[i][i] = BEGIN[i] * BEGIN[i];
            (by_meshes[0][i], by_meshes[1][i]) = (jacobian[i][0], jacobian[i][1]);
        }
        Self {
            state: [0.0; STATES],
            covariance,
            by_meshes,
            left_out: 0,
        }
    }

    /// Returns the torque of the controller for the estimate, in N m.
    pub fn torque(&self) -> f64 {
        torque(&self.state)
    }

    /// Propagates the estimate over one step after time `t` (in s) for a torque (in N m).
    pub fn step(&mut self, t: f64, torque: f64, coefficients: &Coefficients) {
        let jacobian = jacobian(t, &self.state, torque, coefficients);
        let half = transposed(&propagate_columns(&self.covariance, &jacobian));
        let both = propagate_columns(&half, &jacobian);
        // The covariance is symmetrised. Otherwise its asymmetry, a rounding error, would grow, and the filter would
        // fail within a third of a second.
        let other = transposed(&both);
        for i in 0..STATES {
            let mut row = [0.0; STATES];
            add(&mut row, 0.5, &both[i]);
            add(&mut row, 0.5, &other[i]);
            for by_mesh in &self.by_meshes {
                add(&mut row, FORCES * FORCES * STEP * by_mesh[i], by_mesh);
            }
            self.covariance[i] = row;
        }
        self.state = driven(t, &self.state, torque, coefficients);
    }

    /// Updates the estimate with the sensor values at time `t` (in s). NaN values are skipped and counted.
    pub fn measured(&mut self, t: f64, values: &[f64; SENSORS], coefficients: &Coefficients) {
        let inputs = Inputs::default();
        for sensor in 0..SENSORS {
            if !values[sensor].is_finite() {
                self.left_out += 1;
                continue;
            }
            let expected = arm::observables(t, &self.state, &inputs, coefficients);
            let nonzeros = arm::observables_by_state(t, &self.state, &inputs, coefficients);
            let slopes: [State; OBSERVABLES] = OBSERVABLES_BY_STATE.dense(&nonzeros);
            let observable = MEASURED[sensor];
            let larger = values[sensor] - expected[observable];
            self.apply_residual(&slopes[observable], larger, DEVIATION[sensor]);
        }
    }

    /// Updates the estimate with the residual `larger` of a measured quantity; `slopes` are the derivatives of the
    /// quantity by the state.
    fn apply_residual(&mut self, slopes: &State, larger: f64, deviation: f64) {
        let mut direction = [0.0; STATES];
        let mut variance = deviation * deviation;
        for i in 0..STATES {
            add(&mut direction, slopes[i], &self.covariance[i]);
        }
        for i in 0..STATES {
            variance += slopes[i] * direction[i];
        }
        add(&mut self.state, larger / variance, &direction);
        for i in 0..STATES {
            add(
                &mut self.covariance[i],
                -direction[i] / variance,
                &direction,
            );
        }
    }
}
