//! Initial states given as `NAME=EXPR`, or as the nearest equilibrium.

use eomgen_model_spec::assignment::{Assignment, QuantityReader};
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::unit::Unit;

use crate::equilibrium::{Equilibrium, EquilibriumRequest};
use crate::error::Error;
use crate::instance::Instance;
use crate::operating_point::{OperatingPoint, Setting};
use crate::prescribed_inputs::split_assignments;

/// Word that requests the nearest equilibrium.
const TRIM: &str = "trim";

/// Values of states, inputs and time that replace those of the specification, or a request for the nearest equilibrium.
/// Expressions are evaluated at the parameter values of an instance.
#[derive(Clone, Debug, Default)]
pub struct StateRequest {
    assigned: Vec<Assignment>,
    is_trimmed: bool,
}

impl StateRequest {
    /// Parses `NAME=EXPR` and the word `trim`. `option`, for example `--state`, replaces the file name in messages.
    ///
    /// # Errors
    /// A text of another form.
    pub fn parse(option: &str, texts: &[String]) -> Result<Self, Error> {
        let (words, assigned): (Vec<String>, Vec<String>) =
            texts.iter().cloned().partition(|text| text.trim() == TRIM);
        Ok(Self {
            assigned: split_assignments(option, &assigned)?,
            is_trimmed: !words.is_empty(),
        })
    }
}

impl Instance<'_> {
    /// Reads values of states, inputs and `t`, SI.
    ///
    /// # Errors
    /// An unknown name or an invalid value, with its location in the option.
    pub fn read_quantities(&self, given: &[Assignment]) -> Result<Vec<(String, f64)>, Error> {
        if given.is_empty() {
            return Ok(Vec::new());
        }
        let compiled = self.model();
        let model = self.valued_model()?;
        let states = model.state_units(compiled.orders());
        let reader = QuantityReader::new(&model)?;
        let value = |given: &Assignment| -> Result<(String, f64), Error> {
            let unit = match compiled.find_setting(given.name()) {
                Ok(Setting::State(place)) => states[place].clone(),
                Ok(Setting::Input(place)) => model.inputs[place].unit.clone(),
                Ok(Setting::Time) => Unit::coherent(Dimension::TIME),
                Err(error) => return Err(given.name_error(error.to_string(), None).into()),
            };
            Ok((given.name().to_owned(), reader.read(given, &unit)?))
        };
        given.iter().map(value).collect()
    }

    /// Returns the requested point, and the equilibrium if one is requested.
    ///
    /// # Errors
    /// [`Error::Stopped`] if no equilibrium is found; see also [`Instance::read_quantities`].
    pub fn requested_point(
        &self,
        request: &StateRequest,
    ) -> Result<(OperatingPoint, Option<Equilibrium>), Error> {
        let given = self.read_quantities(&request.assigned)?;
        let given: Vec<(&str, f64)> = given.iter().map(|(name, v)| (&**name, *v)).collect();
        if !request.is_trimmed {
            return Ok((self.operating_point(&given)?, None));
        }
        let found = self.find_equilibrium(EquilibriumRequest {
            start_values: &given,
            fixed_values: &[],
        })?;
        Ok((found.point.clone(), Some(found)))
    }

    /// Returns the requested initial state, SI, and the equilibrium if one is requested.
    ///
    /// # Errors
    /// A value of an input or of the time; see also [`Instance::requested_point`].
    pub fn requested_state(
        &self,
        request: &StateRequest,
    ) -> Result<(Vec<f64>, Option<Equilibrium>), Error> {
        for given in &request.assigned {
            if !matches!(
                self.model().find_setting(given.name()),
                Ok(Setting::State(_)) | Err(_)
            ) {
                return Err(Error::Request(format!(
                    "{} {}: expected a coordinate, a mode, a rate or another state",
                    given.option(),
                    given.name()
                )));
            }
        }
        let (point, found) = self.requested_point(request)?;
        Ok((point.state, found))
    }
}
