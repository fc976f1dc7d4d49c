//! C sources of a unit: emitted source, tables of numbers, and the common runtime.

use eomgen_codegen::c;
use eomgen_codegen::program::Program;

use super::variables::{Kind, Unit};
use super::version::Version;
use crate::error::{EmissionError, Result};

/// Compiled file. It includes the others, so that only the functions of the standard are exported.
pub const MAIN: &str = "fmu.c";

/// Default tolerance of the solver.
pub const TOLERANCE: f64 = 1e-8;

/// Common runtime, in the order of inclusion.
const RUNTIME: [(&str, &str); 8] = [
    ("instance.h", include_str!("runtime/instance.h")),
    ("evaluation.c", include_str!("runtime/evaluation.c")),
    ("sides.c", include_str!("runtime/sides.c")),
    ("variables.c", include_str!("runtime/variables.c")),
    ("lifecycle.c", include_str!("runtime/lifecycle.c")),
    ("snapshot.c", include_str!("runtime/snapshot.c")),
    ("solver.c", include_str!("runtime/solver.c")),
    ("derivatives.c", include_str!("runtime/derivatives.c")),
];

pub fn files(program: &Program, unit: &Unit, version: Version) -> Result<Vec<(String, String)>> {
    let c::Files { source, header } = c::emit(program).map_err(EmissionError::request)?;
    let name = &program.name;
    let interface = match version {
        Version::Two => ("fmi2.c", include_str!("runtime/fmi2.c")),
        Version::Three => ("fmi3.c", include_str!("runtime/fmi3.c")),
    };
    let runtime: Vec<(&str, &str)> = RUNTIME.into_iter().chain([interface]).collect();
    let mut files = vec![
        (MAIN.to_owned(), main(unit, &runtime)),
        (format!("{name}.c"), source),
        (format!("{name}.h"), header),
    ];
    let copied = |(name, text): &(&str, &str)| ((*name).to_owned(), (*text).to_owned());
    files.extend(runtime.iter().map(copied));
    Ok(files)
}

/// Returns the file that includes all others, with the model's constants for the runtime.
fn main(unit: &Unit, runtime: &[(&str, &str)]) -> String {
    let name = &unit.name;
    let numbers = |kind: Kind, value: &dyn Fn(&super::variables::Variable) -> f64| {
        let mut numbers: Vec<String> = unit
            .of_kind(|of| of == kind)
            .map(|(_, variable)| format!("{:?}", value(variable)))
            .collect();
        if numbers.is_empty() {
            // C has no empty arrays.
            numbers.push("0.0".to_owned());
        }
        let lines: Vec<String> = numbers.chunks(6).map(|line| line.join(", ")).collect();
        format!(
            "[{}] = {{\n    {},\n}};\n",
            numbers.len(),
            lines.join(",\n    ")
        )
    };
    let start = |variable: &super::variables::Variable| variable.start.unwrap_or(0.0);
    let mut text = format!(
        "/* A functional mock-up unit of {name}: compile this file only. */\n\
         /* Numbers of a unit are in double precision. */\n\
         #undef {name}_REAL\n#define {name}_REAL double\n#include \"{name}.c\"\n\
         #define MODEL(name) {name}_##name\n\
         #define TOKEN \"{}\"\n#define DEFAULT_TOLERANCE {TOLERANCE:?}\n\
         #if defined(_WIN32)\n#define EXPORT __declspec(dllexport)\n\
         #elif defined(__GNUC__)\n#define EXPORT __attribute__((visibility(\"default\")))\n\
         #else\n#define EXPORT\n#endif\n",
        unit.token
    );
    for (table, kind, value) in [
        ("initial_state", Kind::State, &start as &dyn Fn(&_) -> f64),
        ("parameter_values", Kind::Parameter, &start),
        ("parameter_minima", Kind::Parameter, &|variable| {
            variable.min.unwrap_or(-f64::MAX)
        }),
        ("parameter_maxima", Kind::Parameter, &|variable| {
            variable.max.unwrap_or(f64::MAX)
        }),
    ] {
        text += &format!("static const double {table}{}", numbers(kind, value));
    }
    for (file, _) in runtime {
        text += &format!("#include \"{file}\"\n");
    }
    text
}
