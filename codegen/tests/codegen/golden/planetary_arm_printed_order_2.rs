impl<T: Scalar> Coefficients<T> {
    /// Prepares the coefficients of these parameters.
    pub fn prepare(parameters: &Parameters<T>) -> Self {
        let _ = core::hint::black_box(&IDENTITY);
        let m = parameters.m;
        let s_79w6g = T::number(0.5) * m;
        let z_s = parameters.z_s;
        let alpha = parameters.alpha;
        let s_rrfp8 = cos(alpha);
        let r_s = s_79w6g * z_s * s_rrfp8;
        let M_s = parameters.M_s;
        let s_r_s_r_s = r_s * r_s;
        let I_s = M_s * s_r_s_r_s;
        let a_m = parameters.a_m;
        let s_z14ky = s_rrfp8 * s_rrfp8;
        let m_p = parameters.m_p;
        let s_hppb7 = T::number(3.0) * m_p / s_z14ky;
        let z_p = parameters.z_p;
        let r_c = s_79w6g * (z_s + z_p);
        let s_r_c_r_c = r_c * r_c;
        let s_dmnvh = s_z14ky * s_r_c_r_c;
        let m_c = parameters.m_c;
        let I_c = m_c * s_r_c_r_c;
        let s_f4jtk = I_c / s_dmnvh;
        let rho = parameters.rho;
        let A = parameters.A;
        let l = parameters.l;
        let s_l_l = l * l;
        let s_l_l_l = l * s_l_l;
        let s_1u3rt = T::number(0.3333333333333333) * rho * A * s_l_l_l / s_dmnvh;
        let s_ctt33 = s_rrfp8 * r_c;
        let s_rho_A = rho * A;
        let s_rho_A_l_l = s_rho_A * s_l_l;
        let s_2z827 = T::number(0.5) * rho * A * l;
        let mut s_r97tz = [[T::number(0.0); 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                s_r97tz[i][j] = s_r97tz[i][j]
                    + s_2z827 * T::number(INTEGRAL_PHI_BY_PHI[i][j]) * T::number(1.0);
                s_r97tz[i][j] = s_r97tz[i][j]
                    + s_2z827 * T::number(INTEGRAL_PHI_BY_PHI[j][i]) * T::number(1.0);
            }
        }
        let s_qmcbf = cholesky(&s_r97tz);
        let mut M_x_c_q = [T::number(0.0); 2];
        for i in 0..2 {
            M_x_c_q[i] = s_rho_A_l_l * T::number(INTEGRAL_S1_PHI[i]) / s_ctt33;
        }
        let s_bvudq = cholesky_solve(&s_qmcbf, &M_x_c_q);
        let s_tdpv7 = sum_of_few(
            [(); 2],
            |i| T::number(INTEGRAL_S1_PHI[i]) * s_bvudq[i],
        );
        let pivot_x_c = s_hppb7 + s_f4jtk + s_1u3rt - s_rho_A_l_l * s_tdpv7 / s_ctt33;
        let s_5f1my = pivot_reciprocal(pivot_x_c);
        let c_sp = parameters.c_sp;
        let b_sp = parameters.b_sp;
        let c_pr = parameters.c_pr;
        let b_pr = parameters.b_pr;
        let k_sp = parameters.k_sp;
        let k_pr = parameters.k_pr;
        let E = parameters.E;
        let I = parameters.I;
        let s_bsgvc = T::number(0.5) * E * I / s_l_l_l;
        let r_p = s_79w6g * s_rrfp8 * z_p;
        let s_r_p_r_p = r_p * r_p;
        let M_p = parameters.M_p;
        let I_p = M_p * s_r_p_r_p;
        let s_3_I_p = T::number(3.0) * I_p;
        let b_m = parameters.b_m;
        let F_w = parameters.F_w;
        let omega = parameters.omega;
        let mut s_3n7zt = [T::number(0.0); 2];
        for i in 0..2 {
            s_3n7zt[i] = s_5f1my * s_bvudq[i];
        }
        let M_x_sp_x_sp = I_s / s_r_s_r_s;
        let M_x_sp_x_c = T::number(2.0) * I_s / s_r_s_r_s;
        let pivot_x_pr = s_3_I_p / s_r_p_r_p;
        let M_x_pr_x_pr = M_x_sp_x_sp + pivot_x_pr;
        let M_x_pr_x_c = M_x_sp_x_c + pivot_x_pr;
        let M_x_c_x_c = T::number(4.0) * I_s / s_r_s_r_s + (pivot_x_pr + s_hppb7)
            + s_f4jtk + s_1u3rt;
        let z_r = parameters.z_r;
        let i_sH = T::number(1.0) + z_r / z_s;
        let s_r_s_i_sH = r_s * i_sH;
        let mut positive_4 = true;
        for i in 0..2 {
            positive_4 = positive_4 && T::all_greater(s_qmcbf[i][i], T::number(0.0))
                && T::all_greater(T::number(f64::INFINITY), s_qmcbf[i][i]);
        }
        Self {
            a_m: a_m,
            c_r_s_a_m_per_I_s: r_s * a_m / I_s,
            c_1u3rt: s_1u3rt,
            c_2z827: s_2z827,
            c_qmcbf: s_qmcbf,
            M_x_c_q: M_x_c_q,
            c_5f1my: s_5f1my,
            c_79h79: T::number(2.0) * s_5f1my,
            c_sp: c_sp,
            c_3_c_sp: T::number(3.0) * c_sp,
            b_sp: b_sp,
            c_pr: c_pr,
            c_3_c_pr: T::number(3.0) * c_pr,
            b_pr: b_pr,
            k_sp: k_sp,
            c_3_k_sp: T::number(3.0) * k_sp,
            k_pr: k_pr,
            c_3_k_pr: T::number(3.0) * k_pr,
            c_bsgvc: s_bsgvc,
            c_fr34v: -s_bsgvc,
            c_mttba: T::number(0.3333333333333333) * s_r_p_r_p / I_p,
            c_en65n: s_3_I_p * s_5f1my / s_r_p_r_p,
            c_b_m_per_I_s: b_m / I_s,
            c_r_s_r_s_per_I_s: s_r_s_r_s / I_s,
            F_w: F_w,
            c_r_s_F_w_per_I_s: r_s * F_w / I_s,
            omega: omega,
            c_3n7zt: s_3n7zt,
            M_x_sp_x_sp: M_x_sp_x_sp,
            M_x_sp_x_c: M_x_sp_x_c,
            M_x_pr_x_pr: M_x_pr_x_pr,
            M_x_pr_x_c: M_x_pr_x_c,
            M_x_c_x_c: M_x_c_x_c,
            c_1_per_r_s: T::number(1.0) / r_s,
            c_b_m_per_r_s: b_m / r_s,
            c_2_per_r_s: T::number(2.0) / r_s,
            c_1_per_r_p: T::number(1.0) / r_p,
            c_72jmj: T::number(1.0) / s_ctt33,
            c_1_per_r_s_i_sH: T::number(1.0) / s_r_s_i_sH,
            c_l_per_r_s_i_sH: l / s_r_s_i_sH,
            c_tqaqf: T::number(0.5) * I_s / s_r_s_r_s,
            c_k4tad: T::number(1.5) * I_p / s_r_p_r_p,
            c_uxvby: T::number(1.5) * m_p / s_z14ky,
            c_r6kbz: T::number(0.5) * I_c / s_dmnvh,
            c_y853x: T::number(2.0) * rho * A * s_l_l / s_ctt33,
            c_rho_A_l: s_rho_A * l,
            c_x6cxe: T::number(1.5) * k_sp,
            c_ydxtm: T::number(1.5) * k_pr,
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
    let s_9a1vw = coefficients.c_3_c_sp
        * T::select_greater(
            contact(x_sp, coefficients.b_sp),
            T::number(0.0),
            x_sp_dot,
            T::number(0.0),
        );
    let x_pr_dot = state[6];
    let x_pr = state[1];
    let s_rt6xq = coefficients.c_3_c_pr
        * T::select_greater(
            contact(x_pr, coefficients.b_pr),
            T::number(0.0),
            x_pr_dot,
            T::number(0.0),
        );
    let s_jbryk = coefficients.c_3_k_sp * deadzone(x_sp, coefficients.b_sp);
    let s_hfjv2 = coefficients.c_3_k_pr * deadzone(x_pr, coefficients.b_pr);
    let mut s_quf7q = [T::number(0.0); 2];
    for i in 0..2 {
        for k in 0..2 {
            s_quf7q[i] = s_quf7q[i]
                + T::number(INTEGRAL_PHI_D2_BY_PHI_D2[i][k]) * state[3 + k];
        }
    }
    let mut s_vynrj = [T::number(0.0); 2];
    for i in 0..2 {
        for k in 0..2 {
            s_vynrj[i] = s_vynrj[i]
                + T::number(INTEGRAL_PHI_D2_BY_PHI_D2[k][i]) * state[3 + k];
        }
    }
    let mut s_qez5g = [T::number(0.0); 2];
    for i in 0..2 {
        s_qez5g[i] = coefficients.c_fr34v * (s_quf7q[i] + s_vynrj[i]);
    }
    let s_bdj51 = cholesky_solve(&coefficients.c_qmcbf, &s_qez5g);
    let s_cf4yw = sum_of_few([(); 2], |i| coefficients.M_x_c_q[i] * s_bdj51[i]);
    let s_ysw27 = s_9a1vw + s_rt6xq + s_jbryk + s_hfjv2 - s_cf4yw;
    let s_3tfc6 = s_9a1vw + s_jbryk;
    let x_pr_ddot = coefficients.c_mttba
        * (s_3tfc6 - s_rt6xq - s_hfjv2 - coefficients.c_en65n * s_ysw27);
    let x_c_dot = state[7];
    let s_at6bd = coefficients.c_r_s_a_m_per_I_s - coefficients.c_79h79 * s_ysw27
        - x_pr_ddot
        - coefficients.c_b_m_per_I_s * (x_sp_dot + x_pr_dot + T::number(2.0) * x_c_dot)
        - coefficients.c_r_s_r_s_per_I_s * s_3tfc6;
    let x_sp_ddot = s_at6bd
        + coefficients.c_r_s_F_w_per_I_s * sin(coefficients.omega * t);
    let x_c_ddot = coefficients.c_5f1my * s_ysw27;
    for i in 0..5 {
        rates[i] = state[5 + i];
    }
    rates[5] = x_sp_ddot;
    rates[6] = x_pr_ddot;
    rates[7] = x_c_ddot;
    for i in 0..2 {
        rates[8 + i] = s_bdj51[i] - coefficients.c_3n7zt[i] * s_ysw27;
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
                + coefficients.c_2z827 * T::number(INTEGRAL_PHI_BY_PHI[i][j])
                    * T::number(1.0);
            values[3 + i][3 + j] = values[3 + i][3 + j]
                + coefficients.c_2z827 * T::number(INTEGRAL_PHI_BY_PHI[j][i])
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
        for j in 0..i {
            let mut rest = matrix[i][j];
            for k in 0..j {
                rest = rest - factor[i][k] * factor[j][k];
            }
            factor[i][j] = rest / factor[j][j];
        }
        let mut rest = matrix[i][i];
        for k in 0..i {
            rest = rest - factor[i][k] * factor[i][k];
        }
        factor[i][i] = T::select_greater(
            rest,
            T::number(0.0),
            sqrt(rest),
            T::number(f64::NAN),
        );
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
    for i in (0..N).rev() {
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
