//! Tests of the errata of the flexible arm: coefficients of Eq. (22) at S = 4.

#![allow(non_snake_case, reason = "names as in the paper")]

use super::sources::{PRINTED_ORDER, Sources};
use super::table::ErrataTable;

pub fn add_rows(sources: &Sources, table: &mut ErrataTable) {
    motor(sources, table);
    meshes_in_row_1(sources, table);
    meshes_in_row_2(sources, table);
    inertias(sources, table);
    carrier_row(sources, table);
    for mode in 0..PRINTED_ORDER {
        mode_row(sources, mode, table);
    }
}

fn motor(sources: &Sources, table: &mut ErrataTable) {
    let a = &sources.coefficients;
    let measured = &sources.flexible;
    let b_c = 25e-6;
    table.add_misprint(
        "Eq. (22), X_sp'' at rest and t = 0 (omega_n = 1, b_c = 25 um)",
        ("a_11/b_0, b_0 undefined and read as 1 m", a.a_11_constant),
        ("a_11/b_c", a.a_11_constant / b_c),
        measured.constant.entry(0) / b_c,
    );
    table.add_misprint(
        "Eq. (22), a_11, rise over a quarter period",
        ("0: A_m/M_s", 0.0),
        ("F_w/(r_s M_s): A_m(t)/M_s", a.a_11_amplitude),
        measured.fluctuation.entry(0),
    );
    table.add_correct(
        "Eq. (22), a_12 on X_sp'",
        ("-B_m/M_s", a.a_12),
        measured.rate[0].entry(0),
    );
    table.add_correct(
        "Eq. (22), a_12 on X_pr'",
        ("-B_m/M_s", a.a_12),
        measured.rate[1].entry(0),
    );
    table.add_correct(
        "Eq. (22), a_13",
        ("2 a_12", a.a_13),
        measured.rate[2].entry(0),
    );
}

/// Compares a_14 .. a_17 and a_18 .. a_111 in the row of X_sp.
fn meshes_in_row_1(sources: &Sources, table: &mut ErrataTable) {
    let a = &sources.coefficients;
    let parameters = &sources.parameters;
    let measured = &sources.flexible;
    let (m_s, m_p) = (sources.masses.M_s, sources.masses.M_p);
    let printed_sp = -(3.0 / m_s + 1.0 / m_p + a.a_36 / a.a_30);
    let printed_pr = -(3.0 / m_s - 1.0 / m_p + a.a_36 / a.a_30);
    table.add_misprint(
        "Eq. (22), a_14",
        (
            "-(3/M_s + 1/M_p + a_36/a_30) k_sp",
            printed_sp * parameters.k_sp,
        ),
        ("-(3/M_s + 1/M_p + 3 r_c cos(alpha)/a_30) k_sp", a.a_14),
        measured.spring[0].entry(0),
    );
    table.add_misprint(
        "Eq. (22), a_15",
        (
            "-(3/M_s + 1/M_p + a_36/a_30) c_sp",
            printed_sp * parameters.c_sp,
        ),
        ("a_14 c_sp/k_sp", a.a_15),
        measured.damping[0].entry(0),
    );
    table.add_misprint(
        "Eq. (22), a_16",
        (
            "-(3/M_s - 1/M_p + a_36/a_30) k_pr",
            printed_pr * parameters.k_pr,
        ),
        ("-(-1/M_p + 3 r_c cos(alpha)/a_30) k_pr", a.a_16),
        measured.spring[1].entry(0),
    );
    table.add_misprint(
        "Eq. (22), a_17",
        (
            "-(3/M_s - 1/M_p + a_36/a_30) c_pr",
            printed_pr * parameters.c_pr,
        ),
        ("a_16 c_pr/k_pr", a.a_17),
        measured.damping[1].entry(0),
    );
    modes_in_row(sources, 0, "X_sp", table);
}

/// Compares a_21 .. a_24 and a_18 .. a_111 in the row of X_pr.
fn meshes_in_row_2(sources: &Sources, table: &mut ErrataTable) {
    let a = &sources.coefficients;
    let parameters = &sources.parameters;
    let measured = &sources.flexible;
    let m_p = sources.masses.M_p;
    let printed_sp = 1.0 / m_p - a.a_36 / a.a_30;
    let printed_pr = -(1.0 / m_p + a.a_36 / a.a_30);
    table.add_misprint(
        "Eq. (22), a_21",
        ("(1/M_p - a_36/a_30) k_sp", printed_sp * parameters.k_sp),
        ("(1/M_p - 3 r_c cos(alpha)/a_30) k_sp", a.a_21),
        measured.spring[0].entry(1),
    );
    table.add_misprint(
        "Eq. (22), a_22",
        ("(1/M_p - a_36/a_30) c_sp", printed_sp * parameters.c_sp),
        ("a_21 c_sp/k_sp", a.a_22),
        measured.damping[0].entry(1),
    );
    table.add_misprint(
        "Eq. (22), a_23",
        ("-(1/M_p + a_36/a_30) k_pr", printed_pr * parameters.k_pr),
        ("-(1/M_p + 3 r_c cos(alpha)/a_30) k_pr", a.a_23),
        measured.spring[1].entry(1),
    );
    table.add_misprint(
        "Eq. (22), a_24",
        ("-(1/M_p + a_36/a_30) c_pr", printed_pr * parameters.c_pr),
        ("a_23 c_pr/k_pr", a.a_24),
        measured.damping[1].entry(1),
    );
    modes_in_row(sources, 1, "X_pr", table);
}

fn modes_in_row(sources: &Sources, row: usize, name: &str, table: &mut ErrataTable) {
    for (i, a) in sources.coefficients.a_18.iter().enumerate() {
        table.add_correct(
            format!("Eq. (22), a_1{} in the row of {name}", 8 + i),
            ("-a_3i/a_30", *a),
            sources.flexible.modes[i].entry(row),
        );
    }
}

/// Compares a_01 .. a_05 and a_30, from the accelerations of carrier and modes under F_sp.
fn inertias(sources: &Sources, table: &mut ErrataTable) {
    let a = &sources.coefficients;
    let by_rigid = &sources.rigid.spring[0];
    let by_flexible = &sources.flexible.spring[0];
    table.add_correct(
        "Eq. (22), a_01",
        ("(I_c + 3 m_p r_c^2 + I_arm)/(r_c cos(alpha))", a.a_01),
        a.a_35 / by_rigid.entry(2),
    );
    table.add_correct(
        "Eq. (22), a_30",
        ("a_01 - sum of (int x phi_i/int phi_i^2) a_0(i+1)", a.a_30),
        a.a_35 / by_flexible.entry(2),
    );
    for (i, (a_0, mode)) in a.a_0.iter().zip(&a.modes).enumerate() {
        table.add_correct(
            format!("Eq. (22), a_0{}/(rho A int phi_{}^2)", i + 2, i + 1),
            (
                "int x phi_i/(r_c cos(alpha) int phi_i^2)",
                a_0 * a.a_30 / mode.a_0,
            ),
            -by_flexible.entry(3 + i) / by_flexible.entry(2),
        );
    }
}

/// Compares a_31 .. a_38, each divided by a_30.
fn carrier_row(sources: &Sources, table: &mut ErrataTable) {
    let a = &sources.coefficients;
    let measured = &sources.flexible;
    for (i, a_3) in a.a_3.iter().enumerate() {
        table.add_correct(
            format!("Eq. (22), a_3{}/a_30", i + 1),
            (
                "int x phi_i int EI phi_i''^2/(int phi_i^2 a_30)",
                a_3 / a.a_30,
            ),
            measured.modes[i].entry(2),
        );
    }
    let meshes = [
        ("a_35", a.a_35, measured.spring[0].entry(2)),
        ("a_36", a.a_36, measured.damping[0].entry(2)),
        ("a_37", a.a_37, measured.spring[1].entry(2)),
        ("a_38", a.a_38, measured.damping[1].entry(2)),
    ];
    for (name, value, derived) in meshes {
        let text = "3 r_c cos(alpha) times k or c, over a_30";
        table.add_correct(
            format!("Eq. (22), {name}/a_30"),
            (text, value / a.a_30),
            derived,
        );
    }
}

/// Compares the row of mode `i` (counted from 0). Each coefficient is divided by the coefficient of the mode's
/// acceleration.
fn mode_row(sources: &Sources, i: usize, table: &mut ErrataTable) {
    let a = &sources.coefficients;
    let measured = &sources.flexible;
    let Some(row) = a.modes.get(i) else { return };
    let number = 4 + i;
    for (j, coefficient) in row.a.iter().enumerate() {
        let place = format!("Eq. (22), a_{number}{}/a_{number}0", j + 1);
        let derived = measured.modes[j].entry(3 + i);
        let value = coefficient / row.a_0;
        if i == j && i >= 2 {
            // The paper prints a_03 instead of a_0(i+1).
            let printed = (coefficient + (a.a_0[i] - a.a_0[1]) * a.a_3[i]) / row.a_0;
            let text = format!("-a_30 int EI phi_i''^2 - a_03 a_3{}", i + 1);
            let right = format!("-a_30 int EI phi_i''^2 - a_0{} a_3{}", i + 2, i + 1);
            table.add_misprint(place, (&text, printed), (&right, value), derived);
        } else {
            table.add_correct(place, ("as printed", value), derived);
        }
    }
    let meshes = [
        (row.a_5, measured.spring[0].entry(3 + i)),
        (row.a_6, measured.damping[0].entry(3 + i)),
        (row.a_7, measured.spring[1].entry(3 + i)),
        (row.a_8, measured.damping[1].entry(3 + i)),
    ];
    for (column, (value, derived)) in (5..).zip(meshes) {
        let place = format!("Eq. (22), a_{number}{column}/a_{number}0");
        table.add_correct(place, ("-a_0(i+1) a_3j", value / row.a_0), derived);
    }
}
