//! Comparison of emitted source with other number types:
//!
//! - requested outputs and 8-wide SIMD: bit for bit with the evaluator;
//! - single precision: within an error bound that the same source computes with numbers that carry error bounds.

use super::super::certificate::{Check, SkipKind, Worst};
use super::super::compiler::{Compiler, Optimization};
use super::super::outputs::{Outputs, requested_jacobians};
use super::super::random::Random;
use super::super::sampler::Sample;
use super::super::variant::Variant;
use super::linked_program::{Emitted, count_differences, format_bits, run_linked};
use std::path::Path;

/// Tolerance in units of the error bound. Double precision changes the bound by much less than 1e-6.
const SINGLE_TOLERANCE: f64 = 1.0 + 1e-6;
/// Maximum number of states, compared in groups of eight for SIMD.
const STATES: usize = 48;
const LANES: usize = 8;
const SEED: u64 = 0x51de_5eed;

pub type BorrowedOutputs<'r> = &'r mut (dyn Outputs + 'static);

struct Arguments {
    sample: Sample,
    accelerations: Vec<f64>,
    direction: Vec<f64>,
    input_direction: Vec<f64>,
    weights: Vec<f64>,
}

impl Arguments {
    fn draw(sample: &Sample, degrees: usize, random: &mut Random) -> Self {
        let mut draw = |count: usize| (0..count).map(|_| random.away_from_zero()).collect();
        Self {
            accelerations: draw(degrees),
            direction: draw(sample.state.len()),
            input_direction: draw(sample.inputs.len()),
            weights: draw(sample.state.len()),
            sample: sample.clone(),
        }
    }

    fn format_line(&self) -> String {
        let Sample {
            time,
            state,
            inputs,
        } = &self.sample;
        let [a, d, u, w] = [
            &self.accelerations,
            &self.direction,
            &self.input_direction,
            &self.weights,
        ];
        format_bits(&[&[*time][..], state, inputs, a, d, u, w].concat())
    }
}

fn names(outputs: &[String]) -> Vec<&'static str> {
    let has = |name: &str| outputs.iter().any(|known| known == name);
    let mut found = Vec::new();
    if harness_calls(outputs)
        .iter()
        .any(|call| call.row == "emitted_requests")
    {
        found.push("emitted_requests");
    }
    for name in ["linearisation", "lanes"] {
        if has(name) {
            found.push(name);
        }
    }
    found.push("f32");
    found
}

fn check_tolerance(name: &str) -> f64 {
    if name == "f32" { SINGLE_TOLERANCE } else { 0.0 }
}

pub fn skipped_checks(outputs: &[String], kind: SkipKind, reason: &str) -> Vec<Check> {
    let names = names(outputs).into_iter();
    names
        .map(|name| {
            Check::with_skip(
                name.to_owned(),
                check_tolerance(name),
                kind,
                reason.to_owned(),
            )
        })
        .collect()
}

pub fn check(
    compiler: &Compiler,
    folder: &Path,
    emitted: &Emitted,
    (variant, functions): (&mut dyn Variant, Option<BorrowedOutputs<'_>>),
    samples: &[Sample],
) -> Vec<Check> {
    let Some(outputs) = &emitted.outputs else {
        return Vec::new();
    };
    let degrees = variant.coordinate_names().len();
    let mut random = Random::new(SEED);
    let arguments: Vec<Arguments> = samples
        .iter()
        .take(STATES)
        .map(|sample| Arguments::draw(sample, degrees, &mut random))
        .collect();
    let calls = harness_calls(outputs);
    let text: Vec<String> = arguments.iter().map(Arguments::format_line).collect();
    let source = harness_source(emitted, &calls, outputs);
    let found = run_linked(
        compiler,
        folder,
        ("kinds", &source),
        Optimization::None,
        &(text.join("\n") + "\n"),
    )
    .and_then(|lines| {
        let mut reading = OutputReader {
            lines: lines.lines(),
            variant,
            functions,
        };
        reading.worst_deviations(outputs, &calls, &arguments)
    });
    match found {
        Ok(checks) => checks,
        Err(message) => names(outputs)
            .into_iter()
            .map(|name| {
                let worst = Worst::from_deviation(f64::INFINITY, message.clone());
                Check::from_deviation(name, worst, check_tolerance(name))
            })
            .collect(),
    }
}

struct Call {
    row: &'static str,
    name: &'static str,
    text: String,
}

fn harness_calls(outputs: &[String]) -> Vec<Call> {
    let has = |name: &str| outputs.iter().any(|known| known == name);
    let at = "t, &state, &inputs, &coefficients";
    let mut calls = Vec::new();
    let mut add = |row, name, text| calls.push(Call { row, name, text });
    for (name, more) in [
        ("bias_forces", ""),
        ("inverse_dynamics", ", &accelerations"),
        ("guard_rates", ""),
    ] {
        if has(name) {
            add(
                "emitted_requests",
                name,
                format!("model::{name}({at}{more}).print();"),
            );
        }
    }
    for name in requested_jacobians(outputs) {
        let (rows, columns) = jacobian_extents(name);
        let pattern = name.to_uppercase();
        let text = format!(
            "let dense: [[f64; model::{columns}]; model::{rows}] = \
             model::{pattern}.dense(&model::{name}({at})); dense.print();"
        );
        add("emitted_requests", name, text);
    }
    if has("products") {
        let text = format!(
            "model::jacobian_vector_product({at}, &direction, &inputs_of(input_direction)).print();"
        );
        add("emitted_requests", "jacobian_vector_product", text);
        let text = format!(
            "let (by_state, by_inputs) = model::vector_jacobian_product({at}, &weights); \
             by_state.print(); let by_inputs: [f64; INPUTS] = [/*FIELDS*/]; by_inputs.print();"
        );
        add("emitted_requests", "vector_jacobian_product", text);
        let name = "vector_jacobian_product_by_parameters";
        add(
            "emitted_requests",
            name,
            format!("model::{name}({at}, &weights).print();"),
        );
    }
    if has("linearisation") {
        let text = format!(
            "let l = model::linearise({at}); l.rates.print(); l.observables.print(); \
             l.A.print(); l.B.print(); l.C.print(); l.D.print();"
        );
        add("linearisation", "linearise", text);
    }
    calls
}

fn jacobian_extents(name: &str) -> (&'static str, &'static str) {
    let rows = if name.starts_with("rates") {
        "STATES"
    } else {
        "OBSERVABLES"
    };
    let columns = match name.rsplit('_').next() {
        Some("state") => "STATES",
        Some("inputs") => "INPUTS",
        _ => "PARAMETERS",
    };
    (rows, columns)
}

fn harness_source(emitted: &Emitted, calls: &[Call], outputs: &[String]) -> String {
    let fields = emitted.input_fields.iter();
    let by_inputs: Vec<String> = fields.map(|field| format!("by_inputs.{field}")).collect();
    let statement = |call: &Call| {
        let text = call.text.replace("/*FIELDS*/", &by_inputs.join(", "));
        format!("        {{ {text} }}\n")
    };
    let statements: String = calls.iter().map(statement).collect();
    let mut source = include_str!("harness/kinds.rs")
        .replace("        //CALLS\n", &statements)
        .replace("//INPUTS\n", &input_constructor(&emitted.input_fields));
    // `Coefficients` without fields is not generic, so it needs no cast.
    let has_coefficients = emitted.source.contains("pub struct Coefficients<");
    for kind in ["f32", "Rounded"] {
        let conversion = if has_coefficients {
            format!(".cast::<{kind}>()")
        } else {
            String::new()
        };
        source = source.replace(&format!("/*CAST {kind}*/"), &conversion);
    }
    if outputs.iter().any(|name| name == "lanes") {
        source = source
            .replace("//LANES\n", include_str!("harness/lanes.rs"))
            .replace("        //GROUPS\n", COMPARE_GROUP);
    }
    source
}

const COMPARE_GROUP: &str = "        if group.len() == 8 {
            let found = compare_lanes(&group, &coefficients);
            lanes = [lanes[0] + found[0], lanes[1] + found[1]];
            group.clear();
        }
";

/// Returns the constant `INPUTS` and a function that creates the inputs from an array.
fn input_constructor(fields: &[String]) -> String {
    let count = format!("const INPUTS: usize = {};\n\n", fields.len());
    if fields.is_empty() {
        let none = "fn inputs_of<T>(_: [T; INPUTS]) -> model::Inputs {\n    model::Inputs {}\n}\n";
        return count + none;
    }
    let given = fields.iter().enumerate();
    let given: Vec<String> = given
        .map(|(i, field)| format!("{field}: given[{i}]"))
        .collect();
    let given = given.join(", ");
    let head = "fn inputs_of<T: Copy>(given: [T; INPUTS]) -> model::Inputs<T> {";
    format!("{count}{head}\n    model::Inputs {{ {given} }}\n}}\n")
}

struct OutputReader<'l, 'r> {
    lines: std::str::Lines<'l>,
    variant: &'r mut dyn Variant,
    functions: Option<BorrowedOutputs<'r>>,
}

impl OutputReader<'_, '_> {
    fn next_line(&mut self) -> Result<String, String> {
        let line = self.lines.next();
        Ok(line
            .ok_or("the compiled model printed fewer lines than expected")?
            .to_owned())
    }

    fn worst_deviations(
        &mut self,
        outputs: &[String],
        calls: &[Call],
        arguments: &[Arguments],
    ) -> Result<Vec<Check>, String> {
        let mut rows = [
            ("emitted_requests", 0, 0, None),
            ("linearisation", 0, 0, None),
        ];
        for (count, arguments) in (1..).zip(arguments) {
            for call in calls {
                for expected in self.expected(call.name, arguments)? {
                    let wrong = count_differences(&self.next_line()?, &format_bits(&expected));
                    let row = rows.iter_mut().find(|row| row.0 == call.row);
                    let Some((_, compared, differing, first)) = row else {
                        continue;
                    };
                    *compared += expected.len();
                    *differing += wrong;
                    if wrong > 0 && first.is_none() {
                        *first = Some(format!("first in {} at state {count}", call.name));
                    }
                }
            }
        }
        let (single, lanes) = (
            parse_numbers(&self.next_line()?)?,
            parse_numbers(&self.next_line()?)?,
        );
        let mut checks = Vec::new();
        for name in names(outputs) {
            let worst = match name {
                "f32" => single_deviation(&single),
                "lanes" => {
                    let detail = format!(
                        "{} numbers in groups of {LANES} states",
                        number_at(&lanes, 1)
                    );
                    Worst::from_deviation(number_at(&lanes, 0), detail)
                }
                _ => bit_deviation(&rows, name),
            };
            checks.push(if name == "f32" && number_at(&single, 1) == 0.0 {
                let reason = "no result is in the range of single precision";
                Check::not_applicable(name, SINGLE_TOLERANCE, reason)
            } else {
                Check::from_deviation(name, worst, check_tolerance(name))
            });
        }
        Ok(checks)
    }

    fn expected(&mut self, name: &str, at: &Arguments) -> Result<Vec<Vec<f64>>, String> {
        let sample = &at.sample;
        let missing = || format!("the variant has no function {name}");
        let functions = self.functions.as_deref_mut().ok_or_else(missing)?;
        let found = match name {
            "bias_forces" => functions.bias_forces(sample).map(|rows| vec![rows]),
            "inverse_dynamics" => {
                let rows = functions.inverse_dynamics(sample, &at.accelerations);
                rows.map(|rows| vec![rows])
            }
            "guard_rates" => functions.guard_rates(sample).map(|rates| vec![rates]),
            "jacobian_vector_product" => functions
                .jacobian_vector_product(sample, &at.direction, &at.input_direction)
                .map(|rows| vec![rows]),
            "vector_jacobian_product" => functions
                .vector_jacobian_product(sample, &at.weights)
                .map(|(by_state, by_inputs)| vec![by_state, by_inputs]),
            "vector_jacobian_product_by_parameters" => functions
                .vector_jacobian_product_by_parameters(sample, &at.weights)
                .map(|rows| vec![rows]),
            "linearise" => return self.expected_linearisation(sample),
            name => jacobian_by_rows(functions, name, sample).map(|rows| vec![rows]),
        };
        found.ok_or_else(missing)
    }

    fn expected_linearisation(&mut self, sample: &Sample) -> Result<Vec<Vec<f64>>, String> {
        let Sample {
            time,
            state,
            inputs,
        } = sample;
        let mut rates = vec![f64::NAN; state.len()];
        self.variant.rates(*time, state, inputs, &mut rates)?;
        let observables = self.variant.observables(*time, state, inputs)?;
        let mut found = vec![rates, observables];
        for name in [
            "rates_by_state",
            "rates_by_inputs",
            "observables_by_state",
            "observables_by_inputs",
        ] {
            let functions = self.functions.as_deref_mut();
            let rows = functions.and_then(|functions| jacobian_by_rows(functions, name, sample));
            found.push(rows.ok_or_else(|| format!("the variant has no function {name}"))?);
        }
        Ok(found)
    }
}

fn jacobian_by_rows(functions: &mut dyn Outputs, name: &str, sample: &Sample) -> Option<Vec<f64>> {
    let jacobian = functions.jacobian(name, sample)?;
    Some(jacobian.transpose().as_slice().to_vec())
}

type BitRow = (&'static str, usize, usize, Option<String>);

fn bit_deviation(rows: &[BitRow], name: &str) -> Worst {
    match rows.iter().find(|row| row.0 == name) {
        Some((_, compared, differing, first)) => {
            let all = || format!("{compared} numbers");
            Worst::from_deviation(*differing as f64, first.clone().unwrap_or_else(all))
        }
        None => Worst::default(),
    }
}

fn single_deviation(found: &[f64]) -> Worst {
    let detail = format!(
        "as a fraction of the rounding bound; {} numbers, {} of them with a bound below 1 %",
        number_at(found, 1),
        number_at(found, 2)
    );
    Worst::from_deviation(number_at(found, 0), detail)
}

fn number_at(numbers: &[f64], place: usize) -> f64 {
    numbers.get(place).copied().unwrap_or(f64::NAN)
}

fn parse_numbers(line: &str) -> Result<Vec<f64>, String> {
    let words = line.split(' ');
    let number = |word: &str| u64::from_str_radix(word, 16).map(f64::from_bits);
    words
        .map(|word| {
            number(word).map_err(|_| {
                format!("the compiled model printed {word:?}, expected 16 hexadecimal digits")
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn harness(inputs: &[&str], outputs: &[&str], source: &str) -> String {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let outputs: Vec<String> = owned(outputs);
        let emitted = Emitted {
            source: source.to_owned(),
            input_fields: owned(inputs),
            functions: Vec::new(),
            outputs: Some(outputs.clone()),
        };
        harness_source(&emitted, &harness_calls(&outputs), &outputs)
    }

    #[test]
    fn harness_has_no_placeholder_left() {
        let all = [
            "bias_forces",
            "inverse_dynamics",
            "guard_rates",
            "jacobians",
            "products",
            "linearisation",
            "lanes",
        ];
        let text = harness(&["u", "f"], &all, "pub struct Coefficients<T = f64> {");
        for place in [
            "//CALLS", "//INPUTS", "//LANES", "//GROUPS", "CAST", "FIELDS",
        ] {
            assert!(!text.contains(place), "{place}");
        }
        assert!(text.contains("model::Inputs { u: given[0], f: given[1] }"));
        assert!(text.contains("[by_inputs.u, by_inputs.f]"));
        assert!(text.contains("coefficients.cast::<f32>()"));
    }

    #[test]
    fn harness_without_inputs_and_coefficients_needs_no_cast() {
        let text = harness(&[], &[], "pub struct Coefficients {");
        assert!(text.contains("const INPUTS: usize = 0;"));
        assert!(text.contains("(coefficients, coefficients)"));
        assert!(!text.contains("compare_lanes"));
    }
}
