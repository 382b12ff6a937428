//! How much of each triangle lies over which other one.

use std::collections::BTreeMap;

use homeo_core::number::{Lazy, Scalar};

use super::for_each_cell;
use crate::map::Shell;
use crate::progress::Progress;

/// A triangle of the source and one of the section with an area in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Share {
    /// The triangle of the source.
    pub source: u32,
    /// The triangle of the section.
    pub section: u32,
    /// The common area as a part of the triangle of the source, exactly; these add up to 1 for each triangle.
    pub of_source: Lazy,
    /// The common area as a part of the triangle of the section, exactly; these add up to 1 for each triangle.
    pub of_section: Lazy,
}

/// All pairs of triangles with an area in common, by section triangle and then by source triangle; `None` when stopped.
///
/// The shares of every triangle add up to exactly 1, so what is moved by them is neither lost nor doubled.
///
/// # Complexity
/// That of the [overlay](super::for_each_cell).
pub fn shares(shell: &Shell, progress: &(dyn Progress + Sync)) -> Option<Vec<Share>> {
    let mut found: BTreeMap<[u32; 2], [Lazy; 2]> = BTreeMap::new();
    let is_complete = for_each_cell(shell, progress, |cell| {
        let none = || [0.0; 2].map(Lazy::from_f64);
        let [a, b] = found.entry([cell.section, cell.source]).or_insert_with(none);
        (*a, *b) = (a.plus(&cell.share_of_source()), b.plus(&cell.share_of_section()));
    });
    let share = |([section, source], [of_source, of_section]): ([u32; 2], [Lazy; 2])| Share {
        source,
        section,
        of_source,
        of_section,
    };
    is_complete.then(|| found.into_iter().map(share).collect())
}
