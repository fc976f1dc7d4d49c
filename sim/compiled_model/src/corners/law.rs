//! Corner conditions at one surface: rates after transmission through it or reflection from it.

use eomgen_codegen::program::evaluator::Evaluator;
use nalgebra::DVector;

use super::contacts::apply_with_contacts;
use super::sided_point::{Jump, Passage, SidedPoint};

/// Difference of Hamiltonians that counts as zero, relative to their magnitude.
const ENERGY_ROUNDING: f64 = 1e-13;

/// Applies the corner conditions at the surface `place`, with the contacts that push. Returns `None` if the momenta do
/// not determine the rates beyond the surface, or if every choice of contacts is contradictory.
pub(super) fn apply_corner_conditions(
    point: &mut SidedPoint<'_>,
    place: usize,
    side: f64,
) -> Option<Passage> {
    let jump = apply_with_contacts(point, |point| {
        cross_with_active_contacts(point, place, side)
    })?;
    Some(jump.passage)
}

/// Changes the rates for given momenta, with the contacts that push.
pub(super) fn keep_momenta(point: &mut SidedPoint<'_>, momenta: &DVector<f64>) -> Option<()> {
    apply_with_contacts(point, |point| {
        let balance = point.build_balance()?;
        let (rates, impulses) = balance.solve_rates(momenta)?;
        point.set_rates(&rates);
        Some(balance.jump(Passage::Transmitted, impulses))
    })?;
    Some(())
}

/// Applies the corner conditions at the surface `place`, with the active contacts, to the rates of a point. If the
/// motion passes the surface, its side changes to `side`. Returns `None` if the momenta do not determine the rates
/// beyond the surface.
///
/// Notation: v0 are the rates at unchanged momenta, D = dv/dlambda, a = dg/dq D, r is the rate of g at v0, and c is the
/// change of the Hamiltonian at v0. The energy balance is c + r lambda + a lambda^2/2 = 0. The rate of g at the
/// solutions is +-sqrt(r^2 - 2 a c); for transmission it keeps its sign.
fn cross_with_active_contacts(point: &mut SidedPoint<'_>, place: usize, side: f64) -> Option<Jump> {
    let first_side = point.inputs.len() - sides(point.evaluator);
    let direction = if side > 0.0 { 1.0 } else { -1.0 };
    let near = point.build_balance()?;
    let (arrival, row) = &near.values.surfaces[place];
    let row = DVector::from_column_slice(row);
    if direction * arrival <= 0.0 {
        let none = DVector::zeros(near.drift.len());
        return Some(near.jump(Passage::Returned, none));
    }
    let rates = point.rates();
    let own_rate = arrival - row.dot(&rates);
    let old_side = std::mem::replace(&mut point.inputs[first_side + place], side);
    let far = point.build_balance()?;
    let momenta = DVector::from_column_slice(&near.values.momenta);
    let (free, impulses) = far.solve_rates(&momenta)?;
    let work = impulses.dot(&far.drift);
    let (column, reactions) = far.column(&row)?;
    let yielding = row.dot(&column);
    point.set_rates(&free);
    if yielding <= 0.0 {
        return Some(far.jump(Passage::Transmitted, impulses));
    }
    let (before, after) = (near.values.hamiltonian, point.values()?.hamiltonian);
    let mut excess = after - before + work;
    let magnitude = before.abs() + after.abs() + work.abs() + momenta.dot(&rates).abs();
    if excess.abs() <= ENERGY_ROUNDING * magnitude {
        excess = 0.0;
    }
    let rate = row.dot(&free) + own_rate;
    let squared = rate * rate - 2.0 * yielding * excess;
    if squared >= 0.0 {
        let beyond = direction * squared.sqrt();
        let impulse = match direction * rate > 0.0 {
            true => -2.0 * excess / (rate + beyond),
            false => (beyond - rate) / yielding,
        };
        point.set_rates(&(free + column * impulse));
        return Some(far.jump(Passage::Transmitted, impulses + reactions * impulse));
    }
    point.inputs[first_side + place] = old_side;
    let (column, reactions) = near.column(&row)?;
    let impulse = -2.0 * arrival / row.dot(&column);
    point.set_rates(&(&rates + &column * impulse));
    Some(near.jump(Passage::Returned, reactions * impulse))
}

/// Returns the number of sides among the inputs of a program.
pub(super) fn sides(evaluator: &Evaluator) -> usize {
    let corners = evaluator.program().outputs.corners.as_ref();
    corners.map_or(0, |corners| corners.surfaces.len())
}
