//! Arm at S = 4 for the general solvers: the compiled model with switching surfaces, and equations in variables with a
//! continuous right-hand side.

use std::cell::RefCell;
use std::path::Path;

use eomgen_compiled_model::{CompiledModel, DrivenModel, Orders};
use eomgen_generated::planetary_arm_order_4 as g;
use eomgen_sim::ode::{Settings, Trajectory, simulate};

/// Number of states: x_sp, x_pr, x_c, q_1 .. q_4 (m), then their rates (m/s).
pub const STATES: usize = g::STATES;

const DEGREES: usize = STATES / 2;

/// Compiled model as in `simulate`; both ends of each play are switching surfaces.
pub struct Located {
    model: CompiledModel,
}

impl Located {
    /// Compiles the reference case, with the parameters of the specification.
    pub fn new() -> Self {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
        let model = CompiledModel::load(path, Orders::Uniform(4)).expect("the model compiles");
        Self { model }
    }

    /// Simulates one second from rest and returns the states at `times` (s) and at the end.
    pub fn simulate(&self, times: &[f64], settings: &Settings) -> Option<Trajectory> {
        let instance = self.model.with_declared_parameters().ok()?;
        let (evaluator, inputs) = (
            RefCell::new(instance.evaluator().ok()?),
            instance.default_inputs(),
        );
        let system = DrivenModel::new(&evaluator, &inputs)
            .with_typical_sizes(self.model.typical_sizes())
            .with_sides(instance.sided_model().ok()?, settings.tolerance);
        let start = [0.0; STATES];
        simulate(&system, &start, (0.0, 1.0), times, settings, &mut |_| {}).ok()
    }
}

/// Row of accelerations, padded to full SIMD registers.
type Lanes = [f64; DEGREES + 1];

/// Equations of motion in momentum-like variables.
///
/// The damping force of a mesh is c times the rate of its compression. With u = q' + d_sp psi(x_sp) + d_pr psi(x_pr),
/// u' is therefore the acceleration without mesh damping. Here psi(x) is the compression, and -d is the acceleration
/// per unit rate of compression. Unlike the acceleration, u' is continuous when a mesh opens or closes.
pub struct Momentum {
    half_width: [f64; 2],
    /// d_sp and d_pr, 1/s.
    damping: [Lanes; 2],
    /// Accelerations per unit compression of each mesh, 1/s^2.
    stiffness: [Lanes; 2],
    /// Accelerations per unit deflection of each mode, 1/s^2.
    modes: [Lanes; 4],
    /// Constant part and ripple amplitude of the motor's contribution to x_sp'', m/s^2.
    motor: [f64; 2],
    /// Decrease of the motor's acceleration per unit of x_sp' + x_pr' + 2 x_c', 1/s.
    fall: f64,
    /// Angular frequency of the ripple, rad/s.
    omega: f64,
}

impl Momentum {
    /// Creates the reference case. The coefficients are computed from the generated equations, which are linear within
    /// a regime.
    pub fn new() -> Self {
        let damped = g::Parameters::default();
        let undamped = g::Parameters {
            c_sp: 0.0,
            c_pr: 0.0,
            ..damped
        };
        let [damped_rows, rows] = [&damped, &undamped].map(g::Coefficients::prepare);
        let half_width = [damped.b_sp, damped.b_pr];
        let at = |coefficients: &g::Coefficients, t: f64, state: &[f64; STATES]| -> Lanes {
            let rates = g::rates(t, state, &g::Inputs::default(), coefficients);
            std::array::from_fn(|row| rates.get(DEGREES + row).copied().unwrap_or(0.0))
        };
        let still = at(&rows, 0.0, &[0.0; STATES]);
        let unit = |place: usize, value: f64| -> Lanes {
            let mut state = [0.0; STATES];
            state[place] = value;
            subtract(&at(&rows, 0.0, &state), &still)
        };
        let quarter = std::f64::consts::FRAC_PI_2 / damped.omega;
        Self {
            half_width,
            damping: [0, 1].map(|mesh| {
                let mut closed = [0.0; STATES];
                closed[mesh] = 2.0 * half_width[mesh];
                closed[DEGREES + mesh] = 1.0;
                subtract(&at(&rows, 0.0, &closed), &at(&damped_rows, 0.0, &closed))
            }),
            stiffness: [0, 1].map(|mesh| unit(mesh, half_width[mesh] + 1.0)),
            modes: [3, 4, 5, 6].map(|mode| unit(mode, 1.0)),
            motor: [still[0], at(&rows, quarter, &[0.0; STATES])[0] - still[0]],
            fall: unit(DEGREES, 1.0)[0],
            omega: damped.omega,
        }
    }

    /// Computes the rates of x_sp, x_pr, x_c, q_1 .. q_4 (m) and of the corresponding u (m/s).
    #[inline]
    pub fn rates(&self, t: f64, y: &[f64; STATES]) -> [f64; STATES] {
        let sp = compression(y[0], self.half_width[0]);
        let pr = compression(y[1], self.half_width[1]);
        let mut rates = [0.0; STATES];
        for place in 0..DEGREES {
            rates[place] =
                y[DEGREES + place] - self.damping[0][place] * sp - self.damping[1][place] * pr;
        }
        let mut rows: Lanes =
            std::array::from_fn(|row| self.stiffness[0][row] * sp + self.stiffness[1][row] * pr);
        for (mode, column) in self.modes.iter().enumerate() {
            for (row, factor) in rows.iter_mut().zip(column) {
                *row += factor * y[3 + mode];
            }
        }
        let ripple = self.motor[1] * (self.omega * t).sin();
        let turning = rates[0] + rates[1] + 2.0 * rates[2];
        rows[0] += self.motor[0] + ripple + self.fall * turning;
        rates[DEGREES..].copy_from_slice(&rows[..DEGREES]);
        rates
    }
}

/// Returns the compression deadzone(x) in m.
fn compression(x: f64, half_width: f64) -> f64 {
    x - x.clamp(-half_width, half_width)
}

fn subtract(a: &Lanes, b: &Lanes) -> Lanes {
    std::array::from_fn(|row| a[row] - b[row])
}
