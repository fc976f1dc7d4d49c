eomgen::model! {
    model { name: beam }
    parameters {
        mu: { value: 1, unit: kg/m },
        l: { value: 1, unit: m },
        k: { value: 1, unit: N/m },
    }
    fields { w: { along: x, from: 0, to: l, basis: clamped_free, coordinates: q, order: 2, unit: m } }
    kinetic { beam: 1/2*integral(mu*dot(w)^2, w) }
    potential { springs: sum(i, v, 1/2*k*q[i]^2) }
}

fn main() {}
