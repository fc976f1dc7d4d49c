//! The step that shows the derived equations: definitions, energies, M q'' + c = f entry by
//! entry, the named coefficients with their values, the accelerations, what switches.

use codegen::report::{CoefficientLine, Line, MassMatrixEntry, Report, Sentence, Solution};
use codegen::symbolic::formula::{Formula, Symbol};

use super::markup::{escaped, number, table};

/// At most so many values of a coefficient are shown.
const SHOWN_VALUES: usize = 8;

/// The content of the step.
pub(super) fn content(report: &Report) -> String {
    let mut html = introduction(report);
    html.push_str(&lines("Definitions", &report.definitions, Formula::mathml));
    html.push_str(&lines(
        "Terms of the energies <i>T</i> and <i>V</i>, of the dissipation, and forces",
        &report.terms,
        Formula::mathml,
    ));
    html.push_str(&energies(report));
    html.push_str(&lines(
        "Shared subexpressions, by names of their own",
        &report.shared,
        Formula::mathml,
    ));
    html.push_str(&mass_matrix(&report.mass_matrix));
    html.push_str(&lines(
        "Pivots of its factorisation, which must be positive",
        &report.pivots,
        Formula::mathml,
    ));
    html.push_str(&lines(
        "Velocity terms <i>c</i>",
        &report.velocity_terms,
        |name| indexed("c", &[name]),
    ));
    html.push_str(&lines(
        "Generalised forces <i>f</i>",
        &report.forces,
        |name| indexed("f", &[name]),
    ));
    html.push_str(&coefficients(&report.coefficients));
    html.push_str(&lines(
        "Accelerations",
        &report.accelerations,
        Formula::mathml,
    ));
    html.push_str(&guards(&report.guards));
    html.push_str(&format!("<p>{}</p>\n", sentence(&report.linearity)));
    html.push_str(&solution(
        &report.solution,
        report.orders.iter().any(|order| *order > 0),
    ));
    html
}

fn introduction(report: &Report) -> String {
    let orders: Vec<String> = report.orders.iter().map(usize::to_string).collect();
    let order = match orders.as_slice() {
        [] => String::new(),
        [order] => format!(" The flexible body is carried by <i>S</i> = {order} modes."),
        _ => format!(
            " The flexible bodies are carried by {} modes.",
            orders.join(", ")
        ),
    };
    let state: Vec<String> = report
        .state
        .iter()
        .map(|name| Formula::Symbol(Symbol::of_state(name)).mathml())
        .collect();
    format!(
        "<p>Lagrange’s equations of the energies, in the form <b>M</b> <i>q̈</i> + <i>c</i> = <i>f</i>.{order} \
         Sums run over the modes <i>i</i>; integrals over the mode shapes <i>φ</i> run over \
         <i>s</i> = <i>x</i>/<i>l</i> from 0 to 1, with primes for derivatives by <i>s</i>.</p>\n\
         <p>The state: {}.</p>\n",
        state.join(", ")
    )
}

/// A letter with names as its indices.
fn indexed(letter: &str, names: &[&Formula]) -> String {
    let names: Vec<String> = names.iter().map(|name| name.mathml()).collect();
    format!("<i>{letter}</i><sub>{}</sub>", names.join(", "))
}

fn sentence(sentence: &Sentence) -> String {
    let text = escaped(sentence.text);
    match &sentence.formula {
        Some(formula) => format!("{text}: {}.", formula.mathml()),
        None => format!("{text}."),
    }
}

fn heading(text: &str) -> String {
    format!("<h3>{text}</h3>\n")
}

fn row(left: &str, right: &str) -> String {
    format!("<tr><th scope=\"row\">{left}</th><td>= {right}</td></tr>\n")
}

fn equations(rows: &str) -> String {
    format!(
        "<div class=\"wide\"><table class=\"equations\"><tbody>\n{rows}</tbody></table></div>\n"
    )
}

fn lines(title: &str, lines: &[Line], name: impl Fn(&Formula) -> String) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let rows: String = lines
        .iter()
        .map(|line| row(&name(&line.name), &line.formula.mathml()))
        .collect();
    heading(title) + &equations(&rows)
}

fn energies(report: &Report) -> String {
    let rows =
        row("<i>T</i>", &report.kinetic.mathml()) + &row("<i>V</i>", &report.potential.mathml());
    heading("Kinetic and potential energy") + &equations(&rows)
}

fn mass_matrix(entries: &[MassMatrixEntry]) -> String {
    let rows: String = entries
        .iter()
        .map(|entry| {
            row(
                &indexed("M", &[&entry.row, &entry.column]),
                &entry.formula.mathml(),
            )
        })
        .collect();
    heading("Mass matrix <b>M</b>: symmetric, its nonzero entries") + &equations(&rows)
}

fn coefficients(lines: &[CoefficientLine]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let rows: String = lines
        .iter()
        .map(|line| {
            format!(
                "<tr><th scope=\"row\" class=\"formula\">{}</th><td class=\"formula\">{}</td><td class=\"values\">{}</td></tr>\n",
                line.name.mathml(),
                line.formula.mathml(),
                values(&line.values)
            )
        })
        .collect();
    heading("Coefficients")
        + "<p>By the names the specification gives them; values in SI units at its parameters.</p>\n"
        + &table(&["coefficient", "formula", "value, or one per mode"], &rows)
}

fn values(values: &[f64]) -> String {
    if values.is_empty() {
        return "varies with time or state".to_owned();
    }
    let mut shown: Vec<String> = values
        .iter()
        .take(SHOWN_VALUES)
        .map(|value| number(*value, 5))
        .collect();
    if values.len() > SHOWN_VALUES {
        shown.push(format!("… ({} values)", values.len()));
    }
    shown.join("<br>")
}

fn guards(guards: &[Formula]) -> String {
    if guards.is_empty() {
        return String::new();
    }
    let items: String = guards
        .iter()
        .map(|guard| format!("<li>{}</li>", guard.mathml()))
        .collect();
    heading("Switching surfaces")
        + &format!(
            "<p>The equations switch where one of these changes sign:</p>\n<ul class=\"formulas\">{items}</ul>\n"
        )
}

fn solution(solution: &Solution, has_modes: bool) -> String {
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
    let order: Vec<String> = solution.order.iter().map(Formula::mathml).collect();
    format!(
        "{}<p>Without pivoting, in the order that costs least: {modes}{interfaces}{}. That takes {} operations a \
         call, against {} in the dearest order.</p>\n",
        heading("How the accelerations are solved for"),
        order.join(", "),
        escaped(&solution.operations.to_string()),
        escaped(&solution.dearest.to_string())
    )
}
