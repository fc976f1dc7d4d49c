//! Structure of the requested outputs, for nodes of the equations and for values of the program.

use std::ops::Range;

use super::output::Output;
use crate::symbolic::variable::Variable;

/// Requested outputs, with nodes or values `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct Outputs<N, R> {
    /// Requested outputs by name.
    pub kinds: Vec<Output>,
    /// Bias forces c - f.
    pub bias_forces: Option<R>,
    /// Inverse dynamics M a + c - f for given accelerations a.
    pub inverse_dynamics: Option<R>,
    /// Rate of each guard along the motion.
    pub guard_rates: Option<Vec<N>>,
    /// Jacobians by state, inputs and parameters: first of the rates, then of the observables.
    pub jacobians: Vec<Jacobian<N>>,
    /// Products with the Jacobian of the rates.
    pub products: Option<Products<N, R>>,
    /// Derivative of the gradient of the weighted rates along a direction.
    pub gradient_derivative: Option<GradientDerivative<N>>,
    /// Sticking frictions and contacts for steps of fixed length; `None` if the model has neither.
    pub reactions: Option<Reactions<N, R>>,
    /// Piecewise functions of the accelerations whose branches a regime determines.
    pub regimes: Option<Vec<Switch<N>>>,
    /// Surfaces along which the motion can slide, if their sides are inputs.
    pub sliding: Vec<SlidingSurface<N, R>>,
    /// Other surfaces whose sides are inputs, before those of `sliding`.
    pub sides: Vec<Side>,
    /// Momenta and energy at corners of the motion, if the sides of their surfaces are inputs.
    pub corners: Option<Corners<N, R>>,
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
            reactions: None,
            regimes: None,
            sliding: Vec::new(),
            sides: Vec::new(),
            corners: None,
        }
    }
}

/// Surface along which the motion can slide, with nodes or values `N` and rows `R` of them.
#[derive(Clone, Debug)]
pub struct SlidingSurface<N, R> {
    /// Index of its function g among all guard values.
    pub guard: usize,
    /// Index of the velocity v of which the function is a component, if the side replaces a component of
    /// v/norm(v).
    pub disc: Option<usize>,
    /// True if the piecewise function at g = 0 is the mean of its values on both sides, as sign(0) is.
    pub is_odd: bool,
    /// True if the rates are of first degree in the sides.
    pub is_linear: bool,
    /// Rate g' for given sides.
    pub rate: N,
    /// Derivatives of g' by the sides of all surfaces.
    pub by_sides: Vec<N>,
    /// Derivatives of the accelerations by the side of this surface.
    pub column: R,
    /// Derivatives of the first-order rates by the side of this surface.
    pub first_order: Vec<N>,
}

/// Reactions in a step of fixed length, with nodes or values `N` and rows `R` of them: first the frictions that can
/// stick, then the forces of the contacts, then the frictions of the contacts.
///
/// A reaction is an impulse over the step. For a friction, it is the integral of the sign, whose magnitude is at most
/// the step size. For a contact, it is the integral of the force.
#[derive(Clone, Debug)]
pub struct Reactions<N, R> {
    /// Accelerations with the sides of the frictions as an [argument](crate::symbolic::variable::Argument::Sides).
    pub accelerations: R,
    /// Rates of the first-order states with these sides.
    pub first_order_rates: Vec<N>,
    /// Function that each reaction keeps at 0: the switching function of a friction, the rate of a contact's
    /// distance, the slip of a contact.
    pub functions: Vec<N>,
    /// Change of the rates of coordinates and modes, and of the first-order states, per unit of each reaction.
    pub columns: Vec<(R, Vec<N>)>,
    /// Change of each function per unit of each reaction, row by row.
    pub effects: Vec<N>,
    /// Distances of the contacts.
    pub distances: Vec<N>,
    /// Coefficients of restitution of the contacts.
    pub restitutions: Vec<N>,
    /// Friction coefficients of the contacts with friction, each with the index of the contact.
    pub coefficients: Vec<(usize, N)>,
}

/// Numbers of reactions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReactionCounts {
    /// Number of frictions that can stick.
    pub sides: usize,
    /// Number of contacts.
    pub contacts: usize,
    /// Number of all reactions.
    pub reactions: usize,
}

impl<N, R> Reactions<N, R> {
    /// Returns the number of frictions that can stick.
    pub fn sides(&self) -> usize {
        self.functions.len() - self.distances.len() - self.coefficients.len()
    }

    /// Returns the numbers of reactions.
    pub fn counts(&self) -> ReactionCounts {
        ReactionCounts {
            sides: self.sides(),
            contacts: self.distances.len(),
            reactions: self.functions.len(),
        }
    }
}

/// Surface whose side is an input: 1 if its function is positive, else 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Side {
    /// Index of its function among all guard values.
    pub guard: usize,
    /// True if the piecewise function on the surface is the mean of its values on both sides, as sign(0) is.
    pub is_odd: bool,
}

/// Quantities that determine the rates after a corner, with nodes or values `N` and rows `R` of them. The mass matrix
/// of the program also depends on the sides.
#[derive(Clone, Debug)]
pub struct Corners<N, R> {
    /// Momenta p = dL/dq'.
    pub momenta: R,
    /// Hamiltonian p q' - L.
    pub hamiltonian: N,
    /// Energy T + V.
    pub energy: N,
    /// Surfaces, in the order of their sides.
    pub surfaces: Vec<RateRow<N, R>>,
    /// Constraints.
    pub constraints: Vec<RateRow<N, R>>,
}

/// Rate of a function, and its derivatives with respect to the rates of the coordinates.
#[derive(Clone, Debug)]
pub struct RateRow<N, R> {
    /// Index of the function among all guard values, or among the constraints.
    pub place: usize,
    /// Rate.
    pub rate: N,
    /// Derivatives of the rate.
    pub row: R,
}

/// Products with the rates' Jacobian by state and inputs.
#[derive(Clone, Debug)]
pub struct Products<N, R> {
    /// Rows of the accelerations in the product with a direction. The rows of the coordinates, which come first, are
    /// components of the direction.
    pub forward: R,
    /// Rows of the first-order states in the product with a direction.
    pub forward_first_order: Vec<N>,
    /// Product of the weights with the column of each variable, without the contribution of the weights of
    /// the coordinates' rates.
    pub reverse: Vec<(Variable, N)>,
    /// Product of the weights with the columns by parameters: a Jacobian of one row.
    pub by_parameters: Jacobian<N>,
}

/// Derivative of the gradient of the weighted rates along a direction: the product of the Hessian, by time,
/// state, inputs and independent parameters, with the direction.
#[derive(Clone, Debug)]
pub struct GradientDerivative<N> {
    /// Rows that are not zero.
    pub rows: Vec<GradientRow<N>>,
}

/// Row of the derivative of a gradient, or one row for each mode of a field.
#[derive(Clone, Debug)]
pub struct GradientRow<N> {
    /// Index in the order time, state, inputs, parameters.
    pub first: usize,
    /// Number of rows.
    pub count: usize,
    /// Derivative along the direction, a scalar or a vector over the modes.
    pub value: N,
    /// Columns of the structural nonzeros of the Hessian, in the same order of variables.
    pub columns: Vec<Range<usize>>,
}

/// Jacobian, stored by its structural nonzeros.
#[derive(Clone, Debug)]
pub struct Jacobian<N> {
    /// Name, for example `rates_by_state`.
    pub name: &'static str,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Blocks by rows, then by columns; blocks of the same rows are adjacent.
    pub entries: Vec<JacobianBlock<N>>,
}

/// Block of structural nonzeros.
#[derive(Clone, Copy, Debug)]
pub struct JacobianBlock<N> {
    /// First row.
    pub row: usize,
    /// Number of rows.
    pub rows: usize,
    /// First column.
    pub column: usize,
    /// Number of columns.
    pub columns: usize,
    /// True if only the diagonal is filled.
    pub diagonal: bool,
    /// Scalar, vector over the rows or columns, or assembled matrix.
    pub value: N,
}

impl<N> JacobianBlock<N> {
    /// Returns the number of nonzeros in each row of the block.
    pub fn width(&self) -> usize {
        if self.diagonal { 1 } else { self.columns }
    }
}

/// Position of a block among the nonzeros of the whole Jacobian, row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockPlace {
    /// Index of the first nonzero.
    pub start: usize,
    /// Number of nonzeros in each row, including those of other blocks; it is the distance from one row to the next.
    pub width: usize,
}

impl<N> Jacobian<N> {
    /// Returns the number of structural nonzeros.
    pub fn nonzeros(&self) -> usize {
        self.entries.iter().map(|e| e.rows * e.width()).sum()
    }

    /// Returns the position of each block among the nonzeros of the whole Jacobian.
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

/// Largest number of surfaces in a regime number, which has one bit for each surface.
pub const SURFACES_OF_A_REGIME: usize = u32::BITS as usize;

/// Piecewise function in the accelerations, as a node or value `N`, whose branch a regime determines.
#[derive(Clone, Copy, Debug)]
pub struct Switch<N> {
    /// Value of the function.
    pub value: N,
    /// Surfaces that determine the branch.
    pub decided: Decision,
}

/// Surfaces that determine a branch, by their indices among all guard values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// Dead zone or contact; the switching functions are p - b and p + b.
    Between {
        /// Index of p - b.
        above: usize,
        /// Index of p + b.
        beyond: usize,
    },
    /// Sign or contact that can be zero for a whole regime; the switching functions are p - b and -p - b, with b = 0
    /// for a sign.
    Outside {
        /// Index of p - b.
        above: usize,
        /// Index of -p - b.
        below: usize,
    },
    /// Other piecewise function with a single surface.
    Surface(usize),
    /// Selection by a > b with the switching function b - a, or `above(p)` with the switching function -p.
    NegatedSurface(usize),
}
