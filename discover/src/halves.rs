//! Others in the place of one of a pair's two effects: what looks like it, and was not paired
//! with the other because a straight line promised more of something else.

use crate::rule;
use crate::trials::{Round, Set, Trial};

impl Round<'_> {
    /// Pairs that share one half with a pair and whose other half looks like its other, if they
    /// were not fitted yet; the most alike first, at most [`rule::FITS_AT_ONCE`].
    pub fn other_halves(&self, trials: &[Trial], pair: usize) -> Vec<Trial> {
        let [a, b] = trials[pair].responses[..] else {
            return Vec::new();
        };
        let mut found: Vec<(f64, Vec<usize>)> = Vec::new();
        for (kept, other) in [(a, b), (b, a)] {
            for response in 0..self.screen.responses.len() {
                let is_new = ![kept, other].contains(&response)
                    && !self.share_a_name(kept, response)
                    && self.candidate(response).order.is_none();
                let is_seen = self.screen.responses[response].visible > rule::OWN_PART;
                let similarity = match is_new && is_seen {
                    true => self.screen.similarity(other, response),
                    false => 0.0,
                };
                let pair = vec![kept, response];
                let is_known = |trial: &Trial| {
                    trial.responses.len() == 2 && pair.iter().all(|r| trial.responses.contains(r))
                };
                if similarity > rule::ALIKE && !trials.iter().any(is_known) {
                    found.push((similarity, pair));
                }
            }
        }
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.truncate(rule::FITS_AT_ONCE);
        let set = |(_, responses): (f64, Vec<usize>)| Set {
            sizes: self.screen.left(&responses).1,
            responses,
            deleted: None,
        };
        self.completed(self.sketched(found.into_iter().map(set).collect()))
    }
}
