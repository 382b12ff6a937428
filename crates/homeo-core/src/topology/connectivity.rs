//! Pieces, orientation and links of a glued complex.

use super::gluing::Gluing;
use crate::mesh::{CellId, Facet, SimplicialComplex, VertexId};

/// The cells at each vertex, as (cell, number of the vertex in it).
pub(super) struct Corners {
    starts: Vec<u32>,
    corners: Vec<Facet>,
}

impl Corners {
    /// Linear: a counting sort by vertex.
    pub(super) fn new<const K: usize>(complex: &SimplicialComplex<K>) -> Self {
        let mut starts = vec![0u32; complex.vertex_count() + 1];
        for vertex in complex.cells().iter().flatten() {
            starts[vertex.index() + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut corners = vec![Facet::NONE; complex.cell_count() * K];
        for (index, cell) in complex.cells().iter().enumerate() {
            for (number, vertex) in cell.iter().enumerate() {
                let place = &mut fill[vertex.index()];
                corners[*place as usize] = Facet::new(CellId::new(index), number);
                *place += 1;
            }
        }
        Self { starts, corners }
    }

    /// The corners at a vertex, by ascending cell.
    #[inline]
    pub(super) fn at(&self, vertex: usize) -> &[Facet] {
        &self.corners[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// Vertices of no cell.
    pub(super) fn isolated(&self) -> Vec<[u32; 1]> {
        let empty = |&v: &usize| self.starts[v] == self.starts[v + 1];
        (0..self.starts.len() - 1).filter(empty).map(|v| [v as u32]).collect()
    }
}

/// Pieces that hang together by facets, and a turn of each cell that makes the piece consistent.
pub(super) struct Sheets {
    /// The sheet of each cell; sheets are numbered by their lowest cells.
    pub of_cell: Vec<u32>,
    /// How many there are.
    pub count: usize,
    /// Whether a cell must be turned round to agree with the lowest cell of its sheet.
    pub turned: Vec<bool>,
    /// For each sheet with a contradiction two neighbours that show it.
    pub contradictions: Vec<[u32; 2]>,
    /// Whether all neighbours in the sheet turn the same way.
    pub consistent: Vec<bool>,
}

impl Sheets {
    /// Linear: a search across facets.
    pub(super) fn new<const K: usize>(gluing: &Gluing<K>) -> Self {
        let cells = gluing.across.len();
        let mut sheets = Self {
            of_cell: vec![u32::MAX; cells],
            count: 0,
            turned: vec![false; cells],
            contradictions: Vec::new(),
            consistent: Vec::new(),
        };
        let mut stack = Vec::new();
        for seed in 0..cells {
            if sheets.of_cell[seed] == u32::MAX {
                let sheet = sheets.count as u32;
                sheets.count += 1;
                sheets.of_cell[seed] = sheet;
                sheets.consistent.push(true);
                stack.push(seed);
                sheets.flood(gluing, sheet, &mut stack);
            }
        }
        sheets
    }

    fn flood<const K: usize>(&mut self, gluing: &Gluing<K>, sheet: u32, stack: &mut Vec<usize>) {
        let mut contradiction = None;
        while let Some(cell) = stack.pop() {
            for (i, facet) in gluing.across[cell].iter().enumerate().filter(|(_, facet)| facet.is_some()) {
                let other = facet.cell().index();
                let agrees = gluing.agrees(cell, i);
                self.consistent[sheet as usize] &= agrees;
                // Turned exclusive-or disagreeing.
                let turned = self.turned[cell] == agrees;
                if self.of_cell[other] == u32::MAX {
                    self.of_cell[other] = sheet;
                    self.turned[other] = turned;
                    stack.push(other);
                } else if self.turned[other] != turned && contradiction.is_none() {
                    contradiction = Some([cell.min(other) as u32, cell.max(other) as u32]);
                }
            }
        }
        self.contradictions.extend(contradiction);
    }

    /// The fewest cells to turn round so that every orientable sheet is consistent, ascending.
    pub(super) fn cells_to_turn(&self) -> Vec<u32> {
        let mut balance = vec![0i64; self.count];
        for (cell, &turned) in self.turned.iter().enumerate() {
            balance[self.of_cell[cell] as usize] += if turned { 1 } else { -1 };
        }
        (0..self.turned.len() as u32)
            .filter(|&cell| self.turned[cell as usize] != (balance[self.of_cell[cell as usize] as usize] > 0))
            .collect()
    }

    /// Number of pieces when sheets that share a vertex count as one.
    pub(super) fn components<const K: usize>(&self, complex: &SimplicialComplex<K>) -> usize {
        let mut parent: Vec<u32> = (0..self.count as u32).collect();
        let find = |parent: &mut Vec<u32>, mut sheet: u32| {
            while parent[sheet as usize] != sheet {
                parent[sheet as usize] = parent[parent[sheet as usize] as usize];
                sheet = parent[sheet as usize];
            }
            sheet
        };
        let mut at_vertex = vec![u32::MAX; complex.vertex_count()];
        let mut components = self.count;
        for (cell, vertices) in complex.cells().iter().enumerate() {
            let sheet = self.of_cell[cell];
            for vertex in vertices {
                let seen = &mut at_vertex[vertex.index()];
                if *seen == u32::MAX {
                    *seen = sheet;
                } else if *seen != sheet {
                    let (a, b) = (find(&mut parent, *seen), find(&mut parent, sheet));
                    if a != b {
                        parent[a.max(b) as usize] = a.min(b);
                        components -= 1;
                    }
                }
            }
        }
        components
    }
}

/// Walks the link of a vertex from facet to facet.
pub(super) struct LinkWalk {
    /// Bit `i`: corner `i` of the cell was reached.
    reached: Vec<u8>,
    stack: Vec<Facet>,
}

impl LinkWalk {
    pub(super) fn new(cells: usize) -> Self {
        Self { reached: vec![0; cells], stack: Vec::new() }
    }

    /// Whether the cells at a vertex hang together by facets at the vertex. Once for each vertex.
    pub(super) fn is_connected<const K: usize>(
        &mut self,
        complex: &SimplicialComplex<K>,
        gluing: &Gluing<K>,
        corners: &[Facet],
    ) -> bool {
        let Some(&first) = corners.first() else { return true };
        let vertex = complex.cells()[first.cell().index()][first.opposite()];
        let mut count = 1;
        self.reached[first.cell().index()] |= 1 << first.opposite();
        self.stack.push(first);
        while let Some(corner) = self.stack.pop() {
            let row = &gluing.across[corner.cell().index()];
            for facet in (0..K).filter(|&i| i != corner.opposite()).map(|i| row[i]).filter(|f| f.is_some()) {
                let cell = facet.cell().index();
                let number = number_of(&complex.cells()[cell], vertex);
                if self.reached[cell] >> number & 1 == 0 {
                    self.reached[cell] |= 1 << number;
                    count += 1;
                    self.stack.push(Facet::new(facet.cell(), number));
                }
            }
        }
        count == corners.len()
    }
}

/// The number of `vertex` in a cell that contains it.
#[inline]
pub(super) fn number_of<const K: usize>(cell: &[VertexId; K], vertex: VertexId) -> usize {
    (0..K - 1).find(|&i| cell[i] == vertex).unwrap_or(K - 1)
}
