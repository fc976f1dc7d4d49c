//! Tells the program to embed the library of functional mock-up units if `EOMGEN_UNIT` names it.

fn main() {
    println!("cargo::rustc-check-cfg=cfg(eomgen_unit)");
    println!("cargo::rerun-if-env-changed=EOMGEN_UNIT");
    if let Ok(library) = std::env::var("EOMGEN_UNIT") {
        println!("cargo::rerun-if-changed={library}");
        println!("cargo::rustc-cfg=eomgen_unit");
    }
}
