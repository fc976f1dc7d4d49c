//! Candidates with what they promise: the pool from which hypotheses are made.

use crate::catalogue::candidate::Candidate;
use crate::ids::ResponseId;
use crate::search::context::Context;
use crate::search::screening::Screening;
use crate::thresholds;

/// Candidates to be fitted.
#[derive(Clone, Copy)]
pub struct Pool<'r> {
    /// What it is about.
    pub context: Context<'r>,
    /// The candidates.
    pub candidates: &'r [Candidate],
    /// What they promise.
    pub screening: &'r Screening,
    /// Whether that was seen over whole windows.
    pub is_whole: bool,
    /// The most candidates that get a preliminary fit.
    pub most: usize,
    /// Parts of the promised sizes among which they begin with the best.
    pub parts: &'r [f64],
}

impl<'r> Pool<'r> {
    /// Candidates to be fitted, started as most are.
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

    /// Candidates that promise enough, the best first.
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

    /// The candidate of a response.
    pub fn candidate(&self, response: ResponseId) -> &Candidate {
        &self.candidates[self.screening.responses[response].candidate]
    }

    /// The names of the candidates of some responses.
    pub fn label(&self, responses: &[ResponseId]) -> String {
        let labels = responses.iter().map(|r| self.candidate(*r).label());
        labels.collect::<Vec<_>>().join(" and ")
    }

    /// Whether two candidates give a parameter the same name: one effect at two places. Of these
    /// the next round may add the other.
    pub fn share_a_name(&self, a: ResponseId, b: ResponseId) -> bool {
        let (a, b) = (self.candidate(a), self.candidate(b));
        let has = |name: &str| b.parameters.iter().any(|other| other.name == name);
        a.parameters.iter().any(|parameter| has(&parameter.name))
    }
}
