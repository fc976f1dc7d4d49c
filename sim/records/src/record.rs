//! One record: its columns of time, inputs and channels, in SI.

use std::path::{Path, PathBuf};

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::table::Written;
use eomgen_model_spec::unit::Unit;
use eomgen_sim::cubic_spline::CubicSpline;
use eomgen_sim::inputs::HeldInputs;

use crate::columns;
use crate::description::Description;
use crate::files::beside;
use crate::refusal::Refusal;
use crate::samples::{check_input, check_times};

/// A record in SI.
#[derive(Clone, Debug)]
pub struct Record {
    /// `train[0]`, `test[1]`, ...
    pub name: String,
    /// Its file.
    pub path: PathBuf,
    /// The times of the samples, s.
    pub times: Vec<f64>,
    /// The model's inputs, held from sample to sample.
    pub inputs: HeldInputs,
    /// The inputs as columns, NaN where a sample is missing.
    pub input_columns: Vec<Vec<f64>>,
    /// One column per channel, NaN where a sample is missing.
    pub channels: Vec<Vec<f64>>,
}

/// Which columns of a record are what.
pub(crate) struct Columns<'d> {
    pub description: &'d Description,
    /// The dataset file.
    pub path: &'d Path,
    /// The time's unit.
    pub time: &'d Unit,
    /// For each input of the model its column and unit, if there is one.
    pub inputs: &'d [Option<(&'d Written, Unit)>],
    /// The unit of each channel's column.
    pub channels: &'d [Unit],
    pub model: &'d Model,
    /// The fewest samples of a record.
    pub fewest: usize,
}

impl Columns<'_> {
    /// Reads one record.
    pub fn record(&self, name: &str, file: &Written) -> Result<Record, Refusal> {
        let wrong =
            |diagnostic: Diagnostic| Diagnostics::one(self.description.source.clone(), diagnostic);
        let place = beside(self.path, file).map_err(wrong)?;
        let mut wanted = vec![self.description.time.column.text.as_str()];
        let mut units = vec![self.time];
        for (column, unit) in self.inputs.iter().flatten() {
            wanted.push(&column.text);
            units.push(unit);
        }
        let first_channel = wanted.len();
        for (channel, unit) in self.description.channels.iter().zip(self.channels) {
            wanted.push(&channel.column.column.text);
            units.push(unit);
        }
        let mut columns = columns::read(&place, &wanted)?;
        for (column, unit) in columns.iter_mut().zip(&units) {
            for value in column.iter_mut() {
                // What is too large for a number in SI is as good as missing.
                *value = Some(unit.to_si(*value))
                    .filter(|v| v.is_finite())
                    .unwrap_or(f64::NAN);
            }
        }
        let channels = columns.split_off(first_channel);
        let mut columns = columns.into_iter();
        let times = columns.next().unwrap_or_default();
        let input_columns: Vec<Vec<f64>> = (self.inputs.iter())
            .map(|fed| fed.as_ref().and_then(|_| columns.next()))
            .map(|column| column.unwrap_or_else(|| vec![0.0; times.len()]))
            .collect();
        check_times(&place, &times, self.fewest)?;
        for (input, column) in self.model.inputs.iter().zip(&input_columns) {
            check_input(&place, &input.name, column)?;
        }
        Ok(Record {
            name: name.to_owned(),
            inputs: self.driving(&times, &input_columns),
            path: place,
            times,
            input_columns,
            channels,
        })
    }

    /// Inputs held from sample to sample, prescribed motion on a spline through its samples.
    fn driving(&self, times: &[f64], columns: &[Vec<f64>]) -> HeldInputs {
        let mut inputs = held(times, columns);
        let places = self.model.inputs.iter().zip(self.inputs).enumerate();
        for (place, (input, column)) in places {
            if input.rate.is_none() || input.rate_of.is_some() || column.is_none() {
                continue;
            }
            let samples = times.iter().zip(&columns[place]);
            let known = samples.filter(|(_, value)| value.is_finite());
            let (times, values) = known.map(|(t, value)| (*t, *value)).unzip();
            if let Some(spline) = CubicSpline::through(times, values) {
                inputs = inputs.with_prescribed(place, spline);
            }
        }
        inputs
    }
}

/// Inputs held from sample to sample, over missing ones too.
fn held(times: &[f64], columns: &[Vec<f64>]) -> HeldInputs {
    let mut last = vec![0.0; columns.len()];
    let mut values = Vec::with_capacity(times.len() * columns.len());
    for sample in 0..times.len() {
        for (slot, column) in last.iter_mut().zip(columns) {
            if column[sample].is_finite() {
                *slot = column[sample];
            }
        }
        values.extend_from_slice(&last);
    }
    HeldInputs::new(times.to_vec(), values, columns.len())
        .unwrap_or_else(|| HeldInputs::zero(columns.len()))
}
