//! Drawing of the machine with the positive direction of every angle, deflection and error. Radii and the length of the
//! arm are to scale (Table I); deflections are exaggerated.

use eomgen_plot::drawing::{LineStyle, Part, arc_points, point_on_circle};

use super::report::Figure;
use super::sketch::{circle, draw_figure, words};

/// Centre of the sun, px.
const CENTRE: (f64, f64) = (200.0, 236.0);
const SCALE: f64 = 0.86;
/// Half the module, mm; multiplied by the numbers of teeth of sun, planet and ring, it gives the pitch radii.
const HALF_MODULE: f64 = 1.5;
const SUN: f64 = 27.0 * HALF_MODULE * SCALE;
const PLANET: f64 = 36.0 * HALF_MODULE * SCALE;
const RING: f64 = 99.0 * HALF_MODULE * SCALE;
const LENGTH: f64 = 500.0 * SCALE;
/// Angles of the planets, degrees.
const PLANETS: [f64; 3] = [90.0, 210.0, 330.0];
/// Angles of the carrier with and without backlash, degrees.
const CARRIER: f64 = 12.0;
const CARRIER_WITHOUT_BACKLASH: f64 = 23.0;
/// Deflection of the tip, px.
const TIP: f64 = 40.0;
const PRESSURE: f64 = 24.6;

pub(super) fn draw_machine() -> Figure {
    let caption = "The arm on its planetary reducer, every quantity drawn in its positive direction: angles theta_s, \
                   theta_p and theta_c, motor torque T_M, mesh deflections x_sp and x_pr, forces F_sp and F_pr on a planet, the deflection w of the arm and that of its end, \
                   tip (dr in the paper), the lag dtheta of the carrier, and the two positioning errors f_la and f_la_signed";
    let parts = [
        draw_gears(),
        draw_meshes(),
        draw_forces(),
        draw_arm(),
        draw_errors(),
        draw_mesh_force(),
        draw_formulas(),
    ];
    draw_figure("machine.svg", caption, (980.0, 640.0), parts.concat())
}

/// Draws sun, planets, ring and carrier with their angles.
fn draw_gears() -> Vec<Part> {
    let mut parts = vec![
        circle(CENTRE, SUN),
        circle(CENTRE, RING),
        circle(CENTRE, RING + 10.0),
    ];
    for angle in PLANETS {
        let centre = point_on_circle(CENTRE, SUN + PLANET, angle);
        parts.extend([circle(centre, PLANET), circle(centre, 4.0)]);
        parts.push(Part::Line(LineStyle::Body, vec![CENTRE, centre]));
    }
    let planet = point_on_circle(CENTRE, SUN + PLANET, PLANETS[1]);
    parts.extend([
        Part::Arrow(
            LineStyle::Dimension,
            arc_points(CENTRE, 0.62 * SUN, (150.0, 400.0)),
        ),
        words((CENTRE.0 - 20.0, CENTRE.1 + SUN + 25.0), -1, "theta_s, T_M"),
        Part::Arrow(
            LineStyle::Dimension,
            arc_points(planet, 0.62 * PLANET, (240.0, -20.0)),
        ),
        words((planet.0 - 6.0, planet.1 + 20.0), 0, "theta_p"),
        words((CENTRE.0 - 40.0, CENTRE.1 - RING - 22.0), 0, "ring, fixed"),
        words(
            (CENTRE.0, CENTRE.1 + RING + 30.0),
            0,
            "sun inside, three planets on the carrier",
        ),
    ]);
    parts
}

/// Draws the lines of action at both meshes of the upper planet. An arrow marks the side that leads if the deflection
/// is positive.
fn draw_meshes() -> Vec<Part> {
    let (sun, ring) = (
        point_on_circle(CENTRE, SUN, 90.0),
        point_on_circle(CENTRE, RING, 90.0),
    );
    let along = |from: (f64, f64), angle: f64| {
        vec![
            point_on_circle(from, 6.0, angle + 180.0),
            point_on_circle(from, 42.0, angle),
        ]
    };
    vec![
        // The teeth of the sun move to the left at this mesh and push the planet.
        Part::Arrow(LineStyle::Dimension, along(sun, 180.0 - PRESSURE)),
        words((sun.0 - 48.0, sun.1 - 22.0), 1, "x_sp"),
        // The teeth of the planet move to the right at this mesh and push the ring, also outwards.
        Part::Arrow(LineStyle::Dimension, along(ring, PRESSURE)),
        words((ring.0 + 46.0, ring.1 - 14.0), -1, "x_pr"),
    ]
}

/// Draws the forces of both meshes on the right planet. The radial components push the planet out of the meshes.
fn draw_forces() -> Vec<Part> {
    let angle = PLANETS[2];
    let planet = point_on_circle(CENTRE, SUN + PLANET, angle);
    let contacts = [
        (angle + 180.0, angle + 90.0 - PRESSURE),
        (angle, angle + 90.0 + PRESSURE),
    ];
    let arrow = |(contact, direction): (f64, f64)| {
        let from = point_on_circle(planet, PLANET, contact);
        let line = vec![from, point_on_circle(from, 40.0, direction)];
        Part::Arrow(LineStyle::Dimension, line)
    };
    let mut parts: Vec<Part> = contacts.map(arrow).to_vec();
    parts.extend([
        words((planet.0 - 10.0, planet.1 - 20.0), -1, "F_sp"),
        words((planet.0 + 12.0, planet.1 + 26.0), -1, "F_pr"),
    ]);
    parts
}

/// Draws the arm at rest on its carrier, and the bent arm.
fn draw_arm() -> Vec<Part> {
    let bent = (0..=40).map(|step| {
        let s = f64::from(step) / 40.0;
        // Deflection by a load at the end, which is similar to the first mode shape.
        let w = TIP * s * s * (3.0 - s) / 2.0;
        let along = point_on_circle(CENTRE, LENGTH * s, CARRIER);
        point_on_circle(along, w, CARRIER + 90.0)
    });
    let end = point_on_circle(CENTRE, LENGTH, CARRIER);
    let middle = point_on_circle(CENTRE, 0.6 * LENGTH, CARRIER);
    let bow = TIP * 0.36 * 1.2;
    vec![
        Part::Line(
            LineStyle::Imaginary,
            vec![CENTRE, (CENTRE.0 + LENGTH + 20.0, CENTRE.1)],
        ),
        Part::Line(LineStyle::Imaginary, vec![CENTRE, end]),
        Part::Line(LineStyle::Displaced, bent.collect()),
        Part::Arrow(
            LineStyle::Dimension,
            arc_points(CENTRE, RING + 34.0, (0.0, CARRIER)),
        ),
        words((CENTRE.0 + RING + 40.0, CENTRE.1 - 10.0), -1, "theta_c"),
        Part::Arrow(
            LineStyle::Dimension,
            vec![middle, point_on_circle(middle, bow, CARRIER + 90.0)],
        ),
        words((middle.0 + 10.0, middle.1 + 16.0), -1, "w(x, t)"),
        words(
            point_on_circle((CENTRE.0, CENTRE.1 + 20.0), 0.9 * LENGTH, CARRIER),
            0,
            "x",
        ),
    ]
}

/// Draws lead and lag at the end of the arm.
fn draw_errors() -> Vec<Part> {
    let end = point_on_circle(CENTRE, LENGTH, CARRIER);
    let ideal = point_on_circle(CENTRE, LENGTH + 36.0, CARRIER_WITHOUT_BACKLASH);
    let outside = LENGTH + 20.0;
    vec![
        Part::Line(LineStyle::Imaginary, vec![CENTRE, ideal]),
        words(
            (ideal.0 + 6.0, ideal.1 - 6.0),
            -1,
            "theta_s/i_sH: the arm without backlash",
        ),
        Part::Arrow(
            LineStyle::Dimension,
            vec![end, point_on_circle(end, TIP, CARRIER + 90.0)],
        ),
        words((end.0 - 12.0, end.1 - 17.0), 1, "tip"),
        Part::Arrow(
            LineStyle::Dimension,
            arc_points(CENTRE, outside, (CARRIER, CARRIER_WITHOUT_BACKLASH)),
        ),
        words(
            (
                point_on_circle(CENTRE, outside + 10.0, 16.5).0,
                point_on_circle(CENTRE, outside, 16.5).1,
            ),
            -1,
            "l dtheta: the carrier lags",
        ),
        words((end.0 + 30.0, end.1 + 18.0), -1, "tip: the end leads"),
        Part::Arrow(
            LineStyle::Dimension,
            vec![
                point_on_circle(CENTRE, LENGTH, CARRIER_WITHOUT_BACKLASH),
                point_on_circle(
                    point_on_circle(CENTRE, LENGTH, CARRIER_WITHOUT_BACKLASH),
                    0.75 * TIP,
                    CARRIER_WITHOUT_BACKLASH + 90.0,
                ),
            ],
        ),
        words(
            point_on_circle(
                point_on_circle(CENTRE, LENGTH - 12.0, CARRIER_WITHOUT_BACKLASH),
                0.6 * TIP,
                CARRIER_WITHOUT_BACKLASH + 90.0,
            ),
            1,
            "f_la_signed",
        ),
    ]
}

/// Draws the force of a mesh over its deflection.
fn draw_mesh_force() -> Vec<Part> {
    let (x, y) = (200.0, 520.0);
    let (half, b, rise) = (130.0, 38.0, 56.0);
    vec![
        Part::Heading((24.0, 432.0), "a mesh".to_owned()),
        Part::Arrow(
            LineStyle::Imaginary,
            vec![(x - half, y), (x + half + 16.0, y)],
        ),
        Part::Arrow(
            LineStyle::Imaginary,
            vec![(x, y + rise + 8.0), (x, y - rise - 14.0)],
        ),
        Part::Line(
            LineStyle::Displaced,
            vec![
                (x - half, y + rise),
                (x - b, y),
                (x + b, y),
                (x + half, y - rise),
            ],
        ),
        words((x + b, y + 19.0), 0, "+b"),
        words((x - b, y - 9.0), 0, "−b"),
        words((x + half + 22.0, y + 5.0), -1, "x_sp, x_pr"),
        words((x + 9.0, y - rise - 6.0), -1, "k f_k"),
        words((x + half - 6.0, y - rise - 12.0), 0, "driving flanks"),
        words((x - half + 40.0, y + rise + 24.0), 0, "rear flanks"),
    ]
}

fn draw_formulas() -> Vec<Part> {
    let mut parts = vec![Part::Heading((470.0, 352.0), "signs".to_owned())];
    let lines = [
        "theta_s, theta_c and the motor torque T_M: with the sun; theta_p: absolute, against it",
        "x_s = r_s theta_s,  x_p = r_p theta_p,  x_c = r_c cos(alpha) theta_c",
        "x_sp = x_s − x_p − x_c: the sun is ahead of the planet",
        "x_pr = x_p − x_c: the planet is ahead of the ring",
        "F_sp, F_pr > 0 push planet and carrier on, and F_sp turns the sun back",
        "w: with theta_c;  tip = w(l, t), dr in the paper",
        "dtheta = theta_s/i_sH − theta_c: a lag of the carrier",
        "f_la = l dtheta + tip: the sum that Eq. (24) prints",
        "f_la_signed = tip − l dtheta: the error of the arm's end",
    ];
    for (index, line) in lines.iter().enumerate() {
        parts.push(words((470.0, 380.0 + 26.0 * index as f64), -1, line));
    }
    parts
}
