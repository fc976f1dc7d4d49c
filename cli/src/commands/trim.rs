//! `eomgen trim`: an equilibrium of a model, and whether it is stable.

use eomgen_analysis::constrained_modes::constrained_modes;
use eomgen_compiled_model::{CompiledModel, Equilibrium, Error as Failure};
use serde_json::{Value, json};

use crate::arguments::Trim;
use crate::error::{Error, Result, say_json, warn};
use crate::operating_point::{assignments, head, inputs, model, named};

/// A real part is 0 if it is this small beside the largest eigenvalue.
const ZERO: f64 = 1e-9;

/// Runs the command.
pub fn run(options: &Trim) -> Result {
    let compiled = model(&options.spec, options.order.as_deref(), &options.set)?;
    let run = compiled.at_declared()?;
    let found = match run.equilibrium(&assignments("--fix", &options.fix)?) {
        Err(Failure::Stopped { reason, .. }) => {
            warn(&format!("error: {reason}"));
            return Err(Error::Failed);
        }
        other => other?,
    };
    let linear = run.linearise(found.at.point())?;
    let degrees = compiled.program().degrees_of_freedom();
    let modes = constrained_modes(&linear.a, &linear.held(&compiled), degrees)
        .map_err(|error| Error::input(error.to_string()))?;
    let largest = modes.iter().map(|mode| mode.eigenvalue.norm());
    let least = ZERO * largest.fold(0.0, f64::max);
    let growth = modes.iter().map(|mode| mode.eigenvalue.re);
    let growth = growth.fold(f64::NEG_INFINITY, f64::max);
    let stability = match growth {
        growth if growth > least => "unstable",
        growth if growth < -least => "asymptotically stable",
        _ => "marginal",
    };
    if found.depends_on_time {
        warn("warning: the forces depend on the time: this is an equilibrium at t = 0 s alone");
    }
    say_json(&document(&compiled, &found, stability))
}

fn document(compiled: &CompiledModel, found: &Equilibrium, stability: &str) -> Value {
    let states = compiled.state_names();
    let degrees = compiled.program().degrees_of_freedom();
    let coordinates = &states[..degrees];
    let (inputs, input_units) = inputs(compiled);
    let units = &compiled.state_units()[..coordinates.len()];
    let mut document = head(compiled);
    document.extend([
        ("at".to_owned(), named(compiled, &found.at)),
        ("coordinates".to_owned(), json!(coordinates)),
        ("inputs".to_owned(), json!(inputs)),
        (
            "units".to_owned(),
            json!({ "coordinates": units, "inputs": input_units }),
        ),
        ("free".to_owned(), json!(found.free)),
        ("residual".to_owned(), json!(found.residual)),
        ("stability".to_owned(), json!(stability)),
    ]);
    Value::Object(document)
}
