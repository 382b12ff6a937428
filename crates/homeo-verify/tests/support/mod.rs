//! What the tests share: maps in memory, an independent writer, a slow constructor and an oracle.
#![allow(dead_code)] // every test uses another part

pub mod build;
pub mod bundles;
pub mod clip;
pub mod immersed;
pub mod moved;
pub mod mutants;
pub mod oracle;
pub mod plane;
pub mod random;
pub mod shells;
pub mod spatial;
pub mod write;

use homeo_verify::{Verdict, Witness, verify_bytes};
use serde_json::{Value, json};

/// Points and triangles.
pub type Rows = (Vec<Vec<f64>>, Vec<Vec<u32>>);

/// A map file in memory. Rows are vectors, so that mutations can make them ragged in count, not in width.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    pub manifest: Value,
    pub positions: Vec<Vec<f64>>,
    pub source_cells: Vec<Vec<u32>>,
    pub refinement: Option<Refinement>,
    pub directions: Vec<Vec<i8>>,
    pub lengths: Vec<u32>,
    pub section_vertices: Vec<u32>,
    pub section_coordinates: Vec<Vec<f64>>,
    /// Of a map between cages: of all cages after the source.
    pub target_positions: Vec<Vec<f64>>,
    /// Bottom, middle and top points of the columns of a shell.
    pub levels: [Vec<Vec<f64>>; 3],
    pub prisms: Vec<Vec<u32>>,
    /// Another section of a shell: points and triangles.
    pub section: Option<Rows>,
    /// The pairs of a triangle and a prism, for a source that may cross itself.
    pub pairs: Option<Vec<[u32; 2]>>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Refinement {
    pub carrier_vertices: Vec<Vec<u32>>,
    pub carrier_weights: Vec<Vec<i64>>,
    pub cells: Vec<Vec<u32>>,
    pub parents: Vec<u32>,
}

impl Map {
    pub fn new(kind: &str, target: &str, positions: Vec<Vec<f64>>, source_cells: Vec<Vec<u32>>) -> Map {
        let dimension = if target == "cube" || target == "ball" { 3 } else { 2 };
        let manifest = json!({
            "format": "homeo", "version": 1, "kind": kind, "dimension": dimension, "target": target, "centre": null,
            "source": {"name": "test", "vertices": 0, "cells": 0, "content_sha256": ""},
            "length_unit": 1.0, "construction": {"program": "test", "options": {}},
        });
        Map {
            manifest,
            positions,
            source_cells,
            refinement: None,
            directions: vec![],
            lengths: vec![],
            section_vertices: vec![],
            section_coordinates: vec![],
            target_positions: vec![],
            levels: Default::default(),
            prisms: vec![],
            section: None,
            pairs: None,
        }
    }

    pub fn text(&self, key: &str) -> String {
        self.manifest[key].as_str().unwrap_or_default().to_owned()
    }

    /// Vertices per cell.
    pub fn size(&self) -> usize {
        if self.text("target") == "space" {
            return self.manifest["dimension"].as_u64().unwrap_or_default() as usize + 1;
        }
        if ["square", "disk", "shell", "section", "immersed-shell", "embedded-shell", "polyhedron"]
            .contains(&self.text("target").as_str())
        {
            3
        } else {
            4
        }
    }

    /// Cells of the refined complex.
    pub fn cells(&self) -> &Vec<Vec<u32>> {
        self.refinement.as_ref().map_or(&self.source_cells, |r| &r.cells)
    }

    pub fn cells_mut(&mut self) -> &mut Vec<Vec<u32>> {
        self.refinement.as_mut().map_or(&mut self.source_cells, |r| &mut r.cells)
    }

    pub fn vertex_count(&self) -> usize {
        self.positions.len() + self.refinement.as_ref().map_or(0, |r| r.carrier_vertices.len())
    }

    /// Writes the right counts and hash into the manifest.
    pub fn sign(&mut self) {
        self.manifest["source"]["vertices"] = json!(self.positions.len());
        self.manifest["source"]["cells"] = json!(self.source_cells.len());
        self.manifest["source"]["content_sha256"] = json!(write::content_hash(self));
    }

    /// The file, with the manifest as it is.
    pub fn bytes(&self) -> Vec<u8> {
        write::zip(&write::entries(self))
    }

    /// The file, after `sign`.
    pub fn signed_bytes(&self) -> Vec<u8> {
        let mut map = self.clone();
        map.sign();
        map.bytes()
    }
}

/// The witness against a map, which has to be of a rule and to say certain words.
#[track_caller]
pub fn assert_refuted(map: &Map, rule: &str, words: &str) -> Witness {
    match verify_bytes(&map.signed_bytes()) {
        Ok(Verdict::Refuted(witness)) => {
            assert_eq!(witness.rule, rule, "{witness:?}");
            assert!(witness.message.contains(words), "{witness:?}");
            witness
        }
        other => panic!("not refuted: {other:?}"),
    }
}
