//! Scan of laws with one shape parameter along a reference motion. The position, speed, level or
//! width is scanned over decades; the sizes follow by linear least squares (variable projection).
//! The laws are not simulated, so the result does not depend on the initial values of a fit.

use eomgen_model_spec::edit::Edit;
use rayon::prelude::*;

use crate::catalogue::candidate::Candidate;
use crate::free_function::drives::{DrivenModel, average_drive, is_visible};
use crate::free_function::scene::Scene;
use crate::free_function::segments::{Drive, LinearFit};
use crate::model::estimation_model::EstimationModel;
use crate::thresholds;

/// A law with its shape and sizes from a scan.
#[derive(Clone, Debug)]
pub struct ScannedLaw {
    /// Law with the best scanned shape as its initial value.
    pub candidate: Candidate,
    /// Differences of the other parameters from their values without the effect, SI. For inverse
    /// parameters, the difference of the inverse.
    pub sizes: Vec<f64>,
    /// RMS residual of training and test records, in standard deviations.
    pub rms: f64,
}

/// Laws of a scan.
#[derive(Clone, Debug)]
pub struct LawScan {
    /// The laws, the best first.
    pub laws: Vec<ScannedLaw>,
    /// RMS residual without a law, in standard deviations.
    pub rms_without: f64,
}

/// Parameter that is scanned.
#[derive(Clone, Copy, Debug)]
struct ScannedParameter {
    index: usize,
    /// True if the law is linear in its other parameters at a fixed value of this parameter.
    /// Otherwise it has no other parameter.
    is_shape: bool,
}

/// Fit of a law at one value of its scanned parameter.
#[derive(Clone, Debug)]
struct Trial {
    value: f64,
    fit: LinearFit,
}

/// Law with its derived equations.
struct DerivedLaw<'c> {
    candidate: &'c Candidate,
    scanned: ScannedParameter,
    model: EstimationModel,
    values: Vec<f64>,
}

/// Scans all laws with a shape among candidates along the reference motion.
pub(crate) fn scan_laws(scene: &Scene<'_>, candidates: &[Candidate]) -> LawScan {
    let scanned = candidates.par_iter().filter_map(|candidate| {
        scene.problem.stop.check_not_stopped().ok()?;
        DerivedLaw::derive(scene, candidate)?.scan(scene)
    });
    let mut laws: Vec<ScannedLaw> = scanned.collect();
    laws.sort_by(|a, b| a.rms.total_cmp(&b.rms));
    LawScan {
        laws,
        rms_without: scene.segments.nuisance_fit.rms(),
    }
}

/// Returns the only parameter of a candidate that is not a size; `None` if there are several.
fn find_scanned(candidate: &Candidate) -> Option<ScannedParameter> {
    if candidate.dropped_prior.is_some() || candidate.angle_order.is_some() {
        return None;
    }
    let parameters = &candidate.parameters;
    let shapes: Vec<usize> = (0..parameters.len())
        .filter(|index| parameters[*index].shape_size.is_some())
        .collect();
    let is_new = parameters.iter().all(|p| p.offset.is_none());
    let substitutes = (candidate.changes.iter()).any(|edit| matches!(edit, Edit::Substitute(_)));
    match (&shapes[..], parameters.len()) {
        ([shape], 2..) if parameters.iter().all(|p| !p.is_inverse) => Some(ScannedParameter {
            index: *shape,
            is_shape: true,
        }),
        ([], 1) if is_new && substitutes => Some(ScannedParameter {
            index: 0,
            is_shape: false,
        }),
        _ => None,
    }
}

impl<'c> DerivedLaw<'c> {
    fn derive(scene: &Scene<'_>, candidate: &'c Candidate) -> Option<Self> {
        let (problem, fit) = (scene.problem, scene.fit);
        let scanned = find_scanned(candidate)?;
        let start: Vec<f64> = candidate
            .parameters
            .iter()
            .map(|parameter| parameter.neutral_value())
            .collect();
        let text = candidate
            .write_effect(&fit.texts.full, &problem.path, &start, "")
            .ok()?;
        let channels = &problem.dataset.channels;
        let model =
            EstimationModel::derive_equations(&text, &problem.path, problem.order, channels)
                .ok()?;
        let mut values = model.values.clone();
        for (name, value) in fit.model.parameters.iter().zip(&scene.motion.values) {
            model.set_value(&mut values, name, *value);
        }
        Some(Self {
            candidate,
            scanned,
            model,
            values,
        })
    }

    fn scan(&self, scene: &Scene<'_>) -> Option<ScannedLaw> {
        let parameter = &self.candidate.parameters[self.scanned.index];
        let (center, (low, high)) = match parameter.shape_size {
            Some(size) => (size, thresholds::SHAPE_SCAN_DECADES),
            None => (parameter.typical_size, thresholds::SIZE_SCAN_DECADES),
        };
        let per_decade = thresholds::SCANNED_VALUES_PER_DECADE;
        let count = ((high - low) * per_decade).round() as i32;
        let mut best: Option<Trial> = None;
        let note = |trial: Option<Trial>, best: &mut Option<Trial>| {
            if let Some(trial) = trial
                && trial.fit.rms().is_finite()
                && best.as_ref().is_none_or(|b| trial.fit.rms() < b.fit.rms())
            {
                *best = Some(trial);
            }
        };
        for k in 0..=count {
            let value = center * 10f64.powf(low + f64::from(k) / per_decade);
            note(self.try_value(scene, value), &mut best);
        }
        let mut ratio = 10f64.powf(1.0 / per_decade);
        for _ in 0..thresholds::SCAN_REFINEMENT_COUNT {
            ratio = ratio.sqrt();
            let value = best.as_ref()?.value;
            for value in [value / ratio, value * ratio] {
                note(self.try_value(scene, value), &mut best);
            }
        }
        let Trial { value, fit } = best?;
        let mut candidate = self.candidate.clone();
        let sizes = match self.scanned.is_shape {
            true => {
                candidate.parameters[self.scanned.index].shape_size = Some(value);
                fit.coefficients.clone()
            }
            false if parameter.is_inverse => vec![1.0 / value],
            false => vec![value],
        };
        Some(ScannedLaw {
            candidate,
            sizes,
            rms: fit.rms(),
        })
    }

    /// Fits the law at one value of its scanned parameter, SI; `None` if the law has no influence
    /// there or a fitted sign is wrong.
    fn try_value(&self, scene: &Scene<'_>, value: f64) -> Option<Trial> {
        let parameters = &self.candidate.parameters;
        let drive_at = |values: &[f64], factor: f64| -> Option<Drive> {
            let mut model = DrivenModel::with_added_states(&scene.fit.model, &self.model, values)?;
            let drive = average_drive(&scene.motion, &scene.base, &mut model, factor);
            is_visible(&drive).then_some(drive)
        };
        let mut values = self.values.clone();
        let name = &parameters[self.scanned.index].name;
        self.model.set_value(&mut values, name, value);
        if !self.scanned.is_shape {
            let drive = drive_at(&values, 1.0)?;
            let fit = scene.segments.fit_drives(&scene.motion, &[], Some(&drive));
            return Some(Trial { value, fit });
        }
        let sizes = (0..parameters.len()).filter(|index| *index != self.scanned.index);
        let drives = sizes.clone().map(|index| {
            let parameter = &parameters[index];
            let mut values = values.clone();
            let size = parameter.base_value() + parameter.typical_size;
            self.model.set_value(&mut values, &parameter.name, size);
            drive_at(&values, 1.0 / parameter.typical_size)
        });
        let drives: Option<Vec<Drive>> = drives.collect();
        let fit = scene.segments.fit_drives(&scene.motion, &drives?, None);
        let mut signs = sizes.zip(&fit.coefficients);
        let is_allowed = signs.all(|(index, size)| !parameters[index].is_positive || *size > 0.0);
        is_allowed.then_some(Trial { value, fit })
    }
}
