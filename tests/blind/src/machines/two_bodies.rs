//! Machines of two coordinates with random parameters: motor and load on an elastic shaft, a crane,
//! and a quarter car with an actuator. States: two displacements, their rates, and the bristle
//! deflections of both axes. SI units.

use super::setup::{Channel, Setup, Specification};
use super::spring::Spring;
use crate::friction::{AxisForces, FrictionLaw};
use crate::integrate::Motion;
use crate::random::RandomStream;

/// Number of states.
pub const STATE: usize = 6;

const GRAVITY: f64 = 9.81;

/// Machine of the family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// Motor and load on an elastic shaft, driven by the motor torque.
    TwoMass,
    /// Load on a rod below a trolley, which is driven by a force.
    Crane,
    /// Body and wheel of a car, with a spring, a damper and an actuator between them.
    QuarterCar,
}

/// Machine of two bodies with its true parameters and hidden effects.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoBodies {
    /// Kind of machine.
    pub form: Form,
    /// Inertias of motor and load, or masses of trolley and load or of body and wheel.
    pub inertia: [f64; 2],
    /// Viscous friction of motor and load, or of trolley and rod.
    pub viscous: [f64; 2],
    /// Spring of the shaft or of the suspension.
    pub spring: Spring,
    /// Stiffness of the tyre, N/m.
    pub tyre: f64,
    /// Length of the rod, m.
    pub length: f64,
    /// Hidden forces: on motor and load, on trolley and rod, or on the suspension travel and the
    /// body.
    pub hidden: [AxisForces; 2],
    /// Gain and bias of the drive relative to the record.
    pub actuator: (f64, f64),
}

/// Rounds to four digits, as in the specification.
fn round_to_four_digits(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

impl TwoBodies {
    /// Returns a machine with random parameters and without hidden effects.
    pub fn random(form: Form, seed: u64) -> Self {
        // Machines use the last random streams, because cases use the streams 1, 2, ...
        let mut draw = RandomStream::new(seed, u64::MAX - form as u64);
        let mut between = |low: f64, high: f64| round_to_four_digits(draw.between(low, high));
        let friction = |speed: f64| AxisForces::none(FrictionLaw::Steep { speed });
        let plain = |inertia, viscous, spring, speeds: [f64; 2]| Self {
            form,
            inertia,
            viscous,
            spring,
            tyre: 0.0,
            length: 0.0,
            hidden: speeds.map(friction),
            actuator: (0.0, 0.0),
        };
        match form {
            Form::TwoMass => {
                let motor = between(5e-4, 2e-3);
                let load = round_to_four_digits(motor * between(1.5, 6.0));
                let natural = 2.0 * std::f64::consts::PI * between(6.0, 14.0);
                let stiffness = round_to_four_digits(load * natural * natural);
                let damping = round_to_four_digits(2.0 * between(0.01, 0.03) * stiffness / natural);
                let viscous = [
                    round_to_four_digits(motor * between(0.3, 1.0)),
                    round_to_four_digits(load * between(0.1, 0.3)),
                ];
                let spring = Spring::declared(stiffness, damping);
                plain([motor, load], viscous, spring, [0.02, 0.02])
            }
            Form::Crane => {
                let trolley = between(2.0, 6.0);
                let load = round_to_four_digits(trolley * between(0.2, 0.8));
                let length = between(0.4, 0.9);
                let viscous = [
                    round_to_four_digits(trolley * between(0.5, 2.0)),
                    round_to_four_digits(load * length * length * between(0.02, 0.05)),
                ];
                let spring = Spring::declared(0.0, 0.0);
                Self {
                    length,
                    ..plain([trolley, load], viscous, spring, [1e-3, 1e-2])
                }
            }
            Form::QuarterCar => {
                let body = between(2.0, 5.0);
                let wheel = round_to_four_digits(body * between(0.15, 0.35));
                let natural = 2.0 * std::f64::consts::PI * between(1.5, 3.0);
                let stiffness = round_to_four_digits(body * natural * natural);
                let damping = round_to_four_digits(2.0 * between(0.1, 0.25) * stiffness / natural);
                let spring = Spring::declared(stiffness, damping);
                Self {
                    tyre: round_to_four_digits(stiffness * between(4.0, 8.0)),
                    ..plain([body, wheel], [0.0; 2], spring, [1e-3, 1e-3])
                }
            }
        }
    }

    /// Returns the names of the axes, in the order of [`TwoBodies::hidden`].
    pub fn axes(&self) -> [&'static str; 2] {
        match self.form {
            Form::TwoMass => ["theta_m", "theta_l"],
            Form::Crane => ["x", "theta"],
            Form::QuarterCar => ["travel", "z_b"],
        }
    }

    /// Returns the name of the spring, if there is one.
    pub fn spring_name(&self) -> Option<&'static str> {
        match self.form {
            Form::TwoMass => Some("shaft"),
            Form::Crane => None,
            Form::QuarterCar => Some("suspension"),
        }
    }

    /// Returns a parameter by its name in the specification.
    pub fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        Some(match (self.form, name) {
            (Form::TwoMass, "J_m") | (Form::Crane, "M") | (Form::QuarterCar, "m_b") => {
                &mut self.inertia[0]
            }
            (Form::TwoMass, "J_l") | (Form::Crane, "m") | (Form::QuarterCar, "m_w") => {
                &mut self.inertia[1]
            }
            (Form::TwoMass, "b_m") | (Form::Crane, "b") => &mut self.viscous[0],
            (Form::TwoMass, "b_l") | (Form::Crane, "b_r") => &mut self.viscous[1],
            (Form::TwoMass, "k") | (Form::QuarterCar, "k_s") => &mut self.spring.stiffness,
            (Form::TwoMass, "d") | (Form::QuarterCar, "c_s") => &mut self.spring.damping,
            (Form::QuarterCar, "k_t") => &mut self.tyre,
            (Form::Crane, "l") => &mut self.length,
            _ => return None,
        })
    }

    /// Returns the usual magnitude of the input force or torque.
    pub fn usual_input(&self) -> f64 {
        match self.form {
            Form::TwoMass => 10.0 * (self.inertia[0] + self.inertia[1]),
            Form::Crane => self.inertia[0] + self.inertia[1],
            Form::QuarterCar => 5e-3 * self.spring.stiffness,
        }
    }

    /// Returns the deflection of the spring.
    pub fn deflection(state: &[f64]) -> f64 {
        state[0] - state[1]
    }

    /// Returns the deflection at which the bristles slide, and the inertia, for both axes. At usual
    /// speeds the bristles respond within a fraction of a sample. Slower bristles would act like a
    /// lag, unlike any friction of the catalogue.
    pub fn bristles(&self) -> [(f64, f64); 2] {
        match self.form {
            Form::TwoMass => [(1e-4, self.inertia[0]), (1e-4, self.inertia[1])],
            Form::Crane => {
                let [trolley, load] = self.inertia;
                [(2e-5, trolley), (1e-4, load * self.length * self.length)]
            }
            Form::QuarterCar => [(5e-6, self.inertia[1]), (5e-6, self.inertia[0])],
        }
    }

    /// Returns directions that span the initial states. Directions in which both bodies move
    /// together are first.
    pub fn directions(&self) -> Vec<Vec<f64>> {
        let together = match self.form {
            Form::TwoMass | Form::QuarterCar => 1.0,
            Form::Crane => 0.0,
        };
        vec![
            vec![1.0, together, 0.0, 0.0, 0.0, 0.0],
            vec![0.0, 0.0, 1.0, together, 0.0, 0.0],
            vec![0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        ]
    }

    /// Returns the kinetic and potential energy, J, without hidden effects.
    pub fn energy(&self, state: &[f64]) -> f64 {
        let [a, b] = self.inertia;
        let (v, w) = (state[2], state[3]);
        match self.form {
            Form::TwoMass | Form::QuarterCar => {
                let p = Self::deflection(state);
                0.5 * (a * v * v
                    + b * w * w
                    + self.spring.stiffness * p * p
                    + self.tyre * state[1] * state[1])
            }
            Form::Crane => {
                let (sine, cosine) = state[1].sin_cos();
                let across = v + self.length * w * cosine;
                let up = self.length * w * sine;
                0.5 * (a * v * v + b * (across * across + up * up))
                    - b * GRAVITY * self.length * cosine
            }
        }
    }

    /// Returns the measurement setup with the specification.
    pub fn setup(&self) -> Setup {
        let channel = |name, unit, noise, step| Channel {
            name,
            unit,
            scale: 1.0,
            noise,
            step,
        };
        let (channels, input, uncertain) = match self.form {
            Form::TwoMass => (
                vec![
                    channel("theta_m", "rad", 1.5e-4, 2e-4),
                    channel("theta_l", "rad", 1.5e-4, 2e-4),
                ],
                ("u", "N m"),
                vec![("J_l", 0.03), ("b_m", 0.1)],
            ),
            Form::Crane => (
                vec![
                    channel("x", "m", 2e-4, 2e-4),
                    channel("theta", "rad", 4e-4, 5e-4),
                ],
                ("F", "N"),
                vec![("m", 0.03), ("b", 0.1)],
            ),
            Form::QuarterCar => (
                vec![
                    channel("z_b", "m", 2e-5, 2e-5),
                    channel("z_w", "m", 1e-5, 1e-5),
                ],
                ("F", "N"),
                vec![("m_b", 0.02), ("c_s", 0.1)],
            ),
        };
        let slow = self.form == Form::Crane;
        Setup {
            specification: Specification::Text(self.specification()),
            order: None,
            channels,
            input: Some(input),
            sample: if slow { 2e-3 } else { 1e-3 },
            steps: 80,
            duration: if slow { 4.0 } else { 2.0 },
            window: Some(if slow { 0.5 } else { 0.25 }),
            uncertain,
            records: (1, 1),
        }
    }

    fn specification(&self) -> String {
        let [a, b] = self.inertia;
        let [c, d] = self.viscous;
        let (k, loss) = (self.spring.stiffness, self.spring.damping);
        match self.form {
            Form::TwoMass => format!(
                r#"[model]
name = "two_mass"
[parameters]
J_m = {{ value = {a}, unit = "kg m^2", doc = "motor" }}
J_l = {{ value = {b}, unit = "kg m^2", doc = "load" }}
k = {{ value = {k}, unit = "N m/rad", doc = "shaft" }}
d = {{ value = {loss}, unit = "N m s/rad" }}
b_m = {{ value = {c}, unit = "N m s/rad" }}
b_l = {{ value = {d}, unit = "N m s/rad" }}
[coordinates]
theta_m = {{ unit = "rad" }}
theta_l = {{ unit = "rad" }}
[inputs]
u = {{ unit = "N m" }}
[kinetic]
motor = "1/2*J_m*dot(theta_m)^2"
load = "1/2*J_l*dot(theta_l)^2"
[potential]
shaft = "1/2*k*(theta_m - theta_l)^2"
[dissipation]
shaft = "1/2*d*(dot(theta_m) - dot(theta_l))^2"
bearings = "1/2*b_m*dot(theta_m)^2 + 1/2*b_l*dot(theta_l)^2"
[forces]
drive = {{ on = "theta_m", value = "u" }}
"#
            ),
            Form::Crane => format!(
                r#"[model]
name = "crane"
[parameters]
M = {{ value = {a}, unit = "kg", doc = "trolley" }}
m = {{ value = {b}, unit = "kg", doc = "load" }}
l = {{ value = {l}, unit = "m", doc = "rod" }}
g = {{ value = {GRAVITY}, unit = "m/s^2" }}
b = {{ value = {c}, unit = "N s/m" }}
b_r = {{ value = {d}, unit = "N m s/rad" }}
[coordinates]
x = {{ unit = "m" }}
theta = {{ unit = "rad", doc = "of the rod, hanging is 0" }}
[inputs]
F = {{ unit = "N" }}
[definitions]
across = "x + l*sin(theta)"
height = "-l*cos(theta)"
[kinetic]
trolley = "1/2*M*dot(x)^2"
load = "1/2*m*(dot(across)^2 + dot(height)^2)"
[potential]
load = "m*g*height"
[dissipation]
losses = "1/2*b*dot(x)^2 + 1/2*b_r*dot(theta)^2"
[forces]
drive = {{ on = "x", value = "F" }}
"#,
                l = self.length
            ),
            Form::QuarterCar => format!(
                r#"[model]
name = "quarter_car"
[parameters]
m_b = {{ value = {a}, unit = "kg", doc = "body" }}
m_w = {{ value = {b}, unit = "kg", doc = "wheel" }}
k_s = {{ value = {k}, unit = "N/m", doc = "suspension" }}
c_s = {{ value = {loss}, unit = "N s/m" }}
k_t = {{ value = {tyre}, unit = "N/m", doc = "tyre" }}
[coordinates]
z_b = {{ unit = "m", doc = "body, from rest" }}
z_w = {{ unit = "m", doc = "wheel, from rest" }}
[inputs]
F = {{ unit = "N", doc = "actuator between body and wheel" }}
[definitions]
travel = "z_b - z_w"
[kinetic]
body = "1/2*m_b*dot(z_b)^2"
wheel = "1/2*m_w*dot(z_w)^2"
[potential]
suspension = "1/2*k_s*travel^2"
tyre = "1/2*k_t*z_w^2"
[dissipation]
damper = "1/2*c_s*dot(travel)^2"
[forces]
actuator = {{ on = "travel", value = "F" }}
[observables]
travel = {{ value = "travel", unit = "m" }}
"#,
                tyre = self.tyre
            ),
        }
    }
}

impl Motion for TwoBodies {
    fn rates(&self, t: f64, state: &[f64], input: f64, rates: &mut [f64]) {
        let (x, y, v, w) = (state[0], state[1], state[2], state[3]);
        let drive = (1.0 + self.actuator.0) * input + self.actuator.1;
        let ((p, p_rate), (r, r_rate)) = match self.form {
            Form::TwoMass | Form::Crane => ((x, v), (y, w)),
            Form::QuarterCar => ((x - y, v - w), (x, v)),
        };
        let (first, bend) = self.hidden[0].force(t, p, p_rate, state[4], input);
        let (second, other_bend) = self.hidden[1].force(t, r, r_rate, state[5], input);
        let [a, b] = self.inertia;
        let (v_rate, w_rate) = match self.form {
            Form::TwoMass => {
                let shaft = self.spring.force(x - y, v - w);
                (
                    (drive - self.viscous[0] * v - shaft + first) / a,
                    (shaft - self.viscous[1] * w + second) / b,
                )
            }
            Form::Crane => {
                // Newton's law for trolley and load, (a + b) x'' + b l cos(th) th'' = across, and
                // the moment about the trolley, cos(th) x'' + l th'' = along / (b l).
                let (sine, cosine) = y.sin_cos();
                let l = self.length;
                let across = drive - self.viscous[0] * v + b * l * w * w * sine + first;
                let moment = second - self.viscous[1] * w - b * GRAVITY * l * sine;
                let along = moment / (b * l);
                let acceleration = (across - b * cosine * along) / (a + b * sine * sine);
                (acceleration, (along - cosine * acceleration) / l)
            }
            Form::QuarterCar => {
                let strut = drive + first - self.spring.force(x - y, v - w);
                ((strut + second) / a, (-strut - self.tyre * y) / b)
            }
        };
        rates.copy_from_slice(&[v, w, v_rate, w_rate, bend, other_bend]);
    }
}
