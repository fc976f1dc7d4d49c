//! Which part of motions is used while candidates are screened.

use eomgen_model_spec::edit::{self, Edit, SetParameter};
use eomgen_model_spec::source::Source;

use crate::catalogue::meshes::plays;
use crate::fit::fitted::Fit;
use crate::fit::full;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::SpecificationTexts;
use crate::thresholds;

/// Which part of motions is used while candidates are screened.
#[derive(Clone, Copy, PartialEq)]
pub enum ExcitationWindow {
    /// The beginnings of windows, where a motion is nearly linear in whatever changes it.
    Beginnings,
    /// Whole windows, which show more of what is slow.
    Whole,
    /// Whole windows of the model with all play closed: linear in what moves teeth by much more
    /// than their play, and blind for what is smaller.
    BacklashRemoved,
}

impl ExcitationWindow {
    /// The part of each window that is used.
    pub fn part(self) -> f64 {
        match self {
            Self::Beginnings => thresholds::FIRST_PART,
            Self::Whole | Self::BacklashRemoved => 1.0,
        }
    }
}

/// The model with all play closed, fitted; none if there is no play.
pub fn without_play(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<Fit> {
    let edits: Vec<Edit> = plays(fit.model.specification())
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
    let closed = |text: &str| edit::apply(&Source::new(problem.path.as_str(), text), &edits).ok();
    let texts = SpecificationTexts {
        whole: closed(&fit.texts.whole)?,
        linear: closed(&fit.texts.linear)?,
    };
    let theta = &fit.train.estimate.theta;
    full::fit(problem, texts, fit.unknowns.clone(), theta).ok()
}
