//! Meshes made in code, by class: disks of triangles and balls of tetrahedra.

pub mod balls;
pub mod disks;
pub mod hard;

use homeo::input::SourceMesh;
use homeo_core::mesh::{SimplicialComplex, VertexId};
use homeo_core::predicate::{Sign, orient3d};

use crate::random::Random;

/// Coordinates and cells.
#[derive(Clone, Debug)]
pub struct Shape<const K: usize> {
    pub positions: Vec<[f64; 3]>,
    pub cells: Vec<[u32; K]>,
}

impl<const K: usize> Shape<K> {
    /// As the constructions take it.
    ///
    /// # Panics
    /// If a tetrahedron is not positively oriented, exactly: the generator is wrong then.
    pub fn mesh(&self) -> SourceMesh<K> {
        for cell in &self.cells {
            let corners = cell.map(|v| self.positions[v as usize]);
            if K == 4 {
                let sign = orient3d(corners[0], corners[1], corners[2], corners[K - 1]);
                assert_ne!(sign, Sign::Zero, "{cell:?} is flat");
            }
        }
        let cells = self.cells.iter().map(|&cell| self.oriented(cell).map(VertexId::from)).collect();
        let complex = SimplicialComplex::new(self.positions.len(), cells).expect("indices below the vertex count");
        SourceMesh::new(self.positions.clone(), complex)
    }

    /// A tetrahedron with two corners exchanged where that makes it positive.
    fn oriented(&self, mut cell: [u32; K]) -> [u32; K] {
        if K == 4 {
            let c = cell.map(|v| self.positions[v as usize]);
            // `orient3d` of the core is positive for positively oriented tetrahedra.
            if orient3d(c[0], c[1], c[2], c[K - 1]) == Sign::Negative {
                cell.swap(0, 1);
            }
        }
        cell
    }

    /// Each coordinate changed by a function of the point.
    pub fn moved(mut self, change: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.positions.iter_mut().for_each(|p| *p = change(*p));
        self
    }

    /// Coordinates times `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        self.moved(|p| p.map(|x| x * factor))
    }

    /// Coordinates plus `offset`.
    pub fn offset(self, offset: f64) -> Self {
        self.moved(|p| p.map(|x| x + offset))
    }

    /// Vertices and cells in another order, and cells begun at another corner.
    pub fn shuffled(self, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut number: Vec<u32> = (0..self.positions.len() as u32).collect();
        random.shuffle(&mut number);
        let mut positions = self.positions.clone();
        number.iter().zip(&self.positions).for_each(|(&to, &p)| positions[to as usize] = p);
        let mut cells: Vec<[u32; K]> = self.cells.iter().map(|cell| cell.map(|v| number[v as usize])).collect();
        random.shuffle(&mut cells);
        for cell in &mut cells {
            cell.rotate_left(random.below(K as u64) as usize);
        }
        Self { positions, cells }
    }

    /// A vertex at the centroid of every face of every dimension above 0, all joined up.
    pub fn barycentric(&self) -> Self {
        let mut numbers = std::collections::BTreeMap::new();
        let mut positions = self.positions.clone();
        let mut cells = Vec::new();
        for cell in &self.cells {
            for order in permutations::<K>() {
                cells.push(std::array::from_fn(|length| {
                    let mut face: Vec<u32> = order[..=length].iter().map(|&i| cell[i]).collect();
                    face.sort_unstable();
                    if let [vertex] = face[..] {
                        return vertex;
                    }
                    *numbers.entry(face.clone()).or_insert_with(|| {
                        let mean = |axis: usize| {
                            face.iter().map(|&v| self.positions[v as usize][axis]).sum::<f64>() / face.len() as f64
                        };
                        positions.push([mean(0), mean(1), mean(2)]);
                        positions.len() as u32 - 1
                    })
                }));
                if K == 3 && is_odd(&order) {
                    let last = cells.len() - 1;
                    cells[last].swap(0, 1);
                }
            }
        }
        Self { positions, cells }
    }

    /// Keeps the vertices that cells name.
    pub fn compacted(mut self) -> Self {
        let mut number = vec![u32::MAX; self.positions.len()];
        let mut positions = Vec::new();
        for vertex in self.cells.iter_mut().flatten() {
            let old = *vertex as usize;
            if number[old] == u32::MAX {
                number[old] = positions.len() as u32;
                positions.push(self.positions[old]);
            }
            *vertex = number[old];
        }
        Self { positions, cells: self.cells }
    }
}

fn permutations<const K: usize>() -> Vec<[usize; K]> {
    let mut all = vec![std::array::from_fn(|i| i)];
    for position in 0..K {
        all = all
            .iter()
            .flat_map(|order: &[usize; K]| {
                (position..K).map(|other| {
                    let mut order = *order;
                    order.swap(position, other);
                    order
                })
            })
            .collect();
    }
    all
}

fn is_odd(order: &[usize]) -> bool {
    let pairs = (0..order.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
    pairs.filter(|&(i, j)| order[i] > order[j]).count() % 2 == 1
}
