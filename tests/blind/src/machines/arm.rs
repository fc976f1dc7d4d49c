//! Flexible arm on its planetary reducer, from Newton's laws for the sun, the planets, the carrier
//! and the arm, with up to four clamped-free modes. Displacements along the line of action: x_s of
//! the sun, x_p of a planet. Angles: th_c of the carrier and th_c + psi of the arm's root.
//!
//! ```text
//! F = k dead(d, b) + c contact(d, b) d'          d_sp = x_s - x_p - x_c,  d_pr = x_p - x_c
//! M_s x_s'' = T_s/r_s - 3 F_sp                   x_c = r_c cos(alpha) th_c
//! M_p x_p'' = F_sp - F_pr                        (each of three planets)
//! I_c th_c'' = T_c + 3 r_c cos(alpha) (F_sp + F_pr) + M_root
//! sum over the arm: I_a th_a'' + sum h_i q_i'' = -M_root
//!                   M_i q_i'' + h_i th_a'' = -K_i (q_i + eta q_i') - k_3 w(l)^3 phi_i(l)
//! ```
//! M_root is the torque between carrier and arm; it equals k_j psi if the joint is compliant.

use nalgebra::DMatrix;

use crate::friction::{AxisForces, FrictionLaw};
use crate::integrate::Motion;

/// Maximum number of modes.
pub const MODES: usize = 4;

/// Number of states: coordinates x_s, x_p, th_c, psi and four modes; their rates; two bristle
/// deflections.
pub const STATE: usize = 2 * COORDINATES + 2;

const COORDINATES: usize = 4 + MODES;

/// Roots of cos(z) cosh(z) = -1.
const ROOTS: [f64; MODES] = [
    1.875_104_068_711_961_1,
    4.694_091_132_974_175,
    7.854_757_438_237_613,
    10.995_540_734_875_467,
];

/// Mesh of the reducer with its hidden effects.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Damping in contact, N s/m.
    pub damping: f64,
    /// Half the play, m.
    pub play: f64,
    /// Centre of the play, m.
    pub middle: f64,
    /// Transmission error: periods per revolution of the sun, cosine and sine, m.
    pub error: (f64, f64, f64),
    /// Variation of the stiffness: periods per revolution of the sun, relative cosine and sine.
    pub variation: (f64, f64, f64),
}

/// Flexible arm on its planetary reducer. SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// Decrease of the motor torque with the motor speed, N m s.
    pub b_m: f64,
    /// Inertia of the sun, I_s/r_s^2, kg.
    pub sun_mass: f64,
    /// Inertia of the carrier without the arm, I_c/r_c^2, kg.
    pub carrier_mass: f64,
    /// Young's modulus, Pa.
    pub modulus: f64,
    /// Number of modes.
    pub modes: usize,
    /// Meshes of sun and planet, and of planet and ring.
    pub meshes: [Mesh; 2],
    /// Hidden forces on the sun.
    pub on_sun: AxisForces,
    /// Hidden forces on the carrier.
    pub on_carrier: AxisForces,
    /// Structural damping, s.
    pub loss: f64,
    /// Tip mass, kg.
    pub tip_mass: f64,
    /// Cubic stiffness at the tip, N/m^3.
    pub cubic: f64,
    /// Compliance of the joint, rad per N m.
    pub compliance: f64,
    /// Weight per length of an arm that rotates in a vertical plane, N/m. Components: perpendicular
    /// to the arm at angle 0 (sine term) and along it (cosine term).
    pub weight: (f64, f64),
    inverse: [[f64; MODES + 2]; MODES + 2],
    /// Stiffness of each mode, N/m.
    bending: [f64; MODES],
}

mod given {
    pub const MODULE: f64 = 3e-3;
    pub const TEETH: (f64, f64) = (27.0, 36.0);
    pub const PRESSURE_ANGLE: f64 = 24.6 * std::f64::consts::PI / 180.0;
    pub const PLANET_MASS: f64 = 0.61;
    pub const PLANET_OWN_MASS: f64 = 0.66;
    pub const LINEAR_DENSITY: f64 = 7900.0 * 1e-4;
    pub const LENGTH: f64 = 0.5;
    pub const SECTION: f64 = 8.333e-10;
}

/// Returns the radii r_s and r_c, m.
fn radii() -> (f64, f64) {
    let (sun, planet) = given::TEETH;
    let cosine = given::PRESSURE_ANGLE.cos();
    (
        given::MODULE * sun * cosine / 2.0,
        given::MODULE * (sun + planet) / 2.0,
    )
}

impl Arm {
    /// Returns the arm of the test rig without hidden effects.
    pub fn nominal() -> Self {
        let mesh = Mesh {
            stiffness: 1e8,
            damping: 650.0,
            play: 25e-6,
            middle: 0.0,
            error: (0.0, 0.0, 0.0),
            variation: (0.0, 0.0, 0.0),
        };
        let mut arm = Self {
            b_m: 0.05,
            sun_mass: 0.39,
            carrier_mass: 6.29,
            modulus: 2e11,
            modes: MODES,
            meshes: [mesh.clone(), mesh],
            on_sun: AxisForces::none(FrictionLaw::Steep { speed: 0.05 }),
            on_carrier: AxisForces::none(FrictionLaw::Steep { speed: 0.01 }),
            loss: 0.0,
            tip_mass: 0.0,
            cubic: 0.0,
            compliance: 0.0,
            weight: (0.0, 0.0),
            inverse: [[0.0; MODES + 2]; MODES + 2],
            bending: [0.0; MODES],
        };
        arm.prepare();
        arm
    }

    /// Updates the matrices. To be called after changes of masses, modulus or number of modes.
    pub fn prepare(&mut self) {
        let (_, r_c) = radii();
        let length = given::LENGTH;
        let mass = given::LINEAR_DENSITY * length;
        let size = 1 + self.modes;
        let mut of_arm = DMatrix::zeros(size, size);
        of_arm[(0, 0)] = mass * length * length / 3.0 + self.tip_mass * length * length;
        for i in 0..self.modes {
            // For modes in the form cosh - cos - ..., the integral of x phi is 2 l^2/z^2 and that
            // of phi^2 is l.
            let at_end = end_value(i);
            let turning = 2.0 * mass * length / (ROOTS[i] * ROOTS[i]);
            of_arm[(0, i + 1)] = turning + self.tip_mass * length * at_end;
            of_arm[(i + 1, 0)] = of_arm[(0, i + 1)];
            for j in 0..self.modes {
                let own = if i == j { mass } else { 0.0 };
                of_arm[(i + 1, j + 1)] = own + self.tip_mass * at_end * end_value(j);
            }
        }
        let carrier = (self.carrier_mass + 3.0 * given::PLANET_OWN_MASS) * r_c * r_c;
        let whole = if self.compliance > 0.0 {
            // With a compliant joint, carrier and arm have separate coordinates.
            let mut whole = DMatrix::zeros(size + 1, size + 1);
            whole[(0, 0)] = carrier;
            whole.view_mut((1, 1), (size, size)).copy_from(&of_arm);
            whole
        } else {
            of_arm[(0, 0)] += carrier;
            of_arm
        };
        let inverse = whole
            .try_inverse()
            .expect("the masses are positive, so the matrix has an inverse");
        self.inverse = [[0.0; MODES + 2]; MODES + 2];
        for row in 0..inverse.nrows() {
            for column in 0..inverse.ncols() {
                self.inverse[row][column] = inverse[(row, column)];
            }
        }
        let length_cubed = given::LENGTH.powi(3);
        self.bending =
            ROOTS.map(|root| self.modulus * given::SECTION * root.powi(4) / length_cubed);
    }

    /// Returns the kinetic and potential energy, J, without effects that are periodic in an angle.
    pub fn energy(&self, state: &[f64]) -> f64 {
        let (r_s, r_c) = radii();
        let rates = &state[COORDINATES..];
        let root = rates[2] + rates[3];
        let length = given::LENGTH;
        let mass = given::LINEAR_DENSITY * length;
        let mut energy = 0.5 * self.sun_mass * rates[0] * rates[0]
            + 1.5 * given::PLANET_MASS * rates[1] * rates[1]
            + 0.5 * (self.carrier_mass + 3.0 * given::PLANET_OWN_MASS) * (r_c * rates[2]).powi(2)
            + mass * length * length / 6.0 * root * root;
        for i in 0..self.modes {
            energy += 0.5 * mass * rates[4 + i] * rates[4 + i]
                + 2.0 * mass * length / (ROOTS[i] * ROOTS[i]) * rates[4 + i] * root
                + 0.5 * self.bending[i] * state[4 + i] * state[4 + i];
        }
        let tip_rate = length * root
            + (0..self.modes)
                .map(|i| end_value(i) * rates[4 + i])
                .sum::<f64>();
        let tip = self.tip(state);
        energy += 0.5 * self.tip_mass * tip_rate * tip_rate + 0.25 * self.cubic * tip.powi(4);
        if self.compliance > 0.0 {
            energy += 0.5 * state[3] * state[3] / self.compliance;
        }
        let (along, across) = self.weight;
        let (sine, cosine) = (state[2] + state[3]).sin_cos();
        let (lever, bent) = (0.5 * length * length, self.area(state));
        energy += across * (lever * sine + bent * cosine) - along * (lever * cosine - bent * sine);
        let sun = state[0] / r_s;
        for (mesh, deflection) in self.meshes.iter().zip(self.deflections(state, r_c)) {
            let dead = deadzone(
                deflection - mesh.middle - mesh.periodic(mesh.error, sun).0,
                mesh.play,
            );
            energy +=
                1.5 * mesh.stiffness * (1.0 + mesh.periodic(mesh.variation, sun).0) * dead * dead;
        }
        energy
    }

    fn tip(&self, state: &[f64]) -> f64 {
        (0..self.modes).map(|i| end_value(i) * state[4 + i]).sum()
    }

    /// Returns the integral of the deflection over the length.
    fn area(&self, state: &[f64]) -> f64 {
        (0..self.modes).map(|i| area_value(i) * state[4 + i]).sum()
    }

    fn deflections(&self, of: &[f64], r_c: f64) -> [f64; 2] {
        let carrier = r_c * given::PRESSURE_ANGLE.cos() * of[2];
        [of[0] - of[1] - carrier, of[1] - carrier]
    }

    /// Returns the angles of sun and carrier, and the tip deflection.
    pub fn outputs(&self, state: &[f64]) -> [f64; 3] {
        [state[0] / radii().0, state[2], self.tip(state)]
    }

    /// Converts a state to the corresponding state with a rigid joint.
    pub fn without_joint(state: &[f64]) -> Vec<f64> {
        let mut state = state.to_vec();
        state[3] = 0.0;
        state[COORDINATES + 3] = 0.0;
        state
    }

    /// Returns directions that span the initial states of a model with `modes` modes: first the
    /// joint rotation of all bodies, then mesh deflections. With single coordinates, the problem
    /// would be ill-conditioned, because derivatives along mesh deflections are very large.
    pub fn directions(modes: usize) -> Vec<Vec<f64>> {
        let lever = radii().1 * given::PRESSURE_ANGLE.cos();
        let of = |parts: &[(usize, f64)]| {
            let mut direction = vec![0.0; STATE];
            for (place, part) in parts {
                direction[*place] = *part;
            }
            direction
        };
        let mut directions = Vec::new();
        for of_rates in [0, COORDINATES] {
            let together = [(0, 2.0 * lever), (1, lever), (2, 1.0)];
            directions.push(of(&together.map(|(place, part)| (of_rates + place, part))));
            let single = [0, 1].into_iter().chain(4..4 + modes);
            directions.extend(single.map(|place| of(&[(of_rates + place, 1.0)])));
        }
        directions
    }

    /// Returns the indices of the states of a model with `modes` modes, without bristles.
    pub fn states_of_model(modes: usize) -> Vec<usize> {
        let coordinates: Vec<usize> = [0, 1, 2].into_iter().chain(4..4 + modes).collect();
        let rates = coordinates.iter().map(|place| place + COORDINATES);
        coordinates.iter().copied().chain(rates).collect()
    }
}

/// Returns phi_i(l) = 2 (-1)^(i+1), for modes counted from 1.
fn end_value(mode: usize) -> f64 {
    if mode.is_multiple_of(2) { 2.0 } else { -2.0 }
}

/// Returns the integral of phi_i over the length: 2 sigma_i l/z_i.
fn area_value(mode: usize) -> f64 {
    let z = ROOTS[mode];
    let sigma = (z.sinh() - z.sin()) / (z.cosh() + z.cos());
    2.0 * sigma * given::LENGTH / z
}

fn deadzone(deflection: f64, play: f64) -> f64 {
    if deflection > play {
        deflection - play
    } else if deflection < -play {
        deflection + play
    } else {
        0.0
    }
}

impl Mesh {
    /// Returns an effect that is periodic in the angle of the sun, and its derivative.
    fn periodic(&self, part: (f64, f64, f64), angle: f64) -> (f64, f64) {
        let (order, cosine, sine) = part;
        if cosine == 0.0 && sine == 0.0 {
            return (0.0, 0.0);
        }
        let (s, c) = (order * angle).sin_cos();
        (cosine * c + sine * s, order * (sine * c - cosine * s))
    }

    /// Returns the force along the line of action, N, and the reaction torque of periodic effects
    /// on the sun, N m. Both apply to one of three planets.
    fn forces(&self, deflection: f64, speed: f64, angle: f64, turning: f64) -> (f64, f64) {
        let (error, error_slope) = self.periodic(self.error, angle);
        let (variation, variation_slope) = self.periodic(self.variation, angle);
        let deflection = deflection - self.middle - error;
        let dead = deadzone(deflection, self.play);
        if dead == 0.0 {
            return (0.0, 0.0);
        }
        let speed = speed - error_slope * turning;
        let force = self.stiffness * (1.0 + variation) * dead + self.damping * speed;
        let back = force * error_slope - 0.5 * self.stiffness * variation_slope * dead * dead;
        (force, back)
    }
}

impl Motion for Arm {
    fn rates(&self, t: f64, state: &[f64], input: f64, rates: &mut [f64]) {
        let (r_s, r_c) = radii();
        let lever = r_c * given::PRESSURE_ANGLE.cos();
        let (at, moving) = state[..2 * COORDINATES].split_at(COORDINATES);
        let bristles = &state[2 * COORDINATES..];
        let (sun, turning) = (at[0] / r_s, moving[0] / r_s);
        let [d_sp, d_pr] = self.deflections(at, r_c);
        let [v_sp, v_pr] = self.deflections(moving, r_c);
        let (f_sp, back_sp) = self.meshes[0].forces(d_sp, v_sp, sun, turning);
        let (f_pr, back_pr) = self.meshes[1].forces(d_pr, v_pr, sun, turning);
        let (hidden_sun, bend_sun) = self.on_sun.force(t, sun, turning, bristles[0], input);
        let (hidden_carrier, bend_carrier) =
            self.on_carrier
                .force(t, at[2], moving[2], bristles[1], input);
        let on_sun = input - self.b_m * turning + hidden_sun + 3.0 * (back_sp + back_pr);
        let on_carrier = hidden_carrier + 3.0 * lever * (f_sp + f_pr);
        rates[..COORDINATES].copy_from_slice(moving);
        rates[COORDINATES] = (on_sun / r_s - 3.0 * f_sp) / self.sun_mass;
        rates[COORDINATES + 1] = (f_sp - f_pr) / given::PLANET_MASS;
        rates[2 * COORDINATES] = bend_sun;
        rates[2 * COORDINATES + 1] = bend_carrier;
        let mut forces = [0.0; MODES + 2];
        let yields = usize::from(self.compliance > 0.0);
        let held = if yields == 1 {
            at[3] / self.compliance
        } else {
            0.0
        };
        forces[0] = on_carrier + held;
        forces[yields] -= held;
        let cubic = self.cubic * self.tip(at).powi(3);
        let mut pressed = 0.0;
        if self.weight != (0.0, 0.0) {
            let (along, across) = self.weight;
            let (sine, cosine) = (at[2] + at[3]).sin_cos();
            let (lever, bent) = (0.5 * given::LENGTH * given::LENGTH, self.area(at));
            pressed = across * cosine + along * sine;
            forces[yields] -=
                across * (lever * cosine - bent * sine) + along * (lever * sine + bent * cosine);
        }
        for i in 0..self.modes {
            let bent = at[4 + i] + self.loss * moving[4 + i];
            forces[1 + yields + i] =
                -self.bending[i] * bent - cubic * end_value(i) - pressed * area_value(i);
        }
        // Rows and columns of unused modes are zero.
        let acceleration = |row: usize| -> f64 {
            let row = self.inverse[row].iter().zip(&forces);
            row.map(|(a, b)| a * b).sum()
        };
        let turned = acceleration(0);
        rates[COORDINATES + 2] = turned;
        rates[COORDINATES + 3] = if yields == 1 {
            acceleration(1) - turned
        } else {
            0.0
        };
        for i in 0..MODES {
            let bent = if i < self.modes {
                acceleration(1 + yields + i)
            } else {
                0.0
            };
            rates[COORDINATES + 4 + i] = bent;
        }
    }
}
