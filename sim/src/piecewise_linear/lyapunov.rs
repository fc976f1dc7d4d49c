//! Lyapunov exponents: growth rates of tangent vectors, which are propagated exactly (Benettin, Galgani,
//! Giorgilli and Strelcyn 1980).
//!
//! Coordinates on which no rate and no switching function depends, such as an unrestrained rotation angle, have
//! exponents of zero by construction; they are omitted.

use super::error::ExactError;
use super::flow::Flow;
use super::propagator::{Change, Follow, Motion, Propagator, Segment};
use super::tangent::Tangents;
use crate::inputs::HeldInputs;
use crate::ode::SolveError;

/// Request for Lyapunov exponents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LyapunovRequest {
    /// Time before the first measurement, s. The tangent vectors align in its second half.
    pub transient: f64,
    /// Time between two measurements, s.
    pub interval: f64,
    /// Number of measurements.
    pub interval_count: usize,
    /// Number of exponents, the largest first.
    pub exponent_count: usize,
}

/// Measured growth of tangent vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct LyapunovGrowth {
    /// Time between two measurements, s.
    pub interval: f64,
    /// Growth exponents ln(|v_after| / |v_before|) of the intervals, for each tangent vector.
    /// Their means divided by the interval are the Lyapunov exponents, 1/s, the largest first.
    pub growth_exponents: Vec<Vec<f64>>,
    /// State at the end of every interval.
    pub interval_states: Vec<Vec<f64>>,
    /// Number of events over the whole time.
    pub switches: u64,
}

/// A motion with tangent vectors that can be continued.
pub struct MotionWithTangents {
    motion: Motion,
    frame: TangentFrame,
}

impl MotionWithTangents {
    /// Returns ln(|v_after| / |v_before|) of each tangent vector over the last interval.
    pub fn growth_exponents(&self) -> &[f64] {
        &self.frame.growth
    }

    /// Returns the state at the end of the last interval.
    pub fn state(&self) -> &[f64] {
        self.motion.state()
    }

    /// Returns the number of events up to now.
    pub fn switch_count(&self) -> u64 {
        self.motion.switch_count()
    }
}

impl Propagator {
    /// Starts a motion with one tangent vector from `initial` at time `t` (s). The length of the
    /// vector is the root of the sum of (weight times entry)^2.
    ///
    /// # Errors
    /// Same as [`Propagator::start`], or a number of weights that differs from the number of
    /// states.
    pub fn start_with_tangent(
        &mut self,
        initial: &[f64],
        t: f64,
        inputs: &HeldInputs,
        weights: &[f64],
    ) -> Result<MotionWithTangents, ExactError> {
        if weights.len() != self.states || weights.iter().any(|w| !(*w >= 0.0 && w.is_finite())) {
            let problem = format!("expected {} weights of 0 or more", self.states);
            return Err(SolveError::Request { problem }.into());
        }
        Ok(MotionWithTangents {
            motion: self.start(t, initial, inputs)?,
            frame: TangentFrame::new(weights, 1),
        })
    }

    /// Continues a motion and its tangent vectors to a time (s), and orthonormalises the vectors.
    ///
    /// # Errors
    /// Same as [`Propagator::simulate`].
    pub fn continue_to(
        &mut self,
        carried: &mut MotionWithTangents,
        end: f64,
        inputs: &HeldInputs,
    ) -> Result<(), ExactError> {
        let MotionWithTangents { motion, frame } = carried;
        frame.growth.fill(0.0);
        self.follow_until(motion, end, inputs, frame)?;
        frame.orthonormalise();
        Ok(())
    }

    /// Measures the growth of tangent vectors from `initial` at time `t` (s). The number of exponents is
    /// limited to the number of states that affect a rate or a switching function.
    ///
    /// # Errors
    /// Same as [`Propagator::simulate`], or an invalid request.
    pub fn measure_lyapunov(
        &mut self,
        (t, initial): (f64, &[f64]),
        inputs: &HeldInputs,
        request: &LyapunovRequest,
        check: &dyn Fn(),
    ) -> Result<LyapunovGrowth, ExactError> {
        request.check()?;
        let felt = self.influential_states();
        let wanted = request
            .exponent_count
            .min(felt.iter().filter(|f| **f).count());
        let mut motion = self.start(t, initial, inputs)?;
        let weights: Vec<f64> = felt.iter().map(|felt| f64::from(u8::from(*felt))).collect();
        let mut nobody = TangentFrame::new(&weights, 0);
        self.follow_until(
            &mut motion,
            t + 0.5 * request.transient,
            inputs,
            &mut nobody,
        )?;
        let mut carried = MotionWithTangents {
            motion,
            frame: TangentFrame::new(&weights, wanted),
        };
        let measured_from = t + request.transient;
        self.continue_to(&mut carried, measured_from, inputs)?;
        let mut growths = vec![Vec::with_capacity(request.interval_count); wanted];
        let mut section = Vec::with_capacity(request.interval_count);
        for index in 1..=request.interval_count {
            check();
            let end = measured_from + index as f64 * request.interval;
            self.continue_to(&mut carried, end, inputs)?;
            for (all, growth) in growths.iter_mut().zip(carried.growth_exponents()) {
                all.push(*growth);
            }
            section.push(carried.state().to_vec());
        }
        Ok(LyapunovGrowth {
            interval: request.interval,
            growth_exponents: growths,
            interval_states: section,
            switches: carried.switch_count(),
        })
    }
}

impl LyapunovRequest {
    fn check(&self) -> Result<(), SolveError> {
        let times = self.transient >= 0.0 && self.interval > 0.0;
        if times
            && self.transient.is_finite()
            && self.interval.is_finite()
            && self.interval_count > 0
        {
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
struct TangentFrame {
    tangents: Tangents,
    /// Square of the weight of each state in a length.
    metric: Vec<f64>,
    /// Logarithm of the growth of each vector.
    growth: Vec<f64>,
}

impl TangentFrame {
    /// Creates unit vectors of the first states with a weight, with small components of the other states.
    fn new(weights: &[f64], count: usize) -> Self {
        let felt = weights
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight > 0.0);
        let felt: Vec<(usize, f64)> = felt.map(|(state, weight)| (state, *weight)).collect();
        let vectors = (0..count)
            .map(|index| {
                let mut vector = vec![0.0; weights.len()];
                for (k, (state, weight)) in felt.iter().enumerate() {
                    let turned = if k == index {
                        1.0
                    } else {
                        0.1 / (1 + k + index) as f64
                    };
                    vector[*state] = turned / weight;
                }
                vector
            })
            .collect();
        let mut frame = Self {
            tangents: Tangents::new(vectors),
            metric: weights.iter().map(|weight| weight * weight).collect(),
            growth: vec![0.0; count],
        };
        frame.orthonormalise();
        frame.growth.fill(0.0);
        frame
    }

    /// Orthonormalises the tangent vectors (Gram-Schmidt) and adds the logarithms of their lengths to `growth`.
    fn orthonormalise(&mut self) {
        let vectors = &mut self.tangents.vectors;
        for index in 0..vectors.len() {
            let (done, rest) = vectors.split_at_mut(index);
            let vector = &mut rest[0];
            for (slot, metric) in vector.iter_mut().zip(&self.metric) {
                if *metric == 0.0 {
                    *slot = 0.0;
                }
            }
            for earlier in done {
                let along = weighted_product(&self.metric, earlier, vector);
                vector
                    .iter_mut()
                    .zip(earlier)
                    .for_each(|(slot, e)| *slot -= along * *e);
            }
            let length = weighted_product(&self.metric, vector, vector).sqrt();
            self.growth[index] += length.ln();
            vector.iter_mut().for_each(|slot| *slot /= length);
        }
    }
}

fn weighted_product(metric: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b).zip(metric);
    pairs.map(|((a, b), metric)| metric * a * b).sum()
}

impl Follow for TangentFrame {
    fn observe_segment(&mut self, segment: &Segment<'_>, flow: &mut Flow) {
        self.tangents.observe_segment(segment, flow);
        // Without this, fast decaying vectors would align with the first one by rounding.
        if self.tangents.vectors.len() > 1 {
            self.orthonormalise();
        }
    }

    fn observe_switch(&mut self, change: &Change<'_>) {
        self.tangents.observe_switch(change);
    }
}
