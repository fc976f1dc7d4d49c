//! Measured rates and accelerations of observables. They are added to the model as further
//! observables before the derivation.

use eomgen_model_spec::model::{Model, ObservedRate};

use crate::model::measured_outputs::{ObservedAcceleration, Output};
use eomgen_records::dataset::{Channel, Quantity};

/// Adds the measured derivatives of observables to a model. Returns for each channel the source of
/// the derivative, if it measures one.
pub(crate) fn add_observed_rates(model: &mut Model, channels: &[Channel]) -> Vec<Option<Output>> {
    let mut of = |channel: &Channel| match channel.quantity {
        Quantity::ObservedRate(rate) => Some(add_rate(model, rate)),
        _ => None,
    };
    channels.iter().map(&mut of).collect()
}

fn add_rate(model: &mut Model, rate: ObservedRate) -> Output {
    let observable = rate.observable;
    let holds_rate = model.contains_rate(&model.observables[observable].value);
    let index = model.observe_rate(rate);
    let of = match rate.times {
        1 if !holds_rate => return Output::Observable(index),
        1 => observable,
        _ => model.observe_rate(ObservedRate {
            observable,
            times: 1,
        }),
    };
    Output::Acceleration(ObservedAcceleration {
        index,
        observable: of,
    })
}

#[cfg(test)]
mod tests {
    use eomgen_codegen::program::evaluator::Point;
    use eomgen_model_spec::model::ObservedRate;
    use eomgen_records::dataset::{Channel, Quantity, TransducerPriors};

    use crate::model::estimation_model::EstimationModel;

    /// Pendulum with a moving support, and a first-order state that follows a torque.
    const SUPPORTED: &str = r#"[model]
name = "supported"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 0.5, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
tau = { value = 0.1, unit = "s" }
[coordinates]
x = { unit = "rad" }
[inputs]
s = { unit = "m", rates = 2 }
u = { unit = "N m" }
[states]
z = { unit = "N m", rate = "(u - z)/tau" }
y = { unit = "rad", rate = "(x - y)/tau" }
[definitions]
along = "s + l*sin(x)"
speed = "dot(along)"
[kinetic]
bob = "1/2*m*(dot(along)^2 + (l*sin(x)*dot(x))^2)"
[potential]
weight = "-m*g*l*cos(x)"
[forces]
drive = { on = "x", value = "z" }
[observables]
place = "along"
velocity = "speed"
torque = "z"
filtered = "y"
size = "abs(x)"
side = "sign(x)"
"#;

    /// Channel of the derivative of an observable, given by its name. `times`: order of the
    /// derivative.
    fn channel(name: &str, times: u8) -> Channel {
        let names = ["place", "velocity", "torque", "filtered", "size", "side"];
        let observable = names
            .iter()
            .position(|known| *known == name)
            .expect("an observable");
        Channel {
            name: "c".to_owned(),
            observable: "c".to_owned(),
            quantity: Quantity::ObservedRate(ObservedRate { observable, times }),
            unit: "1".to_owned(),
            noise: 1e-3,
            priors: TransducerPriors::default(),
        }
    }

    /// Returns the value of the channel for a state and inputs.
    fn measure_output(name: &str, times: u8, state: &[f64], inputs: &[f64]) -> f64 {
        let channel = [channel(name, times)];
        let model = EstimationModel::derive_equations(SUPPORTED, "supported", None, &channel);
        let model = model.expect("a model");
        let mut evaluator = model.create_evaluator(&model.values);
        let (mut buffers, mut values) = (model.measured.create_buffers(), Vec::new());
        let point = Point {
            t: 0.0,
            state,
            inputs,
        };
        model
            .measured
            .append(&mut evaluator, point, &mut buffers, &mut values);
        values[0]
    }

    #[test]
    fn derivatives_match_motion() {
        let (m, l, g, tau) = (2.0, 0.5, 9.81, 0.1);
        let (x, v, z, y): (f64, f64, f64, f64) = (0.7, -1.3, 0.9, 0.2);
        let [s_dot, s_ddot, u] = [0.4, -2.1, 3.0];
        let (state, inputs) = ([x, v, z, y], [0.3, s_dot, s_ddot, u]);
        // m l^2 x'' + m l cos(x) s'' + m g l sin(x) = z.
        let a = (z - m * g * l * x.sin() - m * l * x.cos() * s_ddot) / (m * l * l);
        let acceleration = s_ddot + l * (x.cos() * a - x.sin() * v * v);
        let y_dot = (x - y) / tau;
        let right = [
            ("place", 1, s_dot + l * x.cos() * v),
            ("place", 2, acceleration),
            ("velocity", 1, acceleration),
            ("torque", 1, (u - z) / tau),
            ("filtered", 1, y_dot),
            ("filtered", 2, (v - y_dot) / tau),
            ("size", 1, v),
        ];
        for (name, times, right) in right {
            let found = measure_output(name, times, &state, &inputs);
            assert!(
                (found - right).abs() < 1e-12,
                "{name} {times}: {found} {right}"
            );
        }
    }

    #[test]
    fn undefined_derivatives_are_rejected() {
        let reasons = [
            (
                "velocity",
                2,
                "needs the time derivative of an acceleration",
            ),
            ("torque", 2, "needs the rate of an input"),
            ("size", 2, "not defined at jumps"),
            ("side", 1, "not defined at jumps"),
        ];
        for (name, times, reason) in reasons {
            let channel = [channel(name, times)];
            let model = EstimationModel::derive_equations(SUPPORTED, "supported", None, &channel);
            let message = model.err().expect("rejected").to_string();
            assert!(message.contains(reason), "{name} {times}: {message}");
            assert!(message.contains(name), "{message}");
        }
    }

    #[test]
    fn changed_accelerations_affect_outputs_immediately() {
        let (l, x): (f64, f64) = (0.5, 0.7);
        let (state, inputs) = ([x, -1.3, 0.9, 0.2], [0.3, 0.4, -2.1, 3.0]);
        for (name, times, right) in [
            ("place", 2, l * x.cos()),
            ("velocity", 1, l * x.cos()),
            ("place", 1, 0.0),
        ] {
            let channel = [channel(name, times)];
            let model = EstimationModel::derive_equations(SUPPORTED, "supported", None, &channel);
            let model = model.expect("a model");
            let mut evaluator = model.create_evaluator(&model.values);
            let point = Point {
                t: 0.0,
                state: &state,
                inputs: &inputs,
            };
            let mut row = [0.0];
            let changes = (&[2.0, 0.0, 0.0][..], 1e-3);
            model
                .measured
                .add_to_accelerations(&mut evaluator, point, changes, &mut row);
            assert!(
                (row[0] - 2.0 * right).abs() < 1e-9,
                "{name} {times}: {}",
                row[0]
            );
        }
    }
}
