//! Header of a program for CUDA C++: the functions of the emitted C as device functions.
//!
//! [`emit`](super::emit::emit) starts every declaration and definition in the first column. This module adds the CUDA
//! qualifiers to these lines. It omits the arrays of names, units and ranges, which only the host can read.

use super::comments::comment;
use super::emit::emit;
use super::header::describe_file;
use super::names::fill_template;
use crate::program::Program;
use crate::statements::EmitError;

const FUNCTION_QUALIFIER: &str = "inline __device__ ";

const TABLE_QUALIFIER: &str = "static __device__ ";

/// Lines of the C header that declare C linkage. Device functions do not need them.
const LINKAGE: [&str; 2] = [
    "#ifdef __cplusplus\nextern \"C\" {\n#endif\n",
    "#ifdef __cplusplus\n}\n#endif\n",
];

/// Writes a program as the header `NAME.cuh` of device functions, which `nvcc`, NVRTC and clang compile.
///
/// # Errors
/// As for [`emit`](super::emit::emit).
pub fn emit_cuda(program: &Program) -> Result<String, EmitError> {
    let files = emit(program)?;
    let name = &program.name;
    let mut text = comment(&write_notes(program));
    text += &fill_template(program, OPENING);
    let header = LINKAGE
        .iter()
        .fold(files.header, |text, lines| text.replace(lines, ""));
    for part in [&header, &files.source] {
        let is_for_hosts = |line: &&str| line.starts_with("#include") || line.contains("_macro(\"");
        let lines = part.lines().filter(|line| !is_for_hosts(line));
        text += &convert_to_cuda(lines, name);
    }
    text += &fill_template(program, CLOSING);
    Ok(text)
}

fn write_notes(program: &Program) -> Vec<String> {
    let name = &program.name;
    let text = format!(
        "\nDevice functions in double precision, or in single precision with -D{name}_REAL=float. They do\n\
         not allocate or call a library. `{name}_prepare` needs one call for each set of parameters.\n\
         \n\
         Compile with -fmad=false. The results are then bit-identical to those of the emitted C and Rust.\n\
         `{name}_is_unfused` tests this on the device."
    );
    let mut lines = describe_file(program);
    lines.extend(text.split('\n').map(str::to_owned));
    lines
}

/// Lines before the declarations. NVRTC has no standard headers.
const OPENING: &str = "#ifndef NAME_CUH
#define NAME_CUH
#ifdef __CUDACC_RTC__
typedef int int32_t;
typedef unsigned int uint32_t;
typedef unsigned long long uint64_t;
#else
#include <stdint.h>
#endif
";

/// Lines after the definitions. The square of 1 + 2^-n contains the term 2^-2n, which is lost if the product is
/// rounded.
const CLOSING: &str = "
/**
 * Returns 1 if the compiler rounds each product before it is added, as -fmad=false prescribes. `one` is 1, and unknown to the
 * compiler.
 */
inline __device__ int NAME_is_unfused(NAME_real one) {
    const NAME_real small = sizeof(NAME_real) == 4 ? (NAME_real)2.44140625e-4 : (NAME_real)7.450580596923828e-9;
    const NAME_real number = one + small;
    const NAME_real square = one + (NAME_real)2.0 * small;
    return number * number - square == (NAME_real)0.0;
}
#endif
";

/// Adds the CUDA qualifiers to the lines of C. Removes the file comment, and the arrays of names, units and ranges
/// with their documentation.
fn convert_to_cuda<'l>(mut lines: impl Iterator<Item = &'l str>, name: &str) -> String {
    let mut text = String::new();
    let mut documentation = String::new();
    let mut is_first_comment = true;
    while let Some(line) = lines.next() {
        if line.starts_with("/**") {
            let comment = take_until(line, &mut lines, "*/");
            if !std::mem::take(&mut is_first_comment) {
                documentation = comment;
            }
            continue;
        }
        let documentation = std::mem::take(&mut documentation);
        if is_data_array(line, name) {
            take_until(line, &mut lines, ";");
        } else {
            text += &documentation;
            text += &qualify(line, name);
            text.push('\n');
        }
    }
    text
}

/// Returns `first` and the lines after it up to the first that ends with `end`.
fn take_until<'l>(first: &str, lines: &mut impl Iterator<Item = &'l str>, end: &str) -> String {
    let mut text = format!("{first}\n");
    let mut is_complete = first.ends_with(end);
    while !is_complete && let Some(line) = lines.next() {
        text += line;
        text.push('\n');
        is_complete = line.ends_with(end);
    }
    text
}

/// Returns the start of the line that defines the identity.
fn identity_head(name: &str) -> String {
    format!("const char {name}_identity[] = ")
}

/// Returns true for the first line of an array of names, units or ranges, and for the declaration of such an array.
fn is_data_array(line: &str, name: &str) -> bool {
    let is_list = ["const ", "extern const "];
    is_list.iter().any(|head| line.starts_with(head)) && !line.starts_with(&identity_head(name))
}

/// Adds the qualifier to a line that begins a function or a table.
fn qualify(line: &str, name: &str) -> String {
    let is_inside = line.starts_with([' ', '#', '}', ')', '/']) || line.is_empty();
    let declares_type = ["typedef", "enum"]
        .iter()
        .any(|head| line.starts_with(head));
    if is_inside || declares_type {
        return line.to_owned();
    }
    if line.starts_with("static const ") {
        return format!("{TABLE_QUALIFIER}{}", &line["static ".len()..]);
    }
    if line.starts_with(&identity_head(name)) {
        return format!("{TABLE_QUALIFIER}{line}");
    }
    let head = line.strip_prefix("static ").unwrap_or(line);
    let head = head.strip_prefix("inline ").unwrap_or(head);
    match line.contains(&format!("{name}_")) && line.contains('(') {
        true => format!("{FUNCTION_QUALIFIER}{head}"),
        false => line.to_owned(),
    }
}
