//! Statistics of random samples of a sweep: distributions and rank correlations with parameters.

use eomgen_analysis::statistics::{Summary, rank_correlation};
use eomgen_plot::Reference;
use eomgen_plot::distribution::{Distribution, distribution};
use eomgen_sweep::{Column, Job, Samples, Table};
use serde_json::{Map, Value, json};

use crate::count::count;
use crate::document::SCHEMA;
use crate::error::warn;
use crate::figures::DisplayUnit;

/// Probabilities of the quantiles.
const PROBABILITIES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];

/// Statistics of a sweep over random samples.
pub struct Statistics {
    model: String,
    samples: Samples,
    measured: Vec<ColumnStatistics>,
}

/// Statistics of a column.
struct ColumnStatistics {
    column: Column,
    /// Title of the figure; `None` if the column has no figure.
    drawn: Option<String>,
    /// Distribution of the values; `None` if no sample has a number.
    summary: Option<Summary>,
    /// Rank correlation with each parameter.
    correlations: Vec<Option<f64>>,
}

/// Returns the statistics of a sweep over random samples; `None` for other sweeps.
pub fn statistics(job: &Job, table: &Table) -> Option<Statistics> {
    let samples = job.points().samples()?;
    let mut measured = Vec::new();
    for measure in &job.plan().measures {
        for column in &measure.columns {
            let values = table.column(&column.name).unwrap_or_default();
            let parameters = samples
                .names()
                .map(|name| table.column(name).unwrap_or_default());
            let is_drawn = measure.drawn.first() == Some(&column.name);
            measured.push(ColumnStatistics {
                column: column.clone(),
                drawn: is_drawn.then(|| measure.quantity.clone()),
                summary: Summary::from_values(values),
                correlations: parameters.map(|of| rank_correlation(of, values)).collect(),
            });
        }
    }
    Some(Statistics {
        model: job.plan().model.clone(),
        samples: samples.clone(),
        measured,
    })
}

impl Statistics {
    pub fn json(&self) -> Value {
        let of = |measured: &ColumnStatistics| {
            let mut entry = json!({
                "unit": measured.column.unit,
                "description": measured.column.about,
                "count": measured.summary.as_ref().map_or(0, |summary| summary.count),
            });
            if let Some(summary) = &measured.summary {
                let quantiles =
                    PROBABILITIES.map(|part| (part.to_string(), json!(summary.quantile(part))));
                entry["mean"] = json!(summary.mean);
                entry["sd"] = json!(summary.sd);
                entry["standard_error"] = json!(summary.standard_error);
                entry["min"] = json!(summary.quantile(0.0));
                entry["max"] = json!(summary.quantile(1.0));
                entry["quantiles"] = Value::Object(quantiles.into_iter().collect());
                let pairs = self.samples.names().zip(&measured.correlations);
                let pairs = pairs.map(|(name, found)| (name.to_owned(), json!(found)));
                entry["rank_correlations"] = Value::Object(pairs.collect());
            }
            (measured.column.name.clone(), entry)
        };
        let measured: Map<String, Value> = self.measured.iter().map(of).collect();
        json!({
            "schema": SCHEMA,
            "model": self.model,
            "samples": self.samples.count,
            "seed": self.samples.seed,
            "parameters": self.samples.parameters,
            "measured": measured,
        })
    }

    /// Returns one line for each column that has a figure.
    pub fn text(&self) -> String {
        let drawn = self
            .measured
            .iter()
            .filter(|measured| measured.drawn.is_some());
        drawn.map(|measured| self.line(measured)).collect()
    }

    fn line(&self, measured: &ColumnStatistics) -> String {
        let Column { name, unit, .. } = &measured.column;
        let Some(summary) = &measured.summary else {
            return format!("{name}: no sample has a number\n");
        };
        let unit = if unit == "1" {
            String::new()
        } else {
            format!(" {unit}")
        };
        let error = summary.standard_error.unwrap_or(f64::NAN);
        let sd = summary.sd.unwrap_or(f64::NAN);
        let [low, middle, high] = [0.05, 0.5, 0.95].map(|part| summary.quantile(part));
        let pairs = self.samples.names().zip(&measured.correlations);
        let mut pairs: Vec<(&str, f64)> = pairs.filter_map(|(n, c)| Some((n, (*c)?))).collect();
        pairs.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let ranks: Vec<String> = pairs
            .iter()
            .map(|(name, c)| format!("{name} {c:.2}"))
            .collect();
        format!(
            "{name}: mean {:.6e} +- {error:.1e}{unit}, standard deviation {sd:.3e}, median {middle:.4e}, 5 % to 95 % \
             {low:.4e} to {high:.4e}\n  rank correlations: {}\n",
            summary.mean,
            ranks.join(", ")
        )
    }

    /// Returns file names and histograms. A histogram that cannot be drawn is skipped with a warning.
    pub fn figures(&self) -> Vec<(String, String)> {
        let mut figures = Vec::new();
        for measured in &self.measured {
            match self.figure(measured) {
                Some(Ok(figure)) => figures.push(figure),
                Some(Err(error)) => warn(&format!(
                    "warning: the figure of {} cannot be drawn: {error}",
                    measured.column.name
                )),
                None => {}
            }
        }
        figures
    }

    fn figure(
        &self,
        measured: &ColumnStatistics,
    ) -> Option<Result<(String, String), eomgen_plot::PlotError>> {
        let (quantity, summary) = (measured.drawn.as_ref()?, measured.summary.as_ref()?);
        let shown = DisplayUnit::new(&measured.column);
        let sorted: Vec<f64> = summary
            .sorted
            .iter()
            .map(|value| shown.si(*value))
            .collect();
        let mut marks: Vec<Reference> = [("5 %", 0.05), ("median", 0.5), ("95 %", 0.95)]
            .map(|(label, part)| Reference {
                label: label.to_owned(),
                value: shown.si(summary.quantile(part)),
            })
            .into();
        marks.push(Reference {
            label: "mean".to_owned(),
            value: shown.si(summary.mean),
        });
        marks.sort_by(|a, b| a.value.total_cmp(&b.value));
        let svg = distribution(&Distribution {
            title: format!(
                "{}: {}, {}",
                self.model,
                measured.column.about,
                count(summary.count, "sample")
            ),
            quantity: quantity.clone(),
            unit: shown.unit,
            sorted: &sorted,
            marks,
        });
        let file = format!("samples_{}.svg", measured.column.name.replace(':', "_"));
        Some(svg.map(|svg| (file, svg)))
    }
}
