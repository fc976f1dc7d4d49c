//! Detection of poles of coordinates: states at which the inertia of a coordinate vanishes.
//!
//! A spherical pendulum that hangs along its polar axis can move in two directions. Only one of its two angles
//! describes such a motion, so a linearisation at this state lacks a mode. At a pole, a pivot of the factorisation M =
//! L D L^T vanishes with the square of the distance, on both sides.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DMatrix;

use crate::displacements::DISPLACEMENT;
use crate::error::Error;
use crate::instance::Instance;

/// Smallest growth of a pivot from a pole to both displaced points. A regular pivot changes by a fraction of about
/// [`DISPLACEMENT`].
const MIN_GROWTH: f64 = 4.0;

impl Instance<'_> {
    /// Returns the name of a coordinate whose inertia vanishes at a point.
    ///
    /// # Errors
    /// Invalid parameter values.
    pub(crate) fn find_coordinate_pole(&self, point: Point<'_>) -> Result<Option<String>, Error> {
        if !self.model().program().may_lose_definiteness() {
            return Ok(None);
        }
        let mut evaluator = self.interpreter()?;
        let direction = self.generic_direction()?;
        let degrees = self.model().program().degrees_of_freedom();
        let mut pivots_at = |displacement: f64| {
            let mut state = point.state.to_vec();
            for (value, part) in state.iter_mut().zip(&direction).take(degrees) {
                *value += displacement * part;
            }
            let state = &state;
            compute_pivots(&mut evaluator, Point { state, ..point })
        };
        let here = pivots_at(0.0);
        let beside = [-DISPLACEMENT, DISPLACEMENT].map(pivots_at);
        let is_pole = |place: &usize| {
            let mut grown = beside.iter().map(|there| there.get(*place));
            grown.all(|there| there.is_some_and(|there| *there > MIN_GROWTH * here[*place].abs()))
        };
        let pole = (0..here.len()).find(is_pole);
        Ok(pole.map(|place| self.model().state_names()[place].clone()))
    }
}

/// Returns the pivots D of the mass matrix, up to the first that is not positive.
fn compute_pivots(evaluator: &mut Evaluator, point: Point<'_>) -> Vec<f64> {
    let degrees = evaluator.program().degrees_of_freedom();
    let mut mass = vec![0.0; degrees * degrees];
    evaluator.mass_matrix(point, &mut mass);
    let mut rest = DMatrix::from_row_slice(degrees, degrees, &mass);
    let mut found = Vec::with_capacity(degrees);
    for place in 0..degrees {
        let pivot = rest[(place, place)];
        found.push(pivot);
        if pivot.is_nan() || pivot <= 0.0 {
            break;
        }
        let column = rest.view_range(place + 1.., place).into_owned();
        let mut below = rest.view_range_mut(place + 1.., place + 1..);
        below.ger(-1.0 / pivot, &column, &column, 1.0);
    }
    found
}

#[cfg(test)]
mod tests {
    use crate::{CompiledModel, Orders};

    /// Returns the coordinate with a pole of a model at a state at rest, if there is one.
    fn pole(text: &str, coordinates: &[f64]) -> Option<String> {
        let model = CompiledModel::from_text("machine.toml", text, Orders::Declared);
        let model = model.expect("a model");
        let run = model.with_declared_parameters().expect("an instance");
        let mut at = run.operating_point(&[]).expect("a point");
        at.state[..coordinates.len()].copy_from_slice(coordinates);
        let found = run.find_coordinate_pole(at.point());
        found.expect("declared parameters")
    }

    /// Specification with an angle about an axis and a distance from it.
    const SPHERICAL: &str = r#"
[model]
name = "spherical"
[parameters]
m = { value = 1e-6, unit = "kg" }
l = { value = 40, unit = "um" }
[coordinates]
theta = { unit = "rad", initial = 1 }
phi = { unit = "rad" }
[kinetic]
bob = "1/2*m*l^2*(dot(theta)^2 + sin(theta)^2*dot(phi)^2)"
"#;

    #[test]
    fn angle_about_an_axis_has_a_pole_on_the_axis() {
        for theta in [0.0, 1e-27, -1e-9, std::f64::consts::PI, 1e-6] {
            let found = pole(SPHERICAL, &[theta, 0.3]);
            assert_eq!(found.as_deref(), Some("phi"), "{theta}");
        }
        for theta in [1e-4, 0.5, std::f64::consts::FRAC_PI_2] {
            assert_eq!(pole(SPHERICAL, &[theta, 0.3]), None, "{theta}");
        }
    }

    #[test]
    fn distance_from_an_axis_has_a_pole_at_any_scale() {
        for (unit, scale) in [("um", 1e-6), ("m", 1.0), ("km", 1e3)] {
            let text = SPHERICAL
                .replace("unit = \"um\"", &format!("unit = \"{unit}\""))
                .replace(
                    "theta = { unit = \"rad\", initial = 1 }",
                    "r = { unit = \"m\", initial = \"l\" }",
                )
                .replace(
                    "l^2*(dot(theta)^2 + sin(theta)^2*dot(phi)^2)",
                    "(dot(r)^2 + r^2*dot(phi)^2)",
                );
            let found = pole(&text, &[1e-6 * scale, 0.3]);
            assert_eq!(found.as_deref(), Some("phi"), "{unit}");
            assert_eq!(pole(&text, &[scale, 0.3]), None, "{unit}");
        }
    }

    #[test]
    fn aligned_axes_of_a_gimbal_are_a_pole() {
        let text = r#"
[model]
name = "gimbal"
[parameters]
A = { value = 1, unit = "kg m^2" }
B = { value = 2, unit = "kg m^2" }
C = { value = 3, unit = "kg m^2" }
[coordinates]
a = { unit = "rad" }
b = { unit = "rad" }
c = { unit = "rad" }
[definitions]
w_1 = "dot(c) - sin(b)*dot(a)"
w_2 = "cos(c)*dot(b) + sin(c)*cos(b)*dot(a)"
w_3 = "-sin(c)*dot(b) + cos(c)*cos(b)*dot(a)"
[kinetic]
body = "1/2*(A*w_1^2 + B*w_2^2 + C*w_3^2)"
"#;
        let aligned = std::f64::consts::FRAC_PI_2;
        for b in [aligned, -aligned, aligned + 1e-9] {
            assert_eq!(pole(text, &[0.2, b, 0.7]).as_deref(), Some("c"), "{b}");
        }
        assert_eq!(pole(text, &[0.2, aligned - 1e-3, 0.7]), None);
    }

    #[test]
    fn mass_that_jumps_or_vanishes_far_away_is_no_pole() {
        let text = r#"
[model]
name = "load"
[parameters]
m = { value = 1, unit = "kg" }
l = { value = 1, unit = "m" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*m*(1 + 99*above(x))*dot(x)^2"
"#;
        assert_eq!(pole(text, &[0.0]), None);
        let growing = text.replace("(1 + 99*above(x))", "(1e-3 + (x/l)^2)");
        assert_eq!(pole(&growing, &[0.0]), None);
    }
}
