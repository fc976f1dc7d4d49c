//! Measures over time (`max`, `rms`, `final`) against the closed form of the response and the rows
//! of `simulate`.

use std::f64::consts::SQRT_2;

use eomgen_tests::models::path;
use eomgen_tests::program::run_accepted;

use super::place::{SweepFolder, accept, column, refuse, table};

/// Returns the amplitude of the forced response, m.
fn amplitude(damping: f64, omega: f64) -> f64 {
    let (m, k, force) = (1.0, 4.0, 3.0);
    force / (k - m * omega * omega).hypot(damping * omega)
}

#[test]
fn forced_response_has_closed_form_amplitude() {
    let place = SweepFolder::new();
    let wide = ["--vary", "c=400:4000:4:log", "--vary", "omega=1:3:3"];
    let long = ["--transient", "60", "--periods", "3"];
    let measures = ["--measure", "max:x,rms:x,max:x_dot"];
    accept(&place.sweep("map", &[&wide[..], &long, &measures].concat()));
    let table = table(&place.path_to("map"));
    let (c, omega) = (column(&table, "c"), column(&table, "omega"));
    assert!(
        (c[3] / c[0] - 10.0_f64.powf(1.0 / 3.0)).abs() < 1e-14,
        "{c:?}"
    );
    assert_eq!(c.len(), 12);
    for point in 0..12 {
        let expected = amplitude(1e-3 * c[point], omega[point]);
        let near = |name: &str, right: f64, within: f64| {
            let found = column(&table, name)[point];
            assert!(
                (found / right - 1.0).abs() < within,
                "{name}: {found}, expected {right}"
            );
        };
        // The maximum can fall between samples 1/667 of a period apart: (2 pi/667)^2/8.
        near("max:x", expected, 2e-5);
        near("max:x_dot", expected * omega[point], 2e-5);
        near("rms:x", expected / SQRT_2, 1e-8);
        assert_eq!(column(&table, "max:x_status")[point], 0.0);
    }
    for name in ["max_x", "rms_x", "max_x_dot"] {
        assert!(
            place
                .path_to("map")
                .join(format!("map_{name}.png"))
                .exists(),
            "{name}"
        );
    }
}

#[test]
fn measures_over_time_match_rows_of_simulate() {
    let place = SweepFolder::new();
    let arm = path("planetary_arm").display().to_string();
    let (out, rows) = (place.path_to("arm"), place.path_to("arm.csv"));
    let [out, rows] = [out, rows].map(|path| path.display().to_string());
    run_accepted(&[
        "sweep",
        &arm,
        "--order",
        "2",
        "--vary",
        "b_sp=10e-6:50e-6:3",
        "--until",
        "0.3",
        "--measure",
        "max:tip,rms:tip,final:x_sp_dot",
        "--out",
        &out,
    ]);
    run_accepted(&[
        "simulate",
        &arm,
        "--order",
        "2",
        "--set",
        "b_sp=30e-6",
        "--until",
        "0.3",
        "--out",
        &rows,
    ]);
    let text = std::fs::read_to_string(rows).expect("rows");
    let mut lines = text.lines().map(|line| line.split(','));
    let names: Vec<&str> = lines.next().expect("a header").collect();
    let numbers: Vec<Vec<f64>> = lines
        .map(|line| {
            line.map(|number| number.parse().expect("a number"))
                .collect()
        })
        .collect();
    let course = |name: &str| {
        let place = names
            .iter()
            .position(|known| *known == name)
            .expect("a column");
        numbers.iter().map(move |row| row[place])
    };
    let table = table(&place.path_to("arm"));
    let found = |name: &str| column(&table, name)[1];
    let near = |name: &str, right: f64| {
        let found = found(name);
        // The parameter differs in its last bit, and meshes open and close.
        assert!(
            (found / right - 1.0).abs() < 1e-9,
            "{name}: {found}, expected {right}"
        );
        assert!(right.abs() > 1e-6, "{name}: nothing moves");
    };
    near("max:tip", course("tip").fold(f64::MIN, f64::max));
    near(
        "final:x_sp_dot",
        course("x_sp_dot").next_back().expect("rows"),
    );
    let squares: Vec<f64> = course("tip").map(|x| x * x).collect();
    let ends = 0.5 * (squares[0] + squares[1000]);
    let rms = ((squares.iter().sum::<f64>() - ends) / 1000.0).sqrt();
    near("rms:tip", rms);
}

#[test]
fn invalid_measures_are_rejected() {
    let place = SweepFolder::new();
    for (more, what) in [
        (
            &["--measure", "max:y"][..],
            "no observable, coordinate or rate `y`",
        ),
        (&["--measure", "max:enrgy"], "`energy`"),
        (&["--measure", "mean:x"], "max:NAME"),
        (&["--measure", "max:x", "--until", "-1"], "--until"),
        (&["--measure", "max:x", "--until", "nan"], "--until"),
        (
            &["--measure", "max:x", "--frequency", "w"],
            "--frequency NAME",
        ),
        (&["--measure", "max:x,max:x", "--until", "1"], "`max:x`"),
    ] {
        let message = refuse(&place.sweep("map", &[&["--vary", "k=1:2:2"][..], more].concat()));
        assert!(message.contains(what), "{more:?}: {message}");
    }
    for range in ["0:1:3:log", "-1:1:3:log", "1:2:3:lin", "1:2:3:4:5"] {
        let vary = format!("k={range}");
        let message = refuse(&place.sweep("map", &["--vary", &vary, "--measure", "max:x"]));
        assert!(message.contains("FROM:TO:COUNT:log"), "{message}");
    }
}
