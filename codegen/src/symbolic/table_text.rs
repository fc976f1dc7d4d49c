//! Descriptions of tables of constants as plain text, LaTeX and documentation, and names of the tables in emitted
//! code.

use crate::symbolic::tables::{Table, TableKind};

fn prime_marks(derivative: u8) -> String {
    "'".repeat(usize::from(derivative))
}

fn write_power_of_s(power: u32) -> String {
    match power {
        0 => String::new(),
        1 => "s ".to_owned(),
        n => format!("s^{n} "),
    }
}

/// Returns the content of a table in plain text. Integrals are over s from 0 to 1; primes denote derivatives by s.
pub fn plain(kind: TableKind) -> String {
    match kind {
        TableKind::Wavenumber => "betal_i".to_owned(),
        TableKind::Mixing => "xi_i".to_owned(),
        TableKind::GrowingAmplitude => "((1 + xi_i)*exp(betal_i))".to_owned(),
        TableKind::FallingAmplitude => "falling_i".to_owned(),
        TableKind::RisingAmplitude => "rising_i".to_owned(),
        TableKind::ShapeAtStart(d) => format!("phi_i{}(0)", prime_marks(d)),
        TableKind::ShapeAtEnd(d) => format!("phi_i{}(1)", prime_marks(d)),
        TableKind::ShapeAtPlace { bits, derivative } => {
            format!("phi_i{}({})", prime_marks(derivative), f64::from_bits(bits))
        }
        TableKind::Moment { power, derivative } => {
            format!(
                "int[{}phi_i{}]",
                write_power_of_s(power),
                prime_marks(derivative)
            )
        }
        TableKind::OwnMoment { power, left, right } if left == right => {
            format!(
                "int[{}phi_i{}^2]",
                write_power_of_s(power),
                prime_marks(left)
            )
        }
        TableKind::OwnMoment { power, left, right } => {
            format!(
                "int[{}phi_i{} phi_i{}]",
                write_power_of_s(power),
                prime_marks(left),
                prime_marks(right)
            )
        }
        TableKind::PairMoment { power, left, right } => {
            format!(
                "int[{}phi_i{} phi_j{}]",
                write_power_of_s(power),
                prime_marks(left),
                prime_marks(right)
            )
        }
        TableKind::Indicator(mode) => format!("[i = {mode}]"),
        TableKind::NodePosition => "s_g".to_owned(),
        TableKind::NodeWeight => "weight_g".to_owned(),
        TableKind::ShapeAtNodes(d) => format!("phi_i{}(s_g)", prime_marks(d)),
    }
}

/// Returns the content of a table in LaTeX.
pub fn latex(kind: TableKind) -> String {
    let integral = |inner: String| format!("\\int_0^1 {inner}\\,ds");
    let s = |power: u32| match power {
        0 => String::new(),
        1 => "s\\,".to_owned(),
        n => format!("s^{{{n}}}\\,"),
    };
    let phi = |index: &str, d: u8| format!("\\varphi_{index}{}", prime_marks(d));
    match kind {
        TableKind::Wavenumber => "(\\beta l)_i".to_owned(),
        TableKind::Mixing => "\\xi_i".to_owned(),
        TableKind::GrowingAmplitude => "(1 + \\xi_i)e^{(\\beta l)_i}".to_owned(),
        TableKind::FallingAmplitude => "\\varphi^-_i".to_owned(),
        TableKind::RisingAmplitude => "\\varphi^+_i".to_owned(),
        TableKind::ShapeAtStart(d) => format!("{}(0)", phi("i", d)),
        TableKind::ShapeAtEnd(d) => format!("{}(1)", phi("i", d)),
        TableKind::ShapeAtPlace { bits, derivative } => {
            format!("{}({})", phi("i", derivative), f64::from_bits(bits))
        }
        TableKind::Moment { power, derivative } => {
            integral(format!("{}{}", s(power), phi("i", derivative)))
        }
        TableKind::OwnMoment { power, left, right } => {
            integral(format!("{}{}{}", s(power), phi("i", left), phi("i", right)))
        }
        TableKind::PairMoment { power, left, right } => {
            integral(format!("{}{}{}", s(power), phi("i", left), phi("j", right)))
        }
        TableKind::Indicator(mode) => format!("\\delta_{{i,{mode}}}"),
        TableKind::NodePosition => "s_g".to_owned(),
        TableKind::NodeWeight => "w_g".to_owned(),
        TableKind::ShapeAtNodes(d) => format!("{}(s_g)", phi("i", d)),
    }
}

/// Returns the description of a table on one line.
pub fn doc(table: &Table) -> String {
    match table.kind {
        TableKind::Wavenumber => "Wave numbers beta_r l of the modes".to_owned(),
        TableKind::Mixing => "Factors xi_r of the modes".to_owned(),
        TableKind::GrowingAmplitude => "Factors (1 + xi_r) exp(beta_r l) of the modes".to_owned(),
        TableKind::FallingAmplitude => "Factors of exp(-beta_r l s) in the modes".to_owned(),
        TableKind::RisingAmplitude => "Factors of exp(-beta_r l (1 - s)) in the modes".to_owned(),
        TableKind::Indicator(mode) => format!("1 for mode {mode}, 0 for all others"),
        TableKind::NodePosition => "Gauss-Legendre nodes on [0, 1]".to_owned(),
        TableKind::NodeWeight => "Gauss-Legendre weights on [0, 1]".to_owned(),
        kind => format!(
            "{}, with s = x/l from 0 to 1; primes are derivatives by s",
            plain(kind)
        ),
    }
}

/// Returns the name of the constant for a table in emitted code.
pub fn write_constant_name(table: &Table) -> String {
    let derivative = |d: u8| {
        if d == 0 {
            String::new()
        } else {
            format!("_D{d}")
        }
    };
    let power = |k: u32| {
        if k == 0 {
            String::new()
        } else {
            format!("S{k}_")
        }
    };
    let name = match table.kind {
        TableKind::Wavenumber => "BETA_L".to_owned(),
        TableKind::Mixing => "XI".to_owned(),
        TableKind::GrowingAmplitude => "GROWING_AMPLITUDE".to_owned(),
        TableKind::FallingAmplitude => "FALLING_AMPLITUDE".to_owned(),
        TableKind::RisingAmplitude => "RISING_AMPLITUDE".to_owned(),
        TableKind::ShapeAtStart(d) => format!("PHI{}_AT_START", derivative(d)),
        TableKind::ShapeAtEnd(d) => format!("PHI{}_AT_END", derivative(d)),
        TableKind::ShapeAtPlace {
            bits,
            derivative: d,
        } => {
            let place = f64::from_bits(bits).to_string().replace('.', "_");
            format!("PHI{}_AT_{place}", derivative(d))
        }
        TableKind::Moment {
            power: k,
            derivative: d,
        } => {
            format!("INTEGRAL_{}PHI{}", power(k), derivative(d))
        }
        TableKind::OwnMoment {
            power: k,
            left,
            right,
        } if left == right => {
            format!("INTEGRAL_{}PHI{}_SQUARED", power(k), derivative(left))
        }
        TableKind::OwnMoment {
            power: k,
            left,
            right,
        } => {
            format!(
                "INTEGRAL_{}PHI{}_PHI{}",
                power(k),
                derivative(left),
                derivative(right)
            )
        }
        TableKind::PairMoment {
            power: k,
            left,
            right,
        } => {
            format!(
                "INTEGRAL_{}PHI{}_BY_PHI{}",
                power(k),
                derivative(left),
                derivative(right)
            )
        }
        TableKind::Indicator(mode) => format!("MODE_{mode}"),
        TableKind::NodePosition => "NODES".to_owned(),
        TableKind::NodeWeight => "WEIGHTS".to_owned(),
        TableKind::ShapeAtNodes(d) => format!("PHI{}_AT_NODES", derivative(d)),
    };
    if table.field.index() == 0 {
        name
    } else {
        format!("{name}_{}", table.field.index() + 1)
    }
}
