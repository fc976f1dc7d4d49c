//! The steps around the equations: specification, source, certificate, simulation, what is
//! found in records, durations and what next.

use super::markup::{escaped, folded, number, table};
use super::{CheckRow, Hidden, NextCommand, Simulation, Source, Specification, StepDuration};

/// What was checked and what was found.
pub(super) fn specification(specification: &Specification<'_>) -> String {
    let warnings = &specification.warnings;
    let found = match warnings.len() {
        0 => "no errors and no warnings".to_owned(),
        1 => "no errors and one warning".to_owned(),
        count => format!("no errors and {count} warnings"),
    };
    let warnings: String = warnings
        .iter()
        .map(|warning| format!("<pre class=\"warning\">{}</pre>\n", escaped(warning)))
        .collect();
    format!(
        "<p>The model is one text file, <code>{}</code>. Its grammar, its names and the units of every term were \
         checked: <strong>{found}</strong>.</p>\n{warnings}{}",
        escaped(specification.path),
        folded("Read the specification", specification.text, false)
    )
}

/// The emitted file, the right-hand side first.
pub(super) fn source(source: &Source<'_>) -> String {
    let rates = rates_function(source.text)
        .map(|rates| folded("The right-hand side: rates", rates, true))
        .unwrap_or_default();
    format!(
        "<p><code>{}</code> holds the model as {} lines of Rust that need no standard library, no allocation and \
         no other crate, and compile as they are.</p>\n{rates}{}",
        escaped(source.path),
        source.text.lines().count(),
        folded("Read the whole file", source.text, false)
    )
}

/// The function `rates` with its documentation, from formatted source.
fn rates_function(text: &str) -> Option<&str> {
    let start = text.find("\npub fn rates")? + 1;
    let (before, function) = text.split_at(start);
    let end = function.find("\n}").map_or(function.len(), |end| end + 2);
    let attached = before
        .lines()
        .rev()
        .take_while(|line| line.starts_with("///") || line.starts_with("#["))
        .map(|line| line.len() + 1)
        .sum::<usize>();
    text.get(start.checked_sub(attached)?..start + end)
}

/// The certificate as a table with its verdict.
pub(super) fn certificate(checks: &[CheckRow<'_>]) -> String {
    let passed = checks.iter().filter(|check| check.passed).count();
    let skipped = checks.iter().filter(|check| check.skipped).count();
    let failed = checks
        .iter()
        .filter(|check| !check.passed && !check.skipped)
        .count();
    let verdict = match (failed, passed) {
        (0, 0) => "<strong class=\"failed\">Nothing was checked.</strong>".to_owned(),
        (0, _) => "<strong class=\"passed\">The model passes.</strong>".to_owned(),
        _ => format!("<strong class=\"failed\">The model fails {failed} of its checks.</strong>"),
    };
    let rows: String = checks.iter().map(check_row).collect();
    format!(
        "<p>{verdict} Checks passed: {passed}; failed: {failed}; not made: {skipped}. A value is the worst \
         deviation found, relative unless the check says otherwise; the tolerance is what it may be.</p>\n{}",
        table(&["check", "value", "tolerance", "result"], &rows)
    )
}

fn check_row(check: &CheckRow<'_>) -> String {
    let (class, result) = match (check.passed, check.skipped) {
        (true, _) => ("passed", "✓ passed"),
        (false, true) => ("skipped", "– not made"),
        (false, false) => ("failed", "✗ failed"),
    };
    let value = check
        .value
        .map_or_else(|| "–".to_owned(), |value| number(value, 1));
    format!(
        "<tr><th scope=\"row\">{}<br><small>{}</small></th><td class=\"number\">{value}</td>\
         <td class=\"number\">{}</td><td class=\"{class}\">{result}</td></tr>\n",
        escaped(check.name),
        escaped(check.detail),
        number(check.tolerance, 1)
    )
}

/// The figures with their captions.
pub(super) fn simulation(simulation: &Simulation<'_>) -> String {
    let figures: String = simulation
        .figures
        .iter()
        .map(|figure| {
            format!(
                "<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n",
                figure.svg,
                escaped(figure.caption)
            )
        })
        .collect();
    format!(
        "<p>{} Every sample is in <code>{}</code>.</p>\n{figures}",
        escaped(simulation.summary),
        escaped(simulation.path)
    )
}

/// What was found, with the whole pages of the comparison and the search.
pub(super) fn hidden(hidden: &Hidden<'_>) -> String {
    let [before, after] = hidden.reports;
    let page = |summary: &str, report: &str| {
        format!(
            "<details><summary>{summary}</summary>\n<iframe title=\"{summary}\" sandbox srcdoc=\"{}\"></iframe></details>\n",
            escaped(report)
        )
    };
    format!(
        "<p>{} Records and results are in <code>{}</code>.</p>\n{}{}{}",
        escaped(hidden.summary),
        escaped(hidden.path),
        page("Read the report of the comparison, before", before),
        page("Read the report of the search, after", after),
        folded(
            "Read the specification with what was found",
            hidden.extended,
            false
        )
    )
}

/// Durations with their sum.
pub(super) fn durations(durations: &[StepDuration<'_>]) -> String {
    let row = |step: &str, seconds: f64| {
        format!(
            "<tr><th scope=\"row\">{step}</th><td class=\"number\">{}</td></tr>\n",
            duration(seconds)
        )
    };
    let mut rows: String = durations
        .iter()
        .map(|duration| row(&escaped(duration.step), duration.seconds))
        .collect();
    rows.push_str(&row(
        "all together",
        durations.iter().map(|duration| duration.seconds).sum(),
    ));
    table(&["step", "time"], &rows)
}

fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        format!("{:.1} ms", 1e3 * seconds)
    } else {
        format!("{seconds:.1} s")
    }
}

/// Commands with what they do.
pub(super) fn next(commands: &[NextCommand<'_>]) -> String {
    let items: String = commands
        .iter()
        .map(|next| {
            format!(
                "<dt>{}</dt>\n<dd><pre><code>{}</code></pre></dd>\n",
                escaped(next.does),
                escaped(next.command)
            )
        })
        .collect();
    format!("<dl>\n{items}</dl>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rates_function_is_cut_out_with_its_documentation() {
        let text = "const A: f64 = 1.0;\n\n/// The rates.\n#[inline]\npub fn rates() {\n    if true {\n    }\n}\n\nfn b() {}\n";
        assert_eq!(
            rates_function(text),
            Some("/// The rates.\n#[inline]\npub fn rates() {\n    if true {\n    }\n}")
        );
        assert_eq!(rates_function("fn nothing() {}"), None);
    }

    #[test]
    fn durations_are_written_in_fitting_units() {
        assert_eq!(duration(0.0123), "12.3 ms");
        assert_eq!(duration(75.04), "75.0 s");
    }
}
