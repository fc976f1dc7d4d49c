//! The helpers of a module by the names that expressions call them by.

use std::collections::HashMap;

use super::memory::nowhere;
use crate::statements::Emitted;

/// Numbers of functions by name.
#[derive(Debug)]
pub(super) struct Indices(HashMap<&'static str, u32>);

impl Indices {
    /// Those of the functions that come first in their module, in their order.
    pub(super) fn new(names: impl Iterator<Item = &'static str>) -> Self {
        Self(names.zip(0..).collect())
    }

    /// The number of a function.
    pub(super) fn of(&self, name: &str) -> Emitted<u32> {
        self.0.get(name).copied().ok_or_else(|| nowhere(name))
    }
}
