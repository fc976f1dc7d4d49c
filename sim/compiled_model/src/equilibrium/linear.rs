//! Linearised equations at one point of an equilibrium search, scaled to be independent of units.

use eomgen_analysis::allowed_motions::{AllowedMotions, row_by_row};
use eomgen_analysis::qr_iteration;
use nalgebra::{DMatrix, DVector, Dyn, SVD};

/// The sign of an acceleration below this fraction of its terms is unknown.
const MAX_SIGNLESS_FRACTION: f64 = 1e-12;

/// Largest change of the slope of the accelerations along a step for which the equations count as linear, relative to
/// the slope.
const MAX_SLOPE_CHANGE_FRACTION: f64 = 0.5;

/// Accelerations and rates of first-order states at a point, and their derivatives with respect to
/// the unknowns.
pub(super) struct LinearisedEquations {
    pub accelerations: DVector<f64>,
    pub matrix: DMatrix<f64>,
    /// Linearised constraints at this point; `None` without constraints.
    pub constraints: Option<LinearisedConstraints>,
    /// Largest magnitude of each acceleration or of its terms at this point.
    pub terms: DVector<f64>,
    /// Largest such magnitude at all points of the search so far; scales of the norm.
    pub sizes: DVector<f64>,
    /// For each acceleration, the sum of the magnitudes of its derivatives times the states, and of its largest
    /// constraint force.
    pub state_terms: DVector<f64>,
    /// True for each acceleration that an unknown input changes.
    pub input_rows: Vec<bool>,
    /// Largest magnitude of each acceleration at all points of the search so far.
    pub largest: DVector<f64>,
}

impl LinearisedEquations {
    /// Computes the smallest change of the unknowns that minimises the linearised accelerations and satisfies the
    /// linearised constraints. Singular values below `least` times the largest count as 0.
    pub fn solve_step(&self, scales: &[Option<f64>], least: f64) -> DVector<f64> {
        let unknowns = self.matrix.ncols();
        let step = || {
            let system = self.scale(scales)?;
            let wanted = -(&system.rows * &self.accelerations);
            let decomposed = qr_iteration::svd(&system.matrix)?;
            let solved = decomposed.solve(&wanted, system.least_singular_value(&decomposed, least));
            Some(&system.changes * solved.ok()?)
        };
        step().unwrap_or_else(|| DVector::zeros(unknowns))
    }

    /// Returns dimensionless equations. Each unknown is scaled by its natural scale or, without one, by its effect on
    /// the accelerations. `None` if a number is not finite.
    pub fn scale(&self, scales: &[Option<f64>]) -> Option<ScaledSystem> {
        let (sizes, units) = self.find_scales(scales);
        let relative = DMatrix::from_diagonal(&sizes.map(|size| 1.0 / size));
        let units = DMatrix::from_diagonal(&units);
        let Some(constraints) = &self.constraints else {
            return Some(ScaledSystem {
                matrix: &relative * &self.matrix * &units,
                rows: relative,
                changes: units,
                slope_size: 0.0,
            });
        };
        let basis = constraints.compute_allowed_changes(&units)?;
        let rows = constraints.rows(&sizes) * relative;
        let changes = units * basis;
        Some(ScaledSystem {
            matrix: &rows * &self.matrix * &changes,
            rows,
            changes,
            // The slopes are about 1 after scaling. Forces with an extremum along a displacement have a slope of
            // rounding.
            slope_size: 1.0,
        })
    }

    /// Returns the scales of rows and unknowns. The sizes of rows give the units of unknowns by their effects. These
    /// units give the sizes of rows in which all terms are 0, for example the row of an actuator at rest.
    fn find_scales(&self, scales: &[Option<f64>]) -> (DVector<f64>, DVector<f64>) {
        let entry = |row: usize, column: usize| self.matrix[(row, column)].abs();
        let positive = |size: f64| (size > 0.0).then_some(size);
        let mut rows: Vec<Option<f64>> = self.sizes.iter().map(|size| positive(*size)).collect();
        let mut units = scales.to_vec();
        loop {
            let known = rows.iter().chain(&units).flatten().count();
            for (column, unit) in units.iter_mut().enumerate() {
                if unit.is_none() {
                    let effects = rows.iter().enumerate();
                    let effects =
                        effects.filter_map(|(row, size)| Some(entry(row, column) / (*size)?));
                    *unit = positive(effects.fold(0.0, f64::max)).map(|effect| 1.0 / effect);
                }
            }
            for (row, size) in rows.iter_mut().enumerate() {
                if size.is_none() {
                    let terms = units.iter().enumerate();
                    let terms =
                        terms.filter_map(|(column, unit)| Some(entry(row, column) * (*unit)?));
                    *size = positive(terms.fold(0.0, f64::max));
                }
            }
            if rows.iter().chain(&units).flatten().count() == known {
                break;
            }
        }
        let known_or_one = |sizes: Vec<Option<f64>>| {
            DVector::from_iterator(sizes.len(), sizes.iter().map(|size| size.unwrap_or(1.0)))
        };
        (known_or_one(rows), known_or_one(units))
    }

    /// Returns true if the slope of the accelerations along `way` is nearly the same in `there`, the equations at
    /// another point.
    pub fn has_equal_slope_at(&self, there: &Self, way: &DVector<f64>) -> bool {
        let rows = self.sizes.map(nonzero_or_one);
        let slope = |linear: &Self| (&linear.matrix * way).component_div(&rows);
        let (here, there) = (slope(self), slope(there));
        (&there - &here).norm() <= MAX_SLOPE_CHANGE_FRACTION * here.norm().max(there.norm())
    }

    /// Returns the squared norm of accelerations, relative to the sizes of these equations. With constraints the norm
    /// is that of the kinetic energy, which does not depend on the choice of coordinates.
    pub fn compute_squared_norm(&self, accelerations: &DVector<f64>) -> f64 {
        let relative = |row: usize| accelerations[row] / nonzero_or_one(self.sizes[row]);
        let squares = |rows: std::ops::Range<usize>| rows.map(relative).map(|own| own * own).sum();
        let Some(constraints) = &self.constraints else {
            return squares(0..accelerations.len());
        };
        let degrees = constraints.mass.nrows();
        let mechanical = accelerations.rows(0, degrees);
        let energy = mechanical.dot(&(&constraints.mass * mechanical));
        let sizes = self.sizes.rows(0, degrees);
        let size = sizes
            .component_mul(&sizes)
            .dot(&constraints.mass.diagonal());
        let others: f64 = squares(degrees..accelerations.len());
        energy / nonzero_or_one(size) + others
    }

    /// Returns true if all accelerations are below the fraction `part` of their terms.
    pub fn is_below(&self, part: f64) -> bool {
        self.find_rows_above(part).is_empty()
    }

    /// Returns the rows of the accelerations that are at least the fraction `part` of their terms.
    pub fn find_rows_above(&self, part: f64) -> Vec<usize> {
        let rows = self.compute_relative_accelerations().enumerate();
        let above = rows.filter(|(_, own)| own.is_nan() || *own > part);
        above.map(|(row, _)| row).collect()
    }

    /// Returns the magnitude of an unknown that balances the largest acceleration of the search in one row; 0 if the
    /// unknown changes no acceleration.
    pub fn compute_balancing_size(&self, unknown: usize) -> f64 {
        let effects = self.matrix.column(unknown).into_iter();
        let rows = effects
            .zip(self.largest.iter())
            .filter(|(effect, _)| **effect != 0.0);
        rows.map(|(effect, largest)| largest / effect.abs())
            .min_by(f64::total_cmp)
            .unwrap_or(0.0)
    }

    /// Returns the row of the largest acceleration relative to its terms, and its value, SI.
    pub fn find_largest_residual(&self) -> (usize, f64) {
        let worst = self
            .compute_relative_accelerations()
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1));
        worst.map_or((0, 0.0), |(row, _)| (row, self.accelerations[row]))
    }

    /// Returns the sign of the acceleration of a coordinate; 0 if the acceleration is rounding.
    pub fn find_acceleration_sign(&self, coordinate: usize) -> f64 {
        let value = self.accelerations.get(coordinate).copied().unwrap_or(0.0);
        match self.terms.get(coordinate) {
            Some(size) if value.abs() > MAX_SIGNLESS_FRACTION * size => value.signum(),
            _ => 0.0,
        }
    }

    fn compute_relative_accelerations(&self) -> impl Iterator<Item = f64> {
        let parts = self.accelerations.iter().zip(&self.terms);
        let scales = self.largest.iter().zip(&self.input_rows);
        parts
            .zip(scales)
            .map(|((value, size), (largest, is_balanced))| {
                // Terms below the rounding errors of earlier accelerations come from an input that balances nothing.
                let is_rounding = *is_balanced && *size <= f64::EPSILON * largest;
                if *value == 0.0 || is_rounding {
                    0.0
                } else {
                    value.abs() / size
                }
            })
    }
}

/// Holonomic constraints, linearised at a point of a search.
pub(super) struct LinearisedConstraints {
    /// Derivatives of the constraints with respect to the unknowns.
    pub by_unknowns: DMatrix<f64>,
    /// Mass matrix.
    pub mass: DMatrix<f64>,
    /// Largest acceleration of each coordinate by the force of a single constraint. The forces of several constraints
    /// may cancel.
    pub largest_accelerations: DVector<f64>,
    /// Independent displacements of the coordinates that satisfy the linearised constraints, as columns.
    pub displacements: DMatrix<f64>,
}

impl LinearisedConstraints {
    /// Returns the component of the accelerations along the displacements, by the principle of least constraint. In the
    /// orthogonal directions the constraints determine the accelerations; a component there is only rounding of the
    /// constraint forces.
    pub fn project(&self, accelerations: &DVector<f64>) -> Option<DVector<f64>> {
        let degrees = self.mass.nrows();
        let mut projected = accelerations.clone();
        let along = self.displacements.transpose() * &self.mass;
        let inertia = (&along * &self.displacements).cholesky()?;
        let part = &self.displacements * inertia.solve(&(along * accelerations.rows(0, degrees)));
        projected.rows_mut(0, degrees).copy_from(&part);
        Some(projected)
    }

    /// Returns an orthonormal basis of the changes of the unknowns, relative to `units`, that satisfy the linearised
    /// constraints; `None` if a number is not finite.
    fn compute_allowed_changes(&self, units: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let held = &self.by_unknowns * units;
        let allowed = AllowedMotions::new(&row_by_row(&held), &vec![1.0; units.ncols()]).ok()?;
        Some(allowed.basis().clone())
    }

    /// Returns the rows of the equations for accelerations relative to `sizes`. Only accelerations along the
    /// displacements count: in the orthogonal directions the constraints determine the accelerations.
    fn rows(&self, sizes: &DVector<f64>) -> DMatrix<f64> {
        let (degrees, independent) = self.displacements.shape();
        let mut along = self.displacements.transpose() * &self.mass;
        for mut row in along.row_iter_mut() {
            for (entry, size) in row.iter_mut().zip(sizes.iter()) {
                *entry *= size;
            }
            let size = nonzero_or_one(row.iter().map(|entry| entry.abs()).sum());
            row /= size;
        }
        let others = sizes.len() - degrees;
        let mut rows = DMatrix::zeros(independent + others, sizes.len());
        rows.view_mut((0, 0), (independent, degrees))
            .copy_from(&along);
        rows.view_mut((independent, degrees), (others, others))
            .fill_with_identity();
        rows
    }
}

/// Dimensionless linearised equations for changes that satisfy the constraints.
pub(super) struct ScaledSystem {
    /// Equations as linear combinations of the accelerations.
    pub rows: DMatrix<f64>,
    /// Change of the unknowns for a unit change, one column per independent change.
    pub changes: DMatrix<f64>,
    /// Derivatives of the equations with respect to the independent changes.
    pub matrix: DMatrix<f64>,
    /// Size of regular slopes; 0 if the largest singular value is the reference instead.
    slope_size: f64,
}

/// Directions of a scaled system whose slopes exceed rounding.
pub(super) struct KeptDirections {
    /// Orthonormal combinations of the equations, one per column.
    pub left: DMatrix<f64>,
    /// Pseudoinverse of the system in these directions.
    pub inverse: DMatrix<f64>,
}

impl ScaledSystem {
    /// Returns the directions with singular values above `least` times the largest.
    pub fn find_kept_directions(&self, least: f64) -> KeptDirections {
        let (rows, columns) = self.matrix.shape();
        let mut kept = KeptDirections {
            left: DMatrix::zeros(rows, 0),
            inverse: DMatrix::zeros(columns, rows),
        };
        let Some(decomposed) = qr_iteration::svd(&self.matrix) else {
            return kept;
        };
        let least = self.least_singular_value(&decomposed, least);
        let (Some(left), Some(right)) = (&decomposed.u, &decomposed.v_t) else {
            return kept;
        };
        let values = decomposed.singular_values.iter().enumerate();
        for (place, value) in values.filter(|(_, value)| **value > least) {
            kept.inverse += right.row(place).transpose() * left.column(place).transpose() / *value;
            let last = kept.left.ncols();
            kept.left = kept.left.insert_column(last, 0.0);
            kept.left.set_column(last, &left.column(place));
        }
        kept
    }

    /// Returns a change of the unknowns in directions with singular values below `least` times the largest: the
    /// component of the unknowns' accelerations in these directions. `None` if changes of the unknowns remove the
    /// accelerations.
    pub fn find_free_change(
        &self,
        least: f64,
        equations: &LinearisedEquations,
        accelerations: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let kept = self.find_kept_directions(least);
        let residuals = &self.rows * &equations.accelerations;
        let left = &residuals - &kept.left * (kept.left.transpose() * &residuals);
        if left.amax() <= MAX_SIGNLESS_FRACTION * residuals.amax() {
            return None;
        }
        let units = self.changes.diagonal();
        let scaled = accelerations.component_div(&units);
        let along_kept = &kept.inverse * (&self.matrix * &scaled);
        Some((scaled - along_kept).component_mul(&units))
    }

    /// Returns the row of the acceleration with the largest coefficient in one of the equations.
    pub fn find_main_acceleration(&self, row: usize, equations: &LinearisedEquations) -> usize {
        let factors = self.rows.row(row).into_iter();
        let parts = factors.zip(equations.accelerations.iter());
        let parts = parts.map(|(factor, acceleration)| (factor * acceleration).abs());
        let largest = parts.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        largest.map_or(0, |(row, _)| row)
    }

    /// Returns the limit below which a singular value counts as 0: the given fraction of the largest or of the slope
    /// size.
    pub fn least_singular_value(&self, decomposed: &SVD<f64, Dyn, Dyn>, fraction: f64) -> f64 {
        fraction * decomposed.singular_values.amax().max(self.slope_size)
    }
}

fn nonzero_or_one(size: f64) -> f64 {
    if size > 0.0 { size } else { 1.0 }
}
