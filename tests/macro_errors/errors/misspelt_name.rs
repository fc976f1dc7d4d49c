eomgen::model! {
    model { name: pendulum }
    parameters {
        m: { value: 1, unit: kg },
        l: { value: 1, unit: m },
        g: { value: 9.81, unit: m/s^2 },
    }
    coordinates { theta: { unit: rad } }
    kinetic { bob: 1/2*m*(l*dot(theta))^2 }
    potential { gravity: -m*g*l*cos(thta) }
}

fn main() {}
