//! Variants for the tests of the certificate: textbook equations with optional faults.

use super::certify::ScaledRates;
use super::oracle::Oracle;
use super::variant::Variant;
use nalgebra::{DMatrix, DVector};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    None,
    VelocitySign,
    Coupling,
    /// Asymmetry of the mass matrix, fifty times its rounding.
    Asymmetry,
    Energy,
    Power,
    Guard,
    NotANumber,
    WrongRate,
    Refusal,
}

pub(super) struct DoublePendulum(pub Fault);

const G: f64 = 9.81;
const M_1: f64 = 1.3;
const M_2: f64 = 0.7;
const L_1: f64 = 0.9;
const L_2: f64 = 0.6;
const C: f64 = 0.2;

impl DoublePendulum {
    fn mass(&self, state: &[f64]) -> [f64; 4] {
        let coupling = M_2 * L_1 * L_2 * (state[0] - state[1]).cos();
        [(M_1 + M_2) * L_1 * L_1, coupling, coupling, M_2 * L_2 * L_2]
    }

    fn bias(&self, state: &[f64]) -> [f64; 2] {
        let gyration = M_2 * L_1 * L_2 * (state[0] - state[1]).sin();
        let sign = if self.0 == Fault::VelocitySign {
            -1.0
        } else {
            1.0
        };
        [
            gyration * state[3].powi(2),
            -sign * gyration * state[2].powi(2),
        ]
    }

    fn forces(&self, state: &[f64]) -> [f64; 2] {
        let joint = C * (state[3] - state[2]);
        [
            -(M_1 + M_2) * G * L_1 * state[0].sin() + joint,
            -M_2 * G * L_2 * state[1].sin() - joint,
        ]
    }
}

impl Variant for DoublePendulum {
    fn coordinate_names(&self) -> Vec<String> {
        vec!["theta_1".into(), "theta_2".into()]
    }

    fn rates(&mut self, _: f64, state: &[f64], _: &[f64], rates: &mut [f64]) -> Result<(), String> {
        let [m_11, mut m_12, m_21, m_22] = self.mass(state);
        if self.0 == Fault::Coupling {
            m_12 = 0.0;
        }
        let (bias, forces) = (self.bias(state), self.forces(state));
        let (f_1, f_2) = (forces[0] - bias[0], forces[1] - bias[1]);
        let determinant = m_11 * m_22 - m_12 * m_21;
        rates[..2].copy_from_slice(&state[2..]);
        rates[2] = (m_22 * f_1 - m_12 * f_2) / determinant;
        rates[3] = (m_11 * f_2 - m_21 * f_1) / determinant;
        match self.0 {
            Fault::NotANumber => rates[3] = f64::NAN,
            Fault::WrongRate => rates[0] = state[3],
            Fault::Refusal => return Err("a pivot is not positive".into()),
            _ => {}
        }
        Ok(())
    }

    fn mass_matrix(
        &mut self,
        _: f64,
        state: &[f64],
        _: &[f64],
        mass: &mut [f64],
    ) -> Result<(), String> {
        mass.copy_from_slice(&self.mass(state));
        if self.0 == Fault::Asymmetry {
            mass[1] *= 1.0 + 1e-14;
        }
        Ok(())
    }

    fn bias_and_forces(
        &mut self,
        _: f64,
        state: &[f64],
        _: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String> {
        bias.copy_from_slice(&self.bias(state));
        forces.copy_from_slice(&self.forces(state));
        Ok(())
    }

    fn energy(&mut self, _: f64, state: &[f64], _: &[f64]) -> Result<f64, String> {
        let [m_11, m_12, _, m_22] = self.mass(state);
        let (first, second) = (state[2], state[3]);
        let kinetic = 0.5 * (m_11 * first * first + m_22 * second * second) + m_12 * first * second;
        let height = -(M_1 + M_2) * L_1 * state[0].cos() - M_2 * L_2 * state[1].cos();
        let share = if self.0 == Fault::Energy { 0.0 } else { 1.0 };
        Ok(share * kinetic + G * height)
    }

    fn power(&mut self, _: f64, state: &[f64], _: &[f64]) -> Result<f64, String> {
        let sign = if self.0 == Fault::Power { 1.0 } else { -1.0 };
        Ok(sign * C * (state[3] - state[2]).powi(2))
    }

    fn guards(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }

    fn observables(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }
}

pub(super) struct Spring(pub Fault);

impl Variant for Spring {
    fn coordinate_names(&self) -> Vec<String> {
        vec!["y".into()]
    }

    fn rates(
        &mut self,
        _: f64,
        state: &[f64],
        inputs: &[f64],
        rates: &mut [f64],
    ) -> Result<(), String> {
        let [mut bias, mut forces] = [[0.0]; 2];
        self.bias_and_forces(0.0, state, inputs, &mut bias, &mut forces)?;
        rates.copy_from_slice(&[state[1], forces[0] / 2.0]);
        Ok(())
    }

    fn mass_matrix(
        &mut self,
        _: f64,
        _: &[f64],
        _: &[f64],
        mass: &mut [f64],
    ) -> Result<(), String> {
        mass.copy_from_slice(&[2.0]);
        Ok(())
    }

    fn bias_and_forces(
        &mut self,
        _: f64,
        state: &[f64],
        inputs: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String> {
        let (y, rate) = (state[0], state[1]);
        let stretch = y - y.clamp(-0.01, 0.01);
        let touching = if y.abs() > 0.01 { 1.0 } else { 0.0 };
        bias.copy_from_slice(&[0.0]);
        forces.copy_from_slice(&[inputs[0] - 300.0 * stretch - 5.0 * touching * rate]);
        Ok(())
    }

    fn energy(&mut self, _: f64, state: &[f64], _: &[f64]) -> Result<f64, String> {
        let stretch = state[0] - state[0].clamp(-0.01, 0.01);
        Ok(state[1] * state[1] + 150.0 * stretch * stretch)
    }

    fn power(&mut self, _: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String> {
        let touching = if state[0].abs() > 0.01 { 1.0 } else { 0.0 };
        Ok(state[1] * inputs[0] - 5.0 * touching * state[1] * state[1])
    }

    fn guards(&mut self, _: f64, state: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        let mut guards = vec![state[0] - 0.01, state[0] + 0.01];
        if self.0 == Fault::Guard {
            guards.pop();
        }
        Ok(guards)
    }

    fn observables(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }
}

pub(super) struct SingleCoordinate {
    pub name: &'static str,
    pub mass: fn(f64, f64, f64) -> f64,
    pub acceleration: fn(f64, f64, f64) -> f64,
    pub energy: fn(f64, f64, f64) -> f64,
    pub power: fn(f64, f64, f64) -> f64,
}

/// Rotor of 2 kg at a radius of 0.5 m.
pub(super) const FREE_ROTOR: SingleCoordinate = SingleCoordinate {
    name: "theta",
    mass: |_, _, _| 0.5,
    acceleration: |_, _, _| 0.0,
    energy: |_, _, rate| 0.25 * rate * rate,
    power: |_, _, _| 0.0,
};

/// Tank with a mass of 2 kg (2 + sin t) on a spring of 30 N/m.
pub(super) const TIMED_TANK: SingleCoordinate = SingleCoordinate {
    name: "x",
    mass: |t, _, _| 2.0 * (2.0 + t.sin()),
    acceleration: |t, x, rate| -(30.0 * x + 2.0 * t.cos() * rate) / (2.0 * (2.0 + t.sin())),
    energy: |t, x, rate| rate * rate * (2.0 + t.sin()) + 15.0 * x * x,
    power: |t, _, rate| -rate * rate * t.cos(),
};

/// Mass of 2 kg in a logarithmic potential of 3 J.
pub(super) const LOGARITHMIC: SingleCoordinate = SingleCoordinate {
    name: "x",
    mass: |_, _, _| 2.0,
    acceleration: |_, x, _| (3.0 / x - 3.0) / 2.0,
    energy: |_, x, rate| rate * rate - 3.0 * x.ln() + 3.0 * x,
    power: |_, _, _| 0.0,
};

/// Mass of 2 kg on a spring of 30 N/m, with a term beyond 3 m.
pub(super) const FAR_TERM: SingleCoordinate = SingleCoordinate {
    name: "x",
    mass: |_, _, _| 2.0,
    acceleration: |_, x, _| -15.0 * x,
    energy: |_, x, rate| rate * rate + 4.0 * rate * (x - 3.0).max(0.0) + 15.0 * x * x,
    power: |_, x, rate| {
        let beyond = if x > 3.0 { rate * rate } else { 0.0 };
        4.0 * (-15.0 * x * (x - 3.0).max(0.0) + beyond)
    },
};

impl Variant for SingleCoordinate {
    fn coordinate_names(&self) -> Vec<String> {
        vec![self.name.into()]
    }

    fn rates(&mut self, t: f64, state: &[f64], _: &[f64], rates: &mut [f64]) -> Result<(), String> {
        rates.copy_from_slice(&[state[1], (self.acceleration)(t, state[0], state[1])]);
        Ok(())
    }

    fn mass_matrix(
        &mut self,
        t: f64,
        state: &[f64],
        _: &[f64],
        mass: &mut [f64],
    ) -> Result<(), String> {
        mass.copy_from_slice(&[(self.mass)(t, state[0], state[1])]);
        Ok(())
    }

    /// Only certificates of models with fields call this method.
    fn bias_and_forces(
        &mut self,
        _: f64,
        _: &[f64],
        _: &[f64],
        _: &mut [f64],
        _: &mut [f64],
    ) -> Result<(), String> {
        Err("not supported".into())
    }

    fn energy(&mut self, t: f64, state: &[f64], _: &[f64]) -> Result<f64, String> {
        Ok((self.energy)(t, state[0], state[1]))
    }

    fn power(&mut self, t: f64, state: &[f64], _: &[f64]) -> Result<f64, String> {
        Ok((self.power)(t, state[0], state[1]))
    }

    fn guards(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }

    fn observables(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }
}

pub(super) struct Preload;

impl Preload {
    fn force(y: f64) -> f64 {
        let stretch = y - y.clamp(-0.01, 0.01);
        let side = if stretch == 0.0 {
            0.0
        } else {
            stretch.signum()
        };
        -7.0 * side - 300.0 * stretch
    }

    /// Returns the derivative of a solver; with `faulty` it treats zero as negative.
    pub fn derivative(faulty: bool) -> impl Fn(f64, &[f64], &[f64]) -> Result<ScaledRates, String> {
        move |_, state: &[f64], _: &[f64]| {
            let inside = state[0].abs() <= 0.01;
            let force = if faulty && inside {
                7.0
            } else {
                Self::force(state[0])
            };
            Ok(ScaledRates {
                rates: vec![state[1], force / 2.0],
                magnitudes: vec![state[1].abs(), 3.5 + 150.0 * (state[0].abs() + 0.01)],
            })
        }
    }
}

impl Variant for Preload {
    fn coordinate_names(&self) -> Vec<String> {
        vec!["y".into()]
    }

    fn rates(&mut self, _: f64, state: &[f64], _: &[f64], rates: &mut [f64]) -> Result<(), String> {
        rates.copy_from_slice(&[state[1], Self::force(state[0]) / 2.0]);
        Ok(())
    }

    fn mass_matrix(
        &mut self,
        _: f64,
        _: &[f64],
        _: &[f64],
        mass: &mut [f64],
    ) -> Result<(), String> {
        mass.copy_from_slice(&[2.0]);
        Ok(())
    }

    fn bias_and_forces(
        &mut self,
        _: f64,
        state: &[f64],
        _: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String> {
        bias.copy_from_slice(&[0.0]);
        forces.copy_from_slice(&[Self::force(state[0])]);
        Ok(())
    }

    fn energy(&mut self, _: f64, state: &[f64], _: &[f64]) -> Result<f64, String> {
        Ok(state[1] * state[1])
    }

    fn power(&mut self, _: f64, state: &[f64], _: &[f64]) -> Result<f64, String> {
        Ok(state[1] * Self::force(state[0]))
    }

    fn guards(&mut self, _: f64, state: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        let stretch = state[0] - state[0].clamp(-0.01, 0.01);
        Ok(vec![state[0] - 0.01, state[0] + 0.01, stretch, -stretch])
    }

    fn observables(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }
}

/// Kernels of its regimes as emitted source. The force within the play is `WITHIN`.
pub(super) const KERNELS: &str = r"#![no_std]
pub const STATES: usize = 2;
#[derive(Default)]
pub struct Inputs {}
#[derive(Default)]
pub struct Parameters {}
pub struct Coefficients {}
impl Coefficients {
    pub fn prepare(_: &Parameters) -> Self {
        Self {}
    }
}
pub fn regime(_: f64, state: &[f64; STATES], _: &Inputs, _: &Coefficients) -> u32 {
    let y = state[0];
    if y > 0.01 { 7 } else if y < -0.01 { 8 } else { 2 }
}
pub fn rates_in_regime_into<const REGIME: u32, T: Copy + Into<f64>>(
    _: f64, state: &[T; STATES], _: &Inputs, _: &Coefficients, rates: &mut [f64; STATES],
) {
    let y: f64 = state[0].into();
    let force = match REGIME {
        7 => -7.0 - 300.0 * (y - 0.01),
        8 => 7.0 - 300.0 * (y + 0.01),
        _ => WITHIN,
    };
    *rates = [state[1].into(), force / 2.0];
}
";

/// Beam with the oracle's own equations, for the comparison of two orders.
pub(super) struct Beam {
    pub oracle: Oracle,
    /// True if the third mode is coupled to the hub.
    pub coupled: bool,
}

impl Beam {
    fn sides(&self, state: &[f64], inputs: &[f64]) -> Result<(DMatrix<f64>, DVector<f64>), String> {
        let equations = self.oracle.equations(0.0, state, inputs);
        let mut equations = equations.map_err(|error| error.to_string())?;
        let modes = equations.size() - 1;
        if !self.coupled && modes > 3 {
            equations.mass[(0, 3)] = 0.0;
            equations.mass[(3, 0)] = 0.0;
        }
        let right = equations.right_side();
        Ok((equations.mass, right))
    }
}

impl Variant for Beam {
    fn coordinate_names(&self) -> Vec<String> {
        self.oracle.names().to_vec()
    }

    fn rates(
        &mut self,
        _: f64,
        state: &[f64],
        inputs: &[f64],
        rates: &mut [f64],
    ) -> Result<(), String> {
        let (mass, right) = self.sides(state, inputs)?;
        let solution = mass
            .cholesky()
            .ok_or("not positive definite")?
            .solve(&right);
        let size = right.len();
        rates[..size].copy_from_slice(&state[size..]);
        rates[size..].copy_from_slice(solution.as_slice());
        Ok(())
    }

    fn mass_matrix(
        &mut self,
        _: f64,
        state: &[f64],
        inputs: &[f64],
        out: &mut [f64],
    ) -> Result<(), String> {
        out.copy_from_slice(self.sides(state, inputs)?.0.transpose().as_slice());
        Ok(())
    }

    fn bias_and_forces(
        &mut self,
        _: f64,
        state: &[f64],
        inputs: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String> {
        bias.fill(0.0);
        forces.copy_from_slice(self.sides(state, inputs)?.1.as_slice());
        Ok(())
    }

    fn energy(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String> {
        let energy = self.oracle.energy(time, state, inputs);
        Ok(energy.map_err(|error| error.to_string())?.value)
    }

    fn power(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String> {
        let power = self.oracle.power(time, state, inputs);
        Ok(power.map_err(|error| error.to_string())?.value)
    }

    fn guards(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }

    fn observables(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }
}

/// Spring as emitted source, only rates and energy.
pub(super) const EMITTED: &str = r"#![no_std]
pub const STATES: usize = 2;
#[derive(Default)]
pub struct Inputs {
    pub u: f64,
}
pub struct Parameters {
    pub m: f64,
}
impl Default for Parameters {
    fn default() -> Self {
        Self { m: 2.0 }
    }
}
pub struct Coefficients {
    pub m: f64,
}
impl Coefficients {
    pub fn prepare(parameters: &Parameters) -> Self {
        Self { m: parameters.m }
    }
}
pub fn rates(_: f64, state: &[f64; STATES], inputs: &Inputs, c: &Coefficients) -> [f64; STATES] {
    let stretch = state[0] - state[0].clamp(-0.01, 0.01);
    let touching = if state[0].abs() > 0.01 { 1.0 } else { 0.0 };
    [state[1], (inputs.u - 300.0 * stretch - 5.0 * touching * state[1]) / c.m]
}
pub fn energy(_: f64, state: &[f64; STATES], _: &Inputs, _: &Coefficients) -> f64 {
    let stretch = state[0] - state[0].clamp(-0.01, 0.01);
    state[1] * state[1] + 150.0 * stretch * stretch
}
";
