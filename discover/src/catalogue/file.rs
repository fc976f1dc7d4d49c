//! Reader of an effects file. It checks all keywords, keys and placeholders; the edits are checked
//! later at each site.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::quantity::{Name, StringValue};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::table::Entry;
use eomgen_model_spec::toml_file;

use super::change::read_change;
use super::effect::{DAMPER_PLACEHOLDER, Effect, EffectParameter, Shape, ShapeScale, SiteKind};
use super::fields::{read_new_name, read_nonempty_list, read_text};
use super::placeholders::Placeholders;

/// Reads an effects file.
///
/// # Errors
///
/// All errors in the file.
pub fn read_effects(source: &Source) -> Result<Vec<Effect>, Diagnostics> {
    toml_file::read(source, |entries, found| {
        let file = Name {
            text: "the effects file".to_owned(),
            span: Span::new(0, 0),
        };
        let top = Record::with_keys(file, entries.to_vec(), &["effect"], found).as_file();
        let list = top.require_with("effect", "begin each effect with [[effect]]", found)?;
        let list = found.push_error(list.list("[[effect]]"))?;
        Some(
            list.iter()
                .filter_map(|entry| read_effect(entry, found))
                .collect(),
        )
    })
}

fn read_effect(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Effect> {
    let known = [
        "name",
        "site",
        "says",
        "experiment",
        "orders",
        "loads",
        "parameters",
        "edits",
    ];
    let record = Record::read_with(entry, &known, "{ name = \"my_effect\" }", found)?;
    let name = read_text(&record, "name", "\"my_effect\"", found);
    let says = read_text(&record, "says", "\"a friction of ...\"", found);
    let experiment = read_text(&record, "experiment", "\"slow motions\"", found);
    let site = record.require_with("site", "write site = \"axis\"", found);
    let site = site.cloned().map(|site| site.keyword(&SiteKind::KEYWORDS));
    let site = site.and_then(|site| found.push_error(site));
    let orders = read_flag(&record, "orders", found);
    let loads = read_flag(&record, "loads", found);
    let parameters = read_nonempty_list(&record, "parameters", "[{ name = ... }]", found)?;
    let edits = read_nonempty_list(&record, "edits", "[{ add = \"force\", ... }]", found)?;
    let (site, orders, loads) = (site?, orders?, loads?);
    let own: Vec<StringValue> = (parameters.iter().chain(&edits))
        .filter_map(|entry| read_name(entry))
        .collect();
    let of_site = site.placeholders().iter().map(|blank| (*blank).to_owned());
    let of_site: Vec<String> = of_site.collect();
    let is_taken = |name: &str| {
        of_site.iter().any(|blank| blank == name)
            || (site == SiteKind::Spring && name == DAMPER_PLACEHOLDER)
    };
    for name in own.iter().filter(|own| is_taken(&own.text)) {
        let wrong = format!("{} is a placeholder of this site", quote(&name.text));
        found.push(Diagnostic::error(wrong).with_span(name.span, "expected another name"));
    }
    let repeating: &[&str] = match (orders, site) {
        (true, SiteKind::Mesh) => &["n", "angle"],
        (true, _) => &["n"],
        (false, _) => &[],
    };
    let of_load: &[&str] = match loads {
        true => &["load", "per_load"],
        false => &[],
    };
    if loads
        && !matches!(site, SiteKind::Axis | SiteKind::Angle)
        && let Some(loads) = record.get("loads")
    {
        let wrong = Diagnostic::error("`loads` needs a site that is an axis or an angle");
        let expected = "expected site = \"axis\" or site = \"angle\"";
        found.push(wrong.with_span(loads.span(), expected));
    }
    let mut placeholders = Placeholders {
        known: of_site
            .into_iter()
            .chain((repeating.iter().chain(of_load)).map(|blank| (*blank).to_owned()))
            .chain(own.iter().map(|own| own.text.clone()))
            .collect(),
        used: Vec::new(),
    };
    let mut listed = Vec::new();
    for entry in &parameters {
        listed.extend(read_parameter(entry, &mut placeholders, found));
    }
    let mut changes = Vec::new();
    for entry in &edits {
        changes.extend(read_change(entry, site, &mut placeholders, found));
    }
    for parameter in parameters.iter().filter_map(read_name) {
        if !placeholders.used.contains(&parameter.text) {
            found.push(
                Diagnostic::error(format!("{} is not used", quote(&parameter.text)))
                    .with_span(parameter.span, "no edit contains it")
                    .with_help(format!("write {{{}}} in an edit", parameter.text)),
            );
        }
    }
    Some(Effect {
        name: name?.text,
        site_kind: site,
        description: says?.text,
        experiment: experiment?.text,
        has_orders: orders,
        has_loads: loads,
        parameters: listed,
        edits: changes,
        is_user_defined: false,
    })
}

/// Reads a boolean key; false if absent.
fn read_flag(record: &Record<'_>, key: &str, found: &mut Diagnostics) -> Option<bool> {
    let truth = record.get(key).map(|entry| entry.boolean());
    truth.map_or(Some(false), |truth| found.push_error(truth))
}

/// Reads a name of a parameter or addition that other texts may use.
fn read_name(entry: &Entry<'_>) -> Option<StringValue> {
    let entries = entry.table("").ok()?;
    let of = |key: &str| entries.iter().find(|e| e.name.text == key)?.written().ok();
    match of("add") {
        Some(add) if !["coordinate", "definition", "state"].contains(&add.text.as_str()) => None,
        _ => of("name"),
    }
}

fn read_parameter(
    entry: &Entry<'_>,
    placeholders: &mut Placeholders,
    found: &mut Diagnostics,
) -> Option<EffectParameter> {
    let known = ["name", "unit", "sign", "doc", "inverse", "scale", "share"];
    let record = Record::read_with(entry, &known, "{ name = \"T_c\", ... }", found)?;
    let name = read_new_name(&record, found);
    let unit = read_text(&record, "unit", "\"{force}\"", found);
    if let Some(unit) = &unit {
        placeholders.check_placeholders(unit, found);
    }
    let doc = read_text(&record, "doc", "\"dry friction\"", found);
    let sign = record.require_with(
        "sign",
        "write sign = \"+\", or \"\" if it may be negative",
        found,
    );
    let sign = sign
        .cloned()
        .map(|sign| sign.keyword(&[("+", true), ("", false)]));
    let positive = sign.and_then(|sign| found.push_error(sign));
    let inverse = read_flag(&record, "inverse", found);
    Some(EffectParameter {
        name: name?,
        unit: unit?.text,
        is_positive: positive?,
        doc: doc?.text,
        is_inverse: inverse?,
        shape: read_shape(&record, found),
    })
}

/// Reads the scale of a parameter: a quantity of the motion at the site and a fraction of it.
fn read_shape(record: &Record<'_>, found: &mut Diagnostics) -> Option<Shape> {
    let (scale, share) = (record.get("scale"), record.get("share"));
    let word = match scale {
        Some(scale) => Some(found.push_error(scale.clone().keyword(&ShapeScale::KEYWORDS))?),
        None => None,
    };
    let (scale, share) = match (scale, share) {
        (Some(scale), Some(share)) => (scale, share),
        (None, None) => return None,
        (Some(alone), None) | (None, Some(alone)) => {
            found.push(
                Diagnostic::error("`scale` and `share` must be given together")
                    .with_span(alone.name.span, "the other key is missing")
                    .with_help("write scale = \"rate\", share = 0.1"),
            );
            return None;
        }
    };
    let part = found.push_error(share.number())?;
    if part.value <= 0.0 {
        found.push(
            Diagnostic::error(format!("`share` cannot be {}", part.value))
                .with_span(part.span, "expected a number above 0")
                .with_related_span(scale.span(), "share of this quantity"),
        );
    }
    word.map(|scale| Shape {
        quantity: scale,
        fraction: part.value,
    })
}
