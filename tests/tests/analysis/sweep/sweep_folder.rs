//! Folder with a specification to sweep, and the files of a sweep.

use std::fs;
use std::path::{Path, PathBuf};

use eomgen_sweep::{Folder, Table, merge};
use eomgen_tests::program::{run_accepted, run_rejected};

/// Oscillator m x'' + c x' + k x = F sin(omega t). The unit of c is not SI, to test the conversion.
pub const OSCILLATOR: &str = r#"
[model]
name  = "oscillator"
title = "Forced linear oscillator"
[parameters]
m     = { value = 1,    unit = "kg",    doc = "mass", min = 0 }
c     = { value = 500,  unit = "g/s",   doc = "damping" }
zeta  = { value = "c/(2*sqrt(k*m))", unit = "1", doc = "damping ratio" }
k     = { value = 4,    unit = "N/m",   doc = "stiffness" }
F     = { value = 3,    unit = "N",     doc = "amplitude" }
omega = { value = 2,    unit = "rad/s", doc = "frequency" }
[coordinates]
x = { unit = "m", doc = "displacement" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[dissipation]
damper = "zeta*sqrt(k*m)*dot(x)^2"
[forces]
drive = { on = "x", value = "F*sin(omega*t)" }
"#;

pub struct SweepFolder {
    folder: tempfile::TempDir,
}

impl SweepFolder {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("oscillator.toml"), OSCILLATOR).expect("a specification");
        Self { folder }
    }

    pub fn path_to(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn sweep(&self, out: &str, more: &[&str]) -> Vec<String> {
        let spec = self.path_to("oscillator.toml").display().to_string();
        let out = self.path_to(out).display().to_string();
        let given = ["sweep", &spec, "--out", &out, "--measure", "poincare"];
        let given = given.iter().chain(more);
        given.map(|argument| (*argument).to_owned()).collect()
    }
}

/// Options of a sweep over two axes with fast points.
pub const MAP: [&str; 8] = [
    "--vary",
    "c=400:1000:4",
    "--vary",
    "omega=1:3:5",
    "--transient",
    "20",
    "--periods",
    "4",
];

pub fn accept(arguments: &[String]) -> String {
    run_accepted(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

pub fn expect_rejection(arguments: &[String]) -> String {
    run_rejected(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

pub fn merge_command(folder: &Path) -> Vec<String> {
    vec!["merge".to_owned(), folder.display().to_string()]
}

pub fn results(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder") {
        let entry = entry.expect("an entry");
        let name = entry.file_name().to_string_lossy().into_owned();
        if name != "parts" {
            found.push((name, fs::read(entry.path()).expect("a file")));
        }
    }
    found.sort();
    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "map_poincare.png",
            "sweep.csv",
            "sweep.json",
            "sweep.parquet"
        ]
    );
    found
}

pub fn parts(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder.join("parts")) else {
        return Vec::new();
    };
    let names = entries.map(|entry| entry.expect("an entry").file_name());
    let mut names: Vec<String> = names
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

pub fn table(folder: &Path) -> Table {
    merge(&Folder::open_existing(folder).expect("a sweep")).expect("all points")
}

pub fn column<'a>(table: &'a Table, name: &str) -> &'a [f64] {
    table
        .column(name)
        .unwrap_or_else(|| panic!("{name} among {:?}", table.names))
}
