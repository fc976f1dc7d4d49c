//! Upper bounds of the executed instructions and of the stack use of functions compiled for a Cortex-M4F or
//! Cortex-M7, computed from the disassembly.
//!
//! `listing` reads the output of objdump, `operand` and `instruction` decode it. `step` (with `compute` and `jump`)
//! executes an instruction on a `state` of partly known `value`s. `explore` follows both sides of each branch with an
//! unknown condition and finds the longest path in the `graph` of states. A loop is bounded if its counter is known.
//! `library` lists the loops of libgcc that the number format bounds.

mod compute;
mod explore;
mod graph;
mod instruction;
mod jump;
mod library;
mod listing;
mod operand;
mod state;
mod step;
mod value;

pub use explore::Bound;
use explore::Explorer;
use listing::Listing;

/// Function and its bounds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoundedFunction {
    /// Name.
    pub name: String,
    /// Bounds, or the reason why the function has no bounds.
    pub bound: Result<Bound, String>,
}

/// Computes the bounds of the functions that are visible outside the object, in alphabetical order. `listing` is the
/// output of `objdump -t -d -r` for an object that contains all functions that they call.
///
/// # Errors
/// The listing is not the output for an object of a Cortex-M.
pub fn bound_functions(listing: &str) -> Result<Vec<BoundedFunction>, String> {
    let listing = Listing::read(listing)?;
    let functions = listing
        .functions
        .iter()
        .filter(|(_, function)| function.is_global);
    let (names, code_addresses): (Vec<&String>, Vec<u64>) = functions
        .map(|(name, function)| (name, function.code_address))
        .unzip();
    let bounds = Explorer::new(&listing).bound_functions(&code_addresses);
    let bounded = names
        .into_iter()
        .zip(bounds)
        .map(|(name, bound)| BoundedFunction {
            name: name.clone(),
            bound,
        });
    Ok(bounded.collect())
}
