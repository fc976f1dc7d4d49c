/// Regime of a state: bit k is set if number k of [`guards`] is positive, for up to 32 of
/// them. Crossing a surface flips its bit. SIMD lanes must be in one regime: a bit is set
/// if it is set in all of them.
#[allow(unused_variables)]
pub fn regime<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> u32 {
    inlined_regime(t, state, inputs, coefficients)
}

/// [`regime`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_regime<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> u32 {
    0
}

/// Rates of the state in a regime, written to `rates`. They equal those of [`rates_into`] if
/// [`regime`] is `REGIME` and half-widths are not negative. Outside the regime its equations
/// are continued; on a surface they are those of the regime's side.
///
/// `t` in s; `state` and the rates in the order of [`STATE_NAMES`].
#[allow(unused_variables)]
pub fn rates_in_regime_into<const REGIME: u32, T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    rates: &mut [T; STATES],
) {
    inlined_rates_in_regime_into::<REGIME, _, _>(t, state, inputs, coefficients, rates)
}

/// [`rates_in_regime_into`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_rates_in_regime_into<const REGIME: u32, T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    rates: &mut [T; STATES],
) {
    let q_dot = state[1];
    let force = inputs.force;
    let q_ddot = C::read(coefficients.c_1_per_M)
        * (force - C::read(coefficients.F_v) * q_dot);
    for i in 0..1 {
        rates[i] = state[1 + i];
    }
    rates[1] = q_ddot;
}

/// Bias forces c - f of M q'' + c = f, in the order of the first half of
/// [`STATE_NAMES`]: the additional forces for zero accelerations.
#[allow(unused_variables, unused_mut)]
pub fn bias_forces<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; DEGREES_OF_FREEDOM] {
    inlined_bias_forces(t, state, inputs, coefficients)
}

/// [`bias_forces`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_bias_forces<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; DEGREES_OF_FREEDOM] {
    let q_dot = state[1];
    let force = inputs.force;
    let mut values = [T::number(0.0); DEGREES_OF_FREEDOM];
    values[0] = -(force - C::read(coefficients.F_v) * q_dot);
    values
}

/// Inverse dynamics M a + c - f: the generalised forces needed in addition to
/// those of the model for the accelerations a, in the order of the first half of
/// [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn inverse_dynamics<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    accelerations: &[T; DEGREES_OF_FREEDOM],
) -> [T; DEGREES_OF_FREEDOM] {
    inlined_inverse_dynamics(t, state, inputs, coefficients, accelerations)
}

/// [`inverse_dynamics`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_inverse_dynamics<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    accelerations: &[T; DEGREES_OF_FREEDOM],
) -> [T; DEGREES_OF_FREEDOM] {
    let q_dot = state[1];
    let force = inputs.force;
    let s = accelerations[0];
    let mut values = [T::number(0.0); DEGREES_OF_FREEDOM];
    values[0] = C::read(coefficients.M) * s
        - (force - C::read(coefficients.F_v) * q_dot);
    values
}

/// Rates of the switching surfaces along the motion, with constant inputs.
///
#[allow(unused_variables, unused_mut)]
pub fn guard_rates<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; GUARDS] {
    inlined_guard_rates(t, state, inputs, coefficients)
}

/// [`guard_rates`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_guard_rates<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; GUARDS] {
    let mut values = [T::number(0.0); GUARDS];
    values
}

/// Product of the Jacobian of the rates by state and inputs with a direction: the derivative
/// of the rates along it.
#[allow(unused_variables)]
pub fn jacobian_vector_product<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    direction: &[T; STATES],
    input_direction: &Inputs<T>,
) -> [T; STATES] {
    inlined_jacobian_vector_product(
        t,
        state,
        inputs,
        coefficients,
        direction,
        input_direction,
    )
}

/// [`jacobian_vector_product`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_jacobian_vector_product<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    direction: &[T; STATES],
    input_direction: &Inputs<T>,
) -> [T; STATES] {
    let s = direction[1];
    let s_8q7b6 = input_direction.force;
    let mut product = [T::number(0.0); STATES];
    for i in 0..1 {
        product[i] = direction[1 + i];
    }
    product[1] = C::read(coefficients.c_1_per_M)
        * (s_8q7b6 - C::read(coefficients.F_v) * s);
    product
}

/// Product of weights with the Jacobian of the rates by state and inputs: the gradient of
/// the weighted sum of the rates.
#[allow(unused_variables)]
pub fn vector_jacobian_product<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    weights: &[T; STATES],
) -> ([T; STATES], Inputs<T>) {
    inlined_vector_jacobian_product(t, state, inputs, coefficients, weights)
}

/// [`vector_jacobian_product`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables)]
#[inline(always)]
pub fn inlined_vector_jacobian_product<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    weights: &[T; STATES],
) -> ([T; STATES], Inputs<T>) {
    let s = weights[1];
    let mut product = [T::number(0.0); STATES];
    for i in 0..1 {
        product[1 + i] = weights[i];
    }
    product[1] = product[1] + C::read(coefficients.c_minus_F_v_per_M) * s;
    let input_product = Inputs {
        force: C::read(coefficients.c_1_per_M) * s,
    };
    (product, input_product)
}

/// Product of weights with the Jacobian of the rates by the parameters, in the order of
/// [`PARAMETER_NAMES`]: the gradient of the weighted sum of the rates.
#[allow(unused_variables, unused_mut)]
pub fn vector_jacobian_product_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
    weights: &[T; STATES],
) -> [T; PARAMETERS] {
    inlined_vector_jacobian_product_by_parameters(
        t,
        state,
        inputs,
        coefficients,
        weights,
    )
}

/// [`vector_jacobian_product_by_parameters`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_vector_jacobian_product_by_parameters<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
    weights: &[T; STATES],
) -> [T; PARAMETERS] {
    let q_dot = state[1];
    let force = inputs.force;
    let s = weights[1];
    let mut product = [T::number(0.0); PARAMETERS];
    product[0] = C::read(coefficients.c_minus_1_per_M_M)
        * ((force - C::read(coefficients.F_v) * q_dot) * s);
    product[1] = C::read(coefficients.c_minus_1_per_M) * (q_dot * s);
    product
}

/// Number of structural nonzeros of [`rates_by_state`].
pub const RATES_BY_STATE_NONZEROS: usize = 2;

/// Positions of the nonzeros in the matrix of 2 x 2.
pub static RATES_BY_STATE: Pattern<2> = pattern(&[[0, 1, 1, 1, 1], [1, 1, 1, 1, 0]]);

/// Jacobian of the rates by the state: structural nonzeros, row by row, at the positions
/// given by [`RATES_BY_STATE`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_state<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_STATE_NONZEROS] {
    inlined_rates_by_state(t, state, inputs, coefficients)
}

/// [`rates_by_state`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_rates_by_state<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; RATES_BY_STATE_NONZEROS] {
    let mut values = [T::number(0.0); RATES_BY_STATE_NONZEROS];
    values[0] = T::number(1.0);
    values[1] = C::read(coefficients.c_minus_F_v_per_M);
    values
}

/// Number of structural nonzeros of [`rates_by_inputs`].
pub const RATES_BY_INPUTS_NONZEROS: usize = 1;

/// Positions of the nonzeros in the matrix of 2 x 1.
pub static RATES_BY_INPUTS: Pattern<1> = pattern(&[[1, 1, 0, 1, 0]]);

/// Jacobian of the rates by the inputs: structural nonzeros, row by row, at the positions
/// given by [`RATES_BY_INPUTS`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_inputs<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_INPUTS_NONZEROS] {
    inlined_rates_by_inputs(t, state, inputs, coefficients)
}

/// [`rates_by_inputs`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_rates_by_inputs<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; RATES_BY_INPUTS_NONZEROS] {
    let mut values = [T::number(0.0); RATES_BY_INPUTS_NONZEROS];
    values[0] = C::read(coefficients.c_1_per_M);
    values
}

/// Number of structural nonzeros of [`rates_by_parameters`].
pub const RATES_BY_PARAMETERS_NONZEROS: usize = 2;

/// Positions of the nonzeros in the matrix of 2 x 2.
pub static RATES_BY_PARAMETERS: Pattern<2> = pattern(
    &[[1, 1, 0, 1, 0], [1, 1, 1, 1, 0]],
);

/// Jacobian of the rates by the parameters: structural nonzeros, row by row, at the positions
/// given by [`RATES_BY_PARAMETERS`].
#[allow(unused_variables, unused_mut)]
pub fn rates_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; RATES_BY_PARAMETERS_NONZEROS] {
    inlined_rates_by_parameters(t, state, inputs, coefficients)
}

/// [`rates_by_parameters`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_rates_by_parameters<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; RATES_BY_PARAMETERS_NONZEROS] {
    let q_dot = state[1];
    let force = inputs.force;
    let mut values = [T::number(0.0); RATES_BY_PARAMETERS_NONZEROS];
    values[0] = C::read(coefficients.c_minus_1_per_M_M)
        * (force - C::read(coefficients.F_v) * q_dot);
    values[1] = C::read(coefficients.c_minus_1_per_M) * q_dot;
    values
}

/// Number of structural nonzeros of [`observables_by_state`].
pub const OBSERVABLES_BY_STATE_NONZEROS: usize = 2;

/// Positions of the nonzeros in the matrix of 2 x 2.
pub static OBSERVABLES_BY_STATE: Pattern<2> = pattern(
    &[[0, 1, 1, 1, 0], [1, 1, 1, 1, 0]],
);

/// Jacobian of the observables by the state: structural nonzeros, row by row, at the positions
/// given by [`OBSERVABLES_BY_STATE`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_state<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_STATE_NONZEROS] {
    inlined_observables_by_state(t, state, inputs, coefficients)
}

/// [`observables_by_state`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_observables_by_state<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; OBSERVABLES_BY_STATE_NONZEROS] {
    let q_dot = state[1];
    let s_F_v_q_dot = C::read(coefficients.F_v) * q_dot;
    let force = inputs.force;
    let mut values = [T::number(0.0); OBSERVABLES_BY_STATE_NONZEROS];
    values[0] = C::read(coefficients.M) * q_dot;
    values[1] = force - s_F_v_q_dot - s_F_v_q_dot;
    values
}

/// Number of structural nonzeros of [`observables_by_inputs`].
pub const OBSERVABLES_BY_INPUTS_NONZEROS: usize = 1;

/// Positions of the nonzeros in the matrix of 2 x 1.
pub static OBSERVABLES_BY_INPUTS: Pattern<1> = pattern(&[[1, 1, 0, 1, 0]]);

/// Jacobian of the observables by the inputs: structural nonzeros, row by row, at the positions
/// given by [`OBSERVABLES_BY_INPUTS`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_inputs<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_INPUTS_NONZEROS] {
    inlined_observables_by_inputs(t, state, inputs, coefficients)
}

/// [`observables_by_inputs`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_observables_by_inputs<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; OBSERVABLES_BY_INPUTS_NONZEROS] {
    let q_dot = state[1];
    let mut values = [T::number(0.0); OBSERVABLES_BY_INPUTS_NONZEROS];
    values[0] = q_dot;
    values
}

/// Number of structural nonzeros of [`observables_by_parameters`].
pub const OBSERVABLES_BY_PARAMETERS_NONZEROS: usize = 2;

/// Positions of the nonzeros in the matrix of 2 x 2.
pub static OBSERVABLES_BY_PARAMETERS: Pattern<2> = pattern(
    &[[0, 1, 0, 1, 0], [1, 1, 1, 1, 0]],
);

/// Jacobian of the observables by the parameters: structural nonzeros, row by row, at the positions
/// given by [`OBSERVABLES_BY_PARAMETERS`].
#[allow(unused_variables, unused_mut)]
pub fn observables_by_parameters<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> [T; OBSERVABLES_BY_PARAMETERS_NONZEROS] {
    inlined_observables_by_parameters(t, state, inputs, coefficients)
}

/// [`observables_by_parameters`], inlined into the calling function and compiled for its registers.
#[allow(unused_variables, unused_mut)]
#[inline(always)]
pub fn inlined_observables_by_parameters<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> [T; OBSERVABLES_BY_PARAMETERS_NONZEROS] {
    let q_dot = state[1];
    let s_q_dot_q_dot = q_dot * q_dot;
    let mut values = [T::number(0.0); OBSERVABLES_BY_PARAMETERS_NONZEROS];
    values[0] = T::number(0.5) * s_q_dot_q_dot;
    values[1] = -s_q_dot_q_dot;
    values
}

/// Linearisation about a point: rates + A dx + B du, observables + C dx + D du.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearisation<T = f64> {
    /// Rates at the point.
    pub rates: [T; STATES],
    /// Observables at the point.
    pub observables: [T; OBSERVABLES],
    /// Derivatives of the rates with respect to the state.
    pub A: [[T; STATES]; STATES],
    /// Derivatives of the rates with respect to the inputs.
    pub B: [[T; INPUTS]; STATES],
    /// Derivatives of the observables with respect to the state.
    pub C: [[T; STATES]; OBSERVABLES],
    /// Derivatives of the observables with respect to the inputs.
    pub D: [[T; INPUTS]; OBSERVABLES],
}

/// Linearisation about a point.
pub fn linearise<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) -> Linearisation<T> {
    inlined_linearise(t, state, inputs, coefficients)
}

/// [`linearise`], inlined into the calling function and compiled for its registers.
#[inline(always)]
pub fn inlined_linearise<T: Scalar, C: Coefficient<T>>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<C>,
) -> Linearisation<T> {
    let rates = inlined_rates(t, state, inputs, coefficients);
    let observables = inlined_observables(t, state, inputs, coefficients);
    let rates_by_state = inlined_rates_by_state(t, state, inputs, coefficients);
    let rates_by_inputs = inlined_rates_by_inputs(t, state, inputs, coefficients);
    let observables_by_state = inlined_observables_by_state(
        t,
        state,
        inputs,
        coefficients,
    );
    let observables_by_inputs = inlined_observables_by_inputs(
        t,
        state,
        inputs,
        coefficients,
    );
    Linearisation {
        rates,
        observables,
        A: RATES_BY_STATE.dense(&rates_by_state),
        B: RATES_BY_INPUTS.dense(&rates_by_inputs),
        C: OBSERVABLES_BY_STATE.dense(&observables_by_state),
        D: OBSERVABLES_BY_INPUTS.dense(&observables_by_inputs),
    }
}

/// Positions of the structural nonzeros of a matrix, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern<const N: usize> {
    /// Row of each nonzero.
    pub rows: [usize; N],
    /// Column of each nonzero.
    pub columns: [usize; N],
}
impl<const N: usize> Pattern<N> {
    /// Returns the matrix of `R` rows and `C` columns with these nonzeros.
    pub fn dense<T: Scalar, const R: usize, const C: usize>(
        &self,
        nonzeros: &[T; N],
    ) -> [[T; C]; R] {
        let mut matrix = [[T::number(0.0); C]; R];
        for k in 0..N {
            if let Some(row) = matrix.get_mut(self.rows[k]) {
                if let Some(entry) = row.get_mut(self.columns[k]) {
                    *entry = nonzeros[k];
                }
            }
        }
        matrix
    }
}

/// Expands blocks to positions. A block has first row, rows, first column, columns, and 1 if only
/// its diagonal is filled, else 0. Blocks of the same rows are adjacent.
const fn pattern<const B: usize, const N: usize>(
    blocks: &[[usize; 5]; B],
) -> Pattern<N> {
    let mut pattern = Pattern {
        rows: [0; N],
        columns: [0; N],
    };
    let (mut next, mut first) = (0, 0);
    while first < B {
        let [row, rows, _, _, _] = blocks[first];
        let mut last = first;
        while last < B && blocks[last][0] == row {
            last += 1;
        }
        let mut i = 0;
        while i < rows {
            let mut block = first;
            while block < last {
                let [_, _, column, columns, diagonal] = blocks[block];
                let (column, count) = if diagonal == 1 {
                    (column + i, 1)
                } else {
                    (column, columns)
                };
                let mut j = 0;
                while j < count {
                    pattern.rows[next] = row + i;
                    pattern.columns[next] = column + j;
                    next += 1;
                    j += 1;
                }
                block += 1;
            }
            i += 1;
        }
        first = last;
    }
    pattern
}

/// Step of length h (s) of the classical Runge-Kutta method of order 4, with constant inputs. It is
/// bit-identical to `eomgen simulate --solver fixed`. Switches are not located.
pub fn step<T: Scalar>(
    t: T,
    h: T,
    state: &mut [T; STATES],
    inputs: &Inputs<T>,
    coefficients: &Coefficients<T>,
) {
    let mut k1 = [T::number(0.0); STATES];
    let mut k2 = [T::number(0.0); STATES];
    let mut k3 = [T::number(0.0); STATES];
    let mut k4 = [T::number(0.0); STATES];
    let mut stage = [T::number(0.0); STATES];
    let half = T::number(0.5) * h;
    let sixth = h / T::number(6.0);
    rates_into(t, state, inputs, coefficients, &mut k1);
    for i in 0..STATES {
        stage[i] = state[i] + half * k1[i];
    }
    rates_into(t + half, &stage, inputs, coefficients, &mut k2);
    for i in 0..STATES {
        stage[i] = state[i] + half * k2[i];
    }
    rates_into(t + half, &stage, inputs, coefficients, &mut k3);
    for i in 0..STATES {
        stage[i] = state[i] + h * k3[i];
    }
    rates_into(t + h, &stage, inputs, coefficients, &mut k4);
    for i in 0..STATES {
        let inner = k2[i] + k3[i];
        state[i] = state[i] + sixth * (k1[i] + k4[i] + T::number(2.0) * inner);
    }
}

