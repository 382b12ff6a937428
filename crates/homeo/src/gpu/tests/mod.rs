//! Against the processor, on the device that the loader finds. Where there is none, each test says that it was skipped.
#![allow(clippy::print_stderr, reason = "what is skipped is told, and what was measured")]

mod field;
mod images;

use super::{Gpu, GpuError, field as field_program, images as images_program};

/// The device, or nothing and a note.
fn gpu(test: &str) -> Option<Gpu> {
    opened(test, images_program::PROGRAM, field_program::PROGRAM)
}

/// The device with a program in which a text is exchanged.
fn gpu_with(test: &str, exchange: [&str; 2]) -> Option<Gpu> {
    let changed = |program: &str| program.replace(exchange[0], exchange[1]);
    let programs = [images_program::PROGRAM, field_program::PROGRAM].map(changed);
    assert_ne!(programs.concat(), [images_program::PROGRAM, field_program::PROGRAM].concat(), "{exchange:?}");
    opened(test, &programs[0], &programs[1])
}

fn opened(test: &str, images: &str, field: &str) -> Option<Gpu> {
    match Gpu::with_programs(images, field) {
        Ok(gpu) => Some(gpu),
        Err(GpuError::NoAdapter(reason)) => {
            eprintln!("{test} is SKIPPED: no Vulkan driver that the loader finds ({reason})");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// Numbers from 0 to 1 that look random.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[test]
fn a_wrong_program_is_told() {
    let Some(_) = gpu("a_wrong_program_is_told") else { return };
    let error = Gpu::with_programs("this is no program", field_program::PROGRAM).unwrap_err();
    assert!(matches!(error, GpuError::NoDevice { .. }), "{error}");
}
