//! Names reserved in emitted Rust.

use crate::statements::Words;

/// Rules for names in Rust. Keywords are those of any edition; taken names are variables, helpers, constants
/// (also those of generics) and fields, and values of Rust's prelude.
pub(super) const WORDS: Words = Words {
    language: "Rust",
    keywords: "_ abstract as async await become box break const continue crate do dyn else enum \
        extern false final fn for if impl in let loop macro match mod move mut override priv \
        pub ref return Self self static struct super trait true try type typeof unsafe unsized \
        use virtual where while yield gen",
    taken: "t state inputs coefficients parameters rates values total i j k row column rest sum \
        sum_of_few pairwise_sum pow exp_minus_one cholesky cholesky_solve cholesky_solve_matrix \
        converted converted_matrix read_array read_matrix accelerations direction \
        input_direction weights product input_product pattern INPUTS INPUT_NAMES PARAMETERS \
        PARAMETER_NAMES guards deadzone_on_side touching either chosen positive \
        pivot_reciprocal positive_definite ORDERS DEGREES_OF_FREEDOM STATES STATE_NAMES \
        OBSERVABLES OBSERVABLE_NAMES GUARDS SPECIFICATION_SHA256 GENERATOR_VERSION IDENTITY STATE_UNITS \
        INPUT_UNITS PARAMETER_UNITS OBSERVABLE_UNITS INITIAL_STATE STATE_LOWER STATE_UPPER \
        INPUT_LOWER INPUT_UPPER REGIME Some None \
        Ok Err",
    prefixed: false,
};
