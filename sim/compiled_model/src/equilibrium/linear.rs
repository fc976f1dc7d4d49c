//! Linearised equations at one point of a search, scaled so that units do not matter.

use eomgen_analysis::allowed_motions::{AllowedMotions, row_by_row};
use eomgen_analysis::qr_iteration;
use nalgebra::{DMatrix, DVector};

/// Singular values below this fraction of the largest count as 0.
const MIN_SINGULAR_VALUE_FRACTION: f64 = 1e-12;

/// Largest change of the accelerations' slope along a step, relative to the slope, at which the
/// equations count as linear.
const MAX_SLOPE_CHANGE_FRACTION: f64 = 0.5;

/// Accelerations and rates of first-order states at a point, and their derivatives with respect to
/// the unknowns.
pub(super) struct LinearisedEquations {
    pub accelerations: DVector<f64>,
    pub matrix: DMatrix<f64>,
    /// Constraints at this point, if there are any.
    pub constraints: Option<LinearisedConstraints>,
    /// Largest magnitude of each acceleration or of its terms at this point.
    pub terms: DVector<f64>,
    /// The same, at all points of the search up to now: the scales of its norm.
    pub sizes: DVector<f64>,
}

impl LinearisedEquations {
    /// Computes the smallest change of the unknowns that minimises the linearised accelerations and
    /// satisfies the linearised constraints.
    /// Each unknown is scaled by its natural scale or, without one, by its effect on the
    /// accelerations.
    pub fn solve_step(&self, scales: &[Option<f64>]) -> DVector<f64> {
        let (rows, units) = self.find_scales(scales);
        let relative = |row: usize, column: usize| self.matrix[(row, column)] / rows[row];
        let scaled = DMatrix::from_fn(self.matrix.nrows(), self.matrix.ncols(), |row, column| {
            relative(row, column) * units[column]
        });
        let wanted = -self.accelerations.component_div(&rows);
        let step = match &self.constraints {
            None => solve(&scaled, &wanted),
            Some(constraints) => constraints.solve((scaled, wanted), (&rows, &units)),
        };
        let step = step.unwrap_or_else(|| DVector::zeros(self.matrix.ncols()));
        step.component_mul(&units)
    }

    /// Returns the scales of rows and unknowns. Sizes of rows give units of unknowns by their effect; these units give the
    /// sizes of rows in which all terms are 0, for example that of an actuator at rest.
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

    /// Returns true if the slope of the accelerations along `way` is nearly the same at another
    /// point.
    pub fn is_straight_to(&self, there: &Self, way: &DVector<f64>) -> bool {
        let rows = self.sizes.map(nonzero_or_one);
        let slope = |linear: &Self| (&linear.matrix * way).component_div(&rows);
        let (here, there) = (slope(self), slope(there));
        (&there - &here).norm() <= MAX_SLOPE_CHANGE_FRACTION * here.norm().max(there.norm())
    }

    /// Returns the squared norm of accelerations, relative to the sizes of these equations. With constraints it is that of
    /// the kinetic energy, which does not depend on the direction of the coordinates.
    pub fn squared_norm(&self, accelerations: &DVector<f64>) -> f64 {
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

    /// Returns true if all accelerations are below this fraction of their terms.
    pub fn is_below(&self, part: f64) -> bool {
        self.rows_above(part).is_empty()
    }

    /// Returns the rows of the accelerations that are not below this fraction of their terms.
    pub fn rows_above(&self, part: f64) -> Vec<usize> {
        let rows = self.relative_accelerations().enumerate();
        let above = rows.filter(|(_, own)| own.is_nan() || *own > part);
        above.map(|(row, _)| row).collect()
    }

    /// Returns the row of the largest acceleration relative to its terms, and its value, SI.
    pub fn largest_residual(&self) -> (usize, f64) {
        let worst = self
            .relative_accelerations()
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1));
        worst.map_or((0, 0.0), |(row, _)| (row, self.accelerations[row]))
    }

    /// Returns the sign of the acceleration of a coordinate; 0 if it is rounding.
    pub fn acceleration_sign(&self, coordinate: usize) -> f64 {
        let value = self.accelerations.get(coordinate).copied().unwrap_or(0.0);
        match self.terms.get(coordinate) {
            Some(size) if value.abs() > MIN_SINGULAR_VALUE_FRACTION * size => value.signum(),
            _ => 0.0,
        }
    }

    fn relative_accelerations(&self) -> impl Iterator<Item = f64> {
        let parts = self.accelerations.iter().zip(&self.terms);
        parts.map(|(value, size)| {
            if *value == 0.0 {
                0.0
            } else {
                value.abs() / size
            }
        })
    }
}

/// Holonomic constraints at a point of a search.
pub(super) struct LinearisedConstraints {
    /// Derivatives of the constraints by the unknowns.
    pub by_unknowns: DMatrix<f64>,
    /// Mass matrix.
    pub mass: DMatrix<f64>,
    /// Independent displacements of the coordinates that satisfy the linearised constraints, as columns.
    pub displacements: DMatrix<f64>,
}

impl LinearisedConstraints {
    /// Solves the equations, whose rows are relative to `sizes`, for the change of the unknowns relative to `units` that
    /// satisfies the linearised constraints. The accelerations count along the displacements only: across them the
    /// constraints determine them.
    fn solve(
        &self,
        (matrix, wanted): (DMatrix<f64>, DVector<f64>),
        (sizes, units): (&DVector<f64>, &DVector<f64>),
    ) -> Option<DVector<f64>> {
        let columns = units.len();
        let held = DMatrix::from_fn(self.by_unknowns.nrows(), columns, |row, column| {
            self.by_unknowns[(row, column)] * units[column]
        });
        let allowed = AllowedMotions::new(&row_by_row(&held), columns).ok()?;
        if allowed.count() == 0 {
            return None;
        }
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
        let basis = allowed.basis();
        Some(basis * solve(&(&rows * matrix * basis), &(&rows * wanted))?)
    }
}

/// Returns the smallest solution of least squares.
fn solve(matrix: &DMatrix<f64>, wanted: &DVector<f64>) -> Option<DVector<f64>> {
    let decomposed = qr_iteration::svd(matrix)?;
    let least = MIN_SINGULAR_VALUE_FRACTION * decomposed.singular_values.amax();
    decomposed.solve(wanted, least).ok()
}

fn nonzero_or_one(size: f64) -> f64 {
    if size > 0.0 { size } else { 1.0 }
}
