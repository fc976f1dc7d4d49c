//! Tests with records of a machine under feedback: the recorded outputs of its controllers drive the machine.

use eomgen_tests::program::{run, run_accepted, run_rejected, text};
use eomgen_tests::random_numbers::Numbers;
use serde_json::Value;

/// A cart with a position controller; `{friction}` is its true friction.
const CART: &str = r#"
[model]
name = "cart"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
c = { value = 3, unit = "N s/m", min = 0 }
F = { value = {friction}, unit = "N", min = 0 }
k_p = { value = 60, unit = "N/m" }
k_d = { value = 8, unit = "N s/m" }
u_step = { value = 0.5, unit = "N", min = 0 }
[coordinates]
x = { unit = "m" }
[inputs]
r = { unit = "m" }
u = { unit = "N" }
[kinetic]
cart = "1/2*m*dot(x)^2"
[dissipation]
bearing = "1/2*c*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
[observables]
force = "u"
[controllers.servo]
period = { value = 20, unit = "ms" }
delay = { value = 5, unit = "ms" }
states = { last = { unit = "m", next = "x" } }
outputs = { u = "quantise(k_p*(r - x) - k_d*(x - last)/period, u_step)" }
"#;

const FRICTION: &str = "friction = { on = \"x\", value = \"-F*sign(dot(x))\" }\n[observables]";

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[inputs.u]
column = "force"
unit = "N"
hold = "zero-order"
[channels.x]
column = "x"
unit = "m"
noise = 1e-5
[initial]
state = "rest"
[windows]
length = 0.5
"#;

/// Writes the files of a case into a folder: the specification without friction, the dataset, and noisy records of the
/// machine with this friction.
fn write_case(folder: &std::path::Path, friction: f64) {
    let file = |name: &str| folder.join(name).display().to_string();
    let known = CART.replace("F = { value = {friction}, unit = \"N\", min = 0 }\n", "");
    let truth = match friction == 0.0 {
        true => known.clone(),
        false => CART
            .replace("{friction}", &friction.to_string())
            .replace("[observables]", FRICTION),
    };
    std::fs::write(file("truth.toml"), truth).expect("a file");
    std::fs::write(file("cart.toml"), known).expect("a file");
    std::fs::write(file("dataset.toml"), DATASET).expect("a file");
    let mut random = Numbers(12);
    for (name, reference) in [
        ("train", "r=0.2*sin(3*t) + 0.1*sin(7.3*t)"),
        ("test", "r=0.15*sin(4.1*t) - 0.1*sin(2.2*t)"),
    ] {
        let table = file("motion.csv");
        let rows = ["--until", "4", "--interval", "0.005", "--out", &table];
        let spec = file("truth.toml");
        run_accepted(&[&["simulate", &spec, "--input", reference][..], &rows].concat());
        let rows = std::fs::read_to_string(&table).expect("a table");
        let mut record = "t,x,force\n".to_owned();
        for row in rows.lines().skip(1) {
            let row: Vec<f64> = row
                .split(',')
                .map(|n| n.parse().expect("a number"))
                .collect();
            let noise: f64 = (0..12).map(|_| 0.5 * random.symmetric()).sum();
            record += &format!("{},{},{}\n", row[0], row[1] + 1e-5 * noise, row[3]);
        }
        std::fs::write(file(&format!("{name}.csv")), record).expect("a file");
    }
}

#[test]
fn friction_is_found_if_recorded_controller_outputs_drive_the_machine() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    let (spec, dataset, out) = (file("cart.toml"), file("dataset.toml"), file("out"));
    for (friction, verdict) in [(0.0, "no_significant_gap"), (0.8, "effects_found")] {
        write_case(folder.path(), friction);
        let command = match friction == 0.0 {
            true => "compare",
            false => "discover",
        };
        let output = run(&[command, &spec, &dataset, "--out", &out, "--json"]);
        let said = text(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(
            said.contains(
                "note: the recorded `u` drive the machine: its controllers (`servo`) are left out"
            ),
            "{said}"
        );
        // The reference acts only through the controller, so there is no warning about it.
        assert!(!said.contains("is not driven"), "{said}");
        let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(document["verdict"], verdict, "{document}");
        if friction > 0.0 {
            let found = document["effects"].to_string();
            assert!(found.contains("coulomb_friction"), "{found}");
        }
    }
}

#[test]
fn missing_output_of_a_controller_is_rejected_with_location() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    write_case(folder.path(), 0.0);
    let without = DATASET.replace("[inputs.u]", "[inputs.r]");
    std::fs::write(file("dataset.toml"), without).expect("a file");
    let (spec, dataset, out) = (file("cart.toml"), file("dataset.toml"), file("out"));
    for command in ["compare", "discover"] {
        let said = run_rejected(&[command, &spec, &dataset, "--out", &out]);
        for part in [
            "the records have no column for the input `u`, which the controller `servo` drives",
            "cart.toml:27:",
            "add [inputs.u]",
        ] {
            assert!(said.contains(part), "{part}: {said}");
        }
    }
}
