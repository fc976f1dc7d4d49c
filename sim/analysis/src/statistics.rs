//! Numbers that say how values are spread: moments, quantiles, and how the ranks of two go together.

/// How values are spread.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// How many values.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// The standard deviation, with `count - 1` below the root; none of one value.
    pub sd: Option<f64>,
    /// The standard error of the mean, sd/sqrt(count).
    pub standard_error: Option<f64>,
    /// The values in ascending order.
    pub sorted: Vec<f64>,
}

impl Summary {
    /// Of finite values; none where there is none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        let (low, high) = (*sorted.first()?, *sorted.last()?);
        let count = sorted.len() as f64;
        // From the lowest on, so that what they have in common takes no digits, and in parts of their whole
        // range, whose half does not overflow.
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

    /// The value below which this part of all lies, by linear interpolation between the sorted values:
    /// the seventh definition of R. J. Hyndman and Y. Fan, The American Statistician 50 (1996) 361-365.
    pub fn quantile(&self, part: f64) -> f64 {
        let place = part.clamp(0.0, 1.0) * (self.sorted.len() - 1) as f64;
        let (below, above) = (place.floor(), place.ceil());
        let at = |place: f64| self.sorted.get(place as usize).copied().unwrap_or(f64::NAN);
        let (low, high) = (at(below), at(above));
        low + (place - below) * (high - low)
    }
}

/// How the ranks of pairs go together, from -1 to 1 (Spearman's coefficient, equal values with their
/// mean rank). Pairs in which a number is not finite are left out; none where either is the same in all
/// that are left.
pub fn rank_correlation(one: &[f64], other: &[f64]) -> Option<f64> {
    let pairs = one
        .iter()
        .zip(other)
        .filter(|(a, b)| a.is_finite() && b.is_finite());
    let (one, other): (Vec<f64>, Vec<f64>) = pairs.map(|(a, b)| (*a, *b)).unzip();
    let (one, other) = (ranks(&one), ranks(&other));
    // Ranks add up to the same, whatever is equal among them.
    let middle = (one.len() as f64 + 1.0) / 2.0;
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a - middle) * (b - middle)).sum()
    };
    let size = (product(&one, &one) * product(&other, &other)).sqrt();
    (size > 0.0).then(|| (product(&one, &other) / size).clamp(-1.0, 1.0))
}

/// The rank of each value from 1 on; equal ones have the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for group in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = first as f64 + (group.len() as f64 + 1.0) / 2.0;
        for place in group {
            ranks[*place] = rank;
        }
        first += group.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_and_quantiles_are_those_by_hand() {
        let found = Summary::of(&[4.0, f64::NAN, 1.0, 3.0, 2.0]).expect("four values");
        assert_eq!((found.count, found.mean), (4, 2.5));
        // (1.5^2 + 0.5^2) 2/3 = 5/3
        assert!((found.sd.expect("four") - (5.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(
            [0.0, 0.5, 1.0].map(|part| found.quantile(part)),
            [1.0, 2.5, 4.0]
        );
        assert!((found.quantile(0.1) - 1.3).abs() < 1e-15);
        let one = Summary::of(&[7.0]).expect("one value");
        assert_eq!((one.mean, one.sd, one.quantile(0.3)), (7.0, None, 7.0));
        assert_eq!(Summary::of(&[f64::INFINITY]), None);
        let large = Summary::of(&[-1e308, 1e308]).expect("two values");
        assert!(large.mean.abs() < 1e293 && large.sd.is_some_and(f64::is_finite));
        // What all have in common takes no digits of the spread.
        let far = Summary::of(&[1e9, 1e9 + 1.0])
            .and_then(|of| of.sd)
            .expect("two values");
        assert!((far - 0.5_f64.sqrt()).abs() < 1e-12, "{far}");
    }

    #[test]
    fn ranks_go_together_whatever_the_values() {
        let x = [1.0, 2.0, 3.0, 4.0, 5.0];
        let cubes = x.map(|x: f64| x.powi(3));
        assert_eq!(rank_correlation(&x, &cubes), Some(1.0));
        assert_eq!(rank_correlation(&x, &cubes.map(|y| -y)), Some(-1.0));
        // 1 - 6 (1 + 1 + 4 + 1 + 1)/(5 * 24)
        let found = rank_correlation(&x, &[2.0, 1.0, 5.0, 3.0, 4.0]).expect("a number");
        assert!((found - 0.6).abs() < 1e-15, "{found}");
        // Ranks 1.5, 1.5, 3, 4 beside 1, 2, 3, 4: 4.5/sqrt(4.5 * 5).
        let found = rank_correlation(&[0.0, 0.0, 1.0, 2.0], &x[..4]).expect("a number");
        assert!((found - 0.9_f64.sqrt()).abs() < 1e-15, "{found}");
        assert_eq!(rank_correlation(&x, &[1.0; 5]), None);
        assert_eq!(rank_correlation(&[], &[]), None);
    }
}
