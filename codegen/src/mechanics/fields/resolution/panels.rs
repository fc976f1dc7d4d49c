//! Division of [0, 1] into panels in which a function equals a polynomial up to rounding.

use eomgen_model_spec::interval::Interval;

use super::super::quadrature::{QuadratureRule, evaluate_legendre, gauss_legendre};

/// Number of quadrature nodes per panel.
const NODES_PER_PANEL: usize = 24;

/// Number of highest Legendre coefficients that must be zero up to rounding.
const TAIL_COEFFICIENTS: usize = 4;

/// Largest Legendre coefficient that counts as zero, relative to the largest magnitude of the function.
const MAX_RELATIVE_TAIL: f64 = 1e-13;

/// Largest fraction of the integral that a panel may miss between its nodes.
const MAX_MISSED_FRACTION: f64 = 1e-11;

/// Largest accepted ratio of the interval bounds to the range of the sampled values in a panel.
const MAX_BOUNDS_RATIO: f64 = 4.0;

/// Width of the shortest panel, relative to the domain. A jump inside it changes integrals by less than this
/// fraction.
const MIN_PANEL_WIDTH: f64 = 1e-14;

/// Number of panels from which interval bounds are no longer used, because they are too wide for this function.
const MAX_PANELS_WITH_BOUNDS: usize = 4000;

/// Quadrature rule over all panels, and the narrowest panel.
pub(super) struct Panels {
    pub rule: QuadratureRule,
    /// Start and end of the narrowest panel.
    pub narrowest: [f64; 2],
}

/// Function on [0, 1], with an optional function that bounds its values between two positions.
pub(super) struct Profile<'f> {
    pub value: &'f dyn Fn(f64) -> f64,
    pub bounds: Option<&'f dyn Fn(f64, f64) -> Interval>,
}

/// Properties of the sampled function in a panel.
struct Samples {
    /// Largest magnitude of the last Legendre coefficients.
    tail: f64,
    low: f64,
    high: f64,
    /// Mean magnitude.
    mean: f64,
}

/// Divides [0, 1] at the knots, and between them until the function is resolved.
pub(super) fn divide(knots: &[f64], function: &Profile<'_>) -> Panels {
    let rule = gauss_legendre(NODES_PER_PANEL);
    let tails = compute_legendre_tails(&rule);
    let sample = |[a, b]: [f64; 2]| sample(&rule, &tails, function.value, [a, b]);
    let mut waiting: Vec<[f64; 2]> = knots.windows(2).map(|ends| [ends[0], ends[1]]).collect();
    let (mut total, mut greatest) = (0.0, 0.0_f64);
    for panel in &waiting {
        let samples = sample(*panel);
        total += samples.mean * (panel[1] - panel[0]);
        greatest = greatest.max(samples.low.abs()).max(samples.high.abs());
    }
    let mut ends: Vec<[f64; 2]> = Vec::new();
    while let Some(panel) = waiting.pop() {
        let samples = sample(panel);
        let width = panel[1] - panel[0];
        let bounds = match ends.len() + waiting.len() < MAX_PANELS_WITH_BOUNDS {
            true => function.bounds.map(|bounds| bounds(panel[0], panel[1])),
            false => None,
        };
        greatest = greatest.max(samples.low.abs()).max(samples.high.abs());
        let is_smooth = samples.tail <= MAX_RELATIVE_TAIL * greatest
            || samples.tail * width <= MAX_RELATIVE_TAIL * total;
        let range = samples.high - samples.low;
        let is_bounded = bounds.is_none_or(|bounds| {
            let excess = (bounds.high - bounds.low) - MAX_BOUNDS_RATIO * range;
            excess * width <= MAX_MISSED_FRACTION * total
        });
        match (is_smooth && is_bounded)
            || width <= MIN_PANEL_WIDTH
            || ends.len() > 4 * MAX_PANELS_WITH_BOUNDS
        {
            true => ends.push(panel),
            false => {
                let middle = 0.5 * (panel[0] + panel[1]);
                waiting.extend([[middle, panel[1]], [panel[0], middle]]);
            }
        }
    }
    let width = |panel: &[f64; 2]| panel[1] - panel[0];
    let narrowest = ends
        .iter()
        .min_by(|one, other| width(one).total_cmp(&width(other)));
    let (nodes, weights) = ends
        .iter()
        .flat_map(|[a, b]| {
            let own = rule.nodes.iter().zip(&rule.weights);
            own.map(move |(s, weight)| (a + (b - a) * s, (b - a) * weight))
        })
        .unzip();
    Panels {
        narrowest: narrowest.copied().unwrap_or([0.0, 1.0]),
        rule: QuadratureRule { nodes, weights },
    }
}

fn sample(
    rule: &QuadratureRule,
    tails: &[Vec<f64>],
    value: &dyn Fn(f64) -> f64,
    [a, b]: [f64; 2],
) -> Samples {
    let values: Vec<f64> = rule.nodes.iter().map(|s| value(a + (b - a) * s)).collect();
    let weighted = |factors: &[f64]| -> f64 {
        factors
            .iter()
            .zip(&values)
            .map(|(factor, value)| factor * value)
            .sum()
    };
    let tails = tails.iter().map(|factors| weighted(factors).abs());
    let magnitudes = rule.weights.iter().zip(&values);
    Samples {
        tail: tails.fold(0.0, f64::max),
        low: values.iter().copied().fold(f64::INFINITY, f64::min),
        high: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        mean: magnitudes.map(|(weight, value)| weight * value.abs()).sum(),
    }
}

/// Returns, for each of the last Legendre coefficients, the factors of the values at the nodes.
fn compute_legendre_tails(rule: &QuadratureRule) -> Vec<Vec<f64>> {
    let last = NODES_PER_PANEL - TAIL_COEFFICIENTS..NODES_PER_PANEL;
    last.map(|degree| {
        let nodes = rule.nodes.iter().zip(&rule.weights);
        nodes
            .map(|(s, weight)| {
                (2 * degree + 1) as f64 * weight * evaluate_legendre(degree, 2.0 * s - 1.0).0
            })
            .collect()
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use eomgen_model_spec::function::{Function, call};

    use super::*;

    fn integral(value: &dyn Fn(f64) -> f64, bounds: &dyn Fn(f64, f64) -> Interval) -> f64 {
        let bounds = Some(bounds);
        let rule = divide(&[0.0, 1.0], &Profile { value, bounds }).rule;
        let nodes = rule.nodes.iter().zip(&rule.weights);
        nodes.map(|(s, weight)| weight * value(*s)).sum()
    }

    #[test]
    fn panels_detect_step_of_width_1e_6_between_nodes() {
        let position = 0.287_345_6;
        let value = |s: f64| {
            call(Function::Above, s - position, f64::NAN)
                * call(Function::Above, position + 1e-6 - s, f64::NAN)
        };
        let above = |low, high| {
            let argument = Interval::from_ends(low, high);
            Interval::apply_function(Function::Above, &[argument])
        };
        let bounds = |a: f64, b: f64| {
            above(a - position, b - position)
                .multiply(above(position + 1e-6 - b, position + 1e-6 - a))
        };
        let found = integral(&value, &bounds);
        assert!((found - 1e-6).abs() < 1e-13, "{found}");
    }

    #[test]
    fn panels_resolve_a_root_at_the_end() {
        let found = integral(&|s| s.powf(0.3), &|a, b| {
            Interval::from_ends(a.powf(0.3), b.powf(0.3))
        });
        assert!((found - 1.0 / 1.3).abs() < 1e-13, "{found}");
    }
}
