//! Contribution of one term of the specification to every row of the equations.

use super::OracleError;
use super::conditioned::Conditioned;
use super::equations::{RowTerm, RowTermKind};
use super::evaluate::{Number, Pass};
use super::lower::Lowering;
use super::scene::{Direction, Scene};
use super::tree::{Dependence, Tree};
use eomgen_model_spec::model::{Force, Term};

#[derive(Debug)]
pub(super) struct Lowered {
    pub name: String,
    pub tree: Tree,
    pub dependence: Dependence,
}

#[derive(Debug)]
pub(super) struct LoweredForce {
    pub name: String,
    pub coordinate_tree: Tree,
    pub dependence: Dependence,
    pub value: Tree,
}

impl Lowered {
    pub fn rows(&self, scene: &Scene<'_>, kind: RowTermKind) -> RowTerm {
        let entry = |row: usize| match kind {
            RowTermKind::Momentum => {
                self.row_derivative(scene, row, Direction::Time, Direction::Rate(row), |value| {
                    value.eps1eps2
                })
            }
            RowTermKind::KineticGradient => -self.derivative(scene, row, Direction::Position(row)),
            RowTermKind::PotentialGradient | RowTermKind::Force => {
                self.derivative(scene, row, Direction::Position(row))
            }
            RowTermKind::Dissipation => self.derivative(scene, row, Direction::Rate(row)),
        };
        let rows = (0..scene.system.size).map(entry).collect();
        RowTerm::new(&self.name, kind, rows)
    }

    pub fn derivative(&self, scene: &Scene<'_>, row: usize, direction: Direction) -> Conditioned {
        self.row_derivative(scene, row, Direction::Zero, direction, |value| value.eps2)
    }

    fn row_derivative(
        &self,
        scene: &Scene<'_>,
        row: usize,
        first: Direction,
        second: Direction,
        part: impl Fn(Number) -> Conditioned,
    ) -> Conditioned {
        if scene.system.depends_on_row(&self.dependence, row) {
            part(Pass::new(scene, first, second).value(&self.tree))
        } else {
            Conditioned::default()
        }
    }
}

impl LoweredForce {
    pub fn rows(&self, scene: &Scene<'_>) -> RowTerm {
        let value = Pass::new(scene, Direction::Zero, Direction::Zero)
            .value(&self.value)
            .re;
        let entry = |row: usize| {
            if scene.system.depends_on_row(&self.dependence, row) {
                let pass = Pass::new(scene, Direction::Zero, Direction::Position(row));
                -value * pass.value(&self.coordinate_tree).eps2
            } else {
                Conditioned::default()
            }
        };
        let rows = (0..scene.system.size).map(entry).collect();
        RowTerm::new(&self.name, RowTermKind::Force, rows)
    }
}

/// Converts each addend separately, because the scale of a row is its largest addend.
pub(super) fn lower_terms(
    lowering: &mut Lowering<'_>,
    terms: &[Term],
) -> Result<Vec<Lowered>, OracleError> {
    let mut lowered = Vec::new();
    for term in terms {
        let tree = lowering.lower_term(&term.name, &term.value)?;
        lowered.extend(tree.into_addends().into_iter().map(|tree| Lowered {
            name: term.name.clone(),
            dependence: lowering.system.dependence(&tree),
            tree,
        }));
    }
    Ok(lowered)
}

pub(super) fn lower_force(
    lowering: &mut Lowering<'_>,
    force: &Force,
) -> Result<Vec<LoweredForce>, OracleError> {
    let on = lowering.lower_term(&force.name, &force.on)?;
    let dependence = lowering.system.dependence(&on);
    let values = lowering
        .lower_term(&force.name, &force.value)?
        .into_addends();
    let addend = |value| LoweredForce {
        name: force.name.clone(),
        coordinate_tree: on.clone(),
        dependence: dependence.clone(),
        value,
    };
    Ok(values.into_iter().map(addend).collect())
}
