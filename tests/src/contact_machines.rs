//! Machines with sticking friction and with contacts, for tests of fixed steps.

/// Mass on a spring with Stribeck friction, driven by an input `F`.
pub const STRIBECK: &str = r#"
[model]
name = "machine"
[parameters]
m = { value = 1.3, unit = "kg" }
k = { value = 40, unit = "N/m" }
T_c = { value = 2, unit = "N" }
T_s = { value = 3, unit = "N" }
v_s = { value = 10, unit = "mm/s" }
[coordinates]
x = { unit = "m", initial = 0.3 }
[inputs]
F = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2"
[forces]
drive = { on = "x", value = "F" }
friction = { on = "x", value = "-(T_c + (T_s - T_c)*exp(-(dot(x)/v_s)^2))*sign(dot(x))" }
"#;

/// Two balls above each other that fall on a floor.
pub const BALLS: &str = r#"
[model]
name = "machine"
[parameters]
m = { value = 0.5, unit = "kg" }
M = { value = 1.5, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
e = { value = 0.6, unit = "1" }
[coordinates]
y = { unit = "m", initial = 0.4 }
z = { unit = "m", initial = 0.9 }
[kinetic]
balls = "1/2*M*dot(y)^2 + 1/2*m*dot(z)^2"
[potential]
weight = "(M*y + m*z)*g"
[impacts]
floor = { when = "y", restitution = "e" }
balls = { when = "z - y", restitution = "e" }
"#;

/// Cart with friction in its bearing that carries a block on a spring; the block slides on the cart with contact friction.
pub const BLOCK_ON_CART: &str = r#"
[model]
name = "machine"
[parameters]
m = { value = 0.7, unit = "kg" }
M = { value = 2, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
mu = { value = 0.3, unit = "1" }
k = { value = 90, unit = "N/m" }
T_c = { value = 1.5, unit = "N" }
[coordinates]
X = { unit = "m", initial = 0.2 }
x = { unit = "m", initial = 0.2, initial_rate = 0.9 }
y = { unit = "m", initial = 0.01 }
[inputs]
F = { unit = "N" }
[kinetic]
bodies = "1/2*M*dot(X)^2 + 1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
spring = "1/2*k*X^2"
[forces]
drive = { on = "X", value = "F" }
bearing = { on = "X", value = "-T_c*sign(dot(X))" }
[impacts]
bed = { when = "y", restitution = 0, friction = "mu", slip = "dot(x) - dot(X)" }
"#;

/// Pendulum in Cartesian coordinates with friction in its joint.
pub const PENDULUM: &str = r#"
[model]
name = "machine"
[parameters]
m = { value = 1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
l = { value = 0.5, unit = "m" }
T_c = { value = 0.4, unit = "N m" }
[coordinates]
x = { unit = "m", initial = 0.3 }
y = { unit = "m", initial = -0.4 }
[kinetic]
bob = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
weight = "m*g*y"
[definitions]
w = "(x*dot(y) - y*dot(x))/l^2"
[forces]
along_x = { on = "x", value = "T_c*y/l^2*sign(w)" }
along_y = { on = "y", value = "-T_c*x/l^2*sign(w)" }
[constraints]
rod = { zero = "x^2 + y^2 - l^2" }
"#;
