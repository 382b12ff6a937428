//! How much memory this process uses, where the system says so.

/// Bytes in use now.
pub fn current_bytes() -> Option<u64> {
    status_field("VmRSS:")
}

/// The most bytes that were ever in use.
pub fn peak_bytes() -> Option<u64> {
    status_field("VmHWM:")
}

fn status_field(name: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024)
}
