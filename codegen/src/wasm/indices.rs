//! Indices of the helpers of a module.

use std::collections::HashMap;

use super::memory::missing_address_error;
use crate::statements::EmitResult;

#[derive(Debug)]
pub(super) struct Indices(HashMap<&'static str, u32>);

impl Indices {
    /// Numbers the functions at the beginning of their module, in order.
    pub(super) fn new(names: impl Iterator<Item = &'static str>) -> Self {
        Self(names.zip(0..).collect())
    }

    pub(super) fn index(&self, name: &str) -> EmitResult<u32> {
        self.0
            .get(name)
            .copied()
            .ok_or_else(|| missing_address_error(name))
    }
}
