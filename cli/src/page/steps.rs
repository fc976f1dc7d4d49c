//! The steps around the equations: specification, source, certificate, simulation, what is
//! found in records, durations and what next.

use eomgen_page::{figure, folded, number, table};
use maud::{Markup, html};

use super::{CheckRow, Hidden, NextCommand, Simulation, Source, Specification, StepDuration};

/// What was checked and what was found.
pub(super) fn specification(specification: &Specification<'_>) -> Markup {
    let warnings = &specification.warnings;
    let found = match warnings.len() {
        0 => "no errors and no warnings".to_owned(),
        1 => "no errors and one warning".to_owned(),
        count => format!("no errors and {count} warnings"),
    };
    html! {
        p {
            "The model is one text file, " code { (specification.path) } ". Its grammar, its names "
            "and the units of every term were checked: " strong { (found) } "."
        }
        @for warning in warnings { pre.warning { (warning) } }
        (folded("Read the specification", specification.text, false))
    }
}

/// The emitted file, the right-hand side first.
pub(super) fn source(source: &Source<'_>) -> Markup {
    html! {
        p {
            code { (source.path) } " holds the model as " (source.text.lines().count())
            " lines of Rust that need no standard library, no allocation and no other crate, and "
            "compile as they are."
        }
        @if let Some(rates) = rates_function(source.text) {
            (folded("The right-hand side: rates", rates, true))
        }
        (folded("Read the whole file", source.text, false))
    }
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
pub(super) fn certificate(checks: &[CheckRow<'_>]) -> Markup {
    let passed = checks.iter().filter(|check| check.passed).count();
    let skipped = checks.iter().filter(|check| check.skipped).count();
    let failed = checks
        .iter()
        .filter(|check| !check.passed && !check.skipped)
        .count();
    let rows = html! { @for check in checks { (check_row(check)) } };
    html! {
        p {
            @match (failed, passed) {
                (0, 0) => strong.failed { "Nothing was checked." },
                (0, _) => strong.passed { "The model passes." },
                _ => strong.failed { "The model fails " (failed) " of its checks." },
            }
            " Checks passed: " (passed) "; failed: " (failed) "; not made: " (skipped)
            ". A value is the worst deviation found, relative unless the check says otherwise; the "
            "tolerance is what it may be."
        }
        (table(&["check", "value", "tolerance", "result"], &rows))
    }
}

fn check_row(check: &CheckRow<'_>) -> Markup {
    let (class, result) = match (check.passed, check.skipped) {
        (true, _) => ("passed", "✓ passed"),
        (false, true) => ("skipped", "– not made"),
        (false, false) => ("failed", "✗ failed"),
    };
    html! {
        tr {
            th scope="row" { (check.name) br; small { (check.detail) } }
            td.number {
                @match check.value {
                    Some(value) => (number(value, 1)),
                    None => "–",
                }
            }
            td.number { (number(check.tolerance, 1)) }
            td class=(class) { (result) }
        }
    }
}

/// The figures with their captions.
pub(super) fn simulation(simulation: &Simulation<'_>) -> Markup {
    html! {
        p { (simulation.summary) " Every sample is in " code { (simulation.path) } "." }
        @for drawn in &simulation.figures { (figure(*drawn)) }
    }
}

/// What was found, with the whole pages of the comparison and the search.
pub(super) fn hidden(hidden: &Hidden<'_>) -> Markup {
    let [before, after] = hidden.reports;
    // The report of the search computes; it is given nothing else of this page.
    let page = |summary: &str, report: &str, is_open: bool| {
        html! {
            details open[is_open] {
                summary { (summary) }
                iframe title=(summary) sandbox="allow-scripts" srcdoc=(report) {}
            }
        }
    };
    html! {
        p { (hidden.summary) " Records and results are in " code { (hidden.path) } "." }
        (page("Read the report of the comparison, before", before, false))
        (page("Read the report of the search, after", after, true))
        (folded("Read the specification with what was found", hidden.extended, false))
    }
}

/// Durations with their sum.
pub(super) fn durations(durations: &[StepDuration<'_>]) -> Markup {
    let row = |step: &str, seconds: f64| {
        html! { tr { th scope="row" { (step) } td.number { (duration(seconds)) } } }
    };
    let sum = durations.iter().map(|duration| duration.seconds).sum();
    let rows = html! {
        @for duration in durations { (row(duration.step, duration.seconds)) }
        (row("all together", sum))
    };
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
pub(super) fn next(commands: &[NextCommand<'_>]) -> Markup {
    html! {
        dl {
            @for next in commands {
                dt { (next.does) }
                dd { pre { code { (next.command) } } }
            }
        }
    }
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
