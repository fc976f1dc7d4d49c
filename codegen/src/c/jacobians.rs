//! Positions of the structural nonzeros of Jacobians, and the linearisation in dense matrices.

use super::comments::comment;
use super::expression::write_initialiser;
use super::names::fill_template;
use super::stages::{GIVEN, call_stage, nest_lines, write_head};
use crate::program::{Jacobian, Output, Program, ValueId};
use crate::statements::layout::block;

pub(super) fn write_declarations(program: &Program) -> String {
    let mut text = String::new();
    for jacobian in &program.outputs.jacobians {
        let lines = [format!(
            "Positions of the nonzeros of `{}_{}` in the matrix of {} x {}: `rows` and `columns` \
             have {} elements each.",
            program.name,
            jacobian.name,
            jacobian.rows,
            jacobian.columns,
            jacobian.nonzeros()
        )];
        text += &format!(
            "{}{};\n",
            comment(&lines),
            write_places_head(program, jacobian)
        );
    }
    if has_linearisation(program) {
        // C has no empty arrays.
        let columns = match program.inputs.len() {
            0 => "1",
            _ => "NAME_INPUTS",
        };
        text += &fill_template(program, &LINEARISATION.replace("COLUMNS", columns));
        text += &comment(&["Linearisation about a point.".to_owned()]);
        text += &format!("{};\n", write_linearise_head(program, false));
    }
    text
}

pub(super) fn write_sizes(program: &Program) -> String {
    let size = |jacobian: &Jacobian<ValueId>| {
        let line = format!(
            "Number of structural nonzeros of `{}_{}`.",
            program.name, jacobian.name
        );
        let name = jacobian.name.to_uppercase();
        let macro_line = format!("#define NAME_{name}_NONZEROS {}\n", jacobian.nonzeros());
        comment(&[line]) + &fill_template(program, &macro_line)
    };
    program.outputs.jacobians.iter().map(size).collect()
}

/// Returns true if the linearisation in dense matrices is emitted.
pub(super) fn has_linearisation(program: &Program) -> bool {
    program.outputs.kinds.contains(&Output::Linearisation)
}

fn write_places_head(program: &Program, jacobian: &Jacobian<ValueId>) -> String {
    fill_template(
        program,
        &format!(
            "void NAME_{}_places(int *rows, int *columns)",
            jacobian.name
        ),
    )
}

fn write_linearise_head(program: &Program, definition: bool) -> String {
    let mut arguments = GIVEN.to_vec();
    arguments.push(("NAME_linearisation *", "about"));
    write_head(program, ("void ", "linearise"), &arguments, definition)
}

pub(super) fn write_definitions(program: &Program) -> String {
    if program.outputs.jacobians.is_empty() {
        return String::new();
    }
    let mut text = fill_template(program, PLACES);
    for jacobian in &program.outputs.jacobians {
        text += &write_blocks(program, jacobian);
        let call = format!(
            "NAME_places(NAME_{0}_blocks, {1}, rows, columns);\n",
            jacobian.name,
            jacobian.entries.len()
        );
        let head = write_places_head(program, jacobian);
        text += &block(&format!("{head} {{"), &fill_template(program, &call), "}");
    }
    if has_linearisation(program) {
        text += &fill_template(program, DENSE);
        let head = write_linearise_head(program, true);
        text += &block(&format!("{head} {{"), &write_linearisation(program), "}");
    }
    text
}

/// Writes the blocks of nonzeros. An empty list is written as one empty block, because C has no empty arrays.
fn write_blocks(program: &Program, jacobian: &Jacobian<ValueId>) -> String {
    let mut blocks: Vec<String> = Vec::new();
    for e in &jacobian.entries {
        let diagonal = usize::from(e.diagonal);
        blocks.push(format!(
            "{{{}, {}, {}, {}, {diagonal}}}",
            e.row, e.rows, e.column, e.columns
        ));
    }
    if blocks.is_empty() {
        blocks.push("{0, 0, 0, 0, 0}".to_owned());
    }
    let head = format!(
        "static const int NAME_{}_blocks[{}][5]",
        jacobian.name,
        blocks.len()
    );
    format!(
        "{} = {};\n",
        fill_template(program, &head),
        write_initialiser(&blocks)
    )
}

fn write_linearisation(program: &Program) -> String {
    let mut lines = call_stage(program, "rates_into", "about->rates");
    lines += &call_stage(program, "observables", "about->observables");
    for (matrix, name) in [
        ("A", "rates_by_state"),
        ("B", "rates_by_inputs"),
        ("C", "observables_by_state"),
        ("D", "observables_by_inputs"),
    ] {
        let found = program.outputs.jacobians.iter().find(|j| j.name == name);
        let Some(jacobian) = found else { continue };
        let room = jacobian.nonzeros().max(1);
        let none = if jacobian.nonzeros() == 0 {
            " = {0}"
        } else {
            ""
        };
        let mut inner = fill_template(program, &format!("NAME_real nonzeros[{room}]{none};\n"));
        inner += &call_stage(program, name, "nonzeros");
        inner += &fill_template(
            program,
            &format!(
                "NAME_dense(NAME_{name}_blocks, {}, nonzeros, {}, {}, &about->{matrix}[0][0]);\n",
                jacobian.entries.len(),
                jacobian.rows,
                jacobian.columns.max(1)
            ),
        );
        lines += &nest_lines("{", &inner, "}");
    }
    lines
}

const PLACES: &str = "\
/** Expands blocks to positions. A block has first row, rows, first column, columns, and 1 if only \
its diagonal is filled, else 0. Blocks of the same rows are adjacent. */
static void NAME_places(const int (*blocks)[5], int count, int *rows, int *columns) {
    int next = 0;
    int first = 0;
    while (first < count) {
        int last = first;
        while (last < count && blocks[last][0] == blocks[first][0]) {
            ++last;
        }
        for (int i = 0; i < blocks[first][1]; ++i) {
            for (int b = first; b < last; ++b) {
                const int diagonal = blocks[b][4];
                for (int j = 0; j < ((diagonal != 0) ? 1 : blocks[b][3]); ++j) {
                    rows[next] = blocks[b][0] + i;
                    columns[next] = blocks[b][2] + ((diagonal != 0) ? i : j);
                    ++next;
                }
            }
        }
        first = last;
    }
}
";

const DENSE: &str = "\
/** Matrix with these nonzeros in blocks, row by row. */
static void NAME_dense(
    const int (*blocks)[5], int count, const NAME_real *nonzeros, int rows, int width,
    NAME_real *matrix
) {
    int next = 0;
    for (int i = 0; i < rows * width; ++i) {
        matrix[i] = R(0.0);
    }
    int first = 0;
    while (first < count) {
        int last = first;
        while (last < count && blocks[last][0] == blocks[first][0]) {
            ++last;
        }
        for (int i = 0; i < blocks[first][1]; ++i) {
            for (int b = first; b < last; ++b) {
                const int diagonal = blocks[b][4];
                for (int j = 0; j < ((diagonal != 0) ? 1 : blocks[b][3]); ++j) {
                    const int column = blocks[b][2] + ((diagonal != 0) ? i : j);
                    matrix[(blocks[b][0] + i) * width + column] = nonzeros[next];
                    ++next;
                }
            }
        }
        first = last;
    }
}
";

const LINEARISATION: &str = "\
/** Linearisation about a point: rates + A dx + B du, observables + C dx + D du. Without \
inputs B and D have a column of zeros. */
typedef struct {
    /** Rates at the point. */
    NAME_real rates[NAME_STATES];
    /** Observables at the point. */
    NAME_real observables[NAME_OBSERVABLES];
    /** Derivatives of the rates by the state. */
    NAME_real A[NAME_STATES][NAME_STATES];
    /** Derivatives of the rates by the inputs. */
    NAME_real B[NAME_STATES][COLUMNS];
    /** Derivatives of the observables by the state. */
    NAME_real C[NAME_OBSERVABLES][NAME_STATES];
    /** Derivatives of the observables by the inputs. */
    NAME_real D[NAME_OBSERVABLES][COLUMNS];
} NAME_linearisation;
";
