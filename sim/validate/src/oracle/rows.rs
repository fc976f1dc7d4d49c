//! Computation of all rows of the equations of motion at a state, and of some derivatives.

use super::conditioned::Conditioned;
use super::equations::{Equations, RowTermKind};
use super::error::OracleError;
use super::evaluate::Pass;
use super::scene::{Direction, Scene};
use super::switches::{PrescribedSides, Side};
use super::tree::Tree;
use super::{Oracle, expect_length};
use nalgebra::DMatrix;

impl Oracle {
    /// Returns the equations of motion at a state (coordinates, rates, first-order states, in SI).
    pub fn equations(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Equations, OracleError> {
        Ok(self.evaluate_equations(&self.scene(time, state, None, inputs)?))
    }

    /// Returns the equations of motion with every piecewise function on the given side of its
    /// switch, in the order of [`Oracle::switches`], independent of the state's actual sides.
    pub fn equations_on(
        &self,
        sides: &[Side],
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Equations, OracleError> {
        expect_length("sides", self.switches.len(), sides.len())?;
        let mut scene = self.scene(time, state, None, inputs)?;
        scene.prescribed_sides = Some(PrescribedSides {
            switches: &self.switches,
            sides,
        });
        Ok(self.evaluate_equations(&scene))
    }

    /// Returns the equations of motion if the state is in the model's domain: every term and both
    /// energies are finite, and the mass matrix is positive definite. Returns `None` otherwise.
    pub fn equations_inside(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Option<Equations>, OracleError> {
        let equations = self.equations(time, state, inputs)?;
        let totals = [
            self.energy(time, state, inputs)?,
            self.power(time, state, inputs)?,
        ];
        let finite = totals.iter().all(|total| total.is_finite()) && equations.is_finite();
        Ok((finite && equations.is_definite()).then_some(equations))
    }

    pub(super) fn evaluate_equations(&self, scene: &Scene<'_>) -> Equations {
        let mut terms = Vec::new();
        for term in &self.kinetic {
            terms.push(term.rows(scene, RowTermKind::Momentum));
            terms.push(term.rows(scene, RowTermKind::KineticGradient));
        }
        for term in &self.potential {
            terms.push(term.rows(scene, RowTermKind::PotentialGradient));
        }
        for term in &self.dissipation {
            terms.push(term.rows(scene, RowTermKind::Dissipation));
        }
        for force in &self.forces {
            terms.push(force.rows(scene));
        }
        let (mass, mass_magnitude) = self.evaluate_mass(scene);
        Equations {
            mass,
            mass_magnitude,
            terms,
            state_rates: self.state_rates(scene),
            constraints: (self.constraints.iter())
                .map(|constraint| constraint.row(scene, self.stabilisation_rate))
                .collect(),
            excess: self.excess,
        }
    }

    fn state_rates(&self, scene: &Scene<'_>) -> Vec<Vec<Conditioned>> {
        let pass = Pass::new(scene, Direction::Zero, Direction::Zero);
        let rates = self.system.state_rates.iter();
        rates
            .map(|addends| addends.iter().map(|tree| pass.value(tree).re).collect())
            .collect()
    }

    /// Returns the derivative of each first-order state's rate by that state, in 1/s.
    pub fn state_decays(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Vec<f64>, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let decay = |index: usize| {
            let pass = Pass::new(&scene, Direction::Zero, Direction::State(index));
            pass.value(&Tree::StateRate(index)).eps2.value
        };
        Ok((0..self.states).map(decay).collect())
    }

    /// Returns the second derivatives of the potential energy by each generalised coordinate.
    pub fn stiffness_diagonal(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Vec<f64>, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let entry = |row| {
            let pass = Pass::new(&scene, Direction::Position(row), Direction::Position(row));
            let terms = self.potential.iter();
            terms
                .filter(|term| self.system.depends_on_row(&term.dependence, row))
                .map(|term| pass.value(&term.tree).eps1eps2.value)
                .sum()
        };
        Ok((0..self.size()).map(entry).collect())
    }

    /// Returns M_jk = d^2 T/dq_j' dq_k' and magnitudes of the entries; the lower half is mirrored.
    fn evaluate_mass(&self, scene: &Scene<'_>) -> (DMatrix<f64>, DMatrix<f64>) {
        let size = self.size();
        let mut mass = DMatrix::zeros(size, size);
        let mut magnitude = DMatrix::zeros(size, size);
        for row in 0..size {
            for column in row..size {
                let mut terms = self
                    .kinetic
                    .iter()
                    .filter(|term| {
                        self.system.depends_on_row(&term.dependence, row)
                            && self.system.depends_on_row(&term.dependence, column)
                    })
                    .peekable();
                if terms.peek().is_none() {
                    continue;
                }
                let pass = Pass::new(scene, Direction::Rate(row), Direction::Rate(column));
                let entry: Conditioned = terms.map(|term| pass.value(&term.tree).eps1eps2).sum();
                for place in [(row, column), (column, row)] {
                    mass[place] = entry.value;
                    magnitude[place] = entry.magnitude;
                }
            }
        }
        (mass, magnitude)
    }
}
