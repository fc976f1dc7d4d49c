
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
    let s_1 = input_direction.u;
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_55[i]) * direction[1 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_15[i]) * direction[1 + i]);
    let s_4 = sum_of_few([(); 2], |i| C::read(coefficients.c_63[i]) * direction[1 + i]);
    let s_5 = C::read(coefficients.c_18) * s_3 - C::read(coefficients.c_221) * s_4;
    let s_6 = s_1 + C::read(coefficients.c_90) * s_2 - C::read(coefficients.c) * s
        - C::read(coefficients.c_14) * s_3;
    let s_7 = s_6 - C::read(coefficients.c_16) * s_5;
    let s_8 = s_5 - C::read(coefficients.c_23) * s_7;
    let s_9 = C::read(coefficients.c_25) * s_3 - C::read(coefficients.c_22) * s_8
        - C::read(coefficients.c_24) * s_7;
    let mut s_10 = [T::number(0.0); 2];
    for i in 0..2 {
        s_10[i] = C::read(coefficients.c_29[i]) * direction[1 + i]
            - C::read(coefficients.c_21[i]) * s_9 - C::read(coefficients.c_26[i]) * s_8
            - C::read(coefficients.c_28[i]) * s_7;
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[i] = direction[3 + i];
    }
    product[3] = C::read(coefficients.c_12) * s_7;
    for i in 0..2 {
        product[4 + i] = s_10[i];
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
    let s_1 = sum_of_few([(); 2], |i| C::read(coefficients.c_27[i]) * weights[4 + i]);
    let s_2 = sum_of_few([(); 2], |i| C::read(coefficients.c_223[i]) * weights[4 + i]);
    let s_3 = sum_of_few([(); 2], |i| C::read(coefficients.c_225[i]) * weights[4 + i]);
    let s_4 = C::read(coefficients.c_226) * s_2 - C::read(coefficients.c_224) * s_3;
    let s = weights[3];
    let s_5 = C::read(coefficients.c_222) * s_2 + C::read(coefficients.c_12) * s
        - C::read(coefficients.c_12) * s_1 - C::read(coefficients.c_23) * s_4;
    let s_6 = s_4 - C::read(coefficients.c_16) * s_5;
    let s_7 = C::read(coefficients.c_18) * s_6 + C::read(coefficients.c_228) * s_2
        - C::read(coefficients.c_14) * s_5;
    let mut s_8 = [T::number(0.0); 2];
    for i in 0..2 {
        s_8[i] = C::read(coefficients.c_13[i]) * s_5
            + C::read(coefficients.c_15[i]) * s_7 - C::read(coefficients.c_17[i]) * s_6
            - C::read(coefficients.c_19[i]) * weights[4 + i];
    }
    let mut product = [T::number(0.0); STATES];
    for i in 0..3 {
        product[3 + i] = weights[i];
    }
    product[3] = product[3] + C::read(coefficients.c_227) * s_5;
    for i in 0..2 {
        product[1 + i] = s_8[i];
    }
    let input_product = Inputs { u: s_5 };
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
        values[0 + i] = T::number(1.0);
    }
    for i in 0..2 {
        values[3 + i] = C::read(coefficients.c_41[i]);
    }
    values[5] = C::read(coefficients.c_42);
    for i in 0..2 {
        values[6 + 3 * i + i] = values[6 + 3 * i + i] + C::read(coefficients.c_29[i]);
        for j in 0..2 {
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_43[i]) * C::read(coefficients.c_45[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_46[i]) * C::read(coefficients.c_44[j]);
            values[6 + 3 * i + j] = values[6 + 3 * i + j]
                + C::read(coefficients.c_47[i]) * C::read(coefficients.c_40[j]);
        }
    }
    for i in 0..2 {
        values[8 + 3 * i] = C::read(coefficients.c_48[i]);
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
    let s_1 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[1 + i]);
    let s_2 = theta_dot * theta_dot;
    let s_3 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * state[4 + i]);
    let s_4 = theta_dot * s_3;
    let s_5 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_SQUARED[i]) * (state[4 + i] * state[4 + i]),
    );
    let s_6 = sum_of_few([(); 2], |i| T::number(PHI_AT_END[i]) * state[4 + i]);
    let s_7 = C::read(coefficients.l) * theta_dot + s_6;
    let s_8 = sum_of_few([(); 2], |i| T::number(PHI_D1_AT_END[i]) * state[4 + i]);
    let s_9 = theta_dot + C::read(coefficients.c_33) * s_8;
    let s_10 = sum_of_few(
        [(); 2],
        |i| T::number(INTEGRAL_PHI_D2_SQUARED[i]) * (state[1 + i] * state[1 + i]),
    );
    let s_11 = T::number(0.5)
        * (C::read(coefficients.c_70) * s_2 + C::read(coefficients.c_212) * s_4
            + C::read(coefficients.c_213) * s_5);
    let s_12 = T::number(0.5)
        * (C::read(coefficients.c_86) * s_2 + C::read(coefficients.c_214) * s_4
            + C::read(coefficients.c_215) * s_5);
    let s_13 = T::number(0.5)
        * (C::read(coefficients.c_3) * s_2 + C::read(coefficients.c_216) * s_4
            + C::read(coefficients.c_2) * s_5);
    let s_14 = s_13
        + (C::read(coefficients.M_t) * (theta_dot * s_7)
            - C::read(coefficients.c_217) * (s_8 * s_9))
        - C::read(coefficients.c_218) * s_10;
    let mut values = [T::number(0.0); OBSERVABLES_BY_PARAMETERS_NONZEROS];
    values[0] = C::read(coefficients.c_211) * s_1;
    values[1] = T::number(0.5) * s_2;
    values[2] = s_11;
    values[3] = s_12;
    values[4] = s_14;
    values[5] = C::read(coefficients.c_219) * s_10;
    values[6] = C::read(coefficients.c_220) * s_10;
    values[7] = T::number(0.5) * (s_7 * s_7);
    values[8] = T::number(0.5) * (s_9 * s_9);
    values[9] = -s_2;
    values
}
