//! Comparison of the functions of sampled controllers (start and update) with the operations of the program in double
//! precision, bit for bit. Measured quantities and states are random, with magnitudes from far below to far above 1, to
//! reach limits and quantisation steps. Two samples of each call are close to a threshold of an operation, one on each
//! side.

use eomgen_codegen::program::{ControlValues, Program, ProgramController, Quantity};

use super::controller_decisions::Decisions;
use super::linked_program::format_bits;
use crate::random::Random;

const SEED: u64 = 0x5a3d_c0de;

/// Number of samples after each start.
const UPDATES: usize = 6;

/// Indices of the updates of a call that are close to a threshold; both have prescribed states.
const BESIDE_DECISION: [usize; 2] = [3, 5];

/// Maximum number of pairs of samples that are drawn until their decisions differ.
const MAX_DRAWS: usize = 16;

/// Largest decimal exponent of a measured quantity and of a state.
const LARGEST_EXPONENT: f64 = 4.0;

/// Measured quantities, then states, of one sample of a controller.
type Row = Vec<f64>;

/// Random samples of all controllers for a number of calls.
pub struct ControllerCalls<'p> {
    program: &'p Program,
    /// For each controller, the rows of all calls.
    rows: Vec<Vec<Row>>,
}

impl<'p> ControllerCalls<'p> {
    /// Draws the samples of calls; `calls` are their independent parameters in SI.
    pub fn new(program: &'p Program, calls: &[&[f64]]) -> Self {
        let mut random = Random::new(SEED);
        let mut draw = |controller: &ProgramController| -> Vec<Row> {
            let width = controller.measured.len() + controller.states.len();
            let mut number = || {
                let exponent = LARGEST_EXPONENT * random.symmetric();
                random.symmetric() * 10.0_f64.powf(exponent)
            };
            let mut row = || -> Row { (0..width).map(|_| number()).collect() };
            let mut rows = Vec::new();
            for (call, parameters) in calls.iter().enumerate() {
                let mut own: Vec<Row> = (0..UPDATES).map(|_| row()).collect();
                if let Some(op) = Decisions::choose(controller, call) {
                    let mut decisions = Decisions::new(controller, parameters);
                    let mut pairs = (0..MAX_DRAWS).map(|_| [row(), row()]);
                    let found = pairs.find_map(|[a, b]| decisions.bracket(op, [&a, &b]));
                    for (place, row) in BESIDE_DECISION.into_iter().zip(found.into_iter().flatten())
                    {
                        own[place] = row;
                    }
                }
                rows.extend(own);
            }
            rows
        };
        let rows = program.controllers.iter().map(&mut draw).collect();
        Self { program, rows }
    }

    /// Returns the names and results of the call with index `call` at independent parameters in SI.
    pub fn results(&self, call: usize, parameters: &[f64]) -> Vec<(String, Vec<f64>)> {
        let mut lines = Vec::new();
        let mut results = Vec::new();
        for (controller, rows) in self.program.controllers.iter().zip(&self.rows) {
            let name = format!("the controller `{}`", controller.name);
            let (times, mut states) = controller.start(parameters);
            lines.push((format!("start of {name}"), [&times[..], &states].concat()));
            let rows = rows.iter().skip(call * UPDATES).take(UPDATES);
            for (place, row) in rows.enumerate() {
                let (measured, given) = row.split_at(controller.measured.len());
                if has_given_states(place) {
                    states.copy_from_slice(given);
                }
                let values = ControlValues {
                    parameters,
                    period: times[0],
                    measured,
                    states: &states,
                };
                controller.evaluate(values, &mut results);
                let read = |places: &[usize]| -> Vec<f64> {
                    places.iter().map(|place| results[*place]).collect()
                };
                let outputs = read(&controller.output_values);
                states = read(&controller.next);
                let numbers = [&outputs[..], &times, &states].concat();
                lines.push((format!("update of {name}"), numbers));
            }
        }
        lines
    }

    /// Returns the C that prints the results of a call; `row` counts calls. The names begin with `NAME_`.
    pub fn c_calls(&self) -> String {
        let all = self.program.controllers.iter().zip(&self.rows);
        let calls: String = all
            .map(|(controller, rows)| c_call(controller, rows))
            .collect();
        match calls.is_empty() {
            true => String::new(),
            false => format!(
                "        if (sizeof(NAME_real) == sizeof(double)) {{\n            static int row = 0;\n{calls}            \
                 row += {UPDATES};\n        }}\n"
            ),
        }
    }

    /// Returns the Rust that prints the results of a call, with its index `call` and its `parameters`.
    pub fn rust_calls(&self) -> String {
        let all = self.program.controllers.iter().zip(&self.rows);
        all.map(|(controller, rows)| rust_call(controller, rows))
            .collect()
    }
}

/// Returns true if an update starts from the states of its row; otherwise it continues from the previous update.
fn has_given_states(update: usize) -> bool {
    update % 2 == 1
}

const TIMES: [&str; 3] = ["period", "offset", "delay"];

fn names(quantities: &[Quantity]) -> impl Iterator<Item = &str> {
    quantities.iter().map(|quantity| &*quantity.name)
}

/// Returns the field names of the memory.
fn memory_fields(controller: &ProgramController) -> Vec<String> {
    let all = TIMES.into_iter().chain(names(&controller.states));
    all.map(|name| format!("memory.{name}")).collect()
}

/// Returns the field names of the outputs, then of the memory.
fn updated_fields(controller: &ProgramController) -> String {
    let outputs = names(&controller.outputs).map(|name| format!("outputs.{name}"));
    let all: Vec<String> = outputs.chain(memory_fields(controller)).collect();
    all.join(", ")
}

fn table(rows: &[Row], brackets: [&str; 2]) -> String {
    let [open, close] = brackets;
    // C has no arrays of no numbers.
    let row = |row: &Row| {
        let numbers: Vec<String> = row
            .iter()
            .chain([&0.0])
            .map(|number| format!("{number:e}"))
            .collect();
        format!("{open}{}{close}", numbers.join(", "))
    };
    let rows: Vec<String> = rows.iter().map(row).collect();
    rows.join(", ")
}

fn c_call(controller: &ProgramController, rows: &[Row]) -> String {
    let own = &controller.name;
    let width = controller.measured.len() + controller.states.len() + 1;
    let mut text = format!(
        "            {{\n            static const NAME_real given_rows[][{width}] = {{{}}};\n",
        table(rows, ["{", "}"])
    );
    text += &format!(
        "            static NAME_controller_{own} memory;\n            static NAME_controller_{own}_measured measured;\n            \
         static NAME_controller_{own}_outputs outputs;\n            \
         NAME_controller_{own}_start(&parameters, &memory);\n"
    );
    let show = |fields: &str| {
        format!(
            "            {{ const NAME_real all[] = {{{fields}}}; show(all, (int)(sizeof all / sizeof all[0])); }}\n"
        )
    };
    text += &show(&memory_fields(controller).join(", "));
    text += &format!(
        "            for (int k = 0; k < {UPDATES}; ++k) {{\n            const NAME_real *own = given_rows[row + k];\n            (void)own;\n"
    );
    for (place, name) in names(&controller.measured).enumerate() {
        text += &format!("            measured.{name} = own[{place}];\n");
    }
    let first = controller.measured.len();
    let states = names(&controller.states).enumerate();
    let states = states.map(|(place, name)| format!("memory.{name} = own[{}]; ", first + place));
    text += &format!(
        "            if (k % 2 == 1) {{ {}}}\n",
        states.collect::<String>()
    );
    text += &format!(
        "            NAME_controller_{own}_update(&memory, &measured, &parameters, &outputs);\n"
    );
    text += &show(&updated_fields(controller));
    text + "            }\n            }\n"
}

fn rust_call(controller: &ProgramController, rows: &[Row]) -> String {
    let own = format!("model::controller_{}", controller.name);
    let first = controller.measured.len();
    let width = first + controller.states.len() + 1;
    let measured = names(&controller.measured).enumerate();
    let measured = measured.map(|(place, name)| format!("{name}: row[{place}]"));
    let states = names(&controller.states).enumerate();
    let states = states.map(|(place, name)| format!("memory.{name} = row[{}]; ", first + place));
    format!(
        "        {{\n            static ROWS: [[f64; {width}]; {count}] = [{rows}];\n            \
         let mut memory = {own}::Memory::<f64>::start(parameters);\n            show::<f64>(&[{started}]);\n            \
         for (k, row) in ROWS.iter().skip(call * {UPDATES}).take({UPDATES}).enumerate() {{\n                \
         let measured = {own}::Measured {{ {measured} }};\n                if k % 2 == 1 {{ {states}}}\n                \
         let outputs = {own}::update(&mut memory, &measured, parameters);\n                show::<f64>(&[{updated}]);\n            \
         }}\n        }}\n",
        count = rows.len(),
        rows = table(rows, ["[", "]"]),
        started = memory_fields(controller).join(", "),
        measured = measured.collect::<Vec<_>>().join(", "),
        states = states.collect::<String>(),
        updated = updated_fields(controller),
    )
}

/// Returns the expected lines of a call.
pub fn expected_lines(
    calls: &ControllerCalls<'_>,
    (call, parameters): (usize, &[f64]),
) -> impl Iterator<Item = (String, String)> {
    let all = calls.results(call, parameters).into_iter();
    all.map(move |(name, numbers)| (format!("{name}, call {}", call + 1), format_bits(&numbers)))
}
