//! Which column of a record is which quantity of a model, by their names and units.

use eomgen_model_spec::model::{Model, ObservedRate};
use eomgen_model_spec::suggest::nearest;
use eomgen_model_spec::unit::Unit;

/// How people write units that are written otherwise here.
const UNITS: [(&str, &str); 6] = [
    ("degree", "deg"),
    ("degrees", "deg"),
    ("sec", "s"),
    ("Nm", "N m"),
    ("mNm", "mN m"),
    ("N*m", "N m"),
];

/// A column as its file describes it.
#[derive(Clone, Debug)]
pub(crate) struct FileColumn {
    /// Its number, from 1.
    pub number: usize,
    /// Its name, as it stands there; "" where there is none.
    pub name: String,
    /// The name without a unit in it.
    pub stem: String,
    /// Its unit, if the file states one that is known.
    pub unit: Option<Unit>,
    /// What the file states as its unit, if that is not known.
    pub unknown_unit: Option<String>,
}

impl FileColumn {
    /// A column of a file by its name and by what stands in its line of units.
    pub fn of(number: usize, name: &str, unit: &str) -> Self {
        let (stem, inside) = parted(name);
        let stated: Vec<String> = [unit, inside]
            .into_iter()
            .map(bare_unit)
            .filter(|text| !text.is_empty() && text != "-")
            .collect();
        let unit = stated.iter().find_map(|text| Unit::parse(text).ok());
        Self {
            number,
            name: name.to_owned(),
            stem: stem.to_owned(),
            unknown_unit: stated.into_iter().next().filter(|_| unit.is_none()),
            unit,
        }
    }

    /// Takes the end of a name for a unit, as in `time_ms`, if it is one and none is known.
    pub fn take_suffix(&mut self) {
        let Some((stem, unit)) = self.stem.rsplit_once('_') else {
            return;
        };
        let is_stated = self.unit.is_some() || self.unknown_unit.is_some();
        if let (false, Ok(unit)) = (is_stated, Unit::parse(&bare_unit(unit))) {
            self.unit = Some(unit);
            self.stem = stem.to_owned();
        }
    }
}

/// A quantity of a model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
    /// Whether it is an input.
    pub is_input: bool,
    /// True if a unit may identify it without a name; derivatives of observables need theirs.
    is_found_by_unit: bool,
}

/// Inputs, observables and coordinates with their rates and accelerations, and states of first order.
pub(crate) fn quantities(model: &Model) -> Vec<Quantity> {
    let quantity = |name: &str, unit: &Unit, is_input: bool| Quantity {
        name: name.to_owned(),
        unit: unit.clone(),
        is_input,
        is_found_by_unit: true,
    };
    let own = model.inputs.iter().filter(|input| input.rate_of.is_none());
    let inputs = own.map(|input| quantity(&input.name, &input.unit, true));
    let observables = model.observables.iter();
    let observables = observables
        .filter(|observable| !["energy", "power"].contains(&observable.name.as_str()))
        .map(|observable| quantity(&observable.name, &observable.unit, false));
    let coordinates = model.coordinates.iter();
    let coordinates = coordinates.map(|c| quantity(&c.name, &c.unit, false));
    let derivatives = [("dot", "s"), ("ddot", "s^2")];
    let derivatives = derivatives.into_iter().flat_map(|(name, per)| {
        model.coordinates.iter().filter_map(move |c| {
            let unit = Unit::parse(&format!("{}/{per}", c.unit)).ok()?;
            Some(quantity(&format!("{}_{name}", c.name), &unit, false))
        })
    });
    let observed = derivatives_of_observables(model).map(|rate| Quantity {
        is_found_by_unit: false,
        ..quantity(&rate.name(model), &rate.unit(model), false)
    });
    let states = model.states.iter();
    let states = states.map(|state| quantity(&state.name, &state.unit, false));
    let moving = coordinates.chain(derivatives).chain(states).chain(observed);
    let mut all: Vec<Quantity> = Vec::new();
    for quantity in inputs.chain(observables).chain(moving) {
        // An observable may have the name of a coordinate.
        if all.iter().all(|known| known.name != quantity.name) {
            all.push(quantity);
        }
    }
    all
}

/// Rates and accelerations of observables. The acceleration of an observable that holds a rate does not exist.
fn derivatives_of_observables(model: &Model) -> impl Iterator<Item = ObservedRate> {
    (1..=2).flat_map(move |times| {
        let observables = model.observables.iter().enumerate();
        let differentiated = observables.filter(move |(_, observable)| {
            !["energy", "power"].contains(&observable.name.as_str())
                && (times == 1 || !model.holds_rate(&observable.value))
        });
        differentiated.map(move |(observable, _)| ObservedRate { observable, times })
    })
}

/// A column that was matched, and why.
#[derive(Clone, Debug)]
pub(crate) struct Match {
    /// The column's place among the columns.
    pub column: usize,
    /// The quantity's place among the quantities.
    pub quantity: usize,
    /// Why.
    pub why: &'static str,
}

/// A rule by which a column may be a quantity.
type Rule = fn(&FileColumn, &Quantity) -> bool;

/// The rules, the surest first.
const RULES: [(Rule, &str); 5] = [
    (|c, q| c.name == q.name, "the same name"),
    (|c, q| c.stem == q.name, "the same name beside a unit"),
    (
        |c, q| plain(&c.stem) == plain(&q.name),
        "the same name but for capitals and signs",
    ),
    (
        |c, q| nearest(&plain(&c.stem), [plain(&q.name).as_str()]).is_some() && c.stem.len() > 3,
        "a name that is nearly the same: please check",
    ),
    (
        |c, q| c.unit.is_some() && !q.unit.dimension.is_none() && q.is_found_by_unit,
        "the only one left with this unit: please check",
    ),
];

/// Matches columns and quantities, each once. Where several would do, none is taken. What is left
/// is tried with the end of its name as a unit.
pub(crate) fn matched(columns: &mut [FileColumn], quantities: &[Quantity]) -> Vec<Match> {
    let mut matches = Vec::new();
    by_rules(columns, quantities, &mut matches);
    for (place, column) in columns.iter_mut().enumerate() {
        if matches.iter().all(|found| found.column != place) {
            column.take_suffix();
        }
    }
    by_rules(columns, quantities, &mut matches);
    matches.sort_by_key(|found| found.quantity);
    matches
}

/// Adds what the rules find among columns and quantities that are free.
fn by_rules(columns: &[FileColumn], quantities: &[Quantity], matches: &mut Vec<Match>) {
    for (rule, why) in RULES {
        let may = |column: usize, quantity: usize| {
            let (c, q) = (&columns[column], &quantities[quantity]);
            // A unit that is not known may be of any dimension.
            let of_unit = match (&c.unit, &c.unknown_unit) {
                (Some(unit), _) => unit.dimension == q.unit.dimension,
                (None, unknown) => unknown.is_none(),
            };
            of_unit && !(c.name.is_empty() && c.unit.is_none()) && rule(c, q)
        };
        let free = |matches: &[Match], column: usize, quantity: usize| {
            let taken = |m: &Match| m.column == column || m.quantity == quantity;
            !matches.iter().any(taken)
        };
        let before = matches.clone();
        for column in 0..columns.len() {
            let fits =
                |quantity: &usize| free(&before, column, *quantity) && may(column, *quantity);
            let mut fitting = (0..quantities.len()).filter(fits);
            let (Some(quantity), None) = (fitting.next(), fitting.next()) else {
                continue;
            };
            let others = (0..columns.len()).filter(|other| {
                *other != column && free(&before, *other, quantity) && may(*other, quantity)
            });
            if others.count() == 0 {
                matches.push(Match {
                    column,
                    quantity,
                    why,
                });
            }
        }
    }
}

/// A name and the unit in it: `u [N m]`, `u (N m)` or `u / N`.
fn parted(name: &str) -> (&str, &str) {
    for (opening, closing) in [('[', ']'), ('(', ')')] {
        if let Some((stem, rest)) = name.split_once(opening)
            && let Some(unit) = rest.trim_end().strip_suffix(closing)
        {
            return (stem.trim(), unit.trim());
        }
    }
    if let Some((stem, unit)) = name.split_once(" / ") {
        return (stem.trim(), unit.trim());
    }
    (name, "")
}

/// A unit without brackets, as it is written here.
pub(crate) fn bare_unit(text: &str) -> String {
    let bare = text.trim().trim_matches(['[', ']', '(', ')']).trim();
    let known = UNITS.iter().find(|(theirs, _)| *theirs == bare);
    let symbols = [
        ("°", "deg"),
        ("µ", "u"),
        ("μ", "u"),
        ("Ω", "ohm"),
        ("·", " "),
        ("⋅", " "),
    ];
    let spelt = |text: String, (theirs, ours): &(&str, &str)| text.replace(theirs, ours);
    known.map_or_else(
        || with_exponents(&symbols.iter().fold(bare.to_owned(), spelt)),
        |(_, ours)| (*ours).to_owned(),
    )
}

/// A unit with `^` before its exponents, which others write as `m/s2`, `m/s²` or `m s⁻²`.
fn with_exponents(text: &str) -> String {
    const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let mut found = String::new();
    for letter in text.chars() {
        let raised = RAISED.chars().position(|digit| digit == letter);
        let digit = raised.and_then(|digit| char::from_digit(digit as u32, 10));
        let letter = match letter {
            '⁻' | '−' => '-',
            letter => digit.unwrap_or(letter),
        };
        let follows_a_name = found.chars().last().is_some_and(char::is_alphabetic);
        if follows_a_name && (letter == '-' || letter.is_ascii_digit()) {
            found.push('^');
        }
        found.push(letter);
    }
    found
}

/// A name without what people write differently.
fn plain(name: &str) -> String {
    const GREEK: [(char, &str); 9] = [
        ('θ', "theta"),
        ('φ', "phi"),
        ('ϕ', "phi"),
        ('ψ', "psi"),
        ('α', "alpha"),
        ('β', "beta"),
        ('ω', "omega"),
        ('τ', "tau"),
        ('γ', "gamma"),
    ];
    let mut found = String::new();
    for letter in name.chars().flat_map(char::to_lowercase) {
        match GREEK.iter().find(|(greek, _)| *greek == letter) {
            Some((_, word)) => found += word,
            None if letter.is_alphanumeric() => found.push(letter),
            None => {}
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{FileColumn, matched, quantities};

    #[test]
    fn columns_are_matched_by_name_and_unit_and_never_against_a_unit() {
        let source = eomgen_model_spec::models::PLANETARY_ARM_RIG.source();
        let model = eomgen_model_spec::check(source).expect("a model").model;
        let all = quantities(&model);
        let names = |columns: &[(&str, &str)]| -> Vec<(String, String)> {
            let mut columns: Vec<FileColumn> = (1..)
                .zip(columns)
                .map(|(number, (name, unit))| FileColumn::of(number, name, unit))
                .collect();
            matched(&mut columns, &all)
                .into_iter()
                .map(|m| (columns[m.column].name.clone(), all[m.quantity].name.clone()))
                .collect()
        };
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(
            names(&[
                ("U [Nm]", ""),
                ("θ_s (°)", ""),
                ("Theta-C", "rad"),
                ("tip", "V")
            ]),
            [
                pair("U [Nm]", "u"),
                pair("θ_s (°)", "theta_s"),
                pair("Theta-C", "theta_c")
            ]
        );
        assert_eq!(
            names(&[("theta_s", ""), ("theta_c_deg", ""), ("TIP_mm", "")]),
            [
                pair("theta_s", "theta_s"),
                pair("theta_c_deg", "theta_c"),
                pair("TIP_mm", "tip")
            ]
        );
        // Accelerations are neither positions nor rates, however their unit is written.
        for unit in ["m/s2", "m/s²", "m·s⁻²", "m s-2"] {
            assert_eq!(names(&[("x_c", unit)]), [], "{unit}");
            assert_eq!(names(&[("x_c_ddot", unit)]), [pair("x_c_ddot", "x_c_ddot")]);
        }
        assert_eq!(names(&[("x_c [furlong]", ""), ("x_c_dot", "knots")]), []);
        assert_eq!(names(&[("x_c_ddot", "")]), [pair("x_c_ddot", "x_c_ddot")]);
        // Derivatives of observables are found only by their names.
        assert_eq!(
            names(&[("tip_ddot", "m/s2"), ("Theta_s_dot", "deg/s")]),
            [
                pair("Theta_s_dot", "theta_s_dot"),
                pair("tip_ddot", "tip_ddot")
            ]
        );
        assert_eq!(names(&[("a", "m/s2")]), []);
        // Two columns that would do are none.
        assert!(names(&[("thetas", "m"), ("note", "")]).is_empty());
        assert!(names(&[("THETA_S", ""), ("theta s", "")]).is_empty());
    }
}
