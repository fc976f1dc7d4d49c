//! The switching surfaces of a piecewise-linear model and on which side of each a motion is.

use eomgen_codegen::program::affine::{AffineEvaluator, AffineSystem};

/// On which side of a surface a motion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Its function is not positive.
    Below,
    /// It is positive.
    Above,
    /// Forces on both sides lead back to it.
    Held,
}

impl Side {
    /// Returns the side of a surface with this value of its function.
    pub fn from_value(value: f64) -> Self {
        if value > 0.0 {
            Self::Above
        } else {
            Self::Below
        }
    }
}

/// Surfaces that differ: those of one function and one threshold are one.
#[derive(Clone, Debug)]
pub struct Surfaces {
    /// For each surface the guards that are it.
    pub guards: Vec<Vec<usize>>,
    /// Number of guards.
    count: usize,
}

/// A row of a linear function: of the state, of a unit constant and the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// One per state.
    pub state: Vec<f64>,
    /// A constant and one per input.
    pub given: Vec<f64>,
}

impl Row {
    /// The value of the function.
    pub fn evaluate(&self, state: &[f64], given: &[f64]) -> f64 {
        dot(&self.state, state) + dot(&self.given, given)
    }

    /// Returns the difference from another function.
    pub fn subtract(&self, other: &Self) -> Self {
        let difference = |one: &[f64], other: &[f64]| -> Vec<f64> {
            one.iter().zip(other).map(|(a, b)| a - b).collect()
        };
        Self {
            state: difference(&self.state, &other.state),
            given: difference(&self.given, &other.given),
        }
    }

    /// The value of the function at a state and at inputs without the leading unit constant.
    pub fn evaluate_with_inputs(&self, state: &[f64], inputs: &[f64]) -> f64 {
        dot(&self.state, state) + self.given[0] + dot(&self.given[1..], inputs)
    }
}

/// A sum of products.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A guard's function.
fn row(system: &AffineSystem, guard: usize) -> Row {
    let guards = &system.guards;
    let part = |block: &[f64]| {
        let width = block.len() / guards.rows.max(1);
        block[guard * width..(guard + 1) * width].to_vec()
    };
    let mut given = vec![guards.constant[guard]];
    given.extend(part(&guards.inputs));
    Row {
        state: part(&guards.state),
        given,
    }
}

impl Surfaces {
    /// Returns the surfaces of a model, or `None` if one may move with the side of another, or
    /// depends only on inputs.
    pub fn new(evaluator: &mut AffineEvaluator) -> Option<Self> {
        let count = evaluator.guard_count();
        if evaluator.guards_rest().contains(&true) {
            return None;
        }
        let below = evaluator.system(&vec![0.0; count]);
        let above = evaluator.system(&vec![1.0; count]);
        let mut surfaces: Vec<(Row, Vec<usize>)> = Vec::new();
        for guard in 0..count {
            let function = row(&below, guard);
            if function != row(&above, guard) {
                return None;
            }
            match surfaces.iter_mut().find(|(known, _)| *known == function) {
                Some((_, guards)) => guards.push(guard),
                None => surfaces.push((function, vec![guard])),
            }
        }
        Some(Self {
            guards: surfaces.into_iter().map(|(_, guards)| guards).collect(),
            count,
        })
    }

    /// The function of each surface.
    pub fn rows(&self, system: &AffineSystem) -> Vec<Row> {
        let rows = self.guards.iter().map(|guards| row(system, guards[0]));
        rows.collect()
    }

    /// A number for each guard: its side, or `held` for those that are held.
    pub fn guard_sides(&self, sides: &[Side], held: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut numbers = vec![0.0; self.count];
        for (place, (guards, side)) in self.guards.iter().zip(sides).enumerate() {
            let number = match side {
                Side::Below => 0.0,
                Side::Above => 1.0,
                Side::Held => held(place),
            };
            for guard in guards {
                numbers[*guard] = number;
            }
        }
        numbers
    }
}
