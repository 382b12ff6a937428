//! What can go wrong on a graphics processor.

/// Why a graphics processor gave no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// The loader finds no Vulkan driver with a device.
    #[error("no graphics processor was found ({0}); install a Vulkan driver, or compute without one")]
    NoAdapter(String),
    /// A device was found, but it cannot be used.
    #[error("{adapter} cannot be used: {reason}; choose another Vulkan driver, or compute without one")]
    NoDevice {
        /// The device's name.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// The driver refused or gave up a computation: most often memory is short.
    #[error("{adapter} gave up: {reason}; give fewer points or a smaller picture at a time, or compute without it")]
    Failed {
        /// The device's name.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// One domain of a map does not fit into a buffer of the device.
    #[error(
        "a domain with {vertices} vertices needs {bytes} bytes on the device, which takes {most}; compute without it"
    )]
    DomainTooLarge {
        /// How many vertices it has.
        vertices: usize,
        /// Bytes needed.
        bytes: u64,
        /// Bytes that a buffer may have.
        most: u64,
    },
    /// A picture's samples are not as many as its size says, or it has no pixels or too many channels.
    #[error(
        "a picture of {width} x {height} pixels with {channels} channels has {samples} samples; \
         it must have width times height times channels of them, at least one, and 1 to 4 channels"
    )]
    Picture {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// Samples of a pixel.
        channels: usize,
        /// Samples that there are.
        samples: usize,
    },
}
