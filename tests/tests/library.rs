//! Test of the example in docs/library.md: it is compiled and run in the project's folder.

use eomgen_tests::models::project;

include!("../../examples/with_library/main.rs");

#[test]
fn library_example_runs() {
    std::env::set_current_dir(project()).expect("the project's folder");
    main().expect("three motions");
}
