//! Tests of the report's parts against facts that are known without them.

use super::data::{CellList, CellMesh, Leaf, ReportData, TargetShape, VerdictWords};
use super::facets::visible_facets;
use super::histogram::{Statistics, histogram_svg};
use super::leaves::pair_leaves;
use super::levels::{fit, level_sets};
use super::marching::zero_set;
use super::pack::{Block, Frame, write_base64};
use super::page::{escape, grouped, rounded};
use super::simplify::simplify;
use super::write_report;
use std::io::ErrorKind;

/// The unit cube, split into six tetrahedra round its diagonal, `steps` times in each direction.
fn cube(steps: usize) -> CellMesh {
    let at = |corner: [usize; 3]| (corner[0] + (steps + 1) * (corner[1] + (steps + 1) * corner[2])) as u32;
    let share = |n: usize| n as f64 / steps as f64;
    let side = steps + 1;
    let positions: Vec<[f64; 3]> =
        (0..side * side * side).map(|n| [share(n % side), share(n / side % side), share(n / side / side)]).collect();
    let mut cells = Vec::new();
    for n in 0..steps * steps * steps {
        for (order, even) in [
            ([0, 1, 2], true),
            ([1, 2, 0], true),
            ([2, 0, 1], true),
            ([0, 2, 1], false),
            ([2, 1, 0], false),
            ([1, 0, 2], false),
        ] {
            let mut corner = [n % steps, n / steps % steps, n / steps / steps];
            let mut path = [at(corner); 4];
            for (place, axis) in order.into_iter().enumerate() {
                corner[axis] += 1;
                path[place + 1] = at(corner);
            }
            if !even {
                path.swap(1, 2);
            }
            cells.push(path);
        }
    }
    CellMesh { images: positions.clone(), positions, cells: CellList::Tetrahedra(cells) }
}

fn report(mesh: CellMesh) -> ReportData {
    ReportData {
        title: "a <b> & </script>".into(),
        subtitle: String::new(),
        target: TargetShape::Cube,
        verdict: VerdictWords { holds: true, headline: "It holds".into(), ..Default::default() },
        facts: vec![("cells".into(), "<6>".into())],
        stage_seconds: vec![("read".into(), 0.5), ("total".into(), 0.5)],
        distortion: vec![1.0; mesh.cells.len()],
        cells: mesh,
        leaves: vec![Leaf { source: vec![[0.0; 3], [1.0; 3]], target: vec![[0.0; 3], [0.5; 3], [1.0; 3]] }],
        shell: None,
    }
}

fn area(points: &[[f64; 3]], triangles: &[u32]) -> f64 {
    let normal = |t: &[u32]| {
        let [a, b, c] = [points[t[0] as usize], points[t[1] as usize], points[t[2] as usize]];
        let (u, v): ([f64; 3], [f64; 3]) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    triangles.chunks(3).map(|t| normal(t).iter().map(|n| n * n).sum::<f64>().sqrt() / 2.0).sum()
}

#[test]
fn boundary_of_the_cube_points_outwards_and_encloses_its_volume() {
    let mesh = cube(3);
    let facets = visible_facets(&mesh.cells);
    assert_eq!(facets.triangles.len(), 6 * 9 * 2);
    let volume: f64 = facets
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| mesh.positions[v as usize]);
            (a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
                / 6.0
        })
        .sum();
    assert!((volume - 1.0).abs() < 1e-12);
}

#[test]
fn a_simplified_surface_is_small_and_keeps_vertices_of_the_mesh() {
    let mesh = cube(16);
    let facets = visible_facets(&mesh.cells);
    assert_eq!(simplify(&mesh, facets.clone(), 10_000).triangles, facets.triangles);
    let thinned = simplify(&mesh, facets, 500);
    assert!((100..=500).contains(&thinned.triangles.len()));
    assert_eq!(thinned.triangles.len(), thinned.cells.len());
    assert!(thinned.triangles.iter().all(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
}

#[test]
fn level_sets_of_the_identity_are_unit_squares() {
    let mesh = cube(4);
    let sets = level_sets(TargetShape::Cube, &mesh);
    assert_eq!(sets.len(), 21);
    for set in &sets {
        assert!((area(&set.patch.source, &set.patch.elements) - 1.0).abs() < 1e-12, "level {}", set.label);
    }
}

#[test]
fn an_oblique_zero_set_has_its_area_and_lies_where_the_function_vanishes() {
    let mesh = cube(5);
    let values: Vec<f64> = mesh.positions.iter().map(|p| p[0] + p[1] - 0.77).collect();
    let patch = zero_set(&mesh, &values);
    assert!(patch.source.iter().all(|p| (p[0] + p[1] - 0.77).abs() < 1e-12));
    assert!((area(&patch.source, &patch.elements) - 0.77 * 2.0_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn levels_are_thinned_until_they_fit() {
    let mut sets = level_sets(TargetShape::Cube, &cube(4));
    let bytes: usize = sets.iter().map(|set| set.patch.packed_bytes()).sum();
    assert!(!fit(&mut sets, bytes));
    assert!(fit(&mut sets, bytes / 2));
    assert_eq!(sets.len(), 9);
    assert!(fit(&mut sets, 0));
    assert!(sets.is_empty());
}

#[test]
fn isolines_of_a_square_have_length_one() {
    let mesh = CellMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        images: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        cells: CellList::Triangles(vec![[0, 1, 2], [0, 2, 3]]),
    };
    for set in level_sets(TargetShape::Square, &mesh) {
        let length: f64 = set
            .patch
            .elements
            .chunks(2)
            .map(|s| {
                let (a, b) = (set.patch.source[s[0] as usize], set.patch.source[s[1] as usize]);
                (a[0] - b[0]).hypot(a[1] - b[1])
            })
            .sum();
        assert!((length - 1.0).abs() < 1e-12);
    }
}

#[test]
fn statistics_count_every_cell_once() {
    let mut ratios: Vec<f64> = (0..1000).map(|i| 1.0 + f64::from(i)).collect();
    ratios.extend([f64::INFINITY, f64::NAN, 0.5]);
    let statistics = Statistics::of(&ratios).expect("not empty");
    assert_eq!(statistics.collapsed, 2);
    assert_eq!(statistics.bins.iter().sum::<usize>() + statistics.collapsed, ratios.len());
    assert_eq!(statistics.largest, 1000.0);
    assert_eq!(statistics.median, 501.0);
    assert!(Statistics::of(&[]).is_none());
    let collapsed = Statistics::of(&[f64::INFINITY]).expect("not empty");
    assert!(histogram_svg(&collapsed).ends_with("</svg>"));
}

#[test]
fn extreme_ratios_keep_the_histogram_finite() {
    for ratio in [1.0, 1.0 + 1e-15, 1e300, f64::MAX] {
        let statistics = Statistics::of(&[ratio]).expect("not empty");
        let svg = histogram_svg(&statistics);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{ratio}");
        assert!(svg.len() < 20_000);
    }
}

#[test]
fn base64_matches_the_examples_of_the_rfc() {
    for (bytes, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg==")] {
        let mut out = Vec::new();
        write_base64(bytes.as_bytes(), &mut out).expect("a vector takes all");
        assert_eq!(out, text.as_bytes());
    }
}

#[test]
fn quantization_stays_in_the_box_at_any_scale() {
    for size in [1e-300, 1.0, 1e300, f64::MAX] {
        let points = [[-size, 0.0, size], [size, 0.0, -size], [0.0, 0.0, size / 2.0]];
        let frame = Frame::around(points.iter());
        let mut block = Block::default();
        block.octets(&[1]);
        let slot = block.points(&frame, &points);
        assert_eq!((slot.offset, slot.length), (4, 9));
        let steps: Vec<u16> = block.bytes[4..].chunks(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
        assert_eq!(steps, [0, 0, 65535, 65535, 0, 0, 32768, 0, 49151], "size {size}");
    }
}

#[test]
fn leaves_with_different_points_are_paired_by_length() {
    let leaf =
        Leaf { source: vec![[0.0; 3], [4.0, 0.0, 0.0]], target: vec![[0.0; 3], [0.0, 0.25, 0.0], [0.0, 1.0, 0.0]] };
    let (paired, shown) = pair_leaves(&[leaf.clone(), Leaf::default()], 100);
    assert_eq!(shown, 1);
    assert_eq!(paired.starts, [0, 3]);
    assert_eq!(paired.source[1], [1.0, 0.0, 0.0]);
    assert_eq!(paired.image[1], [0.0, 0.25, 0.0]);
    let (thinned, shown) = pair_leaves(&vec![leaf; 100], 100);
    assert!(shown < 25 && thinned.source.len() <= 100);
}

#[test]
fn the_page_is_complete_and_escapes_what_it_is_given() {
    let mut page = Vec::new();
    write_report(&report(cube(3)), &mut page).expect("a vector takes all");
    let page = String::from_utf8(page).expect("the page is UTF-8");
    assert!(page.contains("<h1>a &lt;b&gt; &amp; &lt;/script&gt;</h1>"));
    assert_eq!(page.matches("<script").count(), page.matches("</script>").count());
    assert!(page.contains("&lt;6&gt;") && page.contains("MIT License"));
    assert!(!page.contains("src=\"") && !page.contains("@import"));
    assert!(page.trim_end().ends_with("</html>"));
}

#[test]
fn contradictory_data_are_refused_before_anything_is_written() {
    let broken: [fn(&mut ReportData); 6] = [
        |data| data.target = TargetShape::Disk,
        |data| data.cells.images.truncate(5),
        |data| data.distortion.truncate(1),
        |data| data.cells.positions[7][1] = f64::NAN,
        |data| data.cells.cells = CellList::Tetrahedra(vec![[0, 1, 2, 9999]]),
        |data| data.leaves[0].target[1][2] = f64::INFINITY,
    ];
    for (case, spoil) in broken.into_iter().enumerate() {
        let mut data = report(cube(2));
        spoil(&mut data);
        let mut page = Vec::new();
        let error = write_report(&data, &mut page).expect_err("the data contradict themselves");
        assert_eq!(error.kind(), ErrorKind::InvalidInput, "case {case}");
        assert!(page.is_empty());
    }
}

#[test]
fn numbers_read_well() {
    assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
    let cases = [(0.0, "0"), (1.0, "1"), (12.345, "12.3"), (0.04, "0.04"), (999.6, "1000"), (1e7, "1.00e7")];
    for (value, text) in cases {
        assert_eq!(rounded(value), text);
    }
    assert_eq!(escape("'\"<>&"), "&#39;&quot;&lt;&gt;&amp;");
}
