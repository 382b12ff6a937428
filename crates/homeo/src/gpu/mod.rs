//! Images of many points and sampling of pictures on a graphics processor, by Vulkan. Feature `gpu`.
//!
//! What is computed here is rounded, in single precision with positions in two parts, and compared with the results of the
//! processor by tests. No certificate rests on it: maps are made, proved and inverted without it.
//!
//! Method:      composite mean value maps, all steps in one program for each point; a step adds the mean of the vertices'
//!              displacements, so that errors go with the length of the way and not with the number of steps.
//! Source:      Hormann, Floater 2006 (doi 10.1145/1183287.1183295), section 4, for half tangents and for the sign of the sum
//!              of weights, which tells inside from outside.
//! Arithmetic:  f32; where it would lose too many digits, close to edges and vertices, points are left to the processor.
//! Fails when:  there is no Vulkan driver, or the device has too little memory -> [`GpuError`].
//! See:         `docs/methods/gpu.md`.

mod device;
mod error;
mod field;
mod frame;
mod images;
#[cfg(test)]
mod tests;
mod wait;

pub use device::Gpu;
pub use error::GpuError;
pub use images::GpuImages;
