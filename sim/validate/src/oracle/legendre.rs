//! Gauss-Legendre rule on the unit interval, by Newton's method in double-double arithmetic. Mode 64 multiplies an
//! error of a node by 200 in the phase. With `f64` nodes, the first moment of this mode (5e-5 of its amplitude) would
//! have a relative error of 1e-11.

use crate::double_double::DoubleDouble;

#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Position s, 0 < s < 1.
    pub position: DoubleDouble,
    pub weight: f64,
}

/// Returns the rule with `count` nodes in increasing order, exact up to degree `2 count - 1`.
pub(super) fn unit_rule(count: usize) -> Vec<Node> {
    (0..count).map(|index| unit_node(count, index)).collect()
}

/// Returns node `index` of `count`. Newton's method in `f64` starts from Tricomi's approximation and converges to
/// rounding; each of two double-double steps squares the error.
fn unit_node(count: usize, index: usize) -> Node {
    let n = count as f64;
    let angle = std::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5);
    let mut x = -(1.0 - (n - 1.0) / (8.0 * n.powi(3))) * angle.cos();
    for _ in 0..8 {
        let (value, previous) = legendre(count, x);
        x -= value * (x * x - 1.0) / (n * (x * value - previous));
    }
    let mut node = DoubleDouble::new(x);
    for _ in 0..2 {
        let (value, slope) = precise_legendre(count, node);
        node = node - value.quotient(slope);
    }
    let (_, slope) = precise_legendre(count, node);
    let one = DoubleDouble::new(1.0);
    let weight = one.quotient((one - node * node) * slope * slope);
    Node {
        position: (one + node) * DoubleDouble::new(0.5),
        weight: weight.high,
    }
}

/// Returns P_n and P_(n-1) at x by the three-term recurrence.
fn legendre(count: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut value) = (1.0, x);
    for k in 2..=count {
        let k = k as f64;
        let next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * previous) / k;
        (previous, value) = (value, next);
    }
    (value, previous)
}

fn precise_legendre(count: usize, x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let one = DoubleDouble::new(1.0);
    let (mut previous, mut value) = (one, x);
    for k in 2..=count {
        let k = k as f64;
        let next = (DoubleDouble::new(2.0 * k - 1.0) * x * value
            - DoubleDouble::new(k - 1.0) * previous)
            .quotient(DoubleDouble::new(k));
        (previous, value) = (value, next);
    }
    let slope = (DoubleDouble::new(count as f64) * (x * value - previous)).quotient(x * x - one);
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rule_is_exact_up_to_its_degree() {
        for count in [2, 7, 40, 296] {
            let rule = unit_rule(count);
            for degree in [0, 1, 2, count, 2 * count - 1] {
                let sum: f64 = rule
                    .iter()
                    .map(|node| node.weight * node.position.high.powi(degree as i32))
                    .sum();
                let exact = 1.0 / (degree as f64 + 1.0);
                // The rounding error of powi is up to `degree` times 1e-16.
                let tolerance = 2e-16 * (degree as f64 + 4.0);
                assert!(
                    (sum / exact - 1.0).abs() < tolerance,
                    "{count} nodes, degree {degree}: found {sum}, expected {exact}"
                );
            }
        }
    }

    #[test]
    fn rule_is_not_exact_above_its_degree() {
        let sum: f64 = unit_rule(2)
            .iter()
            .map(|node| node.weight * node.position.high.powi(4))
            .sum();
        assert!((sum - 0.2).abs() > 1e-3);
    }
}
