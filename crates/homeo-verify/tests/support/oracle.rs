//! The definition of a valid map, checked naively: all pairs, all faces, recursion on links, rational numbers.
//!
//! Where the checker counts (volumes, degrees, Euler numbers of links) this compares cells with cells instead.

use super::{Map, write};
use dashu_ratio::RBig;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

type Face = BTreeSet<u32>;
type Vector = Vec<RBig>;

/// Whether a map is valid, and has the counts and the hash that its manifest states.
pub fn is_valid(map: &Map) -> bool {
    manifest_is_right(map) && shapes_match(map) && source_is_right(map) && refinement_is_right(map) && {
        if map.text("kind") == "foliation" { foliation_is_right(map) } else { linear_map_is_right(map) }
    }
}

fn manifest_is_right(map: &Map) -> bool {
    let m = &map.manifest;
    let known = ["format", "version", "kind", "dimension", "target", "centre", "source", "length_unit", "construction"];
    let (Some(top), target) = (m.as_object(), map.text("target")) else { return false };
    let radial = target == "disk" || target == "ball";
    let centre_is_right = match &m["centre"] {
        Value::Object(centre) => {
            radial
                && centre.len() == 2
                && centre.get("cell").is_some_and(Value::is_u64)
                && centre.get("length").and_then(Value::as_u64).is_some_and(|r| (1..1 << 32).contains(&r))
        }
        other => other.is_null() && !radial && top.contains_key("centre"),
    };
    top.keys().all(|key| known.contains(&key.as_str()) || key.starts_with("note_"))
        && m["format"] == "homeo"
        && m["version"].as_u64() == Some(1)
        && m["dimension"].as_u64() == Some(map.size() as u64 - 1)
        && ["square", "disk", "cube", "ball"].contains(&target.as_str())
        && (m["kind"] == "foliation" || m["kind"] == "piecewise-linear" && !radial)
        && centre_is_right
        && m["source"]["vertices"].as_u64() == Some(map.positions.len() as u64)
        && m["source"]["cells"].as_u64() == Some(map.source_cells.len() as u64)
        && m["source"]["content_sha256"] == write::content_hash(map)
}

fn shapes_match(map: &Map) -> bool {
    let refinement = map
        .refinement
        .as_ref()
        .is_none_or(|r| r.carrier_vertices.len() == r.carrier_weights.len() && r.cells.len() == r.parents.len());
    refinement
        && if map.text("kind") == "foliation" {
            map.directions.len() == map.cells().len()
                && map.lengths.len() == map.cells().len()
                && map.section_vertices.len() == map.section_coordinates.len()
        } else {
            map.target_positions.len() == map.vertex_count()
        }
}

// Geometry.

fn exact(numbers: &[f64]) -> Option<Vector> {
    numbers.iter().map(|&x| RBig::try_from(x).ok()).collect()
}

fn minus(a: &[RBig], b: &[RBig]) -> Vector {
    a.iter().zip(b).map(|(x, y)| x - y).collect()
}

fn dot(a: &[RBig], b: &[RBig]) -> RBig {
    sum(a.iter().zip(b).map(|(x, y)| x * y))
}

fn sum(numbers: impl Iterator<Item = RBig>) -> RBig {
    numbers.fold(RBig::ZERO, |a, b| a + b)
}

/// By elimination.
fn determinant(mut rows: Vec<Vector>) -> RBig {
    let mut product = RBig::ONE;
    for k in 0..rows.len() {
        let Some(pivot) = (k..rows.len()).find(|&i| rows[i][k] != RBig::ZERO) else { return RBig::ZERO };
        if pivot != k {
            rows.swap(pivot, k);
            product = -product;
        }
        product *= &rows[k][k];
        for i in k + 1..rows.len() {
            let factor = &rows[i][k] / &rows[k][k];
            rows[i] = (0..rows.len()).map(|j| &rows[i][j] - &factor * &rows[k][j]).collect();
        }
    }
    product
}

/// Signed volume of a simplex, times the factorial of the dimension.
fn volume(points: &[Vector]) -> RBig {
    determinant(points[1..].iter().map(|p| minus(p, &points[0])).collect())
}

fn cross(a: &[RBig], b: &[RBig]) -> Vector {
    (0..3).map(|i| &a[(i + 1) % 3] * &b[(i + 2) % 3] - &a[(i + 2) % 3] * &b[(i + 1) % 3]).collect()
}

fn edges(points: &[Vector]) -> Vec<Vector> {
    (0..points.len()).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| minus(&points[i], &points[j])).collect()
}

/// Whether two simplices have no inner point in common: some plane separates them.
fn are_apart(a: &[Vector], b: &[Vector]) -> bool {
    let separates = |normal: Vector| {
        let heights = |points: &[Vector]| {
            let all: Vec<RBig> = points.iter().map(|p| dot(&normal, p)).collect();
            (all.iter().min().cloned(), all.iter().max().cloned())
        };
        let ((low, high), (other_low, other_high)) = (heights(a), heights(b));
        low != high && (high <= other_low || other_high <= low)
    };
    let dimension = a[0].len();
    let axis = |k: usize| (0..dimension).map(|i| RBig::from(u8::from(i == k))).collect::<Vector>();
    if (0..dimension).any(|k| separates(axis(k))) {
        return true;
    }
    let (first, second) = (edges(a), edges(b));
    if dimension == 2 {
        return first.iter().chain(&second).any(|e| separates(vec![-&e[1], e[0].clone()]));
    }
    let pairs = |x: &[Vector], y: &[Vector]| x.iter().any(|e| y.iter().any(|f| separates(cross(e, f))));
    pairs(&first, &first) || pairs(&second, &second) || pairs(&first, &second)
}

/// Whether simplices fill a set of the given volume without overlap.
fn fill_without_overlap(simplices: &[Vec<Vector>], total: &RBig) -> bool {
    let volumes: Vec<RBig> = simplices.iter().map(|s| volume(s)).collect();
    let sizes = volumes.iter().map(|v| if *v < RBig::ZERO { -v } else { v.clone() });
    volumes.iter().all(|v| *v != RBig::ZERO)
        && sum(sizes) == *total
        && (0..simplices.len()).all(|i| (0..i).all(|j| are_apart(&simplices[i], &simplices[j])))
}

// Topology.

fn without(cell: &[u32], v: u32) -> Vec<u32> {
    cell.iter().copied().filter(|&w| w != v).collect()
}

pub fn cells_at_facets(cells: &[Vec<u32>]) -> BTreeMap<Face, Vec<usize>> {
    let mut map: BTreeMap<Face, Vec<usize>> = BTreeMap::new();
    for (c, cell) in cells.iter().enumerate() {
        cell.iter().for_each(|&v| map.entry(without(cell, v).into_iter().collect()).or_default().push(c));
    }
    map
}

fn euler_number(cells: &[Vec<u32>]) -> i64 {
    let mut faces = BTreeSet::new();
    for cell in cells {
        for subset in 1u32..1 << cell.len() {
            faces.insert((0..cell.len()).filter(|i| subset >> i & 1 == 1).map(|i| cell[i]).collect::<Face>());
        }
    }
    faces.iter().map(|face| if face.len() % 2 == 1 { 1 } else { -1 }).sum()
}

fn component_count(cells: &[Vec<u32>]) -> usize {
    let mut label: Vec<usize> = (0..cells.len()).collect();
    for i in 0..cells.len() {
        for j in 0..i {
            if label[i] != label[j] && cells[i].iter().any(|v| cells[j].contains(v)) {
                let (from, to) = (label[i], label[j]);
                label.iter_mut().filter(|l| **l == from).for_each(|l| *l = to);
            }
        }
    }
    label.into_iter().collect::<BTreeSet<_>>().len()
}

/// Components, Euler number and boundary components, if the complex is a manifold: by links of links.
pub fn manifold_type(cells: &[Vec<u32>]) -> Option<(usize, i64, usize)> {
    let Some(size) = cells.first().map(Vec::len) else { return Some((0, 0, 0)) };
    let sets: BTreeSet<Face> = cells.iter().map(|cell| cell.iter().copied().collect()).collect();
    if sets.len() != cells.len() || sets.iter().any(|set| set.len() != size) {
        return None;
    }
    if size == 1 {
        return Some((cells.len(), cells.len() as i64, 0));
    }
    for v in cells.iter().flatten().copied().collect::<BTreeSet<u32>>() {
        let link: Vec<Vec<u32>> = cells.iter().filter(|cell| cell.contains(&v)).map(|cell| without(cell, v)).collect();
        let found = manifold_type(&link)?;
        let spheres_and_balls = match size {
            2 => [(2, 2, 0), (1, 1, 0)], // two points, one point
            3 => [(1, 0, 0), (1, 1, 2)], // circle, arc
            _ => [(1, 2, 0), (1, 1, 1)], // sphere, disk
        };
        let is_right = spheres_and_balls.contains(&found);
        if !is_right {
            return None;
        }
    }
    let boundary: Vec<Vec<u32>> = cells_at_facets(cells)
        .into_iter()
        .filter(|(_, c)| c.len() == 1)
        .map(|(f, _)| f.into_iter().collect())
        .collect();
    let boundaries = if size == 2 { boundary.len() } else { component_count(&boundary) };
    Some((component_count(cells), euler_number(cells), boundaries))
}

// The rules.

fn points_of(map: &Map, cell: &[u32]) -> Option<Vec<Vector>> {
    cell.iter().map(|&v| exact(map.positions.get(v as usize)?)).collect()
}

fn source_is_right(map: &Map) -> bool {
    let Some(simplices) = map.source_cells.iter().map(|cell| points_of(map, cell)).collect::<Option<Vec<_>>>() else {
        return false;
    };
    if map.positions.iter().flatten().any(|x| !x.is_finite()) || manifold_type(&map.source_cells) != Some((1, 1, 1)) {
        return false;
    }
    let facets = cells_at_facets(&map.source_cells);
    if map.size() == 3 {
        let has_area =
            |p: &Vec<Vector>| cross(&minus(&p[1], &p[0]), &minus(&p[2], &p[0])).iter().any(|x| *x != RBig::ZERO);
        return simplices.iter().all(has_area);
    }
    let boundary: Vec<Vec<u32>> =
        facets.iter().filter(|(_, c)| c.len() == 1).map(|(f, _)| f.iter().copied().collect()).collect();
    let opposite_sides = facets.iter().filter(|(_, c)| c.len() == 2).all(|(facet, c)| {
        let side = |cell: &Vec<u32>| {
            let apex = cell.iter().find(|v| !facet.contains(v)).copied();
            let order: Vec<u32> = facet.iter().copied().chain(apex).collect();
            points_of(map, &order).map(|p| volume(&p) > RBig::ZERO)
        };
        side(&map.source_cells[c[0]]) != side(&map.source_cells[c[1]])
    });
    simplices.iter().all(|p| volume(p) > RBig::ZERO) && opposite_sides && euler_number(&boundary) == 2
}

fn refinement_is_right(map: &Map) -> bool {
    let (Some(r), size) = (&map.refinement, map.size()) else { return true };
    let mut carriers: Vec<BTreeMap<u32, i64>> =
        (0..map.positions.len() as u32).map(|v| BTreeMap::from([(v, 1)])).collect();
    for (vertices, weights) in r.carrier_vertices.iter().zip(&r.carrier_weights) {
        let present: BTreeMap<u32, i64> =
            vertices.iter().copied().zip(weights.iter().copied()).filter(|&(_, w)| w > 0).collect();
        let positive = weights.iter().filter(|w| **w > 0).count();
        let in_range = vertices.iter().all(|v| (*v as usize) < map.positions.len());
        if weights.iter().any(|w| *w < 0) || present.is_empty() || positive != present.len() || !in_range {
            return false;
        }
        carriers.push(present);
    }
    let row = |parent: &[u32], v: u32| -> Option<Vector> {
        let carrier = carriers.get(v as usize)?;
        let total: RBig = sum(carrier.values().map(|&w| RBig::from(w)));
        let inside = carrier.keys().all(|v| parent.contains(v));
        inside.then(|| parent.iter().map(|v| RBig::from(*carrier.get(v).unwrap_or(&0)) / &total).collect())
    };
    let mut children: Vec<Vec<Vec<Vector>>> = vec![vec![]; map.source_cells.len()];
    for (cell, &parent) in r.cells.iter().zip(&r.parents) {
        let Some(parent_cell) = map.source_cells.get(parent as usize) else { return false };
        let Some(rows) = cell.iter().map(|&v| row(parent_cell, v)).collect::<Option<Vec<Vector>>>() else {
            return false;
        };
        if determinant(rows.clone()) <= RBig::ZERO {
            return false;
        }
        children[parent as usize].push(rows.iter().map(|row| row[1..].to_vec()).collect());
    }
    let distinct: BTreeSet<Face> = r.cells.iter().map(|cell| cell.iter().copied().collect()).collect();
    let source_boundary: Vec<Face> =
        cells_at_facets(&map.source_cells).into_iter().filter(|(_, c)| c.len() == 1).map(|(f, _)| f).collect();
    let facet_is_right = |(facet, cells): (Face, Vec<usize>)| {
        let support: Face = facet.iter().flat_map(|&v| carriers[v as usize].keys().copied()).collect();
        let on_boundary = source_boundary.iter().any(|f| support.is_subset(f));
        cells.len() == if on_boundary { 1 } else { 2 }
    };
    distinct.len() == r.cells.len()
        && distinct.iter().all(|set| set.len() == size)
        && children.iter().all(|own| fill_without_overlap(own, &RBig::ONE))
        && cells_at_facets(&r.cells).into_iter().all(facet_is_right)
}

fn foliation_is_right(map: &Map) -> bool {
    let (cells, size, target) = (map.cells(), map.size(), map.text("target"));
    let centre = map.manifest["centre"]["cell"].as_u64().map(|c| c as usize);
    if centre.is_some_and(|c| c >= cells.len()) || map.lengths.contains(&0) {
        return false;
    }
    for (c, row) in map.directions.iter().enumerate() {
        if row.iter().map(|&d| i64::from(d)).sum::<i64>() != 0 || row.iter().all(|&d| d == 0) != (Some(c) == centre) {
            return false;
        }
    }
    let sign = |c: usize, facet: &Face| {
        let opposite = cells[c].iter().position(|v| !facet.contains(v)).expect("a facet");
        map.directions[c][opposite].signum()
    };
    let (mut source, mut sink, mut wall, mut arrows) = (vec![], vec![], vec![], vec![]);
    for (facet, at) in cells_at_facets(cells) {
        let foliated: Vec<usize> = at.iter().copied().filter(|&c| Some(c) != centre).collect();
        match foliated[..] {
            [] => return false, // the centre reaches the boundary
            [c] => {
                let inner = at.len() == 2;
                let wanted = if target == "ball" { [-1, 1] } else { [1, -1] }[usize::from(inner)];
                if centre.is_some() && sign(c, &facet) != wanted {
                    return false;
                }
                [&mut wall, &mut source, &mut sink][sign(c, &facet).rem_euclid(3) as usize].push(facet);
            }
            [a, b] => match (sign(a, &facet), sign(b, &facet)) {
                (-1, 1) => arrows.push((a, b)),
                (1, -1) => arrows.push((b, a)),
                _ => return false,
            },
            _ => return false,
        }
    }
    let mut alive: BTreeSet<usize> = (0..cells.len()).filter(|&c| Some(c) != centre).collect();
    let foliated = alive.clone();
    while let Some(&c) = alive.iter().find(|&&c| !arrows.iter().any(|&(a, b)| b == c && alive.contains(&a))) {
        alive.remove(&c);
    }
    let touches = |region: &[Face], f: &Face| region.iter().any(|g| f.is_subset(g));
    let bipolar = |f: &Face| {
        let around: Vec<usize> = foliated.iter().copied().filter(|&c| f.iter().all(|v| cells[c].contains(v))).collect();
        let lacks = |c: usize, wanted: i8| {
            let facets =
                cells[c].iter().filter(|v| !f.contains(v)).map(|&v| without(&cells[c], v).into_iter().collect());
            facets.into_iter().all(|g: Face| sign(c, &g) != wanted)
        };
        let count = |wanted: i8| around.iter().filter(|&&c| lacks(c, wanted)).count();
        count(1) + usize::from(touches(&source, f)) == 1 && count(-1) + usize::from(touches(&sink, f)) == 1
    };
    let mut small: BTreeSet<Face> = BTreeSet::new();
    for &c in &foliated {
        for (i, &v) in cells[c].iter().enumerate() {
            small.insert(Face::from([v]));
            small.extend(cells[c][..i].iter().filter(|_| size == 4).map(|&w| Face::from([v, w])));
        }
    }
    let vertices = |region: &[Face]| region.iter().flatten().copied().collect::<Face>();
    alive.is_empty()
        && small.iter().all(bipolar)
        && vertices(&source).is_disjoint(&vertices(&sink))
        && regions_are_right(&target, [&source, &sink, &wall])
        && section_is_right(map, &source)
}

fn regions_are_right(target: &str, regions: [&Vec<Face>; 3]) -> bool {
    let wanted = match target {
        "square" => [(1, 1, 2), (1, 1, 2), (2, 2, 4)],
        "cube" => [(1, 1, 1), (1, 1, 1), (1, 0, 2)],
        "disk" => [(1, 0, 0), (1, 0, 0), (0, 0, 0)],
        _ => [(1, 2, 0), (1, 2, 0), (0, 0, 0)],
    };
    regions.iter().zip(wanted).all(|(region, wanted)| {
        let cells: Vec<Vec<u32>> = region.iter().map(|f| f.iter().copied().collect()).collect();
        manifold_type(&cells) == Some(wanted)
    })
}

fn section_is_right(map: &Map, source: &[Face]) -> bool {
    let (path, target) = (&map.section_vertices, map.text("target"));
    if target == "ball" {
        return true;
    }
    let named: Face = path.iter().copied().collect();
    if named.len() != path.len() || named != source.iter().flatten().copied().collect() {
        return false;
    }
    if target == "cube" {
        let image: BTreeMap<u32, &Vec<f64>> = path.iter().copied().zip(&map.section_coordinates).collect();
        let triangles: Vec<Vec<u32>> = source.iter().map(|f| f.iter().copied().collect()).collect();
        return fills_the_box(&triangles, |v| image[&v].clone());
    }
    let numbers: Vec<f64> = map.section_coordinates.iter().map(|row| row[0]).collect();
    let mut steps: BTreeSet<Face> = path.windows(2).map(|step| step.iter().copied().collect()).collect();
    let end_is_right = if target == "disk" {
        steps.insert(Face::from([path[0], path[path.len() - 1]]));
        numbers[numbers.len() - 1] < 4.0
    } else {
        numbers[numbers.len() - 1] == 1.0
    };
    let increase = (0..numbers.len()).all(|i| (0..i).all(|j| numbers[j] < numbers[i]));
    steps == source.iter().cloned().collect() && end_is_right && numbers[0] == 0.0 && increase
}

/// Whether images of cells fill the unit box without overlap, boundary on boundary.
fn fills_the_box(cells: &[Vec<u32>], image: impl Fn(u32) -> Vec<f64>) -> bool {
    let simplices: Option<Vec<Vec<Vector>>> =
        cells.iter().map(|cell| cell.iter().map(|&v| exact(&image(v))).collect()).collect();
    let Some(simplices) = simplices else { return false };
    let in_box = simplices.iter().flatten().flatten().all(|x| (RBig::ZERO..=RBig::ONE).contains(x));
    let dimension = cells[0].len() - 1;
    let on_side = |facet: &Face| {
        (0..dimension).any(|k| [0.0, 1.0].iter().any(|value| facet.iter().all(|&v| image(v)[k] == *value)))
    };
    let facets_are_right = cells_at_facets(cells).iter().all(|(facet, at)| match at.len() {
        1 => on_side(facet),
        2 => true,
        _ => false,
    });
    in_box && facets_are_right && fill_without_overlap(&simplices, &RBig::from(if dimension == 2 { 2 } else { 6 }))
}

fn linear_map_is_right(map: &Map) -> bool {
    fills_the_box(map.cells(), |v| map.target_positions[v as usize].clone())
}
