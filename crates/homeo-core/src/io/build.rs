//! Pieces that several readers use to fill a [`MeshFile`](super::MeshFile).

use std::sync::Arc;

use super::error::Outcome;
use super::mesh_file::{Attribute, Element, PolygonList, Values};
use super::scan::Scanner;

/// Rows of up to four numbers that may be missing, such as colours behind the vertices of OFF.
///
/// Nothing is stored before the first row that is there.
#[derive(Default)]
pub(super) struct PartialRows {
    rows: Vec<[f64; 4]>,
    skipped: usize,
    components: usize,
    is_ragged: bool,
    has_fraction: bool,
}

impl PartialRows {
    /// Adds the row of one element; `row` is empty where it has none.
    pub fn push(&mut self, row: &[f64]) {
        if row.is_empty() && self.rows.is_empty() {
            self.skipped += 1;
            return;
        }
        if self.rows.is_empty() {
            self.rows.resize(self.skipped, [f64::NAN; 4]);
            self.is_ragged = self.skipped > 0;
            self.components = row.len().min(4);
        }
        self.is_ragged |= row.len() != self.components;
        self.components = self.components.max(row.len().min(4));
        let mut padded = [f64::NAN; 4];
        padded.iter_mut().zip(row).for_each(|(to, from)| *to = *from);
        self.rows.push(padded);
    }

    /// Remembers that a number was written with a point or an exponent.
    pub fn mark_fraction(&mut self) {
        self.has_fraction = true;
    }

    /// The attribute, if any row was there: whole numbers where all are, NaN where one is missing.
    pub fn finish(self, name: &str, element: Element) -> Option<Attribute> {
        if self.rows.is_empty() {
            return None;
        }
        let entries = self.rows.iter().flat_map(|row| row[..self.components].iter().copied());
        let values = if self.has_fraction || self.is_ragged {
            Values::F64(entries.collect())
        } else {
            Values::I64(entries.map(|value| value as i64).collect())
        };
        Some(Attribute { name: name.to_string(), element, components: self.components, values })
    }
}

/// A text for each element that stays the same until changed, such as the group of OBJ.
#[derive(Default)]
pub(super) struct TextColumn {
    current: Option<Arc<str>>,
    rows: Vec<Arc<str>>,
}

impl TextColumn {
    /// The text of the elements to come, of which `count` elements are there already.
    pub fn set(&mut self, text: &[u8], count: usize) {
        self.fill(count);
        self.current = Some(String::from_utf8_lossy(text).into());
    }

    fn fill(&mut self, count: usize) {
        if let Some(current) = &self.current {
            self.rows.resize(count, current.clone());
        } else if count > 0 {
            self.rows.resize(count, Arc::from(""));
        }
    }

    /// The attribute for `count` elements, if a text was ever set.
    pub fn finish(mut self, name: &str, element: Element, count: usize) -> Option<Attribute> {
        self.current.as_ref()?;
        self.fill(count);
        let values = Values::Text(self.rows);
        Some(Attribute { name: name.to_string(), element, components: 1, values })
    }
}

/// A column of tags, unless all are 0.
pub(super) fn tags(name: &str, element: Element, tags: Vec<i64>) -> Option<Attribute> {
    let values = Values::I64(tags);
    let is_zero = matches!(&values, Values::I64(v) if v.iter().all(|&tag| tag == 0));
    (!is_zero).then(|| Attribute { name: name.to_string(), element, components: 1, values })
}

/// Reads one polygon of `count` vertex indices, each below `limit`, counted from 0.
pub(super) fn read_polygon(
    scanner: &mut Scanner<'_>,
    polygons: &mut PolygonList,
    count: u64,
    limit: usize,
) -> Outcome<()> {
    let number = polygons.len();
    if count < 3 {
        return Err(scanner.fault("too-few-corners", too_few_corners(number, count as usize)));
    }
    let count = scanner.claim(count, 2, "corners of a polygon")?;
    if polygons.corners.len() + count >= u32::MAX as usize {
        return Err(scanner.fault("too-large", "the polygons have more corners than 32 bits can number"));
    }
    for _ in 0..count {
        polygons.corners.push(scanner.index(limit, "polygon", number)?);
    }
    close_polygon(polygons);
    Ok(())
}

/// Ends the polygon whose corners were pushed last.
pub(super) fn close_polygon(polygons: &mut PolygonList) {
    if polygons.starts.is_empty() {
        polygons.starts.push(0);
    }
    polygons.starts.push(polygons.corners.len() as u32);
}

/// The sentence for a polygon of fewer than three corners.
pub(super) fn too_few_corners(number: usize, count: usize) -> String {
    format!("polygon {number} has {count} corners; it needs at least three")
}

/// The sentence for elements that are left out.
pub(super) fn left_out(count: usize, singular: &str, plural: &str) -> String {
    if count == 1 { format!("1 {singular} was left out") } else { format!("{count} {plural} were left out") }
}
