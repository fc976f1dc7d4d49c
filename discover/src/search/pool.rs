//! Pool of screened candidates from which hypotheses are formed.

use crate::catalogue::candidate::Candidate;
use crate::ids::ResponseId;
use crate::search::context::RoundContext;
use crate::search::screening::Screening;
use crate::thresholds;

/// Pool of screened candidates.
#[derive(Clone, Copy)]
pub struct CandidatePool<'r> {
    /// Context of the round.
    pub context: RoundContext<'r>,
    /// The candidates.
    pub candidates: &'r [Candidate],
    /// Screening results.
    pub screening: &'r Screening,
    /// True if the screening used whole windows.
    pub uses_whole_windows: bool,
    /// Maximum number of preliminary fits.
    pub max_preliminary_fits: usize,
    /// Fractions of the predicted sizes from which fits start; the best start is used.
    pub size_fractions: &'r [f64],
    /// Maximum number of evaluations of the rates in a fit, if there is a limit.
    pub most_evaluations: Option<u64>,
}

impl<'r> CandidatePool<'r> {
    /// Creates a pool with default settings.
    pub fn new(
        context: RoundContext<'r>,
        candidates: &'r [Candidate],
        screening: &'r Screening,
        is_whole: bool,
    ) -> Self {
        Self {
            context,
            candidates,
            screening,
            uses_whole_windows: is_whole,
            max_preliminary_fits: thresholds::MAX_PRELIMINARY_FITS,
            size_fractions: &thresholds::INITIAL_SIZE_FRACTIONS,
            most_evaluations: None,
        }
    }

    /// Returns the candidates with a sufficient predicted improvement. The best is first.
    pub fn rank_responses(&self) -> Vec<ResponseId> {
        let screening = self.screening;
        let without_candidates = screening.predict(&[]).cost;
        let least = match without_candidates
            > thresholds::MIN_RMS_FAR_FROM_NOISE
                * thresholds::MIN_RMS_FAR_FROM_NOISE
                * screening.number_count
        {
            true => thresholds::MIN_PREDICTED_REDUCTION_FAR_FROM_NOISE,
            false => thresholds::MIN_PREDICTED_REDUCTION,
        };
        let enough = |r: &ResponseId| {
            let response = &screening.responses[*r];
            // Improvement of a nuisance without its prior that the other nuisances do not achieve
            // within their priors.
            let is_own = response.dropped_prior.is_some()
                || response.unexplained_fraction > thresholds::MIN_UNEXPLAINED_FRACTION
                || response.cost_decrease > thresholds::MIN_EXPLAINED_FRACTION * without_candidates;
            is_own && response.cost_decrease > least * without_candidates
        };
        let mut ranking: Vec<ResponseId> = ResponseId::first(screening.responses.len())
            .filter(enough)
            .collect();
        let decrease = |r: &ResponseId| screening.responses[*r].cost_decrease;
        ranking.sort_by(|a, b| decrease(b).total_cmp(&decrease(a)));
        ranking
    }

    /// Returns the candidate of a response.
    pub fn candidate(&self, response: ResponseId) -> &Candidate {
        &self.candidates[self.screening.responses[response].candidate]
    }

    /// Returns the names of the candidates, joined for a message.
    pub fn label(&self, responses: &[ResponseId]) -> String {
        let labels = responses.iter().map(|r| self.candidate(*r).label());
        labels.collect::<Vec<_>>().join(" and ")
    }

    /// Returns true if two candidates add a parameter of the same name, because they are one effect
    /// at two sites. The next round may add the second candidate.
    pub fn has_common_parameter_name(&self, a: ResponseId, b: ResponseId) -> bool {
        let (a, b) = (self.candidate(a), self.candidate(b));
        let has = |name: &str| b.parameters.iter().any(|other| other.name == name);
        a.parameters.iter().any(|parameter| has(&parameter.name))
    }
}
