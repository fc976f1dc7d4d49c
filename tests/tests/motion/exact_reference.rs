//! Comparison of the arm with zero, four and sixteen modes, with and without backlash, with its Taylor series in
//! double-double arithmetic.
//!
//! The Taylor series in doubles measures the effect of rounding errors on these motions. With backlash the motions are
//! partly chaotic, so the growth of a rounding error is random. The bound is ten times the largest deviation of several
//! runs. The runs have different steps and therefore different rounding errors.

use eomgen_model_spec::model::Model;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;
use eomgen_sim::piecewise_linear::PiecewiseLinear;
use eomgen_tests::models::load;
use eomgen_tests::motions::TestMotion;
use eomgen_tests::taylor::arm::Case;
use eomgen_tests::taylor::double_double::DoubleDouble;
use eomgen_tests::taylor::run::{MAX_STEP_S, Run};
use eomgen_tests::taylor::scalar::Scalar;

/// The paper's higher excitation frequency, 10 pi rad/s.
const OMEGA: f64 = 31.41592653589793;

/// Fractions of the time span at which deviations are compared.
const PARTS: [f64; 3] = [0.25, 0.5, 1.0];

/// Largest deviations from the reference, in m.
#[derive(Clone, Copy, Debug, Default)]
struct Deviation {
    x_sp: f64,
    tip: f64,
}

impl Deviation {
    fn is_within(self, bound: f64) -> bool {
        self.x_sp < bound && self.tip < bound
    }

    fn max(self, other: Self) -> Self {
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

/// Largest deviations up to the times of [`PARTS`].
type Growth = [Deviation; 3];

/// Double-double run with one sample per millisecond.
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
        let run = Run::simulate(case, &times, MAX_STEP_S);
        Self { case, times, run }
    }

    fn deviation(&self, sample: usize, x_sp: f64, tip: f64) -> Deviation {
        let [x_sp, tip] = [x_sp, tip].map(DoubleDouble::exactly);
        let state = &self.run.states[sample];
        Deviation {
            x_sp: (x_sp - state.positions[0]).to_f64().abs(),
            tip: (tip - self.run.tip(sample)).to_f64().abs(),
        }
    }

    /// Returns the deviations from the reference; the first entries of each state are the displacements.
    fn growth<'a>(&self, states: impl ExactSizeIterator<Item = &'a [f64]>) -> Growth {
        assert_eq!(states.len(), self.times.len());
        let mut growth = Growth::default();
        let end = (self.times.len() - 1) as f64;
        for (sample, state) in states.enumerate() {
            let shapes = self.run.tips.iter().zip(&state[3..]);
            let tip = shapes.map(|(phi, q)| phi.to_f64() * q).sum();
            let deviation = self.deviation(sample, state[0], tip);
            for (growth, part) in growth.iter_mut().zip(PARTS) {
                if sample as f64 <= part * end {
                    *growth = growth.max(deviation);
                }
            }
        }
        growth
    }

    /// Returns the largest deviations of the series in doubles over five runs.
    fn rounding(&self) -> Growth {
        let mut rounding = Growth::default();
        for power in [10, 11, 12, 13, 14] {
            let run = Run::<f64>::simulate(self.case, &self.times, 0.5_f64.powi(power));
            assert_eq!(run.switch_counts(), self.run.switch_counts(), "switches");
            let growth = self.growth(run.states.iter().map(|state| &state.positions[..]));
            for (largest, growth) in rounding.iter_mut().zip(growth) {
                *largest = largest.max(growth);
            }
        }
        rounding
    }
}

struct Comparison {
    rounding: Growth,
    exact: Growth,
    /// Numbers of switches of the sun-planet and planet-ring meshes.
    switches: [usize; 2],
    /// Number of distinct switching times of the exact solver after [`AFTER_START_S`].
    exact_switches: usize,
}

/// Compares the arm with `order` modes and half a backlash of `b` m over `until` s.
fn compare(order: usize, b: f64, until: f64) -> Comparison {
    let reference = Reference::new(order, b, until);
    let trajectory = simulate_exactly(&reference, until);
    let displacements = trajectory.states.iter().map(|state| &state[..3 + order]);
    let times = trajectory.events.iter().map(|event| event.t);
    let mut after_start: Vec<f64> = times.filter(|t| *t > AFTER_START_S).collect();
    // Without backlash both surfaces of a mesh coincide.
    after_start.dedup();
    Comparison {
        rounding: reference.rounding(),
        exact: reference.growth(displacements),
        switches: reference.run.switch_counts(),
        exact_switches: after_start.len(),
    }
}

fn simulate_exactly(reference: &Reference, until: f64) -> Trajectory {
    let model = model(reference.case);
    let orders = vec![reference.case.order; model.fields.len()];
    let derived = PiecewiseLinear::derive(&model, &orders).expect("linear between its switches");
    let mut propagator = derived.propagator_for_model(&model).expect("matrices");
    let rest = vec![0.0; propagator.state_count()];
    let none = HeldInputs::zero(0);
    let trajectory = propagator.simulate(&rest, (0.0, until), &reference.times, &none, &mut |_| {});
    trajectory.expect("a trajectory")
}

/// Maximum ratio of the exact solver's deviation to that of the series in doubles.
const MAX_ROUNDING_RATIO: f64 = 10.0;

/// Maximum deviation in m; the series in doubles must stay below a tenth of it.
const MAX_DEVIATION_M: f64 = 1e-10;

/// Time in s after which switches are counted. Without backlash, a mesh starts on its switching surface. The exact
/// solver counts its departure after some nanoseconds as a switch; the reference does not.
const AFTER_START_S: f64 = 1e-6;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Bounds {
    /// [`MAX_DEVIATION_M`] and [`MAX_ROUNDING_RATIO`].
    DeviationAndRatio,
    /// Only [`MAX_DEVIATION_M`].
    DeviationOnly,
}

/// Asserts that the series in doubles and the exact solver match the reference over two seconds, with these switch
/// counts.
fn assert_both_match_reference(order: usize, b: f64, switches: [usize; 2], bounds: Bounds) {
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
        assert!(
            rounding.is_within(0.1 * MAX_DEVIATION_M),
            "double: {rounding}"
        );
        assert!(exact.is_within(MAX_DEVIATION_M), "exact: {exact}");
        // The ratio is checked over the whole time span only, because single samples can deviate by 1e-14 m more over a
        // part of it.
        if bounds == Bounds::DeviationAndRatio && part == 1.0 {
            let within = exact.x_sp <= MAX_ROUNDING_RATIO * rounding.x_sp
                && exact.tip <= MAX_ROUNDING_RATIO * rounding.tip;
            assert!(within, "{ratios:?}");
        }
    }
    let case = format!("S = {order}, b = {b:e} m");
    assert_eq!(compared.switches, switches, "{case}");
    let all: usize = switches.iter().sum();
    assert_eq!(compared.exact_switches, all, "{case}");
}

#[test]
fn exact_matches_reference_for_rigid_arm() {
    assert_both_match_reference(0, 0.0, [20, 20], Bounds::DeviationAndRatio);
    assert_both_match_reference(0, 1e-6, [163, 331], Bounds::DeviationAndRatio);
    assert_both_match_reference(0, 25e-6, [409, 560], Bounds::DeviationAndRatio);
    assert_both_match_reference(0, 100e-6, [518, 678], Bounds::DeviationAndRatio);
}

#[test]
fn exact_matches_reference_without_backlash() {
    assert_both_match_reference(4, 0.0, [20, 20], Bounds::DeviationAndRatio);
    assert_both_match_reference(4, 1e-6, [207, 317], Bounds::DeviationAndRatio);
}

#[test]
fn exact_matches_reference_with_backlash() {
    assert_both_match_reference(4, 25e-6, [381, 584], Bounds::DeviationOnly);
    assert_both_match_reference(4, 100e-6, [498, 700], Bounds::DeviationAndRatio);
}

#[test]
fn exact_matches_reference_for_sixteen_modes_without_backlash() {
    assert_both_match_reference(16, 0.0, [20, 20], Bounds::DeviationAndRatio);
    assert_both_match_reference(16, 1e-6, [207, 315], Bounds::DeviationAndRatio);
}

#[test]
fn exact_matches_reference_for_sixteen_modes_with_backlash() {
    assert_both_match_reference(16, 25e-6, [377, 590], Bounds::DeviationOnly);
    assert_both_match_reference(16, 100e-6, [518, 720], Bounds::DeviationAndRatio);
}

fn model(case: Case) -> Model {
    let values = [("b_sp", case.b), ("b_pr", case.b), ("omega", case.omega)];
    let model = load("planetary_arm").with_parameters(&values);
    model.expect("the values are within their bounds")
}

fn assert_general_solver_matches(order: usize, b: f64) {
    let reference = Reference::new(order, b, 0.02);
    let model = model(reference.case);
    let subject = TestMotion::new(model, order);
    let trajectory = subject
        .simulate_generally((0.0, 0.02), &reference.times, 1e-12)
        .expect("a trajectory");
    let displacements = trajectory.states.iter().map(|state| &state[..3 + order]);
    let [.., worst] = reference.growth(displacements);
    println!("S = {order}, b = {b:e} m: {worst}");
    // The relative tolerance of 1e-12 per step applies to motions of 1e-4 m.
    assert!(worst.x_sp < 1e-14 && worst.tip < 1e-14, "{worst}");
}

#[test]
fn reference_matches_derived_model() {
    for order in [0, 1, 16] {
        for b in [0.0, 1e-6, 100e-6] {
            assert_general_solver_matches(order, b);
        }
    }
}
