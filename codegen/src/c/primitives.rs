//! Operations on the bits of numbers that kernels call, as C text for both number formats.

use eomgen_elementary::{Double, Precision, Single};

/// Number format with the text for each placeholder in the templates of the primitives.
pub(super) trait CFormat: Precision {
    /// Name of the C type.
    const NUMBER: &'static str;
    /// Placeholders of the templates and their replacements.
    const PLACEHOLDERS: [(&'static str, &'static str); 15];
}

impl CFormat for Double {
    const NUMBER: &'static str = "double";
    const PLACEHOLDERS: [(&'static str, &'static str); 15] = [
        (
            "MAGNITUDE",
            "    const double negated = 0.0 - x;\n    return x > negated ? x : negated;",
        ),
        ("NAN_BITS", "0x7ff8 << 48"),
        ("INFINITY_BITS", "0x7ff0 << 48"),
        ("ROUNDING_ALIGNER", "6.755399441055744e15"),
        ("FOURFOLD_ALIGNER", "2.7021597764222976e16"),
        ("EXPONENT_ALIGNER", "4503599627371519.0"),
        ("LARGEST_INTEGER_BITS", "51"),
        ("MANTISSA_BITS", "52"),
        ("EXPONENT_MASK", "0x7ffU"),
        ("ONE_EXPONENT", "0x3ff"),
        ("SIGN_PLACE", "63"),
        ("BIASED", "1023"),
        ("BIAS", "1023.0"),
        ("FLOAT", "double"),
        ("WORD", "uint64_t"),
    ];
}

/// The magnitude is computed by clearing the sign bit, because a comparison needs more instructions.
impl CFormat for Single {
    const NUMBER: &'static str = "float";
    const PLACEHOLDERS: [(&'static str, &'static str); 15] = [
        (
            "MAGNITUDE",
            "    NAME_bits value;\n    value.number = x;\n    value.bits &= 0x7fffffffU;\n    return value.number;",
        ),
        ("NAN_BITS", "0x7fc0 << 16"),
        ("INFINITY_BITS", "0x7f80 << 16"),
        ("ROUNDING_ALIGNER", "12582912.0F"),
        ("FOURFOLD_ALIGNER", "50331648.0F"),
        ("EXPONENT_ALIGNER", "8388735.0F"),
        ("LARGEST_INTEGER_BITS", "22"),
        ("MANTISSA_BITS", "23"),
        ("EXPONENT_MASK", "0xffU"),
        ("ONE_EXPONENT", "0x7f"),
        ("SIGN_PLACE", "31"),
        ("BIASED", "127"),
        ("BIAS", "127.0F"),
        ("FLOAT", "float"),
        ("WORD", "uint32_t"),
    ];
}

/// Fills a template for a format.
fn fill_format<P: CFormat>(template: &str) -> String {
    let mut text = template.to_owned();
    for (word, replacement) in P::PLACEHOLDERS {
        text = text.replace(word, replacement);
    }
    text
}

/// Returns the union of a number and its bits.
pub(super) fn bits<P: CFormat>() -> String {
    fill_format::<P>(BITS)
}

/// Returns names and definitions of the primitives.
pub(super) fn primitives<P: CFormat>() -> [(&'static str, String); 9] {
    PRIMITIVES.map(|(name, template)| (name, fill_format::<P>(template)))
}

const BITS: &str = "\
/** Number and its bits. */
typedef union {
    FLOAT number;
    WORD bits;
} NAME_bits;
";

/// Functions that kernels call, and constants without a literal (NaN, infinity), by name.
const PRIMITIVES: [(&str, &str); 9] = [
    (
        "nan",
        "\
/** NaN. */
static FLOAT NAME_nan(void) {
    NAME_bits value;
    value.bits = (WORD)NAN_BITS;
    return value.number;
}
",
    ),
    (
        "infinity",
        "\
/** Infinity. */
static FLOAT NAME_infinity(void) {
    NAME_bits value;
    value.bits = (WORD)INFINITY_BITS;
    return value.number;
}
",
    ),
    (
        "magnitude",
        "\
/** Magnitude of a number. */
static FLOAT NAME_magnitude(FLOAT x) {
MAGNITUDE
}
",
    ),
    (
        "nearest_integer",
        "\
/** Integer nearest to x, ties to even, for |x| up to 2^LARGEST_INTEGER_BITS. If the compiler may reorder sums, each step
 * is hidden from it in a register or in memory. */
static FLOAT NAME_nearest_integer(FLOAT x) {
#if !defined(__FAST_MATH__) && !defined(__ASSOCIATIVE_MATH__) && !defined(_M_FP_FAST)
    return x + ROUNDING_ALIGNER - ROUNDING_ALIGNER;
#elif defined(__GNUC__) && defined(__SSE2__)
    __asm__(\"\" : \"+x\"(x));
    x = x + ROUNDING_ALIGNER;
    __asm__(\"\" : \"+x\"(x));
    x = x - ROUNDING_ALIGNER;
    __asm__(\"\" : \"+x\"(x));
    return x;
#else
    volatile FLOAT held = x;
    held = held + ROUNDING_ALIGNER;
    held = held - ROUNDING_ALIGNER;
    return held;
#endif
}
",
    ),
    (
        "nearest_multiple_of_four",
        "\
/** Multiple of four nearest to x. If the compiler may reorder sums, each step
 * is hidden from it in a register or in memory. */
static FLOAT NAME_nearest_multiple_of_four(FLOAT x) {
#if !defined(__FAST_MATH__) && !defined(__ASSOCIATIVE_MATH__) && !defined(_M_FP_FAST)
    return x + FOURFOLD_ALIGNER - FOURFOLD_ALIGNER;
#elif defined(__GNUC__) && defined(__SSE2__)
    __asm__(\"\" : \"+x\"(x));
    x = x + FOURFOLD_ALIGNER;
    __asm__(\"\" : \"+x\"(x));
    x = x - FOURFOLD_ALIGNER;
    __asm__(\"\" : \"+x\"(x));
    return x;
#else
    volatile FLOAT held = x;
    held = held + FOURFOLD_ALIGNER;
    held = held - FOURFOLD_ALIGNER;
    return held;
#endif
}
",
    ),
    (
        "copy_sign",
        "\
/** Magnitude of one number with the sign bit of another. */
static FLOAT NAME_copy_sign(FLOAT x, FLOAT sign) {
    const WORD top = (WORD)1 << SIGN_PLACE;
    NAME_bits value;
    NAME_bits other;
    value.number = x;
    other.number = sign;
    value.bits = (value.bits & ~top) | (other.bits & top);
    return value.number;
}
",
    ),
    (
        "power_of_two",
        "\
/** 2^k for an integral k: the addition of 2^MANTISSA_BITS + BIASED moves k to the exponent bits. */
static FLOAT NAME_power_of_two(FLOAT k) {
    NAME_bits value;
    value.number = k + EXPONENT_ALIGNER;
    value.bits <<= MANTISSA_BITS;
    return value.number;
}
",
    ),
    (
        "exponent",
        "\
/** Unbiased exponent field. */
static FLOAT NAME_exponent(FLOAT x) {
    NAME_bits value;
    value.number = x;
    value.bits = (value.bits >> MANTISSA_BITS) & EXPONENT_MASK;
    return (FLOAT)value.bits - BIAS;
}
",
    ),
    (
        "significand",
        "\
/** Mantissa with the exponent of 1. */
static FLOAT NAME_significand(FLOAT x) {
    NAME_bits value;
    value.number = x;
    value.bits = (value.bits & (((WORD)1 << MANTISSA_BITS) - 1U)) | ((WORD)ONE_EXPONENT << MANTISSA_BITS);
    return value.number;
}
",
    ),
];
