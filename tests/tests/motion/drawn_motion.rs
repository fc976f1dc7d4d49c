//! Tests of the figure of `simulate --plot`: panels have the names of their quantities, and no curve looks constant
//! because another curve in the panel is much larger.

use eomgen_tests::models::path;
use eomgen_tests::program::run_accepted;

/// Returns the titles of the panels, which are printed in bold.
fn titles(svg: &str) -> Vec<String> {
    let bold = svg.split(" font-weight=\"600\"").skip(1);
    let elements = bold.filter_map(|rest| rest.split("</text>").next());
    let plain = |element: &str| -> String {
        let pieces = element.split('<');
        pieces.filter_map(|piece| piece.split('>').nth(1)).collect()
    };
    elements.map(plain).collect()
}

#[test]
fn panels_are_named_by_their_quantities() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let (table, figure) = (place("arm.csv"), place("arm.svg"));
    let spec = path("planetary_arm").display().to_string();
    let arguments = ["simulate", &spec, "--until", "0.2", "--interval", "0.001"];
    run_accepted(&[&arguments[..], &["--out", &table, "--plot", &figure]].concat());
    let svg = std::fs::read_to_string(figure).expect("a figure");
    let titles = titles(&svg);
    // The angle of the carrier has the magnitude of radians, its error of microradians.
    let panel_of = |name: &str| {
        titles
            .iter()
            .position(|title| title.contains(name))
            .expect(name)
    };
    assert_ne!(panel_of("θc"), panel_of("Error of the angle"), "{titles:?}");
    for (place, title) in titles.iter().enumerate() {
        assert!(!titles[..place].contains(title), "{title} twice");
    }
}
