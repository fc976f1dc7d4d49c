eomgen::model! { spec = "specifications/rotr.toml" }

fn main() {}
