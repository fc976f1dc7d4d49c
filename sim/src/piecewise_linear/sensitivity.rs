//! How a trajectory depends on parameters and on its initial state, to first order.
//!
//! A sensitivity is a tangent vector that is driven: within a regime it is carried by the
//! exact flow, and what the parameter does to the flow itself is added, by a difference
//! quotient of fourth order of the regime's flow at neighbouring parameters over the same
//! time. No switch lies within, so that the quotient differentiates something smooth. At a
//! switch the saltation matrix holds, with the displacement of the surface. The switching
//! sequence is that of the motion: grazing is where a trajectory has no derivative.

use fearless_simd::{Level, dispatch};
use nalgebra::Complex;

use super::error::ExactError;
use super::flow::Flow;
use super::follow::Samples;
use super::model::PiecewiseLinear;
use super::propagator::{Change, Follow, Propagator, Segment};
use super::tangent::Tangents;
use crate::inputs::HeldInputs;

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
        let samples = Samples::new(span, samples)?;
        let mut propagator = self.at(values)?;
        let mut motion = propagator.start(span.0, initial, inputs)?;
        let mut follower = Follower::new(self, values, directions, samples)?;
        follower.take_until(span.0, initial);
        propagator.follow_until(&mut motion, span.1, inputs, &mut follower)?;
        if let Some(error) = follower.failure {
            return Err(error);
        }
        follower.take_until(span.1, motion.state());
        Ok(Sensitivities {
            times: follower.samples.times,
            states: follower.samples.states,
            derivatives: follower.derivatives,
        })
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
    samples: Samples<'s>,
    tangents: Tangents,
    neighbours: Vec<Option<Neighbours>>,
    /// Scratch: tangent vectors at a sample.
    at_sample: Tangents,
    state: Vec<f64>,
    /// The tangent vectors at the samples taken so far.
    derivatives: Vec<Vec<Vec<f64>>>,
    /// Why nothing more is carried.
    failure: Option<ExactError>,
}

impl<'s> Follower<'s> {
    fn new(
        model: &PiecewiseLinear,
        values: &[f64],
        directions: &[By],
        samples: Samples<'s>,
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
            derivatives: Vec::new(),
            failure: None,
        })
    }

    /// Takes the samples until a time at which state and tangents are known.
    fn take_until(&mut self, t: f64, state: &[f64]) {
        self.samples.take_until(t, state);
        let taken = self.samples.times.len();
        self.derivatives
            .resize(taken, self.tangents.vectors.clone());
    }

    /// Takes the samples within a segment and carries the tangents to its end.
    fn carry(&mut self, segment: &Segment<'_>, flow: &mut Flow) -> Result<(), ExactError> {
        while let Some(after) = self.samples.next_in(segment) {
            self.at_sample.vectors.clone_from(&self.tangents.vectors);
            self.at_sample.advance(segment.regime, after);
            self.drive(segment, after, true)?;
            self.samples.take_in(segment, after, flow);
            self.derivatives.push(self.at_sample.vectors.clone());
        }
        self.tangents.advance(segment.regime, segment.tau);
        self.drive(segment, segment.tau, false)
    }

    /// Takes the tangents through a switch.
    fn switch(&mut self, change: &Change<'_>) -> Result<(), ExactError> {
        let displacements = self
            .neighbours
            .iter_mut()
            .map(|neighbours| match neighbours {
                None => Ok(0.0),
                Some(neighbours) => neighbours.displacement(change),
            });
        let displacements: Vec<f64> = displacements.collect::<Result<_, _>>()?;
        self.tangents.switch(change, &displacements);
        Ok(())
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
            let flow = &mut self.flow;
            dispatch!(Level::new(), simd => {
                flow.start(simd, regime, segment.state, segment.inputs, &phases);
            });
            flow.state_at(regime, tau, state);
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
        if self.failure.is_none() {
            self.failure = self.carry(segment, flow).err();
        }
    }

    fn switched(&mut self, change: &Change<'_>) {
        if self.failure.is_none() {
            self.failure = self.switch(change).err();
        }
    }
}
