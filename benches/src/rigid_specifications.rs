//! Generated specifications of rigid trees: planar arms (with Cartesian definitions, and with energies simplified by
//! hand), chains of pendulums, and the first joints of the shipped PUMA 560.

use std::fmt::Write;

use eomgen_model_spec::models::PUMA_560;

/// Returns a planar arm with a torque at every joint; energies are written in Cartesian positions.
pub fn planar_arm(links: usize) -> String {
    let mut text = head(&format!("planar_{links}r"), links);
    text += "[definitions]\n";
    for i in 1..=links {
        let angle: Vec<String> = (1..=i).map(|k| format!("q_{k}")).collect();
        _ = writeln!(text, "a_{i} = \"{}\"", angle.join(" + "));
        for (axis, function) in [("x", "cos"), ("y", "sin")] {
            let before: String = (1..i)
                .map(|k| format!("l_{k}*{function}(a_{k}) + "))
                .collect();
            _ = writeln!(text, "{axis}_{i} = \"{before}l_{i}/2*{function}(a_{i})\"");
        }
    }
    text += "[kinetic]\n";
    for i in 1..=links {
        _ = writeln!(
            text,
            "link_{i} = \"1/2*m_{i}*(dot(x_{i})^2 + dot(y_{i})^2) + 1/2*I_{i}*dot(a_{i})^2\""
        );
    }
    text += "[potential]\n";
    for i in 1..=links {
        _ = writeln!(text, "link_{i} = \"m_{i}*g*y_{i}\"");
    }
    text + &torques(links)
}

/// Returns the planar arm with energies simplified by hand, in the angles between links.
pub fn planar_arm_by_hand(links: usize) -> String {
    let mut text = head(&format!("planar_{links}r_by_hand"), links);
    text += "[definitions]\n";
    for i in 1..=links {
        let angle: Vec<String> = (1..=i).map(|k| format!("q_{k}")).collect();
        _ = writeln!(text, "a_{i} = \"{}\"", angle.join(" + "));
    }
    let beyond = |i: usize| -> String { (i + 1..=links).map(|k| format!(" + m_{k}")).collect() };
    text += "[kinetic]\n";
    for i in 1..=links {
        let rest = beyond(i);
        _ = writeln!(
            text,
            "link_{i} = \"1/2*(I_{i} + (m_{i}/4{rest})*l_{i}^2)*dot(a_{i})^2\""
        );
        for j in i + 1..=links {
            let between: Vec<String> = (i + 1..=j).map(|k| format!("q_{k}")).collect();
            let (rest, angle) = (beyond(j), between.join(" + "));
            _ = writeln!(
                text,
                "links_{i}_{j} = \"(m_{j}/2{rest})*l_{i}*l_{j}*cos({angle})*dot(a_{i})*dot(a_{j})\""
            );
        }
    }
    text += "[potential]\n";
    for i in 1..=links {
        let rest = beyond(i);
        _ = writeln!(text, "link_{i} = \"(m_{i}/2{rest})*g*l_{i}*sin(a_{i})\"");
    }
    text + &torques(links)
}

/// Returns parameters, coordinates and inputs of a planar arm.
fn head(name: &str, links: usize) -> String {
    let mut text = format!(
        "[model]\nname = \"{name}\"\n[parameters]\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n"
    );
    for i in 1..=links {
        let (mass, length) = (4 - i, 0.6 - 0.1 * i as f64);
        _ = writeln!(text, "m_{i} = {{ value = {mass}, unit = \"kg\" }}");
        _ = writeln!(text, "l_{i} = {{ value = {length:.1}, unit = \"m\" }}");
        _ = writeln!(
            text,
            "I_{i} = {{ value = \"m_{i}*l_{i}^2/12\", unit = \"kg m^2\" }}"
        );
    }
    text += "[coordinates]\n";
    for i in 1..=links {
        _ = writeln!(text, "q_{i} = {{ unit = \"rad\", initial = 0.{i} }}");
    }
    text += "[inputs]\n";
    for i in 1..=links {
        _ = writeln!(text, "u_{i} = {{ unit = \"N m\" }}");
    }
    text
}

fn torques(links: usize) -> String {
    let joints =
        (1..=links).map(|i| format!("joint_{i} = {{ on = \"q_{i}\", value = \"u_{i}\" }}\n"));
    String::from("[forces]\n") + &joints.collect::<String>()
}

/// Returns a spherical pendulum with energies in Cartesian positions.
pub fn spherical_pendulum() -> String {
    SPHERICAL_HEAD.to_owned()
        + "[definitions]\nx = \"l*sin(theta)*cos(phi)\"\ny = \"l*sin(theta)*sin(phi)\"\nz = \"-l*cos(theta)\"\n\
           [kinetic]\nbob = \"1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)\"\n[potential]\nbob = \"m*g*z\"\n"
}

/// Returns the spherical pendulum with energies simplified by hand.
pub fn spherical_pendulum_by_hand() -> String {
    SPHERICAL_HEAD.to_owned()
        + "[kinetic]\nbob = \"1/2*m*l^2*(dot(theta)^2 + sin(theta)^2*dot(phi)^2)\"\n\
           [potential]\nbob = \"-m*g*l*cos(theta)\"\n"
}

const SPHERICAL_HEAD: &str = "[model]\nname = \"spherical_pendulum\"\n[parameters]\n\
    m = { value = 0.5, unit = \"kg\" }\nl = { value = 0.8, unit = \"m\" }\ng = { value = 9.81, unit = \"m/s^2\" }\n\
    [coordinates]\ntheta = { unit = \"rad\", initial = 1.0 }\nphi = { unit = \"rad\", initial_rate = 2.0 }\n";

/// Returns a chain of pendulums; each position is relative to the previous bob.
pub fn chain(bobs: usize) -> String {
    let mut text = format!(
        "[model]\nname = \"chain_{bobs}\"\n[parameters]\nm = {{ value = 0.2, unit = \"kg\" }}\n\
         l = {{ value = 0.15, unit = \"m\" }}\ng = {{ value = 9.81, unit = \"m/s^2\" }}\n[coordinates]\n"
    );
    for i in 1..=bobs {
        _ = writeln!(
            text,
            "q_{i} = {{ unit = \"rad\", initial = {} }}",
            0.05 * i as f64
        );
    }
    text += "[definitions]\nx_1 = \"l*sin(q_1)\"\ny_1 = \"-l*cos(q_1)\"\n";
    for i in 2..=bobs {
        let before = i - 1;
        _ = writeln!(text, "x_{i} = \"x_{before} + l*sin(q_{i})\"");
        _ = writeln!(text, "y_{i} = \"y_{before} - l*cos(q_{i})\"");
    }
    text += "[kinetic]\n";
    for i in 1..=bobs {
        _ = writeln!(text, "bob_{i} = \"1/2*m*(dot(x_{i})^2 + dot(y_{i})^2)\"");
    }
    text += "[potential]\n";
    for i in 1..=bobs {
        _ = writeln!(text, "bob_{i} = \"m*g*y_{i}\"");
    }
    text
}

/// Returns the first joints of the shipped PUMA 560.
pub fn puma(joints: usize) -> String {
    let beyond = |line: &&str| {
        let entry = ["q_", "u_", "link_", "joint_"]
            .iter()
            .find_map(|name| line.strip_prefix(name));
        let number = entry.and_then(|rest| rest.split(' ').next()?.parse::<usize>().ok());
        number.is_none_or(|number| number <= joints)
    };
    let lines: Vec<&str> = PUMA_560.text.lines().filter(beyond).collect();
    lines
        .join("\n")
        .replace("\"puma_560\"", &format!("\"puma_{joints}\""))
        + "\n"
}
