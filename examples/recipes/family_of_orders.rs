//! Compares four orders of one specification in one program: the response of the beam to a torque pulse.

/// Torque on the hub in N m: 0.1 for a tenth of a second, then -0.1 for a tenth of a second.
fn torque(t: f64) -> f64 {
    match t {
        t if t < 0.1 => 0.1,
        t if t < 0.2 => -0.1,
        _ => 0.0,
    }
}

/// Returns the hub angle in mrad and the tip deflection in mm after 0.5 s, by the classical
/// Runge-Kutta method.
macro_rules! response {
    ($model:ident) => {{
        use $model::{Coefficients, Inputs, OBSERVABLES, Parameters, STATES};
        let coefficients = Coefficients::prepare(&Parameters::default());
        assert!(coefficients.positive_definite);
        let (mut x, h) = ([0.0; STATES], 1e-4);
        for step in 0..5000 {
            let t = f64::from(step) * h;
            let inputs = Inputs {
                u: torque(t + 0.5 * h),
            };
            let rates = |x: &[f64; STATES]| $model::rates(t, x, &inputs, &coefficients);
            let ahead = |k: &[f64; STATES], h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
            let k_1 = rates(&x);
            let k_2 = rates(&ahead(&k_1, 0.5 * h));
            let k_3 = rates(&ahead(&k_2, 0.5 * h));
            let k_4 = rates(&ahead(&k_3, h));
            for i in 0..STATES {
                x[i] += h / 6.0 * (k_1[i] + 2.0 * k_2[i] + 2.0 * k_3[i] + k_4[i]);
            }
        }
        let outputs: [f64; OBSERVABLES] =
            $model::observables(0.5, &x, &Inputs::default(), &coefficients);
        (STATES, 1e3 * x[0], 1e3 * outputs[0])
    }};
}

fn main() {
    let responses = [
        (1, response!(beam_1)),
        (2, response!(beam_2)),
        (4, response!(beam_4)),
        (8, response!(beam_8)),
    ];
    let (_, (_, _, reference)) = responses[3];
    for (order, (states, angle, tip)) in responses {
        let error = tip - reference;
        println!(
            "S = {order}: {states:2} states, hub {angle:.4} mrad, tip {tip:.4} mm, error {error:+.4} mm"
        );
    }
}
