//! Size of a hidden effect: the RMS residual over the windows, relative to the noise, after a fit
//! of the machine without the effect. Initial states are free; declared parameters and sensors are
//! within three standard deviations of their priors. The size is adjusted until the residual is a
//! given number of noise floors: first with a fast linear projection (`projection`), then with full
//! fits (`fit`).

mod fit;
mod linear;
mod projection;
mod search;
mod windows;

use crate::hidden::{Effect, HiddenEffect};
use crate::inputs::Drive;
use crate::machines::two_bodies::TwoBodies;
use crate::machines::{Machine, Setup};
pub use fit::Fit;
use projection::Basis;
use search::Search;

pub use projection::floors_of_missing_modes;
pub use windows::window;

const PROJECTION_ACCURACY: f64 = 0.02;

const MAX_PROJECTIONS: usize = 13;

const FIT_ACCURACY: f64 = 0.05;

const MAX_FITS: usize = 3;

/// Divisors of the number of integration steps for fits. Smaller divisors are used if long steps
/// are unstable.
const STEP_DIVISORS: [usize; 3] = [8, 4, 2];

/// Effect with its size.
pub struct SizedEffect {
    /// Effect.
    pub hidden: HiddenEffect,
    /// Residual of the effect, in noise floors.
    pub floors: f64,
}

/// Determines the size for which the residual of an effect is `level` noise floors. For a sensor
/// error or a declared parameter, the size is `level + 2` standard deviations of its prior, because
/// deviations above three are effects; the noise floors are computed from it. `declared`: true
/// values of the declared parameters, as factors.
pub fn determine_size(
    machine: &Machine,
    setup: &Setup,
    drives: &[Drive],
    declared: &[(String, f64)],
    mut hidden: HiddenEffect,
    level: f64,
) -> SizedEffect {
    if matches!(hidden.effect, Effect::EndStop | Effect::EndStops) {
        hidden.order = 0.5 * largest_deflection(machine, setup, drives, hidden.sign);
    }
    let coarse = |part: usize| Setup {
        steps: setup.steps / part,
        ..setup.clone()
    };
    // Records and fit use the same step size, so that its errors cancel.
    let left = |hidden: &HiddenEffect| {
        let of = |part: &usize| Fit::new(machine, &coarse(*part), drives, declared).floors(hidden);
        let mut all = STEP_DIVISORS.iter().map(of);
        all.find(|floors| floors.is_finite()).unwrap_or(f64::NAN)
    };
    let halved = coarse(2);
    if let Some(deviation) = hidden.prior(setup) {
        hidden.amount = deviation * (level.min(10.0) + 2.0);
        let floors = left(&hidden);
        return SizedEffect { hidden, floors };
    }
    let (begin, largest) = size_range(&hidden, machine, drives);
    hidden.amount = begin;
    let training = &drives[..setup.records.0];
    let basis = Basis::new(machine, &halved, training, &hidden);
    let projected = |hidden: &HiddenEffect| basis.floors(machine, &halved, training, hidden);
    let search = Search::new(level, PROJECTION_ACCURACY);
    (hidden.amount, _) = search.run(hidden.clone(), largest, MAX_PROJECTIONS, projected);
    let search = Search::new(level, FIT_ACCURACY);
    let (amount, floors) = search.run(hidden.clone(), largest, MAX_FITS, left);
    hidden.amount = amount;
    SizedEffect { hidden, floors }
}

fn largest_deflection(machine: &Machine, setup: &Setup, drives: &[Drive], side: f64) -> f64 {
    let motions = drives
        .iter()
        .flat_map(|drive| windows::states(machine, setup, drive));
    motions
        .map(|state| side * TwoBodies::deflection(&state))
        .fold(0.0, f64::max)
}

fn size_range(hidden: &HiddenEffect, machine: &Machine, drives: &[Drive]) -> (f64, f64) {
    let free = f64::INFINITY;
    let inputs = drives.iter().flat_map(|drive| &drive.input);
    let strongest = inputs.fold(0.0f64, |most, input| most.max(input.abs()));
    let of_axis = |arm: f64, stage: f64, pendulum: f64| match machine {
        Machine::Arm(_) => (arm, free),
        Machine::Stage(_) => (stage, free),
        Machine::Pendulum(_) => (pendulum, free),
        Machine::TwoBodies(_) => (0.02 * strongest, free),
    };
    match hidden.effect {
        Effect::Backlash | Effect::EndStop | Effect::EndStops | Effect::StiffnessNonlinearity
            if let Machine::TwoBodies(bodies) = machine =>
        {
            let stiffness = bodies.spring.stiffness;
            let deflection = strongest / stiffness;
            match hidden.effect {
                Effect::Backlash => (0.05 * deflection, deflection),
                Effect::StiffnessNonlinearity => (
                    0.05 * stiffness / deflection.powi(2),
                    10.0 * stiffness / deflection.powi(2),
                ),
                _ => (stiffness, 30.0 * stiffness),
            }
        }
        Effect::InputGain => (0.05, 0.5),
        // Half of the critical damping of the first mode.
        Effect::StructuralDamping => (1e-4, 5e-3),
        Effect::TipMass => (0.01, 1.0),
        // The stiffness must be positive at the largest deflections.
        Effect::StiffnessNonlinearity if hidden.sign < 0.0 => (3e7, 1e8),
        Effect::StiffnessNonlinearity => (1e8, 1e11),
        Effect::JointCompliance => (1e-4, 0.01),
        Effect::TransmissionError => (3e-6, 1e-4),
        Effect::StiffnessVariation => (0.2, 0.6),
        Effect::AsymmetricBacklash => (1e-5, 2e-5),
        Effect::ParameterShift => (0.02, 0.5),
        // The drive must be stronger than the friction.
        Effect::CoulombFriction | Effect::StribeckFriction
            if matches!(machine, Machine::Stage(_) | Machine::TwoBodies(_)) =>
        {
            (0.01 * strongest, 0.5 * strongest)
        }
        Effect::QuadraticDrag | Effect::WornFriction => of_axis(1e-4, 10.0, 1e-5),
        Effect::WeakeningDrive => of_axis(0.01, 0.1, 0.0),
        _ => of_axis(0.05, 1.0, 1e-4),
    }
}

#[cfg(test)]
mod tests {
    use super::{Basis, Fit, determine_size};
    use crate::hidden::{Effect, HiddenEffect};
    use crate::inputs::{Drive, Excitation, drive};
    use crate::machines::{Kind, Setup};
    use crate::random::RandomStream;

    fn pendulum() -> (Setup, Vec<Drive>) {
        let setup = Setup {
            steps: 25,
            ..Kind::Pendulum.setup()
        };
        let mut draw = RandomStream::new(11, 0);
        let drives = (0..5).map(|p| drive(Kind::Pendulum, &setup, Excitation::Usual, p, &mut draw));
        let drives = drives.collect();
        (setup, drives)
    }

    fn hidden(effect: Effect, amount: f64) -> HiddenEffect {
        HiddenEffect {
            effect,
            on: "theta".to_owned(),
            order: 0.0,
            sign: 1.0,
            phase: 0.0,
            amount,
        }
    }

    #[test]
    fn declared_parameter_is_fitted_in_the_nonlinear_range() {
        let (setup, drives) = pendulum();
        let machine = Kind::Pendulum.nominal();
        let fit = Fit::new(&machine, &setup, &drives, &[]);
        // The factor 0.6 on the declared friction is two standard deviations.
        let friction = hidden(Effect::ViscousFriction, 0.6 * 2.239e-4);
        let projected = Basis::new(&machine, &setup, &drives, &friction)
            .floors(&machine, &setup, &drives, &friction);
        let fitted = fit.floors(&friction);
        println!("projected {projected}, fitted {fitted}");
        assert!(projected > 1.0, "{projected}");
        assert!(fitted < 0.02, "{fitted}");
        // Four standard deviations exceed the bound by one.
        let beyond = hidden(Effect::ViscousFriction, 1.2 * 2.239e-4);
        let fitted = fit.floors(&beyond);
        println!("beyond {fitted}");
        assert!(fitted > 1.0, "{fitted}");
    }

    #[test]
    fn effect_has_the_requested_size() {
        let (setup, drives) = pendulum();
        let machine = Kind::Pendulum.nominal();
        let found = determine_size(
            &machine,
            &setup,
            &drives,
            &[],
            hidden(Effect::QuadraticDrag, 0.0),
            6.0,
        );
        let fit = Fit::new(&machine, &setup, &drives, &[]);
        let floors = fit.floors(&found.hidden);
        println!("{} {floors}", found.floors);
        assert!(
            (found.floors / 6.0).ln().abs() < super::FIT_ACCURACY,
            "{}",
            found.floors
        );
        assert!((floors / found.floors).ln().abs() < 0.02, "{floors}");
    }
}
