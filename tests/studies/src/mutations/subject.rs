//! Emitted files that receive faults, and their checks.

use std::fmt;
use std::path::Path;
use std::process::Command;

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::Packaging;
use eomgen_codegen::variant::Variant;
use eomgen_codegen::{c, rust};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::models::{
    DOUBLE_PENDULUM, EMPS, FURUTA_PENDULUM, HUB_BEAM_TIP_MASS, PLANETARY_ARM_RIG, ShippedModel,
};
use eomgen_validate::certify::{CCompiler, CSource};
use eomgen_validate::model_certificate::{Sources, check_sources};

use super::tokens::without_comments;

/// Result of the checks of a subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The fault is detected: a check failed, or the source does not compile.
    Noticed,
    /// The mutant is equivalent: it has the same machine code or the same tokens.
    Equivalent,
    /// The fault is not detected: all checks passed.
    Passed,
}

/// Emitted file.
#[derive(Clone)]
pub struct File {
    pub name: String,
    pub text: String,
}

/// Emitted files of one model in one language.
pub struct Subject {
    model: Model,
    orders: Vec<usize>,
    outputs: Vec<Output>,
    name: String,
    /// Emitted files: the source first, then the header of C.
    pub files: Vec<File>,
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} as {}",
            self.name,
            if self.is_c() { "C" } else { "Rust" }
        )
    }
}

/// Carriage with a sampled controller.
const SAMPLED_POSITION: ShippedModel = ShippedModel {
    name: "sampled_position",
    text: include_str!("sampled_position.toml"),
};

/// Models with orders and outputs. They cover trigonometric functions, friction, fields, backlash, a controller and
/// steps.
const MODELS: [(ShippedModel, usize, &[Output]); 6] = [
    (
        DOUBLE_PENDULUM,
        0,
        &[Output::BiasForces, Output::InverseDynamics],
    ),
    (FURUTA_PENDULUM, 0, &[Output::Jacobians]),
    (EMPS, 0, &[Output::GuardRates]),
    (HUB_BEAM_TIP_MASS, 2, &[Output::Products]),
    (PLANETARY_ARM_RIG, 1, &[]),
    (SAMPLED_POSITION, 0, &[Output::Step]),
];

/// Emits all subjects, each in C and in Rust.
pub fn all() -> Result<Vec<Subject>, String> {
    let mut all = Vec::new();
    for (shipped, order, outputs) in MODELS {
        for is_c in [true, false] {
            let model = eomgen_model_spec::check(shipped.source())
                .map_err(|e| e.to_string())?
                .model;
            let orders = vec![order; model.fields.len()];
            let variant =
                Variant::derive_with(&model, &orders, outputs).map_err(|e| e.to_string())?;
            let program = &variant.program;
            let name = program.name.clone();
            let files = match is_c {
                true => {
                    let c::Files { source, header } =
                        c::emit(program).map_err(|e| e.to_string())?;
                    vec![
                        File {
                            name: format!("{name}.c"),
                            text: source,
                        },
                        File {
                            name: format!("{name}.h"),
                            text: header,
                        },
                    ]
                }
                false => {
                    let text = rust::emit(program, Packaging::Crate).map_err(|e| e.to_string())?;
                    vec![File {
                        name: "lib.rs".to_owned(),
                        text,
                    }]
                }
            };
            all.push(Subject {
                orders,
                outputs: outputs.to_vec(),
                name,
                files,
                model,
            });
        }
    }
    Ok(all)
}

impl Subject {
    fn is_c(&self) -> bool {
        self.files.len() > 1
    }

    /// Returns the indices of the files to draw from; the source is drawn four times as often as the header.
    pub fn choices(&self) -> Vec<usize> {
        match self.is_c() {
            true => vec![0, 0, 0, 0, 1],
            false => vec![0],
        }
    }

    /// Runs the checks that compile the sources.
    pub fn judge(&self, files: &[File]) -> Result<Verdict, String> {
        let sources = match self.is_c() {
            true => Sources {
                c: vec![CSource {
                    name: self.name.clone(),
                    file: self.files[0].name.clone(),
                    source: files[0].text.clone(),
                    header: files[1].text.clone(),
                    outputs: self
                        .outputs
                        .iter()
                        .map(|output| output.name().to_owned())
                        .collect(),
                    compiler: CCompiler::default(),
                }],
                ..Sources::default()
            },
            false => Sources {
                rust: Some(files[0].text.clone()),
                ..Sources::default()
            },
        };
        let checks = check_sources(&self.model, &self.orders, &self.outputs, &sources);
        let checks = checks.map_err(|error| error.to_string())?;
        let failed = checks
            .iter()
            .any(|check| check.skipped.is_none() && !check.passed);
        Ok(if failed {
            Verdict::Noticed
        } else {
            Verdict::Passed
        })
    }

    /// Returns true if the changed file has the same tokens as the emitted file, or (for C) the same machine code in
    /// both precisions.
    pub fn is_equivalent(&self, changed: usize, files: &[File]) -> Result<bool, String> {
        let is_same =
            without_comments(&files[changed].text) == without_comments(&self.files[changed].text);
        if is_same || !self.is_c() {
            return Ok(is_same);
        }
        for real in ["double", "float"] {
            if self.object(&self.files, real)? != self.object(files, real)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Compiles C and returns the object file.
    fn object(&self, files: &[File], real: &str) -> Result<Vec<u8>, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let path = |name: &str| folder.path().join(name);
        for file in files {
            std::fs::write(path(&file.name), &file.text).map_err(|error| error.to_string())?;
        }
        compile(
            folder.path(),
            &self.files[0].name,
            &format!("-D{}_REAL={real}", self.name),
        )?;
        std::fs::read(path("object.o")).map_err(|error| error.to_string())
    }
}

fn compile(folder: &Path, file: &str, real: &str) -> Result<(), String> {
    let options = [
        "-std=c99",
        "-O2",
        "-ffp-contract=off",
        real,
        "-c",
        "-o",
        "object.o",
        file,
    ];
    let output = Command::new("cc")
        .args(options)
        .current_dir(folder)
        .output();
    let output = output.map_err(|error| format!("cc: {error}"))?;
    match output.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}
