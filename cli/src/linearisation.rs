//! Linearisations as JSON and as NumPy arrays.

use eomgen_analysis::allowed_motions::{AllowedMotions, row_by_row};
use eomgen_analysis::discretisation::DiscreteSystem;
use eomgen_compiled_model::{CompiledModel, Linearisation, OperatingPoint};
use serde_json::{Value, json};

use crate::error::{Error, Result};
use crate::npz::{Array, archive};
use crate::operating_point::{head, inputs, values_by_name};

/// Linearisation and, if requested, its discrete-time form.
pub struct LinearModel {
    pub continuous: Linearisation,
    /// Sample period in s, and the discrete-time form.
    pub discrete: Option<(f64, DiscreteSystem)>,
}

impl LinearModel {
    /// Adds the discrete-time form for a sample period in s.
    pub fn new(
        compiled: &CompiledModel,
        continuous: Linearisation,
        period: Option<f64>,
    ) -> Result<Self> {
        let discretise = |period: f64| {
            let system = compiled.discretise(&continuous.a, &continuous.b, period)?;
            Ok::<_, Error>((period, system))
        };
        let discrete = period.map(discretise).transpose()?;
        Ok(Self {
            continuous,
            discrete,
        })
    }
}

/// Returns the operating point, names, units and matrices as JSON.
pub fn document(
    compiled: &CompiledModel,
    (at, is_equilibrium): (&OperatingPoint, bool),
    linear: &LinearModel,
) -> Result<Value> {
    let found = &linear.continuous;
    let (inputs, input_units) = inputs(compiled);
    let states = compiled.state_names();
    let outputs = compiled.observable_names();
    // A matrix without columns is printed as empty rows.
    let of = |matrix: &[f64], height: usize, columns: usize| match columns {
        0 => json!(vec![Vec::<f64>::new(); height]),
        _ => matrix.chunks(columns).map(|row| json!(row)).collect(),
    };
    let (n, m, l) = (states.len(), inputs.len(), outputs.len());
    let mut document = head(compiled);
    document.extend([
        ("at".to_owned(), values_by_name(compiled, at)),
        ("equilibrium".to_owned(), json!(is_equilibrium)),
        ("states".to_owned(), json!(states)),
        ("inputs".to_owned(), json!(inputs)),
        ("outputs".to_owned(), json!(outputs)),
        (
            "units".to_owned(),
            json!({
                "states": compiled.state_units(),
                "inputs": input_units,
                "outputs": output_units(compiled),
            }),
        ),
        ("rates".to_owned(), json!(found.rates)),
        ("A".to_owned(), of(&found.a, n, n)),
        ("B".to_owned(), of(&found.b, n, m)),
        ("C".to_owned(), of(&found.c, l, n)),
        ("D".to_owned(), of(&found.d, l, m)),
    ]);
    if let Some((period, system)) = &linear.discrete {
        document.extend([
            ("period".to_owned(), json!(period)),
            ("A_d".to_owned(), of(&system.a, n, n)),
            ("B_d".to_owned(), of(&system.b, n, m)),
        ]);
    }
    if let Some(minimal) = minimal(compiled, linear)? {
        let k = minimal.count;
        if let Some(system) = &minimal.discrete {
            document.extend([
                ("A_allowed_d".to_owned(), of(&system.a, k, k)),
                ("B_allowed_d".to_owned(), of(&system.b, k, m)),
            ]);
        }
        document.extend([
            ("N".to_owned(), of(&minimal.n, n, k)),
            ("A_allowed".to_owned(), of(&minimal.a, k, k)),
            ("B_allowed".to_owned(), of(&minimal.b, k, m)),
            ("C_allowed".to_owned(), of(&minimal.c, l, k)),
        ]);
    }
    Ok(Value::Object(document))
}

/// Matrices of the motions x = N y that the constraints allow.
struct AllowedMatrices {
    count: usize,
    n: Vec<f64>,
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
    discrete: Option<DiscreteSystem>,
}

/// Returns the matrices; `None` for a model without constraints.
fn minimal(compiled: &CompiledModel, linear: &LinearModel) -> Result<Option<AllowedMatrices>> {
    let found = &linear.continuous;
    let held = found.constraint_matrix(compiled);
    if held.is_empty() {
        return Ok(None);
    }
    let allowed = AllowedMotions::new(&held, compiled.typical_sizes())
        .map_err(|error| Error::input(error.to_string()))?;
    let (inputs, _) = inputs(compiled);
    let a = allowed.reduce_state_matrix(&found.a);
    let b = allowed.reduce_input_matrix(&found.b, inputs.len());
    let discretise = |(period, _): &(f64, DiscreteSystem)| compiled.discretise(&a, &b, *period);
    let discrete = linear.discrete.as_ref().filter(|_| allowed.count() > 0);
    Ok(Some(AllowedMatrices {
        count: allowed.count(),
        discrete: discrete.map(discretise).transpose()?,
        n: row_by_row(allowed.basis()),
        a,
        b,
        c: allowed.reduce_output_matrix(&found.c, found.observables.len()),
    }))
}

/// Returns a NumPy archive (`.npz`) of matrices, operating point, names and units.
pub fn arrays(
    compiled: &CompiledModel,
    at: &OperatingPoint,
    linear: &LinearModel,
) -> Result<Vec<u8>> {
    let found = &linear.continuous;
    let (inputs, input_units) = inputs(compiled);
    let inputs: Vec<String> = inputs.into_iter().map(str::to_owned).collect();
    let (states, outputs) = (compiled.state_names(), compiled.observable_names());
    let (n, m, l) = (states.len(), inputs.len(), outputs.len());
    let (time, state_units) = ([at.t], compiled.state_units());
    let output_units = output_units(compiled);
    let mut all = vec![
        ("A", Array::Matrix(&found.a, [n, n])),
        ("B", Array::Matrix(&found.b, [n, m])),
        ("C", Array::Matrix(&found.c, [l, n])),
        ("D", Array::Matrix(&found.d, [l, m])),
        ("t", Array::Vector(&time)),
        ("x", Array::Vector(&at.state)),
        ("u", Array::Vector(&at.inputs)),
        ("rates", Array::Vector(&found.rates)),
        ("states", Array::Names(&states)),
        ("inputs", Array::Names(&inputs)),
        ("outputs", Array::Names(&outputs)),
        ("state_units", Array::Names(&state_units)),
        ("input_units", Array::Names(&input_units)),
        ("output_units", Array::Names(&output_units)),
    ];
    let period = linear.discrete.as_ref().map(|(period, _)| [*period]);
    if let (Some(period), Some((_, system))) = (&period, &linear.discrete) {
        all.extend([
            ("period", Array::Vector(period)),
            ("A_d", Array::Matrix(&system.a, [n, n])),
            ("B_d", Array::Matrix(&system.b, [n, m])),
        ]);
    }
    let minimal = minimal(compiled, linear)?;
    if let Some(minimal) = &minimal {
        let k = minimal.count;
        if let Some(system) = &minimal.discrete {
            all.extend([
                ("A_allowed_d", Array::Matrix(&system.a, [k, k])),
                ("B_allowed_d", Array::Matrix(&system.b, [k, m])),
            ]);
        }
        all.extend([
            ("N", Array::Matrix(&minimal.n, [n, k])),
            ("A_allowed", Array::Matrix(&minimal.a, [k, k])),
            ("B_allowed", Array::Matrix(&minimal.b, [k, m])),
            ("C_allowed", Array::Matrix(&minimal.c, [l, k])),
        ]);
    }
    archive(&all)
}

fn output_units(compiled: &CompiledModel) -> Vec<String> {
    let observables = compiled.program().observables.iter();
    observables.map(|known| known.unit.clone()).collect()
}
