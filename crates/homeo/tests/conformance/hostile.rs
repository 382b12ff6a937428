//! Damaged map files: an error or a map, never a panic.
