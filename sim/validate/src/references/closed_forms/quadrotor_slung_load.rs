//! Quadrotor with a load on a rope: Newton's equations of two points with the rope force, and Euler's equations in the
//! body frame (Sreenath, Lee and Kumar, *Proc. 52nd IEEE Conf. Decision and Control*, 2013, with air drag on the load).
//! With d = s - r, v = d' and a stabilisation rate w, the constraint g = d.d - l^2 follows g'' + 2 w g' + w^2 g = 0.

use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::{Evaluation, Row};

type Vector = [f64; 3];

fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let (position, rate) = at.motion::<9>()?;
    let mut rows = translation(at, &position, &rate)?;
    let load = rows.split_off(3);
    rows.extend(rotation(at, &position, &rate)?);
    rows.extend(load);
    let rows: [Row; 9] = rows.try_into().map_err(|_| NotApplicable::State(18))?;
    Ok(Evaluation::from_rows(rows))
}

/// Returns the direction of the thrust: the third body axis.
fn thrust_direction(position: &[f64; 9]) -> Vector {
    let [(sy, cy), (sp, cp), (sr, cr)] = [position[3], position[4], position[5]].map(f64::sin_cos);
    [cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr]
}

/// Computes the accelerations of the quadrotor, then of the load.
fn translation(
    at: &StateAndParameters<'_>,
    position: &[f64; 9],
    rate: &[f64; 9],
) -> Result<Vec<Row>, NotApplicable> {
    let (g, m, load) = (at.required("g")?, at.required("m")?, at.required("m_l")?);
    let (l, air) = (at.required("l")?, at.optional("c"));
    let w = at.required("stabilisation_rate")?;
    let thrust = thrust_direction(position).map(|axis| axis * at.input("T") / m);
    let d = [0, 1, 2].map(|i| position[6 + i] - position[i]);
    let v = [0, 1, 2].map(|i| rate[6 + i] - rate[i]);
    let drag = [0, 1, 2].map(|i| -air * rate[6 + i] / load);
    let residual = dot(&d, &d) - l * l;
    // 2 d.(drag - thrust) + 2 v.v + 4 lambda d.d (1/m + 1/m_l) = -2 w (2 d.v) - w^2 g
    let stiffness = 2.0 * dot(&d, &d) * (1.0 / m + 1.0 / load);
    let parts = [
        -dot(&v, &v),
        dot(&d, &thrust),
        -dot(&d, &drag),
        -2.0 * w * dot(&d, &v),
        -w * w * residual / 2.0,
    ];
    let mut rows = Vec::with_capacity(6);
    for (mass, sign, others) in [(m, -2.0, thrust), (load, 2.0, drag)] {
        for axis in 0..3 {
            let mut row = Row::new();
            for part in parts {
                row.add(sign * d[axis] * part / (stiffness * mass));
            }
            row.add(others[axis]);
            if axis == 2 {
                row.add(-g);
            }
            rows.push(row);
        }
    }
    Ok(rows)
}

/// Computes the second derivatives of yaw, pitch and roll.
fn rotation(
    at: &StateAndParameters<'_>,
    position: &[f64; 9],
    rate: &[f64; 9],
) -> Result<Vec<Row>, NotApplicable> {
    let inertia = [
        at.required("J_x")?,
        at.required("J_y")?,
        at.required("J_z")?,
    ];
    let torque = ["M_x", "M_y", "M_z"].map(|name| at.input(name));
    let [(sp, cp), (sr, cr)] = [position[4], position[5]].map(f64::sin_cos);
    let [yaw, pitch, roll] = [rate[3], rate[4], rate[5]];
    let omega = [
        roll - yaw * sp,
        pitch * cr + yaw * cp * sr,
        yaw * cp * cr - pitch * sr,
    ];
    // Euler's equations in the body frame: torques, then gyroscopic terms.
    let rates = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let gyroscopic = (inertia[j] - inertia[k]) * omega[j] * omega[k];
        [torque[i] / inertia[i], gyroscopic / inertia[i]]
    });
    let across = omega[1] * sr + omega[2] * cr;
    let rows = [
        (
            0.0,
            sr / cp,
            cr / cp,
            vec![roll * pitch / cp, across * sp * pitch / (cp * cp)],
        ),
        (0.0, cr, -sr, vec![-roll * across]),
        (
            1.0,
            sr * sp / cp,
            cr * sp / cp,
            vec![roll * pitch * sp / cp, across * pitch / (cp * cp)],
        ),
    ];
    let row = |(x, y, z, rest): (f64, f64, f64, Vec<f64>)| {
        let mut row = Row::new();
        for (factor, parts) in [x, y, z].into_iter().zip(rates) {
            parts.iter().for_each(|part| row.add(factor * part));
        }
        rest.into_iter().for_each(|part| row.add(part));
        row
    };
    Ok(rows.into_iter().map(row).collect())
}
