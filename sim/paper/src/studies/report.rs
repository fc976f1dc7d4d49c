//! Files of a study: figures, tables, and a JSON document that describes them and the measurements.

use serde_json::{Value, json};

use eomgen_analysis::exponent::Exponent;
use eomgen_analysis::spectrum::PowerSpectrum;
use eomgen_model_spec::model::{Model, ParameterValue};

use super::arm::Case;
use super::case::{Amplitude, Measurement};
use super::display::SampledCase;

/// Files of a study, with the data of its JSON document.
#[derive(Clone, Debug)]
pub struct Study {
    /// Figures.
    pub figures: Vec<Figure>,
    /// Tables of data.
    pub tables: Vec<Table>,
    /// Measured cases, each a JSON object.
    pub cases: Vec<Value>,
    /// Further entries of the document, by name.
    pub further_entries: Vec<(&'static str, Value)>,
}

/// Figure.
#[derive(Clone, Debug)]
pub struct Figure {
    /// File name.
    pub file: String,
    /// Corresponding figure of the paper, or empty.
    pub paper: String,
    /// Caption.
    pub caption: String,
    /// Cases in the figure.
    pub cases: Vec<String>,
    /// SVG source.
    pub svg: String,
}

/// Table of data: named columns, SI.
#[derive(Clone, Debug)]
pub struct Table {
    /// File name.
    pub file: String,
    /// Name and values of each column.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Study {
    /// Returns the JSON document of a study.
    pub fn document(&self, name: &str, model: &Model) -> Value {
        let figures = self.figures.iter().map(|figure| {
            json!({
                "paper": figure.paper,
                "file": figure.file,
                "caption": figure.caption,
                "cases": figure.cases,
            })
        });
        let mut document = json!({
            "schema": 2,
            "study": name,
            "model": model.name,
            "parameters": parameters(model),
            "figures": figures.collect::<Vec<_>>(),
            "cases": self.cases,
        });
        if let Some(fields) = document.as_object_mut() {
            for (name, value) in &self.further_entries {
                fields.insert((*name).to_owned(), value.clone());
            }
        }
        document
    }
}

/// Returns the name of a case in files: `b025_w10pi_s4`.
pub(super) fn format_case_name(case: &Case) -> String {
    let micrometres = (case.backlash * 1e6).round();
    let multiple = (case.omega / std::f64::consts::PI).round();
    format!("b{micrometres:03}_w{multiple:02}pi_s{}", case.order)
}

/// Returns the values of the parameters with their sources, except those that the cases set.
fn parameters(model: &Model) -> Value {
    let values = model.parameter_values().unwrap_or_default();
    let given = model.parameters.iter().zip(values);
    let given = given.filter(|(p, _)| matches!(p.value, ParameterValue::Number(_)));
    let entries = given.map(|(parameter, value)| {
        let assumed = parameter.origin.starts_with("assumed");
        let entry = json!({
            "value_si": value,
            "unit": parameter.unit.to_string(),
            "origin": if assumed { "assumed" } else { "paper" },
            "source": parameter.origin,
        });
        (parameter.name.clone(), entry)
    });
    Value::Object(entries.collect())
}

/// Returns the tables of a sampled case: time series and spectra.
pub(super) fn list_sampled_tables(display: &SampledCase) -> [Table; 2] {
    let id = format_case_name(&display.case);
    let history = &display.history;
    let column = |name: &str, values: &[f64]| (name.to_owned(), values.to_vec());
    let mut columns = vec![
        column("t", &history.times),
        column("x_sp", &history.x_sp),
        column("x_sp_dot", &display.x_sp_dot),
        column("x_pr", &history.x_pr),
        column("l_dtheta", &history.transmission),
        column("dr", &history.dr),
        column("f_la", &history.f_la),
    ];
    for (mode, values) in history.modal.iter().enumerate() {
        columns.push(column(&format!("q_{}", mode + 1), values));
    }
    let density = |name: &str, of: &PowerSpectrum| column(name, &of.density);
    let spectra = vec![
        column("f", &display.x_sp.frequency),
        density("G_x_sp", &display.x_sp),
        density("G_f_la", &display.f_la),
        density("G_dr", &display.dr),
    ];
    [
        Table {
            file: format!("{id}_history.parquet"),
            columns,
        },
        Table {
            file: format!("{id}_spectra.parquet"),
            columns: spectra,
        },
    ]
}

/// Returns a measured case as JSON, with the names of its files.
pub(super) fn case_json(measured: &Measurement) -> Value {
    let id = format_case_name(&measured.case);
    let evidence = &measured.evidence;
    json!({
        "case": id,
        "order": measured.case.order,
        "b": measured.case.backlash,
        "omega": measured.case.omega,
        "history": format!("{id}_history.parquet"),
        "spectra": format!("{id}_spectra.parquet"),
        "motion": measured.verdict.motion.to_string(),
        "verdict": measured.verdict.sentence,
        "evidence": {
            "exponent": evidence.exponent.map(exponent),
            "K": evidence.chaos_indicator,
            "period": evidence.period,
            "line_share": evidence.line_share,
            "section_dimension": measured.shape.dimension,
        },
        "transient_s": measured.transient,
        "trend": measured.trend,
        "switches_per_second": measured.switches,
        "x_sp": amplitude(&measured.x_sp),
        "f_la": amplitude(&measured.f_la),
        "l_dtheta": amplitude(&measured.transmission),
        "dr": amplitude(&measured.dr),
        "dominant_mode": measured.dominant_mode(),
        "dominant_band": measured.dominant_band(),
        "dominant_mode_with_static": measured.shares.dominant().map(|mode| mode + 1),
        "vibration_by_mode": measured.vibration,
        "mean_square_by_mode": measured.shares.mean_square,
    })
}

fn exponent(of: Exponent) -> Value {
    json!({ "value": of.value, "standard_error": of.standard_error })
}

pub(super) fn amplitude(of: &Amplitude) -> Value {
    json!({ "mean": of.mean, "rms": of.rms, "peak": of.largest, "peak_to_peak": of.span })
}
