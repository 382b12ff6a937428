//! An oracle for orders of cells: the definition of a bishelling, tried naively.

use std::collections::BTreeSet;

use homeo::map::{Foliation, Target};
use homeo_core::mesh::{CellId, SimplicialComplex, VertexId};

/// A boundary facet or a facet of the centre, by its vertices, on the side where leaves begin or end.
pub struct Ends {
    pub source: Vec<Vec<VertexId>>,
    pub sink: Vec<Vec<VertexId>>,
}

/// Whether an order of cells is a bishelling: around each vertex and edge the cells so far, with the
/// source, are connected through facets, those to come, with the sink, too; and one cell or the source comes
/// first, one cell or the sink last.
///
/// Quadratic time: for each face all cells are looked at, and for each step all pairs.
///
/// # Errors
/// The face and what is wrong there.
pub fn check_order<const K: usize>(
    complex: &SimplicialComplex<K>,
    order: &[CellId],
    ends: &Ends,
) -> Result<(), String> {
    for face in faces(complex, order) {
        let around: Vec<[VertexId; K]> =
            order.iter().map(|&c| complex.cell(c)).filter(|cell| face.iter().all(|v| cell.contains(v))).collect();
        let facets = |list: &[Vec<VertexId>]| -> Vec<Vec<VertexId>> {
            list.iter().filter(|f| face.iter().all(|v| f.contains(v))).cloned().collect()
        };
        let (source, sink) = (facets(&ends.source), facets(&ends.sink));
        for time in 0..=around.len() {
            if !is_connected(&around[..time], &source, &face) {
                return Err(format!("around {face:?} the first {time} of {} cells fall apart", around.len()));
            }
            if !is_connected(&around[time..], &sink, &face) {
                return Err(format!("around {face:?} all but the first {time} of {} cells fall apart", around.len()));
            }
        }
        if !source.is_empty() && !sink.is_empty() {
            return Err(format!("{face:?} lies on source and sink"));
        }
    }
    Ok(())
}

/// Vertices and, in volumes, edges of the ordered cells.
fn faces<const K: usize>(complex: &SimplicialComplex<K>, order: &[CellId]) -> BTreeSet<Vec<VertexId>> {
    let mut faces = BTreeSet::new();
    for mut cell in order.iter().map(|&c| complex.cell(c)) {
        cell.sort_unstable();
        faces.extend(cell.map(|v| vec![v]));
        if K == 4 {
            faces.extend((0..K).flat_map(|j| (0..j).map(move |i| vec![cell[i], cell[j]])));
        }
    }
    faces
}

/// Whether cells around a face, and the end if some of its facets contain the face, hang together by facets
/// that contain the face.
fn is_connected<const K: usize>(cells: &[[VertexId; K]], end: &[Vec<VertexId>], face: &[VertexId]) -> bool {
    let at_end = |cell: &[VertexId; K]| end.iter().any(|facet| facet.iter().all(|v| cell.contains(v)));
    let touch = |a: &[VertexId; K], b: &[VertexId; K]| {
        let common: Vec<_> = a.iter().filter(|v| b.contains(v)).collect();
        common.len() == K - 1 && face.iter().all(|v| common.contains(&v))
    };
    let mut waiting: Vec<_> = cells.iter().collect();
    let mut reached: Vec<&[VertexId; K]> = Vec::new();
    if end.is_empty() {
        reached.extend(waiting.pop());
    } else {
        let (first, rest) = waiting.into_iter().partition(|cell| at_end(cell));
        (reached, waiting) = (first, rest);
    }
    let mut next = 0;
    while next < reached.len() {
        let cell = reached[next];
        let (found, rest): (Vec<_>, Vec<_>) = waiting.into_iter().partition(|other| touch(cell, other));
        reached.extend(found);
        waiting = rest;
        next += 1;
    }
    waiting.is_empty()
}

/// The order that a map's directions stand for, and the facets where leaves begin and end.
pub fn order_of<const K: usize>(map: &Foliation<K>) -> (Vec<CellId>, Ends) {
    let complex = map.parts().mesh.complex();
    let centre = map.parts().centre.map(|c| c.cell);
    let foliated = || complex.cell_ids().filter(|&c| centre != Some(c));
    let inside = |cell: CellId, i: usize| {
        Some(map.adjacency().across(cell, i)).filter(|far| far.is_some() && centre != Some(far.cell()))
    };
    let mut ends = Ends { source: Vec::new(), sink: Vec::new() };
    let mut waiting = vec![0; complex.cell_count()];
    for (cell, i) in foliated().flat_map(|c| (0..K).map(move |i| (c, i))) {
        let sign = map.parts().directions[cell.index()][i].signum();
        let facet = || complex.facet_vertices(cell, i).collect();
        match (inside(cell, i), sign) {
            (Some(_), 1) => waiting[cell.index()] += 1,
            (None, 1) => ends.source.push(facet()),
            (None, -1) => ends.sink.push(facet()),
            _ => {}
        }
    }
    let mut order: Vec<CellId> = foliated().filter(|c| waiting[c.index()] == 0).collect();
    let mut next = 0;
    while next < order.len() {
        let cell = order[next];
        for far in (0..K).filter(|&i| map.parts().directions[cell.index()][i] < 0).filter_map(|i| inside(cell, i)) {
            waiting[far.cell().index()] -= 1;
            if waiting[far.cell().index()] == 0 {
                order.push(far.cell());
            }
        }
        next += 1;
    }
    (order, ends)
}

/// Checks a map's directions by the oracle: they are an order, and a bishelling.
pub fn check_directions<const K: usize>(map: &Foliation<K>) {
    let (order, ends) = order_of(map);
    let complex = map.parts().mesh.complex();
    let foliated = complex.cell_count() - usize::from(map.parts().centre.is_some());
    assert_eq!(order.len(), foliated, "the directions run in a circle");
    // Beyond this the naive way takes too long; the larger meshes are left to the checker.
    if order.len() <= 1200 {
        check_order(complex, &order, &ends).unwrap_or_else(|wrong| panic!("{wrong}"));
    }
    if map.parts().target == Target::Ball {
        assert_eq!(ends.source.len(), 4, "leaves begin at the centre's facets");
    }
}

fn ids(order: &[usize]) -> Vec<CellId> {
    order.iter().map(|&c| CellId::new(c)).collect()
}

fn edges(list: &[[u32; 2]]) -> Vec<Vec<VertexId>> {
    list.iter().map(|e| e.map(VertexId::from).to_vec()).collect()
}

/// A closed fan of four triangles round vertex 0, from its lower to its upper edge.
fn fan() -> (SimplicialComplex<3>, Ends) {
    let cells = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    let complex = SimplicialComplex::from_indices(5, &cells).expect("indices");
    (complex, Ends { source: edges(&[[1, 2]]), sink: edges(&[[3, 4]]) })
}

#[test]
fn oracle_accepts_both_ways_round_a_fan() {
    let (complex, ends) = fan();
    for order in [[0, 1, 3, 2], [0, 3, 1, 2]] {
        assert_eq!(check_order(&complex, &ids(&order), &ends), Ok(()));
    }
}

#[test]
fn oracle_refuses_orders_that_fall_apart_or_close_too_soon() {
    let (complex, ends) = fan();
    for order in [[0, 2, 1, 3], [2, 1, 3, 0], [1, 0, 3, 2], [0, 1, 2, 3], [2, 3, 1, 0]] {
        assert!(check_order(&complex, &ids(&order), &ends).is_err(), "{order:?} was taken for a bishelling");
    }
}

#[test]
fn oracle_refuses_ends_that_touch() {
    let (complex, mut ends) = fan();
    ends.sink.extend(edges(&[[2, 3]]));
    assert!(check_order(&complex, &ids(&[0, 3, 1, 2]), &ends).unwrap_err().contains("source and sink"));
}

#[test]
fn oracle_refuses_any_exchange_that_breaks_a_volume() {
    // All cells of the cube round its diagonal: neighbours must follow one another.
    let cube = crate::shapes::balls::kuhn(1, 1, 1).mesh();
    let map = crate::built(&cube, Target::Cube);
    let (order, ends) = order_of(&map);
    let complex = map.parts().mesh.complex();
    assert_eq!(check_order(complex, &order, &ends), Ok(()));
    let mut refused = 0;
    let position = |order: &[CellId], cell: CellId| order.iter().position(|&c| c == cell).expect("ordered");
    for i in 0..order.len() - 1 {
        let mut other = order.clone();
        other.swap(i, i + 1);
        let agrees = order.iter().all(|&cell| {
            (0..4).all(|k| {
                let far = map.adjacency().across(cell, k);
                let is_before = |order: &[CellId]| position(order, cell) < position(order, far.cell());
                far.is_none() || is_before(&order) == is_before(&other)
            })
        });
        let answer = check_order(complex, &other, &ends);
        // Cells that do not touch may change places, and nothing changes.
        assert!(!agrees || answer.is_ok(), "{answer:?}");
        refused += usize::from(answer.is_err());
    }
    assert!(refused > 0, "no exchange was refused");
}
