mod of_a_file {
    eomgen::model! { spec = "specifications/rotor.toml", with = [jacobians, jacobian] }
}

mod in_place {
    eomgen::model! {
        with = [energy],
        model { name: rotor }
        parameters { J: { value: 1, unit: kg m^2 } }
        coordinates { theta: { unit: rad } }
        kinetic { rotor: 1/2*J*dot(theta)^2 }
    }
}

mod no_list {
    eomgen::model! { spec = "specifications/rotor.toml", with = jacobians }
}

fn main() {}
