//! Registers of x86-64. This module contains all `unsafe` code: instructions that some machines lack.
//!
//! Soundness: the types are private to this crate. They are used as the `Vector` of a [`crate::Task`] only in
//! [`with_wide`] and [`with_pairs`], which are called only after the instructions were detected.
//!
//! `fearless_simd`, which the solvers use, has no advantage here. Emitted code creates a number from its value only,
//! so the instruction-set token of `fearless_simd` would need `unsafe` as well. The two were compared with AVX2 in 50
//! paired runs of the arm's rates, with bit-identical results. `fearless_simd` took the same time at 4 modes (5.0 ns
//! per state), 3 % less at 16 modes (8.8 ns instead of 9.1 ns) and 3 % more at 64 modes (24.9 ns instead of 24.1 ns).
//! Its 512-bit registers need the instructions of Ice Lake; the registers of this module need only AVX-512 F and DQ.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use crate::task::Task;
use crate::vector::{LANES, MANTISSA_BITS, Sealed, Vector};

/// One register of 512 bits.
#[derive(Clone, Copy)]
pub struct Wide(__m512d);

/// Two registers of 256 bits.
#[derive(Clone, Copy)]
pub struct Pair([__m256d; 2]);

/// Runs a task, compiled for [`Wide`].
///
/// # Safety
/// The machine must have AVX-512 F and DQ.
#[target_feature(enable = "avx512f,avx512dq")]
pub unsafe fn with_wide<T: Task>(task: T) -> T::Output {
    task.run::<Wide>()
}

/// Runs a task, compiled for [`Pair`].
///
/// # Safety
/// The machine must have AVX2.
#[target_feature(enable = "avx2")]
pub unsafe fn with_pairs<T: Task>(task: T) -> T::Output {
    task.run::<Pair>()
}

const MANTISSA: u32 = MANTISSA_BITS;

impl Sealed for Wide {}

impl Vector for Wide {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: tasks use this type only on machines with AVX-512 (see the module documentation). This holds for
        // every block below.
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn from_array(numbers: [f64; LANES]) -> Self {
        Self(unsafe { _mm512_loadu_pd(numbers.as_ptr()) })
    }
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        unsafe { _mm512_storeu_pd(numbers.as_mut_ptr(), self.0) };
        numbers
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(unsafe { _mm512_add_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(unsafe { _mm512_sub_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(unsafe { _mm512_mul_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(unsafe { _mm512_div_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self(unsafe {
            let greater = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(a.0, b.0);
            _mm512_mask_blend_pd(greater, otherwise.0, then.0)
        })
    }
    #[inline(always)]
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        Self(unsafe {
            let equal = _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(a.0, b.0);
            _mm512_mask_blend_pd(equal, otherwise.0, then.0)
        })
    }
    #[inline(always)]
    fn and(self, bits: u64) -> Self {
        Self(unsafe { _mm512_and_pd(self.0, _mm512_set1_pd(f64::from_bits(bits))) })
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(unsafe { _mm512_or_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn flip(self, bits: u64) -> Self {
        Self(unsafe { _mm512_xor_pd(self.0, _mm512_set1_pd(f64::from_bits(bits))) })
    }
    #[inline(always)]
    fn mantissa_to_exponent(self) -> Self {
        Self(unsafe {
            _mm512_castsi512_pd(_mm512_slli_epi64::<MANTISSA>(_mm512_castpd_si512(self.0)))
        })
    }
    #[inline(always)]
    fn exponent_to_mantissa(self) -> Self {
        Self(unsafe {
            _mm512_castsi512_pd(_mm512_srli_epi64::<MANTISSA>(_mm512_castpd_si512(self.0)))
        })
    }
}

impl Pair {
    #[inline(always)]
    fn each(self, function: impl Fn(__m256d) -> __m256d) -> Self {
        Self([function(self.0[0]), function(self.0[1])])
    }

    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(__m256d, __m256d) -> __m256d) -> Self {
        Self([
            function(self.0[0], other.0[0]),
            function(self.0[1], other.0[1]),
        ])
    }

    /// Returns `then` in lanes whose mask is set.
    #[inline(always)]
    fn choose(mask: Self, then: Self, otherwise: Self) -> Self {
        let half = |i: usize| {
            // SAFETY: tasks use this type only on machines with AVX2 (see the module documentation). This holds for
            // every block below.
            unsafe { _mm256_blendv_pd(otherwise.0[i], then.0[i], mask.0[i]) }
        };
        Self([half(0), half(1)])
    }

    #[inline(always)]
    fn bits(bits: u64) -> __m256d {
        unsafe { _mm256_set1_pd(f64::from_bits(bits)) }
    }
}

impl Sealed for Pair {}

impl Vector for Pair {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        let half = unsafe { _mm256_set1_pd(value) };
        Self([half, half])
    }
    #[inline(always)]
    fn from_array(numbers: [f64; LANES]) -> Self {
        let start = numbers.as_ptr();
        Self(unsafe {
            [
                _mm256_loadu_pd(start),
                _mm256_loadu_pd(start.add(LANES / 2)),
            ]
        })
    }
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        let start = numbers.as_mut_ptr();
        unsafe {
            _mm256_storeu_pd(start, self.0[0]);
            _mm256_storeu_pd(start.add(LANES / 2), self.0[1]);
        }
        numbers
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_add_pd(a, b) })
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_sub_pd(a, b) })
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_mul_pd(a, b) })
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_div_pd(a, b) })
    }
    #[inline(always)]
    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        let mask = a.zip(b, |a, b| unsafe { _mm256_cmp_pd::<_CMP_GT_OQ>(a, b) });
        Self::choose(mask, then, otherwise)
    }
    #[inline(always)]
    fn select_equal(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        let mask = a.zip(b, |a, b| unsafe { _mm256_cmp_pd::<_CMP_EQ_OQ>(a, b) });
        Self::choose(mask, then, otherwise)
    }
    #[inline(always)]
    fn and(self, bits: u64) -> Self {
        self.each(|x| unsafe { _mm256_and_pd(x, Self::bits(bits)) })
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.zip(other, |a, b| unsafe { _mm256_or_pd(a, b) })
    }
    #[inline(always)]
    fn flip(self, bits: u64) -> Self {
        self.each(|x| unsafe { _mm256_xor_pd(x, Self::bits(bits)) })
    }
    #[inline(always)]
    fn mantissa_to_exponent(self) -> Self {
        self.each(|x| unsafe {
            _mm256_castsi256_pd(_mm256_slli_epi64::<{ MANTISSA as i32 }>(
                _mm256_castpd_si256(x),
            ))
        })
    }
    #[inline(always)]
    fn exponent_to_mantissa(self) -> Self {
        self.each(|x| unsafe {
            _mm256_castsi256_pd(_mm256_srli_epi64::<{ MANTISSA as i32 }>(
                _mm256_castpd_si256(x),
            ))
        })
    }
}
