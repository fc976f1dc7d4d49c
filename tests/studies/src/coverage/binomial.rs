//! Exact tail probabilities of the binomial distribution.

/// Returns the probability of at most `held` successes in `count` trials of probability `p`.
pub fn at_most(held: usize, count: usize, p: f64) -> f64 {
    (0..=held).map(|k| probability(k, count, p)).sum()
}

/// Returns the probability of at least `held` successes in `count` trials of probability `p`.
pub fn at_least(held: usize, count: usize, p: f64) -> f64 {
    (held..=count).map(|k| probability(k, count, p)).sum()
}

fn probability(k: usize, count: usize, p: f64) -> f64 {
    let choices = (1..=k).map(|i| ((count - k + i) as f64 / i as f64).ln());
    let logarithm = choices.sum::<f64>() + k as f64 * p.ln() + (count - k) as f64 * (1.0 - p).ln();
    logarithm.exp()
}

#[cfg(test)]
mod tests {
    use super::{at_least, at_most};

    #[test]
    fn tails_of_two_trials_are_exact() {
        assert!((at_most(0, 2, 0.25) - 0.5625).abs() < 1e-12);
        assert!((at_most(1, 2, 0.25) - 0.9375).abs() < 1e-12);
        assert!((at_least(1, 2, 0.25) - 0.4375).abs() < 1e-12);
        assert!((at_least(0, 2, 0.25) - 1.0).abs() < 1e-12);
    }
}
