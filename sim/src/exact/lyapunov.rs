//! Lyapunov exponents: how fast neighbouring motions part (Benettin, Galgani, Giorgilli and
//! Strelcyn 1980), with tangent vectors that are carried exactly.
//!
//! Coordinates that no rate and no switch feels, such as the angle of a rotation nothing
//! restrains, have exponents of zero that say nothing; they are left out.

use super::error::ExactError;
use super::flow::Flow;
use super::propagator::{Change, Follow, Propagator, Segment};
use super::tangent::Tangents;
use crate::record::HeldInputs;
use crate::solve::SolveError;

/// How long and how often the growth of tangent vectors is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lyapunov {
    /// Time before anything is measured, s; tangent vectors turn into place in its second half.
    pub transient: f64,
    /// Time between two measurements, s.
    pub interval: f64,
    /// How many measurements.
    pub intervals: usize,
    /// How many exponents, the largest first.
    pub exponents: usize,
}

/// The growth of tangent vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    /// Time between two measurements, s.
    pub interval: f64,
    /// For each exponent the growth ln |v_after| / |v_before| over every interval. Divided by
    /// the interval their means are the exponents, in 1/s, the largest first.
    pub growths: Vec<Vec<f64>>,
    /// The state at the end of every interval.
    pub section: Vec<Vec<f64>>,
    /// Switches over the whole time.
    pub switches: u64,
}

impl Propagator {
    /// The growth of neighbouring motions, from `initial` at time `t`, s, on.
    ///
    /// At most as many exponents are given as there are states that matter.
    ///
    /// # Errors
    /// As for [`Propagator::simulate`], or if the request makes no sense.
    pub fn lyapunov(
        &mut self,
        initial: &[f64],
        t: f64,
        inputs: &HeldInputs,
        request: &Lyapunov,
    ) -> Result<Growth, ExactError> {
        request.check()?;
        let felt = self.felt_states();
        let wanted = request.exponents.min(felt.iter().filter(|f| **f).count());
        let mut motion = self.start(t, initial, inputs)?;
        let mut frame = Frame::new(&felt, 0);
        self.follow_until(&mut motion, t + 0.5 * request.transient, inputs, &mut frame)?;
        let mut frame = Frame::new(&felt, wanted);
        let measured_from = t + request.transient;
        self.follow_until(&mut motion, measured_from, inputs, &mut frame)?;
        frame.orthonormalise();
        let mut growths = vec![Vec::with_capacity(request.intervals); wanted];
        let mut section = Vec::with_capacity(request.intervals);
        for index in 1..=request.intervals {
            frame.growth.fill(0.0);
            let end = measured_from + index as f64 * request.interval;
            self.follow_until(&mut motion, end, inputs, &mut frame)?;
            frame.orthonormalise();
            for (all, growth) in growths.iter_mut().zip(&frame.growth) {
                all.push(*growth);
            }
            section.push(motion.state().to_vec());
        }
        Ok(Growth {
            interval: request.interval,
            growths,
            section,
            switches: motion.switches(),
        })
    }
}

impl Lyapunov {
    fn check(&self) -> Result<(), SolveError> {
        let times = self.transient >= 0.0 && self.interval > 0.0;
        if times && self.transient.is_finite() && self.interval.is_finite() && self.intervals > 0 {
            return Ok(());
        }
        Err(SolveError::Request {
            problem: "expected a transient of 0 s or more, an interval above 0 s and at least \
                      one interval"
                .to_owned(),
        })
    }
}

/// Tangent vectors that are kept orthonormal.
struct Frame {
    tangents: Tangents,
    felt: Vec<bool>,
    /// ln of what each vector has grown by.
    growth: Vec<f64>,
}

impl Frame {
    /// The first unit vectors, turned a little against each other.
    fn new(felt: &[bool], count: usize) -> Self {
        let places: Vec<usize> = (0..felt.len()).filter(|state| felt[*state]).collect();
        let vectors = (0..count)
            .map(|index| {
                let mut vector = vec![0.0; felt.len()];
                for (k, state) in places.iter().enumerate() {
                    vector[*state] = if k == index {
                        1.0
                    } else {
                        0.1 / (1 + k + index) as f64
                    };
                }
                vector
            })
            .collect();
        let mut frame = Self {
            tangents: Tangents::new(vectors),
            felt: felt.to_vec(),
            growth: vec![0.0; count],
        };
        frame.orthonormalise();
        frame.growth.fill(0.0);
        frame
    }

    /// Gram-Schmidt; the lengths go to the growth.
    fn orthonormalise(&mut self) {
        let vectors = &mut self.tangents.vectors;
        for index in 0..vectors.len() {
            let (done, rest) = vectors.split_at_mut(index);
            let vector = &mut rest[0];
            for (slot, felt) in vector.iter_mut().zip(&self.felt) {
                if !felt {
                    *slot = 0.0;
                }
            }
            for earlier in done {
                let along: f64 = earlier.iter().zip(&*vector).map(|(a, b)| a * b).sum();
                vector
                    .iter_mut()
                    .zip(earlier)
                    .for_each(|(slot, e)| *slot -= along * *e);
            }
            let length = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
            self.growth[index] += length.ln();
            vector.iter_mut().for_each(|slot| *slot /= length);
        }
    }
}

impl Follow for Frame {
    fn flowed(&mut self, segment: &Segment<'_>, flow: &mut Flow) {
        self.tangents.flowed(segment, flow);
        // Vectors that shrink fast would turn into the first one.
        if self.tangents.vectors.len() > 1 {
            self.orthonormalise();
        }
    }

    fn switched(&mut self, change: &Change<'_>) {
        self.tangents.switched(change);
    }
}
