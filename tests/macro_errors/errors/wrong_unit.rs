eomgen::model! {
    model { name: spring }
    parameters {
        m: { value: 1, unit: kg },
        k: { value: 1, unit: N/m },
    }
    coordinates { x: { unit: m } }
    kinetic { mass: 1/2*m*dot(x)^2 }
    potential { spring: 1/2*k*x }
    observables { stretch: { value: x, unit: N } }
}

fn main() {}
