//! Sweep of a model: points, conditions and measures from texts, as on the command line.

use eomgen_model_spec::argument::Argument;
use std::path::Path;

use eomgen_compiled_model::{
    CompiledModel, Error, ExpressionInputs, InputRole, InputTreatment, Orders, StateRequest,
    list_undriven_inputs, split_assignments,
};
use eomgen_model_spec::assignment::Assignment;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_records::{RecordInputs, Refusal, read_inputs};

use crate::conditions::Conditions;
use crate::error::SweepError;
use crate::grid::{Axis, Grid};
use crate::job::{Job, Plan, PlannedConditions};
use crate::lyapunov::Lyapunov;
use crate::measure::Measure;
use crate::over_time::{OverTime, measure_names};
use crate::parameters::columns;
use crate::poincare::{Poincare, Section};
use crate::points::Points;
use crate::samples::Samples;
use crate::span::Span;
use crate::window::{Window, check_end};

/// Measures other than statistics over time.
const MEASURES: [&str; 3] = ["lyapunov", "poincare", "poincare:NAME"];

/// Request for a sweep. Messages name the options of `eomgen sweep`.
#[derive(Clone, Debug, Default)]
pub struct SweepRequest {
    /// Axes of a grid, `NAME[,NAME...]=FROM:TO:COUNT[:log]`; empty with samples.
    pub vary: Vec<String>,
    /// Number of random samples, instead of a grid.
    pub samples: Option<usize>,
    /// Seed of the samples.
    pub seed: u64,
    /// Names of the measures.
    pub measures: Vec<String>,
    /// Parameters whose values differ from the specification, in declared units.
    pub set: Vec<(String, f64)>,
    /// Order of every field; `None` for the orders of the specification.
    pub order: Option<usize>,
    /// Parameter that is the angular frequency of the forcing.
    pub frequency: String,
    /// Discarded and measured forcing periods or crossings.
    pub span: Span,
    /// End of the motion in s, instead of forcing periods. Default with a record: the end of the record.
    pub until: Option<f64>,
    /// Poincaré section, `NAME=VALUE[:up|:down]`.
    pub section: Option<String>,
    /// Inputs given by expressions, `NAME=EXPR`.
    pub inputs: Vec<String>,
    /// Dataset file, and name of the record that drives the inputs.
    pub record: Option<(std::path::PathBuf, String)>,
    /// Initial states, `NAME=EXPR`, and the word `trim`.
    pub state: Vec<String>,
}

impl SweepRequest {
    fn settings(&self) -> Vec<(&str, f64)> {
        let set = self.set.iter();
        set.map(|(name, value)| (&**name, *value)).collect()
    }
}

/// Model, points and conditions of a requested sweep.
pub struct Sweep {
    request: SweepRequest,
    model: CompiledModel,
    points: Points,
    conditions: Conditions,
    specification: String,
    /// Warnings about inputs.
    pub warnings: Vec<String>,
}

impl Sweep {
    /// Derives the model of a request and reads its conditions.
    ///
    /// # Errors
    /// An invalid request with its location, or a model that cannot be derived.
    pub fn new(declared: &Model, request: SweepRequest) -> Result<Self, Error> {
        let set = request.settings();
        let points = create_points(declared, &request, &set)?;
        // If both ends of an axis are admissible, so are all values between them, because admissible values form
        // intervals.
        let at = |point: usize| [&set[..], &points.settings(point)].concat();
        with_parameters(declared, &at(points.count() - 1))?;
        let first = at(0);
        let given = split_assignments(Argument::Inputs.name(), &request.inputs)?;
        let (model, inputs) = derive_driven_model(declared, &given, &request, &first)?;
        let driven: Vec<&str> = given.iter().map(Assignment::name).collect();
        let (record, warnings) = match &request.record {
            Some((dataset, name)) => {
                let record = read_record(dataset, name, (model.model(), &driven))?;
                (Some(record.inputs), record.warnings)
            }
            None => (None, list_undriven_inputs(model.model(), &driven)),
        };
        let conditions = Conditions {
            state: StateRequest::parse(Argument::InitialState.name(), &request.state)?,
            inputs,
            settings: request.set.clone(),
            record,
        };
        if let Some(until) = request.until {
            check_end(until, &conditions)?;
        }
        // Reports invalid names and values once instead of at every point.
        match model.with_parameters(&points.settings(0)) {
            Ok(instance) => match instance.requested_state(&conditions.state) {
                Err(error @ (Error::Specification(_) | Error::Request(_))) => return Err(error),
                Err(Error::Stopped { .. }) | Ok(_) => {}
            },
            Err(error) => return Err(error),
        }
        Ok(Self {
            specification: declared.hash(),
            model,
            points,
            conditions,
            warnings,
            request,
        })
    }

    /// Returns the measures in the order of the request. Consecutive measures over time share the motion of each point.
    ///
    /// # Errors
    /// A measure that is unknown or not applicable.
    pub fn measures(&self) -> Result<Vec<Box<dyn Measure + '_>>, SweepError> {
        let mut measures: Vec<Box<dyn Measure + '_>> = Vec::new();
        let mut names = &self.request.measures[..];
        while let Some(name) = names.first() {
            let over_time = names
                .iter()
                .take_while(|name| OverTime::accepts(name))
                .count();
            measures.push(match over_time {
                0 => self.create_measure(name)?,
                count => self.create_measure_over_time(&names[..count])?,
            });
            names = &names[over_time.max(1)..];
        }
        Ok(measures)
    }

    /// Returns the time window of a measure.
    fn window(&self) -> Window {
        match self.request.until.or(self.conditions.end()) {
            Some(end) => Window::Until(end),
            None => Window::Periods {
                forcing: self.request.frequency.clone(),
                span: self.request.span,
            },
        }
    }

    fn create_measure_over_time(
        &self,
        names: &[String],
    ) -> Result<Box<dyn Measure + '_>, SweepError> {
        let driven = (&self.model, &self.conditions);
        Ok(Box::new(OverTime::new(driven, names, &self.window())?))
    }

    fn create_measure(&self, name: &str) -> Result<Box<dyn Measure + '_>, SweepError> {
        let lines = self.points.axes().iter();
        let lines = lines.filter(|axis| axis.count > 1).count();
        let (model, conditions) = (&self.model, &self.conditions);
        if name == "lyapunov" {
            return Ok(Box::new(Lyapunov::new(model, conditions, &self.window())?));
        }
        let until = self.request.until.or(self.conditions.end());
        let section = match (&self.request.section, until) {
            (None, _) => Section::Forcing(self.request.frequency.clone()),
            (Some(event), Some(until)) => Section::Crossing {
                event: event.clone(),
                until,
            },
            (Some(event), None) => {
                return Err(SweepError::Request(format!(
                    "{}: {} is missing: the time span in s in which crossings are located",
                    Argument::Section.with_text(event),
                    Argument::Until
                )));
            }
        };
        let span = self.request.span;
        let measure = Poincare::new((model, conditions), name, &section, span, lines == 1);
        Ok(Box::new(measure.ok_or_else(|| unknown_measure(name))??))
    }

    /// Returns the job of the given measures.
    ///
    /// # Errors
    /// Repeated measures.
    pub fn job(&self, measures: &[Box<dyn Measure + '_>]) -> Result<Job, SweepError> {
        let record = self.request.record.as_ref();
        let record = record.zip(self.conditions.record.as_ref());
        let record = record.map(|((_, name), inputs)| {
            format!("{name} {}", Source::new("", format!("{inputs:?}")).hash())
        });
        let plan = Plan::new(
            self.specification.clone(),
            &self.model.model().name,
            self.model.orders(),
            &self.request.settings(),
            columns(self.model.model(), &self.points)?,
            &self.points,
            measures.iter().flat_map(|own| own.describe()).collect(),
        );
        Job::new(plan.with_conditions(PlannedConditions {
            inputs: self.request.inputs.clone(),
            record,
            state: self.request.state.clone(),
        }))
    }
}

/// Returns the points of a sweep; `set` are parameters with other values.
fn create_points(
    declared: &Model,
    request: &SweepRequest,
    set: &[(&str, f64)],
) -> Result<Points, Error> {
    if let Some(count) = request.samples {
        let model = with_parameters(declared, set)?;
        return Ok(Points::Samples(Samples::new(&model, count, request.seed)?));
    }
    let axes = request.vary.iter().map(|text| Axis::parse(text));
    let grid = Grid::new(axes.collect::<Result<Vec<_>, _>>()?)?;
    let mut given = set.iter();
    if let Some((name, _)) = given.find(|(name, _)| grid.names().any(|varied| varied == *name)) {
        return Err(Error::Request(format!(
            "`{name}` is both set and varied; give only one of {} and {}",
            Argument::Parameters,
            Argument::Vary
        )));
    }
    Ok(Points::Grid(grid))
}

fn with_parameters(model: &Model, settings: &[(&str, f64)]) -> Result<Model, Error> {
    model
        .with_parameters(settings)
        .map_err(|error| Diagnostics::from_one(model.source.clone(), error.diagnostic()).into())
}

/// Derives the model with inputs given by expressions, as `simulate` does: controllers may measure these inputs.
fn derive_driven_model(
    declared: &Model,
    given: &[Assignment],
    request: &SweepRequest,
    first: &[(&str, f64)],
) -> Result<(CompiledModel, ExpressionInputs), Error> {
    let treatment = InputTreatment {
        role: (!declared.controllers.is_empty()).then_some(InputRole::Measured),
        may_hold: request.record.is_none(),
    };
    ExpressionInputs::derive(declared.clone(), given, (treatment, first), |model| {
        let orders = request.order.map_or(Orders::Declared, Orders::Uniform);
        let model = with_parameters(&model, first)?;
        CompiledModel::derive_without_inertia_check(model, orders)
    })
}

fn read_record(
    dataset: &Path,
    name: &str,
    (model, driven): (&Model, &[&str]),
) -> Result<RecordInputs, Error> {
    read_inputs(dataset, name, (model, driven)).map_err(|refusal| match refusal {
        Refusal::Description(found) => Error::Specification(found),
        Refusal::Record(message) => Error::Request(message),
        Refusal::Column(missing) => Error::Request(missing.message),
    })
}

fn unknown_measure(name: &str) -> SweepError {
    let known = MEASURES.into_iter().map(str::to_owned);
    let known: Vec<String> = known.chain(measure_names()).collect();
    SweepError::Request(format!(
        "{}: unknown measure; expected one of {}",
        Argument::Measure.with_text(name),
        known.join(", ")
    ))
}
