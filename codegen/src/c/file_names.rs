//! Check of the names of emitted headers. A header with the name of a system header would replace the system header
//! for every file compiled with its folder in the include path.

use crate::statements::EmitError;

/// Headers of C99 to C23, and the headers that the standard headers of C and C++ include from the same folders:
/// `gcc -M` with glibc lists them.
const SYSTEM_HEADERS: &str = "assert complex ctype errno fenv float inttypes iso646 limits locale math setjmp \
    signal stdalign stdarg stdatomic stdbit stdbool stdckdint stddef stdint stdio stdlib stdnoreturn \
    string tgmath threads time uchar wchar wctype alloca endian features libintl pthread sched strings \
    syslimits unistd";

/// Checks the name of the header `NAME.h`. Some file systems ignore the case of letters.
///
/// # Errors
/// The name of a system header.
pub(super) fn check_header(name: &str) -> Result<(), EmitError> {
    let lower = name.to_lowercase();
    if SYSTEM_HEADERS.split(' ').all(|known| known != lower) {
        return Ok(());
    }
    Err(EmitError::Header {
        name: name.to_owned(),
        hidden: lower,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Headers of C99, ISO/IEC 9899:1999, 7.1.2.
    const C99: [&str; 24] = [
        "assert", "complex", "ctype", "errno", "fenv", "float", "inttypes", "iso646", "limits",
        "locale", "math", "setjmp", "signal", "stdarg", "stdbool", "stddef", "stdint", "stdio",
        "stdlib", "string", "tgmath", "time", "wchar", "wctype",
    ];

    #[test]
    fn headers_of_c99_are_rejected_in_any_case() {
        for name in C99 {
            for name in [name.to_owned(), name.to_uppercase()] {
                let error = check_header(&name).map_err(|error| error.to_string());
                let message = error.expect_err(&name);
                assert!(message.contains("give the model another name"), "{message}");
            }
            assert_eq!(check_header(&format!("{name}_2")), Ok(()), "{name}");
        }
    }
}
