//! The arm without modes, with four and with sixteen, without play and with it, against its
//! own Taylor series in double-doubles.
//!
//! The same series in doubles says what rounding alone does to these motions. With play
//! they are partly chaotic and the growth of a rounding error is a matter of luck, so the
//! largest of several runs counts, which differ in their steps and so in their roundings.

use codegen::evaluator::Evaluator;
use codegen::lower::lower;
use eomgen_tests::models::load;
use eomgen_tests::taylor::arm::Case;
use eomgen_tests::taylor::double_double::DoubleDouble;
use eomgen_tests::taylor::run::{LONGEST, Run};
use eomgen_tests::taylor::scalar::Scalar;
use model_spec::model::Model;
use sim::derived::Driven;
use sim::record::HeldInputs;
use sim::solve::{Settings, simulate};

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

/// One case in double and in extended precision.
struct Comparison {
    /// Doubles against the reference.
    rounding: Growth,
    /// Of the meshes sun-planet and planet-ring.
    switches: [usize; 2],
}

/// Follows the arm with `order` modes and half a backlash of `b` m for `until` s.
fn compare(order: usize, b: f64, until: f64) -> Comparison {
    let reference = Reference::new(order, b, until);
    Comparison {
        rounding: reference.rounding(),
        switches: reference.run.counts(),
    }
}

/// Two seconds in doubles stay within a tenth of 1e-10 m, with these switches.
fn doubles_suffice(order: usize, b: f64, switches: [usize; 2]) {
    let until = 2.0;
    let compared = compare(order, b, until);
    for (part, rounding) in PARTS.into_iter().zip(compared.rounding) {
        println!("S = {order}, b = {b:e} m, {} s: {rounding}", part * until);
        assert!(rounding.x_sp < 1e-11 && rounding.tip < 1e-11, "{rounding}");
    }
    assert_eq!(compared.switches, switches, "S = {order}, b = {b:e} m");
}

#[test]
fn doubles_follow_the_rigid_arm() {
    doubles_suffice(0, 0.0, [20, 20]);
    doubles_suffice(0, 1e-6, [163, 331]);
    doubles_suffice(0, 100e-6, [518, 678]);
}

#[test]
fn doubles_follow_the_papers_arm() {
    doubles_suffice(4, 25e-6, [381, 584]);
}

#[test]
fn doubles_follow_sixteen_modes_with_little_play() {
    doubles_suffice(16, 0.0, [20, 20]);
    doubles_suffice(16, 1e-6, [207, 315]);
}

#[test]
fn doubles_follow_sixteen_modes_with_much_play() {
    doubles_suffice(16, 100e-6, [518, 720]);
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
    let equations = codegen::equations::derive(&model, &orders).expect("the model can be derived");
    let parameters = model
        .parameter_values()
        .expect("the parameters have values");
    let evaluator = Evaluator::new(lower(&model, &equations, &parameters));
    let system = Driven::new(evaluator, HeldInputs::zero(0)).expect("a positive mass matrix");
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
