//! Tests that results are independent of the units in the specification and in the records.

use std::fs;
use std::path::Path;

use eomgen_model_spec::unit::Unit;
use serde_json::Value;

use super::machines::{
    BEAM, CYLINDER, Channel, Machine, PENDULUM, STEP, Table, description, mass_on_spring,
    run_command, standard_deviation,
};

const ROUNDING: f64 = 1e-6;

/// Exponents of the powers of two that multiply length, mass and current.
type Units = [i32; 3];

/// Returns the factor that converts a number with this unit from SI to other units.
fn factor(unit: &str, [length, mass, current]: Units) -> f64 {
    let unit = Unit::parse(unit).expect("a unit");
    let exponents = unit
        .dimension
        .exponents()
        .map(|exponent| exponent.to_integer());
    let [kg, m, _, a, ..] = exponents;
    2f64.powi(kg * mass + m * length + a * current)
}

fn in_units(specification: &str, units: Units) -> String {
    let line = |line: &str| {
        let parts = line.split_once("{ value = ").and_then(|(name, rest)| {
            let (value, rest) = rest.split_once(", unit = \"")?;
            let (unit, _) = rest.split_once('"')?;
            let value: f64 = value.trim().parse().ok()?;
            Some(format!(
                "{name}{{ value = {:e}, unit = \"{unit}\" }}\n",
                value * factor(unit, units)
            ))
        });
        parts.unwrap_or_else(|| format!("{line}\n"))
    };
    specification.lines().map(line).collect()
}

/// Returns numbers of a result that do not depend on units: gaps relative to the noise floor, and parameters of effects
/// converted to the original units.
fn numbers(answer: &Value, units: Units) -> Vec<(String, f64)> {
    let number = |value: &Value| value.as_f64().expect("a number");
    let mut found = Vec::new();
    for (channel, gap) in answer["gap"].as_object().expect("gaps") {
        for stage in ["before", "after"] {
            let of = match gap.get(stage) {
                Some(stage) => stage,
                None => gap,
            };
            for part in ["train", "test"] {
                let left = number(&of[part]) / number(&gap["floor"]);
                found.push((format!("gap {channel} {stage} {part}"), left));
            }
        }
    }
    for effect in answer["effects"].as_array().into_iter().flatten() {
        for (name, parameter) in effect["parameters"].as_object().expect("parameters") {
            let unit = parameter["unit"].as_str().expect("a unit");
            for of in ["value", "sd"] {
                let value = number(&parameter[of]) / factor(unit, units);
                found.push((format!("{} {name} {of}", effect["effect"]), value));
            }
        }
    }
    found
}

/// Returns the relative difference of two numbers. Differences of gaps are relative to the noise floor, because
/// rounding dominates smaller gaps.
fn difference(name: &str, other: f64, own: f64) -> f64 {
    let size = if name.starts_with("gap ") {
        own.abs().max(1.0)
    } else {
        own.abs()
    };
    (other - own).abs() / size
}

/// Asserts that both commands give the same results in all units. `truth` is the specification that
/// generates the records.
fn assert_same_results(truth: &str, machine: &Machine, channel: &Channel, others: &[Units]) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let made = Machine {
        specification: truth.to_owned(),
        ..machine.clone()
    };
    let noise = 2e-3 * standard_deviation(&made.write_records(folder).column(channel.1));
    for command in ["compare", "discover"] {
        let answer = |units: Units| {
            let folder = tempfile::tempdir_in(folder).expect("a folder");
            write_in_units(folder.path(), machine, channel, units);
            let noise = noise * factor(channel.2, units);
            let description = description(machine, channel, noise);
            let answer = run_command(folder.path(), command, &description);
            (answer["verdict"].clone(), numbers(&answer, units))
        };
        let own = answer([0; 3]);
        for units in others {
            let (verdict, numbers) = answer(*units);
            assert_eq!(verdict, own.0, "{command} {channel:?} {units:?}");
            assert_eq!(
                numbers.len(),
                own.1.len(),
                "{command} {channel:?} {units:?}"
            );
            for ((name, other), (_, own)) in numbers.iter().zip(&own.1) {
                let difference = difference(name, *other, *own);
                assert!(
                    difference < ROUNDING,
                    "{command} {channel:?} {units:?}: {name}: {other}, expected {own}"
                );
            }
        }
    }
}

/// Writes a machine and the records of the parent folder in other units.
fn write_in_units(folder: &Path, machine: &Machine, channel: &Channel, units: Units) {
    let specification = in_units(&machine.specification, units);
    fs::write(folder.join("model.toml"), specification).expect("a file");
    let above = folder.parent().expect("a parent folder");
    for name in ["train.csv", "test.csv"] {
        let table = Table::read(&above.join(name));
        let columns = [("t", "s"), ("u", machine.input.0), (channel.1, channel.2)];
        let mut own = Table::default();
        for (column, unit) in columns {
            let factor = factor(unit, units);
            let values = table.column(column).into_iter().map(|value| factor * value);
            own.add(column, values.collect());
        }
        own.write(&folder.join(name));
    }
}

/// Asserts that trajectories by a solver agree in all units. `columns` are columns of `simulate`
/// with their units.
fn assert_same_trajectories(machine: &Machine, solver: &str, columns: &[(&str, &str)]) {
    let motion = |units: Units| {
        let folder = tempfile::tempdir().expect("a folder");
        let (unit, size) = machine.input;
        let own = Machine {
            specification: in_units(&machine.specification, units),
            input: (unit, size * factor(unit, units)),
            channels: Vec::new(),
        };
        fs::write(folder.path().join("model.toml"), &own.specification).expect("a file");
        own.simulate_with_solver(solver, folder.path(), "train", 0.0, STEP)
    };
    let own = motion([0; 3]);
    for units in [[-17, -20, 0], [17, 20, 0], [-20, 20, 10], [40, 40, -30]] {
        let other = motion(units);
        for (column, unit) in columns {
            let own = own.column(column);
            let largest = own
                .iter()
                .fold(0.0_f64, |most, value| most.max(value.abs()));
            for (other, own) in other.column(column).iter().zip(&own) {
                let difference = (other / factor(unit, units) - own).abs() / largest;
                assert!(
                    difference < 1e-9,
                    "{solver} {units:?} {column}: {other} and {own}"
                );
            }
        }
    }
}

#[test]
fn trajectories_are_independent_of_units() {
    let positions = [("x", "m"), ("x_dot", "m/s"), ("energy", "J")];
    let cylinder = Machine::new(CYLINDER, ("V", 1.0), &[]);
    let friction = "u - F*sign(dot(x)) - k_3*x^3";
    let stick = mass_on_spring("1/2*k*x^2", "k*x", friction, "");
    let linear = mass_on_spring("1/2*k*deadzone(x, b)^2", "k*deadzone(x, b)", "u", "");
    for solver in ["rk", "radau"] {
        assert_same_trajectories(
            &cylinder,
            solver,
            &[&positions[..2], &[("p", "Pa")]].concat(),
        );
        assert_same_trajectories(&stick, solver, &positions);
    }
    assert_same_trajectories(&linear, "adams", &positions);
    assert_same_trajectories(&linear, "exact", &positions);
}

/// Very small and very large units, and opposite scales of length and mass.
const OTHERS: [Units; 3] = [[-17, -20, 0], [17, 20, 0], [-20, 20, 10]];

#[test]
fn results_for_nonlinear_model_with_pressure_are_independent_of_units() {
    let channels = [("x", "x", "m"), ("x_ddot", "a", "m/s^2")];
    let machine = Machine::new(CYLINDER, ("V", 1.0), &channels);
    let truth = CYLINDER.replace("value = 500", "value = 510");
    for channel in &channels {
        assert_same_results(&truth, &machine, channel, &OTHERS);
    }
}

#[test]
fn results_for_model_with_field_are_independent_of_units() {
    let channels = [("x", "x", "rad"), ("o", "o", "m")];
    let machine = Machine::new(BEAM, ("N m", 0.5), &channels);
    for channel in &channels {
        assert_same_results(BEAM, &machine, channel, &OTHERS);
    }
}

#[test]
fn missing_dry_friction_is_found_in_all_units() {
    let machine = mass_on_spring("1/2*k*x^2", "k*x", "u", "");
    let truth = mass_on_spring("1/2*k*x^2", "k*x", "u - F*sign(dot(x))", "").specification;
    assert_same_results(&truth, &machine, &("x", "x", "m"), &OTHERS);
}

#[test]
fn missing_spring_is_found_in_all_units() {
    let machine = Machine::new(PENDULUM, ("N m", 1.5), &[]);
    let truth = PENDULUM.replace("u - c*dot(x)", "u - c*dot(x) - m*g*l*x/10");
    assert_same_results(&truth, &machine, &("x", "x", "rad"), &OTHERS);
}

/// The pressure is in Pa, kPa, MPa or GPa.
#[test]
fn results_are_independent_of_the_unit_of_a_state() {
    let in_unit = |unit: f64| {
        (CYLINDER.replace(
            "[coordinates]",
            &format!("P = {{ value = {unit:e}, unit = \"Pa\" }}\n[coordinates]"),
        ))
        .replace(
            "p = { unit = \"Pa\", rate = \"E_V",
            "z = { unit = \"1\", rate = \"1/P*E_V",
        )
        .replace("p/p_s", "z*P/p_s")
        .replace("A*p", "A*P*z")
    };
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let channel = ("x", "x", "m");
    let machine = Machine::new(CYLINDER, ("V", 1.0), &[channel]);
    let truth = Machine {
        specification: CYLINDER.replace("value = 500", "value = 510"),
        ..machine.clone()
    };
    let noise = 2e-3 * standard_deviation(&truth.write_records(folder).column("x"));
    let description = description(&machine, &channel, noise);
    let answer = |unit: f64| {
        fs::write(folder.join("model.toml"), in_unit(unit)).expect("a file");
        let answer = run_command(folder, "compare", &description);
        (answer["verdict"].clone(), numbers(&answer, [0; 3]))
    };
    let (verdict, own) = answer(1.0);
    for unit in [1e3, 1e6, 1e9] {
        let (other, numbers) = answer(unit);
        assert_eq!(other, verdict, "{unit:e}");
        for ((name, other), (_, own)) in numbers.iter().zip(&own) {
            let difference = difference(name, *other, *own);
            assert!(
                difference < ROUNDING,
                "{unit:e}: {name}: {other}, expected {own}"
            );
        }
    }
}
