//! Triangle and tetrahedral meshes, with or without coordinates.

use homeo::progress::Progress;
use homeo_core::topology::{
    AngleRange, Answer as Found, Finding, Intersections, Options, SurfaceReport, VolumeReport, analyse_tetrahedra,
    analyse_triangles,
};
use serde_json::{Value, json};

use super::{violation, violations_text};
use crate::answer::Answer;
use crate::args::InfoArgs;
use crate::failure::Result;
use crate::mesh_input::{self, Cells, MeshInput, Requested};
use crate::session::Session;
use crate::text::{Lines, counted, yes_no};

/// Describes a mesh.
pub fn describe(session: &Session, options: &InfoArgs) -> Result<Answer> {
    let requested = Requested { weld: options.weld, ..Requested::default() };
    let mesh = mesh_input::read(session, &options.input, requested)?;
    session.stage("check");
    let look = if options.intersections { Intersections::Find } else { Intersections::WhereNeeded };
    let look = Options { intersections: look };
    let (mut fields, mut text) = match &mesh.cells {
        Cells::Triangles(complex) => {
            let report = analyse_triangles(&mesh.file.positions, complex, look);
            (surface_fields(&report), surface_text(&report))
        }
        Cells::Tetrahedra(complex) => {
            let report = analyse_tetrahedra(&mesh.file.positions, complex, look);
            (volume_fields(&report), volume_text(&report))
        }
    };
    session.check()?;
    session.end_stage();
    fields["coordinates"] = json!(mesh.file.space);
    let mut violations: Vec<Value> = fields["violations"].as_array().cloned().unwrap_or_default();
    violations.splice(0..0, polygon_violation(&mesh));
    text = format!("{}: {text}{}", options.input.display(), violations_text(&violations));
    for note in mesh.changes.iter().chain(&mesh.file.losses) {
        text.push_str(&format!("note: {note}\n"));
    }
    fields["violations"] = Value::Array(violations);
    Ok(Answer::new(fields, text))
}

fn polygon_violation(mesh: &MeshInput) -> Option<Value> {
    if mesh.polygon_count == 0 {
        return None;
    }
    let message =
        format!("{}. Triangles are numbered here as --triangulate cuts them", crate::refuse::polygons_message(mesh));
    Some(violation("polygon-not-triangle", "error", "polygon", mesh.polygons.clone(), mesh.polygon_count, message))
}

fn answer(finding: &Finding) -> Value {
    match finding.answer {
        Found::Yes => json!(true),
        Found::No => json!(false),
        Found::Unknown => Value::Null,
    }
}

fn surface_fields(report: &SurfaceReport) -> Value {
    let mut fields = json!({
        "kind": "triangles",
        "vertices": report.vertices, "edges": report.edges, "triangles": report.faces,
        "isolated_vertices": report.isolated_vertices, "components": report.components,
        "edge_manifold": report.edge_manifold, "vertex_manifold": report.vertex_manifold, "manifold": report.manifold,
        "orientable": report.orientable, "consistently_oriented": report.consistently_oriented,
        "closed": report.closed, "boundary_edges": report.boundary_edges, "boundary_loops": report.boundary_loops,
        "boundary": report.boundary, "genus": report.genus, "euler": report.euler_characteristic,
        "disk": report.is_disk, "sphere": report.is_sphere, "parts": report.parts,
        "self_intersections": report.self_intersections, "violations": report.violations,
    });
    if let Some(geometry) = &report.geometry {
        fields["lowest"] = json!(geometry.lowest);
        fields["highest"] = json!(geometry.highest);
        fields["diagonal"] = json!(geometry.diagonal);
        fields["area"] = json!(geometry.area);
        fields["enclosed_volume"] = json!(geometry.enclosed_volume);
        fields["degenerate"] = json!(geometry.flat_cells);
        fields["triangle_angles"] = json!(geometry.triangle_angles);
        fields["dihedral_angles"] = json!(geometry.dihedral_angles);
    }
    fields
}

fn volume_fields(report: &VolumeReport) -> Value {
    let mut fields = json!({
        "kind": "tetrahedra",
        "vertices": report.vertices, "edges": report.edges, "triangles": report.faces, "tetrahedra": report.cells,
        "isolated_vertices": report.isolated_vertices, "interior_vertices": report.interior_vertices,
        "components": report.components, "facet_manifold": report.facet_manifold,
        "vertex_manifold": report.vertex_manifold, "manifold": report.manifold,
        "bad_vertex_links": report.bad_vertex_links, "orientable": report.orientable,
        "consistently_oriented": report.consistently_oriented, "closed": report.boundary.faces == 0,
        "euler": report.euler_characteristic, "boundary": report.boundary,
        "boundary_components": report.boundary.components, "genus": report.boundary.genus,
        "ball": answer(&report.ball), "ball_reason": report.ball.reason,
        "handle_body": answer(&report.handle_body), "handle_body_reason": report.handle_body.reason,
        "embedded": answer(&report.embedded), "embedded_reason": report.embedded.reason,
        "cells_with_all_vertices_on_boundary": report.cells_with_all_vertices_on_boundary,
        "interior_edges_between_boundary_vertices": report.interior_edges_between_boundary_vertices,
        "interior_faces_with_all_vertices_on_boundary": report.interior_faces_with_all_vertices_on_boundary,
        "self_intersections": report.boundary_self_intersections, "violations": report.violations,
    });
    if let Some(geometry) = &report.geometry {
        fields["lowest"] = json!(geometry.lowest);
        fields["highest"] = json!(geometry.highest);
        fields["diagonal"] = json!(geometry.diagonal);
        fields["volume"] = json!(geometry.volume);
        fields["positive"] = json!(geometry.positive_cells);
        fields["negative"] = json!(geometry.negative_cells);
        fields["degenerate"] = json!(geometry.flat_cells);
        fields["triangle_angles"] = json!(geometry.triangle_angles);
        fields["dihedral_angles"] = json!(geometry.dihedral_angles);
    }
    fields
}

fn angles(range: &AngleRange) -> String {
    format!("{:.2} to {:.2} degrees", range.min_degrees, range.max_degrees)
}

fn or_unknown(number: Option<impl ToString>) -> String {
    number.map_or_else(|| "undefined".to_owned(), |n| n.to_string())
}

fn surface_text(report: &SurfaceReport) -> String {
    let mut lines = Lines::default();
    let shape = match (report.is_disk, report.is_sphere) {
        (true, _) => "a disk",
        (_, true) => "a sphere",
        _ => "neither disk nor sphere",
    };
    lines.add("shape", shape);
    lines.add("pieces", report.components);
    lines.add("manifold", yes_no(report.manifold));
    lines.add("orientable", yes_no(report.orientable));
    lines.add("oriented alike", yes_no(report.consistently_oriented));
    lines.add("boundary", format!("{} loops, {} edges", or_unknown(report.boundary_loops), report.boundary_edges));
    lines.add("genus", or_unknown(report.genus));
    lines.add("euler", report.euler_characteristic);
    if let Some(geometry) = &report.geometry {
        lines.add("area", format!("{:.6}", geometry.area));
        geometry.triangle_angles.iter().for_each(|range| lines.add("angles", angles(range)));
        geometry.dihedral_angles.iter().for_each(|range| lines.add("dihedral angles", angles(range)));
    }
    if let Some(pairs) = report.self_intersections {
        lines.add("self-intersections", pairs);
    }
    let head = format!(
        "{}, {}",
        counted(report.vertices, "vertex", "vertices"),
        counted(report.faces, "triangle", "triangles")
    );
    lines.below(&head)
}

fn volume_text(report: &VolumeReport) -> String {
    let mut lines = Lines::default();
    let worded = |finding: &Finding| {
        let word = match finding.answer {
            Found::Yes => "yes",
            Found::No => "no",
            Found::Unknown => "unknown",
        };
        format!("{word}: {}", finding.reason)
    };
    lines.add("ball", worded(&report.ball));
    lines.add("handle body", worded(&report.handle_body));
    lines.add("embedded", worded(&report.embedded));
    lines.add("pieces", report.components);
    lines.add("manifold", yes_no(report.manifold));
    lines.add("orientable", yes_no(report.orientable));
    lines.add("oriented alike", yes_no(report.consistently_oriented));
    lines.add(
        "boundary",
        format!(
            "{}, {}, genus {}",
            counted(report.boundary.components, "piece", "pieces"),
            counted(report.boundary.faces, "triangle", "triangles"),
            or_unknown(report.boundary.genus)
        ),
    );
    lines.add("euler", report.euler_characteristic);
    if let Some(geometry) = &report.geometry {
        lines.add(
            "signs",
            format!(
                "{} positive, {} negative, {} flat",
                geometry.positive_cells, geometry.negative_cells, geometry.flat_cells
            ),
        );
        lines.add("volume", format!("{:.6}", geometry.volume));
        geometry.dihedral_angles.iter().for_each(|range| lines.add("dihedral angles", angles(range)));
    }
    let head = format!(
        "{}, {}",
        counted(report.vertices, "vertex", "vertices"),
        counted(report.cells, "tetrahedron", "tetrahedra")
    );
    lines.below(&head)
}
