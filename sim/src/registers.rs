//! Selection of SIMD registers at run time.

/// Evaluates an expression with the registers of AVX2 if the processor has them, otherwise with those
/// of the target's baseline; `$simd` is the token. The results are bit-identical.
///
/// `fearless_simd::dispatch` has variants for SSE4.2 and AVX-512 as well. They double the compiled
/// code, and vectors of four numbers gain nothing from them.
macro_rules! dispatch_registers {
    ($simd:pat => $body:expr) => {{
        #[cfg(target_arch = "x86_64")]
        {
            use fearless_simd::Simd as _;
            let level = fearless_simd::Level::new();
            if let Some(avx2) = level.as_avx2() {
                avx2.vectorize(
                    #[inline(always)]
                    || {
                        let $simd = avx2;
                        $body
                    },
                )
            } else if let Some(sse2) = level.as_sse2() {
                sse2.vectorize(
                    #[inline(always)]
                    || {
                        let $simd = sse2;
                        $body
                    },
                )
            } else {
                unreachable!("x86-64 has SSE2")
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            fearless_simd::dispatch!(fearless_simd::Level::new(), $simd => $body)
        }
    }};
}

pub(crate) use dispatch_registers;
