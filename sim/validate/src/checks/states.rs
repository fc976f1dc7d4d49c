//! Comparison with the oracle at random states in every regime: accelerations, mass matrix, energy,
//! power and guards. Accelerations are also compared with hand-written references.

use super::super::certificate::{Check, Coverage, Worst};
use super::super::oracle::{Conditioned, Equations, Oracle, OracleError};
use super::super::sampler::{Regime, Sample, SampledState, Sampler};
use super::super::variant::Variant;
use super::{
    MASS_TOLERANCE, ROW_TOLERANCE, SYMMETRY_TOLERANCE, mass_matrix, matrix_distance, unknowns,
};
use nalgebra::{Cholesky, DMatrix};
use std::collections::HashMap;

const STATES_PER_REGIME: usize = 200;
const STATES: usize = 81 * STATES_PER_REGIME;
/// Minimum number of states for a regime to count as sampled.
const MIN_STATES_PER_REGIME: usize = 20;
/// Number of failed draws after which the search in a regime ends.
const MAX_FAILED_DRAWS: usize = 5;
const SEED: u64 = 0x0dd5_eed5;

/// Hand-written equations to compare accelerations with.
pub struct Reference {
    /// Name of the check in the certificate.
    pub name: String,
    /// Function of (time, state, inputs, accelerations) that returns the deviation relative to each row's largest term.
    #[expect(clippy::type_complexity, reason = "a plain function of four arguments")]
    pub deviation: Box<dyn Fn(f64, &[f64], &[f64], &[f64]) -> f64>,
}

struct Findings<'f> {
    oracle: &'f Oracle,
    references: &'f [Reference],
    checks: Vec<Check>,
    dense: Worst,
    mass: Worst,
    symmetry: Worst,
    definite: Worst,
    energy: Worst,
    power: Worst,
    by_reference: Vec<Worst>,
    guards: Guards,
    /// True if no energy depends explicitly on time.
    scleronomic: bool,
    compared_states: usize,
    /// Number of regimes with enough states.
    sampled_regimes: u64,
    per_regime: usize,
}

/// Runs all checks at random states and returns them with the coverage of regimes.
pub fn check(
    oracle: &Oracle,
    variant: &mut dyn Variant,
    references: &[Reference],
) -> Result<(Vec<Check>, Coverage), OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    let regimes = sampler.visit_regimes()?;
    let mut findings = Findings {
        oracle,
        references,
        checks: vec![check_names(oracle, variant)],
        dense: Worst::default(),
        mass: Worst::default(),
        symmetry: Worst::default(),
        definite: Worst::default(),
        energy: Worst::default(),
        power: Worst::default(),
        by_reference: vec![Worst::default(); references.len()],
        guards: Guards::default(),
        scleronomic: is_scleronomic(oracle)?,
        compared_states: 0,
        sampled_regimes: 0,
        per_regime: (STATES / regimes.visited.len().max(1))
            .clamp(MIN_STATES_PER_REGIME, STATES_PER_REGIME),
    };
    for regime in &regimes.visited {
        findings.compare_in_regime(&mut sampler, Some(regime), variant)?;
    }
    let coverage = Coverage {
        regimes: regimes.combinations.saturating_sub(regimes.unreachable),
        sampled: findings.sampled_regimes,
        unreachable: regimes.unreachable,
    };
    if findings.compared_states == 0 && !oracle.switches().is_empty() {
        findings.compare_in_regime(&mut sampler, None, variant)?;
    }
    if findings.compared_states == 0 {
        let redrawn = sampler.redrawn_count();
        let message = format!(
            "no state in the model's domain was found: at {redrawn} sampled states a term is NaN or the mass \
             matrix is not positive definite; give coordinates, states and inputs a `range`"
        );
        let worst = Worst::from_deviation(f64::INFINITY, message);
        findings
            .checks
            .push(Check::from_deviation("domain", worst, ROW_TOLERANCE));
    }
    if !oracle.switches().is_empty() {
        findings.checks.push(check_coverage(&coverage));
    }
    Ok((findings.into_checks(), coverage))
}

fn check_coverage(coverage: &Coverage) -> Check {
    const NAME: &str = "coverage";
    if coverage.sampled >= coverage.regimes {
        return Check::from_deviation(NAME, Worst::from_deviation(0.0, coverage.sentence()), 0.0);
    }
    let reason = format!(
        "{}; give coordinates, states and inputs a `range` that includes or excludes the other regimes",
        coverage.sentence()
    );
    Check::not_run(NAME, 0.0, reason)
}

/// Returns true if T + V does not depend explicitly on time at several states.
fn is_scleronomic(oracle: &Oracle) -> Result<bool, OracleError> {
    let mut sampler = Sampler::new(oracle, SEED)?;
    for _ in 0..MIN_STATES_PER_REGIME {
        let Some(drawn) = sampler.draw_inside()? else {
            break;
        };
        let Sample {
            time,
            state,
            inputs,
        } = &drawn.sample;
        if !oracle.is_scleronomic(*time, state, inputs)? {
            return Ok(false);
        }
    }
    Ok(true)
}

fn check_names(oracle: &Oracle, variant: &dyn Variant) -> Check {
    let found = variant.coordinate_names();
    let same = found == oracle.names();
    let detail = if same {
        match found.len() {
            1 => "1 coordinate".to_owned(),
            count => format!("{count} coordinates"),
        }
    } else {
        format!("found {found:?}, expected {:?}", oracle.names())
    };
    let worst = Worst::from_deviation(if same { 0.0 } else { 1.0 }, detail);
    Check::from_deviation("coordinate_names", worst, 0.0)
}

impl Findings<'_> {
    /// Compares at states of one regime, or of any regime if `regime` is `None`.
    fn compare_in_regime(
        &mut self,
        sampler: &mut Sampler<'_>,
        regime: Option<&Regime>,
        variant: &mut dyn Variant,
    ) -> Result<(), OracleError> {
        let oracle = self.oracle;
        let label = regime.map_or_else(|| "in any regime".into(), |r| r.label(oracle));
        let name = if label.is_empty() {
            "accelerations".to_owned()
        } else {
            format!("accelerations {label}")
        };
        let mut worst = Worst::default();
        let (mut examined, mut fruitless) = (0, 0);
        let before = sampler.redrawn_count();
        for count in 1..=self.per_regime {
            let drawn = match regime {
                Some(regime) => sampler.draw_in(regime)?,
                None => sampler.draw_inside()?,
            };
            let Some(drawn) = drawn else {
                fruitless += 1;
                if examined == 0 || fruitless == MAX_FAILED_DRAWS {
                    break;
                }
                continue;
            };
            let place = format!("state {count} of {label}");
            let place = place.trim_end_matches(" of ");
            examined += 1;
            self.guards.record(oracle, variant, &drawn)?;
            match self.compare(variant, &drawn, place)? {
                Ok(deviation) => worst.include(Worst::from_deviation(deviation, place)),
                Err(message) => worst.include(Worst::from_deviation(f64::INFINITY, message)),
            }
        }
        self.compared_states += examined;
        self.sampled_regimes += u64::from(regime.is_some() && examined >= MIN_STATES_PER_REGIME);
        let redrawn = sampler.redrawn_count() - before;
        self.checks.push(match (examined, redrawn) {
            (0, 0) => Check::not_run(name, ROW_TOLERANCE, "no state was found in this regime"),
            (0, _) => {
                let reason = "no state in this regime was in the model's domain";
                Check::not_run(name, ROW_TOLERANCE, reason)
            }
            (1..MIN_STATES_PER_REGIME, _) if worst.value() <= ROW_TOLERANCE => {
                let reason = format!(
                    "only {examined} of at least {MIN_STATES_PER_REGIME} states were found in this regime"
                );
                Check::not_run(name, ROW_TOLERANCE, reason)
            }
            (_, 0) => Check::from_deviation(name, worst.with_count(examined, "states"), ROW_TOLERANCE),
            _ => {
                let what = format!("states ({redrawn} were outside the model's domain and were drawn again)");
                Check::from_deviation(name, worst.with_count(examined, &what), ROW_TOLERANCE)
            }
        });
        Ok(())
    }

    fn compare(
        &mut self,
        variant: &mut dyn Variant,
        SampledState { sample, equations }: &SampledState,
        place: &str,
    ) -> Result<Result<f64, String>, OracleError> {
        let Sample {
            time,
            state,
            inputs,
        } = sample;
        let energy = self.oracle.energy(*time, state, inputs)?;
        Ok((|| {
            let mass = mass_matrix(variant, *time, state, inputs)?;
            self.compare_mass(&mass, equations, place);
            let found = variant.energy(*time, state, inputs)?;
            self.energy
                .include(Worst::from_deviation(energy.deviation(found), place));
            let power = variant.power(*time, state, inputs)?;
            let found = unknowns(variant, *time, state, inputs)?;
            let expected = self
                .power(sample, &found[..equations.size()])
                .map_err(|e| e.to_string())?;
            self.power
                .include(Worst::from_deviation(expected.deviation(power), place));
            self.compare_accelerations(&found, equations, sample, place);
            Ok(equations.worst_residual(&found))
        })())
    }

    /// Returns the expected rate of T + V: the power of the forces or, if an energy depends
    /// explicitly on time, the rate along the motion with these accelerations.
    fn power(&self, sample: &Sample, accelerations: &[f64]) -> Result<Conditioned, OracleError> {
        let Sample {
            time,
            state,
            inputs,
        } = sample;
        if self.scleronomic && self.oracle.is_scleronomic(*time, state, inputs)? {
            return self.oracle.power(*time, state, inputs);
        }
        self.oracle.energy_rate(*time, state, accelerations, inputs)
    }

    fn compare_mass(&mut self, mass: &DMatrix<f64>, equations: &Equations, place: &str) {
        let distance = |other| matrix_distance(mass, other, equations);
        self.mass
            .include(Worst::from_deviation(distance(&equations.mass), place));
        self.symmetry
            .include(Worst::from_deviation(distance(&mass.transpose()), place));
        let definite = Cholesky::new(scale_to_unit_diagonal(mass)).is_some();
        self.definite.include(Worst::from_deviation(
            if definite { 0.0 } else { 1.0 },
            place,
        ));
    }

    fn compare_accelerations(
        &mut self,
        found: &[f64],
        equations: &Equations,
        sample: &Sample,
        place: &str,
    ) {
        let distance = equations
            .unknowns()
            .map_or(f64::INFINITY, |dense| equations.distance(&dense, found));
        self.dense.include(Worst::from_deviation(distance, place));
        for (reference, worst) in self.references.iter().zip(&mut self.by_reference) {
            let deviation =
                (reference.deviation)(sample.time, &sample.state, &sample.inputs, found);
            worst.include(Worst::from_deviation(deviation, place));
        }
    }

    fn into_checks(self) -> Vec<Check> {
        let mut checks = self.checks;
        checks.extend([
            Check::from_deviation("dense_solve", self.dense, ROW_TOLERANCE),
            Check::from_deviation("mass_matrix", self.mass, MASS_TOLERANCE),
            Check::from_deviation("mass_matrix_symmetric", self.symmetry, SYMMETRY_TOLERANCE),
            Check::from_deviation("mass_matrix_positive_definite", self.definite, 0.0),
            Check::from_deviation("energy", self.energy, ROW_TOLERANCE),
            Check::from_deviation("power", self.power, ROW_TOLERANCE),
            self.guards.into_check(self.oracle),
        ]);
        for (reference, worst) in self.references.iter().zip(self.by_reference) {
            let name = format!("reference {}", reference.name);
            checks.push(Check::from_deviation(name, worst, ROW_TOLERANCE));
        }
        checks
    }
}

/// Scales rows and columns to a unit diagonal, so that the result does not depend on units.
fn scale_to_unit_diagonal(mass: &DMatrix<f64>) -> DMatrix<f64> {
    let scale = mass.diagonal().map(|entry| entry.sqrt().recip());
    DMatrix::from_fn(mass.nrows(), mass.ncols(), |row, column| {
        scale[row] * mass[(row, column)] * scale[column]
    })
}

/// Signs of the guards in each regime. Two regimes with different equations must differ in at least one sign. A switch
/// without influence on the equations needs no guard.
#[derive(Default)]
struct Guards {
    regimes: HashMap<Vec<bool>, Regime>,
    worst: Worst,
}

impl Guards {
    fn record(
        &mut self,
        oracle: &Oracle,
        variant: &mut dyn Variant,
        drawn: &SampledState,
    ) -> Result<(), OracleError> {
        let sample = &drawn.sample;
        let regime = Regime::from_state(oracle, sample)?;
        let values = match variant.guards(sample.time, &sample.state, &sample.inputs) {
            Ok(values) => values,
            Err(message) => {
                self.worst
                    .include(Worst::from_deviation(f64::INFINITY, message));
                return Ok(());
            }
        };
        let signs = values.iter().map(|value| *value > 0.0).collect();
        let known = self.regimes.entry(signs).or_insert_with(|| regime.clone());
        let told = *known == regime || is_same_regime(oracle, drawn, known)?;
        self.worst.include(if told {
            Worst::from_deviation(0.0, "the signs of the guards identify the regime")
        } else {
            let (known, label) = (known.label(oracle), regime.label(oracle));
            Worst::from_deviation(
                1.0,
                format!("the guards have the same signs in {known} and {label}"),
            )
        });
        Ok(())
    }

    fn into_check(self, oracle: &Oracle) -> Check {
        if oracle.switches().is_empty() {
            return Check::not_applicable("guards", 0.0, "the model has no piecewise function");
        }
        Check::from_deviation("guards", self.worst, 0.0)
    }
}

fn is_same_regime(
    oracle: &Oracle,
    drawn: &SampledState,
    regime: &Regime,
) -> Result<bool, OracleError> {
    let SampledState { sample, equations } = drawn;
    let (state, inputs) = (&sample.state, &sample.inputs);
    let other = oracle.equations_on(&regime.sides, sample.time, state, inputs)?;
    let Some(unknowns) = equations.unknowns() else {
        return Ok(false);
    };
    let mass = matrix_distance(&equations.mass, &other.mass, equations);
    let rows = other.worst_residual(&unknowns);
    Ok(mass <= MASS_TOLERANCE && rows <= ROW_TOLERANCE)
}
