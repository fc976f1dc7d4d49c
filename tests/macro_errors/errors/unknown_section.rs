eomgen::model! {
    model { name: rotor }
    parameter { J: { value: 1, unit: kg m^2 } }
    coordinates { theta: { unit: rad } }
    kinetic { rotor: 1/2*J*dot(theta)^2 }
}

fn main() {}
