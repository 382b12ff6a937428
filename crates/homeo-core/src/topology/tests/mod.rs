//! Tests of the analysis by class of mesh.

mod data;
mod invalid_files;
mod plain_readers;
mod random;
mod shapes;
mod surfaces;
mod volumes;

use super::Violation;

/// The codes of violations, in order.
fn codes(violations: &[Violation]) -> Vec<&'static str> {
    violations.iter().map(|violation| violation.code).collect()
}

/// The violation with a code.
fn find<'a>(violations: &'a [Violation], code: &str) -> &'a Violation {
    let found = violations.iter().find(|violation| violation.code == code);
    found.unwrap_or_else(|| panic!("no {code} in {violations:?}"))
}
