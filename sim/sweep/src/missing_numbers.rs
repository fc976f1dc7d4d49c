//! Messages about points of a sweep at which a measure has no number.

use eomgen_model_spec::argument::Argument;

use crate::job::Job;
use crate::measure::{Description, Failure};
use crate::merge::Table;
use crate::poincare::crossings_column;

/// Maximum number of points that a message lists.
const MAX_LISTED_POINTS: usize = 5;

/// Maximum number of parameters in the description of a point.
const MAX_LISTED_PARAMETERS: usize = 3;

/// Messages about points of a sweep without numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MissingNumbers {
    /// One message for each measure and each reason.
    pub messages: Vec<String>,
    /// True if no measure has a number at any point, because sections have too few crossings.
    pub is_without_crossings: bool,
}

impl MissingNumbers {
    /// Finds the points without numbers in a merged sweep.
    pub fn find(job: &Job, table: &Table) -> Self {
        let measures = &job.plan().measures;
        let statuses = |measure: &Description| {
            let name = format!("{}_status", measure.name);
            table.column(&name).unwrap_or_default().to_vec()
        };
        let few = f64::from(Failure::FewCrossings(0).code());
        let is_without_crossings = measures
            .iter()
            .all(|measure| statuses(measure).iter().all(|status| *status == few));
        let mut messages = Vec::new();
        for measure in measures {
            let statuses = statuses(measure);
            for (code, reason) in Failure::CODES.into_iter().filter(|(code, _)| *code != 0) {
                let all = 0..statuses.len();
                let points = all.filter(|point| statuses[*point] == f64::from(code));
                let points: Vec<usize> = points.collect();
                if !points.is_empty() {
                    let found = MissingPoints {
                        job,
                        table,
                        measure,
                        points: &points,
                    };
                    messages.push(found.message(code, reason));
                }
            }
        }
        Self {
            messages,
            is_without_crossings,
        }
    }
}

/// Points at which a measure has no number for one reason.
struct MissingPoints<'a> {
    job: &'a Job,
    table: &'a Table,
    measure: &'a Description,
    points: &'a [usize],
}

impl MissingPoints<'_> {
    fn message(&self, code: u8, reason: &str) -> String {
        let (count, all) = (self.points.len(), self.job.points().count());
        let is_section = code == Failure::FewCrossings(0).code();
        let listed = self.points.iter().take(MAX_LISTED_POINTS);
        let mut listed: Vec<String> = listed
            .map(|point| match is_section {
                true => format!(
                    "{} of {} at {}",
                    self.crossing_count(*point),
                    self.required_crossings(),
                    self.name(*point)
                ),
                false => self.name(*point),
            })
            .collect();
        if count > MAX_LISTED_POINTS {
            listed.push("...".to_owned());
        }
        let listed = listed.join("; ");
        let measure = &self.measure.name;
        let verb = if count == 1 { "has" } else { "have" };
        let message = format!(
            "{measure}: {count} of {all} points {verb} no number, because {reason}: {listed}"
        );
        match is_section {
            false => message,
            true => format!(
                "{message}. Give a later end ({}), fewer crossings ({}, {}), or another section ({})",
                Argument::Until,
                Argument::Transient,
                Argument::Periods,
                Argument::Section
            ),
        }
    }

    /// Returns the number of crossings at a point.
    fn crossing_count(&self, point: usize) -> f64 {
        let column = self.table.column(&crossings_column(&self.measure.name));
        let count = column.and_then(|column| column.get(point));
        count.copied().unwrap_or(f64::NAN)
    }

    /// Returns the number of crossings that the measure requires.
    fn required_crossings(&self) -> usize {
        let option = |name: &str| self.measure.options.get(name)?.parse::<usize>().ok();
        ["transient", "periods"]
            .into_iter()
            .filter_map(option)
            .sum()
    }

    /// Describes a point by its parameters, in declared units.
    fn name(&self, point: usize) -> String {
        let parameters = self.job.plan().parameters.iter();
        let values = parameters.map(|parameter| {
            let column = self.table.column(&parameter.name);
            let value = column.and_then(|column| column.get(point)).copied();
            format!(
                "{} = {}",
                parameter.name,
                round_to_six_digits(value.unwrap_or(f64::NAN))
            )
        });
        let mut values: Vec<String> = values.collect();
        if values.len() > MAX_LISTED_PARAMETERS {
            values.truncate(MAX_LISTED_PARAMETERS);
            values.push("...".to_owned());
        }
        values.join(", ")
    }
}

fn round_to_six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::super::job::tests::job;
    use super::*;

    fn table(statuses: &[f64]) -> Table {
        let count = statuses.len();
        Table {
            names: ["x", "m_value", "m_status"].map(str::to_owned).to_vec(),
            columns: vec![
                (0..count).map(|point| point as f64 / 3.0).collect(),
                vec![f64::NAN; count],
                statuses.to_vec(),
            ],
        }
    }

    #[test]
    fn messages_name_measure_reason_and_points() {
        let found = MissingNumbers::find(&job(4), &table(&[0.0, 2.0, 0.0, 5.0]));
        assert_eq!(found.messages.len(), 2);
        let [first, second] = [&found.messages[0], &found.messages[1]];
        assert!(
            first.starts_with("m: 1 of 4 points has no number, because rates"),
            "{first}"
        );
        assert!(first.ends_with(": x = 0.333333"), "{first}");
        assert!(second.ends_with("for this motion: x = 1"), "{second}");
        assert!(!found.is_without_crossings);
    }

    #[test]
    fn only_missing_crossings_everywhere_leave_no_result() {
        for (statuses, is_without) in [
            ([6.0, 6.0, 6.0], true),
            ([6.0, 0.0, 6.0], false),
            ([6.0, 5.0, 6.0], false),
            ([2.0, 2.0, 2.0], false),
            ([0.0, 0.0, 0.0], false),
        ] {
            let found = MissingNumbers::find(&job(3), &table(&statuses));
            assert_eq!(found.is_without_crossings, is_without, "{statuses:?}");
        }
        let many = MissingNumbers::find(&job(9), &table(&[2.0; 9]));
        assert!(
            many.messages[0].ends_with("x = 1.33333; ..."),
            "{:?}",
            many.messages
        );
    }
}
