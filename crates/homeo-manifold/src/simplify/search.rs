//! In which order edges are collapsed and moves are made.

use super::SimplifyError;
use super::collapse::collapse;
use super::editor::{Editor, corner_at};
use super::moves::{four_to_four, reduce_at, two_to_three};
use crate::skeleton::EDGES;
use crate::triangulation::Triangulation;

/// Collapses edges until all vertices are truncated ones; of a closed manifold one vertex stays, or a few where the search
/// does not find more.
///
/// The manifold with truncated vertices cut off stays the same; see the theorem in the source of `collapse`. Where no
/// edge can be collapsed, faces are opened by moves and closed otherwise, at most some hundred times.
///
/// Cost: nearly linear for meshes in general; 100,000 tetrahedra take seconds.
///
/// # Errors
/// When faces are open, an edge is reversed, or a vertex cannot be taken away beside truncated ones.
///
/// # Example
/// ```
/// use homeo_manifold::{Skeleton, from_signature, simplify::without_inner_vertices, subdivision::subdivided};
/// let tripus = from_signature("cPcbbbihq")?;
/// let fine = subdivided(&tripus);
/// let coarse = without_inner_vertices(&fine)?;
/// assert_eq!(Skeleton::new(&coarse).vertex_count(), 1);
/// assert!(coarse.len() < fine.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn without_inner_vertices(triangulation: &Triangulation) -> Result<Triangulation, SimplifyError> {
    let mut editor = Editor::new(&breadth_first(triangulation))?;
    let mut random = Random(0);
    for attempt in 0..MOST_ATTEMPTS {
        collapse_all(&mut editor);
        if inner_vertices(&editor) <= usize::from(!has_truncated(&editor)) {
            return Ok(editor.finished());
        }
        reduce_all(&mut editor);
        let steps = 1 + editor.len() / 20 + attempt % 6;
        // Collapses come before the next reductions, which could undo the moves.
        shake(&mut editor, &mut random, steps);
    }
    match inner_vertices(&editor) {
        left if has_truncated(&editor) => Err(SimplifyError::Stuck { left }),
        _ => Ok(editor.finished()),
    }
}

/// The same with tetrahedra numbered from neighbour to neighbour. Edges are collapsed in this order: one region after the other.
/// In an order without sense vertices with large stars come up all over, and nothing can be collapsed between them.
fn breadth_first(triangulation: &Triangulation) -> Triangulation {
    const NONE: u32 = u32::MAX;
    let mut numbers = vec![NONE; triangulation.len()];
    let mut order: Vec<u32> = Vec::with_capacity(triangulation.len());
    for first in 0..triangulation.len() as u32 {
        let mut next = order.len();
        if numbers[first as usize] == NONE {
            numbers[first as usize] = next as u32;
            order.push(first);
        }
        while let Some(&here) = order.get(next) {
            next += 1;
            for there in (0..4).filter_map(|face| Some(triangulation.neighbour(here, face)?.tetrahedron)) {
                if numbers[there as usize] == NONE {
                    numbers[there as usize] = order.len() as u32;
                    order.push(there);
                }
            }
        }
    }
    let mut renumbered = Triangulation::new(triangulation.len());
    for (tetrahedron, face) in triangulation.faces() {
        let Some(gluing) = triangulation.neighbour(tetrahedron, face) else { continue };
        let (here, there) = (numbers[tetrahedron as usize], numbers[gluing.tetrahedron as usize]);
        if renumbered.neighbour(here, face).is_none() {
            let glued = renumbered.glue(here, face, there, gluing.corners);
            debug_assert!(glued.is_ok(), "{glued:?}");
        }
    }
    renumbered
}

/// How often a search that is stuck is shaken.
const MOST_ATTEMPTS: usize = 200;

/// Rings with more tetrahedra are not collapsed in the first round.
const FIRST_MOST: usize = 12;

fn has_truncated(editor: &Editor) -> bool {
    alive(editor).any(|t| editor.vertices(t).iter().any(|&vertex| editor.is_truncated(vertex)))
}

fn inner_vertices(editor: &Editor) -> usize {
    let corners = alive(editor).flat_map(|t| editor.vertices(t)).filter(|&vertex| !editor.is_truncated(vertex));
    let mut vertices: Vec<_> = corners.collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices.len()
}

fn alive(editor: &Editor) -> impl Iterator<Item = u32> + '_ {
    (0..editor.slots()).filter(|&tetrahedron| editor.is_alive(tetrahedron))
}

/// Passes over all edges until none can be collapsed.
fn collapse_all(editor: &mut Editor) {
    let mut most = FIRST_MOST;
    loop {
        let before = editor.len();
        for tetrahedron in 0..editor.slots() {
            for [a, b] in EDGES.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]) {
                if editor.is_alive(tetrahedron) {
                    collapse(editor, corner_at(tetrahedron, a, b), most);
                }
            }
        }
        if editor.len() == before {
            if most == usize::MAX {
                return;
            }
            most = usize::MAX;
        }
    }
}

/// Moves that reduce the number of tetrahedra, until there is none.
fn reduce_all(editor: &mut Editor) {
    loop {
        let before = editor.len();
        for tetrahedron in 0..editor.slots() {
            for [a, b] in EDGES {
                if editor.is_alive(tetrahedron) {
                    reduce_at(editor, tetrahedron, a, b);
                }
            }
        }
        if editor.len() == before {
            return;
        }
    }
}

/// Some moves 2-3 at random faces.
fn shake(editor: &mut Editor, random: &mut Random, steps: usize) {
    let mut alive: Vec<_> = alive(editor).collect();
    if alive.is_empty() {
        return;
    }
    for _ in 0..steps {
        let tetrahedron = alive[random.below(alive.len() as u32) as usize];
        if let Some(new) = two_to_three(editor, tetrahedron, random.below(4) as u8) {
            // Two of them have the numbers of the old ones.
            alive.extend(new.into_iter().filter(|tetrahedron| !alive.contains(tetrahedron)).collect::<Vec<_>>());
        }
    }
}

/// Moves at random edges: those that reduce the number of tetrahedra, else those that keep it.
fn wander(editor: &mut Editor, random: &mut Random, steps: usize) {
    for _ in 0..steps {
        let tetrahedron = random.below(editor.slots());
        if editor.is_alive(tetrahedron) {
            let [a, b] = EDGES[random.below(6) as usize];
            // The octahedron round an edge has two other diagonals: one for each of these ends of the walk round it.
            let edge = corner_at(tetrahedron, a, b);
            if !reduce_at(editor, tetrahedron, a, b) {
                four_to_four(editor, if random.below(2) == 0 { edge } else { edge.turned() });
            }
        }
    }
}

/// Looks for a triangulation of the same manifold with few tetrahedra.
///
/// Moves 3-2 and 2-0 are made while there are any; then moves 4-4 at random, which keep the number, and some moves 2-3, which
/// do not, and again; the smallest is kept and gone on from, also others of the same size. The search depends on the seed alone.
///
/// # Example
/// ```
/// use homeo_manifold::{from_signature, signature, simplify::{Simplifier, without_inner_vertices}, subdivision::subdivided};
/// let fine = subdivided(&from_signature("cPcbbbihq")?);
/// let mut simplifier = Simplifier::new(&without_inner_vertices(&fine)?, 1)?;
/// simplifier.run(1000);
/// assert_eq!(signature(simplifier.best()), "cPcbbbihq");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simplifier {
    best: Triangulation,
    random: Random,
}

impl Simplifier {
    /// A search from a closed triangulation.
    ///
    /// # Errors
    /// When faces are open or an edge is reversed.
    pub fn new(triangulation: &Triangulation, seed: u64) -> Result<Self, SimplifyError> {
        let mut editor = Editor::new(triangulation)?;
        reduce_all(&mut editor);
        Ok(Self { best: editor.finished(), random: Random(seed) })
    }

    /// Goes on for a number of rounds, each of a cost in proportion to the number of tetrahedra; whether a smaller one was found.
    pub fn run(&mut self, rounds: usize) -> bool {
        let before = self.best.len();
        for round in 0..rounds {
            // Every other round without moves that add tetrahedra.
            let steps =
                if round % 2 == 0 { 0 } else { 1 + self.random.below(1 + self.best.len().min(12) as u32) as usize };
            let found = self.shaken(steps);
            if found.len() <= self.best.len() {
                self.best = found;
            }
        }
        self.best.len() < before
    }

    /// The smallest so far, the latest of this size.
    pub fn best(&self) -> &Triangulation {
        &self.best
    }

    /// Another triangulation of the manifold: this many random moves 2-3, then moves 4-4, and what can be reduced then. The best
    /// one is not changed.
    pub fn shaken(&mut self, steps: usize) -> Triangulation {
        let Ok(mut editor) = Editor::new(&self.best) else { return self.best.clone() };
        shake(&mut editor, &mut self.random, steps);
        let moves = 4 * editor.slots() as usize;
        wander(&mut editor, &mut self.random, moves);
        reduce_all(&mut editor);
        editor.finished()
    }
}

/// Splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below a bound, which must not be 0.
    fn below(&mut self, bound: u32) -> u32 {
        (((self.next() >> 32) * u64::from(bound)) >> 32) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simplify::moves::two_to_one;
    use crate::subdivision::subdivided;
    use crate::{AllowedLinks, Homology, Links, Skeleton, covers, enumerate, from_signature, signature};

    fn boundary_genera(triangulation: &Triangulation) -> Vec<Option<usize>> {
        let links = Links::new(triangulation, &Skeleton::new(triangulation));
        let mut genera: Vec<_> = links.all().iter().filter(|link| !link.is_sphere()).map(|link| link.genus()).collect();
        genera.sort();
        genera
    }

    #[test]
    fn moves_and_collapses_keep_homology_and_links() {
        // The tripus, another of genus 2 with torsion of its coverings, one of genus 3, one with torus and genus 2, lens spaces.
        for name in ["cPcbbbihq", "cMcabbjik", "dLQbcccdefo", "dLQacccjjkg", "cMcabbgds", "cPcbbbiht"] {
            let triangulation = from_signature(name).unwrap();
            let (homology, genera) = (Homology::new(&triangulation), boundary_genera(&triangulation));
            let mut simplifier = Simplifier::new(&subdivided(&triangulation), 7).unwrap();
            let mut sizes = std::collections::BTreeSet::new();
            for steps in 0..12 {
                let shaken = simplifier.shaken(steps);
                sizes.insert(shaken.len());
                assert_eq!(
                    (Homology::new(&shaken), boundary_genera(&shaken)),
                    (homology.clone(), genera.clone()),
                    "{name}"
                );
                let coarse = without_inner_vertices(&shaken).unwrap();
                assert_eq!(
                    (Homology::new(&coarse), boundary_genera(&coarse)),
                    (homology.clone(), genera.clone()),
                    "{name}"
                );
                assert!(coarse.len() < shaken.len(), "{} of {}", coarse.len(), shaken.len());
            }
            assert!(sizes.len() > 1, "nothing was shaken");
        }
    }

    #[test]
    fn the_search_comes_back_to_the_tripus_from_far_away() {
        let mut simplifier = Simplifier::new(&from_signature("cPcbbbihq").unwrap(), 3).unwrap();
        for steps in [0, 2, 5, 9] {
            let mut search = Simplifier::new(&subdivided(&simplifier.shaken(steps)), steps as u64).unwrap();
            search.run(20);
            let coarse = without_inner_vertices(search.best()).unwrap();
            let mut search = Simplifier::new(&coarse, 5).unwrap();
            search.run(1000);
            assert_eq!(signature(search.best()), "cPcbbbihq");
        }
    }

    /// Gluings of three tetrahedra with an edge of degree 1, after some moves 2-3: where the edge can be taken away coverings with
    /// two and three sheets keep their homology, where not all is as it was.
    #[test]
    fn edges_of_degree_one_are_taken_away_and_the_manifold_stays() {
        let homologies = |triangulation: &Triangulation| {
            [1, 2, 3].map(|sheets| {
                let all = covers(triangulation, sheets).unwrap();
                let mut groups: Vec<String> = all.iter().map(|cover| Homology::new(cover).to_string()).collect();
                groups.sort();
                groups
            })
        };
        let (mut taken, mut left, mut random) = (0, 0, Random(3));
        for entry in enumerate(3, AllowedLinks::Higher).unwrap() {
            let mut editor = Editor::new(&entry.triangulation).unwrap();
            shake(&mut editor, &mut random, 4);
            let before = editor.finished();
            let skeleton = Skeleton::new(&before);
            let Some(edge) = skeleton.edges().iter().find(|edge| edge.corners.len() == 1) else { continue };
            let mut editor = Editor::new(&before).unwrap();
            let is_taken = two_to_one(&mut editor, edge.corners[0]);
            let after = editor.finished();
            if is_taken {
                assert_eq!(after.len() + 1, before.len(), "{}", entry.signature);
                assert_eq!(homologies(&after), homologies(&before), "{}", entry.signature);
                assert_eq!(boundary_genera(&after), boundary_genera(&before), "{}", entry.signature);
                taken += 1;
            } else {
                assert_eq!(signature(&after), signature(&before), "a move that is undone leaves what was");
                left += 1;
            }
        }
        assert!(taken >= 5 && left >= 5, "{taken} {left}");
    }

    #[test]
    fn of_no_tetrahedra_nothing_is_made() {
        let mut simplifier = Simplifier::new(&Triangulation::new(0), 1).unwrap();
        assert!(!simplifier.run(3));
        assert_eq!(simplifier.shaken(5).len(), 0);
        assert_eq!(without_inner_vertices(&Triangulation::new(0)).unwrap().len(), 0);
    }

    #[test]
    fn open_faces_are_told() {
        let open = without_inner_vertices(&Triangulation::new(1));
        assert_eq!(open.unwrap_err(), SimplifyError::Open { tetrahedron: 0, face: 0 });
    }
}
