//! Derived equations as a part of a page: definitions, energies, the entries of M q'' + c = f,
//! named coefficients with their values, accelerations, switching surfaces.

use eomgen_codegen::report::{CoefficientLine, Line, MassMatrixEntry, Report, Sentence, Solution};
use eomgen_codegen::symbolic::formula::{Formula, Symbol};
use maud::{Markup, html};

use crate::aligned::aligned;
use crate::formula::{entry_name, formula};
use crate::parts::stacked_table;

/// Maximum number of modes whose values are shown.
const MAX_SHOWN_MODES: usize = 8;

/// Number of digits of a value after the first.
const SHOWN_DIGITS: usize = 5;

/// Returns the equations of a report, with formulas as MathML.
pub fn equations(report: &Report) -> Markup {
    let has_modes = report.orders.iter().any(|order| *order > 0);
    let terms = html! {
        "Terms of the energies " i { "T" } " and " i { "V" } ", of the dissipation, and forces"
    };
    html! {
        (introduction(report, has_modes))
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
            entry_name("c", &[name])
        }))
        (equation_section(&html! { "Generalised forces " i { "f" } }, &report.forces, |name| {
            entry_name("f", &[name])
        }))
        (equation_section(&html! { "Rates of first-order states" }, &report.state_rates, formula))
        (equation_section(&html! { "Constraints, which are zero" }, &report.constraints, formula))
        (equation_section(&html! { "Multipliers of the constraints" }, &report.multipliers, formula))
        (coefficients(&report.coefficients))
        (equation_section(&html! { "Accelerations" }, &report.accelerations, formula))
        (guards(&report.guards))
        div.wide { p { (sentence(&report.linearity)) } }
        (solution(&report.solution, has_modes))
    }
}

fn introduction(report: &Report, has_modes: bool) -> Markup {
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
            @if has_modes {
                " Sums run over the modes " i { "i" } "; integrals over the mode shapes " i { "φ" }
                " use " i { "s" } " = " i { "x" } "/" i { "l" }
                " from 0 to 1, with primes for derivatives by " i { "s" } "."
            }
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
        @for (index, item) in items.iter().enumerate() {
            @if index > 0 { " " }
            // No line breaks before a comma.
            span.word { (set(item)) @if index + 1 < items.len() { "," } }
        }
    }
}

fn sentence(sentence: &Sentence) -> Markup {
    html! {
        (sentence.text)
        @if let Some(of) = &sentence.formula { " " (formula(of)) }
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
        (equation_row(&formula(&Formula::from_name("T")), &report.kinetic))
        (equation_row(&formula(&Formula::from_name("V")), &report.potential))
    };
    section_under_heading(&html! { "Kinetic and potential energy" }, &rows)
}

fn mass_matrix(entries: &[MassMatrixEntry]) -> Markup {
    let rows = html! {
        @for entry in entries { (equation_row(&entry_symbol(entry), &entry.formula)) }
    };
    let heading = html! { "Mass matrix " b { "M" } ": symmetric, its nonzero entries" };
    section_under_heading(&heading, &rows)
}

/// Returns the name of an entry of the mass matrix. The column of a block of modes has a separate index.
fn entry_symbol(entry: &MassMatrixEntry) -> Markup {
    let column = match &entry.row {
        Formula::Symbol(row) if !row.indices.is_empty() => entry.column.clone().split_by_columns(),
        _ => entry.column.clone(),
    };
    entry_name("M", &[&entry.row, &column])
}

fn coefficients(lines: &[CoefficientLine]) -> Markup {
    if lines.is_empty() {
        return html! {};
    }
    let scalars: Vec<Option<f64>> = lines.iter().map(scalar).collect();
    let scalars = aligned(&scalars, SHOWN_DIGITS);
    let rows = html! {
        @for (line, scalar) in lines.iter().zip(&scalars) {
            tr {
                th.formula scope="row" { (formula(&indexed_name(line))) }
                @if line.columns > 1 {
                    td.formula colspan="2" { (formula(&line.formula)) }
                } @else {
                    td.formula { (formula(&line.formula)) }
                    td.amounts { (values(line, scalar)) (unit(line)) }
                }
            }
            @if line.columns > 1 {
                tr { td {} td.amounts colspan="2" { (values(line, scalar)) (unit(line)) } }
            }
        }
    };
    html! {
        h3 { "Coefficients" }
        p {
            "Names as in the specification; values for its parameters in SI units, by the modes "
            i { "i" } " and " i { "j" } " of a coefficient with these indices."
        }
        (stacked_table(&["coefficient", "formula", "value"], &rows))
    }
}

/// Returns the name of a coefficient with the indices of its values.
fn indexed_name(line: &CoefficientLine) -> Formula {
    match &line.name {
        Formula::Symbol(symbol) => Formula::Symbol(symbol.clone().with_indices(&line.indices)),
        name => name.clone(),
    }
}

/// Returns the value of a scalar coefficient.
fn scalar(line: &CoefficientLine) -> Option<f64> {
    match (&line.indices[..], &line.values[..]) {
        ([], [only]) => Some(*only),
        _ => None,
    }
}

fn values(line: &CoefficientLine, scalar: &Markup) -> Markup {
    match (line.values.is_empty(), line.indices.is_empty()) {
        (true, _) => html! { "varies with time or state" },
        (false, true) => scalar.clone(),
        (false, false) => mode_table(&line.values, line.columns.max(1)),
    }
}

/// Returns the unit of the values, if they have one.
fn unit(line: &CoefficientLine) -> Markup {
    let unit = line.unit.as_deref().filter(|unit| *unit != "1");
    let preposition = if line.indices.is_empty() { " " } else { " in " };
    html! { @if let Some(unit) = unit { (preposition) (unit) } }
}

/// Returns values by mode: a row for each mode, and a column for each mode of a matrix.
fn mode_table(values: &[f64], columns: usize) -> Markup {
    let shown = columns.min(MAX_SHOWN_MODES);
    let rows: Vec<&[f64]> = values.chunks(columns).take(MAX_SHOWN_MODES).collect();
    let numbers = |column: usize| -> Vec<Markup> {
        let of_column: Vec<Option<f64>> = rows.iter().map(|row| row.get(column).copied()).collect();
        aligned(&of_column, SHOWN_DIGITS)
    };
    let cells: Vec<Vec<Markup>> = (0..shown).map(numbers).collect();
    let modes = values.len() / columns;
    html! {
        table.modes {
            @if columns > 1 {
                thead { tr {
                    th {}
                    @for column in 1..=shown { th scope="col" { i { "j" } " = " (column) } }
                } }
            }
            tbody {
                @for row in 0..rows.len() {
                    tr {
                        th scope="row" { i { "i" } " = " (row + 1) }
                        @for column in &cells { td { (column[row]) } }
                    }
                }
            }
        }
        @if modes.max(columns) > MAX_SHOWN_MODES {
            small { "the first " (MAX_SHOWN_MODES) " of " (modes.max(columns)) " modes" }
        }
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
            " operations per call"
            @if solution.dearest != solution.operations {
                "; the most expensive order takes " (solution.dearest)
            }
            "."
        }
    }
}
