//! Hidden forces on an axis. Unlike the catalogue, dry friction is a bristle model (LuGre) or a
//! steep hyperbolic tangent instead of the sign function.

/// Law of dry friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FrictionLaw {
    /// Bristles that deflect before they slide. Their damping follows from the inertia of the axis
    /// (force unit s^2 per axis unit).
    Bristles {
        /// Deflection at which the bristles slide, in axis units.
        reach: f64,
        /// Inertia of the axis.
        inertia: f64,
    },
    /// Hyperbolic tangent of the speed.
    Steep {
        /// Speed at which the friction is tanh(1) = 0.76 of its full value, axis units per second.
        speed: f64,
    },
}

/// Forces on an axis, in its units of force and of angle or length. All forces are zero without a
/// hidden effect.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisForces {
    /// Law of dry friction.
    pub dry: FrictionLaw,
    /// Sliding friction.
    pub coulomb: f64,
    /// Static friction minus sliding friction, and the Stribeck speed.
    pub stribeck: (f64, f64),
    /// Viscous friction, per speed.
    pub viscous: f64,
    /// Asymmetric friction, per absolute speed.
    pub asymmetric: f64,
    /// Quadratic drag, per square of the speed.
    pub drag: f64,
    /// Constant force.
    pub offset: f64,
    /// Stiffness of a spring to zero displacement.
    pub restraint: f64,
    /// Unbalanced weight: cosine and sine of its potential, see [`AxisForces::force`].
    pub gravity: (f64, f64),
    /// Ripple: periods per revolution, cosine and sine.
    pub ripple: (f64, f64, f64),
    /// Force outside the catalogue.
    pub strange: UncataloguedForce,
}

/// Force outside the catalogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UncataloguedForce {
    /// No additional force.
    None,
    /// Friction that increases with the square of the displacement: -size x^2 x'.
    Worn(f64),
    /// External force: size sin(2 pi f t). Elements: size, and f in Hz.
    Hum(f64, f64),
    /// Drive that weakens with the displacement x: -size x u, with the input u.
    Weakening(f64),
}

impl AxisForces {
    /// Returns forces without a hidden effect.
    pub fn none(dry: FrictionLaw) -> Self {
        Self {
            dry,
            coulomb: 0.0,
            stribeck: (0.0, 1.0),
            viscous: 0.0,
            asymmetric: 0.0,
            drag: 0.0,
            offset: 0.0,
            restraint: 0.0,
            gravity: (0.0, 0.0),
            ripple: (0.0, 0.0, 0.0),
            strange: UncataloguedForce::None,
        }
    }

    /// Returns the force along the axis, and the rate of the bristle deflection. Arguments:
    /// displacement `x`, rate `v`, bristle deflection `z`.
    pub fn force(&self, t: f64, x: f64, v: f64, z: f64, input: f64) -> (f64, f64) {
        let (dry, bending) = self.dry_friction(v, z);
        let per_turn = self.ripple.0 * x;
        let strange = match self.strange {
            UncataloguedForce::None => 0.0,
            UncataloguedForce::Worn(size) => -size * x * x * v,
            UncataloguedForce::Hum(size, f) => size * (2.0 * std::f64::consts::PI * f * t).sin(),
            UncataloguedForce::Weakening(size) => -size * x * input,
        };
        let smooth = self.offset
            - self.viscous * v
            - self.asymmetric * v.abs()
            - self.drag * v * v.abs()
            - self.restraint * x
            - sinusoid((self.gravity.1, self.gravity.0), x)
            + sinusoid((self.ripple.1, self.ripple.2), per_turn);
        (smooth + strange - dry, bending)
    }

    fn dry_friction(&self, v: f64, z: f64) -> (f64, f64) {
        let (near_rest, fall) = self.stribeck;
        if self.coulomb == 0.0 && near_rest == 0.0 {
            return (0.0, 0.0);
        }
        let level = self.coulomb + near_rest * (-(v / fall) * (v / fall)).exp();
        match self.dry {
            FrictionLaw::Steep { speed } => (level * (v / speed).tanh(), 0.0),
            // Bristles with a large Stribeck excess would need shorter integration steps.
            FrictionLaw::Bristles { .. } if self.coulomb < near_rest => {
                (level * (v / (0.01 * fall)).tanh(), 0.0)
            }
            FrictionLaw::Bristles { reach, inertia } => {
                let stiffness = (self.coulomb + near_rest) / reach;
                let bending = v - stiffness * v.abs() * z / level;
                // The damping ratio is one half at rest and decreases to zero as the bristles
                // slide.
                let damping = (stiffness * inertia).sqrt();
                let pace = v / (reach * (stiffness / inertia).sqrt());
                let damped = damping * bending * (-pace * pace).exp();
                (stiffness * z + damped, bending)
            }
        }
    }
}

/// Returns a sum of a cosine and a sine. It returns early if both amplitudes are zero, because
/// sines are expensive.
fn sinusoid((cosine, sine): (f64, f64), angle: f64) -> f64 {
    if cosine == 0.0 && sine == 0.0 {
        return 0.0;
    }
    let (s, c) = angle.sin_cos();
    cosine * c + sine * s
}

#[cfg(test)]
mod tests {
    use super::{AxisForces, FrictionLaw};

    /// Returns the force after long sliding at constant speed, with fully bent bristles.
    fn sliding_force(forces: &AxisForces, v: f64) -> f64 {
        let mut z = 0.0;
        for _ in 0..100_000 {
            z += 1e-6 * forces.force(0.0, 0.0, v, z, 0.0).1;
        }
        forces.force(0.0, 0.0, v, z, 0.0).0
    }

    #[test]
    fn both_friction_laws_have_the_same_sliding_force() {
        for v in [-0.3, 0.05, 0.5] {
            let of = |dry| {
                let mut forces = AxisForces::none(dry);
                forces.coulomb = 4.0;
                forces.stribeck = (2.0, 0.1);
                sliding_force(&forces, v)
            };
            let expected = -v.signum() * (4.0 + 2.0 * (-(v / 0.1) * (v / 0.1)).exp());
            let bristles = of(FrictionLaw::Bristles {
                reach: 1e-5,
                inertia: 0.01,
            });
            let steep = of(FrictionLaw::Steep { speed: 1e-4 });
            assert!((bristles - expected).abs() < 1e-6, "{bristles} {expected}");
            assert!((steep - expected).abs() < 1e-6, "{steep} {expected}");
        }
    }

    #[test]
    fn large_stribeck_excess_does_not_use_bristles() {
        let force = |dry| {
            let mut forces = AxisForces::none(dry);
            forces.coulomb = 2.0;
            forces.stribeck = (8.0, 0.02);
            forces.force(0.0, 0.0, 0.5, 0.0, 0.0)
        };
        let bristles = force(FrictionLaw::Bristles {
            reach: 5e-6,
            inertia: 95.0,
        });
        assert_eq!(bristles, force(FrictionLaw::Steep { speed: 2e-4 }));
    }

    #[test]
    fn forces_have_the_correct_sign() {
        let mut forces = AxisForces::none(FrictionLaw::Steep { speed: 1e-4 });
        forces.viscous = 2.0;
        forces.drag = 3.0;
        assert_eq!(
            forces.force(0.0, 0.0, -2.0, 0.0, 0.0).0,
            2.0 * 2.0 + 3.0 * 4.0
        );
        let mut forces = AxisForces::none(FrictionLaw::Steep { speed: 1e-4 });
        forces.asymmetric = 1.5;
        assert_eq!(forces.force(0.0, 0.0, -2.0, 0.0, 0.0).0, -3.0);
        forces.asymmetric = 0.0;
        forces.ripple = (2.0, 5.0, 7.0);
        let quarter = std::f64::consts::FRAC_PI_4;
        assert!((forces.force(0.0, quarter, 0.0, 0.0, 0.0).0 - 7.0).abs() < 1e-12);
    }
}
