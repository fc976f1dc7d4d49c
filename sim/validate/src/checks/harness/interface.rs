// Prints the interface of emitted Rust, then reads parameters, times, states and inputs as hexadecimal bits, and prints
// the results of the functions the same way, in double precision and then in single precision.
#![allow(unused_variables)]

fn show<T: Copy + Into<f64>>(numbers: &[T]) {
    let words: Vec<String> = numbers.iter().map(|x| format!("{:016x}", (*x).into().to_bits())).collect();
    println!("{}", words.join(" "));
}

fn results<T: model::Scalar + Into<f64>>(
    numbers: &[f64],
    coefficients: &model::Coefficients/*OF T*/,
    convert: fn(f64) -> T,
) {
    let (given, signals) = numbers.split_at(1 + model::STATES);
    let t = convert(given[0]);
    let state: [T; model::STATES] = std::array::from_fn(|i| convert(given[1 + i]));
    let signals: [T; model::INPUTS] = std::array::from_fn(|i| convert(signals[i]));
    let inputs = model::Inputs::from(signals);
    let mut rates = [t; model::STATES];
    model::rates_into(t, &state, &inputs, coefficients, &mut rates);
    let again = model::rates(t, &state, &inputs, coefficients);
    for (again, rate) in again.iter().zip(&rates) {
        assert_eq!((*again).into().to_bits(), (*rate).into().to_bits(), "rates");
    }
    show(&rates);
    show(&model::observables(t, &state, &inputs, coefficients));
    show(&[model::energy(t, &state, &inputs, coefficients)]);
    show(&[model::power(t, &state, &inputs, coefficients)]);
    show(&model::guards(t, &state, &inputs, coefficients));
    show(model::mass_matrix(t, &state, &inputs, coefficients).as_flattened());
}

/// Number that compares the slopes of all elementary functions with differences.
#[derive(Clone, Copy)]
struct Probe(f64);

impl std::ops::Add for Probe {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}
impl std::ops::Sub for Probe {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}
impl std::ops::Mul for Probe {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}
impl std::ops::Div for Probe {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}
impl std::ops::Neg for Probe {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
impl model::Scalar for Probe {
    fn number(value: f64) -> Self {
        Self(value)
    }
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        if a.0 > b.0 { then } else { otherwise }
    }
    fn all_greater(a: Self, b: Self) -> bool {
        a.0 > b.0
    }
    fn function<F: model::Function>(self) -> Self {
        let value = F::value(self.0);
        compare_slope(F::slope(self.0, value), self.0, |x| F::value(x));
        Self(value)
    }
    fn function_of_two<F: model::FunctionOfTwo>(self, other: Self) -> Self {
        let value = F::value(self.0, other.0);
        let [by_first, by_second] = F::slopes(self.0, other.0, value);
        compare_slope(by_first, self.0, |x| F::value(x, other.0));
        compare_slope(by_second, other.0, |y| F::value(self.0, y));
        Self(value)
    }
}

/// Compares a slope with differences, unless they show a corner or a jump.
fn compare_slope(slope: f64, x: f64, value: impl Fn(f64) -> f64) {
    const STEP: f64 = 1e-5;
    let difference = |low: f64, high: f64| (value(high) - value(low)) / (high - low);
    let (below, above) = (difference(x - STEP, x), difference(x, x + STEP));
    let between = difference(x - STEP, x + STEP);
    let allowed = 1e-3 * between.abs() + 1e-6 * value(x).abs() + 1e-6;
    let is_smooth = (above - below).abs() <= allowed;
    assert!(
        !is_smooth || (slope - between).abs() <= allowed,
        "slope {slope} instead of {between} at {x}"
    );
}

/// Computes all functions with slopes.
fn probe_slopes(numbers: &[f64], coefficients: &model::Coefficients/*OF PROBE*/) {
    let (given, signals) = numbers.split_at(1 + model::STATES);
    let t = Probe(given[0]);
    let state: [Probe; model::STATES] = std::array::from_fn(|i| Probe(given[1 + i]));
    let signals: [Probe; model::INPUTS] = std::array::from_fn(|i| Probe(signals[i]));
    let inputs = model::Inputs::from(signals);
    model::rates(t, &state, &inputs, coefficients);
    model::observables(t, &state, &inputs, coefficients);
    model::guards(t, &state, &inputs, coefficients);
    model::mass_matrix(t, &state, &inputs, coefficients);
}

fn main() {
    //INTERFACE
    let lines: Vec<Vec<f64>> = (std::io::stdin().lines())
        .map(|line| {
            let line = line.unwrap();
            let words = line.split(' ').map(|word| u64::from_str_radix(word, 16).unwrap());
            words.map(f64::from_bits).collect()
        })
        .collect();
    for is_single in [false, true] {
        for numbers in &lines {
            let (numbers, point) = numbers.split_at(model::PARAMETERS);
            let parameters: [f64; model::PARAMETERS] = std::array::from_fn(|i| numbers[i]);
            let coefficients = model::Coefficients::prepare(&model::Parameters::from(parameters));
            println!("{}", i32::from(coefficients.positive_definite));
            if is_single {
                results::<f32>(point, &coefficients/*CAST*/, |x| x as f32);
            } else {
                results::<f64>(point, &coefficients, |x| x);
                probe_slopes(point, &coefficients/*PROBE*/);
            }
        }
    }
}
