//! Names of emitted C; external names begin with the name of the model.

use crate::program::Program;
use crate::statements::Words;

/// Rules for names in C. Keywords are those of C, C++ and the preprocessor; taken names are variables and macros of
/// emitted functions.
pub(super) const WORDS: Words = Words {
    language: "C or C++",
    keywords: "_ alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t \
        char16_t char32_t class co_await co_return co_yield compl concept const const_cast \
        consteval constexpr constinit continue decltype default delete do double dynamic_cast \
        else enum errno explicit export extern false float for friend goto if inline int linux \
        long mutable namespace new noexcept not not_eq nullptr operator or or_eq private \
        protected public register reinterpret_cast requires restrict return short signed \
        sizeof static static_assert static_cast stderr stdin stdout struct switch template \
        this thread_local throw true try typedef typeid typename typeof union unix unsigned \
        using virtual void volatile wchar_t while xor xor_eq NULL",
    taken: "t state inputs coefficients parameters rates values observables i j k block regime \
        accelerations direction input_direction weights product input_product guards numbers \
        identity R",
    prefixed: true,
};

/// Replaces `NAME_` in a template by the model's name and `_`.
pub(super) fn fill_template(program: &Program, template: &str) -> String {
    template.replace("NAME_", &format!("{}_", program.name))
}

/// Returns the C name of an item of the emitted Rust.
pub(super) fn item_name(program: &Program, item: &str) -> String {
    let name = match item {
        "Coefficients::positive_definite" => return "positive_definite".to_owned(),
        "rates_into" => "rates",
        "rates_in_regime_into" => "rates_in_regime",
        "STATE_NAMES" => "state_names",
        "OBSERVABLE_NAMES" => "observable_names",
        "PARAMETER_NAMES" => "parameter_names",
        other => other,
    };
    let pattern = name
        .bytes()
        .all(|b| b.is_ascii_uppercase() || b == b'_')
        .then(|| format!("{}_places", name.to_lowercase()));
    format!("{}_{}", program.name, pattern.as_deref().unwrap_or(name))
}
