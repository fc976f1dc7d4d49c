//! Small models with textbook equations for the tests of the validation.

use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;

pub(super) fn parse_model(text: &str) -> Model {
    match eomgen_model_spec::check(Source::new("test.toml", text)) {
        Ok(checked) => checked.model,
        Err(diagnostics) => panic!("{}", diagnostics.render(false)),
    }
}

pub(super) const SPRING: &str = r#"
[model]
name = "spring"
title = "Mass on a spring with play"

[parameters]
m = { value = 2.0, unit = "kg", doc = "mass" }
k = { value = 300.0, unit = "N/m", doc = "stiffness" }
b = { value = 0.01, unit = "m", doc = "half the play" }
c = { value = 5.0, unit = "N s/m", doc = "damping in contact" }

[coordinates]
y = { unit = "m", doc = "displacement" }

[inputs]
u = { unit = "N", doc = "pull" }

[kinetic]
mass = "1/2*m*dot(y)^2"

[potential]
spring = "1/2*k*deadzone(y, b)^2"

[forces]
damping = { on = "y", value = "-c*contact(y, b)*dot(y)" }
pull = { on = "y", value = "u" }
"#;

pub(super) const PRELOAD: &str = r#"
[model]
name = "preload"
title = "Mass between preloaded springs"

[parameters]
m = { value = 2.0, unit = "kg", doc = "mass" }
k = { value = 300.0, unit = "N/m", doc = "stiffness" }
F = { value = 7.0, unit = "N", doc = "preload" }
b = { value = 0.01, unit = "m", doc = "half the play" }

[coordinates]
y = { unit = "m", doc = "displacement" }

[kinetic]
mass = "1/2*m*dot(y)^2"

[forces]
springs = { on = "y", value = "-F*sign(deadzone(y, b)) - k*deadzone(y, b)" }
"#;

pub(super) const DOUBLE_PENDULUM: &str = r#"
[model]
name = "double_pendulum"
title = "Double pendulum"

[parameters]
m_1 = { value = 1.3, unit = "kg", doc = "upper mass" }
m_2 = { value = 0.7, unit = "kg", doc = "lower mass" }
l_1 = { value = 0.9, unit = "m", doc = "upper rod" }
l_2 = { value = 0.6, unit = "m", doc = "lower rod" }
g = { value = 9.81, unit = "m/s^2", doc = "gravity" }
c = { value = 0.2, unit = "N m s", doc = "damping between the rods" }

[coordinates]
theta_1 = { unit = "rad", doc = "upper angle" }
theta_2 = { unit = "rad", doc = "lower angle" }

[definitions]
x_1 = "l_1*sin(theta_1)"
y_1 = "-l_1*cos(theta_1)"
x_2 = "x_1 + l_2*sin(theta_2)"
y_2 = "y_1 - l_2*cos(theta_2)"

[kinetic]
upper = "1/2*m_1*(dot(x_1)^2 + dot(y_1)^2)"
lower = "1/2*m_2*(dot(x_2)^2 + dot(y_2)^2)"

[potential]
gravity = "m_1*g*y_1 + m_2*g*y_2"

[dissipation]
joint = "1/2*c*(dot(theta_2) - dot(theta_1))^2"
"#;

pub(super) const BEAM: &str = r#"
[model]
name = "beam"
title = "Beam on a hub with a tip mass"

[parameters]
J = { value = 0.4, unit = "kg m^2", doc = "hub" }
rho = { value = 2700.0, unit = "kg/m^3", doc = "density" }
A = { value = 2e-4, unit = "m^2", doc = "section" }
E = { value = 7e10, unit = "Pa", doc = "elasticity" }
I = { value = 1.5e-9, unit = "m^4", doc = "second moment" }
l = { value = 1.25, unit = "m", doc = "length" }
m_t = { value = 0.3, unit = "kg", doc = "tip mass" }
d = { value = 0.02, unit = "N m s", doc = "bearing" }

[coordinates]
theta = { unit = "rad", doc = "hub angle" }

[inputs]
u = { unit = "N m", doc = "torque" }

[fields.w]
along = "x"
from = "0"
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 3
unit = "m"

[definitions]
tip = "at(w, l)"

[kinetic]
hub = "1/2*J*dot(theta)^2"
beam = "1/2*integral(rho*A*(x*dot(theta) + dot(w))^2, w)"
mass = "1/2*m_t*(l*dot(theta) + dot(tip))^2"

[potential]
bending = "1/2*integral(E*I*diff(w, x, 2)^2, w)"

[forces]
bearing = { on = "theta", value = "-d*dot(theta)" }
torque = { on = "theta", value = "u" }
"#;

/// Free rotor whose kinetic energy is written in Cartesian coordinates of a point: all terms of the single row cancel.
pub(super) const ROTOR: &str = r#"
[model]
name = "rotor"

[parameters]
m = { value = 2.0, unit = "kg" }
l = { value = 0.5, unit = "m" }

[coordinates]
theta = { unit = "rad", initial_rate = 1 }

[definitions]
x = "l*sin(theta)"
y = "-l*cos(theta)"

[kinetic]
point = "1/2*m*(dot(x)^2 + dot(y)^2)"
"#;

/// Mass on a spring; the mass changes with time.
pub(super) const TANK: &str = r#"
[model]
name = "tank"

[parameters]
m = { value = 2.0, unit = "kg" }
k = { value = 30, unit = "N/m" }
tau = { value = 1, unit = "s" }

[coordinates]
x = { unit = "m" }

[kinetic]
tank = "1/2*m*dot(x)^2*(2 + sin(t/tau))"

[potential]
spring = "1/2*k*x^2"
"#;

/// Mass in a logarithmic potential, which is defined for positive arguments only.
pub(super) const LOGARITHM: &str = r#"
[model]
name = "logarithm"

[parameters]
m = { value = 2.0, unit = "kg" }
e = { value = 3, unit = "J" }
L = { value = 1, unit = "m" }

[coordinates]
x = { unit = "m", initial = 0.5 }

[kinetic]
mass = "1/2*m*dot(x)^2"

[potential]
well = "-e*ln(x/L) + e*x/L"
"#;

/// Mass on a spring with a force linear in the rate that acts only far from most sampled states.
pub(super) const FAR_TERM_TEXT: &str = r#"
[model]
name = "far"

[parameters]
m = { value = 2.0, unit = "kg" }
k = { value = 30, unit = "N/m" }
h = { value = 4, unit = "kg/s" }
L = { value = 3, unit = "m" }

[coordinates]
x = { unit = "m" }

[kinetic]
mass = "1/2*m*dot(x)^2"
far = "h*dot(x)*max(x - L, 0)"

[potential]
spring = "1/2*k*x^2"
"#;
