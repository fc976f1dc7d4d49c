//! Size of the derivation and of the emitted source: independent of the order, and bounded for large models.

use std::fmt::Write;

use crate::support::{accelerations, emitted, equations, evaluator, model, shipped};

/// Counts the statements, without tables and without the constants for indices.
fn statements(source: &str) -> usize {
    source
        .lines()
        .filter(|line| {
            let is_constant = line.trim_start().starts_with("pub const");
            line.trim_end().ends_with(';') && !line.starts_with("static") && !is_constant
        })
        .count()
}

#[test]
fn derivation_and_statements_do_not_grow_with_the_order() {
    for name in ["planetary_arm", "hub_beam_tip_mass"] {
        let model = shipped(name);
        assert_eq!(
            equations(&model, 4).graph.len(),
            equations(&model, 128).graph.len(),
            "{name}"
        );
        let (small, large) = (emitted(&model, 4), emitted(&model, 128));
        // With nine or more modes, sums call another function. If the number of modes is odd, the last number is
        // copied separately.
        let statements_of_ten = statements(&emitted(&model, 10));
        assert_eq!(statements_of_ten, statements(&large), "{name}");
        assert!(statements(&small).abs_diff(statements_of_ten) < 5, "{name}");
        // The additional text is about six tables with 124 more numbers of 20 characters each, and names, units,
        // initial values and ranges of 248 states with 60 characters each.
        assert!(
            large.len() < small.len() + 50_000,
            "{name}: {} and {}",
            small.len(),
            large.len()
        );
    }
}

// The mass matrix of a chain of masses is diagonal and must remain so.
#[test]
fn derivation_of_a_chain_grows_linearly() {
    let count = 60;
    let mut text = String::from(
        "[model]\nname = \"chain\"\ntitle = \"A chain\"\n[parameters]\n\
         m = { value = 2, unit = \"kg\" }\nk = { value = 3, unit = \"N/m\" }\n[coordinates]\n",
    );
    (0..count).for_each(|i| writeln!(text, "x_{i} = {{ unit = \"m\" }}").unwrap());
    text.push_str("[kinetic]\n");
    (0..count).for_each(|i| writeln!(text, "m_{i} = \"1/2*m*dot(x_{i})^2\"").unwrap());
    text.push_str("[potential]\n");
    (1..count).for_each(|i| writeln!(text, "k_{i} = \"1/2*k*(x_{i} - x_{})^2\"", i - 1).unwrap());
    let model = model(&text);
    let source = emitted(&model, 0);
    let nodes = equations(&model, 0).graph.len();
    assert!(nodes < 25 * count, "{nodes}");
    assert!(statements(&source) < 20 * count, "{}", statements(&source));
    let mut state = vec![0.0; 2 * count];
    state[30] = 1.0;
    let found = accelerations(&mut evaluator(&model, 0), &state);
    let expected = |i: usize| match i {
        29 | 31 => 1.5,
        30 => -3.0,
        _ => 0.0,
    };
    assert!(
        found.iter().enumerate().all(|(i, a)| *a == expected(i)),
        "{found:?}"
    );
}

// The mass matrix is full and depends on the state.
#[test]
fn pendulum_of_twelve_links_has_a_small_graph() {
    let count = 12;
    let mut text = String::from(
        "[model]\nname = \"links\"\ntitle = \"Links\"\n[parameters]\nm = { value = 0.3, unit = \"kg\" }\n\
         l = { value = 0.4, unit = \"m\" }\ng = { value = 9.81, unit = \"m/s^2\" }\n[coordinates]\n",
    );
    (0..count).for_each(|i| writeln!(text, "a_{i} = {{ unit = \"rad\" }}").unwrap());
    text.push_str("[definitions]\nx_0 = \"l*sin(a_0)\"\ny_0 = \"-l*cos(a_0)\"\n");
    for i in 1..count {
        writeln!(
            text,
            "x_{i} = \"x_{} + l*sin(a_{i})\"\ny_{i} = \"y_{} - l*cos(a_{i})\"",
            i - 1,
            i - 1
        )
        .unwrap();
    }
    text.push_str("[kinetic]\n");
    (0..count)
        .for_each(|i| writeln!(text, "b_{i} = \"1/2*m*(dot(x_{i})^2 + dot(y_{i})^2)\"").unwrap());
    text.push_str("[potential]\n");
    (0..count).for_each(|i| writeln!(text, "h_{i} = \"m*g*y_{i}\"").unwrap());
    let model = model(&text);
    let nodes = equations(&model, 0).graph.len();
    assert!(nodes < 10_000, "{nodes}");
    // At rest in the lowest position, the pendulum remains at rest.
    let still = accelerations(&mut evaluator(&model, 0), &vec![0.0; 2 * count]);
    assert!(still.iter().all(|a| a.abs() < 1e-12), "{still:?}");
}

// A product of 149 sums is not expanded.
#[test]
fn deep_products_stay_small() {
    let factors: Vec<String> = (1..150).map(|i| format!("(1 + x/{i}00)")).collect();
    let text = format!(
        "[model]\nname = \"deep\"\ntitle = \"Deep\"\n[parameters]\nm = {{ value = 1, unit = \"kg m^2\" }}\n\
         [coordinates]\nx = {{ unit = \"1\" }}\n[kinetic]\nall = \"1/2*m*dot(x)^2*{}\"\n",
        factors.join("*")
    );
    let model = model(&text);
    let nodes = equations(&model, 0).graph.len();
    assert!(nodes < 20_000, "{nodes}");
    let source = emitted(&model, 0);
    // Each number is written with a type conversion, which is not counted.
    let length = source.replace("T::number(", "(").len();
    assert!(length < 250_000, "{length}");
    let (x, rate) = (0.3, 0.7);
    // x'' = -1/2 (ln p)' x'^2
    let slope: f64 = (1..150).map(|i| 1.0 / (f64::from(i) * 100.0 + x)).sum();
    let found = accelerations(&mut evaluator(&model, 0), &[x, rate])[0];
    assert!(
        (found / (-0.5 * slope * rate * rate) - 1.0).abs() < 1e-12,
        "{found}"
    );
}

// High powers of the position are integrated by quadrature.
#[test]
fn nested_powers_of_the_position_stay_small() {
    let nested = (0..6).fold("x/l".to_owned(), |inner, _| format!("({inner})^8"));
    let text = format!(
        "[model]\nname = \"nested\"\ntitle = \"Nested\"\n[parameters]\nmu = {{ value = 1, unit = \"kg/m\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\n[fields.w]\nalong = \"x\"\nfrom = 0\nto = \"l\"\nbasis = \"clamped_free\"\n\
         coordinates = \"q\"\norder = 1\nunit = \"m\"\n[kinetic]\nall = \"1/2*integral(mu*(1 + {nested})*dot(w)^2, w)\"\n"
    );
    let nodes = equations(&model(&text), 2).graph.len();
    assert!(nodes < 150, "{nodes}");
}

/// Returns a chain of bodies on hinges about the three axes in turn.
fn hinged_bodies(count: usize) -> String {
    let mut text = String::from(
        "[model]\nname = \"hinged\"\ngravity = [0, 0, \"-g\"]\n[parameters]\n\
         m = { value = 1, unit = \"kg\" }\nl = { value = 1, unit = \"m\" }\n\
         J = { value = 1, unit = \"kg m^2\" }\ng = { value = 9.81, unit = \"m/s^2\" }\n[coordinates]\n",
    );
    (0..count).for_each(|k| writeln!(text, "q{k} = {{ unit = \"rad\" }}").unwrap());
    text.push_str("[frames]\nf0 = { rotation = \"rotation_x(q0)\" }\n");
    for k in 1..count {
        let axis = ['x', 'y', 'z'][k % 3];
        let place = format!("in = \"f{}\", origin = [0, 0, \"-l\"]", k - 1);
        writeln!(
            text,
            "f{k} = {{ rotation = \"rotation_{axis}(q{k})\", {place} }}"
        )
        .unwrap();
    }
    text.push_str("[bodies]\n");
    for k in 0..count {
        let body = format!("frame = \"f{k}\", mass = \"m\", inertia = [\"J\", \"J\", \"J\"]");
        writeln!(text, "f{k} = {{ {body} }}").unwrap();
    }
    text
}

// The mass matrix has the square of the number of bodies as entries, and its factors are emitted as a loop.
#[test]
fn derivation_of_hinged_bodies_grows_with_the_square() {
    let [single, double] = [18, 36].map(|count| {
        let equations = equations(&model(&hinged_bodies(count)), 0);
        equations.graph.len()
    });
    assert!(double <= 4 * single, "{single} to {double} nodes");
}
