//! Tests of the report's parts against facts that are known without them.

use super::data::{CellList, CellMesh, Leaf, ReportData, TargetShape, VerdictWords};
use super::facets::visible_facets;
use super::histogram::{Statistics, histogram_svg};
use super::leaves::pair_leaves;
use super::levels::{fit, level_sets};
use super::marching::zero_set;
use super::overlay::{Overlay, overlay, weights_near};
use super::pack::{Block, Frame, write_base64};
use super::page::{escape, grouped, rounded};
use super::simplify::simplify;
use super::{report_of_shell, write_report};
use crate::construct::shell::{ShellParams, build};
use crate::input::SourceMesh;
use crate::map::Shell;
use crate::progress::Silent;
use homeo_core::mesh::SimplicialComplex;
use homeo_core::number::Rational;
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

/// A shell round a bumpy torus.
fn torus_shell(rounds: usize) -> Shell {
    let (n, m) = (24, 12);
    let point = |k: u32| {
        let [s, t] = [(k / m, n), (k % m, m)].map(|(k, of)| std::f64::consts::TAU * f64::from(k) / f64::from(of));
        let r = 0.3 + 0.05 * (3.0 * s).sin();
        [(1.0 + r * t.cos()) * s.cos(), (1.0 + r * t.cos()) * s.sin(), r * t.sin()]
    };
    let at = |i: u32, j: u32| i % n * m + j % m;
    let triangles: Vec<[u32; 3]> = (0..n * m)
        .map(|k| (k / m, k % m))
        .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
        .collect();
    let complex = SimplicialComplex::from_indices((n * m) as usize, &triangles).expect("indices");
    let source = SourceMesh::new((0..n * m).map(point).collect(), complex);
    let params = ShellParams { rounds, ..ShellParams::default() };
    build(&source, &params, &Silent).expect("a torus has a shell").0
}

fn triangles(cells: &CellList) -> Vec<u32> {
    match cells {
        CellList::Triangles(cells) => cells.as_flattened().to_vec(),
        CellList::Tetrahedra(_) => panic!("a surface"),
    }
}

#[test]
fn parts_of_a_shell_cover_source_and_middle_once_and_go_where_the_projection_sends_them() {
    for rounds in [0, 30] {
        let shell = torus_shell(rounds);
        let source: Vec<u32> = shell.source().complex().cells().iter().flatten().map(|v| v.raw()).collect();
        let middle = area(&shell.parts().middle, shell.parts().prisms.as_flattened());
        let Overlay { mesh, prisms, distortion } = overlay(&shell);
        let parts = triangles(&mesh.cells);
        if rounds == 0 {
            assert_eq!(parts.len(), source.len(), "every triangle is the middle of its prism");
            assert!(distortion.iter().all(|ratio| *ratio < 1.0 + 1e-9));
        }
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
        assert!(near(area(&mesh.positions, &parts), area(shell.source().positions(), &source)), "rounds {rounds}");
        assert!(near(area(&mesh.images, &parts), middle), "rounds {rounds}");
        assert_eq!((prisms.len(), distortion.len()), (parts.len() / 3, parts.len() / 3));
        let (mut tried, mut in_their_prism) = (0, 0);
        for (part, &prism) in parts.chunks(3).zip(&prisms).step_by(37) {
            let centre = |points: &[[f64; 3]]| -> [f64; 3] {
                std::array::from_fn(|axis| part.iter().map(|&v| points[v as usize][axis]).sum::<f64>() / 3.0)
            };
            let (point, expected) = (centre(&mesh.positions), centre(&mesh.images));
            let image = shell.to_middle(point).expect("in the shell").point;
            let miss = (0..3).map(|axis| (image[axis] - expected[axis]).abs()).fold(0.0, f64::max);
            assert!(miss < 1e-9, "{miss}");
            let exact = point.map(|x| Rational::from_f64(x).expect("finite"));
            let at = shell.to_middle_exact(&exact).expect("in the shell");
            let corners = shell.parts().prisms[prism as usize].map(|v| shell.parts().middle[v as usize]);
            let weights = weights_near(&corners, expected);
            tried += 1;
            // The centre of a sliver is rounded across the side of its prism now and then.
            if at.prism != prism {
                continue;
            }
            in_their_prism += 1;
            assert!(at.weights.iter().zip(weights).all(|(exact, near)| (exact.to_f64() - near).abs() < 1e-9));
        }
        assert!(tried > 10 && 20 * in_their_prism >= 19 * tried, "{in_their_prism} of {tried}");
    }
}

#[test]
fn the_page_of_a_shell_is_complete() {
    let data = report_of_shell(&torus_shell(30), "torus", "", VerdictWords::default());
    assert!(!data.leaves.is_empty());
    let mut page = Vec::new();
    write_report(&data, &mut page).expect("a vector takes all");
    let page = String::from_utf8(page).expect("the page is UTF-8");
    assert!(page.contains("right the middle surface") && page.contains("parts of source triangles"));
    for (what, count) in [("\"coordinate\":\"bottom\"", 1), ("\"coordinate\":\"top\"", 1), ("\"weights\":{", 1)] {
        assert_eq!(page.matches(what).count(), count, "{what}");
    }
}

/// The middle surface as another section: both pages show the same map.
#[test]
fn the_page_of_a_section_shows_it_beside_the_source() {
    let shell = torus_shell(30);
    let middle = report_of_shell(&shell, "torus", "", VerdictWords::default());
    let parts = shell.parts().clone();
    let complex = SimplicialComplex::from_indices(parts.middle.len(), &parts.prisms).expect("columns exist");
    let onto = shell.with_section(SourceMesh::new(parts.middle.clone(), complex));
    let data = report_of_shell(&onto, "torus", "", VerdictWords::default());
    assert_eq!(data.target, TargetShape::Section);
    // Drawn with positions that are right to 1e-6 of the size, where edges are some hundredths of it.
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-4;
    let drawn = [&middle, &data].map(|data| triangles(&data.cells.cells));
    assert!(near(area(&data.cells.positions, &drawn[1]), area(&middle.cells.positions, &drawn[0])));
    assert!(near(area(&data.cells.images, &drawn[1]), area(&parts.middle, parts.prisms.as_flattened())));
    // Tiny parts are left out, and among them are the most distorted ones: by area it makes no difference.
    let mean = |data: &ReportData, triangles: &[u32]| {
        let parts = triangles.chunks(3).zip(&data.distortion).filter(|(_, distortion)| distortion.is_finite());
        let sums = parts.fold([0.0, 0.0], |[sum, whole], (t, distortion)| {
            let part = area(&data.cells.positions, t);
            [sum + part * distortion.ln(), whole + part]
        });
        sums[0] / sums[1]
    };
    let means = [mean(&middle, &drawn[0]), mean(&data, &drawn[1])];
    assert!(means[0] > 0.05 && (means[1] / means[0] - 1.0).abs() < 1e-2, "{means:?}");
    let mut page = Vec::new();
    write_report(&data, &mut page).expect("a vector takes all");
    let page = String::from_utf8(page).expect("the page is UTF-8");
    assert!(page.contains("right the section") && page.contains("\"target\":\"section\""));
}

#[test]
fn contradictory_shells_are_refused() {
    let broken: [fn(&mut ReportData); 8] = [
        |data| data.target = TargetShape::Disk,
        |data| data.shell = None,
        |data| data.shell.iter_mut().for_each(|shell| _ = shell.middle_of_vertex.pop()),
        |data| data.shell.iter_mut().for_each(|shell| shell.middle_of_vertex[0][1] = f64::INFINITY),
        |data| data.shell.iter_mut().for_each(|shell| shell.prism_of_cell[0] = u32::MAX),
        |data| data.shell.iter_mut().for_each(|shell| shell.prism_of_cell.truncate(1)),
        |data| data.shell.iter_mut().for_each(|shell| shell.parts.prisms[0][2] = u32::MAX),
        |data| data.shell.iter_mut().for_each(|shell| shell.parts.top[0][2] = f64::NAN),
    ];
    let whole = report_of_shell(&torus_shell(0), "torus", "", VerdictWords::default());
    for (case, spoil) in broken.into_iter().enumerate() {
        let mut data = whole.clone();
        spoil(&mut data);
        let mut page = Vec::new();
        let error = write_report(&data, &mut page).expect_err("the data contradict themselves");
        assert_eq!(error.kind(), ErrorKind::InvalidInput, "case {case}");
        assert!(page.is_empty());
    }
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
