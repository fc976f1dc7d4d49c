//! Constraints that depend on each other.

use eomgen_model_spec::argument::Argument;
use eomgen_model_spec::model::Model;

/// Constraints that depend on each other at every state that satisfies them. The accelerations are unique, but the
/// multipliers are not. The multipliers with the least sum of (s_k lambda_k)^2 are used, with s_k^2 = A_k M^-1 A_k^T.
/// With these scales, the units of the constraints have no effect.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Redundancy {
    /// Groups of constraints that depend on each other, each ascending.
    pub groups: Vec<DependentGroup>,
    /// Indices of the constraints that depend on each other, or have no effect, at the initial state only; ascending.
    pub singular_start: Vec<usize>,
}

/// Constraints that depend on each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DependentGroup {
    /// Indices of the constraints, ascending.
    pub constraints: Vec<usize>,
    /// Number of independent constraints in the group.
    pub rank: usize,
}

impl Redundancy {
    /// Returns the indices of all dependent constraints, ascending.
    pub fn constraints(&self) -> Vec<usize> {
        let groups = self.groups.iter();
        let mut all: Vec<usize> = groups.flat_map(|group| group.constraints.clone()).collect();
        all.sort_unstable();
        all
    }

    /// Returns the number of independent constraints among the dependent ones.
    pub fn rank(&self) -> usize {
        self.groups.iter().map(|group| group.rank).sum()
    }

    /// Returns a note about each group and about a singular initial state.
    pub fn describe(&self, model: &Model) -> Vec<String> {
        let groups = self.groups.iter();
        let groups = groups.map(|group| group.describe(model));
        groups.chain(self.describe_start(model)).collect()
    }

    fn describe_start(&self, model: &Model) -> Option<String> {
        let list = join_names(model, &self.singular_start);
        let reason = match self.singular_start.as_slice() {
            [] => return None,
            [_] => format!("the constraint {list} has no effect there"),
            _ => format!("the constraints {list} depend on each other there"),
        };
        Some(format!(
            "the initial state is a singular position: {reason}; a motion must start elsewhere ({})",
            Argument::State
        ))
    }

    /// Returns the number of redundant constraints: all dependent constraints minus the rank.
    pub fn excess(&self) -> usize {
        self.constraints().len() - self.rank()
    }
}

fn join_names(model: &Model, constraints: &[usize]) -> String {
    let names = constraints.iter();
    let names: Vec<String> = names
        .map(|index| format!("`{}`", model.constraints[*index].name))
        .collect();
    names.join(", ")
}

impl DependentGroup {
    fn describe(&self, model: &Model) -> String {
        let list = join_names(model, &self.constraints);
        let excess = self.constraints.len() - self.rank;
        let verb = if excess == 1 { "is" } else { "are" };
        format!(
            "the constraints {list} depend on each other, and {excess} of them {verb} redundant: the motion is \
             unique, but the multipliers are not; the multipliers with the least norm are used"
        )
    }
}
