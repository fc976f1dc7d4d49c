//! Motion held on switching surfaces, such as sticking under dry friction. The rates on both sides point
//! towards the surface, and the motion follows their convex combination that stays on the surface (Filippov).
//! The weight of either side is again a linear function of the motion. The motion leaves the surface when a
//! weight leaves the interval from 0 to 1.

use eomgen_codegen::program::affine::{AffineEvaluator, AffineRows, AffineSystem};
use nalgebra::{DMatrix, DVector};

use super::event_function::Linear;
use super::parallel_guards::{Cell, ParallelGuards};
use crate::sliding_modes::{MIN_SINGULAR_VALUE_FRACTION, divide_rows};

/// Largest relative residual of a jump that is constant on its surface.
const ROUNDING: f64 = 1e-11;

/// Largest relative residual of the rate of a held function.
const HELD_RATE_TOLERANCE: f64 = 1e-9;

/// Smallest coefficient of a state that may be the pivot of a function, relative to the function's largest
/// coefficient.
const MIN_PIVOT_RATIO: f64 = 1e-6;

/// A regime held on surfaces.
pub(super) struct Sliding {
    /// The equations of motion on the surfaces.
    pub system: AffineSystem,
    /// Weight of the upper side of each surface, 0 to 1.
    pub parts: Vec<Linear>,
}

/// Returns the motion with the cells of all families, some of which are held. Returns `None` if the jumps are
/// not constant on the surfaces or the surfaces do not hold the motion.
pub(super) fn derive_sliding(
    evaluator: &mut AffineEvaluator,
    families: &[ParallelGuards],
    cells: &[Cell],
) -> Option<Sliding> {
    let mut sides = vec![0.0; evaluator.guard_count()];
    let mut base = |held: Option<usize>| {
        for (index, (family, cell)) in families.iter().zip(cells).enumerate() {
            let side = if held == Some(index) { 1.0 } else { 0.0 };
            family.write_sides(*cell, side, &mut sides);
        }
        evaluator.system(&sides)
    };
    let below = base(None);
    let mut rows = Vec::new();
    let mut jumps = Vec::new();
    for (index, (family, cell)) in families.iter().zip(cells).enumerate() {
        let Cell::On(rank) = *cell else { continue };
        let above = base(Some(index));
        let function = family.function(&below);
        let still = [&function.inputs, &function.sines, &function.cosines];
        if still
            .iter()
            .any(|block| block.iter().any(|entry| *entry != 0.0))
        {
            return None;
        }
        let threshold = family.threshold(&below, rank);
        jumps.push(find_constant_jump(
            &below.rates,
            &above.rates,
            &function.state,
            threshold,
        )?);
        rows.push(function.state);
    }
    combine(below, &rows, &jumps)
}

/// Returns the constant jump of the rates across a surface row y = threshold; `None` if it is not constant.
fn find_constant_jump(
    below: &AffineRows,
    above: &AffineRows,
    row: &DVector<f64>,
    threshold: f64,
) -> Option<DVector<f64>> {
    let same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| a == b);
    let driven_alike = same(&below.inputs, &above.inputs)
        && same(&below.sines, &above.sines)
        && same(&below.cosines, &above.cosines);
    if !driven_alike {
        return None;
    }
    let states = row.len();
    let length = row.norm_squared();
    let mut jump = DVector::zeros(states);
    for state in 0..states {
        let range = state * states..(state + 1) * states;
        let pairs = above.state[range.clone()].iter().zip(&below.state[range]);
        let difference = DVector::from_iterator(states, pairs.map(|(a, b)| a - b));
        let along = difference.dot(row) / length;
        let rest = &difference - row * along;
        let scale = above.state.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
        if rest.amax() > ROUNDING * scale {
            return None;
        }
        jump[state] = above.constant[state] - below.constant[state] + along * threshold;
    }
    Some(jump)
}

/// Returns f = f_below + sum of jumps times parts, with parts such that row f = 0 for every row.
fn combine(below: AffineSystem, rows: &[DVector<f64>], jumps: &[DVector<f64>]) -> Option<Sliding> {
    let held = rows.len();
    let projected = DMatrix::from_fn(held, held, |i, j| rows[i].dot(&jumps[j]));
    let (inverse, are_dependent) = invert(&projected)?;
    // parts = -inverse rows f_below.
    let weights = DMatrix::from_fn(held, below.states, |i, state| {
        -(0..held)
            .map(|j| inverse[(i, j)] * rows[j][state])
            .sum::<f64>()
    });
    let rates = &below.rates;
    let states = below.states;
    let of = |block: &[f64], part: usize| -> Vec<f64> {
        let width = block.len() / states.max(1);
        (0..width)
            .map(|column| {
                (0..states)
                    .map(|row| weights[(part, row)] * block[row * width + column])
                    .sum()
            })
            .collect()
    };
    let mut parts: Vec<Linear> = (0..held)
        .map(|part| Linear {
            state: DVector::from_vec(of(&rates.state, part)),
            inputs: of(&rates.inputs, part),
            sines: of(&rates.sines, part),
            cosines: of(&rates.cosines, part),
            constant: of(&rates.constant, part)[0],
        })
        .collect();
    if are_dependent {
        // Among all weights that hold, those nearest to one half are chosen; they have the smallest signs.
        let halves = &inverse * projected.column_sum() * 0.5;
        for (part, half) in parts.iter_mut().zip(&halves) {
            part.constant += 0.5 - half;
        }
    }
    let mut system = below.clone();
    for (part, jump) in parts.iter().zip(jumps) {
        let add = |block: &mut [f64], row: &[f64]| {
            let width = row.len();
            for state in 0..states {
                for (column, entry) in row.iter().enumerate() {
                    block[state * width + column] += jump[state] * entry;
                }
            }
        };
        add(&mut system.rates.state, part.state.as_slice());
        add(&mut system.rates.inputs, &part.inputs);
        add(&mut system.rates.sines, &part.sines);
        add(&mut system.rates.cosines, &part.cosines);
        add(&mut system.rates.constant, &[part.constant]);
    }
    if are_dependent && !rows.iter().all(|row| is_held(&system, &below, row)) {
        return None;
    }
    remove_rate_rounding(&mut system, rows, jumps);
    Some(Sliding { system, parts })
}

/// Inverts the effect of the jumps on the held functions. Returns the pseudoinverse and true if the functions
/// are linearly dependent, otherwise the inverse and false.
fn invert(projected: &DMatrix<f64>) -> Option<(DMatrix<f64>, bool)> {
    if projected.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let (divided, sizes) = divide_rows(projected);
    let values = divided.singular_values();
    let smallest = MIN_SINGULAR_VALUE_FRACTION * values.max();
    let are_dependent = values.min() <= smallest;
    let mut inverse = match are_dependent {
        true => divided.pseudo_inverse(smallest).ok()?,
        false => divided.try_inverse()?,
    };
    for (mut column, size) in inverse.column_iter_mut().zip(&sizes) {
        column.unscale_mut(*size);
    }
    Some((inverse, are_dependent))
}

/// Returns true if a function is constant up to rounding.
fn is_held(system: &AffineSystem, below: &AffineSystem, row: &DVector<f64>) -> bool {
    let pairs = blocks(&system.rates).into_iter().zip(blocks(&below.rates));
    let mut pairs = pairs.map(|(block, below)| (block, block.iter().chain(below)));
    pairs.all(|(block, all)| {
        let width = block.len() / row.len().max(1);
        let size = all.fold(0.0_f64, |most, entry| most.max(entry.abs())) * row.amax();
        (0..width).all(|column| {
            let rate: f64 = (0..row.len())
                .map(|state| row[state] * block[state * width + column])
                .sum();
            rate.abs() <= HELD_RATE_TOLERANCE * size
        })
    })
}

fn blocks(rates: &AffineRows) -> [&Vec<f64>; 5] {
    [
        &rates.state,
        &rates.inputs,
        &rates.sines,
        &rates.cosines,
        &rates.constant,
    ]
}

/// Removes rounding errors from held rates. For each function, the rate of one state that the surfaces affect
/// is computed from the others; it is zero if the function depends on no other state.
fn remove_rate_rounding(system: &mut AffineSystem, rows: &[DVector<f64>], jumps: &[DVector<f64>]) {
    let states = system.states;
    let moved: Vec<usize> = (0..states)
        .filter(|state| jumps.iter().any(|jump| jump[*state] != 0.0))
        .collect();
    // Gauss-Jordan elimination: subtracts the other rows from each row until it has a pivot.
    let mut left = rows.to_vec();
    let mut own: Vec<(usize, DVector<f64>)> = Vec::new();
    while let Some(row) = left.pop() {
        let size = row.amax();
        let row = own
            .iter()
            .fold(row, |row, (state, known)| &row - known * row[*state]);
        let largest = moved
            .iter()
            .copied()
            .max_by(|a, b| row[*a].abs().total_cmp(&row[*b].abs()));
        let Some(state) = largest.filter(|state| row[*state].abs() > MIN_PIVOT_RATIO * size) else {
            continue;
        };
        let row = row.map(|entry| {
            if entry.abs() > ROUNDING * size {
                entry
            } else {
                0.0
            }
        });
        let row = &row / row[state];
        for (_, known) in &mut own {
            *known -= &row * known[state];
        }
        own.push((state, row));
    }
    let rates = &mut system.rates;
    let blocks = [
        &mut rates.state,
        &mut rates.inputs,
        &mut rates.sines,
        &mut rates.cosines,
        &mut rates.constant,
    ];
    for block in blocks {
        let width = block.len() / states;
        for column in 0..width {
            for (state, row) in &own {
                let others = (0..states).filter(|other| other != state && row[*other] != 0.0);
                let rate: f64 = others
                    .map(|other| row[other] * block[other * width + column])
                    .sum();
                block[state * width + column] = -rate;
            }
        }
    }
}
