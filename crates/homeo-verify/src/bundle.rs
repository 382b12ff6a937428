//! Rules T1-T8: a closed tetrahedral mesh is the unit tangent bundle of a closed surface, as a bundle of circles; T9 and T10: a
//! section of it over the edges of the surface, with its indices.
//!
//! *Theorem.* Over a closed oriented triangulated surface let the slopes be antisymmetric, and add up to -1 or -2 round each
//! triangle. Then the tetrahedra that belong to them are a circle bundle, and its Euler number is the number of sums -1 less that
//! of sums -2, divided by `2 N`. Where it is the Euler characteristic, the bundle is isomorphic to that of the unit tangent
//! vectors. (Proof: `docs/theory/bundles.md`.)

mod data;
mod section;

use crate::complex::Complex;
use crate::links::{Shape, check_manifold};
use crate::verdict::{Checked, check, decidable};
pub(crate) use data::BundleData;

/// Applies the rules and counts what was checked.
pub(crate) fn check_bundle(data: &BundleData) -> Checked<Vec<(&'static str, u64)>> {
    let (layers, triangles) = (u64::from(data.layers), data.triangles.len());
    check(layers >= 3, "T1", "fibres have fewer than three edges", &[], &[])?;
    let vertices = data.vertex_count as u64 * layers;
    decidable(vertices < u64::from(u32::MAX), "the bundle has more than 2^32 - 2 vertices", "fewer layers")?;
    let base = Complex::new(3, data.triangles.as_flattened().to_vec(), data.vertex_count, ["T1", "T2"])?;
    let characteristic = check_base(&base)?;
    check_slopes(data, &base)?;
    check_euler_number(data, characteristic)?;
    check_tetrahedra(data)?;
    let total = Complex::new(4, data.tetrahedra.as_flattened().to_vec(), vertices as usize, ["T6", "T6"])?;
    check_total(&total)?;
    check_fibres(data, vertices as usize)?;
    let mut checked = vec![
        ("base vertices with cyclic links (rules T1, T2)", data.vertex_count as u64),
        ("base triangles, oriented and connected (rules T1, T2)", triangles as u64),
        ("walls with slopes that agree (rule T3)", 3 * triangles as u64 / 2),
        ("triangles with slopes that add up to -1 or -2 (rule T4)", triangles as u64),
        ("tetrahedra that the slopes say, each once (rule T5)", data.tetrahedra.len() as u64),
        ("faces with two tetrahedra on opposite sides (rule T6)", 2 * data.tetrahedra.len() as u64),
        ("vertices with spheres as links (rule T7)", vertices),
        ("closed fibres, disjoint, of edges of the mesh (rule T8)", data.vertex_count as u64),
    ];
    if let Some(stored) = &data.section {
        checked.extend(section::check_section(data, stored, &base, characteristic)?);
    }
    Ok(checked)
}

/// Rule T2: the base is a closed, connected, oriented surface; its Euler characteristic.
fn check_base(base: &Complex) -> Checked<i64> {
    if let Some(slot) = base.boundary_slots().next() {
        return check(false, "T2", "the base is not closed", &[slot / 3], &base.facet(slot)).map(|()| 0);
    }
    base.check_sides("T2", |_, _| true, |_| true)?;
    let is_used = base.vertices_of(base.cells());
    if let Some(vertex) = is_used.iter().position(|is_used| !is_used) {
        return check(false, "T2", "a vertex of the base is in no triangle", &[], &[vertex as u32]).map(|()| 0);
    }
    let shape = check_manifold(base, "base", "T2")?;
    check(shape.components == 1, "T2", &format!("the base has {} components", shape.components), &[], &[])?;
    Ok(shape.euler)
}

/// Rule T3: slopes are below the number of layers, and those of a wall from its two sides add up to -1.
fn check_slopes(data: &BundleData, base: &Complex) -> Checked {
    for (triangle, slopes) in data.slopes.iter().enumerate() {
        check(slopes.iter().all(|&m| m < data.layers), "T3", "a slope is not below the layers", &[triangle], &[])?;
    }
    // The side after corner k is the facet opposite corner k + 2.
    let slope = |slot: usize| u64::from(data.slopes[slot / 3][(slot % 3 + 1) % 3]);
    for (a, b) in base.inner_facets() {
        let is_one_wall = (slope(a) + slope(b) + 1).is_multiple_of(u64::from(data.layers));
        check(is_one_wall, "T3", "slopes of a wall from its two sides disagree", &[a / 3, b / 3], &base.facet(a))?;
    }
    Ok(())
}

/// Rule T4: slopes add up to -1 or -2 round each triangle, and to the Euler characteristic in all.
fn check_euler_number(data: &BundleData, characteristic: i64) -> Checked {
    let layers = u64::from(data.layers);
    let mut halves = 0_i64;
    for (triangle, slopes) in data.slopes.iter().enumerate() {
        let sum = slopes.iter().map(|&m| u64::from(m)).sum::<u64>() % layers;
        let is_bundle = sum + 1 == layers || sum + 2 == layers;
        check(is_bundle, "T4", &format!("slopes add up to {sum} modulo {layers}"), &[triangle], &[])?;
        halves += if sum + 1 == layers { 1 } else { -1 };
    }
    // A bundle by T3, so the division leaves nothing.
    let message = format!("the Euler number is {} / {}, not {characteristic}", halves, 2 * layers);
    check(halves == 2 * i64::from(data.layers) * characteristic, "T4", &message, &[], &[])
}

/// Rule T5: the tetrahedra over each triangle are those that the slopes say, positively oriented.
fn check_tetrahedra(data: &BundleData) -> Checked {
    let each = 3 * data.layers as usize;
    let is_right = data.tetrahedra.len() == each * data.triangles.len();
    check(is_right, "T5", "there are not 3 N tetrahedra for each triangle", &[], &[])?;
    let mut is_there = vec![false; each];
    for (triangle, tetrahedra) in data.tetrahedra.chunks_exact(each).enumerate() {
        is_there.fill(false);
        for (number, tetrahedron) in tetrahedra.iter().enumerate() {
            let place = place_over(data, triangle, *tetrahedron);
            let is_new = place.is_some_and(|place| !std::mem::replace(&mut is_there[place], true));
            let message =
                format!("a tetrahedron over triangle {triangle} is not one that the slopes say, or is there twice");
            check(is_new, "T5", &message, &[triangle * each + number], tetrahedron)?;
        }
    }
    Ok(())
}

/// The place of a tetrahedron among those over a triangle: `N k + j` if it has the levels `j` and `j + 1` of corner `k`; nothing
/// if it is none of them.
///
/// With the corners u, v, w from corner `k` on, and slopes m of uv and n of wu, level `j + m + 1` of v alone is joined with both levels of
/// u, and so is level `j - n` of w.
fn place_over(data: &BundleData, triangle: usize, tetrahedron: [u32; 4]) -> Option<usize> {
    let layers = data.layers;
    let on = |k: usize, level: u32| {
        let vertex = data.triangles[triangle][k % 3] * layers + level % layers;
        tetrahedron.iter().position(|&other| other == vertex)
    };
    let sum = |terms: [u32; 3]| (terms.iter().map(|&x| u64::from(x)).sum::<u64>() % u64::from(layers)) as u32;
    for k in 0..3 {
        for &vertex in tetrahedron.iter().filter(|&&vertex| vertex / layers == data.triangles[triangle][k]) {
            let level = vertex % layers;
            let second = sum([level, data.slopes[triangle][k], 1]);
            let third = sum([level, layers, layers - data.slopes[triangle][(k + 2) % 3]]);
            let corners = (on(k, level), on(k, level + 1), on(k + 1, second), on(k + 2, third));
            if let (Some(a), Some(b), Some(c), Some(d)) = corners {
                return is_even([a, b, c, d]).then_some(k * layers as usize + level as usize);
            }
        }
    }
    None
}

fn is_even(order: [usize; 4]) -> bool {
    let inversions = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j))).filter(|&(i, j)| order[i] > order[j]).count();
    inversions.is_multiple_of(2)
}

/// Rules T6 and T7, from the list of tetrahedra alone: a closed, connected, oriented 3-manifold.
fn check_total(total: &Complex) -> Checked {
    if let Some(slot) = total.boundary_slots().next() {
        return check(false, "T6", "a face has one tetrahedron only", &[slot / 4], &total.facet(slot));
    }
    total.check_sides("T6", |_, _| true, |_| true)?;
    let found = check_manifold(total, "bundle", "T7")?;
    let expected = Shape { components: 1, euler: 0, boundaries: 0 };
    check(found == expected, "T7", &format!("the bundle has {found:?} instead of {expected:?}"), &[], &[])
}

/// Rule T8: each fibre is a closed path of edges of the tetrahedra. Fibres have no vertex in common by their numbers.
fn check_fibres(data: &BundleData, vertices: usize) -> Checked {
    let layers = data.layers;
    let mut is_joined = vec![false; vertices];
    for tetrahedron in &data.tetrahedra {
        for (a, b) in tetrahedron.iter().flat_map(|a| tetrahedron.iter().map(move |b| (*a, *b))) {
            if a / layers == b / layers && b % layers == (a + 1) % layers {
                is_joined[a as usize] = true;
            }
        }
    }
    match is_joined.iter().position(|is_joined| !is_joined) {
        None => Ok(()),
        Some(vertex) => check(false, "T8", "a vertex is not joined with the next of its fibre", &[], &[vertex as u32]),
    }
}

/// T6 to T8 hold where T1 to T5 do, so no file can fail them alone: their negative controls are here.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::Stop;

    fn rule(checked: Checked) -> Option<&'static str> {
        match checked {
            Err(Stop::Refuted(witness)) => Some(witness.rule),
            _ => None,
        }
    }

    fn rule_of_total(tetrahedra: &[[u32; 4]]) -> Option<&'static str> {
        let vertices = tetrahedra.iter().flatten().max().map_or(0, |&most| most as usize + 1);
        let total = Complex::new(4, tetrahedra.as_flattened().to_vec(), vertices, ["T6", "T6"]);
        rule(total.and_then(|total| check_total(&total)))
    }

    /// The boundary of a simplex of four dimensions, oriented.
    const SPHERE: [[u32; 4]; 5] = [[1, 2, 3, 4], [0, 2, 4, 3], [0, 1, 3, 4], [0, 1, 4, 2], [0, 1, 2, 3]];

    #[test]
    fn lists_that_are_no_closed_oriented_manifold_are_refuted() {
        assert_eq!(rule_of_total(&SPHERE), None);
        assert_eq!(rule_of_total(&SPHERE[1..]), Some("T6"), "open");
        let mut turned = SPHERE;
        turned[2].swap(0, 1);
        assert_eq!(rule_of_total(&turned), Some("T6"), "one is turned over");
        assert_eq!(rule_of_total(&[SPHERE.as_slice(), &SPHERE[..1]].concat()), Some("T6"), "one twice");
        let apart = SPHERE.map(|corners| corners.map(|v| v + 5));
        assert_eq!(rule_of_total(&[SPHERE, apart].concat()), Some("T7"), "two pieces");
        let pinched = SPHERE.map(|corners| corners.map(|v| if v == 0 { 0 } else { v + 4 }));
        assert_eq!(rule_of_total(&[SPHERE, pinched].concat()), Some("T7"), "two spheres at one vertex");
        // The suspension of a torus of 3 by 3 squares: two links are tori.
        let at = |i: u32, j: u32| i % 3 * 3 + j % 3;
        let squares = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
        let torus = squares.flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        });
        let suspension: Vec<_> = torus.flat_map(|[a, b, c]| [[a, b, c, 9], [a, c, b, 10]]).collect();
        assert_eq!(rule_of_total(&suspension), Some("T7"), "links that are tori");
    }

    #[test]
    fn fibres_with_a_gap_are_refuted() {
        let data = |tetrahedra: Vec<[u32; 4]>| BundleData {
            vertex_count: 1,
            triangles: vec![],
            layers: 5,
            slopes: vec![],
            tetrahedra,
            section: None,
        };
        assert_eq!(rule(check_fibres(&data(SPHERE.to_vec()), 5)), None);
        // Nothing joins 3 with 4.
        let gap = vec![[4, 0, 1, 2], [0, 1, 2, 3]];
        assert_eq!(rule(check_fibres(&data(gap), 5)), Some("T8"));
    }
}
