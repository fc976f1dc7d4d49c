
/// Regime of a state: bit k is set if number k of [`guards`] is positive, for up to 32 of
/// them. Crossing a surface flips its bit. SIMD lanes must be in one regime: a bit is set
/// if it is set in all of them.
#[allow(unused_variables)]
pub fn regime<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> u32 {
    let guards = guards(t, state, inputs, coefficients);
    let mut regime = 0;
    for k in 0..4 {
        if T::all_greater(guards[k], T::number(0.0)) {
            regime = regime | 1 << k;
        }
    }
    regime
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
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
    rates: &mut [T; STATES],
) {
    let x_sp_dot = state[5];
    let x_sp = state[0];
    let s_1 = coefficients.c_5
        * chosen(
            touching(positive(REGIME, 0), positive(REGIME, 1)),
            x_sp_dot,
            T::number(0.0),
        );
    let x_pr_dot = state[6];
    let x_pr = state[1];
    let s_2 = coefficients.c_6
        * chosen(
            touching(positive(REGIME, 2), positive(REGIME, 3)),
            x_pr_dot,
            T::number(0.0),
        );
    let s_3 = coefficients.c_7
        * deadzone_on_side(
            positive(REGIME, 0),
            positive(REGIME, 1),
            x_sp,
            coefficients.b_sp,
        );
    let s_4 = coefficients.c_8
        * deadzone_on_side(
            positive(REGIME, 2),
            positive(REGIME, 3),
            x_pr,
            coefficients.b_pr,
        );
    let s_5 = sum_of_few([(); 2], |i| coefficients.c_9[i] * state[3 + i]);
    let s_6 = s_1 + s_2 + s_3 + s_4 + s_5;
    let s_7 = s_1 + s_3;
    let x_pr_ddot = coefficients.c_10 * (s_7 - s_2 - s_4 - coefficients.c_11 * s_6);
    let x_c_dot = state[7];
    let s_8 = coefficients.c_1 - coefficients.c_4 * s_6 - x_pr_ddot
        - coefficients.c_12 * (x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot)
        - coefficients.c_13 * s_7;
    let x_sp_ddot = s_8 + coefficients.c_14 * sin(coefficients.omega * t);
    let x_c_ddot = coefficients.c_3 * s_6;
    for i in 0..5 {
        rates[i] = state[5 + i];
    }
    rates[5] = x_sp_ddot;
    rates[6] = x_pr_ddot;
    rates[7] = x_c_ddot;
    for i in 0..2 {
        rates[8 + i] = coefficients.c_16[i] * state[3 + i] - coefficients.c_15[i] * s_6;
    }
}
