//! Threads of parallel work.

use std::sync::Once;

/// Stack size of a thread. A thread that waits for a part of its work takes other work meanwhile, and derives models with
/// nested formulas, so that its stack becomes deeper than that of a single fit. Unused memory is not allocated.
const STACK_BYTES: usize = 64 << 20;

/// Creates the threads of parallel work with stacks that are large enough, unless the process already has some.
pub fn prepare_threads() {
    static PREPARED: Once = Once::new();
    PREPARED.call_once(|| {
        let threads = rayon::ThreadPoolBuilder::new().stack_size(STACK_BYTES);
        // An error means that there are threads, which the caller created.
        drop(threads.build_global());
    });
}
