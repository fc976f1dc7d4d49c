//! Constants of the two number formats: limits, splittings of irrational numbers, polynomials.
//!
//! The functions are written once for both formats. The formats differ only in these constants and in the argument
//! reduction of sine and cosine, which needs fewer operations in single precision.

use crate::pair::Pair;

/// Constants of a number format. Every value is exactly representable in the format.
///
/// The coefficients of each polynomial minimise the largest relative error of the *function* over the stated interval
/// (computed in at least 48 digits). Then the coefficients are rounded to the format one after the other, and the
/// remaining ones are fitted again after each rounding.
pub trait Precision: Copy + 'static {
    /// Rounds a double to the format.
    fn round(value: f64) -> f64;
    /// `1.5 2^(p - 1)` for `p` bits of mantissa. The spacing of the numbers near this value is 1; kernels round to an
    /// integer by adding and subtracting it.
    const ROUNDING_ALIGNER: f64;
    /// Factor of Veltkamp's splitting of a number into halves.
    const SPLITTER: f64;
    /// Distance from 1 to the next larger number.
    const EPSILON: f64;
    /// Smallest normal number.
    const SMALLEST_NORMAL: f64;
    /// Exponent e, and 2^e: the product of 2^e and any subnormal is normal.
    const SUBNORMAL_SCALING: (f64, f64);

    /// Largest magnitude, in radians, of an argument of sine, cosine and tangent.
    const LARGEST_ANGLE: f64;
    /// `pi/2` as a sum of five parts. The products of the first four parts with the integer `k` of the reduction are
    /// exact up to the largest angle (up to 1e5 in single precision).
    const HALF_PI_PARTS: [f64; 5];
    /// If sine and cosine use the short remainder: factor whose product with `k` overflows beyond the largest angle.
    const SHORT_REMAINDER: Option<f64>;
    /// `(1 - sin(r)/r)/z`, `z = r^2`, `|r| <= pi/4`.
    const SINE: &'static [f64];
    /// `(cos(r) - 1 + z/2)/z^2`, `z = r^2`, `|r| <= pi/4`.
    const COSINE: &'static [f64];

    /// `ln 2` as a pair. The product of its leading part with an exponent is exact.
    const LN_2: Pair<f64>;
    /// `(e^r - 1 - r)/r^2`, `|r| <= ln(2)/2`.
    const EXPONENTIAL: &'static [f64];
    /// Largest argument whose exponential is zero, and smallest argument whose exponential is infinite.
    const EXPONENTIAL_RANGE: (f64, f64);
    /// Argument below which `e^x - 1` is rounded to -1.
    const FLAT_EXPONENTIAL: f64;
    /// Argument above which hyperbolic sine and cosine are infinite. The power of two in their computation is still
    /// finite here.
    const LARGEST_HYPERBOLIC: f64;
    /// Argument above which the hyperbolic tangent is rounded to 1.
    const FLAT_TANGENT: f64;
    /// Magnitude below which an odd function `f(x) = x + O(x^3)` is rounded to its argument.
    const TINY: f64;

    /// `(2 artanh(s)/s - 2)/z`, `z = s^2`, `|s| <= (sqrt 2 - 1)/(sqrt 2 + 1)`.
    const LOGARITHM: &'static [f64];
    /// `(artanh(s)/s - 1 - z/3)/z^2` on the same interval.
    const LOGARITHM_BEYOND_CUBE: &'static [f64];
    /// One third.
    const ONE_THIRD: Pair<f64>;
    /// Magnitude of an exponent above which every power of a number other than 1 overflows or underflows.
    const LARGEST_EXPONENT: f64;
    /// Magnitude of `y ln x` up to which its low part is a rounding error.
    const CORRECTED_RANGE: f64;
    /// Magnitude from which on every number of the format is an integer.
    const ALL_INTEGERS: f64;

    /// `1/sqrt m`, `m` in `[1, 4]`.
    const INVERSE_ROOT: &'static [f64];
    /// Number of Newton steps after that polynomial, for at least about half of the bits.
    const NEWTON_STEPS: usize;

    /// `pi`, `pi/2`, `pi/4`.
    const PI: [Pair<f64>; 3];
    /// `atan(1/2)`.
    const ARCTAN_HALF: Pair<f64>;
    /// `(1 - atan(t)/t)/z`, `z = t^2`, `|t| <= 13/32`.
    const ARC_TANGENT: &'static [f64];
    /// `(asin(s)/s - 1)/z`, `z = s^2`, `|s| <= 1/2`.
    const ARC_SINE: &'static [f64];
    /// Magnitude that squares and triples without overflow in a ratio of products.
    const HUGE: f64;
    /// Scale (a power of two) for numbers above `HUGE`, magnitude below which products can lose bits, and scale for
    /// numbers below this magnitude.
    const SCALING: (f64, f64, f64);
}

const fn pair(high: f64, low: f64) -> Pair<f64> {
    Pair { high, low }
}

/// IEEE 754 binary64.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Double {}

impl Precision for Double {
    const ROUNDING_ALIGNER: f64 = (3_u64 << 51) as f64;
    const SPLITTER: f64 = ((1_u64 << 27) + 1) as f64;
    const EPSILON: f64 = f64::EPSILON;
    const SMALLEST_NORMAL: f64 = f64::MIN_POSITIVE;
    const SUBNORMAL_SCALING: (f64, f64) = (54.0, (1_u64 << 54) as f64);

    const LARGEST_ANGLE: f64 = 1e9;
    // Four multiples of 2^-22, 2^-45, 2^-68 and 2^-91, and the rest.
    const HALF_PI_PARTS: [f64; 5] = [
        1.570_796_251_296_997,
        7.549_789_415_861_596e-8,
        5.390_304_224_023_659e-15,
        -1.365_865_426_710_064_5e-21,
        -1.135_111_860_752_220_2e-28,
    ];
    const SHORT_REMAINDER: Option<f64> = None;
    // Relative error of the sine: 2^-57.9.
    const SINE: &'static [f64] = &[
        0.166_666_666_666_666_3,
        -0.008_333_333_333_321_917,
        0.000_198_412_698_294_584_53,
        -2.755_731_358_278_338e-6,
        2.505_074_247_785_225_2e-8,
        -1.589_595_656_566_405_4e-10,
    ];
    // Relative error of the cosine: 2^-63.7.
    const COSINE: &'static [f64] = &[
        0.041_666_666_666_666_595,
        -0.001_388_888_888_887_334_2,
        2.480_158_728_900_197_8e-5,
        -2.755_731_421_694_031e-7,
        2.087_570_531_942_464_2e-9,
        -1.135_873_832_348_000_3e-11,
    ];

    // The leading part is a multiple of 2^-42; exponents have 11 bits.
    const LN_2: Pair<f64> = pair(0.693_147_180_559_890_3, 5.497_923_018_708_371e-14);
    // Relative error of `e^r - 1`: 2^-61.6.
    const EXPONENTIAL: &'static [f64] = &[
        0.5,
        0.166_666_666_666_666_77,
        0.041_666_666_666_666_68,
        0.008_333_333_333_321_454,
        0.001_388_888_888_887_710_2,
        0.000_198_412_698_865_142_7,
        2.480_158_734_179_433e-5,
        2.755_724_386_281_276e-6,
        2.755_725_790_496_236e-7,
        2.510_914_570_771_847e-8,
        2.091_996_652_279_279_6e-9,
    ];
    const EXPONENTIAL_RANGE: (f64, f64) = (-746.0, 710.0);
    const FLAT_EXPONENTIAL: f64 = -40.0;
    const LARGEST_HYPERBOLIC: f64 = 710.5;
    const FLAT_TANGENT: f64 = 22.0;
    const TINY: f64 = 1.0 / (1_u64 << 28) as f64;

    // Relative error of the logarithm: 2^-58.5.
    const LOGARITHM: &'static [f64] = &[
        0.666_666_666_666_673_4,
        0.399_999_999_994_166_47,
        0.285_714_287_420_412_05,
        0.222_221_986_023_973_25,
        0.181_835_630_409_943_4,
        0.153_140_790_370_342_92,
        0.147_956_981_892_253_4,
    ];
    // Relative error of the logarithm: 2^-73.3.
    const LOGARITHM_BEYOND_CUBE: &'static [f64] = &[
        0.199_999_999_999_999_9,
        0.142_857_142_857_219_2,
        0.111_111_111_088_948_76,
        0.090_909_094_219_955_27,
        0.076_922_792_141_128_09,
        0.066_681_322_726_506_69,
        0.058_378_893_992_871_744,
        0.059_908_896_471_751_4,
    ];
    const ONE_THIRD: Pair<f64> = pair(0.333_333_333_333_333_3, 1.850_371_707_708_594e-17);
    const LARGEST_EXPONENT: f64 = (1_u128 << 65) as f64;
    const CORRECTED_RANGE: f64 = 800.0;
    const ALL_INTEGERS: f64 = (1_u64 << 52) as f64;

    // Relative error of `1/sqrt m`: 2^-12.2.
    const INVERSE_ROOT: &'static [f64] = &[
        2.081_649_629_276_674,
        -2.032_425_431_582_041_6,
        1.427_860_208_912_750_3,
        -0.612_114_372_530_438,
        0.154_845_229_307_336_9,
        -0.021_231_322_940_888_833,
        0.001_215_380_137_694_336,
    ];
    const NEWTON_STEPS: usize = 2;

    const PI: [Pair<f64>; 3] = [
        pair(core::f64::consts::PI, 1.224_646_799_147_353_2e-16),
        pair(core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17),
        pair(core::f64::consts::FRAC_PI_4, 3.061_616_997_868_383e-17),
    ];
    const ARCTAN_HALF: Pair<f64> = pair(0.463_647_609_000_806_1, 2.269_877_745_296_168_7e-17);
    // Relative error of the arc tangent: 2^-60.0.
    const ARC_TANGENT: &'static [f64] = &[
        0.333_333_333_333_332_4,
        -0.199_999_999_999_677_74,
        0.142_857_142_817_274_52,
        -0.111_111_108_647_920_88,
        0.090_909_002_284_327_43,
        -0.076_921_064_388_157_52,
        0.066_636_547_777_900_65,
        -0.058_520_779_995_031_746,
        0.050_589_893_714_249_747,
        -0.038_585_239_163_830_554,
        0.018_499_946_444_261_672,
    ];
    // Relative error of the arc sine: 2^-59.8.
    const ARC_SINE: &'static [f64] = &[
        0.166_666_666_666_667_63,
        0.074_999_999_999_701_72,
        0.044_642_857_175_186_69,
        0.030_381_942_681_077_145,
        0.022_372_215_719_623_372,
        0.017_351_599_189_577_46,
        0.013_980_970_743_362_084,
        0.011_397_710_031_166_455,
        0.010_786_851_869_560_77,
        0.003_681_972_820_173_528_4,
        0.021_765_785_126_995_955,
        -0.021_080_136_755_579_845,
        0.032_678_452_646_137_02,
    ];
    const HUGE: f64 = 1e300;
    const SCALING: (f64, f64, f64) = (1.0 / (1_u64 << 30) as f64, 1e-270, (1_u128 << 120) as f64);

    fn round(value: f64) -> f64 {
        value
    }
}

/// IEEE 754 binary32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Single {}

impl Precision for Single {
    const ROUNDING_ALIGNER: f64 = (3_u32 << 22) as f64;
    const SPLITTER: f64 = ((1_u32 << 12) + 1) as f64;
    const EPSILON: f64 = f32::EPSILON as f64;
    const SMALLEST_NORMAL: f64 = f32::MIN_POSITIVE as f64;
    const SUBNORMAL_SCALING: (f64, f64) = (25.0, (1_u32 << 25) as f64);

    // Largest number below 2^22.
    const LARGEST_ANGLE: f64 = 4_194_303.75;
    // Four parts of 8 bits, because k has 16 bits up to 1e5, and the rest, rounded up. If the rest were rounded to
    // nearest, the error of the cosine next to 33433 pi/2 would exceed two units; no other argument below 1e5 is
    // affected. All parts are positive, so that a negative zero keeps its sign.
    const HALF_PI_PARTS: [f64; 5] = [
        1.570_312_5,
        0.000_482_559_204_101_562_5,
        1.266_598_701_477_050_8e-6,
        9.895_302_355_289_46e-10,
        2.563_344_285_097_524e-12,
    ];
    // 2^106: the product with 2^22 is infinite.
    const SHORT_REMAINDER: Option<f64> = Some((1_u128 << 106) as f64);
    // Relative error of the sine: 2^-27.9.
    const SINE: &'static [f64] = &[0.166_666_55, -0.008_332_187, 0.000_195_178_97];
    // Relative error of the cosine: 2^-32.3.
    const COSINE: &'static [f64] = &[0.041_666_653, -0.001_388_761, 2.446_175e-5];

    // The leading part is a multiple of 2^-16; exponents have 8 bits.
    const LN_2: Pair<f64> = pair(0.693_145_751_953_125, 1.428_606_8e-6);
    // Relative error of `e^r - 1`: 2^-27.9.
    const EXPONENTIAL: &'static [f64] = &[
        0.5,
        0.166_666_36,
        0.041_666_485,
        0.008_340_016,
        0.001_393_431_7,
        0.000_166_493_37,
    ];
    const EXPONENTIAL_RANGE: (f64, f64) = (-104.0, 89.0);
    const FLAT_EXPONENTIAL: f64 = -20.0;
    const LARGEST_HYPERBOLIC: f64 = 89.5;
    const FLAT_TANGENT: f64 = 10.0;
    const TINY: f64 = 1.0 / (1_u32 << 13) as f64;

    // Relative error of the logarithm: 2^-30.2.
    const LOGARITHM: &'static [f64] = &[0.666_667_76, 0.399_775_68, 0.298_714_6];
    // Relative error of the logarithm: 2^-36.1.
    const LOGARITHM_BEYOND_CUBE: &'static [f64] = &[0.200_000_46, 0.142_761_07, 0.116_565_33];
    const ONE_THIRD: Pair<f64> = pair(0.333_333_34, -9.934_108e-9);
    const LARGEST_EXPONENT: f64 = (1_u64 << 33) as f64;
    const CORRECTED_RANGE: f64 = 120.0;
    const ALL_INTEGERS: f64 = (1_u32 << 23) as f64;

    // Relative error of `1/sqrt m`: 2^-10.6.
    const INVERSE_ROOT: &'static [f64] = &[
        1.922_545,
        -1.555_900_9,
        0.862_922_67,
        -0.271_961_3,
        0.044_724_75,
        -0.002_978_555_9,
    ];
    const NEWTON_STEPS: usize = 1;

    const PI: [Pair<f64>; 3] = [
        pair(core::f32::consts::PI as f64, -8.742_278e-8),
        pair(core::f32::consts::FRAC_PI_2 as f64, -4.371_139e-8),
        pair(core::f32::consts::FRAC_PI_4 as f64, -2.185_569_4e-8),
    ];
    const ARCTAN_HALF: Pair<f64> = pair(0.463_647_6, 5.012_158_7e-9);
    // Relative error of the arc tangent: 2^-30.6.
    const ARC_TANGENT: &'static [f64] = &[
        0.333_333_22,
        -0.199_988_72,
        0.142_508_2,
        -0.106_471_874,
        0.062_143_575,
    ];
    // Relative error of the arc sine: 2^-31.6.
    const ARC_SINE: &'static [f64] = &[
        0.166_666_63,
        0.075_003_84,
        0.044_535_793,
        0.031_672_97,
        0.014_888_308,
        0.036_947_865,
    ];
    const HUGE: f64 = 1e30;
    const SCALING: (f64, f64, f64) = (1.0 / (1_u32 << 30) as f64, 1e-20, (1_u64 << 60) as f64);

    fn round(value: f64) -> f64 {
        f64::from(value as f32)
    }
}
