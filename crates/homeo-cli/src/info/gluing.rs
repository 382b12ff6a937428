//! Gluings of tetrahedra (truncated hyperbolic ones, say): counts, and whether the faces are paired.

use std::path::Path;

use homeo::progress::Progress;
use serde_json::{Value, json};

use super::{violation, violations_text};
use crate::answer::Answer;
use crate::failure::Result;
use crate::session::Session;
use crate::text::{Lines, counted};

/// Whether this looks like one gluing, or a file of them.
pub fn is_gluing(value: &Value) -> bool {
    value.get("gluings").is_some() || value.get("triangulation").is_some() || value.get("triangulations").is_some()
}

/// Describes them.
pub fn describe(session: &Session, value: &Value, path: &Path) -> Result<Answer> {
    session.stage("check");
    let records: Vec<&Value> = match (value.get("triangulations").and_then(Value::as_array), value.get("triangulation"))
    {
        (Some(list), _) => list.iter().collect(),
        (None, Some(one)) => vec![one],
        (None, None) => vec![value],
    };
    let (mut tetrahedra, mut free, mut bad) = (0, 0, Vec::new());
    for (index, record) in records.iter().enumerate() {
        match count_faces(record) {
            Some((count, open)) => {
                tetrahedra += count;
                free += open;
            }
            None => bad.push(index as u32),
        }
    }
    let mut violations = Vec::new();
    if !bad.is_empty() {
        let message = format!(
            "{} ({}): faces must be glued in pairs, [tetrahedron, face, other tetrahedron, [images of vertices]], both ways",
            counted(bad.len(), "gluing is broken", "gluings are broken"),
            bad.iter().take(3).map(u32::to_string).collect::<Vec<_>>().join(", ")
        );
        violations.push(violation(
            "broken-gluing",
            "error",
            "record",
            bad.iter().take(10).copied().collect(),
            bad.len(),
            message,
        ));
    }
    session.end_stage();
    let mut lines = Lines::default();
    lines.add("tetrahedra", tetrahedra);
    lines.add("free faces", free);
    let head = format!("{}: {} of tetrahedra", path.display(), counted(records.len(), "gluing", "gluings"));
    let text = lines.below(&head) + &violations_text(&violations);
    let fields = json!({
        "kind": "gluing", "gluings": records.len(), "tetrahedra": tetrahedra, "free_faces": free,
        "schema": value.get("schema"), "name": value.get("name"), "violations": violations,
        "input": {"path": path.display().to_string(), "tetrahedra": tetrahedra},
    });
    Ok(Answer::new(fields, text))
}

/// Tetrahedra and free faces of a record; `None` where the gluing contradicts itself.
fn count_faces(record: &Value) -> Option<(usize, usize)> {
    let count = usize::try_from(record.get("tetrahedra")?.as_u64()?).ok()?;
    let entries = record.get("gluings")?.as_array()?;
    if count == 0 || entries.len() > count.checked_mul(4)? {
        return None;
    }
    let mut known = std::collections::BTreeMap::new();
    for entry in entries {
        let (face, image) = one_face(entry, count)?;
        if known.insert(face, image).is_some() {
            return None;
        }
    }
    for (&(tetrahedron, face), &(there, images)) in &known {
        let back = known.get(&(there, images[face]))?;
        let is_inverse = (0..4).all(|v| back.1[images[v]] == v) && back.0 == tetrahedron;
        if !is_inverse || (there, images[face]) == (tetrahedron, face) {
            return None;
        }
    }
    Some((count, 4 * count - known.len()))
}

type Face = (usize, usize);

fn one_face(entry: &Value, count: usize) -> Option<(Face, (usize, [usize; 4]))> {
    let number =
        |value: &Value, below: usize| value.as_u64().and_then(|n| usize::try_from(n).ok()).filter(|&n| n < below);
    let [tetrahedron, face, there, images] = entry.as_array()?.as_slice() else { return None };
    let images: Vec<usize> = images.as_array()?.iter().map(|v| number(v, 4)).collect::<Option<_>>()?;
    let images: [usize; 4] = images.try_into().ok()?;
    let is_permutation = (0..4).all(|v| images.contains(&v));
    let face = (number(tetrahedron, count)?, number(face, 4)?);
    is_permutation.then_some((face, (number(there, count)?, images)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_must_be_mutual() {
        let good = json!({"tetrahedra": 1, "gluings": [[0, 0, 0, [1, 0, 2, 3]], [0, 1, 0, [1, 0, 2, 3]]]});
        assert_eq!(count_faces(&good), Some((1, 2)));
        let lonely = json!({"tetrahedra": 1, "gluings": [[0, 0, 0, [1, 0, 2, 3]]]});
        assert_eq!(count_faces(&lonely), None);
        let twisted = json!({"tetrahedra": 1, "gluings": [[0, 0, 0, [1, 2, 0, 3]], [0, 1, 0, [1, 0, 2, 3]]]});
        assert_eq!(count_faces(&twisted), None);
        let alone = json!({"tetrahedra": 1, "gluings": [[0, 0, 0, [0, 2, 1, 3]]]});
        assert_eq!(count_faces(&alone), None);
    }
}
