//! Format of the JSON documents that the commands print and write.

/// Version of the format of JSON documents.
pub const SCHEMA: u32 = 2;
