//! Classification of the motion of a case, from as many forcing periods as needed.

use eomgen_analysis::classify::{Evidence, Motion, SIGNIFICANT_STANDARD_ERRORS, Verdict, classify};
use eomgen_analysis::exponent::Exponent;
use eomgen_analysis::poincare::{Section, Shape};
use eomgen_analysis::zero_one::chaos_indicator;
use eomgen_sim::piecewise_linear::Propagator;

use super::arm::Case;
use super::error::StudyError;
use super::neighbours::TangentMotion;
use super::series::{FIRST_MODE, X_PR, X_SP};

/// Tolerance for equal points of the section, relative to the extent of the motion. It exceeds the rest of a transient
/// that decays over tens of periods, and is below visible differences.
const SECTION_TOLERANCE: f64 = 2e-3;

/// Kind of a motion with its evidence.
pub(super) struct Classification {
    pub evidence: Evidence,
    pub verdict: Verdict,
    /// Points of x_sp, x_pr and their rates once per forcing period; m and m/s.
    pub section: Vec<f64>,
    pub shape: Shape,
    /// Number of forcing periods used.
    pub periods: usize,
}

/// Properties of a motion that are known without the Lyapunov exponent.
pub(super) struct MotionProperties<'a> {
    pub case: &'a Case,
    /// Extent of each component of the state.
    pub extents: &'a [f64],
    pub line_share: Option<f64>,
}

/// Classifies a motion from `periods` forcing periods. Doubles this number up to `most` until the kind of motion is
/// decided.
pub(super) fn classify_motion(
    neighbours: &mut TangentMotion,
    propagator: &mut Propagator,
    known: &MotionProperties<'_>,
    (mut periods, most): (usize, usize),
) -> Result<Classification, StudyError> {
    loop {
        neighbours.extend(propagator, periods)?;
        let found = weigh(neighbours, known, periods)?;
        if found.is_decided(known.case) || periods >= most {
            return Ok(found);
        }
        periods = (2 * periods).min(most);
    }
}

fn weigh(
    neighbours: &TangentMotion,
    known: &MotionProperties<'_>,
    periods: usize,
) -> Result<Classification, StudyError> {
    let places = mesh_state_indices(known.case);
    let section: Vec<f64> = neighbours
        .states()
        .iter()
        .flat_map(|state| places.map(|index| state.get(index).copied().unwrap_or_default()))
        .collect();
    // A constant coordinate has no scale; any value will do.
    let scale = places.map(|index| match known.extents.get(index) {
        Some(scale) if *scale > 0.0 => *scale,
        _ => 1.0,
    });
    let shape = Section {
        points: &section,
        scale: &scale,
    }
    .shape(SECTION_TOLERANCE)?;
    let strobe: Vec<f64> = section.iter().step_by(places.len()).copied().collect();
    let evidence = Evidence {
        exponent: Some(neighbours.exponent()?),
        chaos_indicator: chaos_indicator(&strobe).ok(),
        period: shape.period,
        line_share: known.line_share,
        forcing: known.case.omega,
    };
    Ok(Classification {
        verdict: classify(&evidence),
        evidence,
        section,
        shape,
        periods,
    })
}

impl Classification {
    fn is_decided(&self, case: &Case) -> bool {
        let exponent = self.evidence.exponent;
        self.verdict.motion != Motion::Undecided
            || exponent.is_some_and(|exponent| is_strong_growth(&exponent, case))
    }
}

/// Returns true if the growth is fast enough to decide without other evidence.
pub(super) fn is_strong_growth(exponent: &Exponent, case: &Case) -> bool {
    (exponent.value - SIGNIFICANT_STANDARD_ERRORS * exponent.standard_error) * case.period() > 1.0
}

/// Returns the indices of x_sp, x_pr and their rates in the state.
fn mesh_state_indices(case: &Case) -> [usize; 4] {
    let rates = FIRST_MODE + case.order;
    [X_SP, X_PR, rates + X_SP, rates + X_PR]
}
