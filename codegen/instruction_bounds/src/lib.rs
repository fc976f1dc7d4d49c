//! Upper bounds of the instructions and the stack of compiled functions of a Cortex-M4F or Cortex-M7, from the
//! disassembly.
//!
//! `listing` reads the output of objdump, `operand` and `instruction` decode it. `step` (with `compute` and `jump`)
//! executes an instruction on a `state` of partly known `value`s. `explore` follows all branches whose condition is not
//! known and takes the longest path of the `graph` of states; a loop ends if its counter is known. `library` has the
//! loops of libgcc whose limits follow from the number format.

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

/// Function with its bounds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BoundedFunction {
    /// Name.
    pub name: String,
    /// Bounds, or the reason why there are none.
    pub bound: Result<Bound, String>,
}

/// Bounds the functions that are visible outside the object, in alphabetical order. `listing` is the output of
/// `objdump -t -d -r` for an object that contains all functions that they call.
///
/// # Errors
/// If the listing is not that of an object for a Cortex-M.
pub fn bound_functions(listing: &str) -> Result<Vec<BoundedFunction>, String> {
    let listing = Listing::read(listing)?;
    let functions = listing
        .functions
        .iter()
        .filter(|(_, function)| function.is_global);
    let (names, places): (Vec<&String>, Vec<u64>) = functions
        .map(|(name, function)| (name, function.place))
        .unzip();
    let bounds = Explorer::new(&listing).bounds(&places);
    let bounded = names
        .into_iter()
        .zip(bounds)
        .map(|(name, bound)| BoundedFunction {
            name: name.clone(),
            bound,
        });
    Ok(bounded.collect())
}
