//! Documentation of the step, shared by the languages.

use crate::program::Program;

const HEAD: &str = "Step of length h (s) of the classical Runge-Kutta method of order 4, with constant inputs. It is\n\
                    bit-identical to `eomgen simulate --solver fixed`. Switches are not located.";

const REACTIONS: &str = "\n\n\
    Frictions that can hold the motion have one value over the step, so that a friction at rest\n\
    holds. Contacts that are closed at the end of the step receive impulses, with Newton's law of\n\
    restitution. The state becomes NaN if the iteration for these reactions does not converge.";

/// Returns name, value and documentation of the sizes of arrays of reactions; nothing without reactions.
pub fn reaction_constants(program: &Program) -> Vec<(&'static str, usize, &'static str)> {
    let Some(known) = &program.outputs.reactions else {
        return Vec::new();
    };
    let [functions, effects] = program.reaction_sizes();
    let mut constants = vec![
        (
            "REACTION_FUNCTIONS",
            functions,
            "Number of functions of reactions and of distances of contacts.",
        ),
        (
            "REACTION_EFFECTS",
            effects,
            "Number of effects of reactions, coefficients of contacts and elements of columns.",
        ),
    ];
    if known.sides() > 0 {
        let doc = "Number of dry frictions that can stick.";
        constants.insert(0, ("SIDES", known.sides(), doc));
    }
    constants
}

/// Returns the documentation of the emitted function.
pub fn describe_step(program: &Program) -> String {
    match program.outputs.reactions {
        Some(_) => HEAD.to_owned() + REACTIONS,
        None => HEAD.to_owned(),
    }
}

/// Documentation of the functions that a step with reactions calls.
pub const CLOSE_CONTACTS: &str = "Closes the open contacts whose distance is not positive with the reactions so far: sets the rate that each has\n\
     after the step at least, and the time for which its impulse acts. Returns 1 if a contact closes, else 0.";
/// See [`CLOSE_CONTACTS`].
pub const SEPARATE_CONTACTS: &str = "Moves the positions so that closed contacts do not overlap.";
/// See [`CLOSE_CONTACTS`].
pub const FIND_REACTIONS: &str = "Corrects the reactions by projected Gauss-Seidel sweeps until the conditions on the functions hold, and the\n\
     functions with them. Returns 0 if they are found, else 1.";
/// See [`CLOSE_CONTACTS`].
pub const APPLY_REACTIONS: &str = "Adds the changes of the reactions since `applied` to the state.";
