
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
    let s = direction[3];
    let s_kvw5j = input_direction.u;
    let s_h4ktx = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.c_u2tnq[i]) * direction[1 + i],
    );
    let s_kjdf1 = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.c_axmtw[i]) * direction[1 + i],
    );
    let s_frhzy = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.c_1h1ee[i]) * direction[1 + i],
    );
    let s_ug4n7 = C::read(coefficients.c_1rv2k) * s_kjdf1
        - C::read(coefficients.c_gh9kd) * s_frhzy;
    let s_99y8y = s_kvw5j + C::read(coefficients.c_ehqt7) * s_h4ktx
        - C::read(coefficients.c) * s - C::read(coefficients.c_3esjz) * s_kjdf1;
    let s_m76s9 = s_99y8y - C::read(coefficients.c_4g7wt) * s_ug4n7;
    let s_1cpyt = s_ug4n7 - C::read(coefficients.c_8x3f2) * s_m76s9;
    let s_9gzhp = C::read(coefficients.c_3zzzt) * s_kjdf1
        - C::read(coefficients.c_gj36f) * s_1cpyt
        - C::read(coefficients.c_rtd1j) * s_m76s9;
    let mut s_25bvh = [T::number(0.0); 2];
    for i in 0..2 {
        s_25bvh[i] = C::read(coefficients.c_hy49k[i]) * direction[1 + i]
            - C::read(coefficients.c_mqx2z[i]) * s_9gzhp
            - C::read(coefficients.c_dkurp[i]) * s_1cpyt
            - C::read(coefficients.c_y2pfu[i]) * s_m76s9;
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[i] = direction[3 + i];
    }
    product[3] = C::read(coefficients.c_wcwe9) * s_m76s9;
    for i in 0..2 {
        product[4 + i] = s_25bvh[i];
    }
    product
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
    let s_qqc5z = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.c_6tcqm[i]) * weights[4 + i],
    );
    let s_u18m9 = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.c_a9wqn[i]) * weights[4 + i],
    );
    let s_ksvkz = sum_of_few(
        [(); 2],
        |i| C::read(coefficients.c_amvvt[i]) * weights[4 + i],
    );
    let s_de8du = C::read(coefficients.c_6j633) * s_u18m9
        - C::read(coefficients.c_detg7) * s_ksvkz;
    let s = weights[3];
    let s_294nj = C::read(coefficients.c_su826) * s_u18m9
        + C::read(coefficients.c_wcwe9) * s - C::read(coefficients.c_wcwe9) * s_qqc5z
        - C::read(coefficients.c_8x3f2) * s_de8du;
    let s_3e1ja = s_de8du - C::read(coefficients.c_4g7wt) * s_294nj;
    let s_3j9gf = C::read(coefficients.c_1rv2k) * s_3e1ja
        + C::read(coefficients.c_p7buq) * s_u18m9
        - C::read(coefficients.c_3esjz) * s_294nj;
    let mut s_sgv1e = [T::number(0.0); 2];
    for i in 0..2 {
        s_sgv1e[i] = C::read(coefficients.c_sjz8w[i]) * s_294nj
            + C::read(coefficients.c_axmtw[i]) * s_3j9gf
            - C::read(coefficients.c_y3zfv[i]) * s_3e1ja
            - C::read(coefficients.c_ut126[i]) * weights[4 + i];
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[3 + i] = weights[i];
    }
    product[3] = product[3] + C::read(coefficients.c_mtaz2) * s_294nj;
    for i in 0..2 {
        product[1 + i] = s_sgv1e[i];
    }
    let input_product = Inputs { u: s_294nj };
    (product, input_product)
}

/// Positions of the nonzeros in the matrix of 6 x 6.
pub static RATES_BY_STATE: Pattern<12> = pattern(
    &[
        [0, 3, 3, 3, 1],
        [3, 1, 1, 2, 0],
        [3, 1, 3, 1, 0],
        [4, 2, 1, 2, 0],
        [4, 2, 3, 1, 0],
    ],
);

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
    for i in 0..3 {
        values[i] = T::number(1.0);
    }
    for i in 0..2 {
        values[3 + i] = C::read(coefficients.c_12mdq[i]);
    }
    values[5] = C::read(coefficients.c_rw8gz);
    for i in 0..2 {
        values[6 + 3 * i + i] = values[6 + 3 * i + i] + C::read(coefficients.c_hy49k[i]);
        for j in 0..2 {
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_a42bd[i]) * C::read(coefficients.c_5n7vp[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_qcebd[i]) * C::read(coefficients.c_ppdxh[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_827es[i]) * C::read(coefficients.c_7kqwp[j]);
        }
    }
    for i in 0..2 {
        values[8 + 3 * i] = C::read(coefficients.c_kwk8x[i]);
    }
    values
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
    let theta_dot = state[3];
    let s_qat53 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[1 + i]);
    let s_theta_dot_theta_dot = theta_dot * theta_dot;
    let s_bz2gj = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_3njbg = theta_dot * s_bz2gj;
    let s_dbu4z = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_kpq4n = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_sjgdr = C::read(coefficients.l) * theta_dot + s_kpq4n;
    let s_cz5r3 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_zyd2t = theta_dot + C::read(coefficients.c_1_per_l) * s_cz5r3;
    let s_86a4q = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let s_cpujj = T::number(0.5)
        * (C::read(coefficients.c_ahg92) * s_theta_dot_theta_dot
            + C::read(coefficients.c_2_A_l_l) * s_3njbg
            + C::read(coefficients.c_A_l) * s_dbu4z);
    let s_gwexg = T::number(0.5)
        * (C::read(coefficients.c_f8vqv) * s_theta_dot_theta_dot
            + C::read(coefficients.c_2_rho_l_l) * s_3njbg
            + C::read(coefficients.c_rho_l) * s_dbu4z);
    let s_m84ae = T::number(0.5)
        * (C::read(coefficients.c_rho_A_l_l) * s_theta_dot_theta_dot
            + C::read(coefficients.c_4_rho_A_l) * s_3njbg
            + C::read(coefficients.c_rho_A) * s_dbu4z);
    let s_aswaj = s_m84ae
        + (C::read(coefficients.M_t) * (theta_dot * s_sjgdr)
            - C::read(coefficients.c_J_t_per_l_l) * (s_cz5r3 * s_zyd2t))
        - C::read(coefficients.c_c1qge) * s_86a4q;
    let mut values = [T::number(0.0); OBSERVABLES_BY_PARAMETERS_NONZEROS];
    values[0] = C::read(coefficients.c_minus_1_per_l_l) * s_qat53;
    values[1] = T::number(0.5) * s_theta_dot_theta_dot;
    values[2] = s_cpujj;
    values[3] = s_gwexg;
    values[4] = s_aswaj;
    values[5] = C::read(coefficients.c_tarj2) * s_86a4q;
    values[6] = C::read(coefficients.c_htsvy) * s_86a4q;
    values[7] = T::number(0.5) * (s_sjgdr * s_sjgdr);
    values[8] = T::number(0.5) * (s_zyd2t * s_zyd2t);
    values[9] = -s_theta_dot_theta_dot;
    values
}
