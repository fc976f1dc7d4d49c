eomgen::model! { spec = "specifications/unclosed_bracket.toml" }

mod in_place {
    eomgen::model! {
        model { name: rotor }
        parameters { J: { value: 1, unit: kg m^2 } }
        coordinates { theta: { unit: rad } }
        kinetic { rotor: "1/2*J*(dot(theta)^2" }
    }
}

fn main() {}
