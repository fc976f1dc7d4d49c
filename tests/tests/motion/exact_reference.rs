//! The arm without modes, with four and with sixteen, without play and with it, against its
//! own Taylor series in double-doubles.
//!
//! The same series in doubles says what rounding alone does to these motions. With play
//! they are partly chaotic and the growth of a rounding error is a matter of luck, so the
//! largest of several runs counts, which differ in their steps and so in their roundings.
//! The exact solver is asked to stay within ten times that.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::program::lowering::lower;
use eomgen_compiled_model::Driven;
use eomgen_model_spec::model::Model;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Settings, Trajectory, simulate};
use eomgen_sim::piecewise_linear::PiecewiseLinear;
use eomgen_tests::models::load;
use eomgen_tests::taylor::arm::Case;
use eomgen_tests::taylor::double_double::DoubleDouble;
use eomgen_tests::taylor::run::{LONGEST, Run};
use eomgen_tests::taylor::scalar::Scalar;

/// The paper's faster ripple, 10 pi rad/s.
const OMEGA: f64 = 31.41592653589793;

/// Parts of the span at whose ends deviations are told.
const PARTS: [f64; 3] = [0.25, 0.5, 1.0];

/// Largest deviations from the reference, in m.
#[derive(Clone, Copy, Debug, Default)]
struct Deviation {
    x_sp: f64,
    tip: f64,
}

impl Deviation {
    fn within(self, bound: f64) -> bool {
        self.x_sp < bound && self.tip < bound
    }

    fn larger(self, other: Self) -> Self {
        Self {
            x_sp: self.x_sp.max(other.x_sp),
            tip: self.tip.max(other.tip),
        }
    }
}

impl std::fmt::Display for Deviation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "x_sp {:.1e} m, tip {:.1e} m", self.x_sp, self.tip)
    }
}

/// The largest deviations up to the ends of [`PARTS`].
type Growth = [Deviation; 3];

/// A run in double-doubles with a sample per millisecond.
struct Reference {
    case: Case,
    times: Vec<f64>,
    run: Run<DoubleDouble>,
}

impl Reference {
    fn new(order: usize, b: f64, until: f64) -> Self {
        let samples = (until * 1000.0).round() as usize;
        let times: Vec<f64> = (0..=samples).map(|k| k as f64 / 1000.0).collect();
        let case = Case {
            order,
            b,
            omega: OMEGA,
        };
        let run = Run::of(case, &times, LONGEST);
        Self { case, times, run }
    }

    /// The deviation at one sample.
    fn deviation(&self, sample: usize, x_sp: f64, tip: f64) -> Deviation {
        let [x_sp, tip] = [x_sp, tip].map(DoubleDouble::exactly);
        let state = &self.run.states[sample];
        Deviation {
            x_sp: (x_sp - state.positions[0]).nearest().abs(),
            tip: (tip - self.run.tip(sample)).nearest().abs(),
        }
    }

    /// How states that list all displacements first deviate.
    fn growth<'a>(&self, states: impl ExactSizeIterator<Item = &'a [f64]>) -> Growth {
        assert_eq!(states.len(), self.times.len());
        let mut growth = Growth::default();
        let end = (self.times.len() - 1) as f64;
        for (sample, state) in states.enumerate() {
            let shapes = self.run.tips.iter().zip(&state[3..]);
            let tip = shapes.map(|(phi, q)| phi.nearest() * q).sum();
            let deviation = self.deviation(sample, state[0], tip);
            for (growth, part) in growth.iter_mut().zip(PARTS) {
                if sample as f64 <= part * end {
                    *growth = growth.larger(deviation);
                }
            }
        }
        growth
    }

    /// What rounding to doubles does to the same series: the largest of three runs.
    fn rounding(&self) -> Growth {
        let mut rounding = Growth::default();
        for power in [10, 17, 18] {
            let run = Run::<f64>::of(self.case, &self.times, 0.5_f64.powi(power));
            assert_eq!(run.counts(), self.run.counts(), "switches");
            let growth = self.growth(run.states.iter().map(|state| &state.positions[..]));
            for (largest, growth) in rounding.iter_mut().zip(growth) {
                *largest = largest.larger(growth);
            }
        }
        rounding
    }
}

/// One case in double and in extended precision, and by exact propagation.
struct Comparison {
    /// Doubles against the reference.
    rounding: Growth,
    /// The exact solver against it.
    exact: Growth,
    /// Of the meshes sun-planet and planet-ring.
    switches: [usize; 2],
    /// Of both meshes by the exact solver, after the start.
    exact_switches: usize,
}

/// Follows the arm with `order` modes and half a backlash of `b` m for `until` s.
fn compare(order: usize, b: f64, until: f64) -> Comparison {
    let reference = Reference::new(order, b, until);
    let trajectory = exact(&reference, until);
    let displacements = trajectory.states.iter().map(|state| &state[..3 + order]);
    let after_start = trajectory.switches.iter().filter(|switch| switch.t > LEFT);
    Comparison {
        rounding: reference.rounding(),
        exact: reference.growth(displacements),
        switches: reference.run.counts(),
        exact_switches: after_start.count(),
    }
}

/// The same motion from switch to switch, by the derived model.
fn exact(reference: &Reference, until: f64) -> Trajectory {
    let model = model(reference.case);
    let orders = vec![reference.case.order; model.fields.len()];
    let derived = PiecewiseLinear::of(&model, &orders).expect("linear between its switches");
    let mut propagator = derived.propagator(&model).expect("matrices");
    let rest = vec![0.0; propagator.states()];
    let none = HeldInputs::zero(0);
    let trajectory = propagator.simulate(&rest, (0.0, until), &reference.times, &none, &mut |_| {});
    trajectory.expect("a trajectory")
}

/// The exact solver may deviate by so many times what rounding does to the series in doubles.
const FACTOR: f64 = 10.0;

/// The largest deviation of either, m; doubles must stay a tenth of it below.
const LARGEST: f64 = 1e-10;

/// Without play a mesh begins on its surface. The reference takes leaving it for no switch;
/// the exact solver has it some nanoseconds later.
const LEFT: f64 = 1e-6;

/// What is asked of the exact solver in a case.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Asked {
    /// [`LARGEST`] and [`FACTOR`].
    Both,
    /// [`LARGEST`] alone.
    Largest,
}

/// Over two seconds doubles and the exact solver follow the reference, with these switches.
fn both_follow(order: usize, b: f64, switches: [usize; 2], asked: Asked) {
    let until = 2.0;
    let compared = compare(order, b, until);
    let both = compared.rounding.into_iter().zip(compared.exact);
    for (part, (rounding, exact)) in PARTS.into_iter().zip(both) {
        let ratios = [exact.x_sp / rounding.x_sp, exact.tip / rounding.tip];
        println!(
            "S = {order}, b = {b:e} m, {} s: exact {exact}; double {rounding}; ratio {:.1}, {:.1}",
            part * until,
            ratios[0],
            ratios[1]
        );
        assert!(rounding.within(0.1 * LARGEST), "double: {rounding}");
        assert!(exact.within(LARGEST), "exact: {exact}");
        // Over the whole run: in parts of it single samples deviate by some 1e-14 m more.
        if asked == Asked::Both && part == 1.0 {
            // Without modes both tips are zero.
            let within = exact.x_sp <= FACTOR * rounding.x_sp && exact.tip <= FACTOR * rounding.tip;
            assert!(within, "{ratios:?}");
        }
    }
    let case = format!("S = {order}, b = {b:e} m");
    assert_eq!(compared.switches, switches, "{case}");
    let all: usize = switches.iter().sum();
    assert_eq!(compared.exact_switches, all, "{case}");
}

#[test]
fn the_rigid_arm() {
    both_follow(0, 0.0, [20, 20], Asked::Both);
    both_follow(0, 1e-6, [163, 331], Asked::Both);
    both_follow(0, 25e-6, [409, 560], Asked::Both);
    both_follow(0, 100e-6, [518, 678], Asked::Both);
}

#[test]
fn the_papers_arm_with_little_play() {
    both_follow(4, 0.0, [20, 20], Asked::Both);
    both_follow(4, 1e-6, [207, 317], Asked::Both);
}

#[test]
fn the_papers_arm_with_much_play() {
    both_follow(4, 25e-6, [381, 584], Asked::Largest);
    both_follow(4, 100e-6, [498, 700], Asked::Both);
}

#[test]
fn sixteen_modes_with_little_play() {
    both_follow(16, 0.0, [20, 20], Asked::Both);
    both_follow(16, 1e-6, [207, 315], Asked::Both);
}

#[test]
fn sixteen_modes_with_much_play() {
    both_follow(16, 25e-6, [377, 590], Asked::Largest);
    both_follow(16, 100e-6, [518, 720], Asked::Both);
}

/// The shipped arm in one case.
fn model(case: Case) -> Model {
    let values = [("b_sp", case.b), ("b_pr", case.b), ("omega", case.omega)];
    let model = load("planetary_arm").with_parameters(&values);
    model.expect("the values are within their bounds")
}

/// The derived model by the general solver, for orders without and with modes.
fn general_solver_agrees(order: usize, b: f64) {
    let reference = Reference::new(order, b, 0.02);
    let model = model(reference.case);
    let orders = vec![order; model.fields.len()];
    let equations = eomgen_codegen::mechanics::equations::derive(&model, &orders)
        .expect("the model can be derived");
    let parameters = model
        .parameter_values()
        .expect("the parameters have values");
    let evaluator = Evaluator::new(lower(&model, &equations, &parameters));
    let system = Driven::new(RefCell::new(evaluator), HeldInputs::zero(0));
    let trajectory = simulate(
        &system,
        &vec![0.0; 2 * (3 + order)],
        (0.0, 0.02),
        &reference.times,
        &Settings::with_tolerance(1e-12),
        &mut |_| {},
    )
    .expect("a trajectory");
    let displacements = trajectory.states.iter().map(|state| &state[..3 + order]);
    let [.., worst] = reference.growth(displacements);
    println!("S = {order}, b = {b:e} m: {worst}");
    // A relative error of 1e-12 a step, of motions of 1e-4 m.
    assert!(worst.x_sp < 1e-14 && worst.tip < 1e-14, "{worst}");
}

#[test]
fn the_reference_is_the_derived_model() {
    for order in [0, 1, 16] {
        for b in [0.0, 1e-6, 100e-6] {
            general_solver_agrees(order, b);
        }
    }
}
