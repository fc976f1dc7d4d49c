//! Tests of the packages to publish: each has complete metadata, builds from its own files, and depends only on
//! published packages.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_tests::models::project;
use serde_json::Value;

fn cargo(arguments: &[&str]) -> String {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(arguments)
        .args(["--offline", "--locked"])
        .current_dir(project())
        .output()
        .expect("cargo can be run");
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// Returns the published packages of the workspace, and all packages.
fn packages() -> (Vec<Value>, Vec<Value>) {
    let metadata = cargo(&["metadata", "--format-version", "1", "--no-deps"]);
    let mut metadata: Value = serde_json::from_str(&metadata).expect("JSON");
    let Value::Array(all) = metadata["packages"].take() else {
        panic!("no packages: {metadata}");
    };
    // Cargo reports `publish = false` as an empty list of registries.
    let published = all.iter().filter(|package| package["publish"].is_null());
    (published.cloned().collect(), all)
}

fn name(package: &Value) -> &str {
    package["name"].as_str().expect("a name")
}

fn folder(package: &Value) -> &Path {
    let manifest = Path::new(package["manifest_path"].as_str().expect("a path"));
    manifest.parent().expect("a folder")
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten() {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
    found
}

#[test]
fn published_packages_have_complete_metadata() {
    let (published, all) = packages();
    assert!(published.len() >= 8 && published.len() < all.len());
    for package in &published {
        let shown = name(package);
        for field in [
            "description",
            "license",
            "repository",
            "readme",
            "rust_version",
        ] {
            assert!(package[field].is_string(), "{shown} has no {field}");
        }
        for field in ["keywords", "categories"] {
            let words = package[field].as_array().expect("a list");
            assert!((1..=5).contains(&words.len()), "{shown}: {field} {words:?}");
        }
        assert!(
            package["metadata"]["docs"]["rs"].is_object(),
            "{shown} has no settings for docs.rs"
        );
        for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let own = std::fs::read(folder(package).join(licence)).unwrap_or_default();
            let whole = std::fs::read(project().join(licence)).expect("a licence");
            assert!(own == whole, "{shown} has no {licence}");
        }
    }
}

#[test]
fn repository_is_set_in_one_line_and_marked_as_placeholder() {
    let (published, all) = packages();
    let repository = published[0]["repository"].as_str().expect("a URL");
    let manifests = all.iter().map(|package| folder(package).join("Cargo.toml"));
    let manifests = manifests.chain([project().join("Cargo.toml")]);
    let text = |path: PathBuf| std::fs::read_to_string(path).expect("a manifest");
    let lines: usize = manifests
        .map(|path| text(path).matches(repository).count())
        .sum();
    assert_eq!(lines, 1, "{repository}");
    let workspace = text(project().join("Cargo.toml"));
    let mark =
        format!("# A placeholder until the repository is public.\nrepository = \"{repository}\"");
    assert!(workspace.contains(&mark), "{repository}");
}

#[test]
fn binstall_downloads_the_archives_of_a_release() {
    let (published, _) = packages();
    let program = published
        .iter()
        .find(|package| name(package) == "eomgen-cli");
    let program = program.expect("a package");
    let text = |value: &Value| value.as_str().expect("a text").to_owned();
    let (version, repository) = (text(&program["version"]), text(&program["repository"]));
    let target = "x86_64-unknown-linux-musl";
    let expanded = |key: &str| {
        text(&program["metadata"]["binstall"][key])
            .replace("{ repo }", &repository)
            .replace("{ version }", &version)
            .replace("{ target }", target)
    };
    let script = std::fs::read_to_string(project().join(".ci/pack_program")).expect("a script");
    let archive = script.lines().find_map(|line| line.strip_prefix("name="));
    let archive = archive.expect("the name of the archive").trim_matches('"');
    let archive = archive
        .replace("$version", &version)
        .replace("$target", target);
    let release = format!("{repository}/releases/download/v{version}");
    assert_eq!(expanded("pkg-url"), format!("{release}/{archive}.tar.gz"));
    assert_eq!(
        expanded("bin-dir"),
        format!("{archive}/{{ bin }}{{ binary-ext }}")
    );
    let workflow = project().join(".github/workflows/release.yml");
    let workflow = std::fs::read_to_string(workflow).expect("a workflow");
    assert!(
        workflow.contains(&format!("target: {target} }}")),
        "{workflow}"
    );
}

#[test]
fn published_packages_depend_on_published_packages_only() {
    let (published, _) = packages();
    let known: Vec<&str> = published.iter().map(name).collect();
    for package in &published {
        let needed = package["dependencies"].as_array().expect("a list");
        // Development dependencies need not be published.
        let needed = needed.iter().filter(|needed| needed["kind"] != "dev");
        for needed in needed.filter(|needed| needed["path"].is_string()) {
            let shown = format!("{} needs {}", name(package), name(needed));
            assert!(
                known.contains(&name(needed)),
                "{shown}, which is not published"
            );
            assert_ne!(needed["req"], "*", "{shown} of no version");
        }
    }
}

#[test]
fn sources_include_no_file_outside_their_package() {
    for package in packages().0 {
        let root = folder(&package).canonicalize().expect("a folder");
        for source in sources(&root.join("src")) {
            let text = std::fs::read_to_string(&source).expect("a source");
            for macro_name in ["include_str!(", "include_bytes!(", "include!("] {
                for part in text.split(macro_name).skip(1) {
                    let Some(path) = part.trim_start().strip_prefix('"') else {
                        continue;
                    };
                    let path = path.split('"').next().expect("its end");
                    let file = source.parent().expect("a folder").join(path).canonicalize();
                    let inside = file.is_ok_and(|file| file.starts_with(&root));
                    assert!(inside, "{} includes {path}", source.display());
                }
            }
        }
    }
}

#[test]
fn macro_depends_on_no_solver() {
    let tree = [
        "tree",
        "--package",
        "eomgen",
        "--edges",
        "normal,build",
        "--prefix",
        "none",
    ];
    let tree = cargo(&tree);
    let mut names: Vec<&str> = tree
        .lines()
        .filter_map(|line| line.split(' ').next())
        .collect();
    names.sort_unstable();
    names.dedup();
    assert!(names.contains(&"eomgen-codegen"), "{names:?}");
    for solver in [
        "eomgen-sim",
        "eomgen-jit",
        "eomgen-discover",
        "nalgebra",
        "rayon",
    ] {
        assert!(!names.contains(&solver), "{solver}");
    }
    assert!(names.len() <= 45, "{}: {names:?}", names.len());
}

#[test]
fn only_paper_commands_use_the_paper_crate() {
    let (published, _) = packages();
    let mut users: Vec<String> = published
        .iter()
        .flat_map(|package| sources(folder(package)))
        .filter(|path| {
            let source = std::fs::read_to_string(path).expect("a source file");
            source.contains("eomgen_paper::")
        })
        .map(|path| {
            let own = path.strip_prefix(project()).expect("a file of the project");
            own.display().to_string()
        })
        .collect();
    users.sort();
    let commands = ["cli/src/commands/claims.rs", "cli/src/commands/study.rs"];
    assert_eq!(users, commands);
}
