//! Work on many items by all processors, with results that do not depend on how many there are.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The results for all items, in order, by as many threads as there are processors.
pub(crate) fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get());
    let size = items.len().div_ceil(8 * threads).max(1);
    let parts: Vec<&[T]> = items.chunks(size).collect();
    let next = AtomicUsize::new(0);
    let run = || {
        let mut done = Vec::new();
        while let Some((number, part)) = {
            let number = next.fetch_add(1, Relaxed);
            parts.get(number).map(|part| (number, part))
        } {
            done.push((number, part.iter().map(&work).collect::<Vec<R>>()));
        }
        done
    };
    let mut all: Vec<(usize, Vec<R>)> = std::thread::scope(|scope| {
        let handles: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
        handles
            .into_iter()
            .flat_map(|handle| handle.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
            .collect()
    });
    all.sort_by_key(|(number, _)| *number);
    all.into_iter().flat_map(|(_, results)| results).collect()
}
