//! What is derived on request, of nodes in the equations and of values in the program: the same
//! structure for both.

use std::ops::Range;

use super::output::Output;
use super::regimes::Switch;
use crate::symbolic::graph::Variable;

/// The outputs on request, of nodes `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct Outputs<N, R> {
    /// What was asked for.
    pub kinds: Vec<Output>,
    /// c - f
    pub bias_forces: Option<R>,
    /// M a + c - f, the accelerations a being an argument.
    pub inverse_dynamics: Option<R>,
    /// The rate of each guard along the motion.
    pub guard_rates: Option<Vec<N>>,
    /// Jacobians by state, inputs and parameters: of the rates, then of the observables.
    pub jacobians: Vec<Jacobian<N>>,
    /// Products with the Jacobian of the rates.
    pub products: Option<Products<N, R>>,
    /// The derivative of the gradient of the weighted rates along a direction.
    pub gradient_derivative: Option<GradientDerivative<N>>,
    /// What a regime decides in the accelerations.
    pub regimes: Option<Vec<Switch<N>>>,
    /// The surfaces on which the motion may be held, where their sides are inputs.
    pub sliding: Vec<SlidingSurface<N, R>>,
}

impl<N, R> Default for Outputs<N, R> {
    fn default() -> Self {
        Self {
            kinds: Vec::new(),
            bias_forces: None,
            inverse_dynamics: None,
            guard_rates: None,
            jacobians: Vec::new(),
            products: None,
            gradient_derivative: None,
            regimes: None,
            sliding: Vec::new(),
        }
    }
}

/// A surface with a side, of nodes `N` in the equations or values in the program, and rows `R` of
/// them.
#[derive(Clone, Debug)]
pub struct SlidingSurface<N, R> {
    /// The place of its function g among the numbers of all guards.
    pub guard: usize,
    /// Whether what switches there is midway between both sides where g is exactly 0, as sign(0) is.
    pub is_odd: bool,
    /// Whether the rates are of first degree in the sides.
    pub is_linear: bool,
    /// g', with the sides given.
    pub rate: N,
    /// The derivatives of g' by the sides of all surfaces.
    pub by_sides: Vec<N>,
    /// The derivatives of the accelerations by the surface's own side.
    pub column: R,
    /// Those of the rates of the states of first order.
    pub first_order: Vec<N>,
}

/// Products of the rates' Jacobian by state and inputs.
#[derive(Clone, Debug)]
pub struct Products<N, R> {
    /// The accelerations' rows of the product with a direction; those above are the rates'
    /// part of the direction.
    pub forward: R,
    /// The same rows of the states of first order.
    pub forward_first_order: Vec<N>,
    /// For each variable, the product of the weights with its column, without what the
    /// rates' own rows add.
    pub reverse: Vec<(Variable, N)>,
    /// The product of the weights with the columns by parameters: a Jacobian of one row.
    pub by_parameters: Jacobian<N>,
}

/// How the gradient of the weighted rates changes along a direction: the product of their
/// Hessian, by time, state, inputs and independent parameters in this order, with it.
#[derive(Clone, Debug)]
pub struct GradientDerivative<N> {
    /// The rows that are not zero.
    pub rows: Vec<GradientRow<N>>,
}

/// A row of the derivative of a gradient, or one for each mode of a field.
#[derive(Clone, Debug)]
pub struct GradientRow<N> {
    /// Its place in the order of time, state, inputs and parameters.
    pub first: usize,
    /// How many rows.
    pub count: usize,
    /// Its derivative along the direction, a scalar or a vector over the modes.
    pub value: N,
    /// What it depends on, in the same order: where the Hessian may not be zero.
    pub columns: Vec<Range<usize>>,
}

/// A Jacobian by its structural nonzeros.
#[derive(Clone, Debug)]
pub struct Jacobian<N> {
    /// What it is: `rates_by_state` and so on.
    pub name: &'static str,
    /// How many rows.
    pub rows: usize,
    /// How many columns.
    pub columns: usize,
    /// Its blocks, by rows, then by columns; blocks of the same rows stand together.
    pub entries: Vec<JacobianBlock<N>>,
}

/// A block of structural nonzeros.
#[derive(Clone, Copy, Debug)]
pub struct JacobianBlock<N> {
    /// First row.
    pub row: usize,
    /// How many rows.
    pub rows: usize,
    /// First column.
    pub column: usize,
    /// How many columns.
    pub columns: usize,
    /// Whether only the diagonal is filled.
    pub diagonal: bool,
    /// A scalar, a vector over the rows or columns, or an assembled matrix.
    pub value: N,
}

impl<N> JacobianBlock<N> {
    /// How many nonzeros it has in each of its rows.
    pub fn width(&self) -> usize {
        if self.diagonal { 1 } else { self.columns }
    }
}

/// Where the nonzeros of a block stand among those of the whole Jacobian, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockPlace {
    /// The place of its first nonzero.
    pub start: usize,
    /// How many nonzeros there are in each of its rows, with those of the other blocks of
    /// these rows: the distance from one row to the next.
    pub width: usize,
}

impl<N> Jacobian<N> {
    /// How many structural nonzeros there are.
    pub fn nonzeros(&self) -> usize {
        self.entries.iter().map(|e| e.rows * e.width()).sum()
    }

    /// Where the nonzeros of each block stand among those of the whole Jacobian.
    pub fn places(&self) -> Vec<BlockPlace> {
        let mut places = Vec::with_capacity(self.entries.len());
        let mut start = 0;
        for group in self.entries.chunk_by(|a, b| a.row == b.row) {
            let width: usize = group.iter().map(JacobianBlock::width).sum();
            let mut offset = 0;
            for entry in group {
                places.push(BlockPlace {
                    start: start + offset,
                    width,
                });
                offset += entry.width();
            }
            start += group[0].rows * width;
        }
        places
    }
}
