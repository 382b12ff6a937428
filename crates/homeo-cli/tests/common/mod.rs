//! Runs the real binary in a folder of its own.
#![allow(dead_code)] // each test file uses a part

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};

use homeo_core::number::Rational;
use serde_json::Value;

/// A folder that goes away with the test.
pub struct Folder(PathBuf);

/// What a run gave.
pub struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Folder {
    pub fn new() -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("homeo-cli-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.path(name), content).unwrap();
        self
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// A copy of the bundled files.
    pub fn with_testdata(self) -> Self {
        copy(&testdata(""), &self.path("testdata"));
        self
    }

    /// Runs `homeo` here.
    pub fn homeo(&self, arguments: &[&str]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_homeo")).args(arguments).current_dir(&self.0).output().unwrap();
        Run {
            code: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs a line as it would be typed.
    pub fn line(&self, line: &str) -> Run {
        self.homeo(&line.split_whitespace().collect::<Vec<_>>())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl Run {
    #[track_caller]
    pub fn expect(self, code: i32) -> Self {
        assert_eq!(self.code, code, "stdout: {}\nstderr: {}", self.stdout, self.stderr);
        self
    }

    /// The one object on standard output.
    #[track_caller]
    pub fn json(&self) -> Value {
        assert_eq!(self.stdout.lines().count(), 1, "one line is expected: {}", self.stdout);
        serde_json::from_str(&self.stdout).unwrap()
    }
}

/// A bundled file.
pub fn testdata(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata").join(name)
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &to.join(entry.file_name()));
        } else {
            std::fs::copy(entry.path(), to.join(entry.file_name())).unwrap();
        }
    }
}

/// A MEDIT file of cubes on a grid, each cut into six tetrahedra.
pub fn cubes(cells: &[[usize; 3]]) -> String {
    const WALKS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
    let mut points: Vec<[usize; 3]> = Vec::new();
    let mut tetrahedra = Vec::new();
    for cell in cells {
        for (index, walk) in WALKS.iter().enumerate() {
            let mut at = *cell;
            let mut corners = vec![at];
            for &axis in walk {
                at[axis] += 1;
                corners.push(at);
            }
            let mut numbers: Vec<usize> = corners
                .into_iter()
                .map(|corner| {
                    points.iter().position(|p| *p == corner).unwrap_or_else(|| {
                        points.push(corner);
                        points.len() - 1
                    }) + 1
                })
                .collect();
            if index >= 3 {
                numbers.swap(2, 3);
            }
            tetrahedra.push(numbers);
        }
    }
    let mut text = format!("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", points.len());
    points.iter().for_each(|[x, y, z]| text.push_str(&format!("{x} {y} {z} 0\n")));
    text.push_str(&format!("Tetrahedra\n{}\n", tetrahedra.len()));
    tetrahedra.iter().for_each(|t| text.push_str(&format!("{} {} {} {} 0\n", t[0], t[1], t[2], t[3])));
    text.push_str("End\n");
    text
}

/// A square of `n` by `n` quads, as OBJ.
pub fn quads(n: usize) -> String {
    let mut text = String::new();
    (0..=n).for_each(|j| (0..=n).for_each(|i| text.push_str(&format!("v {i} {j} 0\n"))));
    for j in 0..n {
        for i in 0..n {
            let corner = j * (n + 1) + i + 1;
            text.push_str(&format!("f {} {} {} {}\n", corner, corner + 1, corner + n + 2, corner + n + 1));
        }
    }
    text
}

/// The surface of a tetrahedron, as OFF.
pub const CLOSED: &str = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

/// A bumpy torus of `n` by `m` quads cut into triangles, as OBJ; its coordinates are multiples of 1/1024.
pub fn torus(n: usize, m: usize) -> String {
    let mut text = String::new();
    let turn = |i: usize, n: usize| std::f64::consts::TAU * i as f64 / n as f64;
    for i in 0..n {
        for j in 0..m {
            let (u, v) = (turn(i, n), turn(j, m));
            let radius = 0.4 * (1.0 + 0.2 * (3.0 * u + 2.0 * v).sin());
            let across = 1.0 + radius * v.cos();
            let [x, y, z] =
                [across * u.cos(), across * u.sin(), radius * v.sin()].map(|x| (x * 1024.0).round() / 1024.0);
            text.push_str(&format!("v {x} {y} {z}\n"));
        }
    }
    for i in 0..n {
        for j in 0..m {
            let corner = |i: usize, j: usize| i % n * m + j % m + 1;
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            text.push_str(&format!("f {a} {b} {c}\nf {a} {c} {d}\n"));
        }
    }
    text
}

/// The vertices of an OBJ file as a table of points.
pub fn vertices(obj: &str) -> String {
    let rows = obj.lines().filter_map(|line| line.strip_prefix("v "));
    rows.fold("x,y,z\n".to_owned(), |text, row| text + &row.replace(' ', ",") + "\n")
}

pub fn rationals(table: &str) -> Vec<Rational> {
    let numbers = table.lines().skip(1).flat_map(|row| row.split(','));
    numbers.map(|x| x.parse().unwrap()).collect()
}
