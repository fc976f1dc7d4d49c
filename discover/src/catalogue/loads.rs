//! Loads of springs and meshes: forces due to summands `1/2*k*p^2` of the potential energy, where
//! `p` is a deflection, with or without play.

use eomgen_model_spec::model::{Expr, ExprKind, Function, Model, Term};

use crate::catalogue::products::{Square, find_square, is_constant, split_sum};
use crate::catalogue::site::format_expression;
use crate::catalogue::springs::{find_deflection_units, is_deflection, name_spring};

/// Force that a spring or a mesh transmits.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Name of the term, followed by the name of the stiffness if the term has several.
    pub name: String,
    /// Force as an expression of the specification.
    pub force: String,
    /// Unit of the force.
    pub unit: &'static str,
}

/// Returns the loads of a model.
pub fn find_loads(model: &Model) -> Vec<Load> {
    let terms = model.potential.iter();
    terms
        .flat_map(|term| find_loads_in_term(model, term))
        .collect()
}

fn find_loads_in_term(model: &Model, term: &Term) -> Vec<Load> {
    let squares: Vec<(&Expr, Square<'_>)> = split_sum(&term.value)
        .into_iter()
        .filter_map(|summand| Some((summand, find_square(model, summand)?)))
        .filter(|(_, square)| !square.parameters.is_empty())
        .filter_map(|(summand, square)| is_load(model, square.base).then_some((summand, square)))
        .collect();
    let is_only = squares.len() == 1;
    let load = |(number, (summand, square)): (usize, &(&Expr, Square<'_>))| {
        let (_, unit) = find_deflection_units(model, remove_play(square.base))?;
        Some(Load {
            name: name_spring(term, &square.parameters, number, is_only),
            force: format_derivative(model, summand, square),
            unit,
        })
    };
    squares.iter().enumerate().filter_map(load).collect()
}

/// Returns true if the base of a square is a deflection, or a deflection beyond a constant play.
fn is_load(model: &Model, base: &Expr) -> bool {
    let is_play = match &base.kind {
        ExprKind::Call(Function::Deadzone, arguments) => {
            (arguments[1..].iter()).all(|play| is_constant(model, play, &mut Vec::new()))
        }
        _ => true,
    };
    is_play && is_deflection(model, remove_play(base))
}

/// Returns the argument p of deadzone(p, b), or the expression itself.
fn remove_play(base: &Expr) -> &Expr {
    match &base.kind {
        ExprKind::Call(Function::Deadzone, arguments) => &arguments[0],
        _ => base,
    }
}

/// Returns the derivative of a product with respect to the base of its square, in the notation of
/// the specification.
fn format_derivative(model: &Model, product: &Expr, square: &Square<'_>) -> String {
    let source = &model.source.text;
    let part = |from: usize, to: usize| source.get(from..to).unwrap_or_default();
    let before = part(product.span.start, square.square.span.start);
    let after = part(square.square.span.end, product.span.end);
    let halved = format!("{before}{}{after}", format_expression(model, square.base));
    let halves = ["1/2*", "0.5*"].iter();
    match halves.filter_map(|half| halved.strip_prefix(half)).next() {
        Some(whole) => whole.to_owned(),
        None => format!("2*{halved}"),
    }
}

#[cfg(test)]
mod tests {
    use eomgen_model_spec::source::Source;

    use super::{Load, find_loads};

    /// Returns the loads of a mass on a spring with the given potential energy.
    fn find_loads_of_energy(energy: &str) -> Vec<Load> {
        let text = format!(
            "[model]\nname = \"one\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             k = {{ value = 2, unit = \"N/m\" }}\nn = {{ value = 3 }}\nb = {{ value = 1, unit = \"m\" }}\n\
             [coordinates]\nx = {{ unit = \"m\" }}\ny = {{ unit = \"m\" }}\n\
             [kinetic]\nm = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[potential]\nspring = \"{energy}\"\n"
        );
        let checked = eomgen_model_spec::check(Source::new("one.toml", text.as_str()));
        find_loads(&checked.unwrap_or_else(|found| panic!("{found}")).model)
    }

    #[test]
    fn load_is_derivative_of_energy_with_respect_to_deflection() {
        for (energy, force) in [
            ("1/2*k*x^2", "k*x"),
            ("0.5*k*(x - y)^2", "k*(x - y)"),
            ("3/2*k*deadzone(x, b)^2", "2*3/2*k*deadzone(x, b)"),
            ("x^2*k/n", "2*x*k/n"),
            ("k*(x - n*y)^2/2", "2*k*(x - n*y)/2"),
            ("(1/2*k)*x^2", "2*(1/2*k)*x"),
        ] {
            let found = find_loads_of_energy(energy);
            let forces: Vec<&str> = found.iter().map(|load| load.force.as_str()).collect();
            assert_eq!(forces, [force], "{energy}");
            assert_eq!((found[0].name.as_str(), found[0].unit), ("spring", "N"));
        }
        let two = find_loads_of_energy("1/2*k*x^2 + 1/2*k*n*y^2");
        let names: Vec<&str> = two.iter().map(|load| load.name.as_str()).collect();
        assert_eq!(names, ["spring_k", "spring_2"]);
        assert_eq!(find_loads_of_energy("1/4*k*x^4/b^2"), []);
        assert_eq!(find_loads_of_energy("k*x*y"), []);
    }
}
