//! Variants for the tests of the certificate: textbook equations with optional faults.

use super::certify::ScaledRates;
use super::oracle::{Oracle, OracleError};
use super::variant::Variant;

/// Quantities of a model at one state.
#[derive(Default)]
pub(super) struct Quantities {
    pub mass: Vec<f64>,
    pub bias: Vec<f64>,
    pub forces: Vec<f64>,
    pub rates: Vec<f64>,
    pub energy: f64,
    pub power: f64,
    pub guards: Vec<f64>,
}

/// Hand-written equations of a model without observables.
pub(super) trait Equations {
    fn names(&self) -> Vec<String>;

    fn evaluate(&self, time: f64, state: &[f64], inputs: &[f64]) -> Result<Quantities, String>;
}

impl<T: Equations> Variant for T {
    fn coordinate_names(&self) -> Vec<String> {
        self.names()
    }

    fn rates(&mut self, t: f64, x: &[f64], u: &[f64], rates: &mut [f64]) -> Result<(), String> {
        rates.copy_from_slice(&self.evaluate(t, x, u)?.rates);
        Ok(())
    }

    fn mass_matrix(&mut self, t: f64, x: &[f64], u: &[f64], m: &mut [f64]) -> Result<(), String> {
        m.copy_from_slice(&self.evaluate(t, x, u)?.mass);
        Ok(())
    }

    fn bias_and_forces(
        &mut self,
        t: f64,
        x: &[f64],
        u: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String> {
        let found = self.evaluate(t, x, u)?;
        bias.copy_from_slice(&found.bias);
        forces.copy_from_slice(&found.forces);
        Ok(())
    }

    fn energy(&mut self, t: f64, x: &[f64], u: &[f64]) -> Result<f64, String> {
        Ok(self.evaluate(t, x, u)?.energy)
    }

    fn power(&mut self, t: f64, x: &[f64], u: &[f64]) -> Result<f64, String> {
        Ok(self.evaluate(t, x, u)?.power)
    }

    fn guards(&mut self, t: f64, x: &[f64], u: &[f64]) -> Result<Vec<f64>, String> {
        Ok(self.evaluate(t, x, u)?.guards)
    }

    fn observables(&mut self, _: f64, _: &[f64], _: &[f64]) -> Result<Vec<f64>, String> {
        Ok(Vec::new())
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fault {
    None,
    VelocitySign,
    Coupling,
    /// Asymmetry of the mass matrix, fifty times its rounding error.
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

impl Equations for DoublePendulum {
    fn names(&self) -> Vec<String> {
        vec!["theta_1".into(), "theta_2".into()]
    }

    fn evaluate(&self, _: f64, state: &[f64], _: &[f64]) -> Result<Quantities, String> {
        let [a, b, first, second] = *state else {
            return Err("four states".into());
        };
        let fault = self.0;
        let coupling = M_2 * L_1 * L_2 * (a - b).cos();
        let (m_11, m_22) = ((M_1 + M_2) * L_1 * L_1, M_2 * L_2 * L_2);
        let gyration = M_2 * L_1 * L_2 * (a - b).sin();
        let sign = if fault == Fault::VelocitySign {
            1.0
        } else {
            -1.0
        };
        let bias = [gyration * second * second, sign * gyration * first * first];
        let joint = C * (second - first);
        let forces = [
            -(M_1 + M_2) * G * L_1 * a.sin() + joint,
            -M_2 * G * L_2 * b.sin() - joint,
        ];
        let (f_1, f_2) = (forces[0] - bias[0], forces[1] - bias[1]);
        let m_12 = if fault == Fault::Coupling {
            0.0
        } else {
            coupling
        };
        let determinant = m_11 * m_22 - m_12 * coupling;
        let mut rates = vec![
            first,
            second,
            (m_22 * f_1 - m_12 * f_2) / determinant,
            (m_11 * f_2 - coupling * f_1) / determinant,
        ];
        match fault {
            Fault::NotANumber => rates[3] = f64::NAN,
            Fault::WrongRate => rates[0] = second,
            Fault::Refusal => return Err("a pivot is not positive".into()),
            _ => {}
        }
        let asymmetry = if fault == Fault::Asymmetry {
            1e-14
        } else {
            0.0
        };
        let kinetic =
            0.5 * (m_11 * first * first + m_22 * second * second) + coupling * first * second;
        let height = -(M_1 + M_2) * L_1 * a.cos() - M_2 * L_2 * b.cos();
        let share = if fault == Fault::Energy { 0.0 } else { 1.0 };
        let dissipation = C * (second - first).powi(2);
        Ok(Quantities {
            mass: vec![m_11, coupling * (1.0 + asymmetry), coupling, m_22],
            bias: bias.to_vec(),
            forces: forces.to_vec(),
            rates,
            energy: share * kinetic + G * height,
            power: if fault == Fault::Power {
                dissipation
            } else {
                -dissipation
            },
            guards: Vec::new(),
        })
    }
}

pub(super) struct Spring(pub Fault);

impl Equations for Spring {
    fn names(&self) -> Vec<String> {
        vec!["y".into()]
    }

    fn evaluate(&self, _: f64, state: &[f64], inputs: &[f64]) -> Result<Quantities, String> {
        let (y, rate) = (state[0], state[1]);
        let stretch = y - y.clamp(-0.01, 0.01);
        let touching = if y.abs() > 0.01 { 1.0 } else { 0.0 };
        let force = inputs[0] - 300.0 * stretch - 5.0 * touching * rate;
        let mut guards = vec![y - 0.01, y + 0.01];
        if self.0 == Fault::Guard {
            guards.pop();
        }
        Ok(Quantities {
            mass: vec![2.0],
            bias: vec![0.0],
            forces: vec![force],
            rates: vec![rate, force / 2.0],
            energy: rate * rate + 150.0 * stretch * stretch,
            power: rate * inputs[0] - 5.0 * touching * rate * rate,
            guards,
        })
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

/// Mass of 2 kg on a spring of 30 N/m, with an additional force beyond 3 m.
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

impl Equations for SingleCoordinate {
    fn names(&self) -> Vec<String> {
        vec![self.name.into()]
    }

    fn evaluate(&self, t: f64, state: &[f64], _: &[f64]) -> Result<Quantities, String> {
        let (x, rate) = (state[0], state[1]);
        // Only certificates of models with fields use bias and forces.
        Ok(Quantities {
            mass: vec![(self.mass)(t, x, rate)],
            rates: vec![rate, (self.acceleration)(t, x, rate)],
            energy: (self.energy)(t, x, rate),
            power: (self.power)(t, x, rate),
            ..Quantities::default()
        })
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

    /// Returns the state derivative of a solver; if `faulty`, it evaluates a zero quantity on the negative side.
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

impl Equations for Preload {
    fn names(&self) -> Vec<String> {
        vec!["y".into()]
    }

    fn evaluate(&self, _: f64, state: &[f64], _: &[f64]) -> Result<Quantities, String> {
        let (y, rate) = (state[0], state[1]);
        let stretch = y - y.clamp(-0.01, 0.01);
        let force = Self::force(y);
        Ok(Quantities {
            mass: vec![2.0],
            bias: vec![0.0],
            forces: vec![force],
            rates: vec![rate, force / 2.0],
            energy: rate * rate,
            power: rate * force,
            guards: vec![y - 0.01, y + 0.01, stretch, -stretch],
        })
    }
}

/// Emitted source with regime kernels of the preloaded mass. `WITHIN` stands for the force within the play.
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

/// Variant of the beam that evaluates the oracle's equations, for the comparison of two orders.
pub(super) struct Beam {
    pub oracle: Oracle,
    /// True if the third mode is coupled to the hub.
    pub coupled: bool,
}

impl Equations for Beam {
    fn names(&self) -> Vec<String> {
        self.oracle.names().to_vec()
    }

    fn evaluate(&self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Quantities, String> {
        let message = |error: OracleError| error.to_string();
        let mut equations = self.oracle.equations(0.0, state, inputs).map_err(message)?;
        let size = equations.size();
        if !self.coupled && size > 4 {
            equations.mass[(0, 3)] = 0.0;
            equations.mass[(3, 0)] = 0.0;
        }
        let forces = equations.right_side();
        let mass = equations.mass.clone().cholesky();
        let accelerations = mass.ok_or("not positive definite")?.solve(&forces);
        Ok(Quantities {
            mass: equations.mass.transpose().as_slice().to_vec(),
            bias: vec![0.0; size],
            rates: [&state[size..], accelerations.as_slice()].concat(),
            forces: forces.as_slice().to_vec(),
            energy: self.oracle.energy(t, state, inputs).map_err(message)?.value,
            power: self.oracle.power(t, state, inputs).map_err(message)?.value,
            guards: Vec::new(),
        })
    }
}

/// Emitted source of the spring with rates and energy only.
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
