//! How a trajectory depends on parameters and on its initial state, to first order.
//!
//! A sensitivity is a tangent vector that is driven: within a regime it is carried by the
//! exact flow, and what the parameter does to the flow itself is added, by a difference
//! quotient of fourth order of the regime's flow at neighbouring parameters over the same
//! time. No switch lies within, so that the quotient differentiates something smooth. At a
//! switch the saltation matrix holds, with the displacement of the surface. The switching
//! sequence is that of the motion: grazing is where a trajectory has no derivative.

use nalgebra::Complex;

use super::error::ExactError;
use super::flow::Flow;
use super::model::PiecewiseLinear;
use super::propagator::{Change, Follow, Propagator, Segment};
use super::tangent::Tangents;
use crate::record::HeldInputs;

/// Relative step of the difference quotient. The phase of the fastest mode within a segment,
/// some hundred radians, times the step to the fourth power is its error.
const STEP: f64 = 1e-4;

/// Where the quotient is taken, in steps, with its factors (times 12).
const STENCIL: [(f64, f64); 4] = [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)];

/// What a trajectory is differentiated by.
#[derive(Clone, Debug, PartialEq)]
pub enum By {
    /// An independent parameter, by its place; the initial state changes with it as given.
    Parameter(usize, Vec<f64>),
    /// The initial state along a direction.
    Initial(Vec<f64>),
}

/// A trajectory with its sensitivities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensitivities {
    /// The times of the samples, s.
    pub times: Vec<f64>,
    /// The state at each of these times.
    pub states: Vec<Vec<f64>>,
    /// For each sample and each direction the derivative of the state.
    pub derivatives: Vec<Vec<Vec<f64>>>,
}

impl PiecewiseLinear {
    /// Simulates at these values of the independent parameters (SI) from `initial` over `span`
    /// (begin, end; s) and differentiates the states at `samples` (s, ascending).
    ///
    /// # Errors
    /// As for [`Propagator::simulate`].
    pub fn sensitivities(
        &self,
        values: &[f64],
        initial: &[f64],
        span: (f64, f64),
        samples: &[f64],
        inputs: &HeldInputs,
        directions: &[By],
    ) -> Result<Sensitivities, ExactError> {
        super::simulate::check(span, samples)?;
        let mut propagator = self.at(values)?;
        let mut motion = propagator.start(span.0, initial, inputs)?;
        let mut follower = Follower::new(self, values, directions, samples)?;
        follower.take(span.0, initial);
        while motion.time() < span.1 {
            let reached = propagator.advance(&mut motion, span.1, inputs, &mut follower)?;
            if let Some(error) = follower.failure.take() {
                return Err(error);
            }
            if reached {
                break;
            }
        }
        follower.take(span.1, motion.state());
        Ok(follower.result)
    }
}

/// A parameter's neighbouring values, each with its motion.
struct Neighbours {
    /// In the order of the stencil.
    propagators: Vec<Propagator>,
    flow: Flow,
    /// The step, in the parameter's unit.
    step: f64,
}

/// Carries sensitivities along.
struct Follower<'s> {
    samples: &'s [f64],
    tangents: Tangents,
    neighbours: Vec<Option<Neighbours>>,
    /// Scratch: tangent vectors at a sample.
    at_sample: Tangents,
    state: Vec<f64>,
    result: Sensitivities,
    failure: Option<ExactError>,
}

impl<'s> Follower<'s> {
    fn new(
        model: &PiecewiseLinear,
        values: &[f64],
        directions: &[By],
        samples: &'s [f64],
    ) -> Result<Self, ExactError> {
        let mut neighbours = Vec::with_capacity(directions.len());
        let mut vectors = Vec::with_capacity(directions.len());
        for direction in directions {
            match direction {
                By::Initial(vector) => {
                    neighbours.push(None);
                    vectors.push(vector.clone());
                }
                By::Parameter(place, vector) => {
                    neighbours.push(Some(Neighbours::of(model, values, *place)?));
                    vectors.push(vector.clone());
                }
            }
        }
        Ok(Self {
            samples,
            tangents: Tangents::new(vectors),
            neighbours,
            at_sample: Tangents::default(),
            state: Vec::new(),
            result: Sensitivities::default(),
            failure: None,
        })
    }

    /// The samples until a time at which state and tangents are known.
    fn take(&mut self, t: f64, state: &[f64]) {
        while let Some(&sample) = self.next().filter(|sample| **sample <= t) {
            self.result.times.push(sample);
            self.result.states.push(state.to_vec());
            self.result.derivatives.push(self.tangents.vectors.clone());
        }
    }

    fn next(&self) -> Option<&f64> {
        self.samples.get(self.result.times.len())
    }

    /// Adds to tangent vectors what the parameters do to the flow within `tau` s.
    fn drive(
        &mut self,
        segment: &Segment<'_>,
        tau: f64,
        at_sample: bool,
    ) -> Result<(), ExactError> {
        let vectors = if at_sample {
            &mut self.at_sample.vectors
        } else {
            &mut self.tangents.vectors
        };
        self.state.resize(segment.state.len(), 0.0);
        for (vector, neighbours) in vectors.iter_mut().zip(&mut self.neighbours) {
            if let Some(neighbours) = neighbours {
                neighbours.add_flow(segment, tau, &mut self.state, vector)?;
            }
        }
        Ok(())
    }
}

impl Neighbours {
    fn of(model: &PiecewiseLinear, values: &[f64], place: usize) -> Result<Self, ExactError> {
        let value = values.get(place).copied().unwrap_or(f64::NAN);
        let step = if value == 0.0 {
            STEP
        } else {
            STEP * value.abs()
        };
        let propagators = STENCIL.iter().map(|(offset, _)| {
            let mut shifted = values.to_vec();
            if let Some(slot) = shifted.get_mut(place) {
                *slot = value + offset * step;
            }
            model.at(&shifted)
        });
        Ok(Self {
            propagators: propagators.collect::<Result<_, _>>()?,
            flow: Flow::default(),
            step,
        })
    }

    /// Adds the derivative of the regime's flow by the parameter.
    fn add_flow(
        &mut self,
        segment: &Segment<'_>,
        tau: f64,
        state: &mut [f64],
        vector: &mut [f64],
    ) -> Result<(), ExactError> {
        for (propagator, (_, factor)) in self.propagators.iter_mut().zip(STENCIL) {
            let index = propagator.regime(segment.places, segment.start.time())?;
            let phases = propagator.phases_at(segment.start);
            let regime = propagator.made(index);
            self.flow
                .start(regime, segment.state, segment.inputs, &phases);
            self.flow.go_to(regime, tau);
            self.flow.state(regime, state);
            let factor = factor / (12.0 * self.step);
            vector
                .iter_mut()
                .zip(&*state)
                .for_each(|(slot, y)| *slot += factor * y);
        }
        Ok(())
    }

    /// The derivative of a function's distance from its limit by the parameter, at a state.
    fn displacement(&mut self, change: &Change<'_>) -> Result<f64, ExactError> {
        let (functional, upper) = change.limit;
        let mut sum = 0.0;
        for (propagator, (_, factor)) in self.propagators.iter_mut().zip(STENCIL) {
            let index = propagator.regime(change.places, change.clock.time())?;
            let phases: Vec<Complex<f64>> = propagator.phases_at(change.clock);
            let Some(of) = propagator.made(index).functionals.get(functional) else {
                continue;
            };
            let limit = if upper { of.limits.high } else { of.limits.low };
            let value = of.linear.value(change.state, change.inputs, &phases);
            sum += factor * (value - limit);
        }
        Ok(sum / (12.0 * self.step))
    }
}

impl Follow for Follower<'_> {
    fn flowed(&mut self, segment: &Segment<'_>, flow: &mut Flow) {
        while let Some(&sample) = self.next() {
            let after = segment.start.until(sample);
            if after > segment.tau {
                break;
            }
            self.at_sample.vectors.clone_from(&self.tangents.vectors);
            self.at_sample.advance(segment.regime, after);
            if let Err(error) = self.drive(segment, after, true) {
                self.failure = Some(error);
                return;
            }
            flow.go_to(segment.regime, after);
            let mut state = vec![0.0; segment.state.len()];
            flow.state(segment.regime, &mut state);
            self.result.times.push(sample);
            self.result.states.push(state);
            self.result.derivatives.push(self.at_sample.vectors.clone());
        }
        self.tangents.advance(segment.regime, segment.tau);
        if let Err(error) = self.drive(segment, segment.tau, false) {
            self.failure = Some(error);
        }
    }

    fn switched(&mut self, change: &Change<'_>) {
        let mut displacements = Vec::with_capacity(self.neighbours.len());
        for neighbours in &mut self.neighbours {
            let displacement = match neighbours {
                None => Ok(0.0),
                Some(neighbours) => neighbours.displacement(change),
            };
            match displacement {
                Ok(value) => displacements.push(value),
                Err(error) => {
                    self.failure = Some(error);
                    return;
                }
            }
        }
        self.tangents.switch(change, &displacements);
    }
}
