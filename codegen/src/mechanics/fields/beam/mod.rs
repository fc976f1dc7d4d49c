//! Modes of a uniform beam between two ends, each clamped, pinned, free or guided.
//!
//! A wave number is the sum of a multiple of pi/4 and a small difference d: cos z cosh z = 1 and -1 become
//! sin d = (-1)^(r+1) sech z, tan z = tanh z and -tanh z become tan d = -exp(-2 z) and exp(-2 z). The
//! amplitudes follow from the conditions at the two ends (R. D. Blevins, "Formulas for Natural Frequency and
//! Mode Shape", 1979, Table 8-1, where guided ends are called sliding). The second derivative of a mode is a
//! mode with clamped and free ends exchanged; a beam with a free start therefore has the wave numbers and the
//! wave of one with a clamped start.

use eomgen_elementary::Function;
use eomgen_model_spec::model::End;

use super::mode::{Mode, exponential, values_at};

#[cfg(test)]
mod tests;

pub(super) fn compute_mode(from: End, to: End, number: usize) -> Mode {
    let root = Root::solve(from, to, number);
    let wave = compute_wave_amplitudes(from, to, root);
    let wave_at_end = compute_wave_at_end(from, to, root, number, wave);
    let [falling, rising] = compute_exponential_amplitudes(from, to, root, wave, wave_at_end[0]);
    let [sine, cosine] = wave;
    let (falling_at_end, rising_at_start) = (falling * root.decay, rising * root.decay);
    // 4 int phi^2 = phi(1)^2 + phi''(1)^2/k^4 - 2 phi'(1) phi'''(1)/k^4; the same formula holds with the values at
    // the start. At an end with a decaying exponential, only one of these terms is not zero.
    let mean_square = match (from, to) {
        (start, _) if has_decaying_exponential(start) => [cosine; 2],
        (_, end) if has_decaying_exponential(end) => [wave_at_end[0]; 2],
        _ => [1.0, 0.5],
    };
    Mode {
        wavenumber: root.k,
        sine,
        cosine,
        falling,
        rising,
        at_start: values_at(
            from,
            [cosine, sine],
            [falling + rising_at_start, rising_at_start - falling],
        ),
        at_end: values_at(
            to,
            wave_at_end,
            [falling_at_end + rising, rising - falling_at_end],
        ),
        mean_square,
    }
}

/// Computes the mode `number` with beta_r l and xi_r as printed in Eq. (18) and (19) of the paper. This shape does not
/// satisfy the boundary conditions at its end, and its integrals have no closed form.
pub(super) fn compute_printed_mode(number: usize) -> Mode {
    let wavenumber = std::f64::consts::PI * (number as f64 - 0.5);
    let sine = -alternating_sign(number);
    let decay = exponential(-wavenumber);
    let mixing = (1.0 + decay * decay) / (2.0 * sine * decay + 1.0 - decay * decay);
    Mode {
        wavenumber,
        sine: 1.0,
        cosine: mixing,
        falling: 0.5 * (1.0 - mixing),
        rising: -0.5 * ((1.0 + mixing) / decay),
        at_start: [0.0, 0.0, f64::NAN, f64::NAN],
        at_end: [f64::NAN; 4],
        mean_square: [f64::NAN; 2],
    }
}

/// Returns true if every shape is a pure sine or cosine.
pub(super) fn is_sinusoidal(from: End, to: End) -> bool {
    !has_decaying_exponential(from) && !has_decaying_exponential(to)
}

/// Wave number k = beta_r l with its sine and cosine, which are computed more accurately than from the rounded k.
#[derive(Clone, Copy)]
struct Root {
    k: f64,
    sine: f64,
    cosine: f64,
    decay: f64,
}

impl Root {
    fn solve(from: End, to: End, number: usize) -> Self {
        let sign = alternating_sign(number);
        let hyperbolic = |k: f64| -sign * Function::Asin.apply(&[sech(exponential(-k))]);
        let tangent = |k: f64| Function::Atan.apply(&[exponential(-2.0 * k)]);
        match (has_decaying_exponential(from), has_decaying_exponential(to)) {
            (true, true) => {
                let unlike = sign_of_ends(from, to);
                let root = Self::solve_near_multiple(number, -2.0 * unlike, hyperbolic);
                Self {
                    cosine: -unlike * sech(root.decay),
                    ..root
                }
            }
            (false, false) if from == to => Self::solve_near_multiple(number, 0.0, |_| 0.0),
            (false, false) => Self::solve_near_multiple(number, -2.0, |_| 0.0),
            _ if from == End::Pinned || to == End::Pinned => {
                Self::solve_near_multiple(number, 1.0, |k| -tangent(k))
            }
            _ => Self::solve_near_multiple(number, -1.0, tangent),
        }
    }

    /// Finds the fixed point of the contraction k = (r + quarters/4) pi + offset(k).
    fn solve_near_multiple(number: usize, quarters: f64, offset: impl Fn(f64) -> f64) -> Self {
        let centre = std::f64::consts::PI * (number as f64 + 0.25 * quarters);
        let mut d = 0.0;
        for _ in 0..64 {
            let next = offset(centre + d);
            if next == d {
                break;
            }
            d = next;
        }
        let (small_sine, small_cosine) = (Function::Sin.apply(&[d]), Function::Cos.apply(&[d]));
        let [sine, cosine] =
            sine_and_cosine_of_quarters(quarters).map(|value| alternating_sign(number) * value);
        let k = centre + d;
        Self {
            k,
            sine: sine * small_cosine + cosine * small_sine,
            cosine: cosine * small_cosine - sine * small_sine,
            decay: exponential(-k),
        }
    }
}

/// Returns the sine and cosine of `quarters` pi/4 for `quarters` = -2 to 2.
fn sine_and_cosine_of_quarters(quarters: f64) -> [f64; 2] {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    if quarters == 0.0 {
        [0.0, 1.0]
    } else if quarters.abs() == 1.0 {
        [quarters * half, half]
    } else {
        [0.5 * quarters, 0.0]
    }
}

fn sech(decay: f64) -> f64 {
    2.0 * decay / (1.0 + decay * decay)
}

/// Returns true if shapes have an exponential that decays from this end.
fn has_decaying_exponential(end: End) -> bool {
    matches!(end, End::Clamped | End::Free)
}

/// Returns -1 for two equal ends (cos k cosh k = 1), and 1 for a clamped and a free end (cos k cosh k = -1).
fn sign_of_ends(from: End, to: End) -> f64 {
    if from == to { -1.0 } else { 1.0 }
}

/// Returns the amplitudes of sin z and cos z. The shape is scaled to amplitude 1 of the sine or, without a sine, of
/// the cosine.
fn compute_wave_amplitudes(from: End, to: End, root: Root) -> [f64; 2] {
    let square = root.decay * root.decay;
    let mixing = match (from, to) {
        (End::Pinned, _) => return [1.0, 0.0],
        (End::Guided, _) => return [0.0, 1.0],
        (_, End::Pinned) => -(1.0 - square) / (1.0 + square),
        (_, End::Guided) => -(1.0 + square) / (1.0 - square),
        // -(sin - sinh)/(cos - cosh) or -(sin + sinh)/(cos + cosh) at k, with numerator and denominator multiplied by
        // 2 exp(-k)
        _ => {
            let unlike = sign_of_ends(from, to);
            let numerator = 2.0 * root.sine * root.decay + unlike - unlike * square;
            -numerator / compute_wave_divisor(unlike, root)
        }
    };
    [1.0, mixing]
}

/// Returns cos k - cosh k or cos k + cosh k, times 2 exp(-k).
fn compute_wave_divisor(unlike: f64, root: Root) -> f64 {
    2.0 * root.cosine * root.decay + unlike + unlike * root.decay * root.decay
}

/// Returns the wave (the sine and cosine part) at the end, and its first derivative divided by k.
fn compute_wave_at_end(
    from: End,
    to: End,
    root: Root,
    number: usize,
    [a, c]: [f64; 2],
) -> [f64; 2] {
    if has_decaying_exponential(from) && has_decaying_exponential(to) {
        // If both ends are clamped or free, the wave is symmetric or antisymmetric about the middle.
        let sign = sign_of_ends(from, to) * alternating_sign(number);
        return [sign * c, -sign * a];
    }
    [
        a * root.sine + c * root.cosine,
        a * root.cosine - c * root.sine,
    ]
}

/// Returns the amplitudes of exp(-z) and exp(z - k).
fn compute_exponential_amplitudes(
    from: End,
    to: End,
    root: Root,
    wave: [f64; 2],
    wave_at_end: f64,
) -> [f64; 2] {
    let decay = root.decay;
    // The exponential cancels the wave at a clamped end and doubles it at a free end.
    let sense = |end| if end == End::Free { 1.0 } else { -1.0 };
    match (from, to) {
        (End::Pinned, end) if has_decaying_exponential(end) => {
            let rising = sense(end) * wave_at_end / (1.0 - decay * decay);
            [-rising * decay, rising]
        }
        (End::Guided, end) if has_decaying_exponential(end) => {
            let rising = sense(end) * wave_at_end / (1.0 + decay * decay);
            [rising * decay, rising]
        }
        (End::Pinned | End::Guided, _) => [0.0, 0.0],
        (start, end) => {
            let [sine, cosine] = wave;
            let falling = -sense(start) * 0.5 * (sine - cosine);
            let rising = match end {
                End::Pinned => -falling * decay,
                End::Guided => falling * decay,
                // -+(1 + xi) exp(k)/2
                _ => {
                    let unlike = sign_of_ends(from, to);
                    let above = root.cosine - root.sine + unlike * decay;
                    sense(start) * (above / compute_wave_divisor(unlike, root))
                }
            };
            [falling, rising]
        }
    }
}

fn alternating_sign(number: usize) -> f64 {
    if number.is_multiple_of(2) { 1.0 } else { -1.0 }
}
