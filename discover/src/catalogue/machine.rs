//! Weight of the whole machine: first moments of the masses in the kinetic energy along fixed
//! directions. One unknown acceleration of gravity acts on all of them.
//!
//! A mass `m` with `1/2*m*v^2` has the position p with v = dp/dt. Two forms of v are read:
//!
//! - sums of rates of lengths, such as `dot(x)`: p is the sum of the lengths, and the squares of a
//!   mass are its directions x, y, z in their order;
//! - `a*dot(theta) + dot(w)` with a deflection `w` across a line that turns by `theta`: p has the
//!   components `a*cos(theta) - w*sin(theta)` and `a*sin(theta) + w*cos(theta)`.

use std::collections::BTreeSet;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use crate::catalogue::effect::SiteKind;
use crate::catalogue::products::split_sum;
use crate::catalogue::site::{Site, format_expression};
use crate::catalogue::springs::dimension;

/// Name of the site.
const MACHINE_SITE: &str = "machine";

/// Placeholders of the first moments along x, y and z.
const MOMENT_PLACEHOLDERS: [&str; 3] = ["moment_x", "moment_y", "moment_z"];

/// Position of a mass, derived from its velocity.
enum MassPosition {
    /// Sum of lengths, along one direction.
    Length(String),
    /// Point at a distance from the origin of a rotating line.
    Turning {
        root: String,
        lever: String,
        deflection: Option<String>,
    },
    /// The velocity is the component along a rotating line, of a point beside this line.
    AlongLine,
}

/// Mass in the kinetic energy, or mass per length in an integral.
struct Mass<'m> {
    /// Bases of the squares of the velocity.
    velocities: Vec<&'m Expr>,
    /// Texts before and after the sum of squares.
    around: [String; 2],
    /// Number in front of the sum of squares.
    number: f64,
}

/// Returns the machine as a site for its weight. `None` if the position of a mass is unknown or the
/// model has an acceleration of gravity, which may be a shifted parameter. Also `None` if the
/// weight along each direction acts on a single coordinate: it is then equivalent to a force or an
/// unbalance.
pub(super) fn find_machine(model: &Model) -> Option<Site> {
    if has_weight(model) {
        return None;
    }
    let terms = model.kinetic.iter().map(|term| &term.value);
    let summands: Vec<&Expr> = terms.flat_map(split_sum).collect();
    let mut moments: [Vec<String>; 3] = Default::default();
    let mut moving: [BTreeSet<String>; 3] = Default::default();
    for summand in summands {
        let mass = find_mass(model, summand)?;
        let first = mass.velocities.first()?;
        let dimension = dimension(model, first)?;
        // A moment of inertia has no weight. A factor other than 1/2 means several masses around an
        // axis, which balance each other.
        if dimension == Dimension::DIMENSIONLESS || mass.number != 0.5 {
            continue;
        }
        if dimension != Dimension::LENGTH {
            return None;
        }
        let positions = find_positions(model, &mass)?;
        for (moment, position) in moments.iter_mut().zip(&positions) {
            let [before, after] = &mass.around;
            let product = format!("{before}({position}){after}");
            moment.push(match product.strip_prefix("1/2*") {
                Some(whole) => whole.to_owned(),
                None => format!("2*{product}"),
            });
        }
        let turns = mass.velocities.len() < positions.len();
        for (place, velocity) in mass.velocities.iter().enumerate() {
            match turns {
                true => moving[..2]
                    .iter_mut()
                    .for_each(|found| list_moving(model, velocity, found)),
                false => list_moving(model, velocity, &mut moving[place]),
            }
        }
    }
    let along = MOMENT_PLACEHOLDERS.iter().zip(moments);
    let along = along.filter(|(_, moment)| !moment.is_empty());
    moving.iter().any(|found| found.len() > 1).then(|| Site {
        kind: SiteKind::Machine,
        name: MACHINE_SITE.to_owned(),
        arguments: (along.map(|(key, moment)| (*key, moment.join(" + ")))).collect(),
        terms: Vec::new(),
        dampers: Vec::new(),
    })
}

/// Adds the coordinates and fields of an expression, with definitions expanded.
fn list_moving(model: &Model, expr: &Expr, found: &mut BTreeSet<String>) {
    expr.visit(&mut |part| match part.kind {
        ExprKind::Coordinate(_) | ExprKind::Field(_) | ExprKind::ModeCoordinate(_) => {
            found.insert(format_expression(model, part));
        }
        ExprKind::Definition(id) => list_moving(model, &model.definitions[id].value, found),
        _ => {}
    });
}

/// Returns true if a potential energy contains an acceleration among its parameters.
fn has_weight(model: &Model) -> bool {
    let speed = Dimension::LENGTH.divide(Dimension::TIME);
    let acceleration = speed.and_then(|speed| speed.divide(Dimension::TIME));
    let mut found = false;
    for term in &model.potential {
        term.value.visit(&mut |part| {
            if let ExprKind::Parameter(id) = part.kind {
                found |= Some(model.parameters[id].unit.dimension) == acceleration;
            }
        });
    }
    found
}

/// Returns the only sum of squares in a product, with the factors around it.
fn find_mass<'m>(model: &Model, summand: &'m Expr) -> Option<Mass<'m>> {
    let mut number = 1.0;
    let squares = find_squares(summand, &mut number)?;
    let base = |square: &&'m Expr| match &square.kind {
        ExprKind::Binary(BinaryOperator::Power, base, exponent)
            if exponent.kind == ExprKind::Number(2.0) =>
        {
            Some(&**base)
        }
        _ => None,
    };
    let velocities: Option<Vec<&Expr>> = split_sum(squares).iter().map(base).collect();
    let text = &model.source.text;
    let (whole, own) = (summand.span, squares.span);
    let part = |from: usize, to: usize| text.get(from..to).map(str::to_owned);
    Some(Mass {
        velocities: velocities?,
        around: [
            part(whole.start, own.start)?.trim_start().to_owned(),
            part(own.end, whole.end)?,
        ],
        number,
    })
}

/// Returns the variable factor of a product, or of an integral of a product. `number` is multiplied
/// by the numbers among the other factors.
fn find_squares<'m>(product: &'m Expr, number: &mut f64) -> Option<&'m Expr> {
    match &product.kind {
        ExprKind::Integral { integrand, .. } => find_squares(integrand, number),
        ExprKind::Binary(
            operator @ (BinaryOperator::Multiply | BinaryOperator::Divide),
            left,
            right,
        ) => match (is_fixed(left), is_fixed(right), operator) {
            (false, true, BinaryOperator::Multiply) => {
                *number *= multiply_numbers(right);
                find_squares(left, number)
            }
            (false, true, _) => {
                *number /= multiply_numbers(right);
                find_squares(left, number)
            }
            (true, false, BinaryOperator::Multiply) => {
                *number *= multiply_numbers(left);
                find_squares(right, number)
            }
            _ => None,
        },
        _ => Some(product),
    }
}

/// Returns the product of the numbers among the factors of a product.
fn multiply_numbers(expr: &Expr) -> f64 {
    match &expr.kind {
        ExprKind::Number(value) => *value,
        ExprKind::Binary(BinaryOperator::Multiply, left, right) => {
            multiply_numbers(left) * multiply_numbers(right)
        }
        ExprKind::Binary(BinaryOperator::Divide, left, right) => {
            multiply_numbers(left) / multiply_numbers(right)
        }
        _ => 1.0,
    }
}

/// Returns true if an expression contains only parameters, numbers and the position along a field.
fn is_fixed(expr: &Expr) -> bool {
    let mut is_fixed = true;
    expr.visit(&mut |part| {
        is_fixed &= matches!(
            part.kind,
            ExprKind::Number(_)
                | ExprKind::Pi
                | ExprKind::Parameter(_)
                | ExprKind::Position(_)
                | ExprKind::Negate(_)
                | ExprKind::Binary(..)
        );
    });
    is_fixed
}

/// Returns the position of a mass along x, y and z, for the directions in which it moves.
fn find_positions(model: &Model, mass: &Mass<'_>) -> Option<Vec<String>> {
    let velocities = mass.velocities.iter();
    let places: Option<Vec<MassPosition>> =
        velocities.map(|of| find_mass_position(model, of)).collect();
    let mut places = places?;
    places.retain(|place| !matches!(place, MassPosition::AlongLine));
    if let [
        MassPosition::Turning {
            root,
            lever,
            deflection,
        },
    ] = &places[..]
    {
        let (along, across) = (format!("cos({root})"), format!("sin({root})"));
        return Some(match deflection {
            Some(w) => vec![
                format!("{lever}*{along} - ({w})*{across}"),
                format!("{lever}*{across} + ({w})*{along}"),
            ],
            None => vec![format!("{lever}*{along}"), format!("{lever}*{across}")],
        });
    }
    let lengths = places.into_iter().map(|place| match place {
        MassPosition::Length(length) => Some(length),
        MassPosition::Turning { .. } | MassPosition::AlongLine => None,
    });
    lengths
        .collect::<Option<Vec<String>>>()
        .filter(|lengths| lengths.len() <= 3)
}

/// Returns the position of a mass with a given velocity.
fn find_mass_position(model: &Model, velocity: &Expr) -> Option<MassPosition> {
    let (mut turning, mut lengths, mut is_deflection) = (None, Vec::new(), true);
    let mut parts = Vec::new();
    split_signed(velocity, false, &mut parts);
    for (is_negative, part) in &parts {
        let rates = list_rates(part);
        let [rate] = rates[..] else { return None };
        if dimension(model, rate)? == Dimension::DIMENSIONLESS {
            let lever = find_lever(part)?;
            if contains_field(model, lever) && parts.len() == 1 {
                return Some(MassPosition::AlongLine);
            }
            if turning.is_some() || *is_negative || !is_fixed(lever) {
                return None;
            }
            turning = Some((name_rate(model, rate), format_expression(model, lever)));
        } else {
            is_deflection &= contains_field(model, rate);
            let sign = if *is_negative { "-" } else { "+" };
            lengths.push(format!("{sign} {}", find_length(model, part, rate)?));
        }
    }
    let length = lengths.join(" ");
    let length = length.strip_prefix("+ ").unwrap_or(&length).to_owned();
    match turning {
        None => Some(MassPosition::Length(length)),
        // A deflection is measured perpendicular to the line; a coordinate may have any direction.
        Some((root, lever)) if is_deflection => Some(MassPosition::Turning {
            root,
            lever,
            deflection: (!lengths.is_empty()).then_some(length),
        }),
        Some(_) => None,
    }
}

/// Appends the summands of a sum with their signs.
fn split_signed<'m>(expr: &'m Expr, is_negative: bool, found: &mut Vec<(bool, &'m Expr)>) {
    match &expr.kind {
        ExprKind::Binary(BinaryOperator::Add, left, right) => {
            split_signed(left, is_negative, found);
            split_signed(right, is_negative, found);
        }
        ExprKind::Binary(BinaryOperator::Subtract, left, right) => {
            split_signed(left, is_negative, found);
            split_signed(right, !is_negative, found);
        }
        _ => found.push((is_negative, expr)),
    }
}

/// Returns the quantities whose rates an expression contains.
fn list_rates(expr: &Expr) -> Vec<&Expr> {
    match &expr.kind {
        ExprKind::Dot(of) => vec![of],
        ExprKind::Binary(_, left, right) => [list_rates(left), list_rates(right)].concat(),
        ExprKind::At { value, .. } => list_rates(value),
        ExprKind::Sum { summand, .. } => list_rates(summand),
        ExprKind::Negate(inner) => list_rates(inner),
        _ => Vec::new(),
    }
}

/// Returns the factor of a rate in a product of two.
fn find_lever(product: &Expr) -> Option<&Expr> {
    let ExprKind::Binary(BinaryOperator::Multiply, left, right) = &product.kind else {
        return None;
    };
    match (&left.kind, &right.kind) {
        (ExprKind::Dot(_), _) => Some(right),
        (_, ExprKind::Dot(_)) => Some(left),
        _ => None,
    }
}

/// Returns true if an expression contains a field, with definitions expanded.
fn contains_field(model: &Model, expr: &Expr) -> bool {
    let mut found = false;
    expr.visit(&mut |part| match part.kind {
        ExprKind::Field(_) | ExprKind::ModeCoordinate(_) => found = true,
        ExprKind::Definition(id) => found |= contains_field(model, &model.definitions[id].value),
        _ => {}
    });
    found
}

/// Returns a quantity in the notation of the specification; for a component of a vector, its name.
fn name_rate(model: &Model, of: &Expr) -> String {
    match of.kind {
        ExprKind::Definition(id) => model.definitions[id].name.clone(),
        _ => format_expression(model, of),
    }
}

/// Returns the length whose rate is a constant multiple of the given rate; `None` if the factor is
/// variable.
fn find_length(model: &Model, part: &Expr, rate: &Expr) -> Option<String> {
    let (mut dots, mut moving) = (Vec::new(), 0);
    part.visit(&mut |inner| match &inner.kind {
        ExprKind::Dot(_) => dots.push(inner.span),
        ExprKind::Field(_)
        | ExprKind::ModeCoordinate(_)
        | ExprKind::Coordinate(_)
        | ExprKind::Definition(_) => moving += 1,
        ExprKind::Call(..) | ExprKind::Time => moving += 2,
        _ => {}
    });
    let ([dot], 1) = (&dots[..], moving) else {
        return None;
    };
    let before = model.source.text.get(part.span.start..dot.start)?;
    let after = model.source.text.get(dot.end..part.span.end)?;
    let length = format!("{before}{}{after}", name_rate(model, rate));
    Some(length.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use eomgen_model_spec::source::Source;

    use super::find_machine;

    /// Returns the first moments of a machine with the given kinetic energy and with pairs of
    /// masses.
    fn find_moments(kinetic: &str) -> Option<Vec<(&'static str, String)>> {
        let text = format!(
            "[model]\nname = \"one\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
             J = {{ value = 1, unit = \"kg m^2\" }}\nmu = {{ value = 1, unit = \"kg/m\" }}\n\
             l = {{ value = 1, unit = \"m\" }}\n[coordinates]\nx = {{ unit = \"m\" }}\n\
             y = {{ unit = \"m\" }}\ntheta = {{ unit = \"rad\" }}\n[fields.w]\nalong = \"s\"\nfrom = 0\n\
             to = \"l\"\nbasis = \"clamped_free\"\ncoordinates = \"p\"\norder = 2\nunit = \"m\"\n\
             [kinetic]\nrest = \"1/2*J*dot(theta)^2 + m*dot(x)^2 + m*dot(y)^2 + integral(mu*dot(w)^2, w)\"\n{kinetic}\n"
        );
        let checked = eomgen_model_spec::check(Source::new("one.toml", text.as_str()));
        let model = checked.unwrap_or_else(|found| panic!("{found}")).model;
        Some(find_machine(&model)?.arguments.into_iter().collect())
    }

    #[test]
    fn moments_of_an_arm_follow_from_the_velocities_of_beam_and_payload() {
        let beam = "beam = \"1/2*integral(mu*(s*dot(theta) + dot(w))^2, w)\"";
        let load = "load = \"1/2*m*(l*dot(theta) + at(dot(w), l))^2\"";
        let found = find_moments(&format!("{beam}\n{load}"));
        let x = "integral(mu*(s*cos(theta) - (w)*sin(theta)), w) + m*(l*cos(theta) - (at(w, l))*sin(theta))";
        let y = "integral(mu*(s*sin(theta) + (w)*cos(theta)), w) + m*(l*sin(theta) + (at(w, l))*cos(theta))";
        let expected = [("moment_x", x.to_owned()), ("moment_y", y.to_owned())];
        assert_eq!(found, Some(expected.to_vec()));
        // The velocity along the line belongs to the same position.
        let exact = "beam = \"1/2*integral(mu*((s*dot(theta) + dot(w))^2 + (w*dot(theta))^2), w)\"";
        assert_eq!(
            find_moments(&format!("{exact}\n{load}")),
            Some(expected.to_vec())
        );
    }

    #[test]
    fn moments_of_masses_that_translate_are_sums_of_their_coordinates() {
        let found = find_moments("a = \"1/2*m*dot(x)^2\"\nb = \"m*(dot(x) - dot(y))^2/2\"");
        let x = "m*(x) + 2*m*(x - y)/2".to_owned();
        assert_eq!(found, Some(vec![("moment_x", x)]));
        let found = find_moments("a = \"1/2*m*((dot(x) + dot(y))^2 + dot(y)^2)\"");
        let moments = [("moment_x", "m*(x + y)"), ("moment_y", "m*(y)")];
        let moments = moments.map(|(key, moment)| (key, moment.to_owned()));
        assert_eq!(found, Some(moments.to_vec()));
    }

    #[test]
    fn machine_needs_several_coordinates_and_known_positions() {
        for kinetic in [
            // A single mass, or two masses on one coordinate.
            "a = \"1/2*m*dot(x)^2\"",
            "a = \"1/2*m*dot(x)^2\"\nb = \"1/2*m*(2*dot(x))^2\"",
            // Each direction has a different coordinate.
            "a = \"1/2*m*dot(x)^2\"\nb = \"1/2*m*(dot(x)^2 + dot(y)^2)\"",
            // Three masses around an axis.
            "a = \"3/2*m*(l*dot(theta))^2\"\nb = \"1/2*m*dot(x)^2\"",
            // The direction of x relative to the line is unknown.
            "a = \"1/2*m*(l*dot(theta) + dot(x))^2\"\nb = \"1/2*m*dot(x)^2\"",
        ] {
            assert_eq!(find_moments(kinetic), None, "{kinetic}");
        }
    }
}
