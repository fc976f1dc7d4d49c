//! An extended Kalman filter for the planetary arm on its test rig, with the rates and the Jacobians
//! that eomgen emitted. It feeds the state feedback of `controller`. Nothing of a board is here.
//!
//! The method: A. Gelb (ed.), "Applied Optimal Estimation", 1974, section 6.1, continuous
//! motion and discrete measurements, which are taken in one after the other.
#![no_std]
#![forbid(unsafe_code)]

use arm::{OBSERVABLES, OBSERVABLES_BY_STATE, RATES_BY_STATE, STATES};
use controller::{Coefficients, Inputs, STEP, State, driven, torque};

/// Positions, and as many rates.
const HALF: usize = STATES / 2;

/// A matrix of the state's size, row by row.
type Matrix = [State; STATES];

/// Sensors.
pub const SENSORS: usize = 3;
/// What they measure, by the number of the observable: the angles of the sun and of the carrier,
/// rad, and, by a strain gauge, the deflection of the arm's end, m.
pub const MEASURED: [usize; SENSORS] = [0, 2, 3];
/// What they are off by: one standard deviation, rad, rad and m.
pub const DEVIATION: [f64; SENSORS] = [1e-4, 2e-5, 2e-5];

/// One standard deviation of the state where a run begins: the deflections of the meshes, the
/// carrier's path and the modes, m, then the rates of all, m/s.
const BEGIN: State = [
    3e-5, 3e-5, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1,
];
/// What the linearisation does not know of the meshes' forces, where play opens and closes: white
/// noise, as the deflection that would make such a force, m s^(1/2).
const FORCES: f64 = 1e-7;

/// The estimate of the state and what is known of its error.
pub struct Observer {
    /// The estimate.
    pub state: State,
    /// The covariance of its error, SI.
    covariance: Matrix,
    /// The rates of all by the deflection of each mesh, where both are in contact.
    by_meshes: [State; 2],
    /// Measured values that were no numbers, and were left out.
    pub left_out: u32,
}

/// The Jacobian of the rates by the state.
fn jacobian(t: f64, state: &State, torque: f64, coefficients: &Coefficients) -> Matrix {
    let inputs = Inputs { u: torque };
    RATES_BY_STATE.dense(&arm::rates_by_state(t, state, &inputs, coefficients))
}

/// to + factor from
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

/// Each column of a matrix after a step of the linearised motion: rates first, and positions by the new
/// rates (the symplectic method of Euler), so that oscillations do not grow.
fn carried(matrix: &Matrix, jacobian: &Matrix) -> Matrix {
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
    /// At rest, as far as is known.
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

    /// The torque of the controller for the estimate, N m.
    pub fn torque(&self) -> f64 {
        torque(&self.state)
    }

    /// One step after time `t`, s, under the torque that the arm is given, N m.
    pub fn step(&mut self, t: f64, torque: f64, coefficients: &Coefficients) {
        let jacobian = jacobian(t, &self.state, torque, coefficients);
        let half = transposed(&carried(&self.covariance, &jacobian));
        let both = carried(&half, &jacobian);
        // As much as its transpose: left alone, what rounding makes of their difference grows and
        // ruins the filter within a third of a second.
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

    /// Takes in what the sensors say at time `t`, s. What is no number is left out, and counted.
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
            self.taken(&slopes[observable], larger, DEVIATION[sensor]);
        }
    }

    /// Takes in by how much a quantity was measured larger than expected, given its slopes.
    fn taken(&mut self, slopes: &State, larger: f64, deviation: f64) {
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
