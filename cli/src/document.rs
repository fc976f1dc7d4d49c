//! JSON documents that the commands print and write.

/// Version of the documents.
pub const SCHEMA: u32 = 2;
