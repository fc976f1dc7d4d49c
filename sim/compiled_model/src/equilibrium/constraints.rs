//! Holonomic constraints of an equilibrium search, which all its points satisfy.

use eomgen_analysis::allowed_motions::{AllowedMotions, row_by_row};
use eomgen_analysis::qr_iteration;
use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_model_spec::model::MULTIPLIER;
use nalgebra::{DMatrix, DVector};

use crate::instance::Instance;
use crate::operating_point::{OperatingPoint, Setting};

use super::linear::LinearisedConstraints;
use super::unknown::Unknown;

/// Maximum number of corrections of a point.
const MAX_CORRECTIONS: usize = 20;

/// A correction below this fraction of the size of its unknown is the last one of Newton's method; the remaining error
/// is rounding.
const LAST_CORRECTION_FRACTION: f64 = 1e-9;

/// Singular values below this fraction of the largest count as 0.
const MIN_SINGULAR_VALUE_FRACTION: f64 = 1e-9;

/// Holonomic constraints and their derivatives with respect to the unknowns of a search.
pub(super) struct HolonomicConstraints {
    rows: ConstraintRows,
    /// Indices of the holonomic constraints among all constraints.
    places: Vec<usize>,
    /// Indices of the multipliers of these constraints among the observables.
    multipliers: Vec<usize>,
    /// State of each unknown; `None` for unknowns that the constraints do not contain.
    columns: Vec<Option<usize>>,
    /// Typical size of each coordinate and mode, SI.
    sizes: Vec<f64>,
}

impl HolonomicConstraints {
    /// Returns the constraints of a model as functions of the given unknowns; `None` without constraints.
    pub fn new(instance: &Instance<'_>, unknowns: &[Unknown]) -> Option<Self> {
        let rows = instance.constraint_rows()?;
        let constraints = instance.model().model().constraints.iter().enumerate();
        let places: Vec<usize> = constraints
            .filter(|(_, constraint)| !constraint.is_nonholonomic)
            .map(|(place, _)| place)
            .collect();
        let degrees = rows.degrees_of_freedom();
        let columns: Vec<Option<usize>> = unknowns
            .iter()
            .map(|unknown| match unknown {
                Unknown::Setting(Setting::State(place)) if *place < degrees => Some(*place),
                _ => None,
            })
            .collect();
        let names = instance.model().observable_names();
        let multipliers = places.iter().filter_map(|place| {
            let constraint = &instance.model().model().constraints[*place].name;
            let multiplier = format!("{MULTIPLIER}{constraint}");
            names.iter().position(|name| *name == multiplier)
        });
        let multipliers = multipliers.collect();
        let typical = instance.model().typical_sizes();
        (!places.is_empty()).then(|| Self {
            rows,
            multipliers,
            places,
            columns,
            sizes: typical[..degrees].to_vec(),
        })
    }

    /// Linearises the constraints at a point. The evaluator of the model gives their multipliers. Returns `None` if a
    /// number is not finite.
    pub fn linearise(
        &mut self,
        at: &OperatingPoint,
        evaluator: &mut Evaluator,
    ) -> Option<LinearisedConstraints> {
        let degrees = self.rows.degrees_of_freedom();
        let derivatives = self.compute_derivatives(at);
        let mut scaled = derivatives.clone();
        for (mut column, size) in scaled.column_iter_mut().zip(&self.sizes) {
            column *= *size;
        }
        let allowed = AllowedMotions::new(&row_by_row(&scaled), &vec![1.0; degrees]).ok()?;
        let mut displacements = allowed.basis().clone();
        for (mut row, size) in displacements.row_iter_mut().zip(&self.sizes) {
            row *= *size;
        }
        let mass = self.rows.mass_matrix(at.point());
        let mass = DMatrix::from_row_slice(degrees, degrees, &mass);
        let mut observables = vec![0.0; evaluator.program().observables.len()];
        evaluator.observables(at.point(), &mut observables);
        let mut accelerations = mass.clone().cholesky()?.solve(&derivatives.transpose());
        for (mut column, multiplier) in accelerations.column_iter_mut().zip(&self.multipliers) {
            column *= observables[*multiplier];
        }
        Some(LinearisedConstraints {
            by_unknowns: self.differentiate_by_unknowns(&derivatives),
            largest_accelerations: DVector::from_iterator(
                degrees,
                accelerations.row_iter().map(|row| row.amax()),
            ),
            mass,
            displacements,
        })
    }

    /// Returns the derivatives of the constraints with respect to the coordinates and modes at a point, SI.
    fn compute_derivatives(&mut self, at: &OperatingPoint) -> DMatrix<f64> {
        let all = self.rows.derivatives(at.point());
        let degrees = self.rows.degrees_of_freedom();
        DMatrix::from_fn(self.places.len(), degrees, |row, column| {
            all[self.places[row]][column]
        })
    }

    fn differentiate_by_unknowns(&self, derivatives: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(self.places.len(), self.columns.len(), |row, column| {
            self.columns[column].map_or(0.0, |place| derivatives[(row, place)])
        })
    }

    /// Projects a point onto the constraints by the smallest changes of the unknowns, relative to their typical sizes.
    /// Returns false if the projection fails.
    pub fn project(&mut self, at: &mut OperatingPoint) -> bool {
        for _ in 0..MAX_CORRECTIONS {
            let residuals = self.rows.residuals(at.point());
            let derivatives = self.compute_derivatives(at);
            let mut matrix = self.differentiate_by_unknowns(&derivatives);
            let mut wanted = DVector::zeros(self.places.len());
            for (row, place) in self.places.iter().enumerate() {
                for (column, place) in self.columns.iter().enumerate() {
                    matrix[(row, column)] *= place.map_or(1.0, |place| self.sizes[place]);
                }
                let largest = matrix.row(row).amax();
                let largest = if largest > 0.0 { largest } else { 1.0 };
                matrix.row_mut(row).scale_mut(1.0 / largest);
                wanted[row] = -residuals[*place] / largest;
            }
            if !matrix
                .iter()
                .chain(wanted.iter())
                .all(|entry| entry.is_finite())
            {
                return false;
            }
            let change = qr_iteration::svd(&matrix).and_then(|decomposed| {
                let least = MIN_SINGULAR_VALUE_FRACTION * decomposed.singular_values.amax();
                decomposed.solve(&wanted, least).ok()
            });
            let Some(change) = change else {
                return false;
            };
            let mut relative: f64 = 0.0;
            for (place, part) in self.columns.iter().zip(change.iter()) {
                if let Some(place) = *place {
                    let (value, size) = (&mut at.state[place], self.sizes[place]);
                    *value += part * size;
                    relative = relative.max(part.abs() * size / value.abs().max(size));
                }
            }
            if relative <= LAST_CORRECTION_FRACTION {
                // If coordinates are fixed, the constraints may have no solution.
                return (&matrix * &change - &wanted).amax() <= LAST_CORRECTION_FRACTION;
            }
        }
        false
    }
}
