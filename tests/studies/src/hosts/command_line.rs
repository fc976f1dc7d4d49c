//! Hosts within the program: the solvers of `simulate`, and `sweep`.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_model_spec::model::{Parameter, ParameterValue};

use super::cases::{Case, INTERVALS};
use super::compare::TOLERANCE;
use super::host::{Answer, Host, HostRun};

/// Returns the path of the program that was built together with the study.
pub fn program() -> PathBuf {
    let own = std::env::current_exe().unwrap_or_default();
    // Tests run from the folder `deps`, one level deeper.
    let folders = own.ancestors().skip(1).take(2);
    let name = format!("eomgen{}", std::env::consts::EXE_SUFFIX);
    let mut paths = folders.map(|folder| folder.join(&name));
    paths
        .find(|path| path.is_file())
        .unwrap_or_else(|| PathBuf::from(name))
}

/// Runs the solvers and a sweep for a case.
pub fn runs(case: &Case, folder: &Path) -> Vec<HostRun> {
    let solvers = [
        (Host::Rk, "rk"),
        (Host::Radau, "radau"),
        (Host::Adams, "adams"),
        (Host::Exact, "exact"),
    ];
    let mut runs: Vec<HostRun> = solvers
        .into_iter()
        .map(|(host, solver)| HostRun {
            host,
            answer: simulate(case, solver, folder).unwrap_or_else(Answer::Rejected),
        })
        .collect();
    runs.push(HostRun {
        host: Host::Sweep,
        answer: sweep(case, folder).unwrap_or_else(Answer::Rejected),
    });
    runs
}

/// Adds the initial state and the inputs of a case to a command.
fn with_motion<'c>(command: &'c mut Command, case: &Case) -> &'c mut Command {
    command.args(["--until", &format!("{:e}", case.until)]);
    for (name, value) in case.model.state_names().iter().zip(&case.initial) {
        command.args(["--state", &format!("{name}={value:e}")]);
    }
    for input in &case.inputs {
        command.args([
            "--input",
            &format!("{}={}", input.name, case.expression(input)),
        ]);
    }
    command
}

/// Runs the program.
///
/// # Errors
/// The first line of the program's error message.
pub fn execute(command: &mut Command) -> Result<(), String> {
    let output = command.output().map_err(|error| error.to_string())?;
    match output.status.success() {
        true => Ok(()),
        false => Err(first_error(&String::from_utf8_lossy(&output.stderr))),
    }
}

fn first_error(text: &str) -> String {
    let line = text.lines().find_map(|line| line.strip_prefix("error: "));
    line.or(text.lines().last()).unwrap_or_default().to_owned()
}

fn simulate(case: &Case, solver: &str, folder: &Path) -> Result<Answer, String> {
    let out = folder.join(format!("{}_{solver}.csv", case.name));
    let mut command = Command::new(program());
    command.arg("simulate").arg(&case.file);
    command.args(["--solver", solver]);
    if solver != "exact" {
        command.args(["--tolerance", &format!("{TOLERANCE:e}")]);
    }
    let interval = format!("{:e}", case.until / INTERVALS as f64);
    command.args(["--interval", &interval]);
    execute(with_motion(&mut command, case).arg("--out").arg(&out))?;
    let text = std::fs::read_to_string(&out).map_err(|error| error.to_string())?;
    Ok(Answer::Motion(columns(&text, &case.model.state_names())?))
}

/// Returns the named columns of a table, one row for each line.
fn columns(text: &str, names: &[String]) -> Result<Vec<Vec<f64>>, String> {
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let places = names.iter().map(|name| {
        let place = head.iter().position(|known| known == name);
        place.ok_or_else(|| format!("the table has no column `{name}`"))
    });
    let places: Vec<usize> = places.collect::<Result<_, _>>()?;
    let row = |line: &str| {
        let numbers: Vec<&str> = line.split(',').collect();
        let number = |place: &usize| {
            let text = numbers.get(*place).copied().unwrap_or_default();
            text.parse::<f64>()
                .map_err(|_| format!("no number: {text:?}"))
        };
        places.iter().map(number).collect()
    };
    lines.map(row).collect()
}

/// Computes the final state by a sweep over one value of a parameter.
fn sweep(case: &Case, folder: &Path) -> Result<Answer, String> {
    let out = folder.join(format!("{}_sweep", case.name));
    let names = case.model.state_names();
    let parameters = &case.model.model().parameters;
    let measured: Vec<String> = names.iter().map(|name| format!("final:{name}")).collect();
    let number = |known: &Parameter| match known.value {
        ParameterValue::Number(value) => Some((known.name.clone(), known.unit.from_si(value))),
        ParameterValue::Expression(_) => None,
    };
    let (parameter, value) = (parameters.iter())
        .find_map(number)
        .ok_or("the model has no parameter with a number")?;
    let mut command = Command::new(program());
    command.arg("sweep").arg(&case.file);
    command.args(["--vary", &format!("{parameter}={value:e}:{value:e}:1")]);
    command.args(["--measure", &measured.join(",")]);
    execute(with_motion(&mut command, case).arg("--out").arg(&out))?;
    let text = std::fs::read_to_string(out.join("sweep.csv")).map_err(|error| error.to_string())?;
    Ok(Answer::Motion(columns(&text, &measured)?))
}
