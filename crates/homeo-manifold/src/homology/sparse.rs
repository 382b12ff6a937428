//! Relations with an entry 1 or -1 are used to get rid of a generator each.

use dashu_int::IBig;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// A row: the generators with their coefficients, none of them zero, by ascending generator.
type Row = Vec<(u32, IBig)>;

/// What is left: no coefficient is 1 or -1.
pub(super) struct Reduced {
    /// The number of generators left.
    pub generators: usize,
    /// Relations of those that occur in any, densely; in blocks of which no two have a generator in common.
    pub blocks: Vec<Vec<Vec<IBig>>>,
}

/// Uses up all relations with an entry 1 or -1. Lightest rows come first, and in a row the generator in the fewest
/// rows: this keeps the others light. A row with a single entry, which says that a generator vanishes, costs no
/// arithmetic.
pub(super) fn without_units(generators: usize, relations: &[Vec<(u32, i64)>]) -> Reduced {
    let mut matrix = Matrix::new(generators, relations);
    let mut waiting: BinaryHeap<_> = (0..matrix.rows.len()).map(|row| Reverse((matrix.rows[row].len(), row))).collect();
    let mut left = generators;
    while let Some(Reverse((length, row))) = waiting.pop() {
        // Rows have changed since they were put in line, and were put in again.
        if length != matrix.rows[row].len() {
            continue;
        }
        let Some(generator) = matrix.pivot(row) else { continue };
        left -= 1;
        for changed in matrix.eliminate(row, generator) {
            waiting.push(Reverse((matrix.rows[changed].len(), changed)));
        }
    }
    Reduced { generators: left, blocks: matrix.into_blocks() }
}

struct Matrix {
    rows: Vec<Row>,
    /// The rows in which a generator occurs; may name rows in which it does no more.
    rows_of: Vec<Vec<u32>>,
    sum: Row,
}

impl Matrix {
    fn new(generators: usize, relations: &[Vec<(u32, i64)>]) -> Self {
        let rows: Vec<Row> = relations.iter().map(|relation| collected(relation)).collect();
        let mut rows_of = vec![Vec::new(); generators];
        for (number, row) in rows.iter().enumerate() {
            row.iter().for_each(|&(generator, _)| rows_of[generator as usize].push(number as u32));
        }
        Self { rows, rows_of, sum: Row::new() }
    }

    /// The entry 1 or -1 of a row whose generator is in the fewest rows.
    fn pivot(&self, row: usize) -> Option<u32> {
        let units = self.rows[row].iter().filter(|(_, coefficient)| is_unit(coefficient));
        units.map(|&(generator, _)| generator).min_by_key(|&generator| self.rows_of[generator as usize].len())
    }

    /// Removes a generator from all rows by means of one, in which it has the coefficient 1 or -1, and that row with
    /// it. The rows that have changed.
    fn eliminate(&mut self, row: usize, generator: u32) -> Vec<usize> {
        let pivot_row = std::mem::take(&mut self.rows[row]);
        let Ok(place) = pivot_row.binary_search_by_key(&generator, |entry| entry.0) else { return Vec::new() };
        let mut others = std::mem::take(&mut self.rows_of[generator as usize]);
        others.sort_unstable();
        others.dedup();
        let mut changed = Vec::new();
        for other in others.into_iter().map(|other| other as usize) {
            let Ok(at) = self.rows[other].binary_search_by_key(&generator, |entry| entry.0) else { continue };
            // The unit is its own inverse.
            let factor = -(&self.rows[other][at].1 * &pivot_row[place].1);
            self.add(other, &factor, &pivot_row);
            changed.push(other);
        }
        changed
    }

    /// Adds a multiple of a row to one of the matrix.
    fn add(&mut self, target: usize, factor: &IBig, addend: &Row) {
        self.sum.clear();
        let mut old = std::mem::take(&mut self.rows[target]).into_iter().peekable();
        for (generator, coefficient) in addend {
            while let Some(entry) = old.next_if(|entry| entry.0 < *generator) {
                self.sum.push(entry);
            }
            let mut value = factor * coefficient;
            match old.next_if(|entry| entry.0 == *generator) {
                Some(entry) => value += entry.1,
                None => self.rows_of[*generator as usize].push(target as u32),
            }
            if !value.is_zero() {
                self.sum.push((*generator, value));
            }
        }
        self.sum.extend(old);
        self.rows[target].append(&mut self.sum);
    }

    /// The rows that are not empty, in blocks.
    fn into_blocks(self) -> Vec<Vec<Vec<IBig>>> {
        let rows: Vec<Row> = self.rows.into_iter().filter(|row| !row.is_empty()).collect();
        let mut root_of: Vec<u32> = (0..self.rows_of.len() as u32).collect();
        for row in &rows {
            let first = root(&mut root_of, row[0].0);
            for entry in &row[1..] {
                let other = root(&mut root_of, entry.0);
                root_of[other as usize] = first;
            }
        }
        let mut block_of: BTreeMap<u32, Vec<Row>> = BTreeMap::new();
        for row in rows {
            block_of.entry(root(&mut root_of, row[0].0)).or_default().push(row);
        }
        block_of.into_values().map(dense).collect()
    }
}

/// The generator that stands for those joined to one by rows.
fn root(root_of: &mut [u32], generator: u32) -> u32 {
    let mut at = generator;
    while root_of[at as usize] != at {
        // Half of the way is cut off for the next time.
        root_of[at as usize] = root_of[root_of[at as usize] as usize];
        at = root_of[at as usize];
    }
    at
}

/// Rows over the generators that occur in them.
fn dense(rows: Vec<Row>) -> Vec<Vec<IBig>> {
    let mut used: Vec<u32> = rows.iter().flatten().map(|entry| entry.0).collect();
    used.sort_unstable();
    used.dedup();
    let spread = |row: Row| {
        let mut values = vec![IBig::ZERO; used.len()];
        for (generator, coefficient) in row {
            values[used.partition_point(|&other| other < generator)] = coefficient;
        }
        values
    };
    rows.into_iter().map(spread).collect()
}

fn is_unit(coefficient: &IBig) -> bool {
    *coefficient == IBig::ONE || *coefficient == IBig::NEG_ONE
}

/// A relation with each generator once.
fn collected(relation: &[(u32, i64)]) -> Row {
    let mut entries = relation.to_vec();
    entries.sort_unstable_by_key(|entry| entry.0);
    let sum = |equal: &[(u32, i64)]| (equal[0].0, equal.iter().map(|&(_, value)| IBig::from(value)).sum());
    entries.chunk_by(|a, b| a.0 == b.0).map(sum).filter(|entry: &(u32, IBig)| !entry.1.is_zero()).collect()
}
