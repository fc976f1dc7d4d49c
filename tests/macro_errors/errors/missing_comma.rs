eomgen::model! {
    model { name: rotor }
    parameters {
        J: { value: 1, unit: kg m^2 }
        c: { value: 1, unit: N m s }
    }
    coordinates { theta: { unit: rad } }
    kinetic { rotor: 1/2*J*dot(theta)^2 }
}

fn main() {}
