//! Tests of machines whose mode shapes are in a file next to the specification.

use eomgen_tests::moving_base::Recording;
use eomgen_tests::moving_machines::mast;
use eomgen_tests::program::run_on_dataset;

/// Returns mode shapes of a clamped-free beam of 0.5 m, with an unusual normalisation.
fn table() -> String {
    let mut text = "x,phi_1,phi_2,phi_3\n".to_owned();
    for row in 0..=60 {
        let part = f64::from(row) / 60.0;
        text += &format!("{:.12}", 0.5 * part);
        for z in [
            1.875_104_068_711_961_f64,
            4.694_091_132_974_174,
            7.854_757_438_237_613,
        ] {
            let ratio = (z.cosh() + z.cos()) / (z.sinh() + z.sin());
            let at = z * part;
            let shape = at.cosh() - at.cos() - ratio * (at.sinh() - at.sin());
            text += &format!(",{:.12}", 0.3 * shape);
        }
        text.push('\n');
    }
    text
}

#[test]
fn correct_beam_from_a_table_has_no_effect_and_is_written_with_its_table() {
    let machine = mast(|_, _| 0.0);
    let recording = Recording {
        step: 1e-3,
        parts: 80,
        unit: ("m", 1.0),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    let specification = machine.specification.replace(
        "basis = \"clamped_free\"",
        "basis = \"table\"\ntable = \"shapes/modes.csv\"",
    );
    std::fs::create_dir(place("shapes")).expect("a folder");
    let [train, test] = machine.records(recording);
    for (name, text) in [
        ("mast.toml", &specification),
        ("shapes/modes.csv", &table()),
        ("dataset.toml", &machine.dataset(recording)),
        ("train.csv", &train),
        ("test.csv", &test),
    ] {
        std::fs::write(place(name), text).expect("a file");
    }
    let paths = ["mast.toml", "dataset.toml", "found"].map(place);
    let found = run_on_dataset("discover", paths.each_ref());
    assert_eq!(
        found["effects"].as_array().map(Vec::len),
        Some(0),
        "{found:#}"
    );
    let paths = ["found/extended.toml", "dataset.toml", "compared"].map(place);
    let compared = run_on_dataset("compare", paths.each_ref());
    assert_eq!(compared["verdict"], "no_significant_gap", "{compared:#}");
}
