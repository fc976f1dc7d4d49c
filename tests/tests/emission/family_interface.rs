//! Tests of one program for all orders of a family, with the trait in Rust and with tables of function pointers in C.

use std::process::Command;

use super::families::{WRITTEN, run};

/// Rust program that integrates each variant by the classical Runge-Kutta method and prints hub, tip and energy as
/// bits.
const IN_RUST: &str = r#"
use models::Model;

fn index(names: &[&str], name: &str) -> usize {
    names.iter().position(|known| *known == name).unwrap()
}

fn moved<M: Model>(state: M::State, slope: &M::State, length: f64) -> M::State {
    let mut moved = state;
    for (number, slope) in moved.as_mut().iter_mut().zip(slope.as_ref()) {
        *number += length * slope;
    }
    moved
}

fn run<M: Model>() {
    let coefficients = M::default().prepare().unwrap();
    let (hub, motor) = (index(M::STATE_NAMES, "hub"), index(M::STATE_NAMES, "motor_dot"));
    let mut state = M::zero_state();
    state.as_mut()[motor] = 0.1;
    let (inputs, h) = (M::inputs(&[0.5]), 1e-5);
    for step in 0..200 {
        let t = step as f64 * h;
        let rates = |t: f64, state: &M::State| M::rates(t, state, &inputs, &coefficients);
        let k1 = rates(t, &state);
        let k2 = rates(t + h / 2.0, &moved::<M>(state, &k1, h / 2.0));
        let k3 = rates(t + h / 2.0, &moved::<M>(state, &k2, h / 2.0));
        let k4 = rates(t + h, &moved::<M>(state, &k3, h));
        for (slope, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            state = moved::<M>(state, &slope, h / 6.0 * weight);
        }
    }
    let tip = M::observables(0.0, &state, &inputs, &coefficients).as_ref()[index(M::OBSERVABLE_NAMES, "tip")];
    let energy = M::energy(0.0, &state, &inputs, &coefficients);
    let power = M::power(0.0, &state, &inputs, &coefficients);
    let mass = M::mass(0.0, &state, &inputs, &coefficients, (0, 0)).unwrap();
    let guards = M::guards(0.0, &state, &inputs, &coefficients).as_ref().len();
    for number in [state.as_ref()[hub], tip, energy, power, mass] {
        print!("{:016x} ", number.to_bits());
    }
    println!("{guards} {} {}", M::DEGREES_OF_FREEDOM, M::PARAMETER_NAMES.len());
    assert!(M::from_numbers(&[]).prepare().is_none());
    assert_eq!((M::GUARDS, M::INPUT_NAMES), (guards, &["u"][..]));
}

fn main() {
    run::<models::beam_1::Parameters>();
    run::<models::long_beam::Parameters>();
}
"#;

/// The same in C.
const IN_C: &str = r#"
#include "models.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static int find(const char *const *names, int count, const char *name) {
    for (int i = 0; i < count; ++i) {
        if (strcmp(names[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

static void move(int count, double *to, const double *from, const double *slope, double length) {
    for (int i = 0; i < count; ++i) {
        to[i] = from[i] + length * slope[i];
    }
}

static void show(double number) {
    uint64_t bits;
    memcpy(&bits, &number, sizeof bits);
    printf("%016" PRIx64 " ", bits);
}

static void run(const eomgen_model *m) {
    static double parameters[500], coefficients[500], inputs[50], mass[400];
    double state[40] = {0}, stage[40], k[4][40], values[40];
    const double u[1] = {0.5}, h = 1e-5;
    const int n = m->states;
    if (m->size_of_parameters > sizeof parameters || m->size_of_coefficients > sizeof coefficients) {
        return;
    }
    m->parameters_from_array(state, parameters);
    if (m->prepare(parameters, coefficients)) {
        return;
    }
    m->default_parameters(parameters);
    if (!m->prepare(parameters, coefficients)) {
        return;
    }
    m->inputs_from_array(u, inputs);
    state[find(m->state_names, n, "motor_dot")] = 0.1;
    for (int step = 0; step < 200; ++step) {
        const double t = step * h;
        m->rates(t, state, inputs, coefficients, k[0]);
        move(n, stage, state, k[0], h / 2);
        m->rates(t + h / 2, stage, inputs, coefficients, k[1]);
        move(n, stage, state, k[1], h / 2);
        m->rates(t + h / 2, stage, inputs, coefficients, k[2]);
        move(n, stage, state, k[2], h);
        m->rates(t + h, stage, inputs, coefficients, k[3]);
        for (int i = 0; i < 4; ++i) {
            move(n, state, state, k[i], h / 6 * (i == 1 || i == 2 ? 2.0 : 1.0));
        }
    }
    show(state[find(m->state_names, n, "hub")]);
    m->observe(0, state, inputs, coefficients, values);
    show(values[find(m->observable_names, m->observables, "tip")]);
    show(m->energy(0, state, inputs, coefficients));
    show(m->power(0, state, inputs, coefficients));
    m->mass_matrix(0, state, inputs, coefficients, mass);
    show(mass[0]);
    m->guards(0, state, inputs, coefficients, values);
    printf("%d %d %d\n", m->surfaces, m->degrees_of_freedom, m->parameters);
}

int main(void) {
    run(&beam_1_model);
    run(&long_beam_model);
    return 0;
}
"#;

#[test]
fn one_integrator_simulates_all_orders_in_both_languages() {
    let models = WRITTEN.path().join("models");
    let work = tempfile::tempdir().expect("a folder");
    let source = work.path().join("main.rs");
    let head = format!(
        "#![deny(warnings)]\n#[path = {:?}]\nmod models;\n",
        models.join("mod.rs")
    );
    std::fs::write(&source, head + IN_RUST).expect("written");
    let program = work.path().join("in_rust");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    run(Command::new(rustc)
        .args(["--edition", "2021", "-o"])
        .arg(&program)
        .arg(&source));
    let in_rust = run(&mut Command::new(&program));
    // Each variant has two switching surfaces (of the play), order + 2 degrees of freedom and six parameters.
    let ends: Vec<&str> = in_rust
        .lines()
        .map(|line| &line[line.len() - 5..])
        .collect();
    assert_eq!(ends, ["2 3 6", "2 5 6"]);
    if Command::new("cc").arg("--version").output().is_err() {
        return;
    }
    let source = work.path().join("main.c");
    std::fs::write(&source, IN_C).expect("written");
    let program = work.path().join("in_c");
    let options = [
        "-std=c99",
        "-O1",
        "-Wall",
        "-Wextra",
        "-Wconversion",
        "-Werror",
        "-I",
    ];
    let mut compile = Command::new("cc");
    compile.args(options).arg(&models).arg(&source);
    for file in [
        "models.c",
        "beam_1/beam_1.c",
        "beam_3/long_beam.c",
        "stiff_2/stiff_2.c",
    ] {
        compile.arg(models.join(file));
    }
    run(compile.arg("-o").arg(&program));
    assert_eq!(run(&mut Command::new(&program)), in_rust);
}
