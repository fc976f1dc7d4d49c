//! Parts of the motions used for screening.

use eomgen_model_spec::edit::{self, Edit, SetParameter};

use crate::catalogue::meshes::find_play_parameters;
use crate::fit::fit_result::Fit;
use crate::fit::full_fit;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::{SpecificationTexts, edited_source};
use crate::thresholds;

/// Part of the motions used for screening.
#[derive(Clone, Copy, PartialEq)]
pub enum ExcitationWindow {
    /// Initial segments of windows, in which the motion is nearly linear in the unknowns.
    Beginnings,
    /// Whole windows, which show slow effects better.
    Whole,
    /// Whole windows of the model with all play closed. This model is linear for errors of the
    /// teeth that are much larger than their play.
    BacklashRemoved,
}

impl ExcitationWindow {
    /// Returns the fraction of each window that is used.
    pub fn window_fraction(self) -> f64 {
        match self {
            Self::Beginnings => thresholds::PRELIMINARY_FRACTION,
            Self::Whole | Self::BacklashRemoved => 1.0,
        }
    }
}

/// Fits the model with all play closed; `None` if it has no play.
pub fn fit_without_play(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<Fit> {
    let edits: Vec<Edit> = find_play_parameters(fit.model.specification())
        .into_iter()
        .map(|name| {
            Edit::SetParameter(SetParameter {
                name,
                value: 0.0,
                source: String::new(),
            })
        })
        .collect();
    if edits.is_empty() {
        return None;
    }
    let closed = |text: &str| edit::apply(&edited_source(&problem.path, text), &edits).ok();
    let texts = SpecificationTexts {
        full: closed(&fit.texts.full)?,
        linear: closed(&fit.texts.linear)?,
    };
    let theta = &fit.train.estimate.theta;
    full_fit::fit_specification(problem, texts, fit.unknowns.clone(), theta).ok()
}
