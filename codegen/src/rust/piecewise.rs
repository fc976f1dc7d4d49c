//! Emitted helpers of piecewise functions in a regime whose number is a compile-time constant. The regime determines
//! the side.

/// Dead-zone function f_k of Eq. (7) on a given side of the play.
pub const DEADZONE_ON_SIDE: &str = "\
/// Returns the deflection beyond the play on a given side.
#[inline(always)]
fn deadzone_on_side<T: Scalar>(above: bool, beyond: bool, p: T, b: T) -> T {
    if above { p - b } else if beyond { T::number(0.0) } else { p + b }
}
";

/// Contact on a given side of the play.
pub const TOUCHING: &str = "\
/// Returns true if there is contact on a given side of the play.
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
