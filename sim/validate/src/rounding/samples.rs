//! Rounding errors of the quantities of a program at random points, compared with double-double arithmetic.

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Number, Point};
use eomgen_codegen::rounding::{Format, Quantity, Ranges, ScalarOp, Scalars, quantities};
use eomgen_codegen::statements::collect_coefficients;
use eomgen_model_spec::interval::Interval;

use crate::double_double::DoubleDouble;
use crate::random::Random;

/// Sampler of the rounding errors of one program in one number format.
pub struct ErrorSampler {
    program: Program,
    format: Format,
    ranges: Vec<Interval>,
    evaluator: Evaluator,
    scalars: Scalars,
    /// Quantities with their indices in `scalars`.
    quantities: Vec<(Quantity, usize)>,
    /// Discontinuous operations, and the comparisons of selections.
    jumps: Vec<ScalarOp>,
    known: Vec<DoubleDouble>,
    largest: Vec<f64>,
    /// Last point; the errors at this point are empty if it was not compared.
    point: Vec<f64>,
    errors: Vec<f64>,
    /// Number of drawn points, and number of points at which the computed and the exact value are on different sides of
    /// a jump.
    counts: [usize; 2],
}

impl ErrorSampler {
    /// Creates a sampler for points in `ranges`; variables without a range are 0.
    pub fn new(program: &Program, format: Format, ranges: &Ranges) -> Self {
        let quantities = quantities(program);
        let roots: Vec<_> = quantities.iter().map(|quantity| quantity.value).collect();
        let scalars = Scalars::record(program, &roots, format);
        let numbers = quantities
            .iter()
            .map(|quantity| scalars.element(program, quantity.value, quantity.index));
        let numbers: Vec<usize> = numbers.collect();
        let evaluator = Evaluator::new(program.clone());
        let evaluator = match format {
            Format::Double => evaluator,
            Format::Single => evaluator.in_single_precision(&collect_coefficients(program)),
        };
        let jumps = scalars.list.iter().map(|scalar| scalar.op);
        let jumps = jumps.filter(|op| match op {
            ScalarOp::Select(_) => true,
            ScalarOp::Call(function, ..) => function.is_step(),
            _ => false,
        });
        let still = Interval {
            low: 0.0,
            high: 0.0,
        };
        Self {
            program: program.clone(),
            format,
            ranges: ranges.iter().map(|range| range.unwrap_or(still)).collect(),
            evaluator,
            jumps: jumps.collect(),
            known: Vec::new(),
            largest: vec![0.0; numbers.len()],
            quantities: quantities.into_iter().zip(numbers).collect(),
            scalars,
            point: Vec::new(),
            errors: Vec::new(),
            counts: [0; 2],
        }
    }

    /// Draws a point and compares all quantities at this point. Each component is an end of its range with probability
    /// 1/2.
    ///
    /// # Errors
    /// A quantity whose recorded operations are not bit-identical to the evaluator.
    pub fn draw(&mut self, random: &mut Random) -> Result<(), String> {
        let first_parameter = self.ranges.len() - self.program.parameters.len();
        self.point.clear();
        for (place, range) in self.ranges.iter().enumerate() {
            let number = match random.unit() {
                choice if choice < 0.25 => range.low,
                choice if choice < 0.5 => range.high,
                _ => range.low + random.unit() * (range.high - range.low),
            };
            let number = number.clamp(range.low, range.high);
            // Parameters have double precision in both formats.
            self.point.push(match place < first_parameter {
                true => round_inside(self.format, number, *range),
                false => number,
            });
        }
        self.compare()
    }

    fn compare(&mut self) -> Result<(), String> {
        self.counts[0] += 1;
        self.errors.clear();
        let rounded = self.scalars.evaluate_rounded(&self.point);
        self.known = self.scalars.evaluate::<DoubleDouble>(&self.point);
        if self
            .jumps
            .iter()
            .any(|op| self.is_on_other_side(op, &rounded))
        {
            self.counts[1] += 1;
            return Ok(());
        }
        self.compute();
        for ((quantity, number), largest) in self.quantities.iter().zip(&mut self.largest) {
            let (recorded, exact) = (rounded[*number], self.known[*number]);
            let values = self.evaluator.slice(quantity.value);
            let computed = values[quantity.index.min(values.len() - 1)];
            if computed.to_bits() != recorded.to_bits() && !(computed == 0.0 && recorded == 0.0) {
                return Err(format!(
                    "the evaluator computes {} = {computed:e}, but its recorded operations give {recorded:e}, at {:?}",
                    quantity.name, self.point
                ));
            }
            let rest = (computed - exact.high) - exact.low;
            let error = match rest.is_nan() {
                true => f64::INFINITY,
                false => rest.abs(),
            };
            *largest = largest.max(error);
            self.errors.push(error);
        }
        Ok(())
    }

    fn is_on_other_side(&self, op: &ScalarOp, rounded: &[f64]) -> bool {
        let exact = |place: usize| self.known[place];
        match *op {
            ScalarOp::Select([a, b, ..]) => {
                (rounded[a] > rounded[b]) != ((exact(a) - exact(b)).high > 0.0)
            }
            ScalarOp::Call(function, a, b) => {
                let computed: f64 = Number::call(function, rounded[a], rounded[b]);
                DoubleDouble::call(function, exact(a), exact(b)) != DoubleDouble::new(computed)
            }
            _ => false,
        }
    }

    /// Computes all quantities with the evaluator.
    fn compute(&mut self) {
        let (states, inputs) = (self.program.states(), self.program.inputs.len());
        let degrees = self.program.degrees_of_freedom();
        let (t, rest) = self.point.split_at(1);
        let (state, rest) = rest.split_at(states);
        let (inputs, parameters) = rest.split_at(inputs);
        self.evaluator.prepare(parameters);
        let point = Point {
            t: t[0],
            state,
            inputs,
        };
        let mut scratch = vec![0.0; (degrees * degrees).max(states)];
        self.evaluator.rates(point, &mut scratch[..states]);
        let (mut bias, mut forces) = (vec![0.0; degrees], vec![0.0; degrees]);
        self.evaluator
            .bias_and_forces(point, &mut bias, &mut forces);
        self.evaluator
            .mass_matrix(point, &mut scratch[..degrees * degrees]);
    }

    /// Returns the last point, and the error of each quantity at this point. There are no errors if the computed and
    /// the exact value are on different sides of a jump.
    pub fn last(&self) -> (&[f64], &[f64]) {
        (&self.point, &self.errors)
    }

    /// Returns the largest error of each quantity.
    pub fn largest_errors(&self) -> &[f64] {
        &self.largest
    }

    /// Returns the format of the computation.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Returns the number of compared points.
    pub fn compared(&self) -> usize {
        self.counts[0] - self.counts[1]
    }
}

/// Returns the number of the format that is nearest to `number`, or its neighbour inside the range.
fn round_inside(format: Format, number: f64, range: Interval) -> f64 {
    let near = format.round(number);
    if format == Format::Double || range.contains(near) || range.low == range.high {
        return near;
    }
    let single = near as f32;
    let next = match near > range.high {
        true => single.next_down(),
        false => single.next_up(),
    };
    f64::from(next)
}
