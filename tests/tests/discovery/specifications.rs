//! Specifications that several tests use.

pub const OSCILLATOR: &str = r#"
[model]
name = "oscillator"

[parameters]
m = { value = 1, unit = "kg", min = 0 }
k = { value = 400, unit = "N/m", min = 0 }
c = { value = 4, unit = "N s/m", min = 0 }

[coordinates]
x = { unit = "m" }

[inputs]
u = { unit = "N" }

[kinetic]
mass = "1/2*m*dot(x)^2"

[potential]
spring = "1/2*k*x^2"

[dissipation]
damper = "1/2*c*dot(x)^2"

[forces]
drive = { on = "x", value = "u" }
"#;
