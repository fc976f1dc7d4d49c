//! What the compiler says of each file in `errors`, to the letter. `TRYBUILD=overwrite cargo
//! test --release -p eomgen-macro-errors` writes the messages anew; read the difference
//! before keeping it.

use std::path::{Path, PathBuf};

/// The crate that trybuild makes: paths of specifications are from its root.
fn made_crate() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .parent()
        .expect("the target folder");
    target.join("tests/trybuild").join(env!("CARGO_PKG_NAME"))
}

fn copy_specifications() -> std::io::Result<()> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("specifications");
    let to = made_crate().join("specifications");
    std::fs::create_dir_all(&to)?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        std::fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}

#[test]
fn each_mistake_has_its_message() {
    copy_specifications().expect("the specifications can be copied");
    trybuild::TestCases::new().compile_fail("errors/*.rs");
}
