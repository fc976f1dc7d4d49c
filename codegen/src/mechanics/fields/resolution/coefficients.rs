//! Error of the quadrature rule of a field, by comparison with panels that resolve a coefficient along the field.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::evaluate::{enclose_with, evaluate, evaluate_at_time, evaluate_with};
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::interval::Interval;
use eomgen_model_spec::model::{ExprKind, Field, Model};

use super::super::contents::contents;
use super::super::modes::Shapes;
use super::super::quadrature::QuadratureRule;
use super::super::rule::FieldRule;
use super::MAX_ERROR;
use super::panels::{Panels, Profile, divide};
use super::products::{Coefficient, Product};

/// Number of combinations of all modes that are tested in addition to single modes.
const MODE_COMBINATIONS: usize = 3;

/// Largest number of shape waves per panel; with 24 nodes, quadrature of their product is exact to rounding.
const SHAPES_PER_PANEL: usize = 4;

/// Field at given parameters.
pub(super) struct CheckedField<'m> {
    model: &'m Model,
    field: &'m Field,
    parameters: &'m [f64],
    from: f64,
    length: f64,
    order: usize,
    rule: FieldRule,
}

/// Mode shapes at the nodes of a rule: for each derivative, one row for each node and one column for each mode.
struct ShapeTables<'r> {
    rule: &'r QuadratureRule,
    values: Vec<(u8, Vec<Vec<f64>>)>,
}

impl<'m> CheckedField<'m> {
    pub fn new(model: &'m Model, orders: &[usize], field: FieldId, parameters: &'m [f64]) -> Self {
        let order = orders[field.index()];
        let rule = FieldRule::new(model, field, order);
        let field = &model.fields[field];
        let from = evaluate(&field.from, parameters);
        Self {
            model,
            field,
            parameters,
            from,
            length: evaluate(&field.to, parameters) - from,
            order,
            rule,
        }
    }

    /// Checks the integrals of a product at several times if it depends on time.
    ///
    /// # Errors
    /// An error above [`MAX_ERROR`].
    pub fn check(&self, product: &Product<'_>) -> Result<(), Diagnostic> {
        if self.order == 0 && !product.shapes.is_empty() {
            return Ok(());
        }
        let mut coefficients = product.coefficients.iter();
        let has_time = coefficients.any(|c| contents(self.model, c.value).time);
        let times = match has_time {
            true => list_checked_times(),
            false => vec![0.0],
        };
        for t in times {
            let (error, narrowest) = self.error_at(product, t);
            if error > MAX_ERROR {
                return Err(self.describe_error(product, (has_time, t), error, narrowest));
            }
        }
        Ok(())
    }

    /// Returns the largest relative error over single modes and combinations of modes, and the narrowest panel.
    fn error_at(&self, product: &Product<'_>, t: f64) -> (f64, [f64; 2]) {
        let value = |s: f64| {
            let factors = product.coefficients.iter();
            factors.map(|factor| self.value(factor, t, s)).product()
        };
        let bounds = |a: f64, b: f64| {
            let factors = product.coefficients.iter();
            factors
                .map(|factor| self.bounds(factor, t, [a, b]))
                .reduce(Interval::multiply)
                .unwrap_or(Interval::ALL)
        };
        let profile = Profile {
            value: &value,
            bounds: Some(&bounds),
        };
        let knots = self.compute_panel_ends(product.shapes.len());
        let Panels { rule, narrowest } = divide(&knots, &profile);
        let shapes = Shapes::new(&self.field.basis, self.order);
        let own = self.rule.quadrature();
        let [fine, coarse] = [&rule, &own].map(|rule| {
            let mut derivatives = product.shapes.clone();
            derivatives.dedup();
            let table = |derivative: u8| {
                let nodes = rule.nodes.iter();
                nodes.map(|s| shapes.values_at(derivative, *s)).collect()
            };
            let values = derivatives.into_iter().map(|d| (d, table(d)));
            ShapeTables {
                rule,
                values: values.collect(),
            }
        });
        let [fine_values, coarse_values] =
            [&rule, &own].map(|rule| rule.nodes.iter().map(|s| value(*s)).collect::<Vec<f64>>());
        let mut worst = 0.0_f64;
        for amplitudes in self.amplitudes(product) {
            let scales = fine.find_largest_magnitudes();
            let (exact, magnitude) = fine.integral(product, &amplitudes, &scales, &fine_values);
            let (found, _) = coarse.integral(product, &amplitudes, &scales, &coarse_values);
            let difference = (found - exact).abs();
            if difference > 0.0 || difference.is_nan() {
                let error = difference / magnitude;
                worst = worst.max(if error.is_nan() { f64::INFINITY } else { error });
            }
        }
        (worst, narrowest)
    }

    /// Returns the ends of panels that resolve a product of this number of shapes.
    fn compute_panel_ends(&self, shapes: usize) -> Vec<f64> {
        let knots = self.rule.knots();
        let pieces = (shapes.max(1) * self.order)
            .div_ceil(SHAPES_PER_PANEL)
            .div_ceil(knots.len() - 1)
            .max(1);
        let inner = knots.windows(2).flat_map(|ends| {
            let [a, b] = [ends[0], ends[1]];
            (0..pieces).map(move |k| a + (b - a) * k as f64 / pieces as f64)
        });
        inner.chain([1.0]).collect()
    }

    /// Returns the tested amplitudes of the modes: single modes, and combinations of all modes.
    fn amplitudes(&self, product: &Product<'_>) -> Vec<Vec<f64>> {
        if product.shapes.is_empty() {
            return vec![Vec::new()];
        }
        let single = |mode: usize| {
            (0..self.order)
                .map(|r| f64::from(u8::from(r == mode)))
                .collect()
        };
        let numbers = std::iter::successors(Some(1), |number| Some(2 * number));
        let numbers = numbers.take_while(|number| *number < self.order);
        let mut all: Vec<Vec<f64>> = numbers.map(|number| single(number - 1)).collect();
        all.push(single(self.order - 1));
        let mut signs = 0x9e37_79b9_7f4a_7c15_u64;
        for _ in 0..MODE_COMBINATIONS {
            let combination = (0..self.order).map(|_| {
                signs = signs
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                if signs >> 63 == 0 { 1.0 } else { -1.0 }
            });
            all.push(combination.collect());
        }
        all
    }

    fn position(&self, s: f64) -> f64 {
        self.from + self.length * s
    }

    fn value(&self, factor: &Coefficient<'_>, t: f64, s: f64) -> f64 {
        let value = evaluate_with(factor.value, &|leaf| match leaf {
            ExprKind::Position(_) => self.position(s),
            other => self.constant(other, t),
        });
        if factor.is_divisor {
            1.0 / value
        } else {
            value
        }
    }

    fn bounds(&self, factor: &Coefficient<'_>, t: f64, ends: [f64; 2]) -> Interval {
        let [low, high] = ends.map(|s| self.position(s));
        let bounds = enclose_with(factor.value, &|leaf| match leaf {
            ExprKind::Position(_) => Interval::from_ends(low, high),
            other => {
                let value = self.constant(other, t);
                Interval::from_ends(value, value)
            }
        });
        match factor.is_divisor {
            true => bounds.reciprocal(),
            false => bounds,
        }
    }

    /// Returns the value of a leaf that is constant along the field.
    fn constant(&self, leaf: &ExprKind, t: f64) -> f64 {
        match leaf {
            ExprKind::Time => t,
            ExprKind::Parameter(index) => self
                .parameters
                .get(index.index())
                .copied()
                .unwrap_or(f64::NAN),
            ExprKind::Definition(index) => {
                let value = &self.model.definitions[*index].value;
                evaluate_at_time(self.model, value, self.parameters, t)
            }
            _ => f64::NAN,
        }
    }

    fn describe_error(
        &self,
        product: &Product<'_>,
        (has_time, t): (bool, f64),
        error: f64,
        narrowest: [f64; 2],
    ) -> Diagnostic {
        let when = match has_time {
            true => format!(" at t = {t:.3e} s"),
            false => String::new(),
        };
        let width = self.length * (narrowest[1] - narrowest[0]);
        let place = self.position(0.5 * (narrowest[0] + narrowest[1]));
        let message = format!(
            "the {} quadrature points of `{}` integrate this coefficient with a relative error of {error:.0e}{when}",
            self.rule.node_count(),
            self.field.name
        );
        let cause = format!(
            "it changes within {width:.1e} m at {along} = {place:.6} m: write a smooth change over a longer part of the \
             field, raise its `order` (each mode adds points), or write a switch at a fixed fraction of the length, \
             for example above({along} - {fraction:.3}*L) with the length L",
            along = self.field.along,
            fraction = 0.5 * (narrowest[0] + narrowest[1]),
        );
        let culprit = product.coefficients.iter();
        let culprit = culprit.min_by_key(|factor| factor.power().is_some());
        let diagnostic = Diagnostic::error(message).with_help(cause);
        match culprit {
            Some(factor) => diagnostic.with_span(factor.value.span, ""),
            None => diagnostic,
        }
    }
}

impl ShapeTables<'_> {
    /// Returns the largest magnitude of each mode shape for each derivative.
    fn find_largest_magnitudes(&self) -> Vec<Vec<f64>> {
        let largest = |rows: &Vec<Vec<f64>>| {
            let modes = rows.first().map_or(0, Vec::len);
            let of_mode = |r: usize| {
                rows.iter()
                    .fold(0.0_f64, |most, row| most.max(row[r].abs()))
            };
            (0..modes).map(of_mode).collect()
        };
        self.values.iter().map(|(_, rows)| largest(rows)).collect()
    }

    /// Returns the integrals of the product and of its magnitude for these mode amplitudes.
    fn integral(
        &self,
        product: &Product<'_>,
        amplitudes: &[f64],
        scales: &[Vec<f64>],
        coefficient: &[f64],
    ) -> (f64, f64) {
        let (mut sum, mut magnitude) = (0.0, 0.0);
        for (node, weight) in self.rule.weights.iter().enumerate() {
            let mut value = weight * coefficient[node];
            for ((derivative, rows), scales) in self.values.iter().zip(scales) {
                let modes = rows[node].iter().zip(scales).zip(amplitudes);
                let field: f64 = modes
                    .map(|((shape, scale), amplitude)| amplitude * shape / scale)
                    .sum();
                let times = product.shapes.iter().filter(|shape| *shape == derivative);
                value *= field.powi(times.count() as i32);
            }
            sum += value;
            magnitude += value.abs();
        }
        (sum, magnitude)
    }
}

/// Returns the times in s at which coefficients that depend on time are checked: 0, and ten times per decade over six
/// decades.
fn list_checked_times() -> Vec<f64> {
    let decades = (-30..=30).map(|k| 10.0_f64.powf(0.1 * f64::from(k)));
    std::iter::once(0.0).chain(decades).collect()
}
