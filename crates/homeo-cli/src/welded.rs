//! What merging vertices did, for people and for programs.

use homeo_core::io::WeldReport;
use serde_json::{Value, json};

use crate::text::counted;

/// How many elements are listed.
const MOST_LISTED: usize = 10;

/// One sentence for each thing that happened; the first says how many vertices were merged.
pub fn sentences(report: &WeldReport) -> Vec<String> {
    let mut sentences = vec![merged(report)];
    for lost in &report.differing {
        let [kept, merged] = lost.first;
        let count = counted(lost.vertices, "merged vertex", "merged vertices");
        sentences.push(format!(
            "attribute \"{}\": {count} had other values than the vertex kept (first: {merged}, merged into {kept}); \
             those values are lost",
            lost.name
        ));
    }
    let collapsed = [
        (&report.collapsed_polygons, "polygon names", "polygons name"),
        (&report.collapsed_tetrahedra, "tetrahedron names", "tetrahedra name"),
    ];
    for (elements, one, many) in collapsed.into_iter().filter(|(elements, ..)| !elements.is_empty()) {
        let first = listed(elements.len(), elements.iter().map(u32::to_string));
        sentences.push(format!("by this {} a vertex twice ({first})", counted(elements.len(), one, many)));
    }
    sentences
}

fn merged(report: &WeldReport) -> String {
    if report.merged == 0 {
        return "no vertices were merged: no two that elements use are at the same point".to_owned();
    }
    let pairs = report.examples.iter().map(|[kept, merged]| format!("{merged} into {kept}"));
    let count = counted(report.merged, "vertex was", "vertices were");
    format!("{count} merged into an earlier one at the same point ({})", listed(report.merged, pairs))
}

/// The first three names of `count`.
fn listed(count: usize, names: impl Iterator<Item = String>) -> String {
    let first: Vec<String> = names.take(3).collect();
    let more = if count > first.len() { ", ..." } else { "" };
    format!("{}{more}", first.join(", "))
}

/// The field `welded` of JSON objects.
pub fn described(report: &WeldReport) -> Value {
    let differing = report.differing.iter();
    let differing = differing.map(|lost| json!({"name": lost.name, "vertices": lost.vertices, "first": lost.first}));
    let collapsed =
        |elements: &[u32]| json!({"count": elements.len(), "elements": elements[..elements.len().min(MOST_LISTED)]});
    json!({
        "merged": report.merged,
        "examples": report.examples,
        "differing_attributes": differing.collect::<Vec<_>>(),
        "collapsed_polygons": collapsed(&report.collapsed_polygons),
        "collapsed_tetrahedra": collapsed(&report.collapsed_tetrahedra),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use homeo_core::io::DifferingAttribute;

    #[test]
    fn everything_that_happened_has_a_sentence() {
        assert_eq!(sentences(&WeldReport::default()).len(), 1);
        let report = WeldReport {
            merged: 4,
            examples: vec![[0, 5], [1, 6], [2, 7], [2, 8]],
            differing: vec![DifferingAttribute { name: "uv".to_owned(), vertices: 1, first: [1, 6] }],
            collapsed_polygons: (3..15).collect(),
            collapsed_tetrahedra: vec![9],
            ..WeldReport::default()
        };
        let said = [
            "4 vertices were merged into an earlier one at the same point (5 into 0, 6 into 1, 7 into 2, ...)",
            "attribute \"uv\": 1 merged vertex had other values than the vertex kept (first: 6, merged into 1); those \
             values are lost",
            "by this 12 polygons name a vertex twice (3, 4, 5, ...)",
            "by this 1 tetrahedron names a vertex twice (9)",
        ];
        assert_eq!(sentences(&report), said);
        let described = described(&report);
        assert_eq!(described["collapsed_polygons"]["elements"].as_array().map(Vec::len), Some(10));
        assert_eq!(described["differing_attributes"][0]["name"], "uv");
    }
}
