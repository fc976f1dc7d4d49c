#![deny(warnings)]

eomgen::model! {
    model { name: rotor }
    parameters { J: { value: 1, unit: kg m^2 }, K: { value: 1, unit: N m } }
    coordinates { theta: { unit: rad } }
    kinetic { rotor: 1/2*J*dot(theta)^2 }
}

fn main() {}
