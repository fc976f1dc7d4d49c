//! Documented limits of a specification. A model at a limit is accepted with a bounded number of graph nodes, and a
//! model beyond the limit is rejected.

use std::fmt::Write;

use eomgen_codegen::examination::examine;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::{MAX_SIZE, check};

use crate::support::{equations, model};

/// Returns a mass with this kinetic energy and further lines.
fn mass(kinetic: &str, further: &str) -> String {
    format!(
        "[model]\nname = \"limited\"\n[parameters]\nm = {{ value = 2, unit = \"kg\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\n[coordinates]\nx = {{ unit = \"m\" }}\n\
         [kinetic]\nmass = \"{kinetic}\"\n{further}"
    )
}

const KINETIC: &str = "1/2*m*dot(x)^2";

/// Returns a string with an integral of a function of the position.
fn string(integrand: &str) -> String {
    format!(
        "[model]\nname = \"string\"\n[parameters]\nmu = {{ value = 1, unit = \"kg/m\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\n[fields.w]\nalong = \"s\"\nfrom = 0\nto = \"l\"\nbasis = \"string\"\n\
         coordinates = \"q\"\norder = 2\nunit = \"m\"\n[kinetic]\nall = \"1/2*integral(mu*{integrand}*dot(w)^2, w)\"\n"
    )
}

/// Returns the number of graph nodes in the examination of a model.
fn count_nodes(text: &str) -> usize {
    let examined = examine(&model(text)).unwrap_or_else(|found| panic!("{}", found.message));
    examined.expect("no field").nodes
}

/// Returns the error of a text.
fn expect_rejection(text: &str) -> String {
    match check(Source::new("limited.toml", text)) {
        Ok(checked) => {
            let orders = checked.model.orders(None).expect("orders");
            let refused = Variant::derive(&checked.model, &orders).map(drop);
            refused.expect_err("beyond a limit").render(false)
        }
        Err(found) => found.render(false),
    }
}

/// Asserts that the text `at` a limit needs at most `allowed` nodes, and that the text `beyond` it is rejected with
/// the message `said`.
fn assert_limit(said: &str, at: &str, allowed: usize, beyond: &str) {
    let nodes = count_nodes(at);
    assert!(nodes <= allowed, "{said}: {nodes} nodes");
    let rejection = expect_rejection(beyond);
    assert!(rejection.contains(said), "{rejection}");
}

#[test]
fn names_have_64_characters() {
    let named = |length: usize| {
        let name = "x".repeat(length);
        mass(KINETIC, &format!("[definitions]\n{name} = \"2*x\"\n"))
    };
    assert_limit("at most 64 characters", &named(64), 20, &named(65));
}

#[test]
fn units_have_64_characters() {
    let declared = |length: usize| {
        let unit = format!("{:<length$}", "kg");
        mass(KINETIC, "").replace("unit = \"kg\"", &format!("unit = \"{unit}\""))
    };
    assert_limit(
        "a unit has at most 64 characters",
        &declared(64),
        20,
        &declared(65),
    );
}

#[test]
fn expressions_are_200_deep() {
    let summed = |parts: usize| {
        let value = vec!["x"; parts].join("+");
        mass(
            KINETIC,
            &format!("[observables]\no = {{ value = \"{value}\", unit = \"m\" }}\n"),
        )
    };
    assert_limit(
        "more than 200 nested levels",
        &summed(200),
        420,
        &summed(201),
    );
}

#[test]
fn definitions_written_out_are_600_deep() {
    // Each definition adds a product to the depth, and so does the observable.
    let chain = |count: usize| {
        let mut lines = String::from("[definitions]\nd1 = \"2*x\"\n");
        for index in 2..=count {
            writeln!(lines, "d{index} = \"-d{}\"", index - 1).expect("a string");
        }
        mass(KINETIC, &lines)
    };
    let last = (1..=601)
        .rev()
        .find(|count| check(Source::new("deep.toml", chain(*count))).is_ok());
    let last = last.expect("some depth is taken");
    assert!((295..=600).contains(&last), "{last}");
    assert_limit(
        "the expression has more than 600 nested levels",
        &chain(last),
        2 * last,
        &chain(last + 1),
    );
}

#[test]
fn derivatives_by_the_position_are_of_order_4() {
    let bent = |order: usize| {
        string("l^0").replace(
            "dot(w)^2",
            &format!("(dot(w)^2 + l^{}*0*diff(dot(w), s, {order})^2)", 2 * order),
        )
    };
    assert!(equations(&model(&bent(4)), 2).graph.len() < 400);
    let said = expect_rejection(&bent(5));
    assert!(
        said.contains("the order of a derivative along a field must be 1, 2, 3 or 4"),
        "{said}"
    );
}

#[test]
fn integrands_have_4096_terms() {
    let sum = |terms: usize| {
        let terms = (0..terms).map(|place| format!("(s/l)^{}", place + 1));
        format!("({})", terms.collect::<Vec<_>>().join(" + "))
    };
    let product = |one: usize, other: usize| string(&format!("{}*{}", sum(one), sum(other)));
    let at = equations(&model(&product(64, 64)), 2).graph.len();
    // A few nodes for each of the 127 powers.
    assert!(at < 2000, "{at} nodes");
    let said = expect_rejection(&product(65, 64));
    assert!(
        said.contains("more than 4096 terms when expanded"),
        "{said}"
    );
}

#[test]
fn orders_go_to_128() {
    let at = |order: usize| string("1").replace("order = 2", &format!("order = {order}"));
    assert!(equations(&model(&at(128)), 128).graph.len() < 100);
    let said = expect_rejection(&at(129));
    assert!(said.contains("the order 129 is above the limit"), "{said}");
}

#[test]
fn specifications_have_a_mebibyte() {
    let filled = |size: usize| {
        let text = mass(KINETIC, "");
        let rest = size - text.len();
        text + "#" + &"-".repeat(rest - 1)
    };
    let most = MAX_SIZE as usize;
    assert_limit(
        "reduce it to 1048576 bytes (1 MiB)",
        &filled(most),
        20,
        &filled(most + 1),
    );
}

#[test]
fn findings_beyond_20_are_counted() {
    let wrong = |count: usize| {
        let line = |place: usize| format!("o{place} = {{ value = \"x + m\", unit = \"m\" }}\n");
        mass(
            KINETIC,
            &("[observables]\n".to_owned() + &(0..count).map(line).collect::<String>()),
        )
    };
    let found = |count: usize| check(Source::new("wrong.toml", wrong(count))).expect_err("units");
    assert_eq!((found(20).list().len(), found(20).omitted_count()), (20, 0));
    assert_eq!((found(21).list().len(), found(21).omitted_count()), (20, 1));
}

#[test]
fn literals_are_finite_and_not_lost() {
    let weighed = |number: &str| mass(&format!("{number}*m*dot(x)^2"), "");
    assert_limit("is too large", &weighed("1e307"), 20, &weighed("1e309"));
    assert_limit(
        "it would be read as 0",
        &weighed("1e-300"),
        20,
        &weighed("1e-400"),
    );
}
