//! If `EOMGEN_UNIT` names the library of functional mock-up units, sets the configuration flag to embed it.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(eomgen_unit)");
    println!("cargo::rerun-if-env-changed=EOMGEN_UNIT");
    if let Ok(library) = std::env::var("EOMGEN_UNIT") {
        println!("cargo::rerun-if-changed={library}");
        println!("cargo::rustc-cfg=eomgen_unit");
    }
}
