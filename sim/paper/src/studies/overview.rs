//! Picture of the arm for readers without the notation of the paper: the gear, the lag of the arm, and the play of a
//! mesh. Numbers of teeth and length of the arm are to scale (Table I); play and deflection are exaggerated.

use eomgen_plot::drawing::{LineStyle, Part, arc_points, point_on_circle};

use super::report::Figure;
use super::sketch::{circle, draw_figure, words};

/// Centre of the sun, px.
const CENTRE: (f64, f64) = (150.0, 190.0);
/// Half the module, px.
const HALF_MODULE: f64 = 1.2;
const TEETH_OF_SUN: f64 = 27.0;
const TEETH_OF_PLANET: f64 = 36.0;
const TEETH_OF_RING: f64 = 99.0;
const SUN: f64 = TEETH_OF_SUN * HALF_MODULE;
const PLANET: f64 = TEETH_OF_PLANET * HALF_MODULE;
const RING: f64 = TEETH_OF_RING * HALF_MODULE;
/// Angles of the planets, degrees.
const PLANETS: [f64; 3] = [90.0, 210.0, 330.0];
/// Length of the arm, px: 500 mm for a ring of 148.5 mm.
const LENGTH: f64 = RING * 500.0 / 148.5;
/// Angles of the carrier with and without play, degrees.
const CARRIER: f64 = 5.0;
const CARRIER_WITHOUT_PLAY: f64 = 18.0;
/// Deflection of the arm's end, px.
const DEFLECTION: f64 = 26.0;

pub(super) fn draw_overview() -> Figure {
    let caption = "A motor turns the sun of a planetary gear, whose three planets roll in a fixed ring and carry a flexible arm. \
                   The teeth of a mesh have play: they transmit no force until one flank touches the other. \
                   The arm lags behind a rigid arm without play and bends";
    let parts = [draw_gears(), draw_arm(), draw_teeth(), draw_force()];
    draw_figure("arm.svg", caption, (720.0, 400.0), parts.concat())
}

/// Returns the outline of a gear. `phase` is the angle of a tooth, degrees; `outward` is -1 for a ring.
fn gear(centre: (f64, f64), teeth: f64, phase: f64, outward: f64) -> Part {
    let pitch = 360.0 / teeth;
    let radius = teeth * HALF_MODULE;
    let (tip, root) = (
        radius + 1.7 * HALF_MODULE * outward,
        radius - 2.1 * HALF_MODULE * outward,
    );
    let corners = [(-0.36, root), (-0.14, tip), (0.14, tip), (0.36, root)];
    let points = (0..=teeth as usize).flat_map(|tooth| {
        let angle = phase + pitch * tooth as f64;
        corners.map(|(share, radius)| point_on_circle(centre, radius, angle + share * pitch))
    });
    Part::Line(
        LineStyle::Body,
        points.take(4 * teeth as usize + 1).collect(),
    )
}

/// Returns the angle of a tooth of a planet at this angle that is in a gap of the sun, whose first tooth is at 0
/// degrees.
fn planet_phase(angle: f64) -> f64 {
    // The gap of the sun that faces the planet is turned from the line of centres by this share of a pitch.
    let share = (angle * TEETH_OF_SUN / 360.0 + 0.5).rem_euclid(1.0);
    angle + 180.0 + share * 360.0 / TEETH_OF_PLANET
}

/// Returns the angle of a tooth of the ring that is in a gap of the first planet.
fn ring_phase() -> f64 {
    let pitch = 360.0 / TEETH_OF_PLANET;
    let share = ((planet_phase(PLANETS[0]) - PLANETS[0]) / pitch + 0.5).rem_euclid(1.0);
    PLANETS[0] + share * 360.0 / TEETH_OF_RING
}

fn draw_gears() -> Vec<Part> {
    let mut parts = vec![
        circle(CENTRE, RING + 12.0),
        gear(CENTRE, TEETH_OF_RING, ring_phase(), -1.0),
        gear(CENTRE, TEETH_OF_SUN, 0.0, 1.0),
    ];
    for angle in PLANETS {
        let centre = point_on_circle(CENTRE, SUN + PLANET, angle);
        parts.extend([
            gear(centre, TEETH_OF_PLANET, planet_phase(angle), 1.0),
            circle(centre, 4.0),
            Part::Line(LineStyle::Body, vec![CENTRE, centre]),
        ]);
    }
    parts.extend([
        Part::Arrow(
            LineStyle::Dimension,
            arc_points(CENTRE, 0.6 * SUN, (120.0, 400.0)),
        ),
        words((CENTRE.0, CENTRE.1 - RING - 24.0), 0, "fixed ring"),
        words(
            (CENTRE.0, CENTRE.1 + RING + 36.0),
            0,
            "A motor turns the sun;",
        ),
        words(
            (CENTRE.0, CENTRE.1 + RING + 56.0),
            0,
            "three planets carry the arm.",
        ),
    ]);
    parts
}

fn draw_arm() -> Vec<Part> {
    let bent = (0..=40).map(|step| {
        let s = f64::from(step) / 40.0;
        // Deflection by a load at the end, which is similar to the first mode shape.
        let deflection = DEFLECTION * s * s * (3.0 - s) / 2.0;
        let along = point_on_circle(CENTRE, LENGTH * s, CARRIER);
        point_on_circle(along, deflection, CARRIER - 90.0)
    });
    let rigid = point_on_circle(CENTRE, LENGTH, CARRIER_WITHOUT_PLAY);
    let end = point_on_circle(
        point_on_circle(CENTRE, LENGTH, CARRIER),
        DEFLECTION,
        CARRIER - 90.0,
    );
    let error = vec![(rigid.0 + 8.0, rigid.1), (end.0 + 8.0, end.1)];
    let middle = (rigid.1 + end.1) / 2.0;
    vec![
        Part::Line(LineStyle::Imaginary, vec![CENTRE, rigid]),
        Part::Line(LineStyle::Displaced, bent.collect()),
        Part::Arrow(LineStyle::Dimension, error),
        words((rigid.0, rigid.1 - 14.0), 1, "rigid arm without play"),
        words((end.0 + 26.0, middle), -1, "error of"),
        words((end.0 + 26.0, middle + 20.0), -1, "the position"),
        words((end.0 - 110.0, end.1 + 18.0), 0, "flexible arm"),
    ]
}

/// Draws a tooth in the gap of the other gear.
fn draw_teeth() -> Vec<Part> {
    let (x, y) = (390.0, 340.0);
    let (height, slope, play) = (56.0, 14.0, 34.0);
    let half = 22.0;
    // The tooth touches the left flank.
    let tooth = [
        (x - 100.0, y),
        (x - half - slope, y),
        (x - half + slope, y - height),
        (x + half - slope, y - height),
        (x + half + slope, y),
        (x + 100.0 + play, y),
    ];
    let top = y - height - 12.0;
    let gap = |side: f64, shift: f64| {
        let flank = |dx: f64| x + side * (half + dx) + shift;
        [
            (flank(60.0), y - 12.0),
            (flank(slope), y - 12.0),
            (flank(-slope), top),
        ]
    };
    let mut upper = gap(-1.0, -1.5).to_vec();
    upper.extend(gap(1.0, play).into_iter().rev());
    let level = y - 0.5 * height;
    let (from, to) = (x + half + 1.0, x + half + play - 1.0);
    vec![
        Part::Line(LineStyle::Displaced, tooth.to_vec()),
        Part::Line(LineStyle::Body, upper),
        Part::Arrow(
            LineStyle::Dimension,
            vec![((from + to) / 2.0, level), (to, level)],
        ),
        Part::Arrow(
            LineStyle::Dimension,
            vec![((from + to) / 2.0, level), (from, level)],
        ),
        words((x + half + 0.5 * play, y + 24.0), 0, "play 2b of a mesh"),
    ]
}

/// Draws the force of a mesh over its deflection.
fn draw_force() -> Vec<Part> {
    let (x, y) = (610.0, 310.0);
    let (half, b, rise) = (80.0, 30.0, 40.0);
    vec![
        Part::Arrow(LineStyle::Imaginary, vec![(x - half, y), (x + half, y)]),
        Part::Arrow(
            LineStyle::Imaginary,
            vec![(x, y + rise + 6.0), (x, y - rise - 16.0)],
        ),
        Part::Line(
            LineStyle::Displaced,
            vec![
                (x - half + 8.0, y + rise),
                (x - b, y),
                (x + b, y),
                (x + half - 8.0, y - rise),
            ],
        ),
        words((x - 8.0, y - rise - 6.0), 1, "force"),
        words((x + half + 12.0, y + 46.0), 1, "deflection"),
        words((x - b, y - 10.0), 0, "−b"),
        words((x + b, y + 22.0), 0, "b"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn teeth_of_every_mesh_face_gaps() {
        let assert_half = |pitches: f64| {
            let share = pitches.rem_euclid(1.0);
            assert!((share - 0.5).abs() < 1e-9, "{share}");
        };
        for angle in PLANETS {
            let phase = planet_phase(angle);
            // Positions of teeth in pitches; external gears turn in opposite directions.
            let sun = angle * TEETH_OF_SUN / 360.0;
            assert_half(sun + (angle + 180.0 - phase) * TEETH_OF_PLANET / 360.0);
            let ring = (angle - ring_phase()) * TEETH_OF_RING / 360.0;
            assert_half(ring - (angle - phase) * TEETH_OF_PLANET / 360.0);
        }
    }

    #[test]
    fn gears_have_lengths_of_table_one() {
        assert!((SUN + 2.0 * PLANET - RING).abs() < 1e-9);
    }
}
