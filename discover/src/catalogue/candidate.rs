//! Candidates: an effect of the catalogue at a site of a model, with its placeholders filled. A
//! candidate can be written into a specification.

use std::collections::BTreeMap;

use eomgen_model_spec::edit::{self, Edit, EditError, NewParameter, NewValue, SetParameter};
use eomgen_model_spec::model::{Model, Parameter, ParameterValue, STABILISATION_RATE};

use crate::catalogue::effect::{Change, Effect, SiteKind};
use crate::catalogue::loads::{Load, find_loads};
use crate::catalogue::site::Site;
use crate::catalogue::template::{
    fill_placeholders, instantiate_change, list_term_names, reserve_name,
};
use crate::catalogue::usual_motion::UsualMotion;
use crate::error::DiscoverError;
use crate::interval::Interval;
use crate::model::estimation_model::is_linear;
use crate::model::input_faults::InputFault;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::{SpecificationTexts, edited_source};
use crate::model::unknowns::{UnknownKind, bounds_with_sign};
use crate::thresholds;

/// Name of the effect that shifts a parameter.
pub const PARAMETER_SHIFT: &str = "parameter_shift";

/// Effect at a site.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Name of the effect.
    pub effect: String,
    /// Name of the site.
    pub site: String,
    /// Angle and order, in periods per turn, of a periodic effect.
    pub angle_order: Option<(String, u32)>,
    /// Name of the spring or mesh whose load scales the effect.
    pub load: Option<String>,
    /// True if the effect acts on a mesh with play.
    pub on_mesh: bool,
    /// Stiffness parameter of an effect that only scales a stiffness.
    pub scaled_stiffness: Option<String>,
    /// Parameters that the effect adds or shifts.
    pub parameters: Vec<CandidateParameter>,
    /// Description that completes a sentence.
    pub description: String,
    /// Experiment that shows the effect best.
    pub experiment: String,
    pub(crate) changes: Vec<Edit>,
    /// Edits for the linear part of the model, if the effect declares which part of its force is
    /// linear between switches.
    pub(crate) linear_changes: Option<Vec<Edit>>,
    /// Added line that represents the effect in reports.
    pub term: String,
    /// Unknown of the null model whose prior is removed, if this is the effect.
    pub dropped_prior: Option<UnknownKind>,
}

/// Multiple of the typical size that represents infinity.
pub(super) const NEARLY_INFINITE_FACTOR: f64 = 1e12;

/// Parameter of a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct CandidateParameter {
    /// Name in the specification.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// True if the parameter must not be negative.
    pub is_positive: bool,
    /// True if the effect vanishes at infinity instead of 0.
    pub is_inverse: bool,
    /// Initial value of a shape parameter, which does not scale the effect.
    pub shape_size: Option<f64>,
    /// Reference value and bounds of a parameter that exists already, or whose value without the
    /// effect is not 0.
    pub offset: Option<ParameterOffset>,
    /// Typical size, SI.
    pub typical_size: f64,
    pub(crate) doc: String,
}

/// Reference value and bounds of a shifted parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterOffset {
    /// Value in the specification, SI.
    pub reference: f64,
    /// Admissible values, SI.
    pub bounds: Interval,
    /// Value of one SI unit in the unit of the parameter.
    per_si: f64,
    /// True if the effect adds the parameter.
    is_new: bool,
}

impl ParameterOffset {
    /// Describes a parameter that an effect adds. `from`: its value without the effect.
    pub(crate) fn with_reference(from: f64, bounds: Interval) -> Self {
        Self {
            reference: from,
            bounds,
            per_si: 1.0,
            is_new: true,
        }
    }
}

impl CandidateParameter {
    /// Returns the value without the effect; 0 for a new parameter.
    pub fn base_value(&self) -> f64 {
        self.offset.as_ref().map_or(0.0, |offset| offset.reference)
    }

    /// Returns the value of the parameter at which the effect vanishes, or nearly vanishes.
    pub fn neutral_value(&self) -> f64 {
        match (self.is_inverse, self.shape_size) {
            (_, Some(shape)) => shape,
            (true, None) => NEARLY_INFINITE_FACTOR * self.typical_size,
            (false, None) => self.base_value(),
        }
    }

    /// Returns the value of one SI unit in the unit of the parameter.
    pub fn units_per_si(&self) -> f64 {
        self.offset.as_ref().map_or(1.0, |offset| offset.per_si)
    }

    fn to_edit(&self, value: f64, source: &str) -> Edit {
        match &self.offset {
            Some(offset) if !offset.is_new => Edit::SetParameter(SetParameter {
                name: self.name.clone(),
                value: value * self.units_per_si(),
                source: source.to_owned(),
            }),
            _ => Edit::AddParameter(NewParameter {
                name: self.name.clone(),
                value: NewValue::Number(value),
                unit: self.unit.clone(),
                doc: self.doc.clone(),
                source: source.to_owned(),
            }),
        }
    }
}

impl Candidate {
    /// Returns effect and site, followed by the order or the load if there are several.
    pub fn label(&self) -> String {
        let plain = format!("{} on {}", self.effect, self.site);
        match (&self.angle_order, &self.load) {
            (Some((angle, order)), _) => format!("{plain} ({order} per turn of {angle})"),
            (None, Some(load)) => format!("{plain} (by the load of {load})"),
            (None, None) => plain,
        }
    }

    /// Returns true for a constant error of a parameter, a sensor or an input.
    pub(crate) fn is_offset(&self) -> bool {
        let faults = InputFault::ALL.map(InputFault::effect_name);
        self.dropped_prior.is_some()
            || self.effect == PARAMETER_SHIFT
            || faults.contains(&self.effect.as_str())
    }

    /// Returns true if one candidate shifts the stiffness that the other scales. They are the same
    /// effect if the stiffness belongs to a single spring.
    pub(crate) fn is_alias_of(&self, other: &Self) -> bool {
        let shifts = |one: &Self, other: &Self| {
            one.effect == PARAMETER_SHIFT && other.scaled_stiffness.as_ref() == Some(&one.site)
        };
        shifts(self, other) || shifts(other, self)
    }

    /// Returns true if effect and site are equal; the orders may differ.
    pub fn is_same_effect_as(&self, other: &Self) -> bool {
        (&self.effect, &self.site) == (&other.effect, &other.site)
    }

    /// Returns a specification with the effect at these parameter values.
    ///
    /// # Errors
    ///
    /// An edit whose old text is missing in the specification.
    pub fn write_effect(
        &self,
        text: &str,
        name: &str,
        values: &[f64],
        source: &str,
    ) -> Result<String, EditError> {
        self.write_changes(&self.changes, text, name, values, source)
    }

    /// Returns a specification with the given edits and the parameters of the effect.
    fn write_changes(
        &self,
        changes: &[Edit],
        text: &str,
        name: &str,
        values: &[f64],
        source: &str,
    ) -> Result<String, EditError> {
        let pairs = self.parameters.iter().zip(values);
        let mut edits: Vec<Edit> = pairs
            .map(|(parameter, value)| parameter.to_edit(*value, source))
            .collect();
        edits.extend(changes.iter().cloned());
        edit::apply(&edited_source(name, text), &edits)
    }

    /// Returns the specification and its linear part with the effect at these parameter values.
    ///
    /// # Errors
    ///
    /// An edit whose old text is missing in the specification.
    pub fn add_to_texts(
        &self,
        problem: &EstimationProblem<'_>,
        texts: &SpecificationTexts,
        values: &[f64],
    ) -> Result<SpecificationTexts, DiscoverError> {
        let written = |changes: &[Edit], text: &str| {
            self.write_changes(changes, text, &problem.path, values, "")
        };
        let extended = written(&self.changes, &texts.full)?;
        // Added terms that are linear between switches are part of the linear part too.
        let linear = written(
            self.linear_changes.as_ref().unwrap_or(&self.changes),
            &texts.linear,
        );
        let linear = match linear {
            Ok(extended) if is_linear(&extended, &problem.path, problem.order) => extended,
            _ => texts.linear.clone(),
        };
        Ok(SpecificationTexts {
            full: extended,
            linear,
        })
    }
}

/// Returns the candidates of a model. `motion`: known motion at the sites.
pub fn list_candidates<'e>(
    model: &Model,
    effects: impl IntoIterator<Item = &'e Effect>,
    sites: &[Site],
    motion: &UsualMotion,
) -> Vec<Candidate> {
    let angles: Vec<&Site> = sites
        .iter()
        .filter(|site| site.kind == SiteKind::Angle)
        .collect();
    let loads = find_loads(model);
    let mut found = Vec::new();
    for effect in effects {
        for site in sites
            .iter()
            .filter(|site| accepts_site_kind(effect.site_kind, site.kind))
        {
            let own = [site];
            let turning: &[&Site] = match effect.has_orders {
                true if site.kind == SiteKind::Mesh => &angles,
                true => &own,
                false => &[],
            };
            let orders = turning.iter().flat_map(|angle| {
                let orders = list_orders(model, motion.orders(angle)).into_iter();
                let covered = orders.filter(|order| motion.covers_period(angle, *order));
                covered.map(|order| Some((*angle, order)))
            });
            let orders: Vec<Option<(&Site, u32)>> = match effect.has_orders {
                true => orders.collect(),
                false => vec![None],
            };
            let loads: Vec<Option<&Load>> = match effect.has_loads {
                true => loads.iter().map(Some).collect(),
                false => vec![None],
            };
            for load in loads {
                for order in &orders {
                    found.extend(create_candidate(
                        model,
                        effect,
                        site,
                        (*order, load),
                        motion,
                    ));
                }
            }
        }
    }
    found
}

fn accepts_site_kind(wanted: SiteKind, there: SiteKind) -> bool {
    wanted == there || (wanted == SiteKind::Axis && there == SiteKind::Angle)
}

/// Returns the usual shaft orders, the orders `seen` in the residual force, and the numbers of
/// teeth of the model: whole numbers without a unit.
fn list_orders(model: &Model, seen: &[u32]) -> Vec<u32> {
    let mut orders = [&thresholds::SHAFT_ORDERS[..], seen].concat();
    for parameter in &model.parameters {
        if let ParameterValue::Number(value) = parameter.value
            && parameter.unit.text == "1"
            && value.fract() == 0.0
            && (2.0..1000.0).contains(&value)
        {
            orders.push(value as u32);
        }
    }
    orders.sort_unstable();
    orders.dedup();
    orders
}

fn create_candidate(
    model: &Model,
    effect: &Effect,
    site: &Site,
    (order, load): (Option<(&Site, u32)>, Option<&Load>),
    motion: &UsualMotion,
) -> Option<Candidate> {
    let mut arguments: BTreeMap<String, String> = site
        .arguments
        .iter()
        .map(|(key, word)| ((*key).to_owned(), word.clone()))
        .collect();
    if let Some((angle, order)) = order {
        arguments.insert("n".to_owned(), order.to_string());
        arguments.insert("angle".to_owned(), angle.arguments["on"].clone());
    }
    if let Some(load) = load {
        let per_load = match (site.arguments.get("force")?.as_str(), load.unit) {
            (force, unit) if force == unit => "1",
            ("N m", _) => "m",
            _ => "1/m",
        };
        arguments.insert("load".to_owned(), load.force.clone());
        arguments.insert("per_load".to_owned(), per_load.to_owned());
    }
    let mut taken = list_names_in_use(model);
    let mut parameters = Vec::new();
    for parameter in &effect.parameters {
        let name = reserve_name(&parameter.name, &site.name, &mut taken);
        arguments.insert(parameter.name.clone(), name.clone());
        let unit = simplify_unit(&fill_placeholders(&parameter.unit, &arguments)?);
        parameters.push(CandidateParameter {
            name,
            typical_size: motion.typical_size(&unit),
            is_positive: parameter.is_positive,
            is_inverse: parameter.is_inverse,
            shape_size: parameter
                .shape
                .map(|shape| shape.fraction * motion.shape_scale(shape.quantity, site, &unit)),
            unit,
            offset: None,
            doc: parameter.doc.clone(),
        });
    }
    for change in &effect.edits {
        if let Change::Coordinate { name, .. }
        | Change::Definition { name, .. }
        | Change::State { name, .. } = change
        {
            let free = reserve_name(name, &site.name, &mut taken);
            arguments.insert(name.clone(), free);
        }
    }
    let mut changes = Vec::new();
    let mut linear_changes = Vec::new();
    let mut term = String::new();
    for change in &effect.edits {
        changes.extend(instantiate_change(model, change, site, &arguments)?);
        let linear = change.linear_part();
        linear_changes.extend(instantiate_change(model, &linear, site, &arguments)?);
        if let Change::Term { value, .. }
        | Change::Definition { value, .. }
        | Change::Force { value, .. }
        | Change::State { rate: value, .. } = change
        {
            term = fill_placeholders(value, &arguments)?;
        }
    }
    Some(Candidate {
        effect: effect.name.clone(),
        site: site.name.clone(),
        angle_order: order.map(|(angle, order)| (angle.name.clone(), order)),
        load: load.map(|load| load.name.clone()),
        on_mesh: site.kind == SiteKind::Mesh,
        scaled_stiffness: (site.arguments.get("k").cloned()).filter(|_| effect.scales_stiffness()),
        parameters,
        description: effect.description.clone(),
        experiment: effect.experiment.clone(),
        linear_changes: effect.declares_linear_part().then_some(linear_changes),
        changes,
        term,
        dropped_prior: None,
    })
}

/// Returns the candidate that removes the prior of an unknown of the null model.
pub fn drop_prior(
    effect: &str,
    on: &str,
    says: &str,
    experiment: &str,
    what: &UnknownKind,
) -> Candidate {
    Candidate {
        effect: effect.to_owned(),
        site: on.to_owned(),
        angle_order: None,
        load: None,
        on_mesh: false,
        scaled_stiffness: None,
        parameters: Vec::new(),
        description: says.to_owned(),
        experiment: experiment.to_owned(),
        changes: Vec::new(),
        linear_changes: None,
        term: String::new(),
        dropped_prior: Some(what.clone()),
    }
}

/// Returns the candidate that shifts an undeclared parameter; `None` if the parameter is 0 or an
/// expression.
pub fn shift_parameter(parameter: &Parameter) -> Option<Candidate> {
    let ParameterValue::Number(from) = parameter.value else {
        return None;
    };
    let is_count = parameter.unit.text == "1" && from.fract() == 0.0;
    // The stabilisation rate has no effect on motions that satisfy the constraints.
    let is_stabilisation = parameter.name == STABILISATION_RATE;
    if from == 0.0 || is_count || is_stabilisation {
        return None;
    }
    let shifted = CandidateParameter {
        name: parameter.name.clone(),
        unit: parameter.unit.text.clone(),
        typical_size: from.abs(),
        is_positive: false,
        is_inverse: false,
        shape_size: None,
        offset: Some(ParameterOffset {
            reference: from,
            bounds: bounds_with_sign(parameter, from),
            per_si: parameter.unit.from_si(1.0),
            is_new: false,
        }),
        doc: String::new(),
    };
    Some(Candidate {
        parameters: vec![shifted],
        dropped_prior: None,
        term: format!("{} shifted", parameter.name),
        ..drop_prior(
            PARAMETER_SHIFT,
            &parameter.name,
            "a parameter that differs from the specification",
            "a separate measurement of the parameter",
            &UnknownKind::Parameter(parameter.name.clone()),
        )
    })
}

/// Returns the names of all quantities of the model.
pub(crate) fn list_names_in_use(model: &Model) -> Vec<String> {
    let lists = [
        model
            .parameters
            .iter()
            .map(|p| p.name.clone())
            .collect::<Vec<_>>(),
        model.coordinates.iter().map(|c| c.name.clone()).collect(),
        model.inputs.iter().map(|i| i.name.clone()).collect(),
        model.states.iter().map(|s| s.name.clone()).collect(),
        model.definitions.iter().map(|d| d.name.clone()).collect(),
        model
            .fields
            .iter()
            .flat_map(|f| [f.name.clone(), f.along.clone(), f.coordinates.clone()])
            .collect(),
        model.coefficients.iter().map(|c| c.name.clone()).collect(),
        list_term_names(model),
    ];
    lists.concat()
}

/// Replaces `N m s/rad` by `N m s`, because angles have no unit of their own.
fn simplify_unit(unit: &str) -> String {
    let powers = ["/rad^3", "/rad^2", "/rad"];
    powers
        .iter()
        .fold(unit.to_owned(), |unit, power| unit.replace(power, ""))
}
