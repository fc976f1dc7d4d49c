//! Times of a record, counted from its first sample. Unix times in s as doubles are multiples of 2.4e-7 s, so their
//! differences are not the time steps of the record.

use eomgen_model_spec::model::{ExprKind, Model};
use eomgen_model_spec::unit::Unit;

use crate::decimal::Decimal;
use crate::header::Table;
use crate::samples::typical_step;

/// Times in s. The origin of these times is `origin` in the file.
pub(crate) struct Clock {
    pub times: Vec<f64>,
    pub origin: f64,
}

impl Clock {
    /// Returns the times in the first column of a table, in s; NaN for a missing time. Times counted from the first
    /// sample do not depend on the origin of the file.
    pub fn new(table: &Table, unit: &Unit, counts_from_first: bool) -> Self {
        let read = &table.columns[0];
        let in_si = |times: &[f64]| times.iter().map(|t| unit.to_si(*t)).collect();
        match read.first().copied().filter(|_| counts_from_first) {
            Some(first) => Self {
                times: in_si(&count_from_first(read, &table.decimals)),
                origin: unit.to_si(first),
            },
            None => Self {
                times: in_si(read),
                origin: 0.0,
            },
        }
    }
}

/// Returns true if the equations or an observable contain the time, so that its origin has an effect.
pub(crate) fn contains_time(model: &Model) -> bool {
    model.motion_expressions().any(|expression| {
        let mut found = false;
        expression.visit(&mut |part| found |= matches!(part.kind, ExprKind::Time));
        found
    })
}

/// Returns the differences from the first time, without the rounding errors of the times.
fn count_from_first(read: &[f64], decimals: &[Option<Decimal>]) -> Vec<f64> {
    let first = decimals[0];
    let difference = |(time, decimal): (&f64, &Option<Decimal>)| match decimal.zip(first) {
        Some((decimal, first)) => decimal.subtract(first).unwrap_or(time - read[0]),
        None => time - read[0],
    };
    let counted: Vec<f64> = read.iter().zip(decimals).map(difference).collect();
    let may_be_rounded = decimals.iter().flatten().any(|time| time.may_be_rounded());
    if may_be_rounded && let Some(even) = even_times(read, &counted) {
        return even;
    }
    counted
}

/// Returns the multiples of one time step that differ from the times by at most two roundings to doubles; `None`
/// without such a step. A time and both ends of the record have rounding errors of half a unit each, and their decimals
/// have as much again.
fn even_times(read: &[f64], counted: &[f64]) -> Option<Vec<f64>> {
    let largest = read
        .iter()
        .fold(0.0, |most: f64, time| most.max(time.abs()));
    let rounding = largest.next_up() - largest;
    let usual = typical_step(counted);
    let mut number = 0.0;
    let mut numbers = vec![number];
    for pair in counted.windows(2) {
        number += ((pair[1] - pair[0]) / usual).round();
        numbers.push(number);
    }
    let step = counted.last()? / number;
    let even: Vec<f64> = numbers.iter().map(|number| number * step).collect();
    let mut pairs = even.iter().zip(counted);
    pairs
        .all(|(even, counted)| (even - counted).abs() <= 2.0 * rounding)
        .then_some(even)
}

#[cfg(test)]
mod tests {
    use super::count_from_first;
    use crate::decimal::Decimal;

    #[test]
    fn even_times_lose_the_rounding_of_doubles() {
        let step = 1.0 / 3.0e3;
        let numbers = (0..2000).filter(|k| *k < 900 || *k > 950);
        let exact: Vec<f64> = numbers.map(|k| f64::from(k) * step).collect();
        for origin in [0.3, 1.7e9, -4e8] {
            let read: Vec<f64> = exact.iter().map(|t| origin + t).collect();
            let decimals: Vec<_> = read.iter().map(|t| Decimal::from_double(*t)).collect();
            for (found, exact) in count_from_first(&read, &decimals).iter().zip(&exact) {
                assert!(
                    (found - exact).abs() <= 2.4e-7 * (1.0 + exact),
                    "{origin}: {found} {exact}"
                );
            }
        }
    }

    #[test]
    fn uneven_times_are_kept() {
        let read = [1.7e9, 1.7e9 + 1.25e-3, 1.7e9 + 2.75e-3];
        let decimals = read.map(Decimal::from_double);
        let found = count_from_first(&read, &decimals);
        assert!((found[2] - 2.75e-3).abs() < 2.4e-7 && (found[1] - 1.25e-3).abs() < 2.4e-7);
    }
}
