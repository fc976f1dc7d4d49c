//! Tests of `trim` from states at which the Jacobian is singular: inside plays, with quadratic drag at rest, and for
//! steady motion at a given speed.

use super::{run_json, write_model};

/// Returns the values of the equilibrium by name.
fn trim(text: &str, options: &[&str], names: &[&str]) -> Vec<f64> {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), text);
    let found = run_json(&[&["trim", &model, "--json"], options].concat());
    let value = |name: &&str| found["at"][*name].as_f64().expect("a number");
    names.iter().map(value).collect()
}

fn assert_close(found: &[f64], right: &[f64], place: &str) {
    let size = right
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    for (one, other) in found.iter().zip(right) {
        assert!(
            (one - other).abs() <= 1e-8 * size,
            "{place}: {found:?} {right:?}"
        );
    }
}

/// Returns masses that hang from the ceiling and from each other; each spring has play. Masses in `heavy` have weight.
fn hanging(count: usize, heavy: &[usize], springs: &str) -> String {
    let names: Vec<String> = (1..=count).map(|place| format!("x_{place}")).collect();
    let coordinates = names
        .iter()
        .map(|name| format!("{name} = {{ unit = \"m\" }}\n"));
    let rates = names.iter().map(|name| format!("dot({name})^2"));
    let rates: Vec<String> = rates.collect();
    let heavy: Vec<String> = heavy.iter().map(|place| format!("x_{place}")).collect();
    format!(
        "[model]\nname = \"hanging\"\n[parameters]\nm = {{ value = 2, unit = \"kg\" }}\n\
         k = {{ value = 300, unit = \"N/m\" }}\nb = {{ value = 50, unit = \"mm\" }}\n\
         g = {{ value = 9.81, unit = \"m/s^2\" }}\n[coordinates]\n{}[kinetic]\nT = \"1/2*m*({})\"\n\
         [potential]\nweight = \"m*g*({})\"\n{springs}",
        coordinates.collect::<String>(),
        rates.join(" + "),
        heavy.join(" + "),
    )
}

#[test]
fn plays_in_series_close_under_weight() {
    let (weight, stiffness) = (2.0 * 9.81, 300.0);
    for (count, heavy) in [
        (1, &[1][..]),
        (2, &[1, 2]),
        (2, &[2]),
        (3, &[1, 2, 3]),
        (3, &[3]),
        (3, &[1, 3]),
        (4, &[1, 2, 3, 4]),
        (4, &[4]),
    ] {
        let springs: String = (1..=count)
            .map(|place| {
                let stretch = match place {
                    1 => "x_1".to_owned(),
                    place => format!("x_{place} - x_{}", place - 1),
                };
                format!("spring_{place} = \"1/2*k*deadzone({stretch}, b)^2\"\n")
            })
            .collect();
        let model = hanging(count, heavy, &springs);
        let names: Vec<String> = (1..=count).map(|place| format!("x_{place}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        for (options, play) in [
            (&[][..], 0.05),
            (&["--set", "b=1e-3"], 1e-6),
            (&["--set", "b=2e3"], 2.0),
        ] {
            // The spring above mass i carries the weights of mass i and of all masses below it.
            let stretch = |above: usize| {
                let below = heavy.iter().filter(|place| **place > above).count();
                play + below as f64 * weight / stiffness
            };
            let right = (1..=count).map(|masses| -(0..masses).map(stretch).sum::<f64>());
            let right: Vec<f64> = right.collect();
            let found = trim(&model, options, &names);
            assert_close(&found, &right, &format!("{count}, {heavy:?}, {options:?}"));
        }
    }
}

#[test]
fn plays_in_parallel_close_one_after_the_other() {
    // For a displacement d outside both plays: 300 (d - 0.05) + 300 (d - 0.1) = 2 g.
    let springs = "near = \"1/2*k*deadzone(x_1, b)^2\"\nfar = \"1/2*k*deadzone(x_1, 2*b)^2\"\n";
    let found = trim(&hanging(1, &[1], springs), &["--set", "g=30"], &["x_1"]);
    assert_close(&found, &[-(60.0 / 300.0 + 0.15) / 2.0], "both");
    let found = trim(&hanging(1, &[1], springs), &["--set", "g=1"], &["x_1"]);
    assert_close(&found, &[-(2.0 / 300.0 + 0.05)], "the near one");
}

/// Returns a body that falls through air, with a coordinate for each of `directions`.
fn falling(directions: &[&str], drag: &str, unit: &str) -> String {
    let coordinates = directions
        .iter()
        .map(|name| format!("{name} = {{ unit = \"m\" }}\n"));
    let zero = "0*z";
    let part = |name: &'static str| {
        if directions.contains(&name) {
            name
        } else {
            zero
        }
    };
    format!(
        "[model]\nname = \"falling\"\n[parameters]\nm = {{ value = 2, unit = \"kg\" }}\n\
         c = {{ value = 0.2, unit = \"{unit}\" }}\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n\
         [coordinates]\n{}[definitions]\nr = \"[{}, {}, z]\"\nv = \"dot(r)\"\n\
         [kinetic]\nT = \"1/2*m*dot(v, v)\"\n[potential]\nweight = \"m*g*z\"\n\
         [forces]\ndrag = {{ on = \"r\", value = \"{drag}\" }}\n",
        coordinates.collect::<String>(),
        part("x"),
        part("y"),
    )
}

#[test]
fn falling_body_reaches_its_terminal_velocity() {
    let quadratic = -f64::sqrt(2.0 * 9.81 / 0.2);
    for directions in [&["z"][..], &["x", "z"], &["x", "y", "z"]] {
        for start in [&[][..], &["--state", "z_dot=-1"], &["--state", "z_dot=-30"]] {
            let model = falling(directions, "-c*norm(v)*v", "kg/m");
            let found = trim(&model, start, &["z_dot"]);
            assert_close(&found, &[quadratic], &format!("{directions:?}, {start:?}"));
        }
        let model = falling(directions, "-c*v", "kg/s");
        assert_close(
            &trim(&model, &[], &["z_dot"]),
            &[-2.0 * 9.81 / 0.2],
            "linear drag",
        );
        let model = falling(directions, "-c*norm(v)^2*v", "kg s/m^2");
        assert_close(
            &trim(&model, &[], &["z_dot"]),
            &[-f64::cbrt(2.0 * 9.81 / 0.2)],
            "cubic drag",
        );
    }
}

/// Centrifugal governor: two arms with bobs on a rotating shaft. The speed of the shaft is free.
const GOVERNOR: &str = r#"
[model]
name = "governor"
[parameters]
J = { value = 2, unit = "kg m^2" }
m = { value = 0.5, unit = "kg" }
l = { value = 0.4, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
phi = { unit = "rad" }
theta = { unit = "rad", initial = 0.5 }
[kinetic]
all = "1/2*J*dot(phi)^2 + m*l^2*(dot(theta)^2 + sin(theta)^2*dot(phi)^2)"
[potential]
weight = "-2*m*g*l*cos(theta)"
"#;

#[test]
fn arms_of_a_governor_follow_its_speed() {
    for speed in [6.5_f64, 8.0, 20.0] {
        let right = (9.81 / (0.4 * speed * speed)).acos();
        for angle in ["1", "1.2", "1.5"] {
            for option in ["--state", "--fix"] {
                let rate = format!("phi_dot={speed}");
                let start = format!("theta={angle}");
                let found = trim(
                    GOVERNOR,
                    &[option, &rate, "--state", &start],
                    &["theta", "phi_dot"],
                );
                assert_close(&found, &[right, speed], &format!("{option} {rate} {start}"));
            }
        }
    }
}
