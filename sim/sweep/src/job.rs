//! Sweep as data: everything that determines its numbers, with an identifying hash.

use eomgen_model_spec::argument::Argument;
use std::ops::Range;

use eomgen_model_spec::source::Source;
use serde::{Deserialize, Serialize};

use super::error::SweepError;
use super::grid::{Axis, Grid};
use super::measure::{Column, Description, Failure};
use super::points::Points;
use super::samples::Samples;

/// Version of plans, parts and the division into chunks.
const SCHEMA: u32 = 1;

/// Maximum number of chunks. The files are few enough for one folder, and an interruption loses little.
const MAX_CHUNKS: usize = 1000;

/// Everything that determines the numbers of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Version of the plan format.
    pub schema: u32,
    /// Version of the program.
    pub version: String,
    /// Name of the model.
    pub model: String,
    /// SHA-256 of the specification's text.
    pub specification: String,
    /// Orders of the model's fields.
    pub orders: Vec<usize>,
    /// Parameters whose values differ from the specification, in declared units.
    pub set: Vec<(String, f64)>,
    /// Varied axes, the last one fastest; empty if samples are used.
    pub vary: Vec<Axis>,
    /// Random samples; `None` for a grid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<Samples>,
    /// Inputs and initial state, if they differ from those of the specification.
    #[serde(flatten)]
    pub conditions: PlannedConditions,
    /// Columns of the varied parameters, with declared units.
    pub parameters: Vec<Column>,
    /// Descriptions of the measures.
    pub measures: Vec<Description>,
    /// Meaning of the numbers in the status columns.
    pub statuses: Vec<(u8, String)>,
}

/// Inputs and initial state of a sweep, as requested.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlannedConditions {
    /// Inputs given by expressions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<String>,
    /// Name of the record that drives the inputs, and a hash of its samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<String>,
    /// Requested initial states.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub state: Vec<String>,
}

impl Plan {
    /// Sets inputs and initial state.
    #[must_use]
    pub fn with_conditions(mut self, conditions: PlannedConditions) -> Self {
        self.conditions = conditions;
        self
    }

    /// Creates a plan of this version of the program. `specification` is
    /// [`Model::hash`](eomgen_model_spec::model::Model::hash), the hash of all files of the model.
    pub fn new(
        specification: String,
        model: &str,
        orders: &[usize],
        set: &[(&str, f64)],
        parameters: Vec<Column>,
        points: &Points,
        measures: Vec<Description>,
    ) -> Self {
        Self {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model: model.to_owned(),
            specification,
            orders: orders.to_vec(),
            set: set
                .iter()
                .map(|(name, value)| ((*name).to_owned(), *value))
                .collect(),
            vary: points.axes().to_vec(),
            samples: points.samples().cloned(),
            conditions: PlannedConditions::default(),
            parameters,
            measures,
            statuses: Failure::CODES
                .map(|(code, meaning)| (code, meaning.to_owned()))
                .to_vec(),
        }
    }

    /// Returns the command-line options in which two plans differ.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let same = [
            (
                "the program's version".to_owned(),
                (self.schema, &self.version, &self.statuses)
                    == (other.schema, &other.version, &other.statuses),
            ),
            (
                "the specification".to_owned(),
                self.specification == other.specification,
            ),
            (Argument::Order.to_string(), self.orders == other.orders),
            (Argument::Parameters.to_string(), self.set == other.set),
            (Argument::Vary.to_string(), self.vary == other.vary),
            (
                format!("{} or {}", Argument::Samples, Argument::Seed),
                self.samples == other.samples,
            ),
            (
                Argument::Inputs.to_string(),
                self.conditions.inputs == other.conditions.inputs,
            ),
            (
                Argument::Record.to_string(),
                self.conditions.record == other.conditions.record,
            ),
            (
                Argument::InitialState.to_string(),
                self.conditions.state == other.conditions.state,
            ),
            (
                format!("{} or its options", Argument::Measure),
                self.measures == other.measures,
            ),
        ];
        let different = same.into_iter().filter(|(_, same)| !same);
        different.map(|(what, _)| what).collect()
    }
}

/// Valid plan, divided into chunks of consecutive points.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    plan: Plan,
    points: Points,
    hash: String,
}

impl Job {
    /// Checks a plan and creates its job.
    ///
    /// # Errors
    /// Axes that span no grid, repeated column names, no measure, or an unknown version.
    pub fn new(plan: Plan) -> Result<Self, SweepError> {
        let refused = |reason: String| Err(SweepError::Request(reason));
        if plan.schema != SCHEMA {
            return refused(format!(
                "schema {} is unknown; expected {SCHEMA}",
                plan.schema
            ));
        }
        if plan.measures.is_empty() {
            return refused("the plan has no measure".to_owned());
        }
        let points = match &plan.samples {
            None => Points::Grid(Grid::new(plan.vary.clone())?),
            Some(_) if !plan.vary.is_empty() => {
                return refused(
                    "the plan has both a grid and samples; expected one of them".to_owned(),
                );
            }
            Some(samples) => {
                samples.check()?;
                Points::Samples(samples.clone())
            }
        };
        let columns = plan.parameters.iter().map(|column| column.name.as_str());
        if !columns.eq(points.names()) {
            return refused("the varied parameters and their columns differ".to_owned());
        }
        let text = serde_json::to_string(&plan)
            .map_err(|error| SweepError::Request(format!("the plan cannot be written: {error}")))?;
        let hash = Source::new("plan", text).hash();
        let job = Self { plan, points, hash };
        let columns = job.columns();
        for (place, column) in columns.iter().enumerate() {
            if columns[..place]
                .iter()
                .any(|other| other.name == column.name)
            {
                return refused(format!(
                    "two columns would have the name `{}`; give each measure once",
                    column.name
                ));
            }
        }
        Ok(job)
    }

    /// Returns the plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the points.
    pub fn points(&self) -> &Points {
        &self.points
    }

    /// Returns the SHA-256 of the plan's compact JSON, 64 hexadecimal digits.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Returns the columns: varied parameters, then each measure's columns and its status.
    pub fn columns(&self) -> Vec<Column> {
        let mut columns = self.plan.parameters.clone();
        for measure in &self.plan.measures {
            columns.extend(measure.columns.iter().cloned());
            columns.push(Column::new(
                format!("{}_status", measure.name),
                "1",
                "0, or the reason for a missing value: see `statuses`",
            ));
        }
        columns
    }

    /// Returns the number of measured numbers per point, statuses included.
    pub fn measured_count(&self) -> usize {
        let measures = self.plan.measures.iter();
        measures.map(|measure| measure.columns.len() + 1).sum()
    }

    /// Returns the number of chunks.
    pub fn chunk_count(&self) -> usize {
        self.points.count().div_ceil(self.chunk_points())
    }

    /// Returns the points of a chunk.
    pub fn chunk_range(&self, chunk: usize) -> Range<usize> {
        let (size, points) = (self.chunk_points(), self.points.count());
        (chunk * size).min(points)..((chunk + 1) * size).min(points)
    }

    fn chunk_points(&self) -> usize {
        self.points.count().div_ceil(MAX_CHUNKS)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Creates a job over `x` from 0 to 1 that measures `m_value`.
    pub fn job(count: usize) -> Job {
        let axis = Axis::parse(&format!("x=0:1:{count}")).expect("an axis");
        let grid = Grid::new(vec![axis]).expect("a grid");
        let description = Description {
            name: "m".to_owned(),
            about: "a measure for tests".to_owned(),
            options: BTreeMap::new(),
            columns: vec![Column::new("m_value", "1", "a number")],
            drawn: vec!["m_value".to_owned()],
            quantity: "m".to_owned(),
        };
        let plan = Plan::new(
            Source::new("a.toml", "text").hash(),
            "a",
            &[],
            &[("y", 0.1)],
            vec![Column::new("x", "m", "varied")],
            &Points::Grid(grid),
            vec![description],
        );
        Job::new(plan).expect("a job")
    }

    #[test]
    fn chunks_cover_the_grid_once() {
        for count in [2, 999, 1000, 1001, 12_345] {
            let job = job(count);
            assert!(job.chunk_count() <= MAX_CHUNKS);
            let mut next = 0;
            for chunk in 0..job.chunk_count() {
                let points = job.chunk_range(chunk);
                assert_eq!(points.start, next);
                assert!(!points.is_empty());
                next = points.end;
            }
            assert_eq!(next, count);
        }
    }

    #[test]
    fn every_dependence_changes_hash() {
        let plan = job(5).plan;
        let hash = |change: &dyn Fn(&mut Plan)| {
            let mut plan = plan.clone();
            change(&mut plan);
            Job::new(plan).expect("a job").hash
        };
        let hashes = [
            hash(&|_| {}),
            hash(&|plan| plan.version.push('1')),
            hash(&|plan| plan.specification.push('1')),
            hash(&|plan| plan.orders.push(3)),
            hash(&|plan| plan.set[0].1 = -0.1),
            hash(&|plan| plan.vary[0].to = 2.0),
            hash(&|plan| {
                let options = &mut plan.measures[0].options;
                options.insert("transient".to_owned(), "3".to_owned());
            }),
        ];
        let different: std::collections::BTreeSet<_> = hashes.iter().collect();
        assert_eq!(different.len(), hashes.len());
    }

    #[test]
    fn plan_is_read_back_exactly() {
        let mut plan = job(5).plan;
        // Random bits reveal a reader that sometimes loses the last bit.
        let mut bits = 1_u64;
        let numbers = std::iter::repeat_with(|| {
            // Knuth's linear congruential generator, MMIX.
            bits = bits
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits)
        });
        let numbers = numbers.filter(|number| number.is_finite()).take(10_000);
        plan.set = numbers
            .chain([-0.0, 5e-324])
            .map(|value| ("y".to_owned(), value))
            .collect();
        let text = serde_json::to_string_pretty(&plan).expect("text");
        let read: Plan = serde_json::from_str(&text).expect("the plan");
        let bits = |plan: &Plan| {
            plan.set
                .iter()
                .map(|(_, v)| v.to_bits())
                .collect::<Vec<_>>()
        };
        assert_eq!(bits(&read), bits(&plan));
        assert_eq!(
            Job::new(read).expect("a job").hash,
            Job::new(plan).expect("a job").hash
        );
    }

    #[test]
    fn repeated_column_names_are_rejected() {
        let mut plan = job(5).plan;
        plan.measures.push(plan.measures[0].clone());
        let error = Job::new(plan).expect_err("m twice").to_string();
        assert!(error.contains("`m_value`"), "{error}");
    }
}
