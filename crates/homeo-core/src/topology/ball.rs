//! Whether a tetrahedral mesh is embedded, a ball, a handle body. The arguments are in the
//! documentation of [`super`].

use super::collapse::collapses_to_graph;
use super::gluing::ProperCells;
use super::report::{Answer, Finding};

/// Yes, no or unknown with the reason.
fn finding(answer: Answer, reason: impl Into<String>) -> Finding {
    Finding::new(answer, reason)
}

/// What was found out about the complex.
pub(super) struct Facts {
    /// No cell repeats a vertex or another cell.
    pub complete: bool,
    pub components: usize,
    pub crowded_facets: usize,
    pub bad_links: usize,
    pub orientable: bool,
    pub boundary_components: usize,
    /// Sum of the genera; `None` where the boundary is no manifold.
    pub boundary_genus: Option<i64>,
    pub euler_characteristic: i64,
}

impl Facts {
    /// Why it is no connected manifold, if it is none.
    fn not_connected_manifold(&self) -> Option<String> {
        let reason = if self.components == 0 {
            "there are no cells".to_owned()
        } else if !self.complete {
            "cells repeat vertices or other cells".to_owned()
        } else if self.crowded_facets > 0 {
            "it is no manifold: a triangle has more than two tetrahedra".to_owned()
        } else if self.bad_links > 0 {
            format!("it is no manifold: {} vertex links are neither spheres nor disks", self.bad_links)
        } else if self.components > 1 {
            format!("it falls into {} pieces", self.components)
        } else {
            return None;
        };
        Some(reason)
    }

    /// What rules out a ball or a handle body, from counts alone.
    fn no_handle_body(&self) -> Option<String> {
        if let Some(reason) = self.not_connected_manifold() {
            return Some(reason);
        }
        match self.boundary_components {
            0 => Some("it is closed: it has no boundary".to_owned()),
            1 if !self.orientable => Some("it is not orientable".to_owned()),
            1 => None,
            many => Some(format!("its boundary has {many} pieces")),
        }
    }
}

/// What was found out about the coordinates.
pub(super) struct Placement {
    /// All tetrahedra are positive when ordered consistently, or all are negative.
    pub uniform: bool,
    pub flat_cells: usize,
    /// Pairs of boundary triangles that meet; `None` where not looked for.
    pub boundary_intersections: Option<usize>,
    /// Boundary vertices at the point of another one.
    pub boundary_vertices_merged: usize,
    /// Boundary pieces that enclose a positive volume when seen from inside the mesh.
    pub outer_pieces: usize,
}

/// Whether the coordinates place the complex in space one-to-one.
pub(super) fn decide_embedded(facts: &Facts, placement: Option<&Placement>) -> Finding {
    let Some(placement) = placement else {
        return finding(Answer::Unknown, "there are no coordinates to judge by");
    };
    if placement.flat_cells > 0 {
        return finding(Answer::No, format!("{} tetrahedra have volume zero", placement.flat_cells));
    }
    if let Some(reason) = facts.not_connected_manifold() {
        return finding(Answer::Unknown, format!("not decided for this complex: {reason}"));
    }
    if !placement.uniform {
        return finding(Answer::No, "two tetrahedra lie on the same side of a common triangle");
    }
    if placement.boundary_vertices_merged > 0 {
        return finding(Answer::No, "boundary vertices lie at the same point");
    }
    match placement.boundary_intersections {
        None => finding(Answer::Unknown, "the boundary was not searched for self-intersections"),
        Some(0) if placement.outer_pieces == 1 => finding(
            Answer::Yes,
            "all tetrahedra have one sign and the boundary does not meet itself, hence no point is covered twice",
        ),
        Some(0) => finding(Answer::Unknown, format!("{} boundary pieces turn outwards", placement.outer_pieces)),
        Some(pairs) => finding(Answer::No, format!("{pairs} pairs of boundary triangles meet")),
    }
}

/// Whether the mesh is a ball, and whether it is a handle body.
pub(super) fn decide_ball(facts: &Facts, embedded: &Finding, proper: &ProperCells<'_, 4>) -> (Finding, Finding) {
    if let Some(reason) = facts.no_handle_body() {
        return (finding(Answer::No, reason.clone()), finding(Answer::No, reason));
    }
    let Some(genus) = facts.boundary_genus else {
        let reason = "the boundary is no orientable surface";
        return (finding(Answer::No, reason), finding(Answer::No, reason));
    };
    if facts.euler_characteristic != 1 - genus {
        let reason = format!("its Euler characteristic is {}, not {}", facts.euler_characteristic, 1 - genus);
        return (finding(Answer::No, reason.clone()), finding(Answer::No, reason));
    }
    if genus == 0 {
        let ball = decide_inside_sphere(embedded, proper);
        let handle_body = match ball.answer {
            Answer::Yes => "it is a ball: a handle body without handles",
            _ => "a handle body with this boundary would be a ball",
        };
        let handle_body = finding(ball.answer, handle_body);
        return (ball, handle_body);
    }
    let ball = finding(Answer::No, format!("its boundary has genus {genus}; that of a ball is a sphere"));
    let handle_body = if collapses_to_graph(&proper.complex, &proper.gluing) {
        finding(Answer::Yes, format!("it collapses to a graph with {genus} independent cycles"))
    } else {
        let reason = format!("boundary genus {genus}; whether it is a handle body is not decided here");
        finding(Answer::Unknown, reason)
    };
    (ball, handle_body)
}

/// The boundary is one sphere: is there a ball inside?
fn decide_inside_sphere(embedded: &Finding, proper: &ProperCells<'_, 4>) -> Finding {
    if embedded.answer == Answer::Yes {
        let reason = "it is embedded in space and its boundary is one sphere (Alexander's theorem)";
        return finding(Answer::Yes, reason);
    }
    if collapses_to_graph(&proper.complex, &proper.gluing) {
        return finding(Answer::Yes, "it collapses to a point (Whitehead's theorem)");
    }
    let reason = format!(
        "its boundary is a sphere, but a greedy collapse got stuck and its embedding is not proved: {}",
        embedded.reason
    );
    finding(Answer::Unknown, reason)
}
