
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
    let s_9a1vw = coefficients.c_3_c_sp
        * chosen(
            touching(positive(REGIME, 0), positive(REGIME, 1)),
            x_sp_dot,
            T::number(0.0),
        );
    let x_pr_dot = state[6];
    let x_pr = state[1];
    let s_rt6xq = coefficients.c_3_c_pr
        * chosen(
            touching(positive(REGIME, 2), positive(REGIME, 3)),
            x_pr_dot,
            T::number(0.0),
        );
    let s_jbryk = coefficients.c_3_k_sp
        * deadzone_on_side(
            positive(REGIME, 0),
            positive(REGIME, 1),
            x_sp,
            coefficients.b_sp,
        );
    let s_hfjv2 = coefficients.c_3_k_pr
        * deadzone_on_side(
            positive(REGIME, 2),
            positive(REGIME, 3),
            x_pr,
            coefficients.b_pr,
        );
    let s_jnh3q = sum_of_few([(); 2], |i| coefficients.c_us4xw[i] * state[3 + i]);
    let s_7z7df = s_9a1vw + s_rt6xq + s_jbryk + s_hfjv2 + s_jnh3q;
    let s_3tfc6 = s_9a1vw + s_jbryk;
    let x_pr_ddot = coefficients.c_mttba
        * (s_3tfc6 - s_rt6xq - s_hfjv2 - coefficients.c_en65n * s_7z7df);
    let x_c_dot = state[7];
    let s_5me8n = coefficients.c_r_s_a_m_per_I_s - coefficients.c_79h79 * s_7z7df
        - x_pr_ddot
        - coefficients.c_b_m_per_I_s * (x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot)
        - coefficients.c_r_s_r_s_per_I_s * s_3tfc6;
    let x_sp_ddot = s_5me8n
        + coefficients.c_r_s_F_w_per_I_s * sin(coefficients.omega * t);
    let x_c_ddot = coefficients.c_5f1my * s_7z7df;
    for i in 0..5 {
        rates[i] = state[5 + i];
    }
    rates[5] = x_sp_ddot;
    rates[6] = x_pr_ddot;
    rates[7] = x_c_ddot;
    for i in 0..2 {
        rates[8 + i] = coefficients.c_hy49k[i] * state[3 + i]
            - coefficients.c_hxhuh[i] * s_7z7df;
    }
}
