//! Tests of errata that are not coefficients, by their consequences: scales, dead band, mode shapes, positioning error,
//! Table I, nomenclature.
//!
//! Quantities that the paper omits (I, a_m, b_m, F_w, c_sp, c_pr, b_c, the initial state) have assumed values and
//! cannot be compared.

#![allow(non_snake_case, reason = "names as in the paper")]

use super::measure::DerivedModel;
use super::sources::{PRINTED_ORDER, Sources};
use super::table::ErrataTable;
use eomgen_validate::references::planetary_arm::dimensionless_equation_22::Equation22;
use eomgen_validate::references::planetary_arm::mesh::f_k;
use eomgen_validate::references::planetary_arm::mode_shapes::ModeShape;

/// Frequency omega_n = sqrt(k_sp/M_sp) of the paper's time scale with the values of Table I, in rad/s.
const OMEGA_N: f64 = 3.0885e4;

/// Displacement scale in m (assumed).
const B_C: f64 = 25e-6;

pub fn add_rows(sources: &Sources, derived: &DerivedModel<'_>, table: &mut ErrataTable) {
    scales(sources, derived, table);
    dead_band(sources, table);
    frequencies(sources, table);
    amplitude_ratio(sources, table);
    coupling(sources, table);
    positioning_error(sources, table);
    table_1(sources, table);
    nomenclature(sources, table);
}

/// Compares Eq. (13)-(15) and the lines below Eq. (22). One state is converted to dimensionless form, evaluated and
/// converted back, with the printed and with the corrected scales.
fn scales(sources: &Sources, derived: &DerivedModel<'_>, table: &mut ErrataTable) {
    let state = [
        6e-5, -7e-5, 0.3, 2e-4, -3e-5, 1e-5, 4e-6, 0.02, -0.01, 0.5, 0.05, 0.02, -0.03, 0.01,
    ];
    let physical = derived(&sources.parameters, PRINTED_ORDER, 0.0, &state);
    let equation = Equation22::<PRINTED_ORDER>::new(&sources.parameters, OMEGA_N, B_C);
    // `factor` converts a displacement to dimensionless form.
    let through = |factor: f64, rate_factor: f64, acceleration_factor: f64| {
        let mut scaled = state;
        scaled[..7].iter_mut().for_each(|x| *x *= factor);
        scaled[7..].iter_mut().for_each(|x| *x *= rate_factor);
        let mut out = [0.0; 14];
        equation.rates(0.0, &scaled, &mut out);
        move |row: usize| out[7 + row] / acceleration_factor
    };
    let acceleration = OMEGA_N * OMEGA_N;
    let corrected = through(1.0 / B_C, 1.0 / (B_C * OMEGA_N), 1.0 / (B_C * acceleration));
    let printed = through(B_C, B_C * OMEGA_N, B_C * acceleration);
    let at = |row: usize| physical.get(row).copied().unwrap_or(f64::NAN);
    table.add_misprint(
        "Eq. (13)-(15): x_sp'' through the dimensionless equations",
        (
            "X = b_c x, X' = b_c omega_n x', X'' = b_c omega_n^2 x''",
            printed(0),
        ),
        (
            "X = x/b_c, X' = x'/(b_c omega_n), X'' = x''/(b_c omega_n^2)",
            corrected(0),
        ),
        at(0),
    );
    table.add_misprint(
        "below Eq. (22): q_1'' through the dimensionless equations",
        ("qbar = b_c q, qbar'' = b_c omega_n^2 q''", printed(3)),
        ("qbar = q/b_c, qbar'' = q''/(b_c omega_n^2)", corrected(3)),
        at(3),
    );
}

/// Compares f_k(X) of Eq. (16) and (22): at half the distance to contact the force must be zero.
fn dead_band(sources: &Sources, table: &mut ErrataTable) {
    let b = sources.parameters.b_sp;
    let inside = 0.5 * b / B_C;
    let force = sources.flexible.inside_dead_band.entry(0) / sources.coefficients.a_14 * inside;
    table.add_misprint(
        "Eq. (16), (22): f_k(X_sp) half way to contact",
        ("half-width b", f_k(inside, b)),
        ("half-width b/b_c", f_k(inside, b / B_C)),
        force,
    );
}

/// Computes the ratio of stiffness and mass of mode `i` in 1/s^2 from accelerations, without the coupling to the
/// carrier.
fn frequency_squared(sources: &Sources, i: usize) -> f64 {
    let by_force = &sources.flexible.spring[0];
    let by_mode = &sources.flexible.modes[i];
    by_force.entry(3 + i) / by_force.entry(2) * by_mode.entry(2) - by_mode.entry(3 + i)
}

fn beta_l(sources: &Sources, i: usize) -> f64 {
    let parameters = &sources.parameters;
    let line_mass = parameters.rho * parameters.A;
    let bending = parameters.E * parameters.I;
    let fourth_power = frequency_squared(sources, i) * line_mass * parameters.l.powi(4) / bending;
    fourth_power.powf(0.25)
}

/// Computes int x phi_1 dx/int phi_1^2 dx of the derived model, in m.
fn first_coupling(sources: &Sources) -> f64 {
    let by_force = &sources.flexible.spring[0];
    -by_force.entry(3) / by_force.entry(2) * sources.parameters.r_c_cos_alpha()
}

fn frequencies(sources: &Sources, table: &mut ErrataTable) {
    for i in 0..PRINTED_ORDER {
        table.add_misprint(
            format!("Eq. (18): beta_{} l", i + 1),
            ("pi (r - 1/2)", std::f64::consts::PI * (i as f64 + 0.5)),
            (
                "root of cos z cosh z = -1",
                ModeShape::clamped_free(i + 1).beta_l,
            ),
            beta_l(sources, i),
        );
    }
}

/// Compares Eq. (19): the amplitude ratio of mode 1, and its moment and shear at the free end.
fn amplitude_ratio(sources: &Sources, table: &mut ErrataTable) {
    let z = beta_l(sources, 0);
    // int x phi/int phi^2 = -2 l/(xi z^2) for a shape with correct boundary conditions.
    let xi = -2.0 * sources.parameters.l / (z * z * first_coupling(sources));
    let printed_xi = (z.cos() + z.cosh()) / (z.sin() + z.sinh());
    let (printed_text, corrected_text) = ("(cos + cosh)/(sin + sinh)", "(cos + cosh)/(sin - sinh)");
    let exact = ModeShape::clamped_free(1);
    table.add_misprint(
        "Eq. (19): xi_1",
        (printed_text, printed_xi),
        (corrected_text, exact.xi),
        xi,
    );
    for (name, derivative) in [("moment", 2), ("shear", 3)] {
        let end = |xi: f64| ModeShape::with_values(z, xi).derivative(derivative, 1.0);
        table.add_misprint(
            format!("Eq. (19): {name} at the free end of mode 1"),
            (printed_text, end(printed_xi)),
            (corrected_text, 0.0),
            end(xi),
        );
    }
}

/// Compares Eq. (21): if the velocity of the arm did not contain the rotation, the modes would not be coupled to the
/// carrier.
fn coupling(sources: &Sources, table: &mut ErrataTable) {
    let integrals = ModeShape::clamped_free(1).integrals();
    table.add_misprint(
        "Eq. (21): -q_1'' per th_c''",
        ("0: T has only w_t", 0.0),
        (
            "int x phi_1/int phi_1^2: T = 1/2 int rho A (x th_c' + w_t)^2 dx",
            sources.parameters.l * integrals.s_phi / integrals.phi_squared,
        ),
        first_coupling(sources),
    );
}

/// Compares Eq. (23) and (24) by the geometry of one state: the position of the end point minus its nominal position,
/// computed from the angle of the sun.
fn positioning_error(sources: &Sources, table: &mut ErrataTable) {
    let parameters = &sources.parameters;
    let (x_sp, x_pr, x_c, w) = (4e-5, 3e-5, 0.2, 1e-4);
    let theta_s = (x_sp + x_pr + 2.0 * x_c) / parameters.r_s();
    let theta_c = x_c / parameters.r_c_cos_alpha();
    let lag = theta_s / parameters.i_sH() - theta_c;
    let dtheta = (x_sp + x_pr) / (parameters.r_s() * parameters.i_sH());
    table.add_correct(
        "Eq. (23): th_s/i_sH - th_c",
        ("(x_sp + x_pr)/(r_s i_sH)", dtheta),
        lag,
    );
    let end = parameters.l * theta_c + w;
    table.add_misprint(
        "Eq. (24): end point less its nominal place",
        ("l dtheta + w", parameters.l * dtheta + w),
        ("w - l dtheta", w - parameters.l * dtheta),
        end - parameters.l * theta_s / parameters.i_sH(),
    );
}

/// Computes the inertia that turns with the carrier in the derived rigid model, in kg m^2.
fn carrier_inertia(sources: &Sources) -> f64 {
    let r_c = sources.parameters.r_c_cos_alpha();
    3.0 * r_c * r_c * sources.parameters.k_sp / sources.rigid.spring[0].entry(2)
}

/// Compares Table I: I_arm, I_c/r_c^2 and the resulting time scale.
fn table_1(sources: &Sources, table: &mut ErrataTable) {
    let parameters = &sources.parameters;
    let r_c = parameters.r_c();
    let rest = parameters.I_c + 3.0 * parameters.m_p * r_c * r_c;
    table.add_misprint(
        "Table I: I_arm",
        (
            "0.033 kg/m^2 beside the arm's own rho A l^3/3",
            0.033 + parameters.I_arm(),
        ),
        ("rho A l^3/3, kg m^2", parameters.I_arm()),
        carrier_inertia(sources) - rest,
    );
    let cos_squared = parameters.alpha.cos().powi(2);
    let equivalent = |inertia: f64| inertia / (r_c * r_c * cos_squared);
    let other = 3.0 * parameters.m_p / cos_squared + equivalent(parameters.I_arm());
    table.add_misprint(
        "Table I: M_c",
        ("I_c/r_c^2", parameters.I_c / (r_c * r_c)),
        ("I_c/(r_c^2 cos^2 alpha)", equivalent(parameters.I_c)),
        equivalent(carrier_inertia(sources)) - other,
    );
    table.add_correct(
        "Table I: omega_n, not given",
        (
            "sqrt(k_sp/M_sp)",
            (parameters.k_sp / sources.masses.M_sp).sqrt(),
        ),
        (-sources.rigid.spring[0].entry(0)).sqrt(),
    );
}

fn nomenclature(sources: &Sources, table: &mut ErrataTable) {
    let parameters = &sources.parameters;
    let rest = parameters.I_c + 3.0 * parameters.m_p * parameters.r_c().powi(2);
    table.add_misprint(
        "Nomenclature: rho, by the arm's inertia",
        (
            "linear density: rho l^3/3",
            parameters.rho * parameters.l.powi(3) / 3.0,
        ),
        ("volume density: rho A l^3/3", parameters.I_arm()),
        carrier_inertia(sources) - rest,
    );
    let by_force = &sources.rigid.spring[0];
    let absolute = parameters.k_sp / sources.masses.M_p;
    // An angle relative to the carrier also contains the rotation of the carrier.
    let carrier = 3.0 * parameters.r_c_cos_alpha() * parameters.k_sp / parameters.I_tot();
    table.add_misprint(
        "Nomenclature: theta_p, by x_p'' per f_k(x_sp)",
        (
            "about its shaft (counted from the carrier)",
            absolute + parameters.r_p() * carrier,
        ),
        ("absolute, positive against the sun", absolute),
        by_force.entry(1) + by_force.entry(2),
    );
}
