//! Switching surfaces of a piecewise-linear model, and the side of each on which a motion is.

use eomgen_codegen::program::affine::{AffineEvaluator, AffineSystem};

/// Side of a surface on which a motion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The function of the surface is not positive.
    Below,
    /// The function of the surface is positive.
    Above,
    /// The surface holds the motion: the rates on both sides point towards it.
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

/// Distinct surfaces: guards with the same function and threshold share one.
#[derive(Clone, Debug)]
pub struct Surfaces {
    /// Indices of the guards of each surface.
    pub guards: Vec<Vec<usize>>,
    /// Number of guards.
    count: usize,
}

/// Coefficients of a linear function of the state, a unit constant and the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Coefficient of each state.
    pub state: Vec<f64>,
    /// Constant, then the coefficient of each input.
    pub given: Vec<f64>,
}

impl Row {
    /// Returns the value of the function.
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

    /// Returns the value of the function at a state and at inputs without the leading unit constant.
    pub fn evaluate_with_inputs(&self, state: &[f64], inputs: &[f64]) -> f64 {
        dot(&self.state, state) + self.given[0] + dot(&self.given[1..], inputs)
    }
}

/// Returns the scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the function of a guard.
fn guard_row(system: &AffineSystem, guard: usize) -> Row {
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
    /// Returns the surfaces of a model, or `None` if the function of a surface depends on the side of another
    /// surface, or only on inputs.
    pub fn new(evaluator: &mut AffineEvaluator) -> Option<Self> {
        let count = evaluator.guard_count();
        if evaluator.guards_rest().contains(&true) {
            return None;
        }
        let below = evaluator.system(&vec![0.0; count]);
        let above = evaluator.system(&vec![1.0; count]);
        let mut surfaces: Vec<(Row, Vec<usize>)> = Vec::new();
        for guard in 0..count {
            let function = guard_row(&below, guard);
            if function != guard_row(&above, guard) {
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

    /// Returns the function of each surface.
    pub fn rows(&self, system: &AffineSystem) -> Vec<Row> {
        let rows = self
            .guards
            .iter()
            .map(|guards| guard_row(system, guards[0]));
        rows.collect()
    }

    /// Returns the number of each guard by its side: 0 below, 1 above, and `held` of the surface on a holding
    /// surface.
    pub fn guard_sides(&self, sides: &[Side], held: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut numbers = vec![0.0; self.count];
        for (index, (guards, side)) in self.guards.iter().zip(sides).enumerate() {
            let number = match side {
                Side::Below => 0.0,
                Side::Above => 1.0,
                Side::Held => held(index),
            };
            for guard in guards {
                numbers[*guard] = number;
            }
        }
        numbers
    }
}
