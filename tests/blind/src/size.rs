//! How large a hidden effect is: the root mean square over the windows of what it does to the
//! outputs, in noises, after everything the null model may fit has been taken out of it -
//! initial states freely, declared parameters and sensors within their priors. Sizes are
//! sought so that this is a given number of floors.

use nalgebra::{DMatrix, DVector};

use crate::hidden::{Effect, Hidden, Sensors};
use crate::inputs::Drive;
use crate::integrate::Stepper;
use crate::machines::{Machine, Setup};

/// Sizes are right to this part.
const RIGHT: f64 = 0.02;

/// The most looks at a size.
const MOST_LOOKS: usize = 12;

/// An effect with its size found.
pub struct Sized {
    /// The effect.
    pub hidden: Hidden,
    /// What was reached, in floors.
    pub floors: f64,
}

/// Finds the size at which an effect stands `level` times above the floor; for a sensor's
/// fault or a declared parameter, the size is `level + 2` standard deviations of its prior
/// (beyond three it is an effect) and the floors are what that comes to.
pub fn sized(
    machine: &Machine,
    setup: &Setup,
    drives: &[Drive],
    mut hidden: Hidden,
    level: f64,
) -> Sized {
    // Half the steps do for a size.
    let coarse = Setup {
        steps: setup.steps / 2,
        ..setup.clone()
    };
    if let Some(deviation) = hidden.prior(setup) {
        hidden.amount = deviation * (level.min(10.0) + 2.0);
    } else {
        (hidden.amount, _) = range(&hidden, machine);
    }
    let basis = Basis::new(machine, &coarse, drives, &hidden);
    let mut floors = basis.floors(machine, &coarse, drives, &hidden);
    if hidden.prior(setup).is_some() {
        return Sized { hidden, floors };
    }
    let (_, largest) = range(&hidden, machine);
    let mut search = Search::new(level);
    search.look(hidden.amount, floors);
    for _ in 0..MOST_LOOKS {
        let next = search.next().min(largest);
        if search.is_found() || search.best.0 == next {
            break;
        }
        hidden.amount = next;
        floors = basis.floors(machine, &coarse, drives, &hidden);
        search.look(next, floors);
    }
    (hidden.amount, floors) = search.best;
    Sized { hidden, floors }
}

/// A search for the amount that stands a level high: by proportion until it lies between two
/// amounts, then by proportion of logarithms between these.
struct Search {
    level: f64,
    below: Option<(f64, f64)>,
    above: Option<(f64, f64)>,
    /// The amount that comes nearest and its floors.
    best: (f64, f64),
}

impl Search {
    fn new(level: f64) -> Self {
        Self {
            level,
            below: None,
            above: None,
            best: (0.0, f64::INFINITY),
        }
    }

    fn distance(&self, floors: f64) -> f64 {
        (floors / self.level).ln().abs()
    }

    fn is_found(&self) -> bool {
        self.distance(self.best.1) < RIGHT
    }

    /// What an amount came to; not a number where the machine could not stand it.
    fn look(&mut self, amount: f64, floors: f64) {
        let nearer = self.distance(floors) < self.distance(self.best.1);
        if floors.is_finite() && (nearer || self.best.1.is_infinite()) {
            self.best = (amount, floors);
        }
        if floors < self.level {
            if self.below.is_none_or(|(known, _)| amount > known) {
                self.below = Some((amount, floors));
            }
        } else if self.above.is_none_or(|(known, _)| amount < known) {
            self.above = Some((amount, floors));
        }
    }

    fn next(&self) -> f64 {
        match (self.below, self.above) {
            (Some(below), Some(above)) => {
                let part = (self.level / below.1).ln() / (above.1 / below.1).ln();
                // Never too near an end, where a bend would hold it.
                let part = if part.is_finite() {
                    part.clamp(0.1, 0.9)
                } else {
                    0.5
                };
                below.0 * (above.0 / below.0).powf(part)
            }
            (Some((amount, floors)), None) => amount * (self.level / floors).min(20.0),
            (None, Some((amount, floors))) => {
                let factor = self.level / floors;
                amount
                    * if factor.is_finite() {
                        factor.max(0.05)
                    } else {
                        0.05
                    }
            }
            (None, None) => 0.0,
        }
    }
}

/// A size to begin with, and the largest that makes sense, SI.
fn range(hidden: &Hidden, machine: &Machine) -> (f64, f64) {
    let free = f64::INFINITY;
    let of_axis = |arm: f64, stage: f64, pendulum: f64| match machine {
        Machine::Arm(_) => (arm, free),
        Machine::Stage(_) => (stage, free),
        Machine::Pendulum(_) => (pendulum, free),
    };
    match hidden.effect {
        // Half of the critical damping of the first mode.
        Effect::StructuralDamping => (1e-4, 5e-3),
        Effect::TipMass => (0.01, 1.0),
        // A softening that leaves a stiffness at the largest deflections.
        Effect::StiffnessNonlinearity if hidden.sign < 0.0 => (3e7, 1e8),
        Effect::StiffnessNonlinearity => (1e8, 1e11),
        Effect::JointCompliance => (1e-4, 0.01),
        Effect::TransmissionError => (3e-6, 1e-4),
        Effect::StiffnessVariation => (0.2, 0.6),
        Effect::AsymmetricBacklash => (1e-5, 2e-5),
        Effect::ParameterShift => (0.02, 0.5),
        Effect::QuadraticDrag | Effect::WornFriction => of_axis(1e-4, 10.0, 1e-5),
        Effect::WeakeningDrive => of_axis(0.01, 0.1, 0.0),
        _ => of_axis(0.05, 1.0, 1e-4),
    }
}

/// What the null model may fit, as directions of the outputs, in noises.
struct Basis {
    /// Per window: its first sample and record, orthonormal directions of initial states, and
    /// the directions of the declared unknowns with those taken out.
    windows: Vec<Part>,
}

struct Part {
    record: usize,
    first: usize,
    count: usize,
    starts: DMatrix<f64>,
    declared: DMatrix<f64>,
}

impl Basis {
    fn new(machine: &Machine, setup: &Setup, drives: &[Drive], hidden: &Hidden) -> Self {
        let mut windows = Vec::new();
        for (record, drive) in drives.iter().enumerate() {
            let states = states(machine, setup, drive);
            let samples = drive.input.len();
            let length = setup
                .window
                .map_or(samples, |w| (w / setup.sample).round() as usize);
            for first in (0..samples).step_by(length) {
                let count = length.min(samples - first);
                if count * 2 < length {
                    continue;
                }
                let part = part(
                    machine,
                    setup,
                    drive,
                    &states[first],
                    (first, count),
                    hidden,
                );
                let (starts, declared) = part;
                windows.push(Part {
                    record,
                    first,
                    count,
                    starts,
                    declared,
                });
            }
        }
        Self { windows }
    }

    /// Root mean square of what the effect does, in noises.
    fn floors(&self, plain: &Machine, setup: &Setup, drives: &[Drive], hidden: &Hidden) -> f64 {
        let mut machine = plain.clone();
        let mut sensors = Sensors::right(setup.channels.len());
        hidden.hide(&mut machine, setup, &mut sensors);
        let runs: Vec<Vec<Vec<f64>>> = drives
            .iter()
            .map(|drive| states(&machine, setup, drive))
            .collect();
        let mut differences = Vec::new();
        for part in &self.windows {
            let (drive, with) = (&drives[part.record], &runs[part.record]);
            let start = plain.plain_state(&with[part.first]);
            let without = window(plain, setup, drive, &start, part.first, part.count);
            let seen = |samples: &[Vec<f64>]| outputs(&machine, setup, samples);
            let with = seen(&with[part.first..part.first + part.count]);
            let deviating = deviated(&with, setup, &sensors);
            let difference = deviating - seen(&without);
            let inside = &part.starts * (part.starts.transpose() * &difference);
            differences.push(difference - inside);
        }
        self.without_declared(differences)
    }

    fn without_declared(&self, differences: Vec<DVector<f64>>) -> f64 {
        let unknowns = self.windows.first().map_or(0, |part| part.declared.ncols());
        // One for each unknown is its prior: unknowns count in standard deviations.
        let mut normal = DMatrix::identity(unknowns, unknowns);
        let mut right = DVector::zeros(unknowns);
        for (part, difference) in self.windows.iter().zip(&differences) {
            normal += part.declared.transpose() * &part.declared;
            right += part.declared.transpose() * difference;
        }
        let taken = normal
            .cholesky()
            .map_or_else(|| DVector::zeros(unknowns), |factor| factor.solve(&right));
        let (mut sum, mut count) = (0.0, 0);
        for (part, difference) in self.windows.iter().zip(differences) {
            count += difference.len();
            sum += (difference - &part.declared * &taken).norm_squared();
        }
        (sum / count as f64).sqrt()
    }
}

/// Directions of one window: of its initial states, and of the declared unknowns.
fn part(
    machine: &Machine,
    setup: &Setup,
    drive: &Drive,
    start: &[f64],
    (first, count): (usize, usize),
    hidden: &Hidden,
) -> (DMatrix<f64>, DMatrix<f64>) {
    let base = window(machine, setup, drive, start, first, count);
    let seen = outputs(machine, setup, &base);
    let mut starts = Vec::new();
    for place in machine.states_of_model() {
        let mut moved = start.to_vec();
        let nudge = 1e-7;
        moved[place] += nudge;
        let run = window(machine, setup, drive, &moved, first, count);
        starts.push((outputs(machine, setup, &run) - &seen) / nudge);
    }
    let scaled: Vec<DVector<f64>> = starts
        .into_iter()
        .filter(|column| column.norm() > 0.0)
        .map(|column| column.normalize())
        .collect();
    let svd = DMatrix::from_columns(&scaled).svd(true, false);
    let kept = svd.singular_values.iter().filter(|s| **s > 1e-6).count();
    let starts = svd.u.map_or_else(
        || DMatrix::zeros(seen.len(), 0),
        |u| u.columns(0, kept).into_owned(),
    );
    let mut declared = Vec::new();
    for (name, relative) in &setup.uncertain {
        if hidden.effect == Effect::ParameterShift && hidden.on == *name {
            continue;
        }
        let mut other = machine.clone();
        let part = 1e-2 * relative;
        other.scale(name, 1.0 + part);
        let run = window(&other, setup, drive, start, first, count);
        declared.push((outputs(machine, setup, &run) - &seen) / 1e-2);
    }
    declared.extend(of_sensors(&seen, setup, hidden));
    let declared = DMatrix::from_columns(&declared);
    let inside = &starts * (starts.transpose() * &declared);
    (starts, declared - inside)
}

/// One standard deviation of each sensor's gain, bias and delay, except the hidden one's own.
fn of_sensors(seen: &DVector<f64>, setup: &Setup, hidden: &Hidden) -> Vec<DVector<f64>> {
    let channels = setup.channels.len();
    let mut columns = Vec::new();
    for (place, channel) in setup.channels.iter().enumerate() {
        for (effect, deviation) in [
            (Effect::SensorGain, 0.01),
            (Effect::SensorBias, 10.0 * channel.noise),
            (Effect::SensorDelay, 0.5 * setup.sample),
        ] {
            if hidden.effect == effect && hidden.on == channel.name {
                continue;
            }
            let mut sensors = Sensors::right(channels);
            match effect {
                Effect::SensorGain => sensors.gain[place] = deviation,
                Effect::SensorBias => sensors.bias[place] = deviation,
                _ => sensors.delay[place] = deviation,
            }
            columns.push(deviated(seen, setup, &sensors) - seen);
        }
    }
    columns
}

/// Outputs in noises as these sensors see them, a delay to first order in its length.
fn deviated(seen: &DVector<f64>, setup: &Setup, sensors: &Sensors) -> DVector<f64> {
    let channels = setup.channels.len();
    let samples = seen.len() / channels;
    let mut result = seen.clone();
    for sample in 0..samples {
        for (place, channel) in setup.channels.iter().enumerate() {
            let at = |sample: usize| seen[sample * channels + place];
            let (before, after) = (sample.saturating_sub(1), (sample + 1).min(samples - 1));
            let slope = (at(after) - at(before)) / ((after - before) as f64 * setup.sample);
            result[sample * channels + place] += sensors.gain[place] * at(sample)
                + sensors.bias[place] / channel.noise
                - sensors.delay[place] * slope;
        }
    }
    result
}

/// Outputs of states in noises, channel by channel within each sample.
fn outputs(machine: &Machine, setup: &Setup, states: &[Vec<f64>]) -> DVector<f64> {
    let values = states.iter().flat_map(|state| {
        let of = machine.outputs(state);
        let channels = of.into_iter().zip(&setup.channels);
        channels
            .map(|(value, channel)| value / channel.noise)
            .collect::<Vec<_>>()
    });
    DVector::from_iterator(states.len() * setup.channels.len(), values)
}

/// The states at all samples of a record.
fn states(machine: &Machine, setup: &Setup, drive: &Drive) -> Vec<Vec<f64>> {
    window(machine, setup, drive, &drive.start, 0, drive.input.len())
}

/// The states at `count` samples from the first on.
pub fn window(
    machine: &Machine,
    setup: &Setup,
    drive: &Drive,
    start: &[f64],
    first: usize,
    count: usize,
) -> Vec<Vec<f64>> {
    let mut stepper = Stepper::new(start.len());
    let mut state = start.to_vec();
    let mut states = Vec::with_capacity(count);
    for sample in first..first + count {
        states.push(state.clone());
        let t = sample as f64 * setup.sample;
        stepper.advance(
            machine,
            t,
            setup.sample,
            setup.steps,
            drive.input[sample],
            &mut state,
        );
    }
    states
}

/// What a model with as many modes as it is given leaves of the arm's motion, in floors: what
/// the truth has beyond it.
pub fn floors_of_missing_modes(machine: &Machine, setup: &Setup, drives: &[Drive]) -> f64 {
    let Machine::Arm(arm) = machine else {
        return 0.0;
    };
    let mut model = arm.clone();
    model.modes = setup.order.unwrap_or(model.modes);
    model.prepare();
    let model = Machine::Arm(model);
    let none = Hidden {
        effect: Effect::CoulombFriction,
        on: "theta_s".to_owned(),
        order: 0.0,
        sign: 1.0,
        phase: 0.0,
        amount: 0.0,
    };
    let basis = Basis::new(&model, setup, drives, &none);
    let mut differences = Vec::new();
    for part in &basis.windows {
        let drive = &drives[part.record];
        let truth = &states(machine, setup, drive)[part.first..part.first + part.count];
        let run = window(&model, setup, drive, &truth[0], part.first, part.count);
        let difference = outputs(machine, setup, truth) - outputs(&model, setup, &run);
        let inside = &part.starts * (part.starts.transpose() * &difference);
        differences.push(difference - inside);
    }
    basis.without_declared(differences)
}

#[cfg(test)]
mod tests {
    use super::Search;

    #[test]
    fn an_amount_is_found_where_floors_bend() {
        for floors in [
            |a: f64| 3.0 * a,
            |a: f64| 1e4 * a * a,
            |a: f64| if a < 0.02 { a } else { 1e3 * a.powi(3) },
            |a: f64| if a > 0.5 { f64::NAN } else { 40.0 * a },
        ] {
            let mut search = Search::new(6.0);
            let mut amount = 0.3;
            for _ in 0..12 {
                search.look(amount, floors(amount));
                if search.is_found() {
                    break;
                }
                amount = search.next();
            }
            assert!(search.is_found(), "{:?}", search.best);
        }
    }
}
