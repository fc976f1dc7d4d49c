//! Derived equations as a part of a page: definitions, energies, the entries of M q'' + c = f,
//! named coefficients with their values, accelerations, switching surfaces.

use eomgen_codegen::report::{CoefficientLine, Line, MassMatrixEntry, Report, Sentence, Solution};
use eomgen_codegen::symbolic::formula::{Formula, Symbol};
use maud::{Markup, html};

use crate::formula::formula;
use crate::number::number;
use crate::parts::table;

const MAX_SHOWN_VALUES: usize = 8;

/// Returns the equations of a report, with formulas as MathML.
pub fn equations(report: &Report) -> Markup {
    let has_modes = report.orders.iter().any(|order| *order > 0);
    let terms = html! {
        "Terms of the energies " i { "T" } " and " i { "V" } ", of the dissipation, and forces"
    };
    html! {
        (introduction(report))
        (equation_section(&html! { "Definitions" }, &report.definitions, formula))
        (equation_section(&terms, &report.terms, formula))
        (energies(report))
        (equation_section(&html! { "Shared subexpressions" }, &report.shared, formula))
        (mass_matrix(&report.mass_matrix))
        (equation_section(
            &html! { "Pivots of its factorisation, which must be positive" },
            &report.pivots,
            formula,
        ))
        (equation_section(&html! { "Velocity terms " i { "c" } }, &report.velocity_terms, |name| {
            indexed_letter("c", &[name])
        }))
        (equation_section(&html! { "Generalised forces " i { "f" } }, &report.forces, |name| {
            indexed_letter("f", &[name])
        }))
        (equation_section(&html! { "Rates of first-order states" }, &report.state_rates, formula))
        (equation_section(&html! { "Constraints, which are zero" }, &report.constraints, formula))
        (equation_section(&html! { "Multipliers of the constraints" }, &report.multipliers, formula))
        (coefficients(&report.coefficients))
        (equation_section(&html! { "Accelerations" }, &report.accelerations, formula))
        (guards(&report.guards))
        p { (sentence(&report.linearity)) }
        (solution(&report.solution, has_modes))
    }
}

fn introduction(report: &Report) -> Markup {
    html! {
        p {
            "Lagrange’s equations, in the form "
            b { "M" } " " i { "q̈" } " + " i { "c" } " = " i { "f" } "."
            @match report.orders.as_slice() {
                [] => {},
                [order] => {
                    " The flexible body has " i { "S" } " = " (order) " modes."
                },
                orders => {
                    " The flexible bodies have "
                    (comma_list(orders, |order| html! { (order) })) " modes."
                },
            }
            " Sums run over the modes " i { "i" } "; integrals over the mode shapes " i { "φ" }
            " use " i { "s" } " = " i { "x" } "/" i { "l" }
            " from 0 to 1, with primes for derivatives by " i { "s" } "."
        }
        p {
            "The state: "
            (comma_list(&report.state, |name| formula(&Formula::Symbol(Symbol::from_state(name)))))
            "."
        }
    }
}

fn comma_list<T>(items: &[T], set: impl Fn(&T) -> Markup) -> Markup {
    html! {
        @for (place, item) in items.iter().enumerate() {
            @if place > 0 { ", " }
            (set(item))
        }
    }
}

fn indexed_letter(letter: &str, names: &[&Formula]) -> Markup {
    html! { i { (letter) } sub { (comma_list(names, |name| formula(name))) } }
}

fn sentence(sentence: &Sentence) -> Markup {
    html! {
        (sentence.text)
        @if let Some(of) = &sentence.formula { ": " (formula(of)) }
        "."
    }
}

fn equation_row(left: &Markup, right: &Formula) -> Markup {
    html! { tr { th scope="row" { (left) } td { "= " (formula(right)) } } }
}

fn section_under_heading(heading: &Markup, rows: &Markup) -> Markup {
    html! {
        h3 { (heading) }
        div.wide { table.equations { tbody { (rows) } } }
    }
}

fn equation_section(heading: &Markup, lines: &[Line], name: impl Fn(&Formula) -> Markup) -> Markup {
    if lines.is_empty() {
        return html! {};
    }
    let rows = html! { @for line in lines { (equation_row(&name(&line.name), &line.formula)) } };
    section_under_heading(heading, &rows)
}

fn energies(report: &Report) -> Markup {
    let rows = html! {
        (equation_row(&html! { i { "T" } }, &report.kinetic))
        (equation_row(&html! { i { "V" } }, &report.potential))
    };
    section_under_heading(&html! { "Kinetic and potential energy" }, &rows)
}

fn mass_matrix(entries: &[MassMatrixEntry]) -> Markup {
    let rows = html! {
        @for entry in entries {
            (equation_row(&indexed_letter("M", &[&entry.row, &entry.column]), &entry.formula))
        }
    };
    let heading = html! { "Mass matrix " b { "M" } ": symmetric, its nonzero entries" };
    section_under_heading(&heading, &rows)
}

fn coefficients(lines: &[CoefficientLine]) -> Markup {
    if lines.is_empty() {
        return html! {};
    }
    let rows = html! {
        @for line in lines {
            tr {
                th.formula scope="row" { (formula(&line.name)) }
                td.formula { (formula(&line.formula)) }
                td.values { (values(&line.values)) }
            }
        }
    };
    html! {
        h3 { "Coefficients" }
        p { "Names as in the specification; values in SI units for its parameters." }
        (table(&["coefficient", "formula", "value, or one per mode"], &rows))
    }
}

fn values(values: &[f64]) -> Markup {
    html! {
        @if values.is_empty() { "varies with time or state" }
        @for (place, value) in values.iter().take(MAX_SHOWN_VALUES).enumerate() {
            @if place > 0 { br; }
            (number(*value, 5))
        }
        @if values.len() > MAX_SHOWN_VALUES { br; "… (" (values.len()) " values)" }
    }
}

fn guards(guards: &[Formula]) -> Markup {
    if guards.is_empty() {
        return html! {};
    }
    html! {
        h3 { "Switching surfaces" }
        p { "The equations switch when one of these changes sign:" }
        ul.formulas { @for guard in guards { li { (formula(guard)) } } }
    }
}

fn solution(solution: &Solution, has_modes: bool) -> Markup {
    let modes = match (has_modes, solution.dense_modes) {
        (false, _) => "",
        (true, false) => "the modes first, then ",
        (true, true) => "the modes first by a dense Cholesky factor, then ",
    };
    let interfaces = match solution.interfaces {
        0 => String::new(),
        1 => "one interface unknown, then ".to_owned(),
        count => format!("{count} interface unknowns, then "),
    };
    html! {
        h3 { "Solution for the accelerations" }
        p {
            "Elimination without pivoting, in the cheapest order: " (modes) (interfaces)
            (comma_list(&solution.order, formula)) ". That takes " (solution.operations)
            " operations per call; the most expensive order takes " (solution.dearest) "."
        }
    }
}
