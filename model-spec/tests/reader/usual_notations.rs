//! For a notation of another program, the message contains the notation of a specification.

use eomgen_model_spec::check;
use eomgen_model_spec::source::Source;

const PENDULUM: &str = r#"[model]
name = "pendulum"

[parameters]
m = { value = 1, unit = "kg" }
l = { value = 0.8, unit = "m" }
g = { value = 9.81, unit = "m/s^2" }

[coordinates]
theta = { unit = "rad", initial = 0.3 }

[kinetic]
bob = "m*l^2*dot(theta)^2/2"

[potential]
weight = "-m*g*l*cos(theta)"
"#;

#[test]
fn notations_of_other_programs_are_rejected_with_their_equivalent() {
    for (from, to, part) in [
        (
            "initial = 0.3",
            "initial = \"20 deg\"",
            "write 20*pi/180 for 20 deg",
        ),
        ("cos(theta)", "cos(30 deg)", "write 30*pi/180 for 30 deg"),
        ("cos(theta)", "cos(30 degrees)", "write 30*pi/180"),
        ("-m*g*l", "-m*g*5 mm", "write 0.005 for 5 mm"),
        (
            "initial = 0.3",
            "initial_value = 0.3",
            "did you mean `initial`?",
        ),
        ("[kinetic]", "[kinetic_energy]", "did you mean `kinetic`?"),
        ("m/s^2", "m/s**2", "write m/s^2"),
        ("\"kg\"", "\"kilogram\"", "write kg"),
        (
            "m = { value = 1, unit = \"kg\" }",
            "m = 20",
            "write m = { value = 20, unit = \"UNIT\" }",
        ),
        (
            "m = { value = 1, unit = \"kg\" }",
            "m = \"20 kg\"",
            "write m = { value = 20, unit = \"kg\" }",
        ),
        (
            "m = { value = 1, unit = \"kg\" }",
            "m = 20 kg",
            "write { value = 20, unit = \"kg\" }",
        ),
        (
            ", unit = \"m\" }",
            " }",
            "correct the unit; `l` has no unit",
        ),
        (
            "dot(theta)^2",
            "thetadot^2",
            "write dot(theta) for the rate",
        ),
        ("dot(theta)^2", "dtheta^2", "write dot(theta) for the rate"),
        (
            "dot(theta)^2",
            "diff(theta, t)^2",
            "write dot(theta) for the rate",
        ),
        ("dot(theta)^2", "thetaddot^2", "no accelerations"),
        ("dot(theta)^2", "ddot(theta)^2", "no accelerations"),
        ("dot(theta)^2", "time^2", "write `t` for the time"),
        ("dot(theta)^2", "dot(2*theta)^2", "this is an expression\n"),
        (
            "[kinetic]",
            "% comment\n[kinetic]",
            "a comment begins with #",
        ),
        (
            "[kinetic]",
            "// comment\n[kinetic]",
            "a comment begins with #",
        ),
        ("9.81", "9,81", "write 9.81"),
        ("theta = {", "\u{3b8} = {", "write theta"),
        ("dot(theta)", "dot(\u{3b8})", "write theta"),
        (
            "weight = \"-m*g*l*cos(theta)\"",
            "weight = -m*g*l*cos(theta)",
            "a text: \"-m*g*l*cos(theta)\"",
        ),
        (
            "value = 1, unit = \"kg\"",
            "value = 1 kg",
            "write value = 1, unit = \"kg\"",
        ),
    ] {
        let text = PENDULUM.replacen(from, to, 1);
        assert_ne!(text, PENDULUM, "{from}");
        let found = check(Source::new("pendulum.toml", text)).expect_err(to);
        let message = found.render(false);
        assert!(
            message.contains(part),
            "{to}: {part} is missing in\n{message}"
        );
    }
}
