//! Arguments for which an inaccurate reduction or rounding fails, found by number theory.

/// `floor(2/pi * 2^127)`.
const TWO_OVER_PI: u128 = 0x517c_c1b7_2722_0a94_fe13_abe8_fa9a_6ee0;

/// Returns the doubles up to 1e9 that are closest to a multiple of pi/2. If `p/q` is a convergent of the
/// continued fraction of `2/pi 2^(e-52)`, then `q 2^(e-52)` is nearly `p pi/2`.
pub fn near_multiples_of_half_pi() -> Vec<f64> {
    let mut found = Vec::new();
    for exponent in 0..=29_u32 {
        let unit = 2f64.powi(exponent as i32 - 52);
        for (p, q) in convergents(TWO_OVER_PI >> (52 - exponent), 1 << 127) {
            let x = q as f64 * unit;
            if p > 0 && x <= 1e9 {
                found.push(x);
                found.push(-x);
            }
        }
    }
    found
}

/// Returns the convergents `p/q`, `q < 2^53`, of `numerator/denominator`.
fn convergents(mut numerator: u128, mut denominator: u128) -> Vec<(u128, u128)> {
    let (mut previous, mut current) = ((0, 1), (1, 0));
    let mut found = Vec::new();
    while denominator != 0 {
        let quotient = numerator / denominator;
        (numerator, denominator) = (denominator, numerator % denominator);
        let Some(next) = step(quotient, previous, current) else {
            break;
        };
        (previous, current) = (current, next);
        found.push(current);
    }
    found
}

fn step(quotient: u128, previous: (u128, u128), current: (u128, u128)) -> Option<(u128, u128)> {
    let q = quotient.checked_mul(current.1)?.checked_add(previous.1)?;
    let p = quotient.checked_mul(current.0)?.checked_add(previous.0)?;
    (q < 1 << 53).then_some((p, q))
}

/// Returns doubles in `[1, 4)` whose square root is almost halfway between two doubles. The doubles are `s^2 -
/// offset` for an odd `s` of 54 bits with `s^2 = offset (mod 2^bits)` and a small `offset`.
pub fn roots_near_a_tie() -> Vec<f64> {
    let mut found = Vec::new();
    for bits in [54, 55] {
        for offset in (-20..20_i128).map(|i| 8 * i + 1) {
            for s in square_roots_modulo(offset, bits) {
                let in_range = if bits == 54 {
                    s * s < 1 << 107
                } else {
                    s * s >= 1 << 107
                };
                if in_range && (1 << 53..1 << 54).contains(&s) {
                    let mantissa = ((s * s - offset) >> bits) as f64;
                    found.push(mantissa * 2f64.powi(bits as i32 - 106));
                }
            }
        }
    }
    found
}

/// Returns the odd `s < 2^54` with `s^2 = square (mod 2^bits)`, for `square = 1 (mod 8)`, bit by bit.
fn square_roots_modulo(square: i128, bits: u32) -> Vec<i128> {
    let mut root = 1_i128;
    for bit in 3..bits {
        if (root * root - square) >> bit & 1 == 1 {
            root += 1 << (bit - 1);
        }
    }
    let half = 1_i128 << (bits - 1);
    let modulus = 1_i128 << bits;
    [root, half - root, half + root, modulus - root]
        .map(|s| s.rem_euclid(modulus))
        .into_iter()
        .collect()
}
