//! Tests of the errata of the rigid arm: Eq. (10), (12) and (16).

#![allow(non_snake_case, reason = "names as in the paper")]

use super::measure::Response;
use super::sources::Sources;
use super::table::ErrataTable;
use eomgen_validate::references::planetary_arm::equation_12::EquivalentMasses;

pub fn add_rows(sources: &Sources, table: &mut ErrataTable) {
    equation_10(sources, table);
    equation_12_row_1(sources, table);
    equation_12_rows_2_and_3(sources, table);
    equation_16_row_1(sources, table);
    equation_16_rows_2_and_3(sources, table);
}

/// Compares Eq. (10): torques per newton of mesh force, from the accelerations of the shafts.
fn equation_10(sources: &Sources, table: &mut ErrataTable) {
    let parameters = &sources.parameters;
    let (r_s, r_p, r_c) = (
        parameters.r_s(),
        parameters.r_p(),
        parameters.r_c_cos_alpha(),
    );
    let [by_sp, by_pr] = &sources.rigid.spring;
    let theta_s = |by: &Response| (by.entry(0) + by.entry(1) + 2.0 * by.entry(2)) / r_s;
    let theta_p = |by: &Response| (by.entry(1) + by.entry(2)) / r_p;
    let (k_sp, k_pr) = (parameters.k_sp, parameters.k_pr);

    table.add_correct(
        "Eq. (10), row 1: torque on the sun per F_sp",
        ("-3 r_s", -3.0 * r_s),
        parameters.I_s * theta_s(by_sp) / k_sp,
    );
    table.add_misprint(
        "Eq. (10), row 1: torque on the sun per F_pr",
        ("-3 r_s", -3.0 * r_s),
        ("0", 0.0),
        parameters.I_s * theta_s(by_pr) / k_pr,
    );
    table.add_correct(
        "Eq. (10), row 2: torque on a planet per F_sp",
        ("r_p", r_p),
        parameters.I_p * theta_p(by_sp) / k_sp,
    );
    table.add_correct(
        "Eq. (10), row 2: torque on a planet per F_pr",
        ("-r_p", -r_p),
        parameters.I_p * theta_p(by_pr) / k_pr,
    );
    table.add_misprint(
        "Eq. (10), row 3: th_s'' per F_sp",
        (
            "3 r_c cos(alpha)/I_tot (the row has th_s'')",
            3.0 * r_c / parameters.I_tot(),
        ),
        (
            "-3 r_s/I_s (the row has th_c'')",
            -3.0 * r_s / parameters.I_s,
        ),
        theta_s(by_sp) / k_sp,
    );
    table.add_correct(
        "Eq. (10), row 3: torque on the carrier per F_sp",
        ("3 r_c cos(alpha)", 3.0 * r_c),
        parameters.I_tot() * by_sp.entry(2) / (r_c * k_sp),
    );
    table.add_misprint(
        "Eq. (10), row 3: torque on the carrier per F_pr",
        ("-3 r_c cos(alpha)", -3.0 * r_c),
        ("3 r_c cos(alpha)", 3.0 * r_c),
        parameters.I_tot() * by_pr.entry(2) / (r_c * k_pr),
    );
}

fn equation_12_row_1(sources: &Sources, table: &mut ErrataTable) {
    let EquivalentMasses {
        M_s, M_sp, B, B_m, ..
    } = sources.masses;
    let parameters = &sources.parameters;
    let rigid = &sources.rigid;
    let motor = -B_m / M_s;
    table.add_correct(
        "Eq. (12), row 1: x_sp'",
        ("-B_m/M_s", motor),
        rigid.rate[0].entry(0),
    );
    table.add_misprint(
        "Eq. (12), row 1: x_pr'",
        ("0", 0.0),
        ("-B_m/M_s", motor),
        rigid.rate[1].entry(0),
    );
    table.add_misprint(
        "Eq. (12), row 1: x_c'",
        ("-B_m/M_s", motor),
        ("-2 B_m/M_s", 2.0 * motor),
        rigid.rate[2].entry(0),
    );
    let meshes = [
        (
            "F_ksp",
            "-1/M_sp",
            -1.0 / M_sp,
            rigid.spring[0].entry(0) / parameters.k_sp,
        ),
        (
            "F_csp",
            "-1/M_sp",
            -1.0 / M_sp,
            rigid.damping[0].entry(0) / parameters.c_sp,
        ),
        (
            "F_kpr",
            "-B/M_sp",
            -B / M_sp,
            rigid.spring[1].entry(0) / parameters.k_pr,
        ),
        (
            "F_cpr",
            "-B/M_sp",
            -B / M_sp,
            rigid.damping[1].entry(0) / parameters.c_pr,
        ),
    ];
    for (force, text, value, derived) in meshes {
        table.add_correct(format!("Eq. (12), row 1: {force}"), (text, value), derived);
    }
    let r_s = parameters.r_s();
    table.add_correct(
        "Eq. (12), row 1: right side at t = 0",
        ("a_m/(r_s M_s)", parameters.a_m / (r_s * M_s)),
        rigid.constant.entry(0),
    );
    table.add_misprint(
        "Eq. (12), row 1: right side, rise over a quarter period",
        ("0: A_m = a_m/r_s", 0.0),
        (
            "F_w/(r_s M_s): A_m(t) = (a_m + F_w sin omega t)/r_s",
            parameters.F_w / (r_s * M_s),
        ),
        rigid.fluctuation.entry(0),
    );
}

/// Compares rows 2 and 3 of Eq. (12), solved for x_pr'' and x_c''.
fn equation_12_rows_2_and_3(sources: &Sources, table: &mut ErrataTable) {
    let EquivalentMasses {
        M_pr, M_c_prime, D, ..
    } = sources.masses;
    let parameters = &sources.parameters;
    let rigid = &sources.rigid;
    let (k_sp, c_sp) = (parameters.k_sp, parameters.c_sp);
    let (k_pr, c_pr) = (parameters.k_pr, parameters.c_pr);
    table.add_correct(
        "Eq. (12), row 2: F_ksp",
        ("-D/M_pr", -D / M_pr),
        rigid.spring[0].entry(1) / k_sp,
    );
    table.add_misprint(
        "Eq. (12), row 2: F_csp",
        ("-1/M_pr", -1.0 / M_pr),
        ("-D/M_pr", -D / M_pr),
        rigid.damping[0].entry(1) / c_sp,
    );
    let planet = ("-1/M_pr", -1.0 / M_pr);
    table.add_correct(
        "Eq. (12), row 2: F_kpr",
        planet,
        rigid.spring[1].entry(1) / k_pr,
    );
    table.add_correct(
        "Eq. (12), row 2: F_cpr",
        planet,
        rigid.damping[1].entry(1) / c_pr,
    );
    let carrier = ("3/M_c'", 3.0 / M_c_prime);
    table.add_correct(
        "Eq. (12), row 3: F_ksp",
        carrier,
        rigid.spring[0].entry(2) / k_sp,
    );
    table.add_correct(
        "Eq. (12), row 3: F_csp",
        carrier,
        rigid.damping[0].entry(2) / c_sp,
    );
    table.add_correct(
        "Eq. (12), row 3: F_kpr",
        carrier,
        rigid.spring[1].entry(2) / k_pr,
    );
    table.add_correct(
        "Eq. (12), row 3: F_cpr",
        carrier,
        rigid.damping[1].entry(2) / c_pr,
    );
}

/// Frequency of the time scale in rad/s. It differs from sqrt(k_sp/M_sp), because the printed coefficient 1 of
/// f_k(X_sp) is correct for this frequency only.
const OMEGA_N: f64 = 1e4;

/// Displacement scale, in m.
const B_C: f64 = 25e-6;

/// Compares row 1 of Eq. (16), solved for X_sp''.
fn equation_16_row_1(sources: &Sources, table: &mut ErrataTable) {
    let EquivalentMasses { M_s, M_sp, B, .. } = sources.masses;
    let parameters = &sources.parameters;
    let rigid = &sources.rigid;
    let (omega_n, stiffness) = (OMEGA_N, OMEGA_N * OMEGA_N);
    let drive = parameters.a_m / parameters.r_s();
    table.add_misprint(
        "Eq. (16), row 1: right side at t = 0",
        ("A_m/(M_sp b_c omega_n^2)", drive / (M_sp * B_C * stiffness)),
        (
            "A_m(t)/(M_s b_c omega_n^2)",
            drive / (M_s * B_C * stiffness),
        ),
        rigid.constant.entry(0) / (B_C * stiffness),
    );
    let fluctuation = parameters.F_w / (parameters.r_s() * M_s * B_C * stiffness);
    table.add_misprint(
        "Eq. (16), row 1: right side, rise over a quarter period",
        ("0", 0.0),
        ("F_w/(r_s M_s b_c omega_n^2)", fluctuation),
        rigid.fluctuation.entry(0) / (B_C * stiffness),
    );
    table.add_misprint(
        "Eq. (16), row 1: f_c(X_pr)",
        ("0", 0.0),
        (
            "-B c_pr/(M_sp omega_n)",
            -B * parameters.c_pr / (M_sp * omega_n),
        ),
        rigid.damping[1].entry(0) / omega_n,
    );
    table.add_misprint(
        "Eq. (16), row 1: f_k(X_sp)",
        ("-1", -1.0),
        (
            "-k_sp/(M_sp omega_n^2)",
            -parameters.k_sp / (M_sp * stiffness),
        ),
        rigid.spring[0].entry(0) / stiffness,
    );
    table.add_misprint(
        "Eq. (16), row 1: f_c(X_sp), the symbol F_csp",
        // F_csp of Eq. (6) is c_sp b_c omega_n f_c(X_sp).
        (
            "-c_sp b_c/M_sp: F as in Eq. (6)",
            -parameters.c_sp * B_C / M_sp,
        ),
        (
            "-c_sp/(M_sp omega_n): F is c f_c(X)",
            -parameters.c_sp / (M_sp * omega_n),
        ),
        rigid.damping[0].entry(0) / omega_n,
    );
}

/// Compares rows 2 and 3 of Eq. (16), solved for X_pr'' and X_c''.
fn equation_16_rows_2_and_3(sources: &Sources, table: &mut ErrataTable) {
    let EquivalentMasses {
        M_sp,
        M_pr,
        M_c_prime,
        D,
        ..
    } = sources.masses;
    let parameters = &sources.parameters;
    let rigid = &sources.rigid;
    let (omega_n, stiffness) = (OMEGA_N, OMEGA_N * OMEGA_N);
    table.add_misprint(
        "Eq. (16), row 2: f_c(X_sp)",
        ("-c_sp/(M_sp omega_n)", -parameters.c_sp / (M_sp * omega_n)),
        (
            "-D c_sp/(M_pr omega_n)",
            -D * parameters.c_sp / (M_pr * omega_n),
        ),
        rigid.damping[0].entry(1) / omega_n,
    );
    table.add_misprint(
        "Eq. (16), row 2: f_k(X_sp)",
        ("-D M_sp/M_pr", -D * M_sp / M_pr),
        (
            "-D k_sp/(M_pr omega_n^2)",
            -D * parameters.k_sp / (M_pr * stiffness),
        ),
        rigid.spring[0].entry(1) / stiffness,
    );
    table.add_misprint(
        "Eq. (16), row 3: f_k(X_sp)",
        ("3 M_sp/M_c'", 3.0 * M_sp / M_c_prime),
        (
            "3 k_sp/(M_c' omega_n^2)",
            3.0 * parameters.k_sp / (M_c_prime * stiffness),
        ),
        rigid.spring[0].entry(2) / stiffness,
    );
}
