//! Equations of motion at one state, term by term.

use super::conditioned::Conditioned;

use nalgebra::{Cholesky, DMatrix, DVector};

/// Equations of motion at one state. For every row j, in the unit of the force on coordinate j:
///
/// ```text
/// sum over k of mass[j, k] q_k'' + sum over terms of term[j] = 0
/// ```
///
/// First-order states have one rate each.
#[derive(Clone, Debug)]
pub struct Equations {
    /// Mass matrix, n by n.
    pub mass: DMatrix<f64>,
    /// Magnitudes of the terms of its entries, before cancellation.
    pub mass_magnitude: DMatrix<f64>,
    /// All terms without accelerations, addend by addend.
    pub terms: Vec<RowTerm>,
    /// Addends of each first-order state's rate, in its unit per s.
    pub state_rates: Vec<Vec<Conditioned>>,
    /// Constraints. Their forces act in the rows.
    pub constraints: Vec<ConstraintRow>,
    /// Number of constraints that depend on the others at every state that satisfies them.
    pub excess: usize,
}

/// Contribution of one addend of a term to every row.
#[derive(Clone, Debug)]
pub struct RowTerm {
    /// Name of the term in the specification; its addends share it.
    pub name: String,
    /// Kind of the term.
    pub kind: RowTermKind,
    /// Value in every row, on the left side of the equation, together with the accelerations.
    pub rows: DVector<f64>,
    /// Magnitudes of the values' terms, before cancellation.
    pub magnitudes: DVector<f64>,
}

impl RowTerm {
    pub(super) fn new(name: &str, kind: RowTermKind, rows: Vec<Conditioned>) -> Self {
        let part = |part: fn(&Conditioned) -> f64| {
            DVector::from_iterator(rows.len(), rows.iter().map(part))
        };
        Self {
            name: name.to_owned(),
            kind,
            rows: part(|row| row.value),
            magnitudes: part(|row| row.magnitude),
        }
    }
}

/// Kind of a term in the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowTermKind {
    /// d/dt dT/dq_j' without the accelerations.
    Momentum,
    /// -dT/dq_j.
    KineticGradient,
    /// dV/dq_j.
    PotentialGradient,
    /// dR/dq_j'.
    Dissipation,
    /// -Q_j of one force.
    Force,
}

/// Constraint on the accelerations: sum over k of gradient[k] q_k'' = right.
#[derive(Clone, Debug)]
pub struct ConstraintRow {
    /// Derivatives of the constraint by every coordinate, or by every rate.
    pub gradient: Vec<Conditioned>,
    pub right_side: Conditioned,
}

/// Residual of one row with the row's scale.
#[derive(Clone, Copy, Debug)]
pub struct Residual {
    /// Sum of the row.
    pub value: f64,
    /// Largest magnitude among the terms and `mass[j, k] q_k''` of the row, before cancellation.
    pub scale: f64,
}

impl Residual {
    /// Returns |value|/scale; 0 for an empty row, infinity for NaN.
    pub fn relative(&self) -> f64 {
        let relative = self.value.abs() / self.scale;
        if self.value == 0.0 {
            0.0
        } else if relative.is_nan() {
            f64::INFINITY
        } else {
            relative
        }
    }
}

/// Minimum square of a pivot of the scaled mass matrix. Smaller pivots are treated as rounding error.
const SMALLEST_PIVOT: f64 = 1e-13;

/// Smallest nonzero eigenvalue of the scaled A M^-1 A^T of dependent constraints.
const SMALLEST_EIGENVALUE: f64 = 1e-3;

/// Largest eigenvalue of the scaled A M^-1 A^T that counts as 0.
const LARGEST_ZERO_EIGENVALUE: f64 = 1e-11;

impl Equations {
    /// Returns true if all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let terms = self
            .terms
            .iter()
            .flat_map(|t| t.rows.iter().chain(&t.magnitudes));
        let mass = self.mass.iter().chain(&self.mass_magnitude);
        let constraints = self.constraints.iter();
        let mut entries = constraints.flat_map(|row| row.gradient.iter().chain([&row.right_side]));
        let mut rates = self.state_rates.iter().flatten();
        entries.all(|entry| entry.value.is_finite() && entry.magnitude.is_finite())
            && terms.chain(mass).all(|number| number.is_finite())
            && rates.all(|rate| rate.value.is_finite() && rate.magnitude.is_finite())
    }

    /// Returns true if the mass matrix is positive definite and the constraints are independent, with a margin over
    /// rounding.
    pub fn is_definite(&self) -> bool {
        has_pivots(&self.scaled_mass().1)
            && match self.excess {
                0 => (self.constraint_compliance())
                    .is_some_and(|compliance| has_pivots(&scale_to_unit_diagonal(&compliance).1)),
                excess => self.compliance_eigenvalues().is_some_and(|eigenvalues| {
                    eigenvalues[excess - 1].abs() < LARGEST_ZERO_EIGENVALUE
                        && eigenvalues[excess] > SMALLEST_EIGENVALUE
                }),
            }
    }

    /// Returns the number of vanishing eigenvalues of the scaled A M^-1 A^T.
    pub(super) fn count_dependent_constraints(&self) -> Option<usize> {
        let eigenvalues = self.compliance_eigenvalues()?;
        let zero = eigenvalues.iter();
        Some(
            zero.filter(|value| value.abs() < LARGEST_ZERO_EIGENVALUE)
                .count(),
        )
    }

    /// Returns the eigenvalues of the scaled A M^-1 A^T, ascending.
    fn compliance_eigenvalues(&self) -> Option<Vec<f64>> {
        let (_, compliance) = scale_to_unit_diagonal(&self.constraint_compliance()?);
        if compliance.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let mut found: Vec<f64> = compliance.symmetric_eigenvalues().iter().copied().collect();
        found.sort_by(f64::total_cmp);
        Some(found)
    }

    fn gradients(&self) -> DMatrix<f64> {
        DMatrix::from_fn(self.constraints.len(), self.size(), |row, column| {
            self.constraints[row].gradient[column].value
        })
    }

    /// Returns A M^-1 A^T.
    fn constraint_compliance(&self) -> Option<DMatrix<f64>> {
        let gradients = self.gradients();
        let (scale, mass) = self.scaled_mass();
        let mut solved = gradients.transpose();
        for mut column in solved.column_iter_mut() {
            column.component_mul_assign(&scale);
        }
        let mut solved = Cholesky::new(mass)?.solve(&solved);
        for mut column in solved.column_iter_mut() {
            column.component_mul_assign(&scale);
        }
        Some(gradients * solved)
    }

    /// Returns the multipliers of the constraints with the magnitudes of their terms, from A M^-1 A^T lambda = b - A
    /// M^-1 (f - c). For dependent constraints, it is the solution of least norm, scaled with the square roots of the
    /// diagonal entries. Returns `None` if the accelerations cannot be solved for.
    pub fn multipliers(&self) -> Option<Vec<Conditioned>> {
        if self.constraints.is_empty() {
            return Some(Vec::new());
        }
        let (scale, compliance) = scale_to_unit_diagonal(&self.constraint_compliance()?);
        let inverse = match self.excess {
            0 => Cholesky::new(compliance.clone())?.inverse(),
            excess => pseudo_inverse(&compliance, excess)?,
        };
        let (free, sizes) = self.free_accelerations()?;
        let gaps: Vec<Conditioned> = self
            .constraints
            .iter()
            .map(|row| {
                let moved = row.gradient.iter().zip(free.iter().zip(sizes.iter()));
                let moved = moved.map(|(entry, (a, size))| {
                    Conditioned::new(-entry.value * a, entry.magnitude * size)
                });
                moved.chain([row.right_side]).sum()
            })
            .collect();
        let row = |row: usize| {
            let gaps = gaps.iter().enumerate();
            gaps.map(|(column, gap)| *gap * (scale[row] * inverse[(row, column)] * scale[column]))
                .sum()
        };
        let mut found: Vec<Conditioned> = (0..gaps.len()).map(row).collect();
        if self.excess > 0 {
            let condition = compliance.norm() * inverse.norm();
            add_pseudo_inverse_errors(&mut found, &scale, condition);
        }
        Some(found)
    }

    /// Returns the accelerations without constraint forces, with the magnitudes of their terms.
    fn free_accelerations(&self) -> Option<(DVector<f64>, DVector<f64>)> {
        let (scale, mass) = self.scaled_mass();
        let right = self.right_side().component_mul(&scale);
        let free = Cholesky::new(mass)?.solve(&right).component_mul(&scale);
        let magnitudes = self.acceleration_magnitudes(&self.term_magnitudes())?;
        Some((free, magnitudes))
    }

    /// Returns the sums of the magnitudes of all terms in every row.
    fn term_magnitudes(&self) -> DVector<f64> {
        let terms = self.terms.iter().map(|term| &term.magnitudes);
        terms.fold(DVector::zeros(self.size()), |sum, term| sum + term)
    }

    /// Returns |M^-1| times the magnitudes of forces, which bounds the magnitudes of the accelerations' terms.
    fn acceleration_magnitudes(&self, forces: &DVector<f64>) -> Option<DVector<f64>> {
        let (scale, mass) = self.scaled_mass();
        let inverse = Cholesky::new(mass)?.inverse().abs();
        Some((inverse * forces.component_mul(&scale)).component_mul(&scale))
    }

    fn constraint_reactions(&self) -> Vec<Vec<Conditioned>> {
        let unknown = || vec![Conditioned::from(f64::NAN); self.constraints.len()];
        let multipliers = self.multipliers().unwrap_or_else(unknown);
        let row = |row: usize| {
            let constraints = self.constraints.iter().zip(&multipliers);
            let reaction = constraints.map(|(constraint, multiplier)| {
                let entry = constraint.gradient[row];
                Conditioned::new(
                    -entry.value * multiplier.value,
                    entry.magnitude * multiplier.magnitude,
                )
            });
            reaction.collect()
        };
        (0..self.size()).map(row).collect()
    }

    /// Scales rows and columns of the mass matrix to a unit diagonal; returns the factors too.
    fn scaled_mass(&self) -> (DVector<f64>, DMatrix<f64>) {
        scale_to_unit_diagonal(&self.mass)
    }

    /// Returns the scale of a mass entry: the geometric mean of two diagonals, or its magnitude.
    pub fn mass_scale(&self, row: usize, column: usize) -> f64 {
        let mean = (self.mass[(row, row)] * self.mass[(column, column)]).sqrt();
        mean.max(self.mass_magnitude[(row, column)])
    }

    /// Returns the number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.mass.nrows()
    }

    /// Returns the right-hand side f - c of M q'' = f - c.
    pub fn right_side(&self) -> DVector<f64> {
        let mut sum = DVector::zeros(self.size());
        for term in &self.terms {
            sum -= &term.rows;
        }
        sum
    }

    /// Returns the accelerations by a Cholesky factorisation; `None` if not positive definite.
    pub fn accelerations(&self) -> Option<DVector<f64>> {
        let (scale, scaled) = self.scaled_mass();
        let mut right = self.right_side();
        for (row, multiplier) in self.constraints.iter().zip(self.multipliers()?) {
            for (side, entry) in right.iter_mut().zip(&row.gradient) {
                *side += entry.value * multiplier.value;
            }
        }
        let right = right.component_mul(&scale);
        Some(Cholesky::new(scaled)?.solve(&right).component_mul(&scale))
    }

    /// Returns [`Equations::accelerations`], then the rates of first-order states.
    pub fn unknowns(&self) -> Option<Vec<f64>> {
        let mut unknowns = self.accelerations()?.as_slice().to_vec();
        let rates = self.state_rates.iter();
        unknowns.extend(rates.map(|addends| sum_residual(addends.iter().copied()).value));
        Some(unknowns)
    }

    /// Returns the number of unknowns: accelerations, then rates of first-order states.
    pub fn unknown_count(&self) -> usize {
        self.size() + self.state_rates.len()
    }

    /// Returns each row's residual for `unknowns`: accelerations, then rates of first-order states. Missing unknowns
    /// count as 0.
    pub fn residuals(&self, unknowns: &[f64]) -> Vec<Residual> {
        self.row_residuals(unknowns, &self.constraint_reactions())
    }

    fn row_residuals(&self, unknowns: &[f64], reactions: &[Vec<Conditioned>]) -> Vec<Residual> {
        let rates = unknowns.get(self.size()..).unwrap_or_default();
        let rates = rates.iter().copied().chain(std::iter::repeat(0.0));
        let of_states = self.state_rates.iter().zip(rates).map(|(addends, rate)| {
            let addends = addends.iter().map(|addend| *addend * -1.0);
            sum_residual(addends.chain([Conditioned::new(rate, rate.abs())]))
        });
        let rows = self.degree_residuals(unknowns, reactions);
        rows.into_iter().chain(of_states).collect()
    }

    /// Returns the residual of every row for given accelerations, without constraint forces. The residuals are the
    /// forces that the accelerations require in addition to the forces of the specification.
    pub fn missing_forces(&self, accelerations: &[f64]) -> Vec<Residual> {
        self.degree_residuals(accelerations, &vec![Vec::new(); self.size()])
    }

    /// Returns the residual of every constraint. The scale includes the rounding errors of all forces, including
    /// constraint forces, even if the forces cancel.
    fn constraint_residuals(
        &self,
        accelerations: &[f64],
        reactions: &[Vec<Conditioned>],
    ) -> Vec<Residual> {
        let mut forces = self.term_magnitudes();
        for (force, reactions) in forces.iter_mut().zip(reactions) {
            *force += reactions.iter().map(|own| own.magnitude).sum::<f64>();
        }
        let sizes = self.acceleration_magnitudes(&forces);
        let sizes = sizes.unwrap_or_else(|| DVector::zeros(self.size()));
        let constraints = self.constraints.iter();
        constraints
            .map(|row| {
                let sizes = sizes.iter().copied();
                let entries = row.gradient.iter().zip(accelerations).zip(sizes);
                let addends = entries.map(|((entry, a), size)| {
                    Conditioned::new(entry.value * a, entry.magnitude * size.max(a.abs()))
                });
                sum_residual(addends.chain([row.right_side * -1.0]))
            })
            .collect()
    }

    fn degree_residuals(
        &self,
        accelerations: &[f64],
        reactions: &[Vec<Conditioned>],
    ) -> Vec<Residual> {
        (0..self.size())
            .map(|row| {
                let masses = self.mass.row(row);
                let magnitudes = self.mass_magnitude.row(row);
                let inertia = masses.iter().zip(magnitudes.iter()).zip(accelerations);
                let inertia = inertia.map(|((mass, magnitude), acceleration)| {
                    Conditioned::new(mass * acceleration, magnitude * acceleration.abs())
                });
                let terms = self.terms.iter();
                let terms = terms.map(|t| Conditioned::new(t.rows[row], t.magnitudes[row]));
                sum_residual(inertia.chain(terms).chain(reactions[row].iter().copied()))
            })
            .collect()
    }

    /// Returns the largest relative residual; infinity for NaN or a wrong number of unknowns.
    pub fn worst_residual(&self, unknowns: &[f64]) -> f64 {
        if unknowns.len() != self.unknown_count() {
            return f64::INFINITY;
        }
        let reactions = self.constraint_reactions();
        self.row_residuals(unknowns, &reactions)
            .iter()
            .chain(&self.constraint_residuals(unknowns, &reactions))
            .map(Residual::relative)
            .fold(0.0, f64::max)
    }

    /// Returns the largest distance of two sets of unknowns over all rows: |mass (first - second)|
    /// relative to the row's scale at `first`, or |first - second| for first-order rates.
    pub fn distance(&self, first: &[f64], second: &[f64]) -> f64 {
        if first.len() != self.unknown_count() || second.len() != self.unknown_count() {
            return f64::INFINITY;
        }
        let difference = DVector::from_iterator(
            self.size(),
            first
                .iter()
                .zip(second)
                .map(|(left, right)| left - right)
                .take(self.size()),
        );
        let rows = &self.mass * difference;
        let rates = first.iter().zip(second).skip(self.size());
        let rates: Vec<f64> = rates.map(|(left, right)| left - right).collect();
        self.residuals(first)
            .iter()
            .zip(rows.iter().chain(&rates))
            .map(|(residual, value)| {
                Residual {
                    value: *value,
                    scale: residual.scale,
                }
                .relative()
            })
            .fold(0.0, f64::max)
    }
}

/// Scales a positive definite matrix to a unit diagonal; returns the factors too.
fn scale_to_unit_diagonal(matrix: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let scale = matrix.diagonal().map(|entry| entry.sqrt().recip());
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        scale[row] * matrix[(row, column)] * scale[column]
    });
    (scale, scaled)
}

/// Returns the pseudo-inverse of a symmetric matrix with `excess` vanishing eigenvalues.
fn pseudo_inverse(matrix: &DMatrix<f64>, excess: usize) -> Option<DMatrix<f64>> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let mut parts = matrix.clone().symmetric_eigen();
    let mut order: Vec<usize> = (0..parts.eigenvalues.len()).collect();
    order.sort_by(|a, b| parts.eigenvalues[*a].total_cmp(&parts.eigenvalues[*b]));
    for (count, place) in order.into_iter().enumerate() {
        let value = parts.eigenvalues[place];
        parts.eigenvalues[place] = if count < excess { 0.0 } else { value.recip() };
    }
    Some(parts.recompose())
}

/// Adds the rounding errors of a pseudo-inverse to the magnitudes of multipliers. The errors are proportional to the
/// length of the scaled vector of multipliers and to the condition number of the matrix (P.-A. Wedin, BIT 13, 1973).
/// Therefore a multiplier that vanishes has an error too.
fn add_pseudo_inverse_errors(
    multipliers: &mut [Conditioned],
    scale: &DVector<f64>,
    condition: f64,
) {
    let scaled = multipliers.iter().zip(scale.iter());
    let squares = scaled.map(|(multiplier, scale)| (multiplier.value / scale).powi(2));
    let error = condition * squares.sum::<f64>().sqrt();
    for (multiplier, scale) in multipliers.iter_mut().zip(scale.iter()) {
        *multiplier = Conditioned::new(multiplier.value, multiplier.magnitude.max(error * scale));
    }
}

/// Returns true if the pivots of a scaled matrix are positive with a margin over rounding.
fn has_pivots(scaled: &DMatrix<f64>) -> bool {
    Cholesky::new(scaled.clone()).is_some_and(|factor| {
        let pivots = factor.l_dirty().diagonal();
        pivots.iter().all(|pivot| pivot * pivot > SMALLEST_PIVOT)
    })
}

/// Returns a row's sum, compensated (Neumaier) against rounding, and its largest magnitude.
fn sum_residual(addends: impl Iterator<Item = Conditioned>) -> Residual {
    let (mut sum, mut rest, mut scale) = (0.0_f64, 0.0_f64, 0.0_f64);
    for Conditioned {
        value: addend,
        magnitude,
    } in addends
    {
        let next = sum + addend;
        rest += if sum.abs() >= addend.abs() {
            (sum - next) + addend
        } else {
            (addend - next) + sum
        };
        sum = next;
        scale = if addend.is_nan() {
            f64::NAN
        } else {
            scale.max(magnitude)
        };
    }
    Residual {
        value: sum + rest,
        scale,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn equations() -> Equations {
        Equations {
            mass: DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 4.0]),
            mass_magnitude: DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 4.0]),
            terms: vec![RowTerm::new(
                "load",
                RowTermKind::Force,
                vec![(-3.0).into(), 1.0.into()],
            )],
            state_rates: Vec::new(),
            constraints: Vec::new(),
            excess: 0,
        }
    }

    #[test]
    fn dense_solution_has_zero_residual() {
        let equations = equations();
        let solution = equations.accelerations().map(|a| a.as_slice().to_vec());
        let solution = solution.unwrap_or_default();
        assert_eq!(solution.len(), 2);
        assert!(equations.worst_residual(&solution) < 1e-15);
        assert!(equations.distance(&solution, &[13.0 / 7.0, -5.0 / 7.0]) < 1e-15);
    }

    #[test]
    fn doubled_constraint_shares_its_force() {
        let mut equations = equations();
        let row = |factor: f64| ConstraintRow {
            gradient: vec![factor.into(), 0.0.into()],
            right_side: 0.0.into(),
        };
        equations.constraints = vec![row(1.0)];
        let single = equations.multipliers().expect("a multiplier")[0].value;
        equations.constraints = vec![row(1.0), row(-2.0)];
        equations.excess = 1;
        assert!(equations.is_definite());
        let shared = equations.multipliers().expect("multipliers");
        assert!((shared[0].value - 0.5 * single).abs() < 1e-14 * single.abs());
        assert!((shared[1].value + 0.25 * single).abs() < 1e-14 * single.abs());
        let solution = equations.accelerations().expect("accelerations");
        assert!(equations.worst_residual(solution.as_slice()) < 1e-14);
    }

    #[test]
    fn row_scale_includes_cancelled_terms() {
        let mut equations = equations();
        equations.terms[0].magnitudes[1] = 1e4;
        let solution = equations.accelerations().map(|a| a.as_slice().to_vec());
        let solution = solution.unwrap_or_default();
        let scales = equations.residuals(&solution);
        assert_eq!(scales[1].scale, 1e4);
        assert!(scales[0].scale < 10.0);
    }

    #[test]
    fn wrong_and_nan_accelerations_have_large_residuals() {
        let equations = equations();
        assert!(equations.worst_residual(&[1.0, 1.0]) > 0.1);
        assert_eq!(equations.worst_residual(&[f64::NAN, 1.0]), f64::INFINITY);
        assert_eq!(equations.worst_residual(&[1.0]), f64::INFINITY);
    }
}
