//! Record: columns of time, inputs and channels, in SI.

use std::ops::Range;
use std::path::{Path, PathBuf};

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::quantity::Number;
use eomgen_model_spec::unit::Unit;
use eomgen_sim::cubic_spline::CubicSpline;
use eomgen_sim::inputs::HeldInputs;

use crate::clock::Clock;
use crate::columns;
use crate::decimation::Decimation;
use crate::description::Description;
use crate::description::columns::Column;
use crate::description::records::Stretch;
use crate::files::resolve_record_path;
use crate::gaps::{
    Gap, describe_missing, find_contiguous_parts, find_empty_cells, find_long_empty_cells,
    find_missing_rows,
};
use crate::header::Table;
use crate::motion_rates::{GivenColumn, GivenKind, differentiate_position, integrate_speed};
use crate::outliers::find_outliers;
use crate::refusal::Refusal;
use crate::samples::{MAX_JITTER_FRACTION, check_known, check_times, typical_step};
use crate::used_part::UsedPart;
use crate::wrapped_columns::{ReadColumn, unwrap_columns};

/// Record in SI.
#[derive(Clone, Debug)]
pub struct Record {
    /// Name, for example `train[0]`.
    pub name: String,
    /// Path of its file.
    pub path: PathBuf,
    /// Times of the samples, in s, counted from the first sample of the file. If the model depends on time, these are
    /// the times of the file.
    pub times: Vec<f64>,
    /// Time in the file at which `times` is 0, in s.
    pub origin: f64,
    /// Inputs of the model, held between samples. With given motion, each row also contains all coordinates, then all
    /// rates, then all second derivatives.
    pub inputs: HeldInputs,
    /// Columns of the inputs; NaN for a missing sample.
    pub input_columns: Vec<Vec<f64>>,
    /// Columns of the channels; NaN for a missing sample.
    pub channels: Vec<Vec<f64>>,
    /// True if the record starts after a gap, so that its initial state is unknown.
    pub is_continued: bool,
}

impl Record {
    /// Returns the samples of a given coordinate; `inputs` is the number of the model's inputs.
    pub fn given_motion(&self, coordinate: usize, inputs: usize) -> Vec<f64> {
        self.column(inputs + coordinate)
    }

    /// Returns the rate of a given coordinate; `coordinates` is the number of coordinates.
    pub fn given_motion_rate(
        &self,
        coordinate: usize,
        coordinates: usize,
        inputs: usize,
    ) -> Vec<f64> {
        self.column(inputs + coordinates + coordinate)
    }

    fn column(&self, place: usize) -> Vec<f64> {
        let value = |t: &f64| self.inputs.last_sample(*t)[place];
        self.times.iter().map(value).collect()
    }
}

pub(crate) struct RecordReader<'d> {
    pub description: &'d Description,
    pub path: &'d Path,
    pub time: &'d Unit,
    pub inputs: &'d [Option<(&'d Column, Unit)>],
    pub motion: &'d [GivenColumn<'d>],
    pub channels: &'d [Unit],
    /// Noise of each channel, in SI; `None` for a quantity that may have a peak of one sample.
    pub smooth_noises: &'d [Option<f64>],
    /// Known reading of each channel at the start of a file, in SI.
    pub initial_readings: &'d [Option<f64>],
    pub model: &'d Model,
    /// True if times are counted from the first sample of a file.
    pub counts_from_first: bool,
    pub decimation: &'d Decimation,
    pub min_samples: usize,
}

impl RecordReader<'_> {
    /// Reads a record. Also returns gaps of the inputs and of the given motion in which cells have no number.
    pub fn read_record(
        &self,
        name: &str,
        stretch: &Stretch,
        notes: &mut Vec<String>,
    ) -> Result<(Record, Vec<Gap>), Refusal> {
        let wrong = |diagnostic: Diagnostic| {
            Diagnostics::from_one(self.description.source.clone(), diagnostic)
        };
        let place = resolve_record_path(self.path, &stretch.file).map_err(wrong)?;
        let (mut table, used) = self.read_table(&place, name, stretch, notes)?;
        self.add_rates(&place, name, &used, &mut table, notes)?;
        let is_continued = used.rows.start > 0;
        cut_to_rows(used.rows, &mut table);
        let mut gaps = self.find_unknown_inputs(&table);
        self.decimate(&place, &mut table)?;
        let first_motion = 1 + self.inputs.iter().flatten().count();
        let channels = (table.columns).split_off(first_motion + 3 * self.motion.len());
        let motion = table.columns.split_off(first_motion);
        let mut columns = table.columns.into_iter();
        let times = columns.next().unwrap_or_default();
        // Shorter runs of empty cells have been filled before.
        for (given, positions) in self.motion.iter().zip(&motion) {
            gaps.extend(find_empty_cells(given.name, &times, positions, 1));
        }
        let undriven = self.model.typical_inputs(0.0);
        let undriven = undriven.unwrap_or_else(|_| vec![0.0; self.inputs.len()]);
        let input_columns: Vec<Vec<f64>> = (self.inputs.iter().zip(undriven))
            .map(|(fed, value)| (fed.as_ref().and_then(|_| columns.next()), value))
            .map(|(column, value)| column.unwrap_or_else(|| vec![value; times.len()]))
            .collect();
        check_times(&place, &times, &table.lines, self.min_samples)?;
        for (input, column) in self.model.inputs.iter().zip(&input_columns) {
            check_known(&place, &format!("input `{}`", input.name), column)?;
        }
        let record = Record {
            name: name.to_owned(),
            inputs: self.build_inputs(&times, &input_columns, motion),
            path: place,
            times,
            origin: used.origin,
            input_columns,
            channels,
            is_continued,
        };
        Ok((record, gaps))
    }

    /// Returns the gaps of input columns that consist of empty cells.
    fn find_unknown_inputs(&self, table: &Table) -> Vec<Gap> {
        let fed = self.model.inputs.iter().zip(self.inputs);
        let fed = fed.filter(|(_, column)| column.is_some());
        let columns = fed.zip(&table.columns[1..]);
        columns
            .flat_map(|((input, _), column)| {
                find_long_empty_cells(&input.name, &table.columns[0], column)
            })
            .collect()
    }

    fn read_columns(&self) -> Vec<ReadColumn<'_>> {
        let fed = self.model.inputs.iter().zip(self.inputs);
        let inputs = fed.filter_map(|(input, fed)| {
            let (column, unit) = fed.as_ref()?;
            Some(ReadColumn::new("inputs", &input.name, column, unit))
        });
        let motion = self.motion.iter();
        let motion =
            motion.map(|given| ReadColumn::new("motion", given.name, given.column, &given.unit));
        let channels = self.description.channels.iter().zip(self.channels);
        let channels = channels
            .zip(self.initial_readings)
            .map(|((channel, unit), start)| {
                let column = ReadColumn::new("channels", &channel.name.text, &channel.column, unit);
                column.with_start(*start)
            });
        inputs.chain(motion).chain(channels).collect()
    }

    /// Reads time, input columns, given motion and channels in SI, unwrapped, and determines the used part of the file.
    fn read_table(
        &self,
        place: &Path,
        name: &str,
        stretch: &Stretch,
        notes: &mut Vec<String>,
    ) -> Result<(Table, UsedPart), Refusal> {
        let columns = self.read_columns();
        let mut wanted = vec![&self.description.time.column.column];
        wanted.extend(columns.iter().map(|column| &column.column.column));
        let mut table = columns::read_columns(place, &self.description.format, &wanted)
            .map_err(|refusal| refusal.locate_column(&self.description.source))?;
        let clock = Clock::new(&table, self.time, self.counts_from_first);
        let read_times = std::mem::replace(&mut table.columns[0], clock.times);
        for (column, read) in table.columns[1..].iter_mut().zip(&columns) {
            for value in column.iter_mut() {
                // A number that overflows when it is converted to SI counts as missing.
                *value = Some(read.unit.to_si(*value))
                    .filter(|v| v.is_finite())
                    .unwrap_or(f64::NAN);
            }
        }
        check_times(place, &table.columns[0], &table.lines, 1)?;
        let used = self.find_used_part(stretch, &read_times, (&table.columns[0], clock.origin))?;
        let gaps = unwrap_columns(&columns, (place, &used), &mut table)
            .map_err(|wrong| Diagnostics::from_one(self.description.source.clone(), wrong))?;
        notes.extend(gaps.into_iter().map(|gap| format!("{name}: {gap}")));
        self.drop_outliers(name, &used.rows, &mut table, notes);
        Ok((table, used))
    }

    /// Replaces single wrong samples of the channels by missing ones, and adds a note.
    fn drop_outliers(
        &self,
        name: &str,
        used: &Range<usize>,
        table: &mut Table,
        notes: &mut Vec<String>,
    ) {
        let first = table.columns.len() - self.channels.len();
        let (others, channels) = table.columns.split_at_mut(first);
        let times = &others[0];
        let known = self.description.channels.iter().zip(self.smooth_noises);
        for ((channel, noise), column) in known.zip(channels) {
            let Some(noise) = *noise else { continue };
            let mut found = find_outliers(times, column, noise);
            for outlier in &found {
                column[outlier.sample] = f64::NAN;
            }
            found.retain(|outlier| used.contains(&outlier.sample));
            let Some(worst) = found
                .iter()
                .max_by(|a, b| a.error.abs().total_cmp(&b.error.abs()))
            else {
                continue;
            };
            let (size, line) = (worst.error.abs(), table.lines[worst.sample]);
            let count = match found.len() {
                1 => String::new(),
                count => format!("the largest of {count} outliers, "),
            };
            notes.push(format!(
                "{name}: left out as an outlier: {count}line {line} of `{}`, which differs from the samples beside it by {size:.3e} (SI), \
                 {:.1e} standard deviations of its noise",
                channel.name.text,
                size / noise
            ));
        }
    }

    /// Returns the used part of a file. `read` has its times in their unit, `times` in s.
    fn find_used_part(
        &self,
        stretch: &Stretch,
        read: &[f64],
        (times, origin): (&[f64], f64),
    ) -> Result<UsedPart, Refusal> {
        let until = |end: Option<Number>, open: usize| {
            end.map_or(open, |end| read.partition_point(|t| *t < end.value))
        };
        let rows = until(stretch.from, 0)..until(stretch.to, read.len());
        if let Some(end) = stretch.from.or(stretch.to)
            && rows.is_empty()
        {
            let nothing = Diagnostic::error(format!(
                "\"{}\" has no samples in this part: its times are {} to {} {}",
                stretch.file.text,
                read[0],
                read[read.len() - 1],
                self.description.time.column.unit.text
            ));
            return Err(Diagnostics::from_one(
                self.description.source.clone(),
                nothing.with_span(
                    end.span,
                    "expected a time of the record, in the unit of its column",
                ),
            )
            .into());
        }
        let from = stretch
            .from
            .map_or(f64::NEG_INFINITY, |_| times[rows.start]);
        let to = times.get(rows.end).copied().unwrap_or(f64::INFINITY);
        Ok(UsedPart {
            rows,
            span: from..to,
            origin,
        })
    }

    /// Appends rates and second derivatives to given motion before filtering, so that the filter keeps them consistent.
    /// Short runs of empty cells are filled, with a note.
    fn add_rates(
        &self,
        place: &Path,
        name: &str,
        used: &UsedPart,
        table: &mut Table,
        notes: &mut Vec<String>,
    ) -> Result<(), Refusal> {
        if self.motion.is_empty() {
            return Ok(());
        }
        let first = 1 + self.inputs.iter().flatten().count();
        let given = first..first + self.motion.len();
        let mut rates = [const { Vec::new() }; 3];
        for (coordinate, column) in self.motion.iter().zip(&table.columns[given.clone()]) {
            check_known(place, &format!("motion of `{}`", coordinate.name), column)?;
            let times = &table.columns[0];
            let parts = find_contiguous_parts(times, column);
            let motion = match (coordinate.kind, parts.first()) {
                (_, None) => None,
                (GivenKind::Position, _) => differentiate_position(times, column, &parts),
                (GivenKind::Speed { initial }, Some(first)) => {
                    check_position_known(place, coordinate.name, (times, column), used)?;
                    integrate_speed(times, column, first.clone(), initial)
                }
            };
            for part in parts {
                let shared = part.start.max(used.rows.start)..part.end.min(used.rows.end);
                if let (Some(times), Some(column)) = (times.get(shared.clone()), column.get(shared))
                    && let Some(filled) = describe_missing((times, used.origin), column)
                {
                    notes.push(format!(
                        "{name}: missing, and interpolated: {filled} of `{}`",
                        coordinate.name
                    ));
                }
            }
            let Some(found) = motion else {
                let nothing = format!(
                    "the motion of `{}` is empty; expected numbers",
                    coordinate.name
                );
                return Err(Refusal::file_error(place, nothing));
            };
            for (all, column) in rates.iter_mut().zip(found) {
                all.push(column);
            }
        }
        table.columns.splice(given, rates.into_iter().flatten());
        Ok(())
    }

    fn decimate(&self, place: &Path, table: &mut Table) -> Result<(), Refusal> {
        let decimation = self.decimation;
        if decimation.is_idle() {
            return Ok(());
        }
        let step = typical_step(&table.columns[0]);
        let mut steps = table.columns[0].windows(2).map(|pair| pair[1] - pair[0]);
        let uneven = steps.position(|s| (s - step).abs() > MAX_JITTER_FRACTION * step);
        if let Some(sample) = uneven.filter(|_| decimation.is_filtered()) {
            return Err(Refusal::line_error(
                place,
                table.lines[sample + 1],
                "the low-pass filter of `every` in [time] requires even time steps, and this one differs; \
                 write filter = \"none\", or use parts with even steps",
            ));
        }
        let inputs = 1 + self.inputs.iter().flatten().count();
        for (number, column) in table.columns.iter_mut().enumerate() {
            *column = match number {
                0 => decimation.pick_samples(column),
                number if number < inputs && !self.is_prescribed(number - 1) => {
                    decimation.decimate_held(column)
                }
                _ => decimation.decimate_measured(column),
            };
        }
        table.lines = decimation.pick_samples(&table.lines);
        Ok(())
    }

    /// Returns true if the input of a column is prescribed motion, which is not held.
    fn is_prescribed(&self, column: usize) -> bool {
        let fed = self.model.inputs.iter().zip(self.inputs);
        let mut fed = fed.filter(|(_, column)| column.is_some());
        fed.nth(column)
            .is_some_and(|(input, _)| input.rate.is_some())
    }

    /// Returns the inputs: held values, splines of prescribed motion, and columns of given motion.
    fn build_inputs(
        &self,
        times: &[f64],
        columns: &[Vec<f64>],
        motion: Vec<Vec<f64>>,
    ) -> HeldInputs {
        let mut inputs = match motion.is_empty() {
            true => hold_inputs(times, columns),
            false => hold_inputs(times, &[columns, &motion].concat()),
        };
        let places = self.model.inputs.iter().zip(self.inputs).enumerate();
        for (place, (input, column)) in places {
            if !input.is_prescribed() || column.is_none() {
                continue;
            }
            let samples = times.iter().zip(&columns[place]);
            let known = samples.filter(|(_, value)| value.is_finite());
            let (times, values) = known.map(|(t, value)| (*t, *value)).unzip();
            if let Some(spline) = CubicSpline::fit(times, values) {
                inputs = inputs.with_prescribed(place, spline);
            }
        }
        inputs
    }
}

fn cut_to_rows(rows: Range<usize>, table: &mut Table) {
    table.lines = table.lines[rows.clone()].to_vec();
    for column in &mut table.columns {
        *column = column[rows.clone()].to_vec();
    }
}

/// Checks that a column of speeds has no gap before the end of the used part. After a gap, its integral is unknown.
fn check_position_known(
    place: &Path,
    name: &str,
    (times, speeds): (&[f64], &[f64]),
    used: &UsedPart,
) -> Result<(), Refusal> {
    let mut gaps = find_missing_rows(times);
    gaps.extend(find_long_empty_cells(name, times, speeds));
    match gaps.iter().find(|gap| gap.behind < used.span.end) {
        Some(gap) => Err(Refusal::file_error(
            place,
            format!(
                "{}, and the position of `{name}` is integrated from its speed: it is unknown after the gap; use \
                 only the part before it (`to`), or write the part after it to a file of its own, whose first position \
                 is `initial` in [motion.{name}]",
                gap.describe(used.origin)
            ),
        )),
        None => Ok(()),
    }
}

fn hold_inputs(times: &[f64], columns: &[Vec<f64>]) -> HeldInputs {
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
