//! The largest ratio of allocated bytes to input bytes over damaged files, for each reader.

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use homeo_core::io::{Format, read_mesh_bytes};

#[path = "../../../crates/homeo-core/examples/stress_readers.rs"]
#[allow(dead_code)]
mod stress;

/// Inputs below this size have ratios that say nothing: an error message is larger.
const LEAST_SIZE: usize = 1024;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: all requests go to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(LIVE.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let seconds = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(5.0);
    let files: Vec<PathBuf> = arguments.iter().skip(1).map(PathBuf::from).collect();
    for format in Format::ALL {
        let mut seeds = stress::seeds(format);
        let of_format = files.iter().filter(|file| Format::of_path(file) == Some(format));
        seeds.extend(of_format.filter_map(|file| std::fs::read(file).ok()).filter(|bytes| !bytes.is_empty()));
        measure(format, &seeds, Duration::from_secs_f64(seconds));
    }
}

fn measure(format: Format, seeds: &[Vec<u8>], duration: Duration) {
    let mut random = stress::Random(0x9e37_79b9_7f4a_7c15);
    let start = Instant::now();
    let (mut reads, mut successes, mut panics) = (0_u64, 0_u64, 0_u64);
    let mut worst = (0.0_f64, 0, 0);
    let mut slowest = (0.0_f64, 0);
    while start.elapsed() < duration {
        let input = stress::damaged(seeds, &mut random);
        let before = LIVE.load(Relaxed);
        PEAK.store(before, Relaxed);
        let begin = Instant::now();
        match std::panic::catch_unwind(|| read_mesh_bytes(format, "damaged".as_ref(), &input).is_ok()) {
            Ok(is_ok) => successes += u64::from(is_ok),
            Err(_) => panics += 1,
        }
        let nanoseconds = begin.elapsed().as_nanos() as f64;
        let allocated = PEAK.load(Relaxed) - before;
        if input.len() >= LEAST_SIZE {
            let ratio = allocated as f64 / input.len() as f64;
            if ratio > worst.0 {
                worst = (ratio, allocated, input.len());
            }
            // Other programs interrupt: a read is slow only if it is slow every time.
            let mut rate = nanoseconds / input.len() as f64;
            for _ in 0..20 {
                if rate > slowest.0 {
                    let begin = Instant::now();
                    let _ = std::panic::catch_unwind(|| read_mesh_bytes(format, "damaged".as_ref(), &input).is_ok());
                    rate = rate.min(begin.elapsed().as_nanos() as f64 / input.len() as f64);
                }
            }
            if rate > slowest.0 {
                slowest = (rate, input.len());
            }
        }
        reads += 1;
    }
    println!(
        "{:16} {reads:8} reads {successes:7} succeeded {panics} panics; most memory {:.1} × the input ({} for {}); \
         slowest {:.0} ns per byte ({} bytes)",
        format.name(),
        worst.0,
        worst.1,
        worst.2,
        slowest.0,
        slowest.1
    );
}
