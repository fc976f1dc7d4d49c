//! What kind of motion a case is: evidence from as many forcing periods as it takes.

use eomgen_analysis::classify::{Evidence, Motion, SIGNIFICANCE, Verdict, classify};
use eomgen_analysis::exponent::Exponent;
use eomgen_analysis::poincare::{Section, Shape};
use eomgen_analysis::zero_one::chaos_indicator;
use eomgen_sim::piecewise_linear::Propagator;

use super::arm::Case;
use super::error::StudyError;
use super::neighbours::Neighbours;
use super::series::{FIRST_MODE, X_PR, X_SP};

/// Points of the section are equal within this share of the motion's extent: above what is
/// left of a transient that decays over tens of periods, below what the eye sees.
const TOLERANCE: f64 = 2e-3;

/// The kind of a motion, and what speaks for it.
pub(super) struct Found {
    pub evidence: Evidence,
    pub verdict: Verdict,
    /// Points of x_sp, x_pr and their rates, once per forcing period; m and m/s.
    pub section: Vec<f64>,
    pub shape: Shape,
    /// How many forcing periods it is from.
    pub periods: usize,
}

/// What is known of a motion beside its neighbours.
pub(super) struct Known<'a> {
    pub case: &'a Case,
    /// The extent of each number of the state.
    pub extents: &'a [f64],
    /// The share of the spectrum's power in lines.
    pub line_share: Option<f64>,
}

/// Finds the kind from `periods` forcing periods, and from twice as many again and again, up
/// to `most`, until it is decided.
pub(super) fn find(
    neighbours: &mut Neighbours,
    propagator: &mut Propagator,
    known: &Known<'_>,
    (mut periods, most): (usize, usize),
) -> Result<Found, StudyError> {
    loop {
        neighbours.extend(propagator, periods)?;
        let found = weigh(neighbours, known, periods)?;
        if found.is_decided(known.case) || periods >= most {
            return Ok(found);
        }
        periods = (2 * periods).min(most);
    }
}

fn weigh(neighbours: &Neighbours, known: &Known<'_>, periods: usize) -> Result<Found, StudyError> {
    let places = mesh_places(known.case);
    let section: Vec<f64> = neighbours
        .states()
        .iter()
        .flat_map(|state| places.map(|place| state.get(place).copied().unwrap_or_default()))
        .collect();
    // A coordinate that does not move at all has any scale.
    let scale = places.map(|place| match known.extents.get(place) {
        Some(scale) if *scale > 0.0 => *scale,
        _ => 1.0,
    });
    let shape = Section {
        points: &section,
        scale: &scale,
    }
    .shape(TOLERANCE)?;
    let strobe: Vec<f64> = section.iter().step_by(places.len()).copied().collect();
    let evidence = Evidence {
        exponent: Some(neighbours.exponent()?),
        chaos_indicator: chaos_indicator(&strobe).ok(),
        period: shape.period,
        line_share: known.line_share,
        forcing: known.case.omega,
    };
    Ok(Found {
        verdict: classify(&evidence),
        evidence,
        section,
        shape,
        periods,
    })
}

impl Found {
    fn is_decided(&self, case: &Case) -> bool {
        let exponent = self.evidence.exponent;
        self.verdict.motion != Motion::Undecided
            || exponent.is_some_and(|exponent| is_strong(&exponent, case))
    }
}

/// Whether neighbours part so fast that nothing else need be asked.
pub(super) fn is_strong(exponent: &Exponent, case: &Case) -> bool {
    (exponent.value - SIGNIFICANCE * exponent.standard_error) * case.period() > 1.0
}

/// Places of x_sp, x_pr and their rates in the state.
fn mesh_places(case: &Case) -> [usize; 4] {
    let rates = FIRST_MODE + case.order;
    [X_SP, X_PR, rates + X_SP, rates + X_PR]
}
