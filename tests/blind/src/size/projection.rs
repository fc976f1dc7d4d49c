//! Fast measure of size: the change of the outputs due to an effect, without the changes that the
//! null model can fit. These are linearised along the motion of the machine without the effect:
//! initial states are free, declared parameters and sensors are within their priors.

use nalgebra::{DMatrix, DVector};

use super::windows::{Span, list_spans, outputs, simulate_window, states, with_sensor_errors};
use crate::hidden::{Effect, HiddenEffect, Sensors};
use crate::inputs::Drive;
use crate::machines::{Machine, Setup};

/// Changes of the outputs that the null model can fit, relative to the noise.
pub struct Basis {
    windows: Vec<Part>,
}

/// Directions for one window: an orthonormal basis for initial states, and the orthogonalised
/// directions of the declared unknowns.
struct Part {
    span: Span,
    starts: DMatrix<f64>,
    declared: DMatrix<f64>,
}

impl Basis {
    /// Computes the directions along the motion of a machine, without the direction of the effect
    /// itself.
    pub fn new(machine: &Machine, setup: &Setup, drives: &[Drive], hidden: &HiddenEffect) -> Self {
        let all: Vec<_> = drives
            .iter()
            .map(|drive| states(machine, setup, drive))
            .collect();
        let part = |span: Span| {
            let start = &all[span.record][span.first];
            window_part(machine, setup, drives, start, span, hidden)
        };
        let windows = list_spans(setup, drives).into_iter().map(part).collect();
        Self { windows }
    }

    /// Returns the RMS residual of the effect, relative to the noise.
    pub fn floors(
        &self,
        plain: &Machine,
        setup: &Setup,
        drives: &[Drive],
        hidden: &HiddenEffect,
    ) -> f64 {
        let mut machine = plain.clone();
        let mut sensors = Sensors::ideal(setup.channels.len());
        hidden.hide(&mut machine, setup, &mut sensors);
        let runs: Vec<Vec<Vec<f64>>> = drives
            .iter()
            .map(|drive| states(&machine, setup, drive))
            .collect();
        let mut differences = Vec::new();
        for part in &self.windows {
            let span = part.span;
            let with = &runs[span.record][span.first..span.first + span.count];
            let start = plain.plain_state(&with[0]);
            let without = simulate_window(plain, setup, drives, &start, span);
            let deviating = with_sensor_errors(&outputs(&machine, setup, with), setup, &sensors);
            differences.push(deviating - without);
        }
        self.projected_rms(differences)
    }

    fn projected_rms(&self, mut differences: Vec<DVector<f64>>) -> f64 {
        let unknowns = self.windows.first().map_or(0, |part| part.declared.ncols());
        // The prior of the unknowns is the identity, because they are in standard deviations.
        let mut normal = DMatrix::identity(unknowns, unknowns);
        let mut right = DVector::zeros(unknowns);
        for (part, difference) in self.windows.iter().zip(&mut differences) {
            let inside = &part.starts * (part.starts.transpose() * &*difference);
            *difference -= inside;
            normal += part.declared.transpose() * &part.declared;
            right += part.declared.transpose() * &*difference;
        }
        let taken = normal
            .cholesky()
            .map_or_else(|| DVector::zeros(unknowns), |factor| factor.solve(&right));
        let (mut sum, mut count) = (0.0, 0);
        for (part, difference) in self.windows.iter().zip(differences) {
            count += difference.len();
            sum += (difference - &part.declared * &taken).norm_squared();
        }
        (sum / count as f64).sqrt()
    }
}

fn window_part(
    machine: &Machine,
    setup: &Setup,
    drives: &[Drive],
    start: &[f64],
    span: Span,
    hidden: &HiddenEffect,
) -> Part {
    let seen = simulate_window(machine, setup, drives, start, span);
    let mut starts = Vec::new();
    for place in machine.states_of_model() {
        let mut moved = start.to_vec();
        let perturbation = 1e-7;
        moved[place] += perturbation;
        starts.push((simulate_window(machine, setup, drives, &moved, span) - &seen) / perturbation);
    }
    let scaled: Vec<DVector<f64>> = starts
        .into_iter()
        .filter(|column| column.norm() > 0.0)
        .map(|column| column.normalize())
        .collect();
    let svd = DMatrix::from_columns(&scaled).svd(true, false);
    let kept = svd.singular_values.iter().filter(|s| **s > 1e-6).count();
    let starts = svd.u.map_or_else(
        || DMatrix::zeros(seen.len(), 0),
        |u| u.columns(0, kept).into_owned(),
    );
    let mut declared = Vec::new();
    for (name, relative) in &setup.uncertain {
        if hidden.effect == Effect::ParameterShift && hidden.on == *name {
            continue;
        }
        let mut other = machine.clone();
        other.scale(name, 1.0 + 1e-2 * relative);
        declared.push((simulate_window(&other, setup, drives, start, span) - &seen) / 1e-2);
    }
    declared.extend(sensor_directions(&seen, setup, hidden));
    let declared = DMatrix::from_columns(&declared);
    let inside = &starts * (starts.transpose() * &declared);
    Part {
        span,
        starts,
        declared: declared - inside,
    }
}

/// Returns the influence of one standard deviation of gain, bias and delay of each sensor, without
/// the hidden error.
fn sensor_directions(
    seen: &DVector<f64>,
    setup: &Setup,
    hidden: &HiddenEffect,
) -> Vec<DVector<f64>> {
    let channels = setup.channels.len();
    let mut columns = Vec::new();
    for unknown in 0..3 * channels {
        let mut one = DVector::zeros(3 * channels);
        one[unknown] = 1.0;
        let effect = Sensors::UNKNOWNS[unknown % 3];
        if hidden.effect == effect && hidden.on == setup.channels[unknown / 3].name {
            continue;
        }
        let sensors = Sensors::within_priors(setup, one.as_slice());
        columns.push(with_sensor_errors(seen, setup, &sensors) - seen);
    }
    columns
}

/// Returns the RMS residual of a model with fewer modes for the motion of the true arm, in noise
/// floors.
pub fn floors_of_missing_modes(machine: &Machine, setup: &Setup, drives: &[Drive]) -> f64 {
    let Machine::Arm(arm) = machine else {
        return 0.0;
    };
    let mut model = arm.clone();
    model.modes = setup.order.unwrap_or(model.modes);
    model.prepare();
    let model = Machine::Arm(model);
    let none = HiddenEffect {
        effect: Effect::CoulombFriction,
        on: "theta_s".to_owned(),
        order: 0.0,
        sign: 1.0,
        phase: 0.0,
        amount: 0.0,
    };
    let basis = Basis::new(&model, setup, drives, &none);
    let all: Vec<_> = drives
        .iter()
        .map(|drive| states(machine, setup, drive))
        .collect();
    let differences = basis.windows.iter().map(|part| {
        let span = part.span;
        let truth = &all[span.record][span.first..span.first + span.count];
        outputs(machine, setup, truth) - simulate_window(&model, setup, drives, &truth[0], span)
    });
    basis.projected_rms(differences.collect())
}
