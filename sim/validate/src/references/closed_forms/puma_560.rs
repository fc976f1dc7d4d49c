//! PUMA 560 by the recursion of Newton and Euler (Luh, Walker and Paul, "On-line computational scheme for mechanical
//! manipulators", 1980): accelerations outward, forces and moments inward, numerically, in the frames of the links.
//! Each column of the mass matrix contains the torques for a unit acceleration of one joint at rest without gravity
//! (Walker and Orin, 1982, method 1). Moments of inertia: Armstrong, Khatib and Burdick (1986).

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

type Vector = [f64; 3];

/// Link. The joint at `origin` turns the link by q about the z axis of the previous link. If `tilt` is 1 or -1, the
/// link's axes are also turned about x by a quarter turn in this direction.
struct Link {
    origin: Vector,
    tilt: f64,
    mass: f64,
    centre: Vector,
    inertia: Vector,
}

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let links = links(at)?;
    let g = at.required("g")?;
    let (q, rates) = at.motion::<6>()?;
    let still = [0.0; 6];
    let mut system = LinearSystem::new(6);
    for column in 0..6 {
        let mut unit = still;
        unit[column] = 1.0;
        let torques = torques(&links, &q, &still, &unit, 0.0);
        for (row, torque) in torques.into_iter().enumerate().skip(column) {
            system.mass(column, row, torque);
        }
    }
    let weight = torques(&links, &q, &still, &still, g);
    let velocity = torques(&links, &q, &rates, &still, 0.0);
    for (row, input) in ["u_1", "u_2", "u_3", "u_4", "u_5", "u_6"]
        .iter()
        .enumerate()
    {
        system.force(row, at.input(input));
        system.force(row, -weight[row]);
        system.force(row, -velocity[row]);
    }
    system.solve()
}

fn links(at: &StateAndParameters<'_>) -> Result<[Link; 6], NotApplicable> {
    let p = |name: &'static str| at.required(name);
    let (a_3, d_3, d_4) = (p("a_3")?, p("d_3")?, p("d_4")?);
    let unit = p("I")?;
    let link = |origin, tilt, mass, centre, [x, y, z]: Vector| Link {
        origin,
        tilt,
        mass,
        centre,
        inertia: [x * unit, y * unit, z * unit],
    };
    let o = [0.0; 3];
    let upper = [p("a_2")? + p("r_2x")?, p("r_2y")?, p("r_2z")?];
    let fore = [0.0, p("r_3y")? - d_3, p("r_3z")?];
    let wrist = [0.0, d_4 + p("r_4y")?, 0.0];
    let hand = [0.0, 0.0, p("r_6z")?];
    let shoulder = [p("a_2")?, 0.0, 0.0];
    Ok([
        link(o, 1.0, 0.0, o, [0.35, 0.35, 0.35]),
        link(o, 0.0, p("m_2")?, upper, [0.13, 0.524, 0.539]),
        link(shoulder, -1.0, p("m_3")?, fore, [0.066, 0.086, 0.0125]),
        link(
            [a_3, -d_3, 0.0],
            1.0,
            p("m_4")?,
            wrist,
            [1.8e-3, 1.3e-3, 1.8e-3],
        ),
        link([0.0, d_4, 0.0], -1.0, p("m_5")?, o, [3e-4, 4e-4, 3e-4]),
        link(o, 0.0, p("m_6")?, hand, [1.5e-4, 1.5e-4, 4e-5]),
    ])
}

fn torques(
    links: &[Link; 6],
    q: &[f64; 6],
    rates: &[f64; 6],
    accelerations: &[f64; 6],
    g: f64,
) -> [f64; 6] {
    // Gravity is an upward acceleration g of the base.
    let (mut omega, mut alpha, mut a) = ([0.0; 3], [0.0; 3], [0.0, 0.0, g]);
    let mut loads = [([0.0; 3], [0.0; 3]); 6];
    for (i, link) in links.iter().enumerate() {
        let spin = [0.0, 0.0, rates[i]];
        let turn = plus(cross(omega, spin), [0.0, 0.0, accelerations[i]]);
        let carried = relative_acceleration(omega, alpha, link.origin);
        a = to_link(link, q[i], plus(a, carried));
        alpha = to_link(link, q[i], plus(alpha, turn));
        omega = to_link(link, q[i], plus(omega, spin));
        let force =
            plus(a, relative_acceleration(omega, alpha, link.centre)).map(|a| link.mass * a);
        let [x, y, z] = link.inertia;
        let times = |v: Vector| [x * v[0], y * v[1], z * v[2]];
        let moment = plus(times(alpha), cross(omega, times(omega)));
        loads[i] = (force, plus(moment, cross(link.centre, force)));
    }
    let mut found = [0.0; 6];
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for (i, link) in links.iter().enumerate().rev() {
        let (own_force, own_moment) = loads[i];
        force = to_previous_link(link, q[i], plus(force, own_force));
        moment = to_previous_link(link, q[i], plus(moment, own_moment));
        found[i] = moment[2];
        moment = plus(moment, cross(link.origin, force));
    }
    found
}

/// Computes the acceleration of a point at `arm` relative to the origin.
fn relative_acceleration(omega: Vector, alpha: Vector, arm: Vector) -> Vector {
    plus(cross(alpha, arm), cross(omega, cross(omega, arm)))
}

/// Converts components of the previous link to components of this link.
fn to_link(link: &Link, q: f64, [x, y, z]: Vector) -> Vector {
    let (sin, cos) = q.sin_cos();
    let (x, y) = (cos * x + sin * y, cos * y - sin * x);
    if link.tilt == 0.0 {
        [x, y, z]
    } else {
        [x, link.tilt * z, -link.tilt * y]
    }
}

/// Converts components of this link to components of the previous link.
fn to_previous_link(link: &Link, q: f64, [x, y, z]: Vector) -> Vector {
    let (y, z) = if link.tilt == 0.0 {
        (y, z)
    } else {
        (-link.tilt * z, link.tilt * y)
    };
    let (sin, cos) = q.sin_cos();
    [cos * x - sin * y, sin * x + cos * y, z]
}

fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
