mod nothing {
    eomgen::model! {}
}

mod no_key {
    eomgen::model! { "specifications/rotor.toml" }
}

mod unknown_key {
    eomgen::model! { spec = "specifications/rotor.toml", orders = 4 }
}

mod file_and_sections {
    eomgen::model! { spec = "specifications/rotor.toml", inputs { u: { unit: N m } } }
}

fn main() {}
