use std::collections::BTreeSet;

use super::comments::comment;
use super::controllers;
use super::expression::{number, write_initialiser};
use super::file_names::check_header;
use super::functions::write_functions;
use super::header::{self, UNBOUNDED, describe_file, lists};
use super::jacobians;
use super::names::{WORDS, fill_template};
use super::real::Real;
use super::regimes::write_regime;
use super::stages::write_definition;
use super::standard_macros::{find_macros, hide_macros};
use super::step;
use super::types::write_fill_functions;
use crate::identity::{seal, write_unsealed_identity};
use crate::program::{Extent, Op, Program};
use crate::statements::layout;
use crate::statements::{
    EmitError, EmitResult, File, RequiredFunctions, Stage, build_controller_stages, build_guards,
    build_jacobian_stage, build_mass_matrix, build_observables, build_preparation, build_rates,
    build_rates_in_regime, build_requested_stages, collect_stage_roots,
};

/// C files of a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Files {
    /// Content of `NAME.h`.
    pub header: String,
    /// Content of `NAME.c`.
    pub source: String,
}

/// Writes a program as C99 that is also valid C++, in double precision.
///
/// # Errors
/// A name of the program is a reserved word of C or C++, or the header would have the name of a system header.
pub fn emit(program: &Program) -> Result<Files, EmitError> {
    emit_with(program, Real::Double)
}

/// Writes a program like [`emit`], with this number type.
///
/// # Errors
/// As for [`emit`].
pub fn emit_with(program: &Program, real: Real) -> Result<Files, EmitError> {
    check_header(&program.name)?;
    let parts = Parts::new(program, real)?;
    let notes = header::write_notes(program, real, header::TWO_FILES);
    let include = format!("#include \"{}.h\"\n", program.name);
    let source = comment(&describe_file(program)) + &include + &parts.definitions;
    Ok(Files {
        header: layout::source(&(notes + &parts.declarations)),
        source: seal(&layout::source(&source)),
    })
}

/// Writes a program like [`emit_with`], as one header `NAME.h`. The file that defines `NAME_IMPLEMENTATION` before it
/// includes the header contains the functions; others contain the declarations only.
///
/// # Errors
/// As for [`emit`].
pub fn emit_header_only(program: &Program, real: Real) -> Result<String, EmitError> {
    check_header(&program.name)?;
    let Parts {
        declarations,
        definitions,
    } = Parts::new(program, real)?;
    let [hide, restore] = hide_macros(["R"]);
    let notes = header::write_notes(program, real, header::HEADER_ONLY);
    let opening = "#if defined(NAME_IMPLEMENTATION) && !defined(NAME_IMPLEMENTED)\n#define NAME_IMPLEMENTED\n";
    let closing = format!(
        "#if defined(__clang__)\n#pragma STDC FP_CONTRACT DEFAULT\n\
         #elif defined(_MSC_VER)\n#pragma fp_contract(on)\n\
         {GCC_CONTRACTS}\n#pragma GCC pop_options\n#endif\n"
    );
    let text = [
        &notes,
        &*declarations,
        &fill_template(program, opening),
        &hide,
        &definitions,
        &restore,
        &closing,
        "#endif\n",
    ];
    Ok(seal(&layout::source(&text.concat())))
}

/// Emitted C with layout marks, without the comment at its top.
struct Parts {
    declarations: String,
    definitions: String,
}

impl Parts {
    fn new(program: &Program, real: Real) -> Result<Self, EmitError> {
        let file = File::new(program, &WORDS)?;
        controllers::check_name_collisions(program)?;
        let mut needed = RequiredFunctions::default();
        let prepared = build_preparation(&file, &mut needed)?;
        let stages = build_stages(&file, &mut needed)?;
        let declarations = header::write_header(&file, &prepared, &stages, real)?;
        let mut defined = write_fill_functions(&file, prepared)?;
        for stage in stages {
            defined += &write_definition(program, stage);
        }
        defined += &write_regime(&file);
        defined += &step::write_definition(program);
        defined += &jacobians::write_definitions(program);
        for controller in &program.controllers {
            let stages = build_controller_stages(&file, controller, &mut needed)?;
            defined += &controllers::write_definitions(program, controller, &stages);
        }
        let mut text = write_opening(program);
        text += &fill_template(program, UNBOUNDED);
        text += &write_tables(&file)?;
        text += &write_functions(program, &needed, &defined);
        for (head, elements, _) in lists(program) {
            text += &format!("{head} = {};\n", write_initialiser(&elements));
        }
        text += &comment(&["Identity, for `eomgen identify`.".to_owned()]);
        text += &format!(
            "const char {}_identity[] = \"{}\";\n",
            program.name,
            write_unsealed_identity(program)
        );
        // `<math.h>` is included above these lines, because they can hide its macros.
        let [hide, restore] = hide_macros(find_macros(&defined));
        text += &[&*hide, &defined, &restore, "#undef R\n"].concat();
        Ok(Self {
            declarations,
            definitions: text,
        })
    }
}

fn build_stages(file: &File<'_>, needed: &mut RequiredFunctions) -> EmitResult<Vec<Stage>> {
    let mut stages = vec![build_rates(file, needed)?];
    stages.extend(build_observables(file, needed)?);
    stages.push(build_guards(file, needed)?);
    stages.push(build_mass_matrix(file, needed)?);
    stages.extend(build_rates_in_regime(file, needed)?);
    stages.extend(build_requested_stages(file, needed)?);
    for jacobian in &file.program.outputs.jacobians {
        stages.push(build_jacobian_stage(file, jacobian, needed)?);
    }
    Ok(stages)
}

/// Condition under which gcc ignores the C99 pragma against contraction of products and sums: C++, or a GNU dialect
/// of C.
const GCC_CONTRACTS: &str = "#elif defined(__GNUC__) && !defined(__CUDACC__) && \
    (defined(__cplusplus) || !defined(__STRICT_ANSI__))";

/// Writes the first lines of the source, which forbid the contraction of products and sums and the reordering of
/// sums.
fn write_opening(program: &Program) -> String {
    let settings = format!(
        "#if defined(__FAST_MATH__) && !defined(NAME_ALLOW_REASSOCIATION)\n\
         #error \"-ffast-math changes bits: remove it, or define NAME_ALLOW_REASSOCIATION\"\n#endif\n\
         #if defined(__clang__)\n#pragma STDC FP_CONTRACT OFF\n\
         #elif defined(_MSC_VER)\n#pragma fp_contract(off)\n\
         {GCC_CONTRACTS}\n#pragma GCC push_options\n#pragma GCC optimize(\"fp-contract=off\")\n#endif\n"
    );
    fill_template(program, &settings)
        + &fill_template(
            program,
            "/** Output arguments of a function do not overlap its input arguments. */\n\
         #if defined(__cplusplus) || defined(_MSC_VER)\n#define NAME_RESTRICT __restrict\n\
         #else\n#define NAME_RESTRICT restrict\n#endif\n\
         /** Converts a number to the number type. */\n\
         #define R(number) ((NAME_real)(number))\n",
        )
}

fn write_tables(file: &File<'_>) -> EmitResult<String> {
    let program = file.program;
    let mut roots = collect_stage_roots(program);
    roots.extend(&program.pivots);
    let reached = program.reachable(&roots);
    let used: BTreeSet<usize> = reached
        .iter()
        .filter_map(|id| match program.value(*id).op {
            Op::Table(place) => Some(place),
            _ => None,
        })
        .collect();
    let mut text = String::new();
    for place in used {
        let table = &program.tables[place];
        let name = file.words.identifier(&table.name)?;
        let values: Vec<String> = table
            .values
            .iter()
            .map(|value| format!("R({})", number(*value)))
            .collect();
        let (extents, content) = match table.extent {
            Extent::Matrix(rows, columns) => {
                let lines = values.chunks(columns.max(1)).map(write_initialiser);
                let lines: Vec<String> = lines.collect();
                (format!("[{rows}][{columns}]"), write_initialiser(&lines))
            }
            other => (format!("[{}]", other.length()), write_initialiser(&values)),
        };
        text += &comment(std::slice::from_ref(&table.doc));
        let head = fill_template(
            program,
            &format!("static const NAME_real NAME_{name}{extents}"),
        );
        text += &format!("{head} = {content};\n");
    }
    Ok(text)
}
