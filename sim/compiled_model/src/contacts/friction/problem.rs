//! Contact force problem from the values of impacts at a point.

use eomgen_codegen::program::evaluator::ImpactValues;
use eomgen_sim::contact_friction::{ContactFriction, ContactProblem};

/// Returns the problem of the contacts at `places`. `direction` has the slip directions of the contacts with friction.
/// The rates are those of the distances, then of the slips.
pub(crate) fn build_contact_problem(
    impacts: &[ImpactValues],
    places: &[usize],
    direction: impl Fn(usize) -> Option<f64>,
    rates: &[f64],
) -> ContactProblem {
    let friction = places.iter().map(|place| match &impacts[*place].friction {
        Some(friction) => ContactFriction {
            coefficient: friction.coefficient,
            direction: direction(*place),
        },
        None => ContactFriction::NONE,
    });
    ContactProblem::new(
        friction.collect(),
        &compute_full_delassus(impacts, places),
        rates,
    )
}

/// Returns Delassus' matrix of the normal and the tangential directions, row by row.
pub(crate) fn compute_full_delassus(impacts: &[ImpactValues], places: &[usize]) -> Vec<f64> {
    let tangent_column = |place: usize| {
        let before = impacts[..place].iter();
        let before = before.filter(|impact| impact.friction.is_some()).count();
        impacts[place].friction.as_ref()?;
        Some(impacts.len() + before)
    };
    let normal = places.iter().map(|place| Some(*place));
    let tangents = places.iter().map(|place| tangent_column(*place));
    let columns: Vec<Option<usize>> = normal.chain(tangents).collect();
    let normal = places.iter().map(|place| Some(&impacts[*place].delassus));
    let tangents = places.iter().map(|place| {
        let friction = impacts[*place].friction.as_ref();
        friction.map(|friction| &friction.delassus)
    });
    let entries = normal.chain(tangents).flat_map(|row| {
        let columns = columns.iter();
        columns.map(move |column| row.zip(*column).map_or(0.0, |(row, column)| row[column]))
    });
    entries.collect()
}

/// Returns the accelerations of distances, then of slips, without contact forces.
pub(crate) fn compute_free_accelerations(impacts: &[ImpactValues], places: &[usize]) -> Vec<f64> {
    normal_and_tangential(impacts, places, |impact| {
        let friction = impact.friction.as_ref();
        [
            impact.acceleration,
            friction.map_or(0.0, |friction| friction.acceleration),
        ]
    })
}

/// Returns the rates of distances, then the slips.
pub(crate) fn collect_rates_and_slips(impacts: &[ImpactValues], places: &[usize]) -> Vec<f64> {
    normal_and_tangential(impacts, places, |impact| {
        let friction = impact.friction.as_ref();
        [impact.rate, friction.map_or(0.0, |friction| friction.slip)]
    })
}

fn normal_and_tangential(
    impacts: &[ImpactValues],
    places: &[usize],
    of: impl Fn(&ImpactValues) -> [f64; 2],
) -> Vec<f64> {
    let values = |which: usize| places.iter().map(move |place| (*place, which));
    let all = values(0).chain(values(1));
    all.map(|(place, which)| of(&impacts[place])[which])
        .collect()
}
