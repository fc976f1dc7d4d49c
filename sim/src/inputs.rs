//! Inputs of a model as functions of time.

use std::borrow::Cow;
use std::fmt::Debug;
use std::sync::Arc;

use eomgen_codegen::program::evaluator::Enclosure;

use crate::cubic_spline::CubicSpline;

/// Inputs as a function of time. Solvers evaluate it at every time at which they evaluate the rates.
pub trait InputFunction: Debug + Send + Sync {
    /// Writes the inputs at time `t` (s) to `out`, one entry per input. A NaN, for a time outside the
    /// function's domain, stops the simulation.
    fn write(&self, t: f64, out: &mut [f64]);
}

#[derive(Clone, Debug)]
struct FunctionInputs {
    place: usize,
    count: usize,
    function: Arc<dyn InputFunction>,
}

impl PartialEq for FunctionInputs {
    fn eq(&self, other: &Self) -> bool {
        let same_place = (self.place, self.count) == (other.place, other.count);
        same_place && Arc::ptr_eq(&self.function, &other.function)
    }
}

/// Half-width of the narrow interval around a time in which the change of a function is measured, relative to
/// the time.
const NEAR_JUMP_DISTANCE: f64 = 1e-13;

/// Half-width of the wide interval, relative to the time. A smooth function changes 10,000 times as much over
/// it as over the narrow one.
const FAR_JUMP_DISTANCE: f64 = 1e-9;

/// Inputs of a motion. Each input is constant between samples, prescribed (a spline through its samples, with
/// its rates) or a function of time. Before the first sample the first value applies, after the last sample the
/// last value.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldInputs {
    times: Vec<f64>,
    /// Values of the held inputs, one row per time, one column per input.
    values: Vec<f64>,
    count: usize,
    /// Prescribed motions: index of the input, whose rate and second derivative follow it, and its spline.
    prescribed: Vec<(usize, CubicSpline)>,
    functions: Vec<FunctionInputs>,
    /// Times at which functions jump, ascending, s.
    jump_times: Vec<f64>,
}

impl HeldInputs {
    /// Returns `count` inputs that are zero at all times.
    pub fn zero(count: usize) -> Self {
        Self {
            times: vec![0.0],
            values: vec![0.0; count],
            count,
            prescribed: Vec::new(),
            functions: Vec::new(),
            jump_times: Vec::new(),
        }
    }

    /// Returns constant inputs.
    pub fn constant(values: Vec<f64>) -> Self {
        Self {
            times: vec![0.0],
            count: values.len(),
            values,
            prescribed: Vec::new(),
            functions: Vec::new(),
            jump_times: Vec::new(),
        }
    }

    /// Returns inputs that are held between samples: row i of `values`, with `count` entries, applies from its
    /// time (s, ascending) until the next one. Returns `None` without rows, or if the numbers of rows and times
    /// differ.
    pub fn new(times: Vec<f64>, values: Vec<f64>, count: usize) -> Option<Self> {
        let whole = !times.is_empty() && values.len() == times.len() * count;
        whole.then_some(Self {
            times,
            values,
            count,
            prescribed: Vec::new(),
            functions: Vec::new(),
            jump_times: Vec::new(),
        })
    }

    /// Sets the input at index `place` to a spline, and the next two inputs to its rate and second derivative.
    #[must_use]
    pub fn with_prescribed(mut self, place: usize, spline: CubicSpline) -> Self {
        self.prescribed.push((place, spline));
        self
    }

    /// Sets `count` inputs from index `place` on to a function of time.
    #[must_use]
    pub fn with_function(
        mut self,
        place: usize,
        count: usize,
        function: Arc<dyn InputFunction>,
    ) -> Self {
        self.functions.push(FunctionInputs {
            place,
            count,
            function,
        });
        self
    }

    /// Sets the times (s) at which functions jump, so that solvers end a step there. At such a time, functions
    /// are evaluated at the next larger number and have the value after the jump. Times that are not finite are
    /// ignored.
    #[must_use]
    pub fn with_jump_times(mut self, mut breaks: Vec<f64>) -> Self {
        breaks.retain(|time| time.is_finite());
        breaks.sort_by(f64::total_cmp);
        self.jump_times = breaks;
        self
    }

    /// Returns these inputs around a time (s) at which their held values change from one row to another.
    /// Prescribed motions and functions stay the same.
    #[must_use]
    pub fn with_held_step(&self, t: f64, before: &[f64], after: &[f64]) -> Self {
        Self {
            times: vec![t.next_down(), t],
            values: [before, after].concat(),
            ..self.clone()
        }
    }

    /// Returns these inputs up to the first of some changes, then the held values of the changes. Each change
    /// is a time (s, ascending) with a row of held values. Prescribed motions and functions stay the same.
    #[must_use]
    pub fn with_held_steps(&self, changes: &[(f64, Vec<f64>)]) -> Self {
        let Some((first, _)) = changes.first() else {
            return self.clone();
        };
        let mut kept = self.times.iter().take_while(|time| *time < first).count();
        let mut changed = Self {
            times: self.times[..kept].to_vec(),
            values: self.values[..kept * self.count].to_vec(),
            ..self.clone()
        };
        if kept == 0 {
            kept = 1;
            changed.times.push(first.next_down());
            changed
                .values
                .extend_from_slice(&self.values[..kept * self.count]);
        }
        for (time, row) in changes {
            changed.times.push(*time);
            changed.values.extend_from_slice(row);
        }
        changed
    }

    /// Returns true if an input varies between samples.
    pub fn is_time_varying(&self) -> bool {
        !(self.prescribed.is_empty() && self.functions.is_empty())
    }

    /// Returns true if the input at an index is a function of time.
    fn is_function(&self, place: usize) -> bool {
        let mut given = self.functions.iter();
        given.any(|given| (given.place..given.place + given.count).contains(&place))
    }

    /// Returns true if the input at an index is held between samples: neither prescribed nor a function of time.
    pub fn is_held(&self, place: usize) -> bool {
        let mut prescribed = self.prescribed.iter();
        !self.is_function(place)
            && !prescribed.any(|(first, _)| (*first..first + 3).contains(&place))
    }

    /// Returns the inputs at a time (s), in the order of the model.
    pub fn evaluate(&self, t: f64) -> Cow<'_, [f64]> {
        let held = self.last_sample(t);
        if !self.is_time_varying() {
            return Cow::Borrowed(held);
        }
        let after = if self.is_jump(t) { t.next_up() } else { t };
        Cow::Owned(self.add_varying_inputs(held.to_vec(), t, after))
    }

    /// Returns the inputs at a time (s), in the order of the model, with `held` as the values of held inputs.
    pub fn evaluate_with_held<'h>(&self, t: f64, held: &'h [f64]) -> Cow<'h, [f64]> {
        match self.is_time_varying() {
            true => Cow::Owned(self.add_varying_inputs(held.to_vec(), t, t)),
            false => Cow::Borrowed(held),
        }
    }

    /// Returns the prescribed motion at index `place` and its first three derivatives at a time, on the cubic
    /// that belongs to the time `piece`, both in s. A motion without samples is constant.
    pub fn evaluate_prescribed(&self, place: usize, t: f64, piece: f64) -> [f64; 4] {
        let mut prescribed = self.prescribed.iter();
        match prescribed.find(|(first, _)| *first == place) {
            Some((_, spline)) => spline.evaluate_piece(t, piece),
            None => [self.last_sample(piece)[place], 0.0, 0.0, 0.0],
        }
    }

    /// Returns the inputs just before a time (s), in the order of the model, with `held` as the values of held
    /// inputs.
    pub fn evaluate_before(&self, t: f64, held: &[f64]) -> Vec<f64> {
        let before = if self.is_jump(t) { t.next_down() } else { t };
        self.add_varying_inputs(held.to_vec(), t, before)
    }

    fn is_jump(&self, t: f64) -> bool {
        let found = self.jump_times.binary_search_by(|time| time.total_cmp(&t));
        found.is_ok()
    }

    /// Adds prescribed motions at `t` and functions at `function_time`, in s, to held inputs.
    fn add_varying_inputs(&self, mut inputs: Vec<f64>, t: f64, function_time: f64) -> Vec<f64> {
        for given in &self.functions {
            let indices = given.place..given.place + given.count;
            given.function.write(function_time, &mut inputs[indices]);
        }
        for (place, spline) in &self.prescribed {
            inputs[*place..*place + 3].copy_from_slice(&spline.evaluate(t));
        }
        inputs
    }

    /// Returns the bounds of the inputs from `begin` to `end` (s), between which no input jumps. Inputs given
    /// as functions of time get [`Enclosure::UNKNOWN`].
    pub fn bound(&self, begin: f64, end: f64) -> Vec<Enclosure> {
        let held = self.last_sample(begin).iter();
        let mut bounds: Vec<Enclosure> = held.map(|value| Enclosure::constant(*value)).collect();
        for given in &self.functions {
            bounds[given.place..given.place + given.count].fill(Enclosure::UNKNOWN);
        }
        for (place, spline) in &self.prescribed {
            bounds[*place..*place + 3].copy_from_slice(&spline.bound(begin, end));
        }
        bounds
    }

    /// Returns time (s), index and value of the first held input between two times (s) whose value is not
    /// finite.
    pub fn first_not_finite(&self, begin: f64, end: f64) -> Option<(f64, usize, f64)> {
        let is_held = |place: &usize| !self.is_function(*place);
        let first = self.last_sample_index(begin);
        let rows = (first..self.times.len()).take_while(|row| self.times[*row] <= end);
        rows.flat_map(|row| (0..self.count).map(move |place| (row, place)))
            .map(|(row, place)| {
                (
                    self.times[row],
                    place,
                    self.values[row * self.count + place],
                )
            })
            .find(|(_, place, value)| !value.is_finite() && is_held(place))
    }

    /// Returns the index of an input function that jumps near a time (s) that is not among the jump times. The
    /// change of such a function across this time hardly depends on the width of the interval.
    pub fn find_unknown_jump(&self, t: f64) -> Option<usize> {
        let size = t.abs().max(f64::MIN_POSITIVE);
        let is_near = |known: &f64| (known - t).abs() <= FAR_JUMP_DISTANCE * size;
        if self.jump_times.iter().any(is_near) {
            return None;
        }
        let values = |distance: f64| {
            let [before, after] = [-1.0, 1.0].map(|sign| self.evaluate(t + sign * distance * size));
            (before.into_owned(), after.into_owned())
        };
        let [near, far] = [NEAR_JUMP_DISTANCE, FAR_JUMP_DISTANCE].map(values);
        (0..self.count).find(|place| {
            let [near, far] = [&near, &far].map(|ends| (ends.1[*place] - ends.0[*place]).abs());
            self.is_function(*place) && near > 0.0 && near > 0.5 * far
        })
    }

    /// Returns the index of the last sample at or before a time (s), 0 before the first sample.
    pub fn last_sample_index(&self, t: f64) -> usize {
        self.count_times_until(t).saturating_sub(1)
    }

    /// Returns the held inputs of the last sample at or before a time (s), without prescribed motions and
    /// functions.
    pub fn last_sample(&self, t: f64) -> &[f64] {
        let row = self.last_sample_index(t);
        &self.values[row * self.count..(row + 1) * self.count]
    }

    /// Returns the number of sample times at or before `t`. The search divides if the times are evenly spaced,
    /// and bisects otherwise.
    fn count_times_until(&self, t: f64) -> usize {
        if self.count == 0 {
            return 0;
        }
        let times = &self.times;
        if let [only] = times[..] {
            return usize::from(only <= t);
        }
        let (first, last) = (times[0], times[times.len() - 1]);
        let part = (t - first) / (last - first);
        let near = ((part * (times.len() - 1) as f64) as usize).min(times.len());
        // The division may be wrong by one because of rounding.
        for count in [near + 1, near + 2, near] {
            let is_before = count == 0 || times.get(count - 1).is_some_and(|time| *time <= t);
            let is_after = times.get(count).is_none_or(|time| *time > t);
            if is_before && is_after {
                return count;
            }
        }
        times.partition_point(|time| *time <= t)
    }

    /// Returns the time (s) of the next jump of an input after `t`.
    pub fn next_change(&self, t: f64) -> Option<f64> {
        if self.count == 0 {
            return None;
        }
        let sample = self.times.get(self.count_times_until(t)).copied();
        let jump = self.jump_times.iter().copied().find(|time| *time > t);
        match (sample, jump) {
            (Some(sample), Some(jump)) => Some(sample.min(jump)),
            (sample, jump) => sample.or(jump),
        }
    }

    /// Returns the sample times, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }
}

#[cfg(test)]
mod tests {
    use super::HeldInputs;

    #[test]
    fn input_is_held_until_next_sample() {
        let held = HeldInputs {
            times: vec![0.0, 1.0, 2.0],
            values: vec![5.0, 6.0, 7.0],
            count: 1,
            prescribed: Vec::new(),
            functions: Vec::new(),
            jump_times: Vec::new(),
        };
        assert_eq!(*held.evaluate(-1.0), [5.0]);
        assert_eq!(*held.evaluate(0.999), [5.0]);
        assert_eq!(*held.evaluate(1.0), [6.0]);
        assert_eq!(*held.evaluate(9.0), [7.0]);
        assert_eq!(held.next_change(0.0), Some(1.0));
        assert_eq!(held.next_change(1.5), Some(2.0));
        assert_eq!(held.next_change(2.0), None);
    }

    #[test]
    fn held_row_is_found_for_even_and_uneven_times() {
        let even: Vec<f64> = (0..50).map(|k| 0.1 * f64::from(k)).collect();
        let uneven: Vec<f64> = even.iter().map(|t| t * t * t).collect();
        for times in [even, uneven, vec![2.0]] {
            let held = HeldInputs {
                values: (0..times.len()).map(|k| k as f64).collect(),
                times: times.clone(),
                count: 1,
                prescribed: Vec::new(),
                functions: Vec::new(),
                jump_times: Vec::new(),
            };
            for t in (-10..1300).map(|k| 0.1 * f64::from(k)).chain(times.clone()) {
                let row = times.iter().filter(|time| **time <= t).count().max(1) - 1;
                assert_eq!(held.last_sample(t), [row as f64], "at {t}");
            }
            assert_eq!(held.last_sample(f64::INFINITY), [(times.len() - 1) as f64]);
        }
    }

    #[test]
    fn zero_inputs_never_change() {
        assert_eq!(HeldInputs::zero(0).next_change(0.0), None);
        assert_eq!(*HeldInputs::zero(2).evaluate(3.0), [0.0, 0.0]);
    }

    #[derive(Debug)]
    struct Ramp;

    impl super::InputFunction for Ramp {
        fn write(&self, t: f64, out: &mut [f64]) {
            out.fill(2.0 * t);
        }
    }

    /// Function that is 0 until 3 s, inclusive, and 1 afterwards.
    #[derive(Debug)]
    struct LateStep;

    impl super::InputFunction for LateStep {
        fn write(&self, t: f64, out: &mut [f64]) {
            out.fill(f64::from(u8::from(t > 3.0)));
        }
    }

    #[test]
    fn function_at_its_break_has_the_value_after_it() {
        let held = HeldInputs::zero(1).with_function(0, 1, std::sync::Arc::new(LateStep));
        assert_eq!(*held.evaluate(3.0), [0.0]);
        let held = held.with_jump_times(vec![1.0, 3.0, 7.0]);
        assert_eq!(*held.evaluate(3.0), [1.0]);
        assert_eq!(*held.evaluate(3.0_f64.next_down()), [0.0]);
    }

    #[test]
    fn jump_of_a_function_is_found_unless_it_is_known() {
        let held = HeldInputs::zero(2).with_function(1, 1, std::sync::Arc::new(LateStep));
        assert_eq!(held.find_unknown_jump(3.0), Some(1));
        assert_eq!(held.find_unknown_jump(2.9), None);
        let known = held.with_jump_times(vec![3.0]);
        assert_eq!(known.find_unknown_jump(3.0), None);
        let ramp = HeldInputs::zero(1).with_function(0, 1, std::sync::Arc::new(Ramp));
        assert_eq!(ramp.find_unknown_jump(0.25), None);
    }

    #[test]
    fn function_varies_with_time_and_changes_at_its_breaks() {
        let held = HeldInputs::constant(vec![5.0, 6.0])
            .with_function(1, 1, std::sync::Arc::new(Ramp))
            .with_jump_times(vec![3.0, f64::NAN, 1.0]);
        assert!(held.is_time_varying());
        assert_eq!(*held.evaluate(0.25), [5.0, 0.5]);
        assert_eq!(held.next_change(0.0), Some(1.0));
        assert_eq!(held.next_change(1.0), Some(3.0));
        assert_eq!(held.next_change(3.0), None);
    }
}
