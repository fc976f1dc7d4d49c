//! Random states in every regime of a model, as large as `sizes` says. Nothing here knows
//! the equations under test.
//!
//! No entry is drawn smaller than a quarter of its size: a row all of whose terms happen
//! to be small measures the rounding of the others.

use super::oracle::{Oracle, OracleError, Side, SwitchValue};
use super::random::Random;
use super::sizes;

/// The most regimes that are visited; of more, this many are drawn.
const MAX_REGIMES: usize = 81;
/// States drawn before a regime counts as out of reach.
const ATTEMPTS: usize = 60;
/// Corrections of one drawn state.
const SWEEPS: usize = 6;

/// A state with its time and inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time, in s.
    pub time: f64,
    /// Coordinates, then rates.
    pub state: Vec<f64>,
    /// Inputs in the order of the model.
    pub inputs: Vec<f64>,
}

/// One side for every switch of the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Regime {
    /// The sides, in the order of [`Oracle::switches`].
    pub sides: Vec<Side>,
}

impl Regime {
    /// Names and sides, as `x_sp+ x_pr0`; empty for a model without switches.
    pub fn label(&self, oracle: &Oracle) -> String {
        let parts: Vec<String> = oracle
            .switches()
            .iter()
            .zip(&self.sides)
            .map(|(switch, side)| format!("{}{}", switch.name, side.symbol()))
            .collect();
        parts.join(" ")
    }
}

/// Draws states of one variant.
#[derive(Debug)]
pub struct Sampler<'o> {
    oracle: &'o Oracle,
    random: Random,
    /// Size of every entry of the state.
    sizes: Vec<f64>,
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
        })
    }

    /// The highest frequency of a coordinate by itself with every dead zone closed, in
    /// rad/s, at least 1.
    pub fn highest_frequency(&self) -> f64 {
        let (positions, rates) = self.sizes.split_at(self.oracle.size());
        let frequencies = positions
            .iter()
            .zip(rates)
            .map(|(position, rate)| rate / position);
        frequencies.fold(1.0, f64::max)
    }

    /// Every combination of sides, or a drawn selection if there are very many.
    pub fn regimes(&mut self) -> Vec<Regime> {
        let switches = self.oracle.switches();
        let count = switches.iter().try_fold(1_usize, |count, switch| {
            count.checked_mul(switch.sides().len())
        });
        if count.is_some_and(|count| count <= MAX_REGIMES) {
            let mut regimes = vec![Regime { sides: Vec::new() }];
            for switch in switches {
                let extended = |regime: &Regime| {
                    let sides = regime.sides.clone();
                    switch.sides().iter().map(move |side| Regime {
                        sides: sides.iter().chain([side]).copied().collect(),
                    })
                };
                regimes = regimes.iter().flat_map(extended).collect();
            }
            return regimes;
        }
        let mut regimes = Vec::new();
        for _ in 0..2 * MAX_REGIMES {
            let draw = |switch: &super::oracle::Switch| {
                self.random
                    .pick(switch.sides())
                    .copied()
                    .unwrap_or(Side::Plus)
            };
            let sides = switches.iter().map(draw).collect();
            let regime = Regime { sides };
            if regimes.len() < MAX_REGIMES && !regimes.contains(&regime) {
                regimes.push(regime);
            }
        }
        regimes
    }

    /// A random state, whatever its regime.
    pub fn draw(&mut self) -> Sample {
        let random = &mut self.random;
        Sample {
            time: random.unit(),
            state: self
                .sizes
                .iter()
                .map(|size| size * random.away_from_zero())
                .collect(),
            inputs: (0..self.oracle.input_count())
                .map(|_| random.symmetric())
                .collect(),
        }
    }

    /// A random state in `regime`; none if it was not reached, which for combinations
    /// that contradict each other is the right answer.
    ///
    /// # Errors
    /// [`OracleError`] as from [`Oracle::equations`].
    pub fn draw_in(&mut self, regime: &Regime) -> Result<Option<Sample>, OracleError> {
        for _ in 0..ATTEMPTS {
            let mut sample = self.draw();
            for _ in 0..SWEEPS {
                if self.correct(&mut sample, regime)? {
                    return Ok(Some(sample));
                }
            }
        }
        Ok(None)
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
        for (index, side) in regime.sides.iter().enumerate() {
            let values = self.oracle.switch_values(*time, state, inputs)?;
            let Some(value) = values.get(index).filter(|value| value.side() != *side) else {
                continue;
            };
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
