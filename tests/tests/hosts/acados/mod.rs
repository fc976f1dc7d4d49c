//! Tests of models emitted for acados: motions of the integrators and of the optimal control of acados equal motions of
//! `simulate`. Skipped with a message if no package of acados can be installed.
//!
//! The files of the package are not in the folders that acados expects, so the tests create links.
#![cfg(unix)]

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_tests::models;
use eomgen_tests::program::{run_accepted, run_rejected, text};

/// Version of acados with its Python interface and its own CasADi.
const PACKAGE: &str = "comma-deps-acados==0.2.2.post92";

/// Virtual environment with acados.
struct Acados {
    python: PathBuf,
    root: PathBuf,
}

impl Acados {
    fn install(folder: &Path) -> Option<Self> {
        let environment = folder.join("environment");
        let succeeds = |command: &mut Command| {
            let output = command.env("PIP_DISABLE_PIP_VERSION_CHECK", "1").output();
            let output = output.ok().filter(|output| output.status.success())?;
            Some(text(&output.stdout).trim().to_owned())
        };
        let python = environment.join("bin/python");
        let files = succeeds(
            Command::new("python3")
                .args(["-m", "venv"])
                .arg(&environment),
        )
        .and_then(|_| {
            let install = ["-m", "pip", "install", "--quiet", PACKAGE];
            succeeds(Command::new(&python).args(install))
        })
        .and_then(|_| {
            let place = "import acados, casadi; print(acados.__path__[0])";
            succeeds(Command::new(&python).args(["-c", place]))
        });
        let Some(files) = files else {
            skips::skip(&format!(
                "no model ran in acados: pip install {PACKAGE} failed"
            ));
            return None;
        };
        let root = folder.join("acados");
        let interfaces = root.join("interfaces/acados_template");
        std::fs::create_dir_all(&interfaces).expect("a folder");
        let files = PathBuf::from(files);
        for (target, link) in [
            ("install/include", root.join("include")),
            ("install/lib", root.join("lib")),
            ("install/bin", root.join("bin")),
            ("acados_template", interfaces.join("acados_template")),
        ] {
            symlink(files.join(target), link).expect("a link");
        }
        Some(Self { python, root })
    }

    /// Runs a script in a folder and returns its output.
    fn run(&self, folder: &Path, script: &Path, arguments: &[&str]) -> String {
        let output = Command::new(&self.python)
            .arg(script)
            .args(arguments)
            .current_dir(folder)
            .env("ACADOS_SOURCE_DIR", &self.root)
            .env("TERA_PATH", self.root.join("bin/t_renderer"))
            .env("LD_LIBRARY_PATH", self.root.join("lib"))
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .output()
            .expect("python");
        let printed = text(&output.stdout);
        let status = output.status;
        assert!(status.success(), "{printed}{}", text(&output.stderr));
        printed
    }
}

fn generate(name: &str, order: &str, out: &Path) {
    let spec = models::path(name).display().to_string();
    let out = out.display().to_string();
    run_accepted(&[
        "generate", &spec, "--order", order, "--target", "acados", "--out", &out,
    ]);
}

/// Returns the numbers of the last row of a CSV file.
fn last_row(file: &Path) -> Vec<f64> {
    let text = std::fs::read_to_string(file).expect("a table");
    let row = text.lines().last().expect("a row");
    row.split(',')
        .map(|cell| cell.parse().expect("a number"))
        .collect()
}

fn assert_close(found: &[f64], right: &[f64], tolerance: f64) {
    let size = right
        .iter()
        .fold(1.0_f64, |most, value| most.max(value.abs()));
    for (one, other) in found.iter().zip(right) {
        let difference = (one - other).abs();
        assert!(difference <= tolerance * size, "{found:?} {right:?}");
    }
}

#[test]
fn motions_and_optimal_control_in_acados_match_simulate() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let Some(acados) = Acados::install(folder) else {
        return;
    };
    // One process loads two orders of one model and another model.
    let cases = [
        ("furuta_pendulum", "0", "ERK"),
        ("hub_beam_tip_mass", "2", "IRK"),
        ("hub_beam_tip_mass", "1", "ERK"),
    ];
    let steps = models::project().join("tests/tests/hosts/acados/steps.py");
    let mut arguments = Vec::new();
    for (name, order, method) in cases {
        let module = format!("{name}_{order}");
        generate(name, order, &folder.join(&module));
        arguments.extend([module, format!("{name}_acados"), method.to_owned()]);
    }
    let arguments: Vec<&str> = arguments.iter().map(|argument| &**argument).collect();
    let printed = acados.run(folder, &steps, &arguments);
    let found: Vec<Vec<f64>> = printed
        .lines()
        .filter_map(|line| line.strip_prefix("state "))
        .map(|line| {
            line.split(' ')
                .map(|number| number.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert_eq!(found.len(), cases.len(), "{printed}");
    for ((name, order, _), found) in cases.iter().zip(found) {
        let spec = models::path(name).display().to_string();
        let table = folder.join(format!("{name}_{order}.csv"));
        let out = table.display().to_string();
        run_accepted(&[
            "simulate", &spec, "--order", order, "--until", "0.001", "--input", "u=0", "--out",
            &out,
        ]);
        let header = std::fs::read_to_string(&table).expect("a table");
        let header: Vec<&str> = header
            .lines()
            .next()
            .expect("a header")
            .split(',')
            .collect();
        let starts: Vec<String> = (1..=found.len())
            .map(|place| format!("{}={}", header[place], 0.02 * place as f64))
            .collect();
        let states = starts.iter().flat_map(|start| ["--state", start]);
        let mut simulate = vec!["simulate", &spec, "--order", order, "--until", "0.1"];
        simulate.extend(["--input", "u=0.1", "--tolerance", "1e-11", "--out", &out]);
        simulate.extend(states);
        run_accepted(&simulate);
        assert_close(&found, &last_row(&table)[1..=found.len()], 1e-8);
    }

    generate("cart_two_arms", "0", &folder.join("cart"));
    let example = models::project().join("examples/with_acados/move_cart.py");
    let printed = acados.run(folder, &example, &["cart"]);
    assert!(printed.contains(" iterations, "), "{printed}");
    let dataset = "[records]\ntrain = [\"force.csv\"]\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\
                   [inputs.u]\ncolumn = \"u\"\nunit = \"N\"\nhold = \"zero-order\"\n\
                   [channels.x]\ncolumn = \"x\"\nunit = \"m\"\nnoise = 1e-6\n";
    std::fs::write(folder.join("force.toml"), dataset).expect("written");
    let at = |file: &str| folder.join(file).display().to_string();
    let spec = models::path("cart_two_arms").display().to_string();
    let rest = ["--state", "theta_1=0", "--state", "theta_2=0"];
    let record = [
        "simulate",
        &spec,
        "--record",
        &at("force.toml"),
        "--until",
        "2",
    ];
    let out = ["--tolerance", "1e-11", "--out", &at("cart.csv")];
    run_accepted(&[&record[..], &rest, &out].concat());
    let end = last_row(&folder.join("cart.csv"));
    assert_close(&end[1..7], &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 1e-6);
}

#[test]
fn rates_that_depend_on_time_are_rejected_for_acados() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("driven.toml");
    let text = std::fs::read_to_string(models::path("pendulum")).expect("a specification");
    let wind = "\n[forces]\nwind = { on = \"theta\", value = \"m*g*sin(t*sqrt(g/a))*a\" }\n";
    std::fs::write(&spec, text + wind).expect("written");
    let out = folder.path().join("out");
    let said = run_rejected(&[
        "generate",
        &spec.display().to_string(),
        "--target",
        "acados",
        "--out",
        &out.display().to_string(),
    ]);
    assert!(said.contains("depend on time"), "{said}");
    assert!(!out.exists(), "nothing is written");
}
