//! Tests of CUDA C++ headers, compiled by NVRTC for every shipped model in both precisions, without a device. The
//! compiled code must not fuse products and sums, because results would then not be bit-identical. Skipped with a
//! message if NVRTC is missing.

use std::collections::BTreeSet;
use std::process::Command;

use eomgen_codegen::c::{emit, emit_cuda};
use eomgen_codegen::program::Output;
use eomgen_codegen::variant::Variant;
use eomgen_tests::models::{load, project, shipped_specifications};

const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/hosts/cuda/compile.py");

/// Additional functions to emit.
const OUTPUTS: [Output; 5] = [
    Output::BiasForces,
    Output::InverseDynamics,
    Output::Jacobians,
    Output::Regimes,
    Output::Step,
];

fn has_compiler() -> bool {
    let found = Command::new("python3")
        .args(["-c", "import nvidia.cuda_nvrtc"])
        .output();
    let is_there = found.is_ok_and(|output| output.status.success());
    if !is_there {
        skips::skip(
            "CUDA headers were not compiled: python3 with NVRTC is missing (pip install nvidia-cuda-nvrtc-cu12)",
        );
    }
    is_there
}

fn emitted(name: &str) -> String {
    let model = load(name);
    let orders = vec![2; model.fields.len()];
    let variant = Variant::derive_with(&model, &orders, &OUTPUTS).expect("derived");
    emit_cuda(&variant.program).expect("emitted")
}

#[test]
fn every_definition_is_for_the_device() {
    let text = emitted("planetary_arm");
    let definitions = text.lines().filter(|line| {
        let is_inside = line.starts_with([' ', '#', '}', ')', '/', ';']) || line.is_empty();
        !is_inside && !line.starts_with("typedef") && !line.starts_with("enum")
    });
    let mut count = 0;
    for line in definitions {
        assert!(line.contains("__device__ "), "{line}");
        count += 1;
    }
    assert!(count > 50, "{count}");
    for absent in ["extern", "char *const", "#include \"", "inline inline"] {
        assert!(!text.contains(absent), "{absent}");
    }
}

#[test]
fn nvrtc_compiles_shipped_models_without_fused_operations() {
    if !has_compiler() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut files = Vec::new();
    let mut names = BTreeSet::new();
    for path in shipped_specifications() {
        let stem = path.file_stem().expect("a name").to_string_lossy();
        let file = folder.path().join(format!("{stem}.cuh"));
        std::fs::write(&file, emitted(&stem)).expect("written");
        files.push(file.to_string_lossy().into_owned());
        files.push(stem.clone().into_owned());
        names.insert(stem.into_owned());
    }
    for real in ["double", "float"] {
        let output = Command::new("python3")
            .arg(SCRIPT)
            .arg(real)
            .args(&files)
            .output()
            .expect("python can be run");
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{real}: {said}");
        let text = String::from_utf8(output.stdout).expect("text");
        let (lines, fused_by_default) = text.trim_end().rsplit_once('\n').expect("lines");
        for line in lines.lines() {
            let (_, counts) = line.split_once(' ').expect("a name");
            let counts: Vec<u32> = counts
                .split(' ')
                .map(|n| n.parse().expect("a count"))
                .collect();
            assert!(counts[0] > 0 && counts[1] == 0, "{real}: {line}");
        }
        assert_eq!(lines.lines().count(), names.len());
        assert_ne!(
            fused_by_default, "0",
            "the count of fused operations finds none"
        );
    }
}

/// The host code of the example must compile without warnings. If `nvcc` is installed, the example is built and run,
/// and all results must be bit-identical.
#[test]
fn example_advances_arms_on_host_and_device() {
    let folder = tempfile::tempdir().expect("a folder");
    let example = folder.path().join("cuda");
    std::fs::create_dir(&example).expect("a folder");
    for entry in std::fs::read_dir(project().join("examples/cuda")).expect("the example") {
        let entry = entry.expect("an entry");
        std::fs::copy(entry.path(), example.join(entry.file_name())).expect("copied");
    }
    let model = load("planetary_arm");
    let variant = Variant::derive_with(&model, &[3], &[Output::Step]).expect("derived");
    let files = emit(&variant.program).expect("emitted");
    let header = emit_cuda(&variant.program).expect("emitted");
    for (name, text) in [
        ("planetary_arm.c", files.source),
        ("planetary_arm.h", files.header),
        ("planetary_arm.cuh", header),
    ] {
        std::fs::write(example.join(name), text).expect("written");
    }
    let run = |words: &[&str]| {
        let output = Command::new(words[0])
            .args(&words[1..])
            .current_dir(&example)
            .output()
            .expect("a command");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words:?}: {said}");
        String::from_utf8(output.stdout).expect("text")
    };
    let warnings = [
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-ffp-contract=off",
    ];
    run(&[&["cc", "-c", "arms.c", "-o", "arms.o"], &warnings[..]].concat());
    if Command::new("nvcc").arg("--version").output().is_err() {
        skips::skip("the arms did not move on a CUDA device: nvcc is missing");
        return;
    }
    run(&["./build", "."]);
    for program in ["./arms_double", "./arms_float"] {
        let said = run(&[program, "1000", "10"]);
        assert!(said.contains("numbers that differ: 0 of 12000"), "{said}");
    }
}
