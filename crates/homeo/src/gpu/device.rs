//! A graphics processor: found, opened, given work, waited for.

use std::sync::mpsc;

use wgpu::{
    BindGroupDescriptor, BindGroupEntry, Buffer, BufferDescriptor, BufferUsages, ComputePassDescriptor,
    ComputePipeline, ComputePipelineDescriptor, Device, ErrorFilter, MapMode, PollType, Queue, ShaderModuleDescriptor,
    ShaderSource,
};

use super::error::GpuError;
use super::wait::wait;

/// How many points or pixels a work group has; the programs say the same.
const GROUP: usize = 64;
/// The most points or pixels in one pass: work groups of one dimension suffice, by far, and buffers are of tens of megabytes.
pub(super) const MOST_IN_PASS: usize = 1 << 21;

/// Buffers that a program reads.
pub(super) const READ: BufferUsages = BufferUsages::STORAGE.union(BufferUsages::COPY_DST);
/// Parameters of a program.
pub(super) const PARAMETERS: BufferUsages = BufferUsages::UNIFORM.union(BufferUsages::COPY_DST);
/// Buffers that a program changes, to be fetched from.
pub(super) const CHANGED: BufferUsages = READ.union(BufferUsages::COPY_SRC);
/// Buffers in which results arrive.
pub(super) const FETCHED: BufferUsages = BufferUsages::MAP_READ.union(BufferUsages::COPY_DST);

/// A graphics processor that is ready to compute.
///
/// ```
/// use homeo::gpu::{Gpu, GpuError};
/// match Gpu::new() {
///     Ok(gpu) => assert!(!gpu.adapter().is_empty()),
///     Err(GpuError::NoAdapter(_)) => {} // no Vulkan driver on this machine
///     Err(error) => return Err(error),
/// }
/// # Ok::<(), GpuError>(())
/// ```
#[derive(Debug)]
pub struct Gpu {
    device: Device,
    queue: Queue,
    adapter: String,
    is_software: bool,
    /// Bytes that a buffer may have.
    pub(super) most_bytes: u64,
    pub(super) images: ComputePipeline,
    pub(super) field: ComputePipeline,
}

impl Gpu {
    /// Opens the graphics processor that the Vulkan loader finds, a fast one before a software one.
    ///
    /// # Errors
    /// There is none; or it cannot be opened, or offers less than is needed.
    pub fn new() -> Result<Self, GpuError> {
        Self::with_programs(super::images::PROGRAM, super::field::PROGRAM)
    }

    /// With programs that may be others than usual: tests have wrong ones refused.
    pub(super) fn with_programs(images: &str, field: &str) -> Result<Self, GpuError> {
        let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle();
        wanted.backends = wgpu::Backends::VULKAN;
        wanted.flags = wgpu::InstanceFlags::empty();
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let found = wait(wgpu::Instance::new(wanted).request_adapter(&options))
            .map_err(|error| GpuError::NoAdapter(error.to_string()))?;
        let info = found.get_info();
        let driver = format!("{} {}", info.driver, info.driver_info);
        let adapter = format!("{} ({})", info.name, driver.trim());
        let limits = wgpu::Limits::downlevel_defaults();
        let most_bytes = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let unusable = |reason: String| GpuError::NoDevice { adapter: adapter.clone(), reason };
        let (device, queue) = wait(found.request_device(&descriptor)).map_err(|error| unusable(error.to_string()))?;
        let (made, error) = watched(&device, || [program(&device, images), program(&device, field)]);
        if let Some(reason) = error {
            return Err(unusable(reason));
        }
        let [images, field] = made;
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        Ok(Self { device, queue, adapter, is_software, most_bytes, images, field })
    }

    /// The names of the device and its driver.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    /// Whether the device is a program that runs on the processor: good for tests, no faster than the processor.
    pub fn is_software(&self) -> bool {
        self.is_software
    }

    /// Does work in which the driver may report errors.
    pub(super) fn guarded<T>(&self, work: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
        let (done, error) = watched(&self.device, work);
        match error {
            Some(reason) => Err(self.failed(reason)),
            None => done,
        }
    }

    fn failed(&self, reason: String) -> GpuError {
        GpuError::Failed { adapter: self.adapter.clone(), reason }
    }

    /// A buffer of so many bytes, four or more.
    pub(super) fn buffer(&self, bytes: u64, usage: BufferUsages) -> Buffer {
        let size = bytes.max(4);
        self.device.create_buffer(&BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    }

    /// Writes data to the front of a buffer, before the next pass.
    pub(super) fn write<T: bytemuck::NoUninit>(&self, buffer: &Buffer, data: &[T]) {
        self.queue.write_buffer(buffer, 0, bytemuck::cast_slice(data));
    }

    /// Begins a pass of a program over so many points or pixels; buffers are in the order of their numbers in the program.
    pub(super) fn start(&self, program: &ComputePipeline, buffers: &[&Buffer], count: usize) {
        let numbered = buffers.iter().enumerate();
        let entries: Vec<BindGroupEntry> = numbered
            .map(|(number, buffer)| BindGroupEntry { binding: number as u32, resource: buffer.as_entire_binding() })
            .collect();
        let layout = program.get_bind_group_layout(0);
        let group =
            self.device.create_bind_group(&BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
            pass.set_pipeline(program);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(count.div_ceil(GROUP) as u32, 1, 1);
        }
        self.queue.submit([encoder.finish()]);
    }

    /// Waits for the front of a buffer, by way of one for results, and hands it on.
    pub(super) fn fetch<T: bytemuck::AnyBitPattern>(
        &self,
        from: &Buffer,
        by: &Buffer,
        count: usize,
        receive: impl FnOnce(&[T]),
    ) -> Result<(), GpuError> {
        let bytes = (count * size_of::<T>()) as u64;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(from, 0, by, 0, bytes);
        self.queue.submit([encoder.finish()]);
        let (sender, arrived) = mpsc::channel();
        by.map_async(MapMode::Read, 0..bytes, move |result| {
            // Nobody listens only if waiting failed, which is told.
            let _ = sender.send(result);
        });
        self.device.poll(PollType::wait_indefinitely()).map_err(|error| self.failed(error.to_string()))?;
        let result = arrived.try_recv().map_err(|error| self.failed(error.to_string()))?;
        result.map_err(|error| self.failed(error.to_string()))?;
        let view = by.get_mapped_range(0..bytes).map_err(|error| self.failed(error.to_string()))?;
        let found = bytemuck::try_cast_slice(&view).map_err(|error| self.failed(error.to_string()))?;
        receive(found);
        drop(view);
        by.unmap();
        Ok(())
    }
}

fn program(device: &Device, source: &str) -> ComputePipeline {
    let source = ShaderSource::Wgsl(source.into());
    let module = device.create_shader_module(ShaderModuleDescriptor { label: None, source });
    device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    })
}

/// What comes of work, and the first error that the driver reports of it.
fn watched<T>(device: &Device, work: impl FnOnce() -> T) -> (T, Option<String>) {
    let kinds = [ErrorFilter::Internal, ErrorFilter::OutOfMemory, ErrorFilter::Validation];
    let [internal, memory, validation] = kinds.map(|kind| device.push_error_scope(kind));
    let done = work();
    let errors = [wait(validation.pop()), wait(memory.pop()), wait(internal.pop())];
    (done, errors.into_iter().flatten().next().map(|error| error.to_string()))
}
