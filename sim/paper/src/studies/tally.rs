//! Counts of a search: shares of the verdicts on each claim, number of claims that hold at once, exclusive pairs.

use super::claims::CLAIMS;
use super::search::JudgedSet;

/// Shares of the verdicts on one claim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Share of the parameter sets in which the claim holds.
    pub holds: f64,
    /// Share of the parameter sets in which the claim fails.
    pub fails: f64,
    /// Share of the parameter sets in which the claim is undecided.
    pub undecided_share: f64,
    /// Share of the parameter sets in which the claim holds in the strict reading.
    pub holds_strictly: f64,
}

/// Returns the shares of all claims, in the order of [`CLAIMS`].
pub fn shares(judged: &[JudgedSet]) -> Vec<Share> {
    let count = judged.len().max(1) as f64;
    let share = |verdicts: fn(&JudgedSet) -> &[char], claim: usize, letter: char| {
        let has_letter = |set: &&JudgedSet| verdicts(set).get(claim) == Some(&letter);
        judged.iter().filter(has_letter).count() as f64 / count
    };
    let generous: fn(&JudgedSet) -> &[char] = |set| &set.verdicts;
    (0..CLAIMS.len())
        .map(|claim| Share {
            holds: share(generous, claim, 'H'),
            fails: share(generous, claim, 'F'),
            undecided_share: share(generous, claim, 'U'),
            holds_strictly: share(|set| &set.strict, claim, 'H'),
        })
        .collect()
}

/// Returns the share of undecided verdicts.
pub fn undecided(judged: &[JudgedSet]) -> f64 {
    let shares = shares(judged);
    let sum: f64 = shares.iter().map(|share| share.undecided_share).sum();
    sum / shares.len().max(1) as f64
}

/// Returns the number of sets with 0, 1, 2, ... claims that hold.
pub fn histogram(judged: &[JudgedSet]) -> Vec<usize> {
    let mut counts = vec![0; CLAIMS.len() + 1];
    for set in judged {
        if let Some(count) = counts.get_mut(set.holding_claims()) {
            *count += 1;
        }
    }
    counts
}

/// Returns pairs of claims that each hold in some set but never hold together.
pub fn find_exclusive_pairs(judged: &[JudgedSet]) -> Vec<(usize, usize)> {
    let holds = |set: &JudgedSet, claim: usize| set.verdicts.get(claim) == Some(&'H');
    let somewhere: Vec<usize> = (0..CLAIMS.len())
        .filter(|claim| judged.iter().any(|set| holds(set, *claim)))
        .collect();
    let mut pairs = Vec::new();
    for (index, &one) in somewhere.iter().enumerate() {
        for &other in somewhere.iter().skip(index + 1) {
            if !judged
                .iter()
                .any(|set| holds(set, one) && holds(set, other))
            {
                pairs.push((one, other));
            }
        }
    }
    pairs
}

/// Returns the share of the sets in which at least `holding` claims hold.
pub fn share_with(judged: &[JudgedSet], holding: usize) -> f64 {
    let found = judged
        .iter()
        .filter(|set| set.holding_claims() >= holding)
        .count();
    found as f64 / judged.len().max(1) as f64
}
