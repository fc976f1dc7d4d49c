//! Test of emitted C for compliance with MISRA C:2012 with the add-on of cppcheck. The reported required and mandatory
//! rules must equal the documented list of deviations. Skipped with a message without cppcheck.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use eomgen_tests::models::project;
use eomgen_tests::program::eomgen;

/// Advisory rules. Reports of these rules need no documented deviation.
const ADVISORY: &str = "1.2 2.3 2.4 2.5 2.6 2.7 4.2 5.9 8.7 8.9 8.11 8.13 10.5 11.4 11.5 12.1 12.3 12.4 13.3 13.4 15.1 \
                        15.4 15.5 17.5 17.8 18.4 18.5 19.2 20.1 20.5 20.10 21.12";

/// Specifications with options of `generate`. They cover fields with all additional functions, regimes, sums of
/// elementary functions, and controllers.
const MODELS: [(&str, &[&str]); 6] = [
    (
        "model-spec/models/planetary_arm.toml",
        &["--order", "1", "--with", "regimes,linearisation,step"],
    ),
    (
        "model-spec/models/hub_beam_tip_mass.toml",
        &["--order", "0"],
    ),
    (
        "model-spec/models/loudspeaker.toml",
        &["--with", "bias_forces,inverse_dynamics,products"],
    ),
    (
        "examples/friction/stribeck_belt.toml",
        &["--with", "regimes,guard_rates,products"],
    ),
    (
        "examples/recipes/hydraulic_axis.toml",
        &["--with", "jacobians,self_test"],
    ),
    (
        "examples/closed_loop/regulator.toml",
        &["--with", "step,self_test"],
    ),
];

#[test]
fn violated_required_rules_equal_the_documented_deviations() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let probe = folder.join("probe.c");
    std::fs::write(&probe, "static int unused = 0x7U + 010;\n").expect("written");
    if broken_rules(&probe, &[]).is_none_or(|rules| rules.is_empty()) {
        skips::skip(
            "the emitted C was not checked against MISRA C:2012: cppcheck with its add-on `misra` is missing \
             (Debian: apt-get install cppcheck)",
        );
        return;
    }
    let mut broken = BTreeSet::new();
    for (place, (specification, options)) in MODELS.into_iter().enumerate() {
        let out = folder.join(place.to_string());
        let output = eomgen()
            .arg("generate")
            .arg(project().join(specification))
            .args(["--target", "c99", "--out"])
            .arg(&out)
            .args(options)
            .output()
            .expect("the program can be run");
        assert!(output.status.success(), "{specification}: {output:?}");
        let name = Path::new(specification).file_stem().expect("a name");
        let name = name.to_str().expect("a name");
        let source = out.join(format!("{name}.c"));
        for number in ["double", "float"] {
            let number = format!("-D{name}_REAL={number}");
            broken.extend(broken_rules(&source, &[&number]).expect("a report"));
        }
        if out.join("vectors.h").is_file() {
            let caller = out.join("caller.c");
            let text = format!(
                "#include \"vectors.h\"\nint run(void);\nint run(void) {{\n    return {name}_self_test();\n}}\n"
            );
            std::fs::write(&caller, text).expect("written");
            broken.extend(broken_rules(&caller, &[]).expect("a report"));
        }
    }
    let advisory: BTreeSet<String> = ADVISORY.split_whitespace().map(str::to_owned).collect();
    let broken: BTreeSet<String> = broken.difference(&advisory).cloned().collect();
    assert_eq!(
        broken,
        listed_deviations(),
        "left: reported by cppcheck; right: listed in docs/embedding.md"
    );
}

/// Returns the rules that a file violates; `None` if cppcheck is not installed.
fn broken_rules(file: &Path, options: &[&str]) -> Option<BTreeSet<String>> {
    let output = Command::new("cppcheck")
        .args(["--quiet", "--std=c99", "--enable=style", "--addon=misra"])
        .args(options)
        .arg(file)
        .output();
    let report = String::from_utf8(output.ok()?.stderr).ok()?;
    let rules = report.split("misra-c2012-").skip(1);
    let number = |rest: &str| {
        let end = rest.find(|c: char| c != '.' && !c.is_ascii_digit());
        end.map(|end| rest[..end].to_owned())
    };
    rules.map(number).collect()
}

/// Returns the first column of the table of deviations.
fn listed_deviations() -> BTreeSet<String> {
    let page = std::fs::read_to_string(project().join("docs/embedding.md")).expect("the page");
    let (_, section) = page
        .split_once("\n### MISRA C:2012\n")
        .expect("the section of deviations");
    let rows = section
        .lines()
        .skip_while(|line| !line.starts_with("| ---"));
    let rows = rows.skip(1).take_while(|line| line.starts_with('|'));
    let rule = |row: &str| {
        row.trim_matches('|')
            .split('|')
            .next()
            .map(str::trim)
            .map(str::to_owned)
    };
    let rules: BTreeSet<String> = rows.filter_map(rule).collect();
    assert!(!rules.is_empty(), "the list of deviations is empty");
    rules
}
