//! Random states in every regime of a model, within the ranges of the specification.
//!
//! States outside the model's domain (for example a root of a negative number) are drawn again and
//! counted. After several misses, states are drawn nearer to the initial state.
//!
//! The magnitude of an entry is at least a quarter of its size. If all terms of a row were small, the check would
//! measure only the rounding errors of other rows.

use super::oracle::{Equations, Oracle, OracleError, Side, SwitchValue};
use super::random::Random;
use super::regime_search::{Sizes, move_into_regime};
pub use super::regimes::Regime;
use super::regimes::{count_combinations, possible_regimes};
pub use super::sample::Sample;
use super::sizes;

/// Maximum number of regimes to visit if a model has too many regimes to list.
const MAX_VISITED_REGIMES: usize = 81;
/// Draws after which a regime is treated as unreachable.
const MAX_DRAWS_PER_REGIME: usize = 60;
const MAX_CORRECTIONS_PER_DRAW: usize = 6;
/// Consecutive states outside the domain after which states are drawn nearer to the initial state.
const MAX_CONSECUTIVE_MISSES: usize = 8;
/// Largest ratio of an entry to its size after a move into a regime.
const MAX_RELATIVE_ENTRY: f64 = 1e6;

/// State in the model's domain with the equations of motion at that state.
#[derive(Clone, Debug)]
pub struct SampledState {
    /// State with time and inputs, as a point of comparison.
    pub sample: Sample,
    /// Equations of the oracle.
    pub equations: Equations,
}

/// Regimes to visit and counts of all combinations of sides.
#[derive(Clone, Debug)]
pub struct Regimes {
    /// Number of combinations of sides.
    pub combinations: u64,
    /// Number of combinations that interval bounds prove to be empty.
    pub unreachable: u64,
    /// Regimes in which to draw states; those of random states if there are too many to list.
    pub visited: Vec<Regime>,
}

/// Random states of one variant.
#[derive(Debug)]
pub struct Sampler<'o> {
    oracle: &'o Oracle,
    random: Random,
    sizes: Vec<f64>,
    input_sizes: Vec<f64>,
    /// Last regime that could not be reached by changes of single entries.
    last_unreachable: Option<Regime>,
    /// Fraction of the distance from the initial state to a drawn state, initially 1.
    draw_fraction: f64,
    consecutive_misses: usize,
    redrawn_count: usize,
}

impl<'o> Sampler<'o> {
    /// Creates a sampler for the states of `oracle`.
    pub fn new(oracle: &'o Oracle, seed: u64) -> Result<Self, OracleError> {
        Ok(Self {
            oracle,
            random: Random::new(seed),
            sizes: sizes::state_sizes(oracle)?,
            input_sizes: sizes::input_sizes(oracle),
            last_unreachable: None,
            draw_fraction: 1.0,
            consecutive_misses: 0,
            redrawn_count: 0,
        })
    }

    /// Returns the number of states that were drawn again because they are outside the domain.
    pub fn redrawn_count(&self) -> usize {
        self.redrawn_count
    }

    /// Returns the typical size of each entry of the state, in SI.
    pub fn sizes(&self) -> &[f64] {
        &self.sizes
    }

    /// Returns the highest uncoupled frequency with all dead zones closed, in rad/s, at least 1.
    pub fn highest_frequency(&self) -> f64 {
        let (positions, rest) = self.sizes.split_at(self.oracle.size());
        let frequencies = positions
            .iter()
            .zip(rest)
            .map(|(position, rate)| rate / position);
        frequencies.fold(1.0, f64::max)
    }

    /// Returns the regimes to visit.
    pub fn visit_regimes(&mut self) -> Result<Regimes, OracleError> {
        let combinations = count_combinations(self.oracle);
        if let Some(visited) = possible_regimes(self.oracle, &self.sizes, &self.input_sizes) {
            return Ok(Regimes {
                unreachable: combinations.saturating_sub(visited.len() as u64),
                combinations,
                visited,
            });
        }
        let mut visited = Vec::new();
        for _ in 0..2 * MAX_VISITED_REGIMES {
            let sample = self.draw();
            let regime = Regime::from_state(self.oracle, &sample)?;
            if visited.len() < MAX_VISITED_REGIMES && !visited.contains(&regime) {
                visited.push(regime);
            }
        }
        Ok(Regimes {
            combinations,
            unreachable: 0,
            visited,
        })
    }

    /// Draws a state in any regime; it may be outside the domain.
    pub fn draw(&mut self) -> Sample {
        let (random, reach, ranges) = (&mut self.random, self.draw_fraction, self.oracle.ranges());
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

    /// Draws a state of the domain in any regime; `None` if the search failed.
    pub fn draw_inside(&mut self) -> Result<Option<SampledState>, OracleError> {
        for _ in 0..MAX_DRAWS_PER_REGIME * MAX_CONSECUTIVE_MISSES {
            let sample = self.draw();
            if let Some(drawn) = self.accept_in_domain(sample)? {
                return Ok(Some(drawn));
            }
        }
        Ok(None)
    }

    /// Draws a state in `regime`; `None` if the search failed or the sides are contradictory.
    pub fn draw_in(&mut self, regime: &Regime) -> Result<Option<SampledState>, OracleError> {
        let reach = self.draw_fraction;
        if self.last_unreachable.as_ref() != Some(regime)
            && let Some(drawn) = self.draw_near(regime)?
        {
            return Ok(Some(drawn));
        }
        for _ in 0..MAX_DRAWS_PER_REGIME {
            let mut sample = self.draw();
            let sizes = Sizes {
                state: &self.sizes,
                inputs: &self.input_sizes,
            };
            if move_into_regime(self.oracle, &mut sample, regime, &sizes, &mut self.random)?
                && let Some(drawn) = self.accept_in_domain(sample)?
            {
                self.last_unreachable = Some(regime.clone());
                return Ok(Some(drawn));
            }
        }
        // Each regime starts again with the distance that was valid before.
        self.draw_fraction = reach;
        Ok(None)
    }

    fn draw_near(&mut self, regime: &Regime) -> Result<Option<SampledState>, OracleError> {
        for _ in 0..MAX_DRAWS_PER_REGIME {
            let mut sample = self.draw();
            for _ in 0..MAX_CORRECTIONS_PER_DRAW {
                if self.correct(&mut sample, regime)? {
                    match self.accept_in_domain(sample)? {
                        Some(drawn) => return Ok(Some(drawn)),
                        None => break,
                    }
                }
            }
        }
        Ok(None)
    }

    fn accept_in_domain(
        &mut self,
        mut sample: Sample,
    ) -> Result<Option<SampledState>, OracleError> {
        if !self.move_onto_constraints(&mut sample)? || !self.is_within(&sample) {
            return Ok(None);
        }
        let (state, inputs) = (&sample.state, &sample.inputs);
        let equations = self.oracle.equations_inside(sample.time, state, inputs)?;
        if let Some(equations) = equations {
            self.consecutive_misses = 0;
            return Ok(Some(SampledState { sample, equations }));
        }
        self.redrawn_count += 1;
        self.consecutive_misses += 1;
        if self.consecutive_misses == MAX_CONSECUTIVE_MISSES {
            self.consecutive_misses = 0;
            self.draw_fraction *= 0.5;
        }
        Ok(None)
    }

    /// Projects a sample onto dependent constraints. Returns false if the projected sample is in another regime or if
    /// the projection fails.
    fn move_onto_constraints(&mut self, sample: &mut Sample) -> Result<bool, OracleError> {
        if !self.oracle.has_dependent_constraints() {
            return Ok(true);
        }
        let regime = Regime::from_state(self.oracle, sample)?;
        let (time, inputs) = (sample.time, sample.inputs.clone());
        let is_found = self.oracle.project(time, &mut sample.state, &inputs);
        Ok(is_found && Regime::from_state(self.oracle, sample)? == regime)
    }

    /// Returns true if all entries are within their ranges and `MAX_RELATIVE_ENTRY` times their sizes.
    fn is_within(&self, sample: &Sample) -> bool {
        let ranges = self.oracle.ranges();
        let states = ranges.state.iter().zip(&sample.state);
        let inputs = ranges.inputs.iter().zip(&sample.inputs);
        let ranged = states
            .chain(inputs)
            .all(|(range, entry)| range.is_none_or(|(low, high)| (low..=high).contains(entry)));
        let entries = sample.state.iter().zip(&self.sizes);
        let mut sized = entries.map(|(entry, size)| entry.abs() <= MAX_RELATIVE_ENTRY * size);
        ranged && sized.all(|sized| sized)
    }

    /// Changes one entry for each switch that is on the wrong side; returns true if all sides are correct.
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
                // Changes of the other switches bring the quantity to zero; a step along its own slope would cross
                // zero.
                let slopes = self.oracle.switch_slopes(index, *time, state, inputs)?;
                right &= value.side() == *side && slopes.iter().all(|slope| *slope == 0.0);
                continue;
            }
            right = false;
            let target = self.choose_target(value, *side);
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

    fn choose_target(&mut self, value: &SwitchValue, side: Side) -> f64 {
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
