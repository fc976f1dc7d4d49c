//! Sets of the undisclosed parameters, distributed evenly over plausible ranges.

use super::arm::UndisclosedParameters;

/// Range of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterRange {
    /// Name of the parameter.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Least and greatest value.
    pub bounds: (f64, f64),
    /// Reason for the range.
    pub reason: &'static str,
}

/// Searched ranges; the logarithms of the values are evenly distributed.
#[rustfmt::skip]
pub const RANGES: [ParameterRange; 5] = [
    ParameterRange { name: "I", unit: "m^4", bounds: (1e-10, 1e-8), reason: "sections of 1e-4 m^2: a strip 3.5 mm thick (1e-10), a 10 mm square (8.3e-10), a bar 30 mm high (7.5e-9), a thin tube (1e-8)" },
    ParameterRange { name: "a_m", unit: "N m", bounds: (0.1, 20.0), reason: "motors that can swing a 0.4 kg arm through a reducer of 4.7, up to some ten times what it needs" },
    ParameterRange { name: "b_m", unit: "N m s", bounds: (1e-3, 0.5), reason: "time constants J/b_m of the drive from 6 s to 12 ms; one set in four has 0: the drive accelerates during the whole record" },
    ParameterRange { name: "F_w", unit: "N m", bounds: (0.1, 20.0), reason: "ripple from a few per cent of the smallest a_m, to torques that bend the arm by centimetres" },
    ParameterRange { name: "c", unit: "N s/m", bounds: (195.0, 1950.0), reason: "3 % to 30 % of critical damping of the sun-planet mesh; damping ratios of 3 % to 17 % are usual for gear meshes" },
];

/// Every set at this interval has b_m = 0.
const UNDAMPED_INTERVAL: usize = 4;

/// Root above 1 of x^6 = x + 1. Powers of its reciprocal fill five dimensions evenly (M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018).
const HARMONIOUS_ROOT: f64 = 1.134_724_138_401_519_5;

/// Returns point `index` of a sequence that fills the unit cube evenly; the seed shifts it.
pub fn compute_sequence_point(index: usize, seed: u64) -> [f64; 5] {
    let golden = 0.618_033_988_749_894_9;
    let mut inverse = 1.0;
    std::array::from_fn(|axis| {
        inverse /= HARMONIOUS_ROOT;
        let shift = 0.5 + golden * (seed % 1_000_003) as f64 * (axis + 1) as f64;
        (shift + inverse * (index + 1) as f64).fract()
    })
}

/// Returns parameter set `index` of a search.
pub fn create_parameter_set(index: usize, seed: u64) -> UndisclosedParameters {
    let mut values = compute_sequence_point(index, seed);
    for (value, range) in values.iter_mut().zip(&RANGES) {
        let (low, high) = range.bounds;
        *value = low * (high / low).powf(*value);
    }
    let [second_moment, a_m, b_m, f_w, c] = values;
    let b_m = if index % UNDAMPED_INTERVAL == UNDAMPED_INTERVAL - 1 {
        0.0
    } else {
        b_m
    };
    UndisclosedParameters {
        second_moment,
        a_m,
        b_m,
        f_w,
        c,
    }
}

/// Returns neighbour `index` of a set, within +-10 % in each parameter.
pub fn create_neighbouring_set(
    of: &UndisclosedParameters,
    index: usize,
    seed: u64,
) -> UndisclosedParameters {
    let [i, a, b, f, c] = compute_sequence_point(index, seed).map(|share| 0.9 + 0.2 * share);
    UndisclosedParameters {
        second_moment: i * of.second_moment,
        a_m: a * of.a_m,
        b_m: b * of.b_m,
        f_w: f * of.f_w,
        c: c * of.c,
    }
}
