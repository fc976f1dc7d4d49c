//! What a study leaves, ready to be written: figures, tables, and the document that says
//! what they are and what was measured.

use serde_json::{Value, json};

use eomgen_analysis::exponent::Exponent;
use eomgen_analysis::spectrum::PowerSpectrum;
use eomgen_model_spec::model::{Model, ParameterValue};

use super::arm::Case;
use super::case::{Amplitude, Measurement};
use super::display::Display;

/// A study's files and their description.
#[derive(Clone, Debug)]
pub struct Study {
    /// The figures.
    pub figures: Vec<Figure>,
    /// The data.
    pub tables: Vec<Columns>,
    /// The measured cases, each a JSON object.
    pub cases: Vec<Value>,
    /// What else there is to say, by name.
    pub more: Vec<(&'static str, Value)>,
}

/// A drawn figure.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The file's name.
    pub file: String,
    /// The paper's figure it corresponds to, or an empty text.
    pub paper: String,
    /// What it shows.
    pub caption: String,
    /// The cases it shows.
    pub cases: Vec<String>,
    /// The drawing.
    pub svg: String,
}

/// A table of data: named columns, SI.
#[derive(Clone, Debug)]
pub struct Columns {
    /// The file's name.
    pub file: String,
    /// Each column's name and values.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl Study {
    /// The document of a study of this name.
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
            "schema": 1,
            "study": name,
            "model": model.name,
            "parameters": parameters(model),
            "figures": figures.collect::<Vec<_>>(),
            "cases": self.cases,
        });
        if let Some(fields) = document.as_object_mut() {
            for (name, value) in &self.more {
                fields.insert((*name).to_owned(), value.clone());
            }
        }
        document
    }
}

/// A case's name in files: `b025_w10pi_s4`.
pub(super) fn id(case: &Case) -> String {
    let micrometres = (case.backlash * 1e6).round();
    let multiple = (case.omega / std::f64::consts::PI).round();
    format!("b{micrometres:03}_w{multiple:02}pi_s{}", case.order)
}

/// The given numbers with where they come from; what a case sets is in the case.
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

/// The data of a displayed case: its series and its spectra.
pub(super) fn tables(display: &Display) -> [Columns; 2] {
    let id = id(&display.case);
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
        Columns {
            file: format!("{id}_history.parquet"),
            columns,
        },
        Columns {
            file: format!("{id}_spectra.parquet"),
            columns: spectra,
        },
    ]
}

/// A measured case with the files that show it.
pub(super) fn case(measured: &Measurement) -> Value {
    let id = id(&measured.case);
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
