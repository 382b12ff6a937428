//! Damaged files never panic, and never allocate far beyond their size.

use super::samples::files;
use crate::io::{Format, read_mesh_bytes};

/// Reads, and checks the invariant where reading succeeds.
fn read(format: Format, bytes: &[u8]) {
    match read_mesh_bytes(format, "broken".as_ref(), bytes) {
        Ok(mesh) => assert_eq!(mesh.check(), Ok(()), "{format:?}"),
        Err(error) => assert!(!error.code.is_empty() && !error.message.is_empty()),
    }
}

#[test]
fn files_cut_at_any_byte() {
    for (format, bytes) in files() {
        for length in 0..bytes.len() {
            read(format, &bytes[..length]);
        }
    }
}

#[test]
fn files_with_any_byte_changed() {
    for (format, bytes) in files() {
        let mut changed = bytes.clone();
        for index in 0..bytes.len() {
            for change in [0x00, 0xff, b' ', b'9', b'-', b'\n', bytes[index] ^ 1, bytes[index] ^ 0x80] {
                changed[index] = change;
                read(format, &changed);
            }
            changed[index] = bytes[index];
        }
    }
}

#[test]
fn files_with_several_changes() {
    // A linear congruential generator: the same changes in every run.
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    };
    for (format, bytes) in files() {
        for _ in 0..500 {
            let mut changed = bytes.clone();
            for _ in 0..=random(4) {
                let (from, to) = (random(changed.len()), random(changed.len()));
                let length = random(24).min(changed.len() - from.max(to));
                match random(3) {
                    0 => changed.copy_within(from..from + length, to),
                    1 => drop(changed.drain(from..from + length)),
                    _ => changed[to] = random(256) as u8,
                }
                if changed.is_empty() {
                    break;
                }
            }
            read(format, &changed);
        }
    }
}

#[test]
fn all_formats_refuse_the_bytes_of_all_others() {
    for (_, bytes) in files() {
        for format in Format::ALL {
            read(format, &bytes);
        }
    }
}
