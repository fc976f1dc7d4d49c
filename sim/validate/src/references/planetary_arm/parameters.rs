//! Parameters of the arm with the names of the paper's nomenclature, and radii computed from them.
//!
//! The values are from Table I. If the paper gives no value, the value is marked "assumed".

use std::f64::consts::PI;

/// Parameters of the arm on its planetary reducer, SI.
///
/// `Default` has the values of Table I, and assumed values for fields marked "assumed".
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(non_snake_case, reason = "names as in the paper's nomenclature")]
pub struct PlanetaryArmParameters {
    /// Mesh stiffness between sun and planet, N/m (Table I).
    pub k_sp: f64,
    /// Mesh stiffness between planet and ring, N/m (Table I).
    pub k_pr: f64,
    /// Mesh damping between sun and planet, N s/m (assumed).
    pub c_sp: f64,
    /// Mesh damping between planet and ring, N s/m (assumed).
    pub c_pr: f64,
    /// Half of the backlash between sun and planet, m.
    pub b_sp: f64,
    /// Half of the backlash between planet and ring, m.
    pub b_pr: f64,
    /// Mass of one planet, kg (Table I).
    pub m_p: f64,
    /// Moment of inertia of the sun, kg m^2 (Table I gives I_s/r_s^2).
    pub I_s: f64,
    /// Moment of inertia of one planet about its shaft, kg m^2 (Table I gives I_p/r_p^2).
    pub I_p: f64,
    /// Moment of inertia of the carrier, kg m^2 (Table I gives I_c/r_c^2).
    pub I_c: f64,
    /// Density of the arm, kg/m^3 (Table I).
    pub rho: f64,
    /// Section area of the arm, m^2 (Table I).
    pub A: f64,
    /// Length of the arm, m (Table I).
    pub l: f64,
    /// Young's modulus of the arm, Pa (Table I).
    pub E: f64,
    /// Second moment of area of the arm's section, m^4 (assumed: a square of 10 mm).
    pub I: f64,
    /// Pressure angle, rad (Table I).
    pub alpha: f64,
    /// Teeth of the sun (Table I).
    pub z_s: f64,
    /// Teeth of a planet (Table I).
    pub z_p: f64,
    /// Teeth of the ring (Table I).
    pub z_r: f64,
    /// Module, m (Table I).
    pub m: f64,
    /// Constant motor torque, N m (assumed).
    pub a_m: f64,
    /// Motor damping, N m s (assumed).
    pub b_m: f64,
    /// Amplitude of the motor's torque fluctuation, N m (assumed).
    pub F_w: f64,
    /// Angular frequency of the torque fluctuation, rad/s.
    pub omega: f64,
}

/// Defines conversions between names and fields. Compilation fails if a field is not listed.
macro_rules! named_fields {
    ($($field:ident)*) => {
        impl PlanetaryArmParameters {
            /// Collects the values of all fields by name, or returns `None` if one is missing.
            pub fn from_names(value: impl Fn(&str) -> Option<f64>) -> Option<Self> {
                Some(Self { $($field: value(stringify!($field))?),* })
            }

            /// Returns every field with its name.
            #[allow(non_snake_case, reason = "names as in the paper's nomenclature")]
            pub fn named_values(&self) -> Vec<(&'static str, f64)> {
                let Self { $($field),* } = *self;
                vec![$((stringify!($field), $field)),*]
            }
        }
    };
}

named_fields! {
    k_sp k_pr c_sp c_pr b_sp b_pr m_p I_s I_p I_c rho A l E I alpha z_s z_p z_r m a_m b_m F_w omega
}

impl Default for PlanetaryArmParameters {
    fn default() -> Self {
        let mut parameters = Self {
            k_sp: 1e8,
            k_pr: 1e8,
            c_sp: 650.0,
            c_pr: 650.0,
            b_sp: 25e-6,
            b_pr: 25e-6,
            m_p: 0.66,
            I_s: 0.0,
            I_p: 0.0,
            I_c: 0.0,
            rho: 7900.0,
            A: 1e-4,
            l: 0.5,
            E: 2e11,
            I: 8.333e-10,
            alpha: 24.6_f64.to_radians(),
            z_s: 27.0,
            z_p: 36.0,
            z_r: 99.0,
            m: 3e-3,
            a_m: 2.0,
            b_m: 0.05,
            F_w: 5.0,
            omega: 10.0 * PI,
        };
        parameters.I_s = 0.39 * parameters.r_s().powi(2);
        parameters.I_p = 0.61 * parameters.r_p().powi(2);
        parameters.I_c = 6.29 * parameters.r_c().powi(2);
        parameters
    }
}

#[allow(non_snake_case, reason = "names as in the paper's nomenclature")]
impl PlanetaryArmParameters {
    /// Returns the base circle radius of the sun, m: m z_s cos(alpha)/2.
    pub fn r_s(&self) -> f64 {
        self.m * self.z_s * self.alpha.cos() / 2.0
    }

    /// Returns the base circle radius of a planet, m: m z_p cos(alpha)/2.
    pub fn r_p(&self) -> f64 {
        self.m * self.z_p * self.alpha.cos() / 2.0
    }

    /// Returns the radius of the carrier, m: m (z_s + z_p)/2.
    pub fn r_c(&self) -> f64 {
        self.m * (self.z_s + self.z_p) / 2.0
    }

    /// Returns the equivalent base radius of the carrier, m: r_c cos(alpha), Eq. (3).
    pub fn r_c_cos_alpha(&self) -> f64 {
        self.r_c() * self.alpha.cos()
    }

    /// Returns the moment of inertia of the straight arm about the joint, kg m^2: rho A l^3/3.
    pub fn I_arm(&self) -> f64 {
        self.rho * self.A * self.l.powi(3) / 3.0
    }

    /// Returns the inertia that turns with the carrier, kg m^2: I_c + 3 m_p r_c^2 + I_arm.
    pub fn I_tot(&self) -> f64 {
        self.I_c + 3.0 * self.m_p * self.r_c().powi(2) + self.I_arm()
    }

    /// Returns the transmission ratio from sun to carrier: 1 + z_r/z_s.
    pub fn i_sH(&self) -> f64 {
        1.0 + self.z_r / self.z_s
    }

    /// Returns the motor's torque fluctuation at time `t` (s), N m: F_w sin(omega t) of Eq. (11).
    pub fn torque_fluctuation(&self, t: f64) -> f64 {
        self.F_w * eomgen_elementary::sin(self.omega * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bound of the relative rounding error of a few products.
    const ROUNDING: f64 = 1e-15;

    #[test]
    fn radii_satisfy_the_geometry() {
        let parameters = PlanetaryArmParameters::default();
        let sum = parameters.r_s() + parameters.r_p();
        assert!((parameters.r_c_cos_alpha() - sum).abs() <= ROUNDING * sum);
        let ratio = 2.0 * (parameters.z_s + parameters.z_p) / parameters.z_s;
        assert!((parameters.i_sH() - ratio).abs() <= ROUNDING * ratio);
    }

    #[test]
    fn arm_inertia_matches_table_1() {
        // Table I prints two digits.
        assert!((PlanetaryArmParameters::default().I_arm() - 0.033).abs() < 0.0005);
    }
}
