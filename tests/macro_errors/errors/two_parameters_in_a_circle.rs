eomgen::model! {
    model { name: rotor }
    parameters { J: { value: K, unit: kg m^2 }, K: { value: 2*J, unit: kg m^2 } }
    coordinates { theta: { unit: rad } }
    kinetic { rotor: 1/2*J*dot(theta)^2 }
}

fn main() {}
