//! Exact compiler messages for each file in `errors`. To rewrite them, run `TRYBUILD=overwrite
//! cargo test --release -p eomgen-macro-errors` and review the difference.

use std::path::{Path, PathBuf};

/// Returns the crate made by trybuild; paths of specifications start at its root.
fn trybuild_crate() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .parent()
        .expect("the target folder");
    target.join("tests/trybuild").join(env!("CARGO_PKG_NAME"))
}

fn copy_specifications() -> std::io::Result<()> {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("specifications");
    let to = trybuild_crate().join("specifications");
    std::fs::create_dir_all(&to)?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        std::fs::copy(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
}

#[test]
fn each_mistake_gives_its_message() {
    copy_specifications().expect("the specifications can be copied");
    trybuild::TestCases::new().compile_fail("errors/*.rs");
}
