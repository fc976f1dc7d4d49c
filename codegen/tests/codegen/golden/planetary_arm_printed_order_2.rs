impl<T: Scalar> Coefficients<T> {
    /// Prepares the coefficients of these parameters.
    pub fn prepare(parameters: &Parameters<T>) -> Self {
        let _ = core::hint::black_box(&IDENTITY);
        let m = parameters.m;
        let s_1 = T::number(0.5) * m;
        let z_s = parameters.z_s;
        let alpha = parameters.alpha;
        let s_2 = cos(alpha);
        let r_s = s_1 * z_s * s_2;
        let M_s = parameters.M_s;
        let s_3 = r_s * r_s;
        let I_s = M_s * s_3;
        let a_m = parameters.a_m;
        let s_4 = s_2 * s_2;
        let m_p = parameters.m_p;
        let s_5 = T::number(3.0) * m_p / s_4;
        let z_p = parameters.z_p;
        let r_c = s_1 * (z_s + z_p);
        let s_6 = r_c * r_c;
        let s_7 = s_4 * s_6;
        let m_c = parameters.m_c;
        let I_c = m_c * s_6;
        let s_8 = I_c / s_7;
        let rho = parameters.rho;
        let A = parameters.A;
        let l = parameters.l;
        let s_9 = l * l;
        let s_10 = l * s_9;
        let s_11 = T::number(0.3333333333333333) * rho * A * s_10 / s_7;
        let s_12 = s_2 * r_c;
        let s_13 = rho * A;
        let s_14 = s_13 * s_9;
        let s_15 = T::number(0.5) * rho * A * l;
        let mut s_16 = [[T::number(0.0); 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                s_16[i][j] = s_16[i][j]
                    + s_15 * T::number(INTEGRAL_PHI_BY_PHI[i][j]) * T::number(1.0);
                s_16[i][j] = s_16[i][j]
                    + s_15 * T::number(INTEGRAL_PHI_BY_PHI[j][i]) * T::number(1.0);
            }
        }
        let s_17 = cholesky(&s_16);
        let mut M_x_c_q = [T::number(0.0); 2];
        for i in 0..2 {
            M_x_c_q[i] = s_14 * T::number(INTEGRAL_S1_PHI[i]) / s_12;
        }
        let s_18 = cholesky_solve(&s_17, &M_x_c_q);
        let s_19 = sum_of_few([(); 2], |i| T::number(INTEGRAL_S1_PHI[i]) * s_18[i]);
        let pivot_x_c = s_5 + s_8 + s_11 - s_14 * s_19 / s_12;
        let s_20 = pivot_reciprocal(pivot_x_c);
        let c_sp = parameters.c_sp;
        let b_sp = parameters.b_sp;
        let c_pr = parameters.c_pr;
        let b_pr = parameters.b_pr;
        let k_sp = parameters.k_sp;
        let k_pr = parameters.k_pr;
        let E = parameters.E;
        let I = parameters.I;
        let s_21 = T::number(0.5) * E * I / s_10;
        let r_p = s_1 * s_2 * z_p;
        let s_22 = r_p * r_p;
        let M_p = parameters.M_p;
        let I_p = M_p * s_22;
        let s_23 = T::number(3.0) * I_p;
        let b_m = parameters.b_m;
        let F_w = parameters.F_w;
        let omega = parameters.omega;
        let mut s_24 = [T::number(0.0); 2];
        for i in 0..2 {
            s_24[i] = s_20 * s_18[i];
        }
        let M_x_sp_x_sp = I_s / s_3;
        let M_x_sp_x_c = T::number(2.0) * I_s / s_3;
        let pivot_x_pr = s_23 / s_22;
        let M_x_pr_x_pr = M_x_sp_x_sp + pivot_x_pr;
        let M_x_pr_x_c = M_x_sp_x_c + pivot_x_pr;
        let M_x_c_x_c = T::number(4.0) * I_s / s_3 + (pivot_x_pr + s_5) + s_8 + s_11;
        let z_r = parameters.z_r;
        let i_sH = T::number(1.0) + z_r / z_s;
        let s_25 = r_s * i_sH;
        let mut positive_4 = true;
        for i in 0..2 {
            positive_4 = positive_4 && T::all_greater(s_17[i][i], T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_17[i][i]);
        }
        Self {
            a_m: a_m,
            c_1: r_s * a_m / I_s,
            c_2: s_11,
            c_3: s_15,
            c_4: s_17,
            M_x_c_q: M_x_c_q,
            c_5: s_20,
            c_6: T::number(2.0) * s_20,
            c_sp: c_sp,
            c_7: T::number(3.0) * c_sp,
            b_sp: b_sp,
            c_pr: c_pr,
            c_8: T::number(3.0) * c_pr,
            b_pr: b_pr,
            k_sp: k_sp,
            c_9: T::number(3.0) * k_sp,
            k_pr: k_pr,
            c_10: T::number(3.0) * k_pr,
            c_11: s_21,
            c_12: -s_21,
            c_13: T::number(0.3333333333333333) * s_22 / I_p,
            c_14: s_23 * s_20 / s_22,
            c_15: b_m / I_s,
            c_16: s_3 / I_s,
            F_w: F_w,
            c_17: r_s * F_w / I_s,
            omega: omega,
            c_18: s_24,
            M_x_sp_x_sp: M_x_sp_x_sp,
            M_x_sp_x_c: M_x_sp_x_c,
            M_x_pr_x_pr: M_x_pr_x_pr,
            M_x_pr_x_c: M_x_pr_x_c,
            M_x_c_x_c: M_x_c_x_c,
            c_19: T::number(1.0) / r_s,
            c_20: b_m / r_s,
            c_21: T::number(2.0) / r_s,
            c_22: T::number(1.0) / r_p,
            c_23: T::number(1.0) / s_12,
            c_24: T::number(1.0) / s_25,
            c_25: l / s_25,
            c_26: T::number(0.5) * I_s / s_3,
            c_27: T::number(1.5) * I_p / s_22,
            c_28: T::number(1.5) * m_p / s_4,
            c_29: T::number(0.5) * I_c / s_7,
            c_30: T::number(2.0) * rho * A * s_9 / s_12,
            c_31: s_13 * l,
            c_32: T::number(1.5) * k_sp,
            c_33: T::number(1.5) * k_pr,
            positive_definite: T::all_greater(M_x_sp_x_sp, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), M_x_sp_x_sp)
                && T::all_greater(pivot_x_pr, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), pivot_x_pr)
                && T::all_greater(pivot_x_c, T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), pivot_x_c) && positive_4,
        }
    }
}

/// Rates of the state, written to `rates`.
///
/// `t` in s; `state` and the rates in the order of [`STATE_NAMES`].
#[allow(unused_variables)]
pub fn rates_into<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
    rates: &mut [T; STATES],
) {
    let x_sp_dot = state[5];
    let x_sp = state[0];
    let s_1 = coefficients.c_7
        * T::select_greater(
            contact(x_sp, coefficients.b_sp),
            T::number(0.0),
            x_sp_dot,
            T::number(0.0),
        );
    let x_pr_dot = state[6];
    let x_pr = state[1];
    let s_2 = coefficients.c_8
        * T::select_greater(
            contact(x_pr, coefficients.b_pr),
            T::number(0.0),
            x_pr_dot,
            T::number(0.0),
        );
    let s_3 = coefficients.c_9 * deadzone(x_sp, coefficients.b_sp);
    let s_4 = coefficients.c_10 * deadzone(x_pr, coefficients.b_pr);
    let mut s_5 = [T::number(0.0); 2];
    for i in 0..2 {
        for k in 0..2 {
            s_5[i] = s_5[i] + T::number(INTEGRAL_PHI_D2_BY_PHI_D2[i][k]) * state[3 + k];
        }
    }
    let mut s_6 = [T::number(0.0); 2];
    for i in 0..2 {
        for k in 0..2 {
            s_6[i] = s_6[i] + T::number(INTEGRAL_PHI_D2_BY_PHI_D2[k][i]) * state[3 + k];
        }
    }
    let mut s_7 = [T::number(0.0); 2];
    for i in 0..2 {
        s_7[i] = coefficients.c_12 * (s_5[i] + s_6[i]);
    }
    let s_8 = cholesky_solve(&coefficients.c_4, &s_7);
    let s_9 = sum_of_few([(); 2], |i| coefficients.M_x_c_q[i] * s_8[i]);
    let s_10 = s_1 + s_2 + s_3 + s_4 - s_9;
    let s_11 = s_1 + s_3;
    let x_pr_ddot = coefficients.c_13 * (s_11 - s_2 - s_4 - coefficients.c_14 * s_10);
    let x_c_dot = state[7];
    let s_12 = coefficients.c_1 - coefficients.c_6 * s_10 - x_pr_ddot
        - coefficients.c_15 * (x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot)
        - coefficients.c_16 * s_11;
    let x_sp_ddot = s_12 + coefficients.c_17 * sin(coefficients.omega * t);
    let x_c_ddot = coefficients.c_5 * s_10;
    for i in 0..5 {
        rates[i] = state[5 + i];
    }
    rates[5] = x_sp_ddot;
    rates[6] = x_pr_ddot;
    rates[7] = x_c_ddot;
    for i in 0..2 {
        rates[8 + i] = s_8[i] - coefficients.c_18[i] * s_10;
    }
}

/// Mass matrix in the order of the first half of [`STATE_NAMES`].
#[allow(unused_variables, unused_mut)]
pub fn mass_matrix<T: Scalar>(
    t: T,
    state: &[T; STATES],
    inputs: &Inputs,
    coefficients: &Coefficients<T>,
) -> [[T; DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM] {
    let mut values = [[T::number(0.0); DEGREES_OF_FREEDOM]; DEGREES_OF_FREEDOM];
    values[0][0] = coefficients.M_x_sp_x_sp;
    values[0][1] = coefficients.M_x_sp_x_sp;
    values[0][2] = coefficients.M_x_sp_x_c;
    values[1][0] = coefficients.M_x_sp_x_sp;
    values[1][1] = coefficients.M_x_pr_x_pr;
    values[1][2] = coefficients.M_x_pr_x_c;
    values[2][0] = coefficients.M_x_sp_x_c;
    values[2][1] = coefficients.M_x_pr_x_c;
    values[2][2] = coefficients.M_x_c_x_c;
    for i in 0..2 {
        values[2][3 + i] = coefficients.M_x_c_q[i];
        values[3 + i][2] = values[2][3 + i];
    }
    for i in 0..2 {
        for j in 0..2 {
            values[3 + i][3 + j] = values[3 + i][3 + j]
                + coefficients.c_3 * T::number(INTEGRAL_PHI_BY_PHI[i][j])
                    * T::number(1.0);
            values[3 + i][3 + j] = values[3 + i][3 + j]
                + coefficients.c_3 * T::number(INTEGRAL_PHI_BY_PHI[j][i])
                    * T::number(1.0);
        }
    }
    values
}

/// int\[phi_i phi_j], with s = x/l from 0 to 1; primes are derivatives by s
static INTEGRAL_PHI_BY_PHI: [[f64; 2]; 2] = [
    [1.7767246194872084, 48.816451369527094],
    [48.816451369527094, 1388.4455965849631],
];

/// int\[phi_i'' phi_j''], with s = x/l from 0 to 1; primes are derivatives by s
static INTEGRAL_PHI_D2_BY_PHI_D2: [[f64; 2]; 2] = [
    [68.61982276332613, 5502.376932211102],
    [5502.376932211102, 637228.9612064523],
];

/// Computes the lower factor L of a symmetric matrix L L^T; NaN if it is not positive definite.
fn cholesky<T: Scalar, const N: usize>(matrix: &[[T; N]; N]) -> [[T; N]; N] {
    let mut factor = [[T::number(0.0); N]; N];
    for i in 0..N {
        for j in 0..i + 1 {
            let mut rest = matrix[i][j];
            for k in 0..j {
                rest = rest - factor[i][k] * factor[j][k];
            }
            factor[i][j] = if i == j {
                let root = sqrt(rest);
                T::select_greater(rest, T::number(0.0), root, T::number(f64::NAN))
            } else {
                rest / factor[j][j]
            };
        }
    }
    factor
}


/// Solves L L^T x = right.
#[inline(always)]
fn cholesky_solve<T: Scalar, const N: usize>(
    factor: &[[T; N]; N],
    right: &[T; N],
) -> [T; N] {
    let mut x = [T::number(0.0); N];
    for i in 0..N {
        let mut rest = right[i];
        for k in 0..i {
            rest = rest - factor[i][k] * x[k];
        }
        x[i] = rest / factor[i][i];
    }
    for j in 0..N {
        let i = N - 1 - j;
        let mut rest = x[i];
        for k in i + 1..N {
            rest = rest - factor[k][i] * x[k];
        }
        x[i] = rest / factor[i][i];
    }
    x
}

/// Converts a matrix to another type.
#[inline(always)]
fn converted_matrix<T: Scalar, const N: usize, const M: usize>(
    numbers: &[[f64; N]; M],
) -> [[T; N]; M] {
    let mut matrix = [[T::number(0.0); N]; M];
    for i in 0..M {
        matrix[i] = converted(&numbers[i]);
    }
    matrix
}
