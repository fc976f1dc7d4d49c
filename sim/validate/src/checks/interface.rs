//! Bit-for-bit comparison of the interface of emitted source with its program, in double and in single precision. It
//! covers sizes, names, indices, units, initial state, ranges, default parameters, conversions from arrays and
//! preparation with other parameters. All functions are called at zeros, in the domain and at large values. Parameters
//! for which the mass matrix is not positive definite test `positive_definite` and the NaN results of the rates.

use eomgen_codegen::program::evaluator::{Evaluator, PivotState, Point};
use eomgen_codegen::program::{
    BlockPlace, Jacobian, Output, Program, SURFACES_OF_A_REGIME, ValueId,
};
use eomgen_codegen::statements::{
    DataElements, Indices, collect_coefficients, list_data_arrays, list_indices,
};

use super::controllers::{ControllerCalls, expected_lines};
use super::linked_program::{count_differences, format_bits};
use crate::certificate::Worst;
use crate::derived_outputs::dense;
use crate::random::Random;
use crate::sampler::Sample;

const SEED: u64 = 0x1a7e_0f0c;
/// Number of parameter sets, including the values of the specification.
const PARAMETER_SETS: usize = 4;
/// Number of states in the domain for each parameter set. They are the first calls of the set.
pub const STATES: usize = 5;
/// Number of functions of every emitted source: rates, observables, energy, power, guards and mass matrix.
pub const USUAL_FUNCTIONS: usize = 6;
/// Factor for states far outside the usual range, exact in any precision.
const LARGE: f64 = 1024.0;

/// Names of the size constants, in the order of the printed lines.
const SIZES: [&str; 6] = [
    "DEGREES_OF_FREEDOM",
    "STATES",
    "OBSERVABLES",
    "GUARDS",
    "INPUTS",
    "PARAMETERS",
];
/// Functions of the C harnesses that read and print bits.
pub const BITS: &str = include_str!("harness/bits.c");

/// Precision of a harness.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Preparation and functions in double precision.
    Double,
    /// Functions in single precision, preparation in double precision.
    Cast,
    /// Preparation and functions in single precision.
    Single,
}

impl Precision {
    fn round(self, number: f64) -> f64 {
        match self {
            Self::Double => number,
            Self::Cast | Self::Single => f64::from(number as f32),
        }
    }
}

/// Arguments of one call of all functions.
struct Call {
    parameters: Vec<f64>,
    sample: Sample,
    /// True if the mass matrix is positive definite for these parameters.
    is_definite: bool,
}

/// Calls of the harnesses.
pub struct Calls<'p> {
    /// Program with the expected results.
    pub program: &'p Program,
    calls: Vec<Call>,
    controllers: ControllerCalls<'p>,
}

impl<'p> Calls<'p> {
    /// Draws parameter sets and combines each with states of the domain, zeros and large states.
    pub fn new(program: &'p Program, samples: &[Sample]) -> Self {
        let mut random = Random::new(SEED);
        let defaults = program.default_parameters();
        let mut calls = Vec::new();
        for set in 0..PARAMETER_SETS {
            let parameters: Vec<f64> = match set {
                0 => defaults.clone(),
                _ => (defaults.iter())
                    .map(|value| value * (1.0 + 0.3 * random.symmetric()))
                    .collect(),
            };
            let start = (set * STATES).min(samples.len().saturating_sub(STATES));
            let drawn = samples.iter().skip(start).take(STATES);
            let far = samples.get(start).map(|sample| scaled(sample, LARGE));
            let zero = samples.first().map(|sample| scaled(sample, 0.0));
            for sample in drawn.cloned().chain(zero).chain(far) {
                calls.push(Call {
                    parameters: parameters.clone(),
                    sample,
                    is_definite: true,
                });
            }
        }
        if let Some(sample) = samples.first() {
            let all = indefinite_parameters(program).into_iter();
            calls.extend(all.map(|parameters| Call {
                parameters,
                sample: sample.clone(),
                is_definite: false,
            }));
        }
        let parameters: Vec<&[f64]> = calls.iter().map(|call| &*call.parameters).collect();
        Self {
            program,
            controllers: ControllerCalls::new(program, &parameters),
            calls,
        }
    }

    /// Returns the calls as lines of bits: parameters, time, state, inputs.
    pub fn text(&self) -> String {
        let line = |call: &Call| {
            let Sample {
                time,
                state,
                inputs,
            } = &call.sample;
            format_bits(&[&call.parameters[..], &[*time], state, inputs].concat()) + "\n"
        };
        self.calls.iter().map(line).collect()
    }

    /// Returns parameters and point of each call.
    pub fn points(&self) -> impl Iterator<Item = (&[f64], &Sample)> {
        let calls = self.calls.iter();
        calls.map(|call| (&*call.parameters, &call.sample))
    }

    /// Compares the printed lines `found` with the expected lines: first the lines of the interface (if `with_names`),
    /// then the lines of the calls. Returns the number of differences with the first one. `functions` is the number of
    /// functions that the harness calls.
    pub fn compare<'f>(
        &self,
        found: &mut impl Iterator<Item = &'f str>,
        precision: Precision,
        (with_names, functions): (bool, usize),
    ) -> Worst {
        let mut expected = Vec::new();
        if with_names {
            interface_lines(self.program, precision, &mut expected);
        }
        self.result_lines(precision, functions, &mut expected);
        let (mut differing, mut first) = (0, None);
        for (what, expected) in &expected {
            let found = found.next().unwrap_or("nothing");
            let wrong = match expected {
                Expected::Line(expected) if what.starts_with("vector_jacobian_product") => {
                    count_differences(
                        &without_sign_of_zero(found),
                        &without_sign_of_zero(expected),
                    )
                }
                Expected::Line(expected) => count_differences(found, expected),
                Expected::NaNs(expected) => count_differences(&nan_places(found), expected),
                Expected::Any => 0,
            };
            differing += wrong;
            if wrong > 0 && first.is_none() {
                let mode = match precision {
                    Precision::Double => "double",
                    Precision::Cast => "converted",
                    Precision::Single => "single",
                };
                first = Some(format!("first in {what}, {mode} precision"));
            }
        }
        let detail = first.unwrap_or_else(|| format!("{} lines of the interface", expected.len()));
        Worst::from_deviation(differing as f64, detail)
    }

    fn result_lines(
        &self,
        precision: Precision,
        functions: usize,
        lines: &mut Vec<(String, Expected)>,
    ) {
        let mut evaluator = Evaluator::new(self.program.clone());
        let mut double = Evaluator::new(self.program.clone());
        if precision != Precision::Double {
            evaluator = evaluator.in_single_precision(&collect_coefficients(self.program));
        }
        for (count, call) in (1..).zip(&self.calls) {
            let round = |number: &f64| precision.round(*number);
            match precision {
                Precision::Single => {
                    let parameters: Vec<f64> = call.parameters.iter().map(round).collect();
                    evaluator.prepare_in_single_precision(&parameters);
                }
                _ => evaluator.prepare(&call.parameters),
            }
            let state: Vec<f64> = call.sample.state.iter().map(round).collect();
            let inputs: Vec<f64> = call.sample.inputs.iter().map(round).collect();
            let point = Point {
                t: precision.round(call.sample.time),
                state: &state,
                inputs: &inputs,
            };
            // Coefficients converted from double precision keep the result of the test for definite mass from
            // `prepare`.
            let definite = match precision {
                Precision::Cast => {
                    double.prepare(&call.parameters);
                    u8::from(double.pivots_are_positive())
                }
                _ => u8::from(evaluator.pivots_are_positive()),
            };
            lines.push((
                format!("positive_definite, call {count}"),
                Expected::Line(definite.to_string()),
            ));
            let all = results(&mut evaluator, point);
            let printed = |place: usize, name: &str| place < functions || name == "step";
            let all = all.into_iter().enumerate();
            for (_, (name, numbers)) in all.filter(|(place, (name, _))| printed(*place, name)) {
                // The evaluator adds the two numbers of this product in double precision, so the sum must be rounded.
                let numbers: Vec<f64> = numbers.iter().map(round).collect();
                let line = format_bits(&numbers);
                let expected = match (call.is_definite, &*name) {
                    (true, _) => Expected::Line(line),
                    (false, "rates") => Expected::NaNs(nan_places(&line)),
                    (false, _) => Expected::Any,
                };
                lines.push((format!("{name}, call {count}"), expected));
            }
            if precision == Precision::Double {
                let of_controllers =
                    expected_lines(&self.controllers, (count - 1, &call.parameters[..]));
                lines.extend(of_controllers.into_iter().map(|(name, line)| {
                    let expected = match call.is_definite {
                        true => Expected::Line(line),
                        false => Expected::Any,
                    };
                    (name, expected)
                }));
            }
        }
    }
}

/// Expected line of a harness.
enum Expected {
    /// The line itself.
    Line(String),
    /// Places of NaN, as [`nan_places`] returns them.
    NaNs(String),
    /// Any line: results that are not specified.
    Any,
}

/// Replaces every number of a line of bits by `nan` or `number`.
fn nan_places(line: &str) -> String {
    let is_nan =
        |word: &str| u64::from_str_radix(word, 16).is_ok_and(|b| f64::from_bits(b).is_nan());
    let words = line.split(' ').map(|word| match is_nan(word) {
        true => "nan",
        false => "number",
    });
    words.collect::<Vec<_>>().join(" ")
}

/// Returns parameters for which a prepared pivot is not positive or not finite. Each has another combination of such
/// pivots. A single parameter is negated, set to zero or infinite.
fn indefinite_parameters(program: &Program) -> Vec<Vec<f64>> {
    let defaults = program.default_parameters();
    let mut evaluator = Evaluator::new(program.clone());
    let mut known: Vec<Vec<PivotState>> = Vec::new();
    let mut found = Vec::new();
    for place in 0..defaults.len() {
        for factor in [-1.0, -LARGE, 0.0, f64::INFINITY] {
            let mut parameters = defaults.clone();
            parameters[place] *= factor;
            evaluator.prepare(&parameters);
            let states: Vec<PivotState> = evaluator.pivot_states().collect();
            if !evaluator.pivots_are_positive() && !known.contains(&states) {
                known.push(states);
                found.push(parameters);
            }
        }
    }
    found
}

/// Returns rows and columns of the structural nonzeros, in their order.
fn nonzero_places(jacobian: &Jacobian<ValueId>) -> [Vec<usize>; 2] {
    let mut places = [vec![0; jacobian.nonzeros()], vec![0; jacobian.nonzeros()]];
    for (entry, BlockPlace { start, width }) in jacobian.entries.iter().zip(jacobian.places()) {
        for row in 0..entry.rows {
            for place in 0..entry.width() {
                let column = if entry.diagonal { row } else { place };
                places[0][start + width * row + place] = entry.row + row;
                places[1][start + width * row + place] = entry.column + column;
            }
        }
    }
    places
}

/// Replaces -0 by 0: a product that is added to a zero entry cannot be -0.
fn without_sign_of_zero(line: &str) -> String {
    line.replace("8000000000000000", "0000000000000000")
}

fn scaled(sample: &Sample, factor: f64) -> Sample {
    Sample {
        time: sample.time,
        state: sample.state.iter().map(|number| factor * number).collect(),
        inputs: sample.inputs.clone(),
    }
}

/// Returns the number at index `place` of an argument that is equal in every call. It is exact in any precision.
fn argument(place: usize) -> f64 {
    0.5 + 0.25 * place as f64
}

/// Returns the first `count` numbers of this argument.
pub fn arguments(count: usize) -> Vec<f64> {
    (0..count).map(argument).collect()
}

/// Returns names and results of all functions, in the order of the harnesses.
fn results(evaluator: &mut Evaluator, point: Point<'_>) -> Vec<(String, Vec<f64>)> {
    let program = &evaluator.program().clone();
    let (states, degrees, guards) = (
        program.states(),
        program.degrees_of_freedom(),
        evaluator.guard_count(),
    );
    let (observables, known) = (program.observables.len(), program.observable_values.len());
    let jacobians: Vec<(String, usize)> = (program.outputs.jacobians.iter())
        .map(|jacobian| (jacobian.name.to_owned(), jacobian.nonzeros()))
        .collect();
    let inputs = program.inputs.len();
    let parameters = program.parameters.len();
    let room = |length: usize| vec![0.0; length];
    let mut all = Vec::new();
    let mut add = |name: &str, numbers: Vec<f64>| all.push((name.to_owned(), numbers));
    let mut rates = room(states);
    evaluator.rates(point, &mut rates);
    add("rates", rates);
    let mut values = room(known);
    evaluator.observables(point, &mut values);
    add("observables", values[..observables].to_vec());
    add("energy", vec![values[known - 2]]);
    add("power", vec![values[known - 1]]);
    let mut surfaces = room(guards);
    evaluator.guards(point, &mut surfaces);
    add("guards", surfaces);
    let mut mass = room(degrees * degrees);
    evaluator.mass_matrix(point, &mut mass);
    add("mass_matrix", mass);
    let mut out = room(degrees);
    if evaluator.bias_forces(point, &mut out) {
        add("bias_forces", out.clone());
    }
    if evaluator.inverse_dynamics(point, &arguments(degrees), &mut out) {
        add("inverse_dynamics", out);
    }
    let mut rates = room(guards);
    if evaluator.guard_rates(point, &mut rates) {
        add("guard_rates", rates);
    }
    for (place, (name, nonzeros)) in jacobians.iter().enumerate() {
        let mut out = room(*nonzeros);
        if evaluator.jacobian(place, point, &mut out) {
            add(name, out);
        }
    }
    let (mut product, mut input_product) = (room(states), room(inputs));
    let direction = (&*arguments(states), &*arguments(inputs));
    if evaluator.jacobian_vector_product(point, direction, &mut product) {
        add("jacobian_vector_product", product.clone());
    }
    let weights = arguments(states);
    let products = (&mut *product, &mut *input_product);
    if evaluator.vector_jacobian_product(point, &weights, products) {
        add("vector_jacobian_product", [product, input_product].concat());
    }
    let mut product = room(parameters);
    if evaluator.vector_jacobian_product_by_parameters(point, &weights, &mut product) {
        add("vector_jacobian_product_by_parameters", product);
    }
    let has = |output: Output| program.outputs.kinds.contains(&output);
    if has(Output::Linearisation) {
        let rates = all[0].1.clone();
        let observables = all[1].1.clone();
        all.push(("linearise, rates".to_owned(), rates));
        all.push(("linearise, observables".to_owned(), observables));
        for name in linearised(program) {
            let found = program.outputs.jacobians.iter().enumerate();
            let found = found.clone().find(|(_, jacobian)| jacobian.name == name);
            let Some((place, jacobian)) = found else {
                continue;
            };
            let mut nonzeros = room(jacobian.nonzeros());
            evaluator.jacobian(place, point, &mut nonzeros);
            // nalgebra stores matrices by columns, C by rows.
            let matrix = dense(jacobian, &nonzeros).transpose();
            all.push((format!("linearise, {name}"), matrix.as_slice().to_vec()));
        }
    }
    if has(Output::Regimes) {
        let guards = all[4].1.iter().take(SURFACES_OF_A_REGIME).enumerate();
        let set = guards.filter(|(_, guard)| **guard > 0.0);
        let regime: u32 = set.map(|(bit, _)| 1_u32 << bit).sum();
        all.push(("regime".to_owned(), vec![f64::from(regime)]));
        let rates = all[0].1.clone();
        all.push(("rates_in_regime".to_owned(), rates));
    }
    if has(Output::Step) {
        let mut state = point.state.to_vec();
        let mut memory = evaluator.create_step_memory();
        evaluator.step((point.t, STEP), &mut state, point.inputs, &mut memory);
        all.push(("step".to_owned(), state));
    }
    all
}

/// Step size of the harnesses in s, exact in any precision.
const STEP: f64 = 1.0 / 1024.0;

/// Returns the names of the Jacobians of a linearisation that have at least one column.
fn linearised(program: &Program) -> Vec<&'static str> {
    let names = [
        "rates_by_state",
        "rates_by_inputs",
        "observables_by_state",
        "observables_by_inputs",
    ];
    let has_columns = |name: &&str| !name.ends_with("inputs") || !program.inputs.is_empty();
    names.into_iter().filter(has_columns).collect()
}

/// Collects the expected lines of sizes, names, indices, default parameters and conversions from arrays.
fn interface_lines(program: &Program, precision: Precision, lines: &mut Vec<(String, Expected)>) {
    let mut add = |what: &str, text: String| lines.push((what.to_owned(), Expected::Line(text)));
    let guards = Evaluator::new(program.clone()).guard_count();
    let sizes = [
        program.degrees_of_freedom(),
        program.states(),
        program.observables.len(),
        guards,
        program.inputs.len(),
        program.parameters.len(),
    ];
    for size in sizes {
        add("sizes", size.to_string());
    }
    add("the hash of the specification", program.spec_hash.clone());
    for field in &program.fields {
        add("the orders", field.order.to_string());
    }
    for Indices { kind, entries, .. } in list_indices(program) {
        for (place, (name, _)) in entries.iter().enumerate() {
            add(&format!("the names of kind {kind}"), name.clone());
            add(&format!("the indices of kind {kind}"), place.to_string());
        }
    }
    for jacobian in &program.outputs.jacobians {
        let what = format!("the nonzeros of {}", jacobian.name);
        add(&what, jacobian.nonzeros().to_string());
        for places in nonzero_places(jacobian) {
            for place in places {
                add(&what, place.to_string());
            }
        }
    }
    for data in list_data_arrays(program) {
        match data.elements {
            DataElements::Texts(texts) => texts.into_iter().for_each(|text| add(data.name, text)),
            DataElements::Numbers(numbers) => {
                let of_file = |number: f64| match precision {
                    Precision::Single => precision.round(number),
                    _ => number,
                };
                let numbers: Vec<f64> = numbers.into_iter().map(of_file).collect();
                add(data.name, format_bits(&numbers));
            }
        }
    }
    let count = program.parameters.len();
    let round = |numbers: Vec<f64>| -> Vec<f64> {
        let of_parameters = |number: f64| match precision {
            Precision::Single => precision.round(number),
            _ => number,
        };
        numbers.into_iter().map(of_parameters).collect()
    };
    add(
        "the default parameters",
        format_bits(&round(program.default_parameters())),
    );
    add("parameters from an array", format_bits(&arguments(count)));
    add(
        "inputs from an array",
        format_bits(&arguments(program.inputs.len())),
    );
}

/// Writes the harness for emitted C with the prefix `name`.
pub fn c_harness(all: &Calls<'_>, name: &str) -> String {
    let program = all.program;
    let mut interface = String::new();
    for size in SIZES {
        interface += &format!("    printf(\"%d\\n\", (int)NAME_{size});\n");
    }
    interface += "    printf(\"%s\\n\", NAME_SPECIFICATION_SHA256);\n";
    for place in 0..program.fields.len() {
        interface += &format!("    printf(\"%d\\n\", NAME_orders[{place}]);\n");
    }
    for Indices { kind, entries, .. } in list_indices(program) {
        for (place, (_, constant)) in entries.iter().enumerate() {
            let capitals = kind.to_uppercase();
            interface += &format!(
                "    printf(\"%s\\n%d\\n\", NAME_{kind}_names[{place}], (int)NAME_{capitals}_{constant});\n"
            );
        }
    }
    for jacobian in &program.outputs.jacobians {
        let (name, count) = (jacobian.name, jacobian.nonzeros());
        let size = format!("NAME_{}_NONZEROS", name.to_uppercase());
        let room = count + 1;
        interface += &format!(
            "    {{ static int rows[{room}], columns[{room}]; printf(\"%d\\n\", (int){size}); \
             NAME_{name}_places(rows, columns); \
             for (int i = 0; i < {count}; ++i) {{ printf(\"%d\\n\", rows[i]); }} \
             for (int i = 0; i < {count}; ++i) {{ printf(\"%d\\n\", columns[i]); }} }}\n"
        );
    }
    for data in list_data_arrays(program) {
        let name = data.name;
        match data.elements {
            DataElements::Texts(texts) => {
                for place in 0..texts.len() {
                    interface += &format!("    printf(\"%s\\n\", NAME_{name}[{place}]);\n");
                }
            }
            DataElements::Numbers(numbers) => {
                interface += &format!("    show(NAME_{name}, {});\n", numbers.len());
            }
        }
    }
    let show = |of: &str, names: &[&str]| {
        let values: Vec<String> = names.iter().map(|field| format!("{of}.{field}")).collect();
        let values = if values.is_empty() {
            "0".to_owned()
        } else {
            values.join(", ")
        };
        format!(
            "    {{ const NAME_real all[] = {{{values}}}; show(all, {}); }}\n",
            names.len()
        )
    };
    let parameters: Vec<&str> = (program.parameters.iter())
        .map(|parameter| &*parameter.quantity.name)
        .collect();
    let inputs: Vec<&str> = program.inputs.iter().map(|input| &*input.name).collect();
    interface += "    NAME_default_parameters(&parameters);\n";
    interface += &show("parameters", &parameters);
    interface += "    NAME_parameters_from_array(given, &parameters);\n";
    interface += &show("parameters", &parameters);
    interface += "    NAME_inputs_from_array(given, &inputs);\n";
    interface += &show("inputs", &inputs);
    let at = "t[0], state, &inputs, &coefficients";
    let mut calls = String::new();
    let array = |name: &str, more: &str, length: usize| {
        format!("        NAME_{name}({at}{more}, out); show(out, {length});\n")
    };
    let guards = Evaluator::new(program.clone()).guard_count();
    let (states, degrees) = (program.states(), program.degrees_of_freedom());
    calls += &array("rates", "", states);
    calls += &array("observables", "", program.observables.len());
    for name in ["energy", "power"] {
        calls += &format!("        out[0] = NAME_{name}({at}); show(out, 1);\n");
    }
    calls += &array("guards", "", guards);
    let matrix = "(NAME_real (*)[NAME_DEGREES_OF_FREEDOM])out";
    calls += &format!(
        "        NAME_mass_matrix({at}, {matrix}); show(out, {});\n",
        degrees * degrees
    );
    let outputs = &program.outputs;
    if outputs.bias_forces.is_some() {
        calls += &array("bias_forces", "", degrees);
    }
    if outputs.inverse_dynamics.is_some() {
        calls += &array("inverse_dynamics", ", given", degrees);
    }
    if outputs.guard_rates.is_some() {
        calls += &array("guard_rates", "", guards);
    }
    for jacobian in &outputs.jacobians {
        calls += &array(jacobian.name, "", jacobian.nonzeros());
    }
    if outputs.products.is_some() {
        calls += &array("jacobian_vector_product", ", given, &given_inputs", states);
        let fields: String = (inputs.iter().enumerate())
            .map(|(place, field)| format!("out[{states} + {place}] = product.{field}; "))
            .collect();
        calls += &format!(
            "        {{ NAME_inputs product; NAME_vector_jacobian_product({at}, given, out, &product); {fields}show(out, {}); }}\n",
            states + inputs.len()
        );
        calls += &format!(
            "        NAME_vector_jacobian_product_by_parameters({at}, given, out); show(out, {});\n",
            parameters.len()
        );
    }
    let has = |output: Output| outputs.kinds.contains(&output);
    if has(Output::Linearisation) {
        calls +=
            &format!("        static NAME_linearisation about; NAME_linearise({at}, &about);\n");
        calls += &format!("        show(about.rates, {states});\n");
        calls += &format!(
            "        show(about.observables, {});\n",
            program.observables.len()
        );
        for name in linearised(program) {
            let (matrix, rows) = match name {
                "rates_by_state" => ("A", states),
                "rates_by_inputs" => ("B", states),
                "observables_by_state" => ("C", program.observables.len()),
                _ => ("D", program.observables.len()),
            };
            let columns = match name.ends_with("state") {
                true => states,
                false => inputs.len(),
            };
            calls += &format!("        show(&about.{matrix}[0][0], {});\n", rows * columns);
        }
    }
    if has(Output::Regimes) {
        // On a switching surface, `rates_in_regime` has the rates of one side, so `rates` is called instead.
        let unused = match guards {
            0 => String::new(),
            _ => format!(
                "NAME_guards({at}, out); for (int k = 0; k < {guards}; ++k) {{ if (out[k] == 0) {{ is_on_surface = 1; }} }} "
            ),
        };
        calls += &format!(
            "        {{ int is_on_surface = 0; const uint32_t regime = NAME_regime({at}); {unused}\
             out[0] = (NAME_real)regime; show(out, 1); \
             if (is_on_surface) {{ NAME_rates({at}, out); }} else {{ NAME_rates_in_regime({at}, regime, out); }} \
             show(out, {states}); }}\n"
        );
    }
    if has(Output::Step) {
        calls += &format!(
            "        NAME_step(t[0], (NAME_real){STEP:?}, state, &inputs, &coefficients); show(state, {states});\n"
        );
    }
    calls += &all.controllers.c_calls();
    let jacobians = outputs.jacobians.iter().map(|jacobian| jacobian.nonzeros());
    let room = jacobians
        .max()
        .unwrap_or(0)
        .max(degrees * degrees)
        .max(states + inputs.len());
    let room = room
        .max(program.observables.len())
        .max(guards)
        .max(parameters.len());
    include_str!("harness/interface.c")
        .replace("/*BITS*/", BITS)
        .replace("/*INTERFACE*/", &interface)
        .replace("/*CALLS*/", &calls)
        .replace("ROOM", &(room + 1).to_string())
        .replace("NAME.h", &format!("{name}.h"))
        .replace("NAME_", &format!("{name}_"))
}

/// Writes the harness for emitted Rust: the interface, the calls in double precision, then those in single precision.
pub fn rust_harness(all: &Calls<'_>, emitted: &str) -> String {
    let program = all.program;
    let mut interface = String::new();
    for size in SIZES {
        interface += &format!("    println!(\"{{}}\", model::{size});\n");
    }
    interface += "    println!(\"{}\", model::SPECIFICATION_SHA256);\n";
    for place in 0..program.fields.len() {
        interface += &format!("    println!(\"{{}}\", model::ORDERS[{place}]);\n");
    }
    for Indices { kind, entries, .. } in list_indices(program) {
        for (place, (_, constant)) in entries.iter().enumerate() {
            let capitals = kind.to_uppercase();
            interface += &format!(
                "    println!(\"{{}}\\n{{}}\", model::{capitals}_NAMES[{place}], model::{kind}::{constant});\n"
            );
        }
    }
    for jacobian in &program.outputs.jacobians {
        let name = jacobian.name.to_uppercase();
        interface += &format!(
            "    println!(\"{{}}\", model::{name}.rows.len());\n    \
             for place in model::{name}.rows.iter().chain(&model::{name}.columns) {{ println!(\"{{place}}\"); }}\n"
        );
    }
    for data in list_data_arrays(program) {
        let name = data.name.to_uppercase();
        interface += &match data.elements {
            DataElements::Texts(_) => {
                format!("    model::{name}.iter().for_each(|text| println!(\"{{text}}\"));\n")
            }
            DataElements::Numbers(_) => format!("    show::<f64>(&model::{name});\n"),
        };
    }
    let show = |of: &str, names: Vec<&str>| {
        let values: Vec<String> = names.iter().map(|field| format!("{of}.{field}")).collect();
        format!("    show::<f64>(&[{}]);\n", values.join(", "))
    };
    let parameters = || (program.parameters.iter()).map(|parameter| &*parameter.quantity.name);
    let inputs = || program.inputs.iter().map(|input| &*input.name);
    let numbers = |count: usize| {
        let numbers: Vec<String> = arguments(count)
            .iter()
            .map(|n| format!("{n:?}_f64"))
            .collect();
        format!("[{}] as [f64; {count}]", numbers.join(", "))
    };
    interface += "    let parameters = model::Parameters::default();\n";
    interface += &show("parameters", parameters().collect());
    // A type without fields has no conversion from an array.
    if !program.parameters.is_empty() {
        let list = |of: &str, end: &str| -> String {
            let fields = parameters().map(|field| format!("{of}.{field}{end}"));
            fields.collect::<Vec<_>>().join(", ")
        };
        interface += &format!(
            "    let single = parameters.cast::<f32>();\n    assert!([{}] == [{}], \"conversion of the parameters\");\n",
            list("single", ""),
            list("parameters", " as f32")
        );
    }
    if !program.inputs.is_empty() {
        let fields: Vec<String> = inputs()
            .map(|field| format!("zero.{field} == 0.0"))
            .collect();
        interface += &format!(
            "    let zero = model::Inputs::<f64>::default();\n    assert!({}, \"default inputs\");\n",
            fields.join(" && ")
        );
    }
    interface += &format!(
        "    let parameters = model::Parameters::from({});\n",
        numbers(program.parameters.len())
    );
    interface += &show("parameters", parameters().collect());
    interface += &format!(
        "    let inputs = model::Inputs::from({});\n",
        numbers(program.inputs.len())
    );
    interface += &show("inputs", inputs().collect());
    let step = match program.outputs.kinds.contains(&Output::Step) {
        true => format!(
            "    let mut state = state;\n    model::step(t, convert({STEP:?}), &mut state, &inputs, coefficients);\n    show(&state);\n"
        ),
        false => String::new(),
    };
    let source = include_str!("harness/interface.rs")
        .replace("    //INTERFACE\n", &interface)
        .replace("    //STEP\n", &step)
        .replace(
            "                //CONTROLLERS\n",
            &all.controllers.rust_calls(),
        );
    // A type without fields is not generic.
    let has_coefficients = emitted.contains("pub struct Coefficients<");
    source
        .replace(
            "/*CAST*/",
            if has_coefficients {
                ".cast::<f32>()"
            } else {
                ""
            },
        )
        .replace("/*OF T*/", if has_coefficients { "<T>" } else { "" })
}
