//! Moments, quantiles and rank correlations.

/// Moments and quantiles of a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Number of finite values.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation with `count - 1` in the denominator; `None` for one value.
    pub sd: Option<f64>,
    /// Standard error of the mean, sd/sqrt(count).
    pub standard_error: Option<f64>,
    /// Values in ascending order.
    pub sorted: Vec<f64>,
}

impl Summary {
    /// Summarises the finite values. Returns `None` without finite values.
    pub fn from_values(values: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (low, high) = (*sorted.first()?, *sorted.last()?);
        let count = sorted.len() as f64;
        // Values relative to the lowest value keep the digits of the spread. Division by the range, in halves,
        // avoids overflow.
        let half = if high > low {
            high / 2.0 - low / 2.0
        } else {
            1.0
        };
        let parts = || sorted.iter().map(|value| (value / 2.0 - low / 2.0) / half);
        let mean = parts().sum::<f64>() / count;
        let squares: f64 = parts().map(|part| (part - mean).powi(2)).sum();
        let sd = (sorted.len() > 1).then(|| half * (2.0 * (squares / (count - 1.0)).sqrt()));
        Some(Self {
            count: sorted.len(),
            mean: low + half * mean + half * mean,
            sd,
            standard_error: sd.map(|sd| sd / count.sqrt()),
            sorted,
        })
    }

    /// Returns the quantile for the probability `part`, by linear interpolation between the sorted values: the
    /// seventh definition of R. J. Hyndman and Y. Fan, The American Statistician 50 (1996) 361-365.
    pub fn quantile(&self, part: f64) -> f64 {
        let index = part.clamp(0.0, 1.0) * (self.sorted.len() - 1) as f64;
        let (below, above) = (index.floor(), index.ceil());
        let at = |index: f64| self.sorted.get(index as usize).copied().unwrap_or(f64::NAN);
        let (low, high) = (at(below), at(above));
        low + (index - below) * (high - low)
    }
}

/// Computes Spearman's rank correlation coefficient, from -1 to 1; equal values get the mean of their ranks.
/// Pairs with a number that is not finite are omitted. Returns `None` if either series is constant.
pub fn rank_correlation(one: &[f64], other: &[f64]) -> Option<f64> {
    let pairs = one
        .iter()
        .zip(other)
        .filter(|(a, b)| a.is_finite() && b.is_finite());
    let (one, other): (Vec<f64>, Vec<f64>) = pairs.map(|(a, b)| (*a, *b)).unzip();
    let (one, other) = (ranks(&one), ranks(&other));
    // Equal values do not change the sum of the ranks.
    let middle = (one.len() as f64 + 1.0) / 2.0;
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a - middle) * (b - middle)).sum()
    };
    let size = (product(&one, &one) * product(&other, &other)).sqrt();
    (size > 0.0).then(|| (product(&one, &other) / size).clamp(-1.0, 1.0))
}

/// Returns the rank of each value, from 1 on; equal values get the mean of their ranks.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for group in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = first as f64 + (group.len() as f64 + 1.0) / 2.0;
        for index in group {
            ranks[*index] = rank;
        }
        first += group.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_and_quantiles_match_hand_calculation() {
        let found = Summary::from_values(&[4.0, f64::NAN, 1.0, 3.0, 2.0]).expect("four values");
        assert_eq!((found.count, found.mean), (4, 2.5));
        // (1.5^2 + 0.5^2) 2/3 = 5/3
        assert!((found.sd.expect("four") - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(
            [0.0, 0.5, 1.0].map(|part| found.quantile(part)),
            [1.0, 2.5, 4.0]
        );
        assert!((found.quantile(0.1) - 1.3).abs() < 1e-15);
        let one = Summary::from_values(&[7.0]).expect("one value");
        assert_eq!((one.mean, one.sd, one.quantile(0.3)), (7.0, None, 7.0));
        assert_eq!(Summary::from_values(&[f64::INFINITY]), None);
        let large = Summary::from_values(&[-1e308, 1e308]).expect("two values");
        assert!(large.mean.abs() < 1e293 && large.sd.is_some_and(f64::is_finite));
        // A common offset does not reduce the precision of the spread.
        let far = Summary::from_values(&[1e9, 1e9 + 1.0])
            .and_then(|of| of.sd)
            .expect("two values");
        assert!((far - 0.5_f64.sqrt()).abs() < 1e-12, "{far}");
    }

    #[test]
    fn rank_correlation_ignores_monotonic_maps() {
        let x = [1.0, 2.0, 3.0, 4.0, 5.0];
        let cubes = x.map(|x: f64| x.powi(3));
        assert_eq!(rank_correlation(&x, &cubes), Some(1.0));
        assert_eq!(rank_correlation(&x, &cubes.map(|y| -y)), Some(-1.0));
        // 1 - 6 (1 + 1 + 4 + 1 + 1)/(5 * 24)
        let found = rank_correlation(&x, &[2.0, 1.0, 5.0, 3.0, 4.0]).expect("a number");
        assert!((found - 0.6).abs() < 1e-15, "{found}");
        // Ranks 1.5, 1.5, 3, 4 against 1, 2, 3, 4: 4.5/sqrt(4.5 * 5).
        let found = rank_correlation(&[0.0, 0.0, 1.0, 2.0], &x[..4]).expect("a number");
        assert!((found - 0.9_f64.sqrt()).abs() < 1e-15, "{found}");
        assert_eq!(rank_correlation(&x, &[1.0; 5]), None);
        assert_eq!(rank_correlation(&[], &[]), None);
    }
}
