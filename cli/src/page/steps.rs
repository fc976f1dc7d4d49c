//! Sections of the tour's page, except the equations.

use eomgen_page::{
    aligned, collapsible_file, figure, number, prose, quantity_symbol, stacked_table, table,
};
use maud::{Markup, html};

use super::{
    CheckRow, FunctionNote, Hidden, NextCommand, Simulation, Source, Specification, StepDuration,
    SymbolRow,
};

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
            "and the units of every term are checked: " strong { (found) } ". " (specification.reference)
        }
        @for warning in warnings { pre.warning { (warning) } }
        (collapsible_file("Specification", specification.text, false))
    }
}

/// Number of digits of a parameter after the first.
const PARAMETER_DIGITS: usize = 4;

/// Returns the folded table of symbols, and the definitions of piecewise functions.
pub(super) fn symbols(symbols: &[SymbolRow], functions: &[FunctionNote]) -> Markup {
    let rows = html! {
        @for symbol in symbols {
            tr {
                th scope="row" { (quantity_symbol(&symbol.name)) }
                td { (prose(&symbol.meaning)) }
                td.number { @if let Some(value) = symbol.value { (number(value, PARAMETER_DIGITS)) } }
                td { @if symbol.unit != "1" { (symbol.unit) } }
            }
        }
    };
    html! {
        details {
            summary { "Symbols" }
            (table(&["symbol", "meaning", "value", "unit"], &rows))
        }
        @for function in functions {
            p { code { (function.call) } " " (function.definition) }
        }
    }
}

pub(super) fn source(source: &Source<'_>) -> Markup {
    html! {
        p {
            (file(source.path)) " contains the model in " (source.text.lines().count())
            " lines of Rust. It compiles on its own, without the standard library, allocation or other "
            "crates."
        }
        @if let Some(rates) = rates_function(source.text) {
            (collapsible_file("The right-hand side: rates", rates, true))
        }
        (collapsible_file("Whole file", source.text, false))
    }
}

/// Returns a link to a file or folder in the folder of the page.
fn file(path: &str) -> Markup {
    html! { a href=(path) { code { (path) } } }
}

/// Extracts the function `rates` with its documentation from formatted source.
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

pub(super) fn certificate(checks: &[CheckRow]) -> Markup {
    let passed = checks.iter().filter(|check| check.passed).count();
    let skipped = checks.iter().filter(|check| check.skipped).count();
    let failed = checks
        .iter()
        .filter(|check| !check.passed && !check.skipped)
        .count();
    let values: Vec<Option<f64>> = checks.iter().map(|check| check.value).collect();
    let tolerances: Vec<Option<f64>> = checks.iter().map(|check| Some(check.tolerance)).collect();
    let (values, tolerances) = (aligned(&values, 1), aligned(&tolerances, 1));
    let rows = html! {
        @for (check, (value, tolerance)) in checks.iter().zip(values.iter().zip(&tolerances)) {
            (check_row(check, value, tolerance))
        }
    };
    html! {
        p {
            @match (failed, passed, skipped) {
                (0, 0, _) => strong.failed { "No check was run." },
                (0, _, 0) => strong.passed { "The model passes." },
                (0, _, _) => strong.failed { "Partial: no check failed, but some were not run." },
                _ => strong.failed { "The model fails " (failed) " of its checks." },
            }
            " Checks passed: " (passed) "; failed: " (failed) "; not run: " (skipped)
            ". A value is the largest deviation, relative unless stated otherwise; it must not exceed the "
            "tolerance."
        }
        (stacked_table(&["check", "value", "tolerance", "result"], &rows))
    }
}

fn check_row(check: &CheckRow, value: &Markup, tolerance: &Markup) -> Markup {
    let (class, result) = match (check.passed, check.skipped) {
        (true, _) => ("passed", "✓ passed"),
        (false, true) => ("skipped", "– not run"),
        (false, false) => ("failed", "✗ failed"),
    };
    html! {
        tr {
            th scope="row" {
                (check.sentence)
                @if !check.detail.is_empty() { br; small { (check.detail) } }
            }
            td.number { (value) }
            td.number { (tolerance) }
            td class=(class) { (result) }
        }
    }
}

pub(super) fn simulation(simulation: &Simulation<'_>) -> Markup {
    html! {
        p { (simulation.summary) " Every sample is in " (file(simulation.path)) "." }
        @for drawn in &simulation.figures { (figure(*drawn)) }
    }
}

pub(super) fn hidden(hidden: &Hidden<'_>) -> Markup {
    let [before, after] = hidden.reports;
    // A report runs a script, so a sandboxed frame isolates it from this page.
    let page = |summary: &str, report: &str, is_open: bool| {
        html! {
            details open[is_open] {
                summary { (summary) }
                iframe title=(summary) sandbox="allow-scripts" srcdoc=(report) {}
            }
        }
    };
    html! {
        p {
            "The records are simulated positions of a positioning stage with a dry friction that its specification "
            "lacks. Records and results are in " (file(hidden.path)) "."
        }
        dl.values {
            @for (name, fact) in &hidden.facts {
                dt { (name) }
                dd { (prose(fact)) }
            }
        }
        (page("Report of the comparison", before, false))
        (page("Report of the discovery", after, true))
        (collapsible_file("Extended specification", hidden.extended, false))
    }
}

pub(super) fn durations(durations: &[StepDuration<'_>]) -> Markup {
    let row = |step: &str, seconds: f64| {
        html! { tr { th scope="row" { (step) } td.number { (duration(seconds)) } } }
    };
    let sum = durations.iter().map(|duration| duration.seconds).sum();
    let rows = html! {
        @for duration in durations { (row(duration.step, duration.seconds)) }
        (row("total", sum))
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

pub(super) fn next(commands: &[NextCommand<'_>]) -> Markup {
    html! {
        dl {
            @for next in commands {
                dt { (next.purpose) }
                dd { pre { code {
                    // Each word is an element of its own, to prevent line breaks at hyphens.
                    @for (place, word) in next.command.split(' ').enumerate() {
                        @if place > 0 { " " }
                        span.word { (word) }
                    }
                } } }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_function_includes_its_documentation() {
        let text = "const A: f64 = 1.0;\n\n/// The rates.\n#[inline]\npub fn rates() {\n    if true {\n    }\n}\n\nfn b() {}\n";
        assert_eq!(
            rates_function(text),
            Some("/// The rates.\n#[inline]\npub fn rates() {\n    if true {\n    }\n}")
        );
        assert_eq!(rates_function("fn nothing() {}"), None);
    }

    #[test]
    fn durations_are_printed_in_ms_or_s() {
        assert_eq!(duration(0.0123), "12.3 ms");
        assert_eq!(duration(75.04), "75.0 s");
    }
}
