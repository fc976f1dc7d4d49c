//! Tests of Parquet records: results equal those of CSV records, and damaged files are rejected.

use eomgen_tests::measured::{Measured, record};
use eomgen_tests::models::path;
use eomgen_tests::program;

fn swing(measured: &Measured, angle: &str, file: &str) {
    let text = std::fs::read_to_string(path("pendulum")).expect("a specification");
    let other = text.replace("3/4*pi", angle);
    assert_ne!(text, other);
    measured.write("swing.toml", other.as_bytes());
    let specification = measured.file("swing.toml").display().to_string();
    let out = measured.file(file).display().to_string();
    program::run_accepted(&[
        "simulate",
        &specification,
        "--until",
        "2",
        "--interval",
        "0.005",
        "--out",
        &out,
    ]);
}

const SWING: &str = r#"
records = { train = ["train.FORMAT"], test = ["test.FORMAT"] }
time = { column = "t", unit = "s" }
channels = { theta = { column = "theta", unit = "rad", noise = 5e-4 } }
initial = { state = "estimate" }
"#;

#[test]
fn parquet_records_give_the_results_of_csv_records() {
    let measured = Measured::stage(0.0);
    let specification = path("pendulum").display().to_string();
    let [one, other] = ["csv", "parquet"].map(|format| {
        swing(&measured, "2/3*pi", &format!("train.{format}"));
        swing(&measured, "4/5*pi", &format!("test.{format}"));
        measured.write(
            "swing-data.toml",
            SWING.replace("FORMAT", format).as_bytes(),
        );
        let dataset = measured.file("swing-data.toml").display().to_string();
        let out = measured.file(format).display().to_string();
        program::run_accepted(&["compare", &specification, &dataset, "--out", &out]);
        let text = measured.read(&format!("{format}/comparison.json"));
        let mut result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        result["seconds"] = 0.into();
        result
    });
    assert_eq!(one, other);
    assert_eq!(one["verdict"], "no_significant_gap");
}

#[test]
fn broken_parquet_records_are_rejected() {
    let measured = Measured::stage(0.0);
    swing(&measured, "2/3*pi", "whole.parquet");
    swing(&measured, "4/5*pi", "test.parquet");
    let data = measured.file("swing-data.toml");
    measured.write(
        "swing-data.toml",
        SWING.replace("FORMAT", "parquet").as_bytes(),
    );
    let whole = std::fs::read(measured.file("whole.parquet")).expect("a file");
    let cut = |part: f64| whole[..(part * whole.len() as f64) as usize].to_vec();
    let mut spoilt = vec![Vec::new(), cut(0.01), cut(0.5), cut(0.999)];
    spoilt.push(record(0.0, 0.0).into_bytes());
    // The footer contains the positions of the columns.
    let mut footer = whole.clone();
    let end = footer.len();
    footer[end - 60..end - 20].fill(0xff);
    spoilt.push(footer);
    for bytes in spoilt {
        measured.write("train.parquet", &bytes);
        let [specification, dataset, out] = [path("pendulum"), data.clone(), measured.file("out")]
            .map(|path| path.display().to_string());
        let message = program::run_rejected(&["compare", &specification, &dataset, "--out", &out]);
        assert!(message.contains("train.parquet"), "{message}");
        assert!(!measured.file("out").exists());
    }
}
