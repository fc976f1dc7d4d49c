//! Matching of a record's columns with the quantities of a model, by names and units.

use crate::computed_observables::COMPUTED_OBSERVABLES;
use eomgen_model_spec::model::{Model, ObservedRate};
use eomgen_model_spec::suggest::nearest;
use eomgen_model_spec::unit::Unit;

const UNITS: [(&str, &str); 6] = [
    ("degree", "deg"),
    ("degrees", "deg"),
    ("sec", "s"),
    ("Nm", "N m"),
    ("mNm", "mN m"),
    ("N*m", "N m"),
];

#[derive(Clone, Debug)]
pub(crate) struct FileColumn {
    /// Number of the column, from 1.
    pub number: usize,
    /// Name in the file; "" without a name.
    pub name: String,
    pub stem: String,
    pub unit: Option<Unit>,
    pub unknown_unit: Option<String>,
}

impl FileColumn {
    pub fn from_header(number: usize, name: &str, unit: &str) -> Self {
        let (stem, inside) = split_unit(name);
        let stated: Vec<String> = [unit, inside]
            .into_iter()
            .map(strip_unit_brackets)
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

    /// If no unit is known, reads the unit from the end of the name, for example `time_ms`.
    pub fn read_unit_suffix(&mut self) {
        let Some((stem, unit)) = self.stem.rsplit_once('_') else {
            return;
        };
        let is_stated = self.unit.is_some() || self.unknown_unit.is_some();
        if let (false, Ok(unit)) = (is_stated, Unit::parse(&strip_unit_brackets(unit))) {
            self.unit = Some(unit);
            self.stem = stem.to_owned();
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Quantity {
    pub name: String,
    pub unit: Unit,
    pub is_input: bool,
    /// True if the unit of a column without a name can identify this quantity. Derivatives of observables need their
    /// name.
    is_found_by_unit: bool,
}

/// Returns inputs, observables, coordinates with rates and accelerations, and first-order states.
pub(crate) fn list_quantities(model: &Model) -> Vec<Quantity> {
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
        .filter(|observable| !COMPUTED_OBSERVABLES.contains(&observable.name.as_str()))
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
    let observed = list_observed_rates(model).map(|rate| Quantity {
        is_found_by_unit: false,
        ..quantity(&rate.name(model), &rate.unit(model), false)
    });
    let states = model.states.iter();
    let states = states.map(|state| quantity(&state.name, &state.unit, false));
    let moving = coordinates.chain(derivatives).chain(states).chain(observed);
    let mut all: Vec<Quantity> = Vec::new();
    for quantity in inputs.chain(observables).chain(moving) {
        // An observable can have the name of a coordinate.
        if all.iter().all(|known| known.name != quantity.name) {
            all.push(quantity);
        }
    }
    all
}

/// Returns rates of observables, and accelerations of observables without a rate in them.
fn list_observed_rates(model: &Model) -> impl Iterator<Item = ObservedRate> {
    (1..=2).flat_map(move |times| {
        let observables = model.observables.iter().enumerate();
        let differentiated = observables.filter(move |(_, observable)| {
            !COMPUTED_OBSERVABLES.contains(&observable.name.as_str())
                && (times == 1 || !model.contains_rate(&observable.value))
        });
        differentiated.map(move |(observable, _)| ObservedRate { observable, times })
    })
}

#[derive(Clone, Debug)]
pub(crate) struct Match {
    pub column: usize,
    pub quantity: usize,
    pub reason: &'static str,
}

type Rule = fn(&FileColumn, &Quantity) -> bool;

/// Rules in the order of their reliability.
const MATCHING_RULES: [(Rule, &str); 6] = [
    (|c, q| c.name == q.name, "the same name"),
    (|c, q| c.stem == q.name, "the same name with a unit"),
    (
        |c, q| normalise_name(&c.stem) == normalise_name(&q.name),
        "the same name except for case and signs",
    ),
    (
        |c, q| q.is_found_by_unit && contains_name(c, q),
        "guessed: the name of the column contains this name; please check",
    ),
    (
        |c, q| {
            nearest(&normalise_name(&c.stem), [normalise_name(&q.name).as_str()]).is_some()
                && c.stem.len() > 3
        },
        "a similar name: please check",
    ),
    (
        |c, q| c.unit.is_some() && !q.unit.dimension.is_dimensionless() && q.is_found_by_unit,
        "the only remaining column with this unit: please check",
    ),
];

/// Words in the names of columns that are no measurement of a quantity.
const SETPOINT_WORDS: [&str; 11] = [
    "ref",
    "reference",
    "set",
    "setpoint",
    "cmd",
    "command",
    "des",
    "desired",
    "target",
    "err",
    "error",
];

/// Returns true if the words of a column's name contain the name of a quantity, such as `F_drive`
/// for `F`. Setpoints and control errors are no channels.
fn contains_name(column: &FileColumn, quantity: &Quantity) -> bool {
    let split = |name: &str| -> Vec<String> {
        let words = name.split(|letter: char| !letter.is_alphanumeric());
        let words = words.map(normalise_name);
        words.filter(|word| !word.is_empty()).collect()
    };
    let (words, wanted) = (split(&column.stem), split(&quantity.name));
    let is_setpoint = words
        .iter()
        .any(|word| SETPOINT_WORDS.contains(&word.as_str()));
    let is_rate = |word: &String| ["dot", "ddot"].contains(&word.as_str());
    let adds_rate = words.iter().any(is_rate) && !wanted.iter().any(is_rate);
    !wanted.is_empty()
        && !adds_rate
        && (quantity.is_input || !is_setpoint)
        && words.windows(wanted.len()).any(|part| part == wanted)
}

/// Number of rules that do not guess. They are applied before units are read from the ends of names.
const EXACT_RULES: usize = 3;

/// Matches unambiguous columns and quantities: first by their whole names, then with the ends of other names read as
/// units.
pub(crate) fn match_columns(columns: &mut [FileColumn], quantities: &[Quantity]) -> Vec<Match> {
    let mut matches = Vec::new();
    apply_rules(
        &MATCHING_RULES[..EXACT_RULES],
        columns,
        quantities,
        &mut matches,
    );
    for (place, column) in columns.iter_mut().enumerate() {
        if matches.iter().all(|found| found.column != place) {
            column.read_unit_suffix();
        }
    }
    apply_rules(&MATCHING_RULES, columns, quantities, &mut matches);
    matches.sort_by_key(|found| found.quantity);
    matches
}

fn apply_rules(
    rules: &[(Rule, &'static str)],
    columns: &[FileColumn],
    quantities: &[Quantity],
    matches: &mut Vec<Match>,
) {
    for (rule, why) in rules {
        let may = |column: usize, quantity: usize| {
            let (c, q) = (&columns[column], &quantities[quantity]);
            // A column with an unknown unit can have any dimension.
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
                    reason: why,
                });
            }
        }
    }
}

/// Splits a name and its unit: `u [N m]`, `u (N m)`, `u / N` or `u/N`.
fn split_unit(name: &str) -> (&str, &str) {
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
    if let Some((stem, unit)) = name.split_once('/')
        && Unit::parse(&strip_unit_brackets(unit)).is_ok()
    {
        return (stem.trim(), unit.trim());
    }
    (name, "")
}

pub(crate) fn strip_unit_brackets(text: &str) -> String {
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
        || insert_exponents(&symbols.iter().fold(bare.to_owned(), spelt)),
        |(_, ours)| (*ours).to_owned(),
    )
}

/// Returns a unit with `^` before its exponents, from `m/s2`, `m/s²` or `m s⁻²`.
fn insert_exponents(text: &str) -> String {
    const SUPERSCRIPT_DIGITS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    let mut found = String::new();
    for letter in text.chars() {
        let raised = SUPERSCRIPT_DIGITS.chars().position(|digit| digit == letter);
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

fn normalise_name(name: &str) -> String {
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
    use super::{FileColumn, list_quantities, match_columns};

    #[test]
    fn columns_match_by_name_and_compatible_unit() {
        let source = eomgen_model_spec::models::PLANETARY_ARM_RIG.source();
        let model = eomgen_model_spec::check(source).expect("a model").model;
        let all = list_quantities(&model);
        let names = |columns: &[(&str, &str)]| -> Vec<(String, String)> {
            let mut columns: Vec<FileColumn> = (1..)
                .zip(columns)
                .map(|(number, (name, unit))| FileColumn::from_header(number, name, unit))
                .collect();
            match_columns(&mut columns, &all)
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
        // The end of a short name is a unit, not a spelling error.
        let units = |name: &str| {
            let mut columns = [FileColumn::from_header(1, name, "")];
            let found = match_columns(&mut columns, &all);
            let unit = columns[0].unit.as_ref().map(ToString::to_string);
            (found.len(), unit.unwrap_or_default())
        };
        for name in ["x_c_mm", "x_c/mm", "tip_mm", "tip (mm)", "tip / mm"] {
            assert_eq!(units(name), (1, "mm".to_owned()), "{name}");
        }
        assert_eq!(units("u_mNm"), (1, "mN m".to_owned()));
        // Accelerations do not match positions or rates in any notation of their unit.
        for unit in ["m/s2", "m/s²", "m·s⁻²", "m s-2"] {
            assert_eq!(names(&[("x_c", unit)]), [], "{unit}");
            assert_eq!(names(&[("x_c_ddot", unit)]), [pair("x_c_ddot", "x_c_ddot")]);
        }
        assert_eq!(names(&[("x_c [furlong]", ""), ("x_c_dot", "knots")]), []);
        assert_eq!(names(&[("x_c_ddot", "")]), [pair("x_c_ddot", "x_c_ddot")]);
        // Derivatives of observables match only by name.
        assert_eq!(
            names(&[("tip_ddot", "m/s2"), ("Theta_s_dot", "deg/s")]),
            [
                pair("Theta_s_dot", "theta_s_dot"),
                pair("tip_ddot", "tip_ddot")
            ]
        );
        assert_eq!(names(&[("a", "m/s2")]), []);
        // A name inside a longer name is a guess.
        assert_eq!(names(&[("u_drive", "")]), [pair("u_drive", "u")]);
        assert_eq!(
            names(&[("theta_s.motor", "")]),
            [pair("theta_s.motor", "theta_s")]
        );
        assert_eq!(
            names(&[("theta_s_ref", ""), ("u_left", ""), ("u_right", "")]),
            []
        );
        // Ambiguous columns do not match.
        assert!(names(&[("thetas", "m"), ("note", "")]).is_empty());
        assert!(names(&[("THETA_S", ""), ("theta s", "")]).is_empty());
    }
}
