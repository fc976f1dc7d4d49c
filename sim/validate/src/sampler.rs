//! Random states in every regime of a model, as large as `sizes` says, within the ranges it
//! states. Nothing here knows the equations under test.
//!
//! States outside the model's domain (a root of something negative, an inductance below 0)
//! are drawn again and counted; where most are, they are drawn nearer to the initial state.
//!
//! No entry is drawn smaller than a quarter of its size: a row all of whose terms happen
//! to be small measures the rounding of the others.

use super::oracle::{Equations, Oracle, OracleError, Side, SwitchValue};
use super::random::Random;
pub use super::regimes::Regime;
use super::regimes::{combinations, possible_regimes};
pub use super::sample::Sample;
use super::seek::{Sizes, seek};
use super::sizes;

/// The most regimes that are visited if all of them are too many to be listed.
const DRAWN_REGIMES: usize = 81;
/// States drawn before a regime counts as out of reach.
const ATTEMPTS: usize = 60;
/// Corrections of one drawn state.
const SWEEPS: usize = 6;
/// States outside the domain, one after another, after which they are drawn nearer to the
/// initial state.
const MISSES: usize = 8;
/// How much larger than its size an entry may become when it is moved into a regime.
const LARGEST: f64 = 1e6;

/// A state of the model's domain with the equations of motion there.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The state.
    pub sample: Sample,
    /// The oracle's equations.
    pub equations: Equations,
}

/// The regimes of a model that are visited, of all combinations of sides.
#[derive(Clone, Debug)]
pub struct Regimes {
    /// Combinations of sides.
    pub combinations: u64,
    /// Combinations that bounds prove empty.
    pub unreachable: u64,
    /// Regimes to draw states in. If there are too many to be listed, those that random states
    /// are in.
    pub visited: Vec<Regime>,
}

/// Draws states of one variant.
#[derive(Debug)]
pub struct Sampler<'o> {
    oracle: &'o Oracle,
    random: Random,
    /// Size of every entry of the state.
    sizes: Vec<f64>,
    /// Size of every input.
    input_sizes: Vec<f64>,
    /// The last regime that single changes did not reach.
    remote: Option<Regime>,
    /// How much of the way from the initial state to a drawn one is gone, 1 at first.
    reach: f64,
    /// States outside the domain, one after another.
    missed: usize,
    /// States outside the domain in all.
    redrawn: usize,
}

impl<'o> Sampler<'o> {
    /// A sampler of `oracle`'s states.
    ///
    /// # Errors
    /// [`OracleError`] as from [`Oracle::equations`].
    pub fn new(oracle: &'o Oracle, seed: u64) -> Result<Self, OracleError> {
        Ok(Self {
            oracle,
            random: Random::new(seed),
            sizes: sizes::of_state(oracle)?,
            input_sizes: sizes::of_inputs(oracle),
            remote: None,
            reach: 1.0,
            missed: 0,
            redrawn: 0,
        })
    }

    /// How many states were drawn again because they lie outside the model's domain.
    pub fn redrawn(&self) -> usize {
        self.redrawn
    }

    /// How large the entries of a state are.
    pub fn sizes(&self) -> &[f64] {
        &self.sizes
    }

    /// The highest frequency of a coordinate by itself with every dead zone closed, in
    /// rad/s, at least 1.
    pub fn highest_frequency(&self) -> f64 {
        let (positions, rest) = self.sizes.split_at(self.oracle.size());
        let frequencies = positions
            .iter()
            .zip(rest)
            .map(|(position, rate)| rate / position);
        frequencies.fold(1.0, f64::max)
    }

    /// The regimes to visit.
    ///
    /// # Errors
    /// [`OracleError`] as from [`Oracle::equations`].
    pub fn regimes(&mut self) -> Result<Regimes, OracleError> {
        let combinations = combinations(self.oracle);
        if let Some(visited) = possible_regimes(self.oracle, &self.sizes, &self.input_sizes) {
            return Ok(Regimes {
                unreachable: combinations.saturating_sub(visited.len() as u64),
                combinations,
                visited,
            });
        }
        let mut visited = Vec::new();
        for _ in 0..2 * DRAWN_REGIMES {
            let sample = self.draw();
            let regime = Regime::of(self.oracle, &sample)?;
            if visited.len() < DRAWN_REGIMES && !visited.contains(&regime) {
                visited.push(regime);
            }
        }
        Ok(Regimes {
            combinations,
            unreachable: 0,
            visited,
        })
    }

    /// A random state, whatever its regime, in the model's domain or not.
    pub fn draw(&mut self) -> Sample {
        let (random, reach, ranges) = (&mut self.random, self.reach, self.oracle.ranges());
        let time = random.unit();
        let entries = self.sizes.iter().zip(self.oracle.initial()).enumerate();
        let state = entries.map(|(row, (size, initial))| {
            let range = ranges.state.get(row).copied().flatten();
            let middle = range.map_or(0.0, |(low, high)| 0.5 * (low + high));
            let drawn = middle + size * random.away_from_zero();
            if reach < 1.0 {
                initial + reach * (drawn - initial)
            } else {
                drawn
            }
        });
        let state = state.collect();
        let inputs = ranges.inputs.iter().zip(&self.input_sizes);
        let inputs = inputs.map(|(range, size)| {
            let (low, high) = range.unwrap_or((-size, *size));
            0.5 * (low + high) + 0.5 * (high - low) * random.symmetric()
        });
        Sample {
            time,
            state,
            inputs: inputs.collect(),
        }
    }

    /// A random state of the model's domain, whatever its regime; none if none was found.
    ///
    /// # Errors
    /// [`OracleError`] as from [`Oracle::equations`].
    pub fn draw_inside(&mut self) -> Result<Option<Drawn>, OracleError> {
        for _ in 0..ATTEMPTS * MISSES {
            let sample = self.draw();
            if let Some(drawn) = self.admit(sample)? {
                return Ok(Some(drawn));
            }
        }
        Ok(None)
    }

    /// A random state in `regime`; none if it was not reached, which for combinations
    /// that contradict each other is the right answer.
    ///
    /// # Errors
    /// [`OracleError`] as from [`Oracle::equations`].
    pub fn draw_in(&mut self, regime: &Regime) -> Result<Option<Drawn>, OracleError> {
        let reach = self.reach;
        if self.remote.as_ref() != Some(regime)
            && let Some(drawn) = self.draw_near(regime)?
        {
            return Ok(Some(drawn));
        }
        for _ in 0..ATTEMPTS {
            let mut sample = self.draw();
            let sizes = Sizes {
                state: &self.sizes,
                inputs: &self.input_sizes,
            };
            if seek(self.oracle, &mut sample, regime, &sizes, &mut self.random)?
                && let Some(drawn) = self.admit(sample)?
            {
                self.remote = Some(regime.clone());
                return Ok(Some(drawn));
            }
        }
        // A regime outside the domain says nothing of the others.
        self.reach = reach;
        Ok(None)
    }

    /// A random state in `regime` by changes of single entries.
    fn draw_near(&mut self, regime: &Regime) -> Result<Option<Drawn>, OracleError> {
        for _ in 0..ATTEMPTS {
            let mut sample = self.draw();
            for _ in 0..SWEEPS {
                if self.correct(&mut sample, regime)? {
                    match self.admit(sample)? {
                        Some(drawn) => return Ok(Some(drawn)),
                        None => break,
                    }
                }
            }
        }
        Ok(None)
    }

    /// The state with its equations if it lies in the model's domain; counts it if not.
    fn admit(&mut self, sample: Sample) -> Result<Option<Drawn>, OracleError> {
        if !self.is_within(&sample) {
            return Ok(None);
        }
        let (state, inputs) = (&sample.state, &sample.inputs);
        let equations = self.oracle.equations_inside(sample.time, state, inputs)?;
        if let Some(equations) = equations {
            self.missed = 0;
            return Ok(Some(Drawn { sample, equations }));
        }
        self.redrawn += 1;
        self.missed += 1;
        if self.missed == MISSES {
            self.missed = 0;
            self.reach *= 0.5;
        }
        Ok(None)
    }

    /// Whether every coordinate is where it lives, and no entry is out of all proportion:
    /// moved into its regime, it may be anywhere.
    fn is_within(&self, sample: &Sample) -> bool {
        let ranges = self.oracle.ranges();
        let states = ranges.state.iter().zip(&sample.state);
        let inputs = ranges.inputs.iter().zip(&sample.inputs);
        let ranged = states
            .chain(inputs)
            .all(|(range, entry)| range.is_none_or(|(low, high)| (low..=high).contains(entry)));
        let entries = sample.state.iter().zip(&self.sizes);
        let mut sized = entries.map(|(entry, size)| entry.abs() <= LARGEST * size);
        ranged && sized.all(|sized| sized)
    }

    /// Moves one entry of the state for every switch on the wrong side, by the linear
    /// change that puts it on the right one; true if none was on the wrong side.
    fn correct(&mut self, sample: &mut Sample, regime: &Regime) -> Result<bool, OracleError> {
        let Sample {
            time,
            state,
            inputs,
        } = sample;
        let mut right = true;
        let switches = self.oracle.switches();
        let mut values = self.oracle.switch_values(*time, state, inputs)?;
        for ((index, side), switch) in regime.sides.iter().enumerate().zip(switches) {
            let resting = *side == Side::Free && switch.rests_at_zero();
            let Some(value) = values
                .get(index)
                .filter(|value| resting || value.side() != *side)
            else {
                continue;
            };
            if resting {
                // Others lead there: moved along its own slope it would only pass zero.
                let slopes = self.oracle.switch_slopes(index, *time, state, inputs)?;
                right &= value.side() == *side && slopes.iter().all(|slope| *slope == 0.0);
                continue;
            }
            right = false;
            let target = self.target(value, *side);
            let slopes = self.oracle.switch_slopes(index, *time, state, inputs)?;
            let movable: Vec<(usize, f64)> = slopes
                .into_iter()
                .enumerate()
                .filter(|(_, slope)| *slope != 0.0 && slope.is_finite())
                .collect();
            if let Some(&(entry, slope)) = self.random.pick(&movable)
                && let Some(entry) = state.get_mut(entry)
            {
                *entry += (target - value.quantity) / slope;
                values = self.oracle.switch_values(*time, state, inputs)?;
            }
        }
        Ok(right)
    }

    /// Where the quantity of a switch shall be.
    fn target(&mut self, value: &SwitchValue, side: Side) -> f64 {
        let (width, distance) = (value.half_width, value.quantity.abs());
        match side {
            Side::Free => width * self.random.symmetric(),
            _ if width > 0.0 => side.sign() * width * (1.0 + 2.0 * self.random.unit()),
            _ => {
                side.sign()
                    * if distance > 0.0 {
                        distance
                    } else {
                        self.random.unit()
                    }
            }
        }
    }
}
