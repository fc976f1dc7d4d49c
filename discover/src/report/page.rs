//! A page that an engineer can hand on: what was measured and simulated before and after, what
//! was found and what was not, and what changed in the specification. It refers to nothing
//! outside.

use crate::report::escaped::escaped;
use crate::report::json::{estimates, sensors};
use crate::report::result::{
    Compared, Comparison, Discovery, FoundEffect, OnRecords, RejectedEffect, Step,
};

impl Comparison {
    /// The page.
    pub fn page(&self) -> String {
        let compared = &self.compared;
        let body = opening(compared, self.verdict()) + &closing(compared);
        whole(compared, &body)
    }
}

impl Discovery {
    /// The page.
    pub fn page(&self) -> String {
        let compared = &self.compared;
        let mut body = opening(compared, self.verdict.word());
        body += &section("What was found", &effects_table(&self.effects));
        let steps = ladder_table(&self.steps) + &validation_line(self);
        body += &section("Step by step", &steps);
        body += &closing(compared);
        body += &section("Rejected", &rejected_table(&self.rejected, false));
        body += &section(
            "Not testable with these records",
            &rejected_table(&self.not_testable, true),
        );
        if self.original != self.extended {
            body += &section(
                "The specification, changed",
                &format!("<pre>{}</pre>", difference(&self.original, &self.extended)),
            );
        }
        whole(compared, &body)
    }
}

fn title(compared: &Compared) -> &str {
    match compared.title.as_str() {
        "" => "Model and measurement",
        title => title,
    }
}

/// A document around a body.
fn whole(compared: &Compared, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title(compared)),
        STYLE
    )
}

/// Title, verdict, where the gap is, notes, and the gap.
fn opening(compared: &Compared, verdict: &str) -> String {
    let mut body = format!("<h1>{}</h1>\n", escaped(title(compared)));
    body += &format!(
        "<p class=\"lead\">Verdict: <strong>{}</strong></p>\n",
        escaped(verdict)
    );
    body += &format!("<p>{}</p>\n", escaped(&compared.location));
    for note in &compared.notes {
        body += &format!("<p class=\"note\">{}</p>\n", escaped(note));
    }
    body + &section("The gap", &gap_table(compared))
}

/// Pictures, and what was refitted.
fn closing(compared: &Compared) -> String {
    let mut body = section("The test record", &compared.pictures.residuals);
    if let Some((equation, force)) = &compared.pictures.force {
        body += &section(&format!("The residual force on {equation}"), force);
    }
    let (refitted, sensors) = (estimates(&compared.refitted), sensors(&compared.sensors));
    let text = format!("{refitted:#}\n{sensors:#}");
    body + &section("Refitted", &format!("<pre>{}</pre>", escaped(&text)))
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

fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.4e}")
    } else {
        String::new()
    }
}

fn gap_table(compared: &Compared) -> String {
    let mut rows = String::new();
    for (name, gap) in &compared.gap {
        let after = |of: fn(OnRecords<f64>) -> f64| {
            gap.after
                .map_or_else(String::new, |after| number(of(after)))
        };
        let cells = [
            number(gap.before.train),
            after(|after| after.train),
            number(gap.before.test),
            after(|after| after.test),
        ];
        rows += &format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            escaped(name),
            escaped(&gap.unit),
            number(gap.floor),
            cells.join("</td><td>")
        );
    }
    format!(
        "<table><tr><th>channel</th><th>unit</th><th>floor</th><th>train before</th><th>train after</th><th>test before</th><th>test after</th></tr>\n{rows}</table>\n"
    )
}

fn effects_table(effects: &[FoundEffect]) -> String {
    let mut rows = String::new();
    for effect in effects {
        let parameters = effect.parameters.iter().map(|(name, of)| {
            format!(
                "{} = {} &plusmn; {} {}",
                escaped(name),
                number(of.value),
                number(of.sd),
                escaped(&of.unit)
            )
        });
        rows += &format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td><code>{}</code></td></tr>\n",
            escaped(&effect.at.effect),
            escaped(&effect.at.on),
            effect.status.word(),
            parameters.collect::<Vec<String>>().join("<br>"),
            escaped(&effect.term)
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
fn ladder_table(steps: &[Step]) -> String {
    let mut rows = String::new();
    for step in steps {
        let added = match step.added.is_empty() {
            true => "the model as it is".to_owned(),
            false => format!("+ {}", step.added.join(", ")),
        };
        let gap = number(step.test_rms);
        rows += &format!("<tr><td>{}</td><td>{gap}</td></tr>\n", escaped(&added));
    }
    format!("<table><tr><th>model</th><th>test gap, in noises</th></tr>\n{rows}</table>\n")
}

/// Whether the equations of the specification that was written are right.
fn validation_line(discovery: &Discovery) -> String {
    let Some(validation) = &discovery.validation else {
        return String::new();
    };
    let noises = |rms: f64| match rms.is_finite() {
        true => format!("{rms:.2}"),
        false => "?".to_owned(),
    };
    let text = match validation.passed {
        true => format!(
            "The specification that was written was derived anew; its equations pass all {} checks of eomgen validate. Run on the records it leaves {} noises in training and {} in test.",
            validation.checks.len(),
            noises(discovery.resimulation.train),
            noises(discovery.resimulation.test)
        ),
        false => format!(
            "The specification that was written was derived anew; its equations FAIL {}.",
            validation.failed.join(", ")
        ),
    };
    format!("<p>{}</p>\n", escaped(&text))
}

fn rejected_table(list: &[RejectedEffect], has_experiment: bool) -> String {
    let row = |of: &RejectedEffect| {
        let experiment = if has_experiment {
            of.experiment.as_str()
        } else {
            ""
        };
        format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            escaped(&of.at.effect),
            escaped(&of.at.on),
            escaped(&of.reason),
            escaped(experiment)
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
