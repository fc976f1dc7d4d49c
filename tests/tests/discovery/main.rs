//! What `compare` and `discover` are given, and what they find.

mod effects_files;
mod nothing_compared;
