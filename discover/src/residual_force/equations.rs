//! Equations of motion in which a force may be missing: one for each coordinate, angle and end of a
//! flexible body. Along a motion they provide the operating point and the accelerations due to a
//! unit force.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::edit::{self, Edit, NewForce, NewParameter, NewTerm, NewValue, Section};
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use crate::catalogue::effect::SiteKind;
use crate::catalogue::sites::find_sites;
use crate::fit::fit_result::Fit;
use crate::fit::shooting::Shooting;
use crate::ids::{ObservableId, ParameterId};
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::edited_source;

/// An equation of motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// Name of the equation in results.
    pub name: String,
    /// Expression on which the force acts, in the notation of the specification.
    pub target: String,
    /// Unit of the expression, `rad` or `m`.
    pub unit: &'static str,
    /// True if the expression is the deflection of a mesh with play.
    pub is_mesh: bool,
}

impl Equation {
    /// Returns the unit of the force.
    pub fn force_unit(&self) -> &'static str {
        if self.unit == "rad" { "N m" } else { "N" }
    }

    /// Returns the unit of the rate.
    pub fn rate_unit(&self) -> &'static str {
        if self.unit == "rad" { "rad/s" } else { "m/s" }
    }
}

/// Position, rate and time at a point of a motion, for one equation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OperatingPoint {
    /// Position, m or rad.
    pub position: f64,
    /// Rate, m/s or rad/s.
    pub rate: f64,
    /// Time from the beginning of the window, s.
    pub time: f64,
}

/// Equations of a fitted model.
pub struct EquationSet {
    /// The equations.
    pub list: Vec<Equation>,
    model: EstimationModel,
    values: Vec<f64>,
    /// Parameters of the model that represent the forces.
    forces: Vec<ParameterId>,
    /// Observables of position and rate for each equation.
    shown: Vec<PositionAndRate>,
}

/// Observables of the position and the rate of one equation.
#[derive(Clone, Copy, Debug)]
struct PositionAndRate {
    position: ObservableId,
    rate: ObservableId,
}

/// Evaluator of the forced equations along a motion.
pub struct EquationEvaluator {
    free: Evaluator,
    forced: Vec<Evaluator>,
    shown: Vec<PositionAndRate>,
    observables: Vec<f64>,
    rates: [Vec<f64>; 2],
}

impl EquationSet {
    /// Derives the equations of a fitted model; `None` if a force cannot be added to it.
    pub fn derive_from_fit(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<Self> {
        Self::derive_list(problem, fit, list_equations(fit.model.specification()))
    }

    /// Derives the equations of a fitted model, and forces between both ends of each spring. `None`
    /// if a force cannot be added to the model.
    pub(crate) fn derive_with_springs(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<Self> {
        let model = fit.model.specification();
        let mut list = list_equations(model);
        for site in find_sites(model) {
            let (Some(on), Some(unit)) = (
                site.arguments.get("on"),
                site.arguments.get("unit").and_then(|text| read_unit(text)),
            ) else {
                continue;
            };
            if site.kind == SiteKind::Spring && list.iter().all(|known| known.target != *on) {
                list.push(Equation {
                    name: site.name.clone(),
                    target: on.clone(),
                    unit,
                    is_mesh: false,
                });
            }
        }
        Self::derive_list(problem, fit, list)
    }

    fn derive_list(
        problem: &EstimationProblem<'_>,
        fit: &Fit,
        list: Vec<Equation>,
    ) -> Option<Self> {
        let names = |word: &str, number: usize| format!("{word}_of_equation_{number}");
        let mut edits = Vec::new();
        for (number, equation) in list.iter().enumerate() {
            let force = names("residual", number);
            edits.push(Edit::AddParameter(NewParameter {
                name: force.clone(),
                value: NewValue::Number(0.0),
                unit: equation.force_unit().to_owned(),
                doc: String::new(),
                source: String::new(),
            }));
            edits.push(Edit::AddForce(NewForce {
                name: names("force", number),
                on: equation.target.clone(),
                value: force,
                doc: String::new(),
                source: String::new(),
            }));
            let shown = [
                ("position", equation.target.clone()),
                ("rate", format!("dot({})", equation.target)),
            ];
            for (word, value) in shown {
                edits.push(Edit::AddTerm(NewTerm {
                    section: Section::Observables,
                    name: names(word, number),
                    value,
                    doc: String::new(),
                    source: String::new(),
                }));
            }
        }
        let source = edited_source(&problem.path, &fit.texts.full);
        let text = edit::apply(&source, &edits).ok()?;
        let model =
            EstimationModel::derive_equations(&text, &problem.path, problem.order, &[]).ok()?;
        if model.states != fit.model.states {
            return None;
        }
        let observable = |name: String| {
            let mut observables = model.specification().observables.iter();
            let position = observables.position(|observable| observable.name == name);
            position.map(ObservableId::new)
        };
        let numbers = 0..list.len();
        let forces = numbers
            .clone()
            .map(|n| model.find_parameter(&names("residual", n)));
        let forces = forces.collect::<Option<Vec<ParameterId>>>()?;
        let shown = numbers.map(|n| {
            Some(PositionAndRate {
                position: observable(names("position", n))?,
                rate: observable(names("rate", n))?,
            })
        });
        let shown = shown.collect::<Option<Vec<PositionAndRate>>>()?;
        let whole = Shooting::new(problem, &model, &problem.train, &fit.unknowns, &fit.ranges);
        let values = whole.parameter_values(&fit.train.estimate.theta);
        Some(Self {
            list,
            values,
            forces,
            shown,
            model,
        })
    }

    /// Creates an evaluator of the equations.
    pub fn create_evaluator(&self) -> EquationEvaluator {
        let forced = self.forces.iter().map(|force| {
            let mut values = self.values.clone();
            values[force.index()] = 1.0;
            self.model.create_evaluator(&values)
        });
        let states = self.model.state_count();
        EquationEvaluator {
            free: self.model.create_evaluator(&self.values),
            forced: forced.collect(),
            shown: self.shown.clone(),
            observables: vec![0.0; self.model.program().observables.len()],
            rates: [vec![0.0; states], vec![0.0; states]],
        }
    }
}

impl EquationEvaluator {
    /// Appends the operating point of each equation; its time is 0.
    pub fn append_operating_points(&mut self, point: Point<'_>, out: &mut Vec<OperatingPoint>) {
        self.free.observables(point, &mut self.observables);
        out.clear();
        out.extend(self.shown.iter().map(|shown| OperatingPoint {
            position: self.observables[shown.position],
            rate: self.observables[shown.rate],
            ..OperatingPoint::default()
        }));
    }

    /// Appends, for each equation, the changes of the accelerations and of the rates of first-order
    /// states due to a unit force.
    pub fn append_accelerations(&mut self, point: Point<'_>, out: &mut Vec<f64>) {
        let [free, forced] = &mut self.rates;
        let first = self.free.program().degrees_of_freedom();
        self.free.rates(point, free);
        out.clear();
        for evaluator in &mut self.forced {
            evaluator.rates(point, forced);
            let pairs = forced[first..].iter().zip(&free[first..]);
            out.extend(pairs.map(|(a, b)| a - b));
        }
    }

    /// Computes the rates of the model.
    pub fn compute_rates(&mut self, point: Point<'_>, out: &mut [f64]) {
        self.free.rates(point, out);
    }
}

/// Returns the unit if it is a unit of position.
fn read_unit(text: &str) -> Option<&'static str> {
    match text {
        "rad" => Some("rad"),
        "m" => Some("m"),
        _ => None,
    }
}

/// Returns the equations in which effects can act, and those of the observables of a flexible body.
fn list_equations(model: &Model) -> Vec<Equation> {
    let unit = read_unit;
    let mut found = Vec::new();
    for site in find_sites(model) {
        let is_mesh = site.kind == SiteKind::Mesh;
        let is_coordinate = || {
            let on = site.arguments.get("on");
            let mut coordinates = model.coordinates.iter();
            coordinates.any(|coordinate| Some(&coordinate.name) == on)
        };
        let unit = match site.kind {
            // A force between both ends of a spring acts in the equations of the joined bodies. The
            // same is true of a mesh whose deflection is not a coordinate.
            SiteKind::Spring => None,
            SiteKind::Mesh if !is_coordinate() => None,
            SiteKind::Input => None,
            _ => site.arguments.get("unit").and_then(|text| unit(text)),
        };
        if let (Some(unit), Some(on)) = (unit, site.arguments.get("on")) {
            found.push(Equation {
                name: site.name.clone(),
                target: on.clone(),
                unit,
                is_mesh,
            });
        }
    }
    let bending = find_flexible_definitions(model);
    for observable in &model.observables {
        let ExprKind::Definition(number) = observable.value.kind else {
            continue;
        };
        let definition = &model.definitions[number];
        if bending[number.index()] == Some(true)
            && let Some(unit) = unit(&observable.unit.text)
        {
            found.push(Equation {
                name: observable.name.clone(),
                target: definition.name.clone(),
                unit,
                is_mesh: false,
            });
        }
    }
    found
}

/// Returns for each definition whether it contains a field; `None` if it depends on more than
/// positions.
fn find_flexible_definitions(model: &Model) -> Vec<Option<bool>> {
    let mut known = vec![None; model.definitions.len()];
    for &definition in &model.definition_order {
        known[definition.index()] = contains_field(&known, &model.definitions[definition].value);
    }
    known
}

/// Returns true if an expression contains a field; `None` if it depends on more than positions.
fn contains_field(known: &[Option<bool>], expr: &Expr) -> Option<bool> {
    let (mut bends, mut is_position) = (false, true);
    expr.visit(&mut |part| match &part.kind {
        ExprKind::Field(_) => bends = true,
        ExprKind::Definition(definition) => match known[definition.index()] {
            Some(inner) => bends |= inner,
            None => is_position = false,
        },
        ExprKind::Dot(_)
        | ExprKind::Time
        | ExprKind::Input(_)
        | ExprKind::State(_)
        | ExprKind::Multiplier(_)
        | ExprKind::Residual(_)
        | ExprKind::Call(..) => {
            is_position = false;
        }
        _ => {}
    });
    is_position.then_some(bends)
}
