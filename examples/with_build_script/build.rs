//! Emits the planetary arm with four modes.

fn main() -> Result<(), eomgen_build::Error> {
    eomgen_build::generate("../../model-spec/models/planetary_arm.toml", &[4])?;
    Ok(())
}
