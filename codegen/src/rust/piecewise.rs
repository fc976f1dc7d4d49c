//! Emitted helpers of piecewise functions, with a selection in every call, or for a side given by the
//! constant number of a regime.

/// f_k of Eq. (7).
pub const DEADZONE: &str = "\
/// Deflection beyond the backlash: f_k of Eq. (7).
#[inline(always)]
fn deadzone<T: Scalar>(p: T, b: T) -> T {
    let held = T::select_greater(p, b, b, p);
    p - T::select_greater(-b, held, -b, held)
}
";

/// Indicator of |p| > b, Eq. (8).
pub const CONTACT: &str = "\
/// Returns 1 if |p| > b, else 0: the contact of Eq. (8).
#[inline(always)]
fn contact<T: Scalar>(p: T, b: T) -> T {
    let beyond = T::select_greater(-b, p, T::number(1.0), T::number(0.0));
    T::select_greater(p, b, T::number(1.0), beyond)
}
";

/// Indicator of p > 0.
pub const ABOVE: &str = "\
/// Returns 1 if p > 0, else 0.
#[inline(always)]
fn above<T: Scalar>(p: T) -> T {
    T::select_greater(p, T::number(0.0), T::number(1.0), T::number(0.0))
}
";

/// f_k on a given side of its dead zone.
pub const DEADZONE_ON_SIDE: &str = "\
/// Deflection beyond the backlash on a given side of it: f_k of Eq. (7).
#[inline(always)]
fn deadzone_on_side<T: Scalar>(above: bool, beyond: bool, p: T, b: T) -> T {
    if above { p - b } else if beyond { T::number(0.0) } else { p + b }
}
";

/// Contact on a given side of its dead zone.
pub const TOUCHING: &str = "\
/// Returns true if there is contact on a given side of the backlash.
#[inline(always)]
fn touching(above: bool, beyond: bool) -> bool {
    above || !beyond
}
";

/// Indicator for a function on either side of its zero interval.
pub const EITHER: &str = "\
/// Returns true if a switching function is on either side of its zero interval.
#[inline(always)]
fn either(above: bool, below: bool) -> bool {
    above || below
}
";

/// Selection at compile time.
pub const CHOSEN: &str = "\
/// Selects one of two numbers at compile time.
#[inline(always)]
fn chosen<T: Scalar>(first: bool, then: T, otherwise: T) -> T {
    if first { then } else { otherwise }
}
";

/// Side of a guard in a regime.
pub const POSITIVE: &str = "\
/// Returns true if the guard with this index is positive in a regime.
#[inline(always)]
fn positive(regime: u32, guard: u32) -> bool {
    regime >> guard & 1 == 1
}
";
