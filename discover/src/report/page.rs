//! A page that an engineer can hand on: what was measured and simulated before and after, what
//! was found and what was not, and what changed in the specification. It refers to nothing
//! outside.

use eomgen_plot::{FrequencyAxis, Panel, Series, Spectrum, TimeHistory, spectrum, time_history};
use serde_json::Value;

use crate::fit::fitted::Fit;
use crate::model::problem::EstimationProblem;
use crate::residual_force::figures::figures as figures_of_force;
use crate::residual_force::types::ResidualForce;

/// The page for a result. What is after is left out where nothing was changed; `forces`: the
/// residual force, where it could be estimated.
pub fn page(
    problem: &EstimationProblem<'_>,
    (before, after): (&Fit, Option<&Fit>),
    forces: Option<(&ResidualForce, Option<&ResidualForce>)>,
    document: &Value,
    texts: (&str, &str),
) -> String {
    let title = match problem.dataset.title.as_str() {
        "" => "Model and measurement",
        title => title,
    };
    let mut body = format!("<h1>{}</h1>\n", escaped(title));
    body += &format!(
        "<p class=\"lead\">Verdict: <strong>{}</strong></p>\n",
        escaped(document["verdict"].as_str().unwrap_or(""))
    );
    body += &format!(
        "<p>{}</p>\n",
        escaped(document["where"].as_str().unwrap_or(""))
    );
    for note in document["notes"].as_array().into_iter().flatten() {
        body += &format!(
            "<p class=\"note\">{}</p>\n",
            escaped(note.as_str().unwrap_or(""))
        );
    }
    body += &section("The gap", &gap_table(document));
    if document.get("effects").is_some() {
        body += &section("What was found", &effects_table(document));
        let steps = ladder_table(document) + &validation_line(document);
        body += &section("Step by step", &steps);
    }
    body += &section("The test record", &figures(problem, before, after));
    if let Some((force, left)) = forces {
        let heading = format!("The residual force on {}", force.profiled_equation());
        body += &section(&heading, &force_section(force, left));
    }
    body += &section(
        "Refitted",
        &format!(
            "<pre>{}</pre>",
            escaped(&format!(
                "{:#}\n{:#}",
                document["refitted"], document["sensors"]
            ))
        ),
    );
    for (key, heading) in [
        ("rejected", "Rejected"),
        ("not_testable", "Not testable with these records"),
    ] {
        if let Some(list) = document[key].as_array() {
            body += &section(heading, &rejected_table(list));
        }
    }
    if texts.0 != texts.1 {
        body += &section(
            "The specification, changed",
            &format!("<pre>{}</pre>", difference(texts.0, texts.1)),
        );
    }
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title),
        STYLE
    )
}

const STYLE: &str = "body{margin:0 auto;max-width:62rem;padding:1.5rem;font:1rem/1.5 system-ui,sans-serif;color:#1d2329}\
.lead{font-size:1.1rem}.note{color:#5b6670}table{border-collapse:collapse;width:100%;font-size:.92rem}\
th,td{text-align:left;vertical-align:top;padding:.3rem .8rem .3rem 0;border-bottom:1px solid #d9dee3}\
pre{overflow-x:auto;background:#f5f7f9;border:1px solid #d9dee3;padding:.8rem;font-size:.85rem}\
.added{color:#00704f}.removed{color:#b03a00}svg{max-width:100%;height:auto}";

fn section(heading: &str, content: &str) -> String {
    format!(
        "<section>\n<h2>{}</h2>\n{content}</section>\n",
        escaped(heading)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn number(value: &Value) -> String {
    value
        .as_f64()
        .map_or_else(String::new, |v| format!("{v:.4e}"))
}

fn gap_table(document: &Value) -> String {
    let mut rows = String::new();
    for (name, gap) in document["gap"].as_object().into_iter().flatten() {
        let cells: Vec<String> = match gap.get("before") {
            Some(before) => vec![
                number(&before["train"]),
                number(&gap["after"]["train"]),
                number(&before["test"]),
                number(&gap["after"]["test"]),
            ],
            None => vec![
                number(&gap["train"]),
                String::new(),
                number(&gap["test"]),
                String::new(),
            ],
        };
        let unit = gap["unit"].as_str().unwrap_or("");
        rows += &format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            escaped(name),
            escaped(unit),
            number(&gap["floor"]),
            cells.join("</td><td>")
        );
    }
    format!(
        "<table><tr><th>channel</th><th>unit</th><th>floor</th><th>train before</th><th>train after</th><th>test before</th><th>test after</th></tr>\n{rows}</table>\n"
    )
}

fn effects_table(document: &Value) -> String {
    let mut rows = String::new();
    for effect in document["effects"].as_array().into_iter().flatten() {
        let mut parameters = Vec::new();
        for (name, entry) in effect["parameters"].as_object().into_iter().flatten() {
            let unit = entry["unit"].as_str().unwrap_or("");
            parameters.push(format!(
                "{} = {} &plusmn; {} {}",
                escaped(name),
                number(&entry["value"]),
                number(&entry["sd"]),
                escaped(unit)
            ));
        }
        let text = |key: &str| escaped(effect[key].as_str().unwrap_or(""));
        rows += &format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
            text("effect"),
            text("on"),
            text("status"),
            parameters.join("<br>"),
            text("term")
        );
    }
    if rows.is_empty() {
        return "<p>Nothing.</p>\n".to_owned();
    }
    format!(
        "<table><tr><th>effect</th><th>on</th><th>status</th><th>parameters</th><th>term</th></tr>\n{rows}</table>\n"
    )
}

/// The test gap after each round.
fn ladder_table(document: &Value) -> String {
    let mut rows = String::new();
    for step in document["ladder"].as_array().into_iter().flatten() {
        let added: Vec<&str> = step["added"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect();
        let added = match added.is_empty() {
            true => "the model as it is".to_owned(),
            false => format!("+ {}", added.join(", ")),
        };
        let gap = number(&step["test_in_noises"]);
        rows += &format!("<tr><td>{}</td><td>{gap}</td></tr>\n", escaped(&added));
    }
    format!("<table><tr><th>model</th><th>test gap, in noises</th></tr>\n{rows}</table>\n")
}

/// Whether the equations of the specification that was written are right.
fn validation_line(document: &Value) -> String {
    let validation = &document["validation"];
    let names = |key: &str| -> Vec<&str> {
        let list = validation[key].as_array();
        list.into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect()
    };
    let noises = |key: &str| {
        let left = validation[key].as_f64();
        left.map_or_else(|| "?".to_owned(), |left| format!("{left:.2}"))
    };
    let text = match validation["passed"].as_bool() {
        Some(true) => format!(
            "The specification that was written was derived anew; its equations pass all {} checks of eomgen validate. Run on the records it leaves {} noises in training and {} in test.",
            names("checks").len(),
            noises("train_in_noises"),
            noises("test_in_noises")
        ),
        Some(false) => format!(
            "The specification that was written was derived anew; its equations FAIL {}.",
            names("failed").join(", ")
        ),
        None => return String::new(),
    };
    format!("<p>{}</p>\n", escaped(&text))
}

/// How the equations compare, and what the force in one of them is like.
fn force_section(force: &ResidualForce, left: Option<&ResidualForce>) -> String {
    let mut rows = String::new();
    let percent = |part: f64| format!("{:.0} %", 100.0 * part.max(0.0));
    for ranked in &force.ranked {
        rows += &format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            escaped(&force.equations[ranked.equation].name),
            percent(ranked.by_state),
            percent(ranked.by_time)
        );
    }
    let told = "A force that was put into this equation, its bars one standard deviation to either side. What records do not show is left out.";
    format!(
        "<table><tr><th>a force on</th><th>explains of the squares over rate or place</th><th>if free in every window</th></tr>\n{rows}</table>\n<p class=\"note\">{told}</p>\n{}",
        figures_of_force(force, left)
    )
}

fn rejected_table(list: &[Value]) -> String {
    let row = |entry: &Value| {
        let text = |key: &str| escaped(entry[key].as_str().unwrap_or(""));
        format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            text("effect"),
            text("on"),
            text("reason"),
            text("experiment")
        )
    };
    let rows: String = list.iter().map(row).collect();
    format!(
        "<table><tr><th>effect</th><th>on</th><th>reason</th><th>what would tell</th></tr>\n{rows}</table>\n"
    )
}

/// Lines that were added or changed, with those they replace.
fn difference(before: &str, after: &str) -> String {
    let old: Vec<&str> = before.lines().collect();
    let new: Vec<&str> = after.lines().collect();
    let removed = old
        .iter()
        .filter(|line| !new.contains(line))
        .map(|line| format!("<span class=\"removed\">- {}</span>\n", escaped(line)));
    let added = new
        .iter()
        .filter(|line| !old.contains(line))
        .map(|line| format!("<span class=\"added\">+ {}</span>\n", escaped(line)));
    removed.chain(added).collect()
}

/// Residuals over time and their spectra, before and after.
fn figures(problem: &EstimationProblem<'_>, before: &Fit, after: Option<&Fit>) -> String {
    let count = problem.noise.len();
    let times: Vec<f64> = problem
        .test
        .list
        .iter()
        .filter(|w| w.record == 0)
        .flat_map(|w| w.times.iter().copied())
        .collect();
    let column = |fit: &Fit, channel: usize| -> Vec<f64> {
        let windows = problem
            .test
            .list
            .iter()
            .zip(&fit.test.residuals)
            .filter(|(w, _)| w.record == 0);
        let mut values = Vec::new();
        for (window, residual) in windows {
            let own = residual
                .iter()
                .skip(channel)
                .step_by(count)
                .map(|r| r * problem.noise[channel]);
            let begin = values.len();
            values.extend(own);
            values.resize(begin + window.times.len(), f64::NAN);
        }
        values
    };
    let mut fits = vec![("before", before)];
    fits.extend(after.map(|after| ("after", after)));
    let columns: Vec<Vec<(&str, Vec<f64>)>> = (0..count)
        .map(|channel| {
            fits.iter()
                .map(|(name, fit)| (*name, column(fit, channel)))
                .collect()
        })
        .collect();
    let named: Vec<(String, String)> = problem
        .dataset
        .channels
        .iter()
        .map(|c| (c.name.clone(), c.unit.clone()))
        .collect();
    let history = TimeHistory {
        title: "Differences on the test record".to_owned(),
        panels: named
            .iter()
            .zip(&columns)
            .map(|((name, unit), series)| Panel {
                title: format!("{name}: simulated minus measured"),
                quantity: name.clone(),
                unit: unit.clone(),
                series: series
                    .iter()
                    .map(|(label, values)| Series {
                        label: (*label).to_owned(),
                        abscissa: &times,
                        values,
                    })
                    .collect(),
                references: Vec::new(),
            })
            .collect(),
    };
    let mut out = time_history(&history).unwrap_or_default();
    let step = eomgen_records::samples::typical_step(&times);
    let spectra: Vec<Vec<(&str, Density)>> = columns
        .iter()
        .map(|series| {
            series
                .iter()
                .map(|(label, values)| (*label, density(values, step)))
                .collect()
        })
        .collect();
    let plot = Spectrum {
        title: "Spectra of the differences".to_owned(),
        frequency: FrequencyAxis::Logarithmic,
        panels: named
            .iter()
            .zip(&spectra)
            .map(|((name, unit), series)| Panel {
                title: format!("{name}: spectrum of the difference"),
                quantity: name.clone(),
                unit: format!("({unit})^2/Hz"),
                series: series
                    .iter()
                    .map(|(label, (f, d))| Series {
                        label: (*label).to_owned(),
                        abscissa: f,
                        values: d,
                    })
                    .collect(),
                references: Vec::new(),
            })
            .collect(),
    };
    out += &spectrum(&plot).unwrap_or_default();
    out
}

/// Frequencies in Hz, and the density at each.
type Density = (Vec<f64>, Vec<f64>);

/// The power spectral density of a residual, missing samples as 0; frequencies in Hz.
fn density(values: &[f64], step: f64) -> Density {
    let mut signal: Vec<f64> = values
        .iter()
        .map(|v| if v.is_finite() { *v } else { 0.0 })
        .collect();
    let length = signal.len();
    if length < 2 {
        return (Vec::new(), Vec::new());
    }
    let transform = realfft::RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut spectrum = transform.make_output_vec();
    if transform.process(&mut signal, &mut spectrum).is_err() {
        return (Vec::new(), Vec::new());
    }
    let rate = 1.0 / (length as f64 * step);
    (1..spectrum.len())
        .map(|k| {
            (
                k as f64 * rate,
                2.0 * step / length as f64 * spectrum[k].norm_sqr(),
            )
        })
        .unzip()
}
