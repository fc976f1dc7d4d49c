//! A sweep as data: everything its numbers depend on, with a hash that names it.

use std::ops::Range;

use eomgen_model_spec::source::Source;
use serde::{Deserialize, Serialize};

use super::error::SweepError;
use super::grid::{Axis, Grid};
use super::measure::{Column, Description, Failure};
use super::points::Points;
use super::samples::Samples;

/// The form of plans, parts and their cutting into chunks.
const SCHEMA: u32 = 1;

/// The most chunks a job is cut into: few enough for a folder, many enough for little to be
/// lost with one.
const MOST_CHUNKS: usize = 1000;

/// Everything that the numbers of a sweep depend on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The form of this description.
    pub schema: u32,
    /// The program's version.
    pub version: String,
    /// The model's name.
    pub model: String,
    /// SHA-256 of the specification's text.
    pub specification: String,
    /// The orders of the model's fields.
    pub orders: Vec<usize>,
    /// Parameters set to other values than the specification's, in declared units.
    pub set: Vec<(String, f64)>,
    /// What is varied, the last fastest; nothing where there are samples.
    pub vary: Vec<Axis>,
    /// Random samples in place of a grid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<Samples>,
    /// The varied parameters as columns, with the units that the specification declares.
    pub parameters: Vec<Column>,
    /// What is measured.
    pub measures: Vec<Description>,
    /// What the numbers in the status columns mean.
    pub statuses: Vec<(u8, String)>,
}

impl Plan {
    /// A plan of this version of the program; `specification` is the hash of all that the model
    /// was read from, [`Model::hash`](eomgen_model_spec::model::Model::hash).
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
            parameters,
            measures,
            statuses: Failure::CODES
                .map(|(code, meaning)| (code, meaning.to_owned()))
                .to_vec(),
        }
    }

    /// What of two plans is not the same, in words of the command line.
    pub fn differences(&self, other: &Self) -> Vec<&'static str> {
        let same = [
            (
                "the program's version",
                (self.schema, &self.version) == (other.schema, &other.version),
            ),
            (
                "the specification",
                self.specification == other.specification,
            ),
            ("--order", self.orders == other.orders),
            ("--set", self.set == other.set),
            ("--vary", self.vary == other.vary),
            ("--samples or --seed", self.samples == other.samples),
            ("--measure or its options", self.measures == other.measures),
        ];
        let different = same.iter().filter(|(_, same)| !same);
        different.map(|(what, _)| *what).collect()
    }
}

/// A plan that makes sense, cut into chunks of consecutive points.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    plan: Plan,
    points: Points,
    hash: String,
}

impl Job {
    /// Takes a plan.
    ///
    /// # Errors
    /// Axes that span no grid, two columns of one name, nothing to measure, or a form that
    /// this version does not know.
    pub fn new(plan: Plan) -> Result<Self, SweepError> {
        let refused = |reason: String| Err(SweepError::Request(reason));
        if plan.schema != SCHEMA {
            return refused(format!("schema {}, where {SCHEMA} is known", plan.schema));
        }
        if plan.measures.is_empty() {
            return refused("nothing is measured".to_owned());
        }
        let points = match &plan.samples {
            None => Points::Grid(Grid::new(plan.vary.clone())?),
            Some(_) if !plan.vary.is_empty() => {
                return refused("either a grid is measured or samples are".to_owned());
            }
            Some(samples) => {
                samples.check()?;
                Points::Samples(samples.clone())
            }
        };
        let columns = plan.parameters.iter().map(|column| column.name.as_str());
        if !columns.eq(points.names()) {
            return refused("what is varied and the columns for it do not agree".to_owned());
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
                    "two columns would be called `{}`; name each measure once",
                    column.name
                ));
            }
        }
        Ok(job)
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Where the parameters are set to.
    pub fn points(&self) -> &Points {
        &self.points
    }

    /// SHA-256 of the plan's compact JSON, 64 hexadecimal digits.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// The columns of the result: varied parameters, then each measure's columns and its
    /// status.
    pub fn columns(&self) -> Vec<Column> {
        let mut columns = self.plan.parameters.clone();
        for measure in &self.plan.measures {
            columns.extend(measure.columns.iter().cloned());
            columns.push(Column::new(
                format!("{}_status", measure.name),
                "1",
                "0, or why nothing was measured: see `statuses`",
            ));
        }
        columns
    }

    /// How many numbers are measured at a point, statuses included.
    pub fn measured(&self) -> usize {
        let measures = self.plan.measures.iter();
        measures.map(|measure| measure.columns.len() + 1).sum()
    }

    /// How many chunks there are.
    pub fn chunks(&self) -> usize {
        self.points.count().div_ceil(self.chunk_points())
    }

    /// The points of a chunk.
    pub fn chunk(&self, chunk: usize) -> Range<usize> {
        let (size, points) = (self.chunk_points(), self.points.count());
        (chunk * size).min(points)..((chunk + 1) * size).min(points)
    }

    fn chunk_points(&self) -> usize {
        self.points.count().div_ceil(MOST_CHUNKS)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// A job over `x` from 0 to 1 that measures `m_value`.
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
            assert!(job.chunks() <= MOST_CHUNKS);
            let mut next = 0;
            for chunk in 0..job.chunks() {
                let points = job.chunk(chunk);
                assert_eq!(points.start, next);
                assert!(!points.is_empty());
                next = points.end;
            }
            assert_eq!(next, count);
        }
    }

    #[test]
    fn whatever_the_numbers_depend_on_changes_the_hash() {
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
    fn a_plan_is_read_back_exactly() {
        let mut plan = job(5).plan;
        // Of random bits, so that a reader which misses the last one now and then is caught.
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
    fn two_columns_of_one_name_are_refused() {
        let mut plan = job(5).plan;
        plan.measures.push(plan.measures[0].clone());
        let error = Job::new(plan).expect_err("m twice").to_string();
        assert!(error.contains("`m_value`"), "{error}");
    }
}
