//! Nonlinear remainder: rates of the whole model minus rates of its linear part, from two compiled
//! programs.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use eomgen_sim::exponential::Force;

/// Rates of a model minus those of its linear part, with fixed parameters.
pub(crate) struct NonlinearRemainder {
    whole: Evaluator,
    linear: Evaluator,
    rates: [Vec<f64>; 2],
    /// Index in the whole model of each guard of the linear part, if they differ.
    guards: Option<Vec<usize>>,
    values: Vec<f64>,
}

impl NonlinearRemainder {
    /// Combines a model and its linear part, which must have the same states.
    pub fn new(whole: Evaluator, linear: Evaluator) -> Self {
        let states = whole.program().states();
        Self {
            guards: match_guards(&whole, &linear),
            values: vec![0.0; whole.guard_count()],
            rates: [vec![0.0; states], vec![0.0; states]],
            whole,
            linear,
        }
    }
}

/// Returns the index in the whole model of each guard of the linear part: the guard with the same
/// formula, or else the next guard without a counterpart. `None` if all guards are equal, or if the
/// numbers of guards without a counterpart differ.
fn match_guards(whole: &Evaluator, linear: &Evaluator) -> Option<Vec<usize>> {
    let formulas = |model: &Evaluator| -> Vec<String> {
        let guards = model.program().guards.iter();
        guards.map(|guard| guard.formula.clone()).collect()
    };
    let (all, own) = (formulas(whole), formulas(linear));
    let is_single = [(whole, &all), (linear, &own)]
        .into_iter()
        .all(|(model, formulas)| model.guard_count() == formulas.len());
    let unmatched: Vec<usize> = (0..all.len()).filter(|g| !own.contains(&all[*g])).collect();
    let changed = own.iter().filter(|formula| !all.contains(formula)).count();
    if !is_single || changed == 0 || changed != unmatched.len() {
        return None;
    }
    let mut unmatched = unmatched.into_iter();
    let corresponding = own.iter().map(|formula| {
        let same = all.iter().position(|known| known == formula);
        same.or_else(|| unmatched.next())
    });
    corresponding.collect()
}

impl Force for NonlinearRemainder {
    fn write_accelerations(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut [f64]) {
        let [whole, linear] = &mut self.rates;
        self.whole.rates(Point { t, state, inputs }, whole);
        self.linear.rates(Point { t, state, inputs }, linear);
        let first = whole.len() - out.len();
        let pairs = whole[first..].iter().zip(&linear[first..]);
        let differences = pairs.map(|(a, b)| a - b);
        out.iter_mut()
            .zip(differences)
            .for_each(|(slot, difference)| *slot = difference);
    }

    fn write_guards(&mut self, t: f64, state: &[f64], inputs: &[f64], out: &mut Vec<f64>) -> bool {
        let Some(guards) = &self.guards else {
            return false;
        };
        self.whole
            .guards(Point { t, state, inputs }, &mut self.values);
        out.clear();
        out.extend(guards.iter().map(|guard| self.values[*guard]));
        true
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::{Path, PathBuf};

    use eomgen_sim::inputs::HeldInputs;

    use crate::model::estimation_model::EstimationModel;
    use crate::model::output_times::OutputRate;
    use crate::model::simulation::TangentDrives;
    use eomgen_records::dataset::{Channel, Quantity, TransducerPriors};
    use eomgen_records::record::Record;
    use eomgen_sim::exponential::NoDrives;

    /// Returns the text of the test rig, and of the test rig with a transmission error of more than
    /// twice the play.
    fn texts() -> (String, String) {
        let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models");
        let rig = fs::read_to_string(models.join("planetary_arm_rig.toml")).expect("the rig");
        let seen = "seen = \"x_sp - 2.4*b_sp*cos(2*theta_s) - 0.8*b_sp*sin(2*theta_s)\"";
        let with = rig
            .replace("(x_sp, b_sp)", "(seen, b_sp)")
            .replace(")*dot(x_sp)", ")*dot(seen)")
            .replace("[definitions]", &format!("[definitions]\n{seen}"));
        assert_eq!(with.matches("(seen, b_sp)").count(), 4);
        (rig, with)
    }

    /// Returns the model of the test rig with transmission error and its text. Also returns a
    /// record of its torque, its channels, and an initial state in the middle of the play.
    fn simulate_rig() -> (EstimationModel, String, Record, [Channel; 1], Vec<f64>) {
        let (rig, with) = texts();
        let channels = [Channel {
            name: "x_sp".to_owned(),
            observable: "x_sp".to_owned(),
            quantity: Quantity::Coordinate(0),
            unit: "m".to_owned(),
            noise: 1e-7,
            priors: TransducerPriors::default(),
        }];
        let times: Vec<f64> = (0..400).map(|k| f64::from(k) * 5e-4).collect();
        let torque = times.iter().map(|t| 2.0 * (20.0 * t).sin() + 0.5);
        let torque: Vec<f64> = torque.collect();
        let inputs = HeldInputs::new(times.clone(), torque.clone(), 1).expect("inputs");
        let record = Record {
            name: "train[0]".to_owned(),
            path: PathBuf::new(),
            times,
            origin: 0.0,
            inputs,
            input_columns: vec![torque],
            channels: Vec::new(),
            is_continued: false,
        };
        let mut integrated =
            EstimationModel::derive(&with, Some(&rig), "rig", Some(4), &channels).expect("a model");
        let mut initial = vec![0.0; integrated.state_count()];
        initial[0] = 60e-6;
        integrated.choose_steps(&record, &initial, &[1e-7], 400.0, OutputRate::SAMPLES);
        (integrated, with, record, channels, initial)
    }

    #[test]
    fn contacts_match_whole_model() {
        let (integrated, with, record, channels, initial) = simulate_rig();
        let solved =
            EstimationModel::derive_equations(&with, "rig", Some(4), &channels).expect("a model");
        let states = |model: &EstimationModel| {
            let mut simulation = model
                .create_simulation(&model.values)
                .expect("a simulation");
            let found = simulation.simulate_states(&initial, &record.times, &record.inputs);
            (simulation.has_tangents(), found.expect("a motion"))
        };
        let ((carries_tangents, found), (_, wanted)) = (states(&integrated), states(&solved));
        assert!(carries_tangents);
        // The play is 25 um. Near an impact, a time error causes a position error.
        let differences = found.iter().zip(&wanted).map(|(a, b)| (a[0] - b[0]).abs());
        let mut differences: Vec<f64> = differences.collect();
        differences.sort_by(f64::total_cmp);
        assert!(wanted.iter().any(|state| state[0].abs() > 5e-5));
        assert!(differences[200] < 1e-8, "{:e}", differences[200]);
        assert!(differences[399] < 2e-6, "{:e}", differences[399]);
    }

    #[test]
    fn tangents_include_nonlinear_remainder() {
        let (integrated, _, record, _, initial) = simulate_rig();
        let mut simulation = integrated
            .create_simulation(&integrated.values)
            .expect("a simulation");
        // The teeth touch once and separate before the third sample.
        let times = &record.times[..4];
        let free = TangentDrives {
            count: 0,
            drives: &mut NoDrives,
        };
        let found = simulation
            .simulate_with_tangents(&initial, times, &record.inputs, (true, 0), free)
            .expect("tangents");
        let count = initial.len();
        for (state, tangent) in found.by_state[3 * count..].iter().enumerate() {
            let size = if state < count / 2 { 1e-10 } else { 1e-7 };
            let [more, less] = [size, -size].map(|change| {
                let mut moved = initial.clone();
                moved[state] += change;
                let states = simulation.simulate_states(&moved, times, &record.inputs);
                states.expect("a motion")[3][0]
            });
            let quotient = (more - less) / (2.0 * size);
            // The tolerance is large: the force is held over two steps, and the contact lasts
            // three.
            let is_near = (tangent - quotient).abs() < 3e-2 * quotient.abs();
            assert!(is_near, "{state}: {tangent:e} for {quotient:e}");
        }
    }
}
