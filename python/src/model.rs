//! Compiled model at its parameter values, as a Python class.

use std::path::Path;
use std::sync::Arc;

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_compiled_model::{
    CompiledModel, Error, Instance, JacobianEvaluator, Orders, split_assignments,
    with_prescribed_inputs,
};
use eomgen_model_spec::Checked;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::edit::{Edit, SetParameter, apply};
use eomgen_model_spec::model::{Model as Specified, ParameterValue};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::suggest;
use eomgen_records::feedback::open_loop;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::evaluators::Pool;

/// Compiled model at one set of parameter values. Threads may share it.
#[pyclass(frozen, module = "eomgen._native")]
pub struct Model {
    compiled: Arc<CompiledModel>,
    /// Requested order; `None` for the orders of the specification.
    order: Option<usize>,
    /// Parameters that were set, in declared units.
    settings: Vec<(String, f64)>,
    /// Warnings about the specification.
    warnings: Option<String>,
    evaluators: Pool<Evaluator>,
    jacobians: Pool<JacobianEvaluator>,
}

impl Model {
    fn derive(checked: Checked, order: Option<usize>) -> Result<Self, Error> {
        let Checked { model, warnings } = checked;
        let orders = order.map_or(Orders::Declared, Orders::Uniform);
        let compiled = CompiledModel::derive(model, orders)?;
        let warnings = (!warnings.is_empty()).then(|| warnings.render(false));
        Ok(Self::new(Arc::new(compiled), order, Vec::new(), warnings))
    }

    fn new(
        compiled: Arc<CompiledModel>,
        order: Option<usize>,
        settings: Vec<(String, f64)>,
        warnings: Option<String>,
    ) -> Self {
        Self {
            compiled,
            order,
            settings,
            warnings,
            evaluators: Pool::default(),
            jacobians: Pool::default(),
        }
    }

    /// Compiled model at its declared parameter values.
    pub fn compiled(&self) -> &CompiledModel {
        &self.compiled
    }

    /// Parameters that were set, in declared units.
    pub fn settings(&self) -> &[(String, f64)] {
        &self.settings
    }

    /// Returns the model for a comparison with records. If columns of the records replace its controllers, returns a
    /// note too.
    pub fn open_loop(&self, dataset: &Path) -> PyResult<(Specified, Option<String>)> {
        let text = self.specification()?;
        let source = self.compiled.model().source.with_text(text);
        let checked = eomgen_model_spec::check(source);
        let model = checked.map_err(|found| error::specification(&found))?.model;
        open_loop(model, dataset).map_err(error::records)
    }

    /// Returns the compiled model at its parameter values.
    pub fn instance(&self) -> Result<Instance<'_>, Error> {
        let settings = self.settings.iter().map(|(name, v)| (name.as_str(), *v));
        self.compiled.with_parameters(&settings.collect::<Vec<_>>())
    }

    /// Returns an instance at the parameter values; it shares the compiled model.
    pub fn shared_instance(&self) -> Result<Instance<'static>, Error> {
        let settings = self.settings.iter().map(|(name, v)| (name.as_str(), *v));
        let settings: Vec<_> = settings.collect();
        self.compiled.share_with_parameters(&settings)
    }

    /// Calls `compute` with an evaluator at the parameter values.
    pub fn evaluate<T>(&self, compute: impl FnOnce(&mut Evaluator) -> T) -> Result<T, Error> {
        let new = || self.instance()?.evaluator();
        self.evaluators.with(new, compute)
    }

    /// Calls `compute` with an evaluator of the Jacobians at the parameter values.
    pub fn differentiate<T>(
        &self,
        compute: impl FnOnce(&mut JacobianEvaluator) -> T,
    ) -> Result<T, Error> {
        let new = || self.instance()?.jacobian_evaluator();
        self.jacobians.with(new, compute)
    }

    /// Returns the specification's text, including parameters that were set.
    pub fn specification(&self) -> PyResult<String> {
        let set = |(name, value): &(String, f64)| {
            Edit::SetParameter(SetParameter {
                name: name.clone(),
                value: *value,
                source: String::new(),
            })
        };
        let edits: Vec<Edit> = self.settings.iter().map(set).collect();
        let source = &self.compiled.model().source;
        match edits.is_empty() {
            true => Ok(source.text.to_string()),
            false => {
                apply(source, &edits).map_err(|error| PyValueError::new_err(error.to_string()))
            }
        }
    }
}

#[pymethods]
impl Model {
    /// Creates a model from the text of a specification. Messages use `name` as its file name.
    #[staticmethod]
    fn of_text(py: Python<'_>, name: &str, text: &str, order: Option<usize>) -> PyResult<Self> {
        let derived = || {
            let checked = eomgen_model_spec::check(Source::new(name, text))?;
            Self::derive(checked, order)
        };
        py.detach(derived).map_err(error::model)
    }

    /// Creates a model from a specification file.
    #[staticmethod]
    fn of_file(py: Python<'_>, path: &str, order: Option<usize>) -> PyResult<Self> {
        let derived = || {
            let checked = eomgen_model_spec::load(Path::new(path))?;
            Self::derive(checked, order)
        };
        py.detach(derived).map_err(error::model)
    }

    /// Returns the model with new parameter values, in declared units. Expressions are part of the equations: if a
    /// value replaces an expression, the equations are derived again.
    fn with_parameters(&self, py: Python<'_>, settings: Vec<(String, f64)>) -> PyResult<Self> {
        let mut all = self.settings.clone();
        all.retain(|(name, _)| settings.iter().all(|(new, _)| new != name));
        all.extend(settings);
        let set = || {
            let declared = self.compiled.model();
            let settings: Vec<_> = all.iter().map(|(name, v)| (name.as_str(), *v)).collect();
            let is_expression = |(name, _): &(&str, f64)| {
                let mut parameters = declared.parameters.iter();
                let known = parameters.find(|known| known.name == *name);
                known.is_some_and(|known| matches!(known.value, ParameterValue::Expression(_)))
            };
            let compiled = match settings.iter().any(is_expression) {
                false => self.compiled.clone(),
                true => {
                    let model = declared.with_parameters(&settings);
                    let model = model.map_err(|error| error.diagnostic());
                    let model = model.map_err(|wrong| {
                        let source = declared.source.clone();
                        Diagnostics::from_one(source, wrong)
                    })?;
                    let orders = Orders::PerField(self.compiled.orders());
                    Arc::new(CompiledModel::derive(model, orders)?)
                }
            };
            // Reports invalid values at once instead of at the first call.
            compiled.with_parameters(&settings)?.evaluator()?;
            Ok(compiled)
        };
        let compiled = py.detach(set).map_err(error::model)?;
        Ok(Self::new(compiled, self.order, all, self.warnings.clone()))
    }

    /// Returns the model with inputs replaced by expressions of time and parameters.
    fn with_inputs(&self, py: Python<'_>, given: Vec<(String, String)>) -> PyResult<Self> {
        let declared = self.compiled.model();
        let source = declared.source.with_text(self.specification()?);
        let given = given.iter().map(|(name, value)| format!("{name}={value}"));
        let given: Vec<String> = given.collect();
        let derived = || {
            let given = split_assignments("inputs", &given)?;
            let model = eomgen_model_spec::check(source)?.model;
            let model = with_prescribed_inputs(model, &given)?;
            CompiledModel::derive(model, Orders::PerField(self.compiled.orders()))
        };
        let compiled = py.detach(derived).map_err(error::model)?;
        let none = Vec::new();
        Ok(Self::new(
            Arc::new(compiled),
            self.order,
            none,
            self.warnings.clone(),
        ))
    }

    /// Name of the model.
    #[getter]
    fn name(&self) -> &str {
        &self.compiled.model().name
    }

    /// Title; may be empty.
    #[getter]
    fn title(&self) -> &str {
        &self.compiled.model().title
    }

    /// Requested order; `None` for the orders of the specification.
    #[getter]
    pub fn order(&self) -> Option<usize> {
        self.order
    }

    /// Order of each field.
    #[getter]
    fn orders(&self) -> Vec<usize> {
        self.compiled.orders().to_vec()
    }

    /// Warnings about the specification, if any.
    #[getter]
    fn warnings(&self) -> Option<&str> {
        self.warnings.as_deref()
    }

    /// Text of the specification, including parameters that were set.
    #[getter]
    fn text(&self) -> PyResult<String> {
        self.specification()
    }

    /// Names and units of the states.
    #[getter]
    fn states(&self) -> Vec<(String, String)> {
        let units = self.compiled.state_units();
        self.compiled.state_names().into_iter().zip(units).collect()
    }

    /// Names of the inputs that controllers of the specification drive.
    #[getter]
    fn controlled_inputs(&self) -> Vec<&str> {
        let model = self.compiled.model();
        let inputs = model.inputs.iter().enumerate();
        let driven = inputs.filter(|(place, _)| model.is_controlled(*place));
        driven.map(|(_, input)| &*input.name).collect()
    }

    /// Names of the inputs that are prescribed motion, and of their rates.
    #[getter]
    fn prescribed_inputs(&self) -> Vec<&str> {
        let inputs = self.compiled.model().inputs.iter();
        let prescribed = inputs.filter(|input| input.rate.is_some() || input.rate_of.is_some());
        prescribed.map(|input| &*input.name).collect()
    }

    /// Names and units of the states of the controllers.
    #[getter]
    fn controller_states(&self) -> Vec<(&str, &str)> {
        let states = self.compiled.model().controller_states().into_iter();
        states.map(|(name, unit)| (name, &*unit.text)).collect()
    }

    /// Number of first-order states, which are last.
    #[getter]
    fn first_order_states(&self) -> usize {
        self.compiled.model().states.len()
    }

    /// Names and units of the inputs.
    #[getter]
    fn inputs(&self) -> Vec<(&str, &str)> {
        let inputs = self.compiled.model().inputs.iter();
        inputs
            .map(|input| (&*input.name, &*input.unit.text))
            .collect()
    }

    /// Names and units of the observables; `energy` and `power` are last.
    #[getter]
    fn observables(&self) -> Vec<(&str, &str)> {
        let observables = self.compiled.program().observables.iter();
        observables
            .map(|known| (&*known.name, &*known.unit))
            .collect()
    }

    /// Names, values and declared units of the parameters.
    #[getter]
    fn parameters(&self) -> PyResult<Vec<(&str, f64, &str)>> {
        let instance = self.instance().map_err(error::model)?;
        let parameters = self.compiled.model().parameters.iter();
        let value = |name: &str| instance.value(name).unwrap_or(f64::NAN);
        Ok(parameters
            .map(|p| (&*p.name, p.unit.from_si(value(&p.name)), &*p.unit.text))
            .collect())
    }

    /// Names of the independent parameters: the columns of the Jacobian with respect to the parameters.
    #[getter]
    fn independent_parameters(&self) -> Vec<String> {
        self.compiled.parameter_names()
    }

    /// Initial state of the specification, in SI.
    #[getter]
    fn initial(&self) -> PyResult<Vec<f64>> {
        let instance = self.instance().map_err(error::model)?;
        Ok(instance.initial_state().to_vec())
    }
}

/// Returns the known name that is most similar to an unknown one, if it is similar enough.
#[pyfunction]
pub fn nearest(wrong: &str, known: Vec<String>) -> Option<String> {
    let known = known.iter().map(String::as_str);
    suggest::nearest(wrong, known).map(str::to_owned)
}
