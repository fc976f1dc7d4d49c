//! Constants of the equations of motion, computed from the parameters of the arm and its reducer (Table I).
//!
//! Parameters are doubles, as in a specification. Derived constants are computed in the arithmetic of `T`.

use super::modes::Mode;
use super::scalar::Scalar;

/// Parameters that vary between runs. All others are from Table I, or assumed if the paper gives no value.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Number of modes, S.
    pub order: usize,
    /// Half the backlash of both meshes, in m.
    pub b: f64,
    /// Frequency of the torque ripple, in rad/s.
    pub omega: f64,
}

/// Constants of one mode of the arm.
#[derive(Clone, Copy, Debug)]
pub struct ArmMode<T> {
    /// K/M, in rad^2/s^2.
    pub stiffness: T,
    /// h, in kg m.
    pub h: T,
    /// h/M, in m.
    pub share: T,
    /// phi(l).
    pub tip: T,
}

/// Constants of the equations, in SI units.
#[derive(Clone, Debug)]
pub struct Arm<T> {
    /// I_s/r_s^2, in kg.
    pub m_s: T,
    /// I_p/r_p^2, in kg.
    pub m_p: T,
    /// r_c cos(alpha), in m.
    pub lever: T,
    /// Inertia at the carrier after elimination of the modes: I_tot minus the sum of h_i^2/M_i, in
    /// kg m^2.
    pub inertia: T,
    /// Stiffness of either mesh, in N/m.
    pub k: T,
    /// Damping of either mesh, in N s/m.
    pub c: T,
    /// Half the backlash, in m.
    pub b: T,
    /// a_m/r_s, in N.
    pub drive: T,
    /// b_m/r_s^2, in N s/m.
    pub drag: T,
    /// F_w/r_s, in N.
    pub ripple: T,
    /// Frequency of the ripple, in rad/s.
    pub omega: T,
    /// Modes of the arm.
    pub modes: Vec<ArmMode<T>>,
}

impl<T: Scalar> Arm<T> {
    /// Computes the constants for a case.
    pub fn from_case(case: Case) -> Self {
        let number = T::from_f64;
        let pressure_angle = number(24.6) * T::PI / number(180.0);
        let (_, cos) = pressure_angle.sin_cos();
        let module = number(3.0) / number(1000.0);
        let r_s = module * cos.scaled_by(27.0 / 2.0);
        let r_c = module.scaled_by((27.0 + 36.0) / 2.0);
        let carrier = (number(6.29) + number(0.66).scaled_by(3.0)) * r_c * r_c;
        let beam = Beam::steel();
        let modes: Vec<ArmMode<T>> = (1..=case.order).map(|r| beam.mode(r)).collect();
        let whole = carrier + beam.inertia();
        let inertia = modes
            .iter()
            .fold(whole, |inertia, mode| inertia - mode.h * mode.share);
        Self {
            m_s: number(0.39),
            m_p: number(0.61),
            lever: r_c * cos,
            inertia,
            k: number(1e8),
            c: number(650.0),
            b: number(case.b),
            drive: number(2.0) / r_s,
            drag: number(0.05) / (r_s * r_s),
            ripple: number(5.0) / r_s,
            omega: number(case.omega),
            modes,
        }
    }
}

struct Beam<T> {
    /// rho A, in kg/m.
    mass: T,
    /// E I, in N m^2.
    stiffness: T,
    /// In m.
    length: T,
}

impl<T: Scalar> Beam<T> {
    /// Returns the paper's arm with the assumed cross-section.
    fn steel() -> Self {
        Self {
            mass: T::from_f64(7900.0) * T::from_f64(1e-4),
            stiffness: T::from_f64(2e11) * T::from_f64(8.333e-10),
            length: T::from_f64(0.5),
        }
    }

    /// Returns rho A l^3/3, in kg m^2.
    fn inertia(&self) -> T {
        self.mass * self.length * self.length * self.length / T::from_f64(3.0)
    }

    /// Returns mode `r` with h = rho A int x phi, M = rho A int phi^2, K = E I int phi''^2.
    fn mode(&self, r: usize) -> ArmMode<T> {
        let mode = Mode::<T>::clamped_free(r);
        let l = self.length;
        let h = self.mass * l * l * mode.moment;
        let m = self.mass * l * mode.square;
        let k = self.stiffness / (l * l * l) * mode.bending;
        ArmMode {
            stiffness: k / m,
            h,
            share: h / m,
            tip: mode.tip,
        }
    }
}
