//! Gauss-Legendre nodes and weights on [0, 1], by Newton's method on the Legendre recurrence.

use eomgen_elementary::Function;

/// Quadrature rule on [0, 1].
#[derive(Clone, Debug, PartialEq)]
pub struct QuadratureRule {
    /// Nodes, ascending.
    pub nodes: Vec<f64>,
    /// Weight of each node.
    pub weights: Vec<f64>,
}

/// Computes the n-point Gauss-Legendre rule, exact for polynomials up to degree 2 n - 1.
pub fn gauss_legendre(n: usize) -> QuadratureRule {
    let mut nodes = vec![0.0; n];
    let mut weights = vec![0.0; n];
    for k in 0..n.div_ceil(2) {
        let guess = std::f64::consts::PI * (k as f64 + 0.75) / (n as f64 + 0.5);
        let mut x = Function::Cos.apply(&[guess]);
        for _ in 0..100 {
            let (value, slope) = evaluate_legendre(n, x);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        let (_, slope) = evaluate_legendre(n, x);
        let weight = 1.0 / ((1.0 - x * x) * slope * slope);
        nodes[k] = 0.5 * (1.0 - x);
        nodes[n - 1 - k] = 0.5 * (1.0 + x);
        weights[k] = weight;
        weights[n - 1 - k] = weight;
    }
    QuadratureRule { nodes, weights }
}

/// Applies the n-point rule between adjacent knots.
pub fn build_composite_rule(knots: &[f64], n: usize) -> QuadratureRule {
    let rule = gauss_legendre(n);
    let pieces = knots.windows(2).map(|ends| (ends[0], ends[1] - ends[0]));
    let (nodes, weights) = pieces
        .flat_map(|(left, h)| {
            let own = rule.nodes.iter().zip(&rule.weights);
            own.map(move |(s, weight)| (left + h * s, h * weight))
        })
        .unzip();
    QuadratureRule { nodes, weights }
}

/// Returns P_n(x) and its derivative; the derivative is not finite at -1 and 1.
pub(super) fn evaluate_legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        let next = ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k;
        previous = current;
        current = next;
    }
    let slope = n as f64 * (x * current - previous) / (x * x - 1.0);
    (current, slope)
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::{QuadratureRule, gauss_legendre};

    #[test]
    fn gauss_legendre_integrates_degree_2n_minus_1_exactly() {
        let QuadratureRule { nodes, weights } = gauss_legendre(12);
        for degree in 0..24 {
            let integral: f64 = nodes
                .iter()
                .zip(&weights)
                .map(|(x, w)| w * x.powi(degree))
                .sum();
            let exact = 1.0 / f64::from(degree + 1);
            // The tolerance is the rounding error of a dozen products of rounded nodes.
            assert_abs_diff_eq!(integral, exact, epsilon = 1e-15);
        }
    }

    #[test]
    fn weights_of_a_large_rule_sum_to_one() {
        let rule = gauss_legendre(288);
        let total: f64 = rule.weights.iter().sum();
        // The tolerance is the rounding error of a sum of 288 weights.
        assert_abs_diff_eq!(total, 1.0, epsilon = 1e-13);
    }
}
