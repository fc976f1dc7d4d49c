//! External hosts: Python, functional mock-up units in FMPy, and the page in Node.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

use super::cases::Case;
use super::command_line::{execute, program};
use super::compare::TOLERANCE;
use super::host::{Answer, Host, HostRun};

/// Targets of functional mock-up units.
const TARGETS: [&str; 2] = ["fmu2", "fmu3"];

/// Interface types of units, with their keys in the answers of the script.
const KINDS: [(Host, &str); 2] = [(Host::CoSimulation, "cs"), (Host::ModelExchange, "me")];

/// Folder of the Python package, in the folder of the study.
const PACKAGES: &str = "python";

/// Assembles the Python package from its sources and the library that was built together with the program.
///
/// # Errors
/// A file that cannot be copied.
pub fn assemble_package(folder: &Path) -> Result<(), String> {
    let library = format!(
        "{}eomgen_native{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    let library = program().with_file_name(library);
    if !library.is_file() {
        return Ok(());
    }
    let failed = |error: std::io::Error| format!("the Python package: {error}");
    let package = folder.join(PACKAGES).join("eomgen");
    std::fs::create_dir_all(&package).map_err(failed)?;
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/package/eomgen");
    for entry in std::fs::read_dir(sources).map_err(failed)?.flatten() {
        if entry.path().extension().is_some_and(|end| end == "py") {
            std::fs::copy(entry.path(), package.join(entry.file_name())).map_err(failed)?;
        }
    }
    let end = if cfg!(windows) { "pyd" } else { "so" };
    std::fs::copy(library, package.join(format!("_native.{end}"))).map_err(failed)?;
    Ok(())
}

/// Runs all external hosts.
///
/// # Errors
/// A host that fails without an answer.
pub fn runs(case: &Case, folder: &Path) -> Result<Vec<HostRun>, String> {
    let own = folder.join(&case.name);
    std::fs::create_dir_all(&own).map_err(|error| error.to_string())?;
    let mut runs = Vec::new();
    let mut units = serde_json::Map::new();
    for target in TARGETS {
        match write_unit(case, target, &own.join(target)) {
            Ok(unit) => {
                units.insert(target.to_owned(), json!(unit));
            }
            Err(reason) => runs.extend(KINDS.map(|(host, _)| HostRun {
                host,
                answer: Answer::Rejected(reason.clone()),
            })),
        }
    }
    let job = describe(case, &units);
    let found = run_script("python3", "guests.py", &job, &own)?;
    runs.push(HostRun {
        host: Host::Python,
        answer: answer(&found["python"])?,
    });
    for target in units.keys() {
        for (host, kind) in KINDS {
            let answer = answer(&found[format!("{target}_{kind}")])?;
            runs.push(HostRun { host, answer });
        }
    }
    runs.push(HostRun {
        host: Host::Page,
        answer: page(case, &job, &own)?,
    });
    Ok(runs)
}

fn describe(case: &Case, units: &serde_json::Map<String, Value>) -> Value {
    let known = &case.model.model().inputs;
    let inputs = case.inputs.iter().map(|input| {
        json!({
            "name": input.name,
            "place": known.iter().position(|known| known.name == input.name),
            "expression": case.expression(input),
            "sine": input.sine.map(|sine| [sine.amplitude, sine.frequency]),
            "samples": input.samples,
        })
    });
    json!({
        "specification": case.file,
        "units": units,
        "states": case.model.state_names(),
        "initial": case.initial,
        "times": case.times(),
        "inputs": inputs.collect::<Vec<_>>(),
        "default_inputs": case.model.default_inputs(),
        "tolerance": TOLERANCE,
    })
}

fn write_unit(case: &Case, target: &str, out: &Path) -> Result<PathBuf, String> {
    let mut command = Command::new(program());
    command.arg("generate").arg(&case.file);
    execute(command.args(["--target", target, "--out"]).arg(out))?;
    let entries = std::fs::read_dir(out).map_err(|error| error.to_string())?;
    let mut files = entries.flatten().map(|entry| entry.path());
    files
        .find(|path| path.extension().is_some_and(|end| end == "fmu"))
        .ok_or_else(|| "no unit was written".to_owned())
}

/// Runs a script on a job and returns its answers.
fn run_script(tool: &str, script: &str, job: &Value, folder: &Path) -> Result<Value, String> {
    let file = folder.join("job.json");
    std::fs::write(&file, job.to_string()).map_err(|error| error.to_string())?;
    let place = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/hosts")).join(script);
    let mut command = Command::new(tool);
    command.arg(place).arg(&file);
    if let Some(packages) = folder.parent().map(|folder| folder.join(PACKAGES)) {
        command.env("PYTHONPATH", packages);
    }
    let output = command.output();
    let output = output.map_err(|error| format!("{tool}: {error}"))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{script}: {}: {text}", output.status));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| format!("{script}: {error}"))
}

fn answer(found: &Value) -> Result<Answer, String> {
    let text = |key: &str| found[key].as_str().map(str::to_owned);
    if let Some(reason) = text("rejected") {
        return Ok(Answer::Rejected(reason));
    }
    if let Some(reason) = text("missing") {
        return Ok(Answer::Missing(reason));
    }
    let rows = found["states"].as_array().ok_or("a host gave no answer")?;
    let row = |row: &Value| {
        let numbers = row.as_array().ok_or("a row is no list")?.iter();
        Ok::<_, String>(
            numbers
                .map(|number| number.as_f64().unwrap_or(f64::NAN))
                .collect(),
        )
    };
    Ok(Answer::Motion(
        rows.iter().map(row).collect::<Result<_, _>>()?,
    ))
}

fn page(case: &Case, job: &Value, folder: &Path) -> Result<Answer, String> {
    if Command::new("node").arg("--version").output().is_err() {
        return Ok(Answer::Missing("page: node is missing".to_owned()));
    }
    let out = folder.join("page.html");
    let mut command = Command::new(program());
    command.arg("page").arg(&case.file).arg("--out").arg(&out);
    if let Err(reason) = execute(&mut command) {
        return Ok(Answer::Rejected(reason));
    }
    let mut job = job.clone();
    job["page"] = json!(out);
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../sim/page/src/play/engine.js"
    );
    job["script"] = json!(script);
    answer(&run_script("node", "page.mjs", &job, folder)?)
}
