//! Constraints that depend on each other.

use eomgen_model_spec::model::Model;

/// Constraints that depend on each other at every state that satisfies them. The accelerations are determined, the
/// multipliers are not: those with the least sum of (s_k lambda_k)^2 are used, with s_k^2 = A_k M^-1 A_k^T, so that
/// the unit of a constraint has no effect.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Redundancy {
    /// Groups of constraints that depend on each other, each ascending.
    pub groups: Vec<DependentGroup>,
}

/// Constraints that depend on each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DependentGroup {
    /// Indices of the constraints, ascending.
    pub constraints: Vec<usize>,
    /// Number of independent ones.
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

    /// Returns a note about each group.
    pub fn describe(&self, model: &Model) -> Vec<String> {
        let groups = self.groups.iter();
        groups.map(|group| group.describe(model)).collect()
    }

    /// Returns the number of constraints beyond those that are needed.
    pub fn excess(&self) -> usize {
        self.constraints().len() - self.rank()
    }
}

impl DependentGroup {
    fn describe(&self, model: &Model) -> String {
        let names = self.constraints.iter();
        let names: Vec<String> = names
            .map(|place| format!("`{}`", model.constraints[*place].name))
            .collect();
        let excess = self.constraints.len() - self.rank;
        let verb = if excess == 1 { "is" } else { "are" };
        format!(
            "the constraints {} depend on each other, and {excess} of them {verb} redundant: the motion is unique, the \
             multipliers are not; those of least norm are used",
            names.join(", ")
        )
    }
}
