//! Selects features of shared dependencies; see `Cargo.toml`. Contains no code.
