//! Thread pool for parallel computations.

use std::sync::Once;

/// Stack size of a thread. While a thread waits for a subtask, it executes other tasks, which may
/// derive models with nested expressions. Its stack is therefore deeper than the stack of a single
/// fit. Unused memory is not allocated.
const STACK_BYTES: usize = 64 << 20;

/// Creates the thread pool with a sufficient stack size, unless the process already has a pool.
pub fn prepare_threads() {
    static PREPARED: Once = Once::new();
    PREPARED.call_once(|| {
        let threads = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES);
        // If the caller has already created a pool, an error is returned and ignored.
        drop(threads.build_global());
    });
}
