//! Constraints at one state: derivatives and right-hand sides for the accelerations.

use super::Oracle;
use super::OracleError;
use super::conditioned::Conditioned;
use super::equations::ConstraintRow;
use super::evaluate::Pass;
use super::lower::Lowering;
use super::scene::{Direction, Scene};
use super::tree::{Dependence, Tree};
use eomgen_model_spec::model::{Model, STABILISATION_RATE};

#[derive(Debug)]
pub(super) struct LoweredConstraint {
    zero: Tree,
    rate: Tree,
    dependence: Dependence,
    is_nonholonomic: bool,
}

pub(super) fn lower_constraints(
    lowering: &mut Lowering<'_>,
    model: &Model,
) -> Result<Vec<LoweredConstraint>, OracleError> {
    let mut constraints = Vec::with_capacity(model.constraints.len());
    for constraint in &model.constraints {
        let zero = lowering.lower_term(&constraint.name, &constraint.zero)?;
        lowering.system.residuals.push(zero.clone());
        constraints.push(LoweredConstraint {
            dependence: lowering.system.dependence(&zero),
            rate: Tree::Dot(zero.clone().into()),
            is_nonholonomic: constraint.is_nonholonomic,
            zero,
        });
    }
    Ok(constraints)
}

/// Returns the decay rate of constraint residuals, in 1/s.
pub(super) fn stabilisation_rate(model: &Model, parameters: &[f64]) -> f64 {
    let mut known = model.parameters.iter().zip(parameters);
    let rate = known.find(|(parameter, _)| parameter.name == STABILISATION_RATE);
    rate.map_or(0.0, |(_, value)| *value)
}

impl LoweredConstraint {
    /// Returns the residual and its rate for a holonomic constraint; 0 and the residual for a nonholonomic one.
    pub(super) fn values(&self, scene: &Scene<'_>) -> (f64, f64) {
        let zero = Pass::new(scene, Direction::Time, Direction::Zero).value(&self.zero);
        match self.is_nonholonomic {
            true => (0.0, zero.re.value),
            false => (zero.re.value, zero.eps1.value),
        }
    }

    pub(super) fn row(&self, scene: &Scene<'_>, stabilisation_rate: f64) -> ConstraintRow {
        let entry = |row: usize| {
            if !scene.system.depends_on_row(&self.dependence, row) {
                return Conditioned::default();
            }
            let direction = match self.is_nonholonomic {
                true => Direction::Rate(row),
                false => Direction::Position(row),
            };
            let pass = Pass::new(scene, Direction::Zero, direction);
            pass.value(&self.zero).eps2
        };
        let along = Pass::new(scene, Direction::Time, Direction::Zero);
        let zero = along.value(&self.zero);
        let w = stabilisation_rate;
        let right = match self.is_nonholonomic {
            true => zero.eps1 * -1.0 + zero.re * (-2.0 * w),
            false => {
                let second = along.value(&self.rate).eps1;
                second * -1.0 + zero.eps1 * (-2.0 * w) + zero.re * (-w * w)
            }
        };
        ConstraintRow {
            gradient: (0..scene.system.size).map(entry).collect(),
            right_side: right,
        }
    }
}

impl Oracle {
    pub(super) fn multipliers(&self, scene: &Scene<'_>) -> Vec<Conditioned> {
        if self.constraints.is_empty() {
            return Vec::new();
        }
        let unknown = || vec![Conditioned::from(f64::NAN); self.constraints.len()];
        self.evaluate_equations(scene)
            .multipliers()
            .unwrap_or_else(unknown)
    }

    /// Returns the power of the constraint forces. It is nonzero if prescribed motion moves a constraint or if a
    /// residual is not 0.
    pub(super) fn reaction_power(&self, scene: &Scene<'_>, rates: &[f64]) -> Conditioned {
        let multipliers = self.multipliers(scene);
        let mut total = Conditioned::default();
        for (constraint, multiplier) in self.constraints.iter().zip(multipliers) {
            let row = constraint.row(scene, self.stabilisation_rate);
            for (entry, rate) in row.gradient.iter().zip(rates) {
                total += Conditioned::new(
                    entry.value * multiplier.value * rate,
                    entry.magnitude * multiplier.magnitude * rate.abs(),
                );
            }
        }
        total
    }
}
