mod too_high {
    eomgen::model! { spec = "specifications/rotor.toml", order = 129 }
}

mod no_field {
    eomgen::model! { spec = "specifications/rotor.toml", order = 4 }
}

mod no_number {
    eomgen::model! { spec = "specifications/rotor.toml", order = "4" }
}

mod in_place {
    eomgen::model! {
        model { name: beam }
        parameters { mu: { value: 1, unit: kg/m }, l: { value: 1, unit: m } }
        fields { w: { along: x, from: 0, to: l, basis: clamped_free, coordinates: q, order: 500, unit: m } }
        kinetic { beam: 1/2*integral(mu*dot(w)^2, w) }
    }
}

fn main() {}
