use std::collections::BTreeSet;

use super::comments::comment;
use super::controllers;
use super::expression::{initialiser, number};
use super::file_names::check_header;
use super::functions::functions;
use super::header::{self, UNBOUNDED, documentation, lists};
use super::jacobians;
use super::names::{WORDS, fill_template};
use super::real::Real;
use super::regimes::regime;
use super::stages::definition;
use super::standard_macros::{find_macros, hide_macros};
use super::step;
use super::types::fill_functions;
use crate::identity::{seal, unsealed};
use crate::program::{Extent, Op, Program};
use crate::statements::layout;
use crate::statements::{
    EmitError, EmitResult, File, RequiredFunctions, Stage, controller_stages, guards,
    jacobian_stage, mass_matrix, observables, preparation, rates, rates_in_regime,
    requested_stages, stage_roots,
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
/// A name of the program that is a word of C or C++, or the name of a system header.
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
    let notes = header::notes(program, real, header::TWO_FILES);
    let include = format!("#include \"{}.h\"\n", program.name);
    let source = comment(&documentation(program)) + &include + &parts.definitions;
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
    let notes = header::notes(program, real, header::HEADER_ONLY);
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

/// Emitted C without the comment at its top, with marks of the layout.
struct Parts {
    declarations: String,
    definitions: String,
}

impl Parts {
    fn new(program: &Program, real: Real) -> Result<Self, EmitError> {
        let file = File::new(program, &WORDS)?;
        controllers::check_names(program)?;
        let mut needed = RequiredFunctions::default();
        let prepared = preparation(&file, &mut needed)?;
        let stages = stages(&file, &mut needed)?;
        let declarations = header::header(&file, &prepared, &stages, real)?;
        let mut defined = fill_functions(&file, prepared)?;
        for stage in stages {
            defined += &definition(program, stage);
        }
        defined += &regime(&file);
        defined += &step::definition(program);
        defined += &jacobians::definitions(program);
        for controller in &program.controllers {
            let stages = controller_stages(&file, controller, &mut needed)?;
            defined += &controllers::definitions(program, controller, &stages);
        }
        let mut text = opening(program);
        text += &fill_template(program, UNBOUNDED);
        text += &tables(&file)?;
        text += &functions(program, &needed, &defined);
        for (head, elements, _) in lists(program) {
            text += &format!("{head} = {};\n", initialiser(&elements));
        }
        text += &comment(&["Identity, for `eomgen identify`.".to_owned()]);
        text += &format!(
            "const char {}_identity[] = \"{}\";\n",
            program.name,
            unsealed(program)
        );
        // The header of mathematics, which these names can hide, is included before.
        let [hide, restore] = hide_macros(find_macros(&defined));
        text += &[&*hide, &defined, &restore, "#undef R\n"].concat();
        Ok(Self {
            declarations,
            definitions: text,
        })
    }
}

fn stages(file: &File<'_>, needed: &mut RequiredFunctions) -> EmitResult<Vec<Stage>> {
    let mut stages = vec![rates(file, needed)?];
    stages.extend(observables(file, needed)?);
    stages.push(guards(file, needed)?);
    stages.push(mass_matrix(file, needed)?);
    stages.extend(rates_in_regime(file, needed)?);
    stages.extend(requested_stages(file, needed)?);
    for jacobian in &file.program.outputs.jacobians {
        stages.push(jacobian_stage(file, jacobian, needed)?);
    }
    Ok(stages)
}

/// Condition that gcc contracts products and sums: as C++, or with a dialect of GNU C. It ignores the pragma of C99.
const GCC_CONTRACTS: &str = "#elif defined(__GNUC__) && !defined(__CUDACC__) && \
    (defined(__cplusplus) || !defined(__STRICT_ANSI__))";

/// Writes the first lines of the source: products and sums stay separate, and sums in their order.
fn opening(program: &Program) -> String {
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

fn tables(file: &File<'_>) -> EmitResult<String> {
    let program = file.program;
    let mut roots = stage_roots(program);
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
                let lines = values.chunks(columns.max(1)).map(initialiser);
                let lines: Vec<String> = lines.collect();
                (format!("[{rows}][{columns}]"), initialiser(&lines))
            }
            other => (format!("[{}]", other.length()), initialiser(&values)),
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
