//! Names of emitted headers. A header with the name of a system header replaces that one for every file that
//! searches the folder.

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
