//! Mode shapes from a table by cubic splines. The unknowns are the second derivatives M_i, not the slopes.
//!
//! Between two knots the second derivative is linear. The slope is continuous if
//!
//! ```text
//! h_i M_i + 2 (h_i + h_(i+1)) M_(i+1) + h_(i+1) M_(i+2) = 6 (chord_(i+1) - chord_i)
//! ```
//!
//! The third derivative is continuous at the first and the last inner knot.

use super::legendre::unit_rule;
use crate::double_double::DoubleDouble;
use eomgen_model_spec::shape_table::ShapeTable;

/// Minimum number of Gauss-Legendre nodes per piece. A product of two shapes has degree 6, of four degree 12. The
/// additional nodes allow for coefficients that vary along the field.
const MIN_NODES_PER_PIECE: usize = 8;

#[derive(Clone, Debug)]
pub(super) struct SplineShape {
    knots: Vec<f64>,
    values: Vec<f64>,
    curvatures: Vec<f64>,
}

impl SplineShape {
    pub fn new(table: &ShapeTable, r: usize) -> Self {
        let knots = relative_positions(table);
        let values = table.shapes.get(r - 1).cloned().unwrap_or_default();
        let curvatures = curvatures(&knots, &values);
        Self {
            knots,
            values,
            curvatures,
        }
    }

    pub fn derivative(&self, derivative: u8, s: f64) -> f64 {
        let inner = self.knots.iter().skip(1).take(self.knots.len() - 2);
        let piece = inner.take_while(|knot| **knot < s).count();
        let (left, right) = (self.knots[piece], self.knots[piece + 1]);
        let (y, next_y) = (self.values[piece], self.values[piece + 1]);
        let (m, next_m) = (self.curvatures[piece], self.curvatures[piece + 1]);
        let h = right - left;
        let (a, b) = ((right - s) / h, (s - left) / h);
        match derivative {
            0 => {
                a * y + b * next_y + h * h / 6.0 * ((a * a * a - a) * m + (b * b * b - b) * next_m)
            }
            1 => {
                (next_y - y) / h
                    + h / 6.0 * ((1.0 - 3.0 * a * a) * m + (3.0 * b * b - 1.0) * next_m)
            }
            2 => a * m + b * next_m,
            3 => (next_m - m) / h,
            _ => 0.0,
        }
    }
}

/// Returns nodes and weights of a composite rule on [0, 1]. It is exact for piecewise polynomials whose pieces end at
/// the rows of the table and at the switches.
pub(super) fn quadrature_rule(
    table: &ShapeTable,
    nodes: usize,
    power: usize,
    switches: &[f64],
) -> Vec<(DoubleDouble, f64)> {
    let pieces = table.positions.len().max(2) - 1;
    // A product of p cubic pieces has the degree 3 p.
    let exact = (3 * power + 1).div_ceil(2).max(MIN_NODES_PER_PIECE);
    let mut knots = [&relative_positions(table)[..], switches].concat();
    knots.sort_by(f64::total_cmp);
    rule_between(&knots, nodes.div_ceil(pieces).max(exact))
}

/// Returns the composite Gauss-Legendre rule with `nodes` nodes between neighbouring knots.
pub(super) fn rule_between(knots: &[f64], nodes: usize) -> Vec<(DoubleDouble, f64)> {
    let rule = unit_rule(nodes);
    knots
        .windows(2)
        .flat_map(|ends| {
            let (left, h) = (ends[0], ends[1] - ends[0]);
            let place = move |s: f64| DoubleDouble::new(left + h * s);
            rule.iter()
                .map(|node| (place(node.position.high), h * node.weight))
                .collect::<Vec<_>>()
        })
        .collect()
}

fn relative_positions(table: &ShapeTable) -> Vec<f64> {
    let first = table.positions.first().copied().unwrap_or(0.0);
    let length = table.positions.last().copied().unwrap_or(1.0) - first;
    table
        .positions
        .iter()
        .map(|x| (x - first) / length)
        .collect()
}

/// Returns the second derivatives at the knots. The end conditions (M_1 - M_0)/h_0 = (M_2 -
/// M_1)/h_1 and their mirror image are eliminated into the first and the last equation.
fn curvatures(knots: &[f64], values: &[f64]) -> Vec<f64> {
    let n = knots.len();
    if n < 4 || values.len() != n {
        return vec![f64::NAN; n];
    }
    let h: Vec<f64> = (1..n).map(|i| knots[i] - knots[i - 1]).collect();
    let chord: Vec<f64> = (1..n)
        .map(|i| (values[i] - values[i - 1]) / h[i - 1])
        .collect();
    // Unknowns M_1 .. M_(n-2).
    let count = n - 2;
    let mut below = vec![0.0; count];
    let mut diagonal = vec![0.0; count];
    let mut above = vec![0.0; count];
    let mut right = vec![0.0; count];
    for row in 0..count {
        below[row] = h[row];
        diagonal[row] = 2.0 * (h[row] + h[row + 1]);
        above[row] = h[row + 1];
        right[row] = 6.0 * (chord[row + 1] - chord[row]);
    }
    // M_0 = (1 + h_0/h_1) M_1 - h_0/h_1 M_2
    let ratio = h[0] / h[1];
    diagonal[0] += h[0] * (1.0 + ratio);
    above[0] -= h[0] * ratio;
    let ratio = h[n - 2] / h[n - 3];
    diagonal[count - 1] += h[n - 2] * (1.0 + ratio);
    below[count - 1] -= h[n - 2] * ratio;
    for row in 1..count {
        let factor = below[row] / diagonal[row - 1];
        diagonal[row] -= factor * above[row - 1];
        right[row] -= factor * right[row - 1];
    }
    let mut inner = vec![0.0; count];
    for row in (0..count).rev() {
        let beyond = inner.get(row + 1).copied().unwrap_or(0.0);
        inner[row] = (right[row] - above[row] * beyond) / diagonal[row];
    }
    let ratio = h[0] / h[1];
    let first = (1.0 + ratio) * inner[0] - ratio * inner[1];
    let ratio = h[n - 2] / h[n - 3];
    let last = (1.0 + ratio) * inner[count - 1] - ratio * inner[count - 2];
    let mut all = vec![first];
    all.extend(inner);
    all.push(last);
    all
}
