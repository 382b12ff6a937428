//! Aligned lines for people.

use std::path::Path;

/// Lines of a label and a value, the values in one column.
#[derive(Default)]
pub struct Lines {
    rows: Vec<(String, String)>,
}

impl Lines {
    /// Adds all lines of another one.
    pub fn extend(&mut self, others: Self) {
        self.rows.extend(others.rows);
    }

    /// Adds a line.
    pub fn add(&mut self, label: &str, value: impl ToString) {
        self.rows.push((label.to_owned(), value.to_string()));
    }

    /// All of them below a heading.
    pub fn below(&self, heading: &str) -> String {
        let width = self.rows.iter().map(|(label, _)| label.chars().count()).max().unwrap_or(0);
        let mut text = format!("{heading}\n");
        for (label, value) in &self.rows {
            let line = format!("  {label:width$}  {value}");
            text.push_str(line.trim_end());
            text.push('\n');
        }
        text
    }
}

/// Yes or no.
pub fn yes_no(answer: bool) -> &'static str {
    if answer { "yes" } else { "no" }
}

/// `1 triangle`, `2 triangles`, `1 tetrahedron`, `2 tetrahedra`.
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// The last part of a path.
pub fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// A ratio in few digits.
pub fn ratio(value: f64) -> String {
    if value.abs() < 1e4 { format!("{value:.3}") } else { format!("{value:.2e}") }
}

/// Seconds per stage in one line, the longest first.
pub fn stages(seconds: &[(&'static str, f64)]) -> String {
    let total = seconds.iter().find(|s| s.0 == "total").map_or(0.0, |s| s.1);
    let mut parts: Vec<_> = seconds.iter().filter(|s| s.0 != "total" && s.1 >= 0.005).collect();
    parts.sort_by(|a, b| b.1.total_cmp(&a.1));
    let named: Vec<String> = parts.iter().take(5).map(|(name, s)| format!("{name} {s:.2}")).collect();
    if named.is_empty() { format!("{total:.2} s") } else { format!("{total:.2} s ({})", named.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_in_a_column() {
        let mut lines = Lines::default();
        lines.add("a", 1);
        lines.add("long", "x");
        assert_eq!(lines.below("h"), "h\n  a     1\n  long  x\n");
    }
}
