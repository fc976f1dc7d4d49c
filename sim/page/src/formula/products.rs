//! Products and quotients. Numbers are first, then symbols, then integrals and sums over modes, which end at
//! their differential or extend to the end of the product. The number before a quotient is part of its
//! numerator and denominator.

use eomgen_codegen::symbolic::formula::{Formula, Level, find_small_fraction};
use eomgen_codegen::symbolic::tables::TableKind;
use maud::{Markup, html};

use super::{formula_at_level, identifier, number, parenthesise, times};

/// Returns a number times the product `above`, divided by the product `below`.
pub(super) fn quotient(magnitude: f64, above: &[Formula], below: &[Formula]) -> Markup {
    if below.is_empty() {
        return multiple(magnitude, above, Level::Product);
    }
    let (numerator, denominator) = match find_small_fraction(magnitude) {
        Some((numerator, denominator)) => (numerator, f64::from(denominator)),
        None => (magnitude, 1.0),
    };
    html! {
        mfrac {
            mrow { (multiple(numerator, above, Level::Sum)) }
            mrow { (multiple(denominator, below, Level::Sum)) }
        }
    }
}

/// Returns a number times a product; `level` is the precedence of the surrounding formula.
fn multiple(magnitude: f64, factors: &[Formula], level: Level) -> Markup {
    match (magnitude == 1.0, factors) {
        (_, []) => number(magnitude),
        (true, [only]) => formula_at_level(only, level),
        (true, _) => product(factors),
        (false, _) => html! { (factor(magnitude)) (times()) (product(factors)) },
    }
}

/// Returns factors in a row; a sum over modes that precedes other factors gets parentheses.
fn product(factors: &[Formula]) -> Markup {
    let mut ordered: Vec<&Formula> = factors.iter().collect();
    ordered.sort_by_key(|factor| rank(factor));
    let last = ordered.len().saturating_sub(1);
    html! {
        @for (index, factor) in ordered.into_iter().enumerate() {
            @if index > 0 { (times()) }
            @match factor {
                Formula::Total(..) if index < last => (parenthesise("(", &formula_at_level(factor, Level::Sum), ")")),
                _ => (formula_at_level(factor, Level::Product)),
            }
        }
    }
}

/// Returns the sort key of a factor in a product.
fn rank(factor: &Formula) -> u8 {
    match factor {
        Formula::Number(_) => 0,
        Formula::Table(
            TableKind::Moment { .. } | TableKind::OwnMoment { .. } | TableKind::PairMoment { .. },
        ) => 2,
        Formula::Total(..) => 3,
        _ => 1,
    }
}

/// Returns the numerical factor before a product, as a fraction if it equals a small fraction.
pub(super) fn factor(magnitude: f64) -> Markup {
    match find_small_fraction(magnitude) {
        Some((numerator, denominator)) => {
            html! { mfrac { mn { (numerator.to_string()) } mn { (denominator) } } }
        }
        None => number(magnitude),
    }
}

/// Returns a factor times a power of π.
pub(super) fn power_of_pi((multiple, power): (f64, i32)) -> Markup {
    let pi = identifier("π");
    html! {
        @if multiple != 1.0 { (factor(multiple)) (times()) }
        @if power == 1 { (pi) } @else { msup { (pi) mn { (power) } } }
    }
}
