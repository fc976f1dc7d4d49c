// Prints the interface of emitted Rust. Then it reads parameters, times, states and inputs as hexadecimal bits and
// prints the results of the functions as bits, first in double and then in single precision.
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
        let (again, rate): (f64, f64) = ((*again).into(), (*rate).into());
        assert!(again.to_bits() == rate.to_bits() || (again.is_nan() && rate.is_nan()), "rates");
    }
    show(&rates);
    show(&model::observables(t, &state, &inputs, coefficients));
    show(&[model::energy(t, &state, &inputs, coefficients)]);
    show(&[model::power(t, &state, &inputs, coefficients)]);
    show(&model::guards(t, &state, &inputs, coefficients));
    show(model::mass_matrix(t, &state, &inputs, coefficients).as_flattened());
    //STEP
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
        for (call, numbers) in lines.iter().enumerate() {
            let (numbers, point) = numbers.split_at(model::PARAMETERS);
            let parameters: [f64; model::PARAMETERS] = std::array::from_fn(|i| numbers[i]);
            let parameters = &model::Parameters::from(parameters);
            let coefficients = model::Coefficients::prepare(parameters);
            println!("{}", i32::from(coefficients.positive_definite));
            if is_single {
                results::<f32>(point, &coefficients/*CAST*/, |x| x as f32);
            } else {
                results::<f64>(point, &coefficients, |x| x);
                //CONTROLLERS
            }
        }
    }
}
