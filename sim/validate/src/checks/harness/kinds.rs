// Harness for the emitted source, crate `model`; the check replaces comments in capitals.
#![allow(unused, non_snake_case, clippy::all)]

use model::{Function, FunctionOfTwo, Real, Scalar};
use std::ops::{Add, Div, Mul, Neg, Sub};

trait Print {
    fn print(&self);
}

fn line(numbers: &[f64]) {
    let words: Vec<String> = numbers.iter().map(|x| format!("{:016x}", x.to_bits())).collect();
    println!("{}", words.join(" "));
}

impl<const N: usize> Print for [f64; N] {
    fn print(&self) {
        line(self);
    }
}

impl<const N: usize, const M: usize> Print for [[f64; N]; M] {
    fn print(&self) {
        line(self.as_flattened());
    }
}

/// Number with a bound of its single-precision rounding error, by running error analysis to all orders (N. J. Higham,
/// Accuracy and Stability of Numerical Algorithms, section 3.3).
#[derive(Clone, Copy, Debug)]
struct Rounded {
    number: f64,
    error: f64,
}

/// Unit roundoff of single precision, and half the smallest subnormal number.
const UNIT: f64 = 1.0 / (1_u64 << 24) as f64;
const SMALLEST: f64 = 1.0 / ((1_u128 << 100) as f64 * (1_u64 << 50) as f64);

impl Rounded {
    /// Adds the rounding error of an elementary function, at most two units in the last place, to the propagated error.
    fn with_function_error(number: f64, error: f64) -> Self {
        Self::with_rounding(number, error + 3.0 * (UNIT * number.abs() + SMALLEST))
    }
    /// Returns a bound of the error of an angle. An angle above 1e5 has an error of at least one unit in the last
    /// place; an angle above 2^22 has no bound.
    fn argument_error(self) -> f64 {
        let size = self.number.abs() + self.error;
        let last_place = if size > 1e5 { 2.0 * UNIT * size } else { 0.0 };
        if size >= 4_194_304.0 { f64::INFINITY } else { self.error + last_place }
    }
    /// Adds the rounding error of the result to the propagated error.
    fn with_rounding(number: f64, error: f64) -> Self {
        let error = error + UNIT * number.abs() + SMALLEST;
        let beyond = number.abs() + error > f64::from(f32::MAX) || error.is_nan();
        Self { number, error: if beyond { f64::INFINITY } else { error } }
    }
}

impl Add for Rounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::with_rounding(self.number + other.number, self.error + other.error)
    }
}

impl Sub for Rounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::with_rounding(self.number - other.number, self.error + other.error)
    }
}

impl Mul for Rounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let error = self.number.abs() * other.error
            + other.number.abs() * self.error
            + self.error * other.error;
        Self::with_rounding(self.number * other.number, error)
    }
}

impl Div for Rounded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.number / other.number;
        let least = other.number.abs() - other.error;
        let error = if least > 0.0 {
            (self.error + quotient.abs() * other.error) / least
        } else {
            f64::INFINITY
        };
        Self::with_rounding(quotient, error)
    }
}

impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { number: -self.number, ..self }
    }
}

impl Scalar for Rounded {
    fn number(value: f64) -> Self {
        Self::with_rounding(value, 0.0)
    }
    /// Includes the other branch in the bound if single precision could select it.
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        let (chosen, other) = if a.number > b.number { (then, otherwise) } else { (otherwise, then) };
        if (a.number - b.number).abs() > a.error + b.error {
            return chosen;
        }
        let error = chosen.error.max((other.number - chosen.number).abs() + other.error);
        Self { error: if error.is_nan() { f64::INFINITY } else { error }, ..chosen }
    }
    fn all_greater(a: Self, b: Self) -> bool {
        a.number > b.number
    }
    fn function<F: Function>(self) -> Self {
        let value = F::value(self.number);
        let bound = self.argument_error();
        let error = [-bound, 0.0, bound].map(|error| {
            let near: f64 = F::value(self.number + error);
            let slope: f64 = F::slope(self.number + error, near);
            worse((near - value).abs(), slope.abs() * bound)
        });
        Self::with_function_error(value, worse(worse(error[0], error[1]), error[2]))
    }
    fn function_of_two<F: FunctionOfTwo>(self, other: Self) -> Self {
        let value = F::value(self.number, other.number);
        let mut error = 0.0;
        for first in [-self.error, 0.0, self.error] {
            for second in [-other.error, 0.0, other.error] {
                let (x, y) = (self.number + first, other.number + second);
                let near: f64 = F::value(x, y);
                let [by_first, by_second] = F::slopes(x, y, near);
                let bound = by_first.abs() * self.error + by_second.abs() * other.error;
                error = worse(error, worse((near - value).abs(), bound));
            }
        }
        Self::with_function_error(value, error)
    }
}

fn worse(first: f64, second: f64) -> f64 {
    if first.is_nan() || second.is_nan() { f64::INFINITY } else { first.max(second) }
}

#[derive(Default)]
struct Single {
    /// Largest error, in units of its bound.
    worst: f64,
    compared: usize,
    /// Results with a rounding bound below 1 % of the value.
    known: usize,
}

impl Single {
    fn compare(&mut self, found: &[f32], expected: &[Rounded]) {
        for (found, expected) in found.iter().zip(expected) {
            if !expected.number.is_finite() || !expected.error.is_finite() {
                // A result without an error bound must still be finite if the true value is within single precision.
                let fits = expected.number.abs() < f64::from(f32::MAX);
                if fits && !found.is_finite() {
                    self.worst = f64::INFINITY;
                }
                continue;
            }
            let error = (f64::from(*found) - expected.number).abs();
            if error != 0.0 {
                self.worst = worse(self.worst, error / expected.error);
            }
            self.compared += 1;
            self.known += usize::from(expected.error < 0.01 * expected.number.abs());
        }
    }
}

//INPUTS

//LANES

fn main() {
    let coefficients = model::Coefficients::prepare(&model::Parameters::default());
    let (single, bounded) = (coefficients/*CAST f32*/, coefficients/*CAST Rounded*/);
    let mut result = Single::default();
    let mut group = Vec::new();
    let mut lanes = [0_usize; 2];
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let mut numbers = line
            .split(' ')
            .map(|word| f64::from_bits(u64::from_str_radix(word, 16).unwrap()));
        let t = numbers.next().unwrap();
        let state: [f64; model::STATES] = std::array::from_fn(|_| numbers.next().unwrap());
        let given: [f64; INPUTS] = std::array::from_fn(|_| numbers.next().unwrap());
        let accelerations: [f64; model::DEGREES_OF_FREEDOM] =
            std::array::from_fn(|_| numbers.next().unwrap());
        let direction: [f64; model::STATES] = std::array::from_fn(|_| numbers.next().unwrap());
        let input_direction: [f64; INPUTS] =
            std::array::from_fn(|_| numbers.next().unwrap());
        let weights: [f64; model::STATES] = std::array::from_fn(|_| numbers.next().unwrap());
        let inputs = inputs_of(given);
        //CALLS
        let (t_single, x_single, u_single) = (t as f32, state.map(|x| x as f32), given.map(|x| x as f32));
        let exact = |x: f32| Rounded { number: f64::from(x), error: 0.0 };
        let (t_exact, x_exact) = (exact(t_single), x_single.map(exact));
        let (u_exact, u_single) = (inputs_of(u_single.map(exact)), inputs_of(u_single));
        result.compare(
            &model::rates(t_single, &x_single, &u_single, &single),
            &model::rates(t_exact, &x_exact, &u_exact, &bounded),
        );
        result.compare(
            &model::observables(t_single, &x_single, &u_single, &single),
            &model::observables(t_exact, &x_exact, &u_exact, &bounded),
        );
        group.push((t, state, given));
        //GROUPS
    }
    line(&[result.worst, result.compared as f64, result.known as f64]);
    line(&[lanes[0] as f64, lanes[1] as f64]);
}
