//! Tests of free decays from initial states that no channel measures.

use eomgen_tests::program::{run_accepted, run_on_dataset};
use eomgen_tests::random_numbers::Numbers;

/// Motor with a winding that drives a load over an elastic shaft; only the motor's angle is measured.
const DRIVE: &str = r#"
[model]
name = "drive"
[parameters]
J = { value = 0.01, unit = "kg m^2" }
J_l = { value = 0.05, unit = "kg m^2" }
k = { value = 40, unit = "N m" }
d = { value = 0.02, unit = "N m s" }
K = { value = 0.4, unit = "N m/A" }
R = { value = 1.5, unit = "ohm" }
L = { value = 8, unit = "mH" }
[coordinates]
phi = { unit = "rad" }
psi = { unit = "rad" }
[states]
i = { unit = "A", rate = "-(R*i + K*dot(phi))/L" }
[kinetic]
T = "1/2*J*dot(phi)^2 + 1/2*J_l*dot(psi)^2"
[potential]
V = "1/2*k*(phi - psi)^2"
[dissipation]
D = "1/2*d*dot(phi)^2 + 1/2*d*(dot(phi) - dot(psi))^2"
[forces]
motor = { on = "phi", value = "K*i" }
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[channels.phi]
column = "phi"
unit = "rad"
noise = 5e-4
[windows]
length = 0.5
"#;

/// Initially the shaft is twisted and the load turns; the first samples do not show this.
#[test]
fn free_decay_from_an_unmeasured_state_is_explained() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name);
    std::fs::write(place("spec.toml"), DRIVE).expect("written");
    std::fs::write(place("dataset.toml"), DATASET).expect("written");
    let mut numbers = Numbers(3);
    for (name, states) in [
        (
            "train.csv",
            ["phi=0.2", "psi=-0.1", "psi_dot=3", "phi_dot=0.2"],
        ),
        (
            "test.csv",
            ["phi=-0.1", "psi=0.2", "psi_dot=-2", "phi_dot=1"],
        ),
    ] {
        let (spec, out) = (place("spec.toml"), place("motion.csv"));
        let (spec, out) = (spec.display().to_string(), out.display().to_string());
        let mut arguments = vec![
            "simulate",
            &spec,
            "--until",
            "3",
            "--interval",
            "0.002",
            "--out",
            &out,
        ];
        arguments.extend(states.iter().flat_map(|state| ["--state", state]));
        run_accepted(&arguments);
        let motion = std::fs::read_to_string(&out).expect("a motion");
        let rows = motion.lines().skip(1).map(|row| {
            let values: Vec<f64> = row
                .split(',')
                .map(|v| v.parse().expect("a number"))
                .collect();
            let noise: f64 = (0..3).map(|_| numbers.symmetric()).sum();
            format!("{},{}\n", values[0], values[1] + 5e-4 * noise)
        });
        std::fs::write(place(name), format!("t,phi\n{}", rows.collect::<String>()))
            .expect("written");
    }
    let paths = ["spec.toml", "dataset.toml", "out"].map(place);
    let found = run_on_dataset("compare", [&paths[0], &paths[1], &paths[2]]);
    assert_eq!(found["verdict"], "no_significant_gap", "{found:#}");
}
