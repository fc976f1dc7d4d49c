//! Pool of screened candidates from which hypotheses are formed.

use crate::catalogue::candidate::Candidate;
use crate::ids::ResponseId;
use crate::search::context::Context;
use crate::search::screening::Screening;
use crate::thresholds;

/// Pool of screened candidates.
#[derive(Clone, Copy)]
pub struct Pool<'r> {
    /// Context of the round.
    pub context: Context<'r>,
    /// The candidates.
    pub candidates: &'r [Candidate],
    /// Screening results.
    pub screening: &'r Screening,
    /// Whether the screening used whole windows.
    pub is_whole: bool,
    /// Maximum number of preliminary fits.
    pub most: usize,
    /// Fractions of the predicted sizes from which fits begin; the best is used.
    pub parts: &'r [f64],
}

impl<'r> Pool<'r> {
    /// Creates a pool with the default start values.
    pub fn new(
        context: Context<'r>,
        candidates: &'r [Candidate],
        screening: &'r Screening,
        is_whole: bool,
    ) -> Self {
        Self {
            context,
            candidates,
            screening,
            is_whole,
            most: thresholds::MOST_PRELIMINARY_FITS,
            parts: &thresholds::INITIAL_PARTS,
        }
    }

    /// Returns the candidates with a sufficient prediction, the best first.
    pub fn ranking(&self) -> Vec<ResponseId> {
        let screening = self.screening;
        let alone = screening.predicted(&[]).cost;
        let promise =
            match alone > thresholds::MUCH_IS_LEFT * thresholds::MUCH_IS_LEFT * screening.numbers {
                true => thresholds::PROMISE_FAR,
                false => thresholds::PROMISE,
            };
        let enough = |r: &ResponseId| {
            let response = &screening.responses[*r];
            // What a nuisance gains without its prior, the others did not do within theirs.
            let is_own = response.dropped_prior.is_some()
                || response.unexplained_fraction > thresholds::UNEXPLAINED_FRACTION
                || response.decrease > thresholds::ENOUGH * alone;
            is_own && response.decrease > promise * alone
        };
        let mut ranking: Vec<ResponseId> = ResponseId::first(screening.responses.len())
            .filter(enough)
            .collect();
        let decrease = |r: &ResponseId| screening.responses[*r].decrease;
        ranking.sort_by(|a, b| decrease(b).total_cmp(&decrease(a)));
        ranking
    }

    /// Returns the candidate of a response.
    pub fn candidate(&self, response: ResponseId) -> &Candidate {
        &self.candidates[self.screening.responses[response].candidate]
    }

    /// Returns the names of the candidates of these responses.
    pub fn label(&self, responses: &[ResponseId]) -> String {
        let labels = responses.iter().map(|r| self.candidate(*r).label());
        labels.collect::<Vec<_>>().join(" and ")
    }

    /// Returns true if two candidates give a parameter the same name: one effect at two sites. The
    /// next round may add the other.
    pub fn share_a_name(&self, a: ResponseId, b: ResponseId) -> bool {
        let (a, b) = (self.candidate(a), self.candidate(b));
        let has = |name: &str| b.parameters.iter().any(|other| other.name == name);
        a.parameters.iter().any(|parameter| has(&parameter.name))
    }
}
