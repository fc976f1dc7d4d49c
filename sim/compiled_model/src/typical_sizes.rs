//! Typical sizes of states, from their units. The parameters, initial values and ranges of a model determine the size
//! of each base unit, by a least-squares fit of the logarithms of their values. These are linear in the logarithms of
//! the base units. A change of units scales all sizes alike, so solvers that compare states with these sizes take the
//! same steps.

use eomgen_analysis::qr_iteration;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::Model;
use nalgebra::{DMatrix, DVector};

const BASE_UNITS: usize = 7;

/// Singular values below this fraction of the largest count as 0; the corresponding combination of units is
/// undetermined.
const MIN_SINGULAR_VALUE_FRACTION: f64 = 1e-9;

/// Largest exponent of 2, so that squares of sizes remain finite.
const LARGEST_EXPONENT: f64 = 400.0;

/// Sizes of the base units as logarithms to base 2; 0 for a unit that no value determines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TypicalSizes([f64; BASE_UNITS]);

impl TypicalSizes {
    /// Fits the sizes to the values of a model with the given orders of its fields.
    pub fn new(model: &Model, orders: &[usize]) -> Self {
        Self(fit_base_units(&known_values(model, orders)))
    }

    /// Returns the typical size of a quantity, SI, a power of two.
    pub fn typical_size(&self, dimension: Dimension) -> f64 {
        let terms = exponents(dimension).into_iter().zip(self.0);
        let exponent: f64 = terms.map(|(exponent, unit)| exponent * unit).sum();
        let exponent = exponent.clamp(-LARGEST_EXPONENT, LARGEST_EXPONENT);
        exponent.round().exp2()
    }
}

pub(crate) fn compute_typical_sizes(model: &Model, orders: &[usize]) -> Vec<f64> {
    let sizes = TypicalSizes::new(model, orders);
    let states = model.state_units(orders).into_iter();
    states
        .map(|unit| sizes.typical_size(unit.dimension))
        .collect()
}

fn known_values(model: &Model, orders: &[usize]) -> Vec<(f64, Dimension)> {
    let parameters = model
        .parameters
        .iter()
        .map(|parameter| parameter.unit.dimension);
    let parameters = model
        .parameter_values()
        .unwrap_or_default()
        .into_iter()
        .zip(parameters);
    let initial = model.initial_state(orders).unwrap_or_default();
    let units = model.state_units(orders);
    let initial = initial
        .into_iter()
        .zip(units.iter().map(|unit| unit.dimension));
    let ranges = model.coordinate_ranges().unwrap_or_default();
    let ranges = ranges.into_iter().zip(&model.coordinates);
    let ranges = ranges.filter_map(|(range, coordinate)| {
        let (low, high) = range?;
        Some((low.abs().max(high.abs()), coordinate.unit.dimension))
    });
    let all = parameters.chain(initial).chain(ranges);
    all.filter(|(value, _)| *value != 0.0 && value.is_finite())
        .collect()
}

fn fit_base_units(values: &[(f64, Dimension)]) -> [f64; BASE_UNITS] {
    let exponents = values
        .iter()
        .flat_map(|(_, dimension)| exponents(*dimension));
    let matrix = DMatrix::from_row_iterator(values.len(), BASE_UNITS, exponents);
    let logarithms = values.iter().map(|(value, _)| value.abs().log2());
    let logarithms = DVector::from_iterator(values.len(), logarithms);
    let largest = matrix
        .iter()
        .fold(0.0_f64, |most, entry| most.max(entry.abs()));
    let solved = (largest > 0.0)
        .then(|| qr_iteration::svd(&matrix))
        .flatten()
        .and_then(|svd| {
            svd.solve(&logarithms, MIN_SINGULAR_VALUE_FRACTION * largest)
                .ok()
        });
    let mut units = [0.0; BASE_UNITS];
    if let Some(solved) = solved {
        units
            .iter_mut()
            .zip(&solved)
            .for_each(|(unit, size)| *unit = *size);
    }
    units
}

fn exponents(dimension: Dimension) -> [f64; BASE_UNITS] {
    let exponents = dimension.exponents();
    exponents.map(|exponent| *exponent.numer() as f64 / *exponent.denom() as f64)
}

#[cfg(test)]
mod tests {
    use eomgen_model_spec::source::Source;

    use super::compute_typical_sizes;

    /// Returns the sizes for a mass on a spring with a stop; lengths and masses are scaled by powers of two.
    fn sizes(length: i32, mass: i32) -> Vec<f64> {
        let (length, mass) = (2f64.powi(length), 2f64.powi(mass));
        let text = format!(
            r#"[model]
name = "mass"
[parameters]
m = {{ value = {:e}, unit = "kg" }}
k = {{ value = {:e}, unit = "N/m" }}
b = {{ value = {:e}, unit = "m" }}
[coordinates]
x = {{ unit = "m" }}
phi = {{ unit = "rad" }}
[states]
F = {{ unit = "N", rate = "k*dot(x)" }}
[kinetic]
mass = "1/2*m*dot(x)^2 + 1/2*m*b^2*dot(phi)^2"
[potential]
stop = "1/2*k*deadzone(x, b)^2"
"#,
            2.0 * mass,
            800.0 * mass,
            2e-3 * length,
        );
        let source = Source::new("mass.toml", text);
        let model = eomgen_model_spec::check(source).expect("a model").model;
        compute_typical_sizes(&model, &[])
    }

    #[test]
    fn sizes_scale_exactly_with_units() {
        let own = sizes(0, 0);
        for (length, mass) in [(-17, -20), (17, 20), (-20, 20), (40, -40)] {
            let [l, m] = [length, mass].map(|power| 2f64.powi(power));
            let expected = [own[0] * l, own[1], own[2] * l, own[3], own[4] * m * l];
            assert_eq!(sizes(length, mass), expected, "{length} {mass}");
        }
    }

    #[test]
    fn sizes_match_magnitudes_of_parameters() {
        let [x, phi, x_dot, phi_dot, force] = sizes(0, 0)[..] else {
            panic!("five states");
        };
        assert!((1e-3..4e-3).contains(&x) && phi == 1.0, "{x} {phi}");
        assert!((10.0..40.0).contains(&phi_dot), "{phi_dot}");
        assert!((0.02..0.08).contains(&x_dot), "{x_dot}");
        assert!((0.5..4.0).contains(&force), "{force}");
    }
}
