//! Tests of pages with texts that would end or begin a script, very large and small numbers, extreme orders, and a
//! model without coordinates.

use std::path::{Path, PathBuf};

use eomgen_tests::models::path;
use serde_json::Value;

use super::browser::{WIDE_WINDOW, browser, run_probe};
use super::write_page;

fn pendulum(title: &str, doc: &str, mass: &str, folder: &Path) -> PathBuf {
    let text = format!(
        "[model]\nname = \"p\"\ntitle = '''{title}'''\n\
         [parameters]\nm = {{ value = {mass}, unit = \"kg\", doc = '''{doc}''' }}\n\
         l = {{ value = 0.3, unit = \"m\", doc = '''{doc}''' }}\n\
         g = {{ value = 9.81, unit = \"m/s^2\" }}\n\
         [coordinates]\ntheta = {{ unit = \"rad\", initial = 1, doc = '''{doc}''' }}\n\
         [kinetic]\nbob = \"1/2*m*(l*dot(theta))^2\"\n\
         [potential]\ngravity = \"-m*g*l*cos(theta)\"\n"
    );
    let spec = folder.join("p.toml");
    std::fs::write(&spec, text).expect("written");
    spec
}

/// Asserts that a page opens without an error; returns the observations.
fn assert_opens(page: &Path) -> Option<Value> {
    let seen = run_probe(browser()?, page, WIDE_WINDOW);
    assert_eq!(seen["errors"], serde_json::json!([]), "{seen}");
    assert_eq!(seen["excess"], 0, "{seen}");
    Some(seen)
}

#[test]
fn texts_cannot_inject_scripts() {
    let folder = tempfile::tempdir().expect("a folder");
    let hostile =
        "</script></title><!--<script>\"'><img src=x onerror=\"alert(1)\">&quot; \u{2028}";
    let spec = pendulum(hostile, hostile, "0.15", folder.path());
    let page = write_page(&spec, &[], folder.path());
    let text = std::fs::read_to_string(&page).expect("a page");
    assert_eq!(text.matches("<script").count(), 2);
    assert_eq!(text.matches("</script").count(), 2);
    for forbidden in ["<img", "<!--", "onerror=\"", "\"alert"] {
        assert!(!text.contains(forbidden), "{forbidden}");
    }
    if let Some(seen) = assert_opens(&page) {
        assert_eq!(
            seen["zero"], true,
            "no message about the pendulum without mass: {seen}"
        );
        let obstacle = seen["obstacle"].as_str().expect("a message");
        assert!(
            obstacle.starts_with("There is no motion from here on with m = 0 kg: "),
            "{obstacle}"
        );
    }
}

#[test]
fn page_with_extreme_numbers_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    for mass in ["1e300", "1e-300", "1e305"] {
        assert_opens(&write_page(
            &pendulum("a", "b", mass, folder.path()),
            &[],
            folder.path(),
        ));
    }
}

#[test]
fn page_with_extreme_orders_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    for order in ["0", "1", "64"] {
        assert_opens(&write_page(
            &path("hub_beam_tip_mass"),
            &["--order", order],
            folder.path(),
        ));
    }
}

#[test]
fn page_of_field_without_coordinates_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = folder.path().join("beam.toml");
    let text = "[model]\nname = \"beam\"\n\
        [parameters]\nmu = { value = 0.3, unit = \"kg/m\" }\nEI = { value = 2, unit = \"N m^2\" }\n\
        [fields.w]\nalong = \"s\"\nfrom = 0\nto = 1\nbasis = \"clamped_free\"\n\
        coordinates = \"q\"\norder = 2\nunit = \"m\"\n\
        [kinetic]\nbeam = \"1/2*integral(mu*dot(w)^2, w)\"\n\
        [potential]\nbending = \"1/2*integral(EI*diff(w, s, 2)^2, w)\"\n";
    std::fs::write(&spec, text).expect("written");
    for order in ["0", "2"] {
        assert_opens(&write_page(&spec, &["--order", order], folder.path()));
    }
}
