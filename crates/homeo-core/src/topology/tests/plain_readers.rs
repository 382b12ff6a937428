//! Readers for well-formed files of the test data, no more. The library's readers are in `io`.

use std::path::Path;

/// Points, triangles and tetrahedra of a file.
#[derive(Default)]
pub struct PlainMesh {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub tetrahedra: Vec<[u32; 4]>,
}

/// Reads by extension; `None` where the file is not of the plain kind.
pub fn read(path: &Path) -> Option<PlainMesh> {
    let bytes = std::fs::read(path).ok()?;
    let text = || String::from_utf8_lossy(&bytes).into_owned();
    match path.extension()?.to_str()? {
        "obj" => obj(&text()),
        "off" => off(&text()),
        "stl" => stl(&bytes),
        "mesh" => medit(&text()),
        "msh" => msh(&text()),
        "vtk" => vtk(&bytes),
        "json" => facets(&text()),
        _ => None,
    }
}

/// A fan of triangles for each polygon.
fn fan(mesh: &mut PlainMesh, corners: &[u32]) {
    mesh.triangles.extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
}

fn obj(text: &str) -> Option<PlainMesh> {
    let mut mesh = PlainMesh::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => mesh.positions.push([(); 3].map(|()| words.next().unwrap().parse().unwrap())),
            Some("f") => {
                let number = |word: &str| word.split('/').next().unwrap().parse::<i64>().unwrap();
                let corners: Vec<u32> = words.map(|w| (number(w) - 1) as u32).collect();
                fan(&mut mesh, &corners);
            }
            _ => {}
        }
    }
    (!mesh.triangles.is_empty()).then_some(mesh)
}

/// Words of a text, comments left out.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.lines().map(|line| line.split('#').next().unwrap()).flat_map(str::split_whitespace)
}

fn off(text: &str) -> Option<PlainMesh> {
    let mut words = words(text).skip(1);
    let mut mesh = PlainMesh::default();
    let vertices: usize = words.next()?.parse().ok()?;
    let faces: usize = words.next()?.parse().ok()?;
    words.next();
    for _ in 0..vertices {
        mesh.positions.push([words.next()?.parse().ok()?, words.next()?.parse().ok()?, words.next()?.parse().ok()?]);
    }
    for _ in 0..faces {
        let count: usize = words.next()?.parse().ok()?;
        let corners: Vec<u32> = (0..count).map_while(|_| words.next()?.parse().ok()).collect();
        fan(&mut mesh, &corners);
    }
    (!mesh.triangles.is_empty()).then_some(mesh)
}

fn stl(bytes: &[u8]) -> Option<PlainMesh> {
    let mut mesh = PlainMesh::default();
    let mut numbers = std::collections::HashMap::new();
    for record in bytes[84..].chunks_exact(50) {
        let float = |i: usize| f32::from_le_bytes(record[4 * i..4 * i + 4].try_into().unwrap());
        let triangle = [3, 6, 9].map(|start| {
            let point = [0, 1, 2].map(|i| float(start + i));
            *numbers.entry(point.map(f32::to_bits)).or_insert_with(|| {
                mesh.positions.push(point.map(f64::from));
                mesh.positions.len() as u32 - 1
            })
        });
        mesh.triangles.push(triangle);
    }
    Some(mesh)
}

fn medit(text: &str) -> Option<PlainMesh> {
    let mut mesh = PlainMesh::default();
    let mut words = words(text);
    while let Some(word) = words.next() {
        let mut next = || words.next().unwrap();
        match word {
            "Vertices" => {
                for _ in 0..next().parse::<usize>().ok()? {
                    mesh.positions.push([(); 3].map(|()| next().parse().unwrap()));
                    next();
                }
            }
            "Tetrahedra" => {
                for _ in 0..next().parse::<usize>().ok()? {
                    mesh.tetrahedra.push([(); 4].map(|()| next().parse::<u32>().unwrap() - 1));
                    next();
                }
            }
            _ => {}
        }
    }
    Some(mesh)
}

fn msh(text: &str) -> Option<PlainMesh> {
    let mut mesh = PlainMesh::default();
    let mut lines = text.lines();
    let mut numbers = std::collections::HashMap::new();
    while let Some(line) = lines.next() {
        if line == "$Nodes" {
            for _ in 0..lines.next()?.trim().parse::<usize>().ok()? {
                let words: Vec<&str> = lines.next()?.split_whitespace().collect();
                numbers.insert(words[0], mesh.positions.len() as u32);
                mesh.positions.push([1, 2, 3].map(|i| words[i].parse().unwrap()));
            }
        } else if line == "$Elements" {
            for _ in 0..lines.next()?.trim().parse::<usize>().ok()? {
                let words: Vec<&str> = lines.next()?.split_whitespace().collect();
                let tags: usize = words[2].parse().ok()?;
                if words[1] == "4" {
                    mesh.tetrahedra.push([0, 1, 2, 3].map(|i| numbers[words[3 + tags + i]]));
                }
            }
        }
    }
    Some(mesh)
}

/// Legacy VTK of the older kind, text or binary.
fn vtk(bytes: &[u8]) -> Option<PlainMesh> {
    let mut mesh = PlainMesh::default();
    let mut at = 0;
    let line = |at: &mut usize| {
        let end = bytes[*at..].iter().position(|&b| b == b'\n').map(|n| *at + n)?;
        let line = String::from_utf8_lossy(&bytes[*at..end]).into_owned();
        *at = end + 1;
        Some(line)
    };
    let mut is_binary = false;
    while let Some(header) = line(&mut at) {
        let words: Vec<&str> = header.split_whitespace().collect();
        match words[..] {
            ["BINARY"] => is_binary = true,
            ["POINTS", count, _] => {
                let values = numbers(bytes, &mut at, 3 * count.parse::<usize>().ok()?, is_binary, true);
                mesh.positions = values.chunks(3).map(|p| [p[0], p[1], p[2]]).collect();
            }
            ["CELLS", _, total] => {
                let values = numbers(bytes, &mut at, total.parse().ok()?, is_binary, false);
                let mut rest = &values[..];
                while let Some(&count) = rest.first() {
                    if count == 4.0 {
                        mesh.tetrahedra.push([1, 2, 3, 4].map(|i| rest[i] as u32));
                    }
                    rest = &rest[count as usize + 1..];
                }
                return Some(mesh);
            }
            _ => {}
        }
    }
    None
}

/// `count` numbers of a VTK file from byte `at` on: doubles or 32-bit integers, or text.
fn numbers(bytes: &[u8], at: &mut usize, count: usize, is_binary: bool, is_real: bool) -> Vec<f64> {
    if is_binary {
        let width = if is_real { 8 } else { 4 };
        let block = &bytes[*at..*at + count * width];
        *at += count * width;
        let real = |b: &[u8]| f64::from_be_bytes(b.try_into().unwrap());
        let integer = |b: &[u8]| f64::from(i32::from_be_bytes(b.try_into().unwrap()));
        return block.chunks(width).map(|b| if is_real { real(b) } else { integer(b) }).collect();
    }
    let mut values = Vec::with_capacity(count);
    while values.len() < count {
        while bytes[*at].is_ascii_whitespace() {
            *at += 1;
        }
        let length = bytes[*at..].iter().position(|b| b.is_ascii_whitespace()).unwrap_or(bytes.len() - *at);
        values.push(std::str::from_utf8(&bytes[*at..*at + length]).unwrap().parse().unwrap());
        *at += length;
    }
    values
}

/// An abstract complex: `{"vertices": n, "facets": [[a, b, c, d], ...]}`.
fn facets(text: &str) -> Option<PlainMesh> {
    let value: serde_json::Value = serde_json::from_str(text).ok()?;
    let rows = value.get("facets")?.as_array()?;
    let number = |v: &serde_json::Value| v.as_u64().unwrap() as u32;
    let tetrahedra = rows.iter().map(|row| [0, 1, 2, 3].map(|i| number(&row[i]))).collect();
    Some(PlainMesh { tetrahedra, ..PlainMesh::default() })
}
