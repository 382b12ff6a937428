//! Leaves as pairs of polylines whose points correspond.

use super::data::Leaf;

/// Leaves with equally many points on both sides.
#[derive(Clone, Debug, Default)]
pub(super) struct PairedLeaves {
    /// Points in the source, leaf after leaf.
    pub source: Vec<[f64; 3]>,
    /// Points in the target, leaf after leaf.
    pub image: Vec<[f64; 3]>,
    /// Where each leaf starts, and the number of points at the end.
    pub starts: Vec<u32>,
}

/// Takes every `n`-th leaf, the smallest `n` for which at most `max_points` points remain.
/// Leaves with fewer than two points on a side are left out.
pub(super) fn pair_leaves(leaves: &[Leaf], max_points: usize) -> (PairedLeaves, usize) {
    let usable: Vec<&Leaf> = leaves.iter().filter(|leaf| leaf.source.len() > 1 && leaf.target.len() > 1).collect();
    let points = |leaf: &&Leaf| {
        if leaf.source.len() == leaf.target.len() { leaf.source.len() } else { leaf.source.len() + leaf.target.len() }
    };
    let total: usize = usable.iter().map(points).sum();
    let stride = total.div_ceil(max_points.max(1)).max(1);
    let mut paired = PairedLeaves { starts: vec![0], ..Default::default() };
    let mut shown = 0;
    for leaf in usable.into_iter().step_by(stride) {
        if leaf.source.len() == leaf.target.len() {
            paired.source.extend_from_slice(&leaf.source);
            paired.image.extend_from_slice(&leaf.target);
        } else {
            let (source, image) = merge(leaf);
            paired.source.extend(source);
            paired.image.extend(image);
        }
        paired.starts.push(paired.source.len() as u32);
        shown += 1;
    }
    (paired, shown)
}

/// Both polylines at the union of their length shares.
fn merge(leaf: &Leaf) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let (source_shares, target_shares) = (length_shares(&leaf.source), length_shares(&leaf.target));
    let mut shares: Vec<f64> = source_shares.iter().chain(&target_shares).copied().collect();
    shares.sort_by(f64::total_cmp);
    shares.dedup();
    let sample = |points: &[[f64; 3]], own: &[f64]| shares.iter().map(|&share| at_share(points, own, share)).collect();
    (sample(&leaf.source, &source_shares), sample(&leaf.target, &target_shares))
}

/// For each point the share of the polyline's length that lies before it; by index where the length is zero.
fn length_shares(points: &[[f64; 3]]) -> Vec<f64> {
    let mut lengths = vec![0.0];
    let mut length = 0.0_f64;
    for pair in points.windows(2) {
        length += (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
        lengths.push(length);
    }
    let last = (points.len() - 1) as f64;
    let share = |(index, &before): (usize, &f64)| if length > 0.0 { before / length } else { index as f64 / last };
    lengths.iter().enumerate().map(share).collect()
}

/// The point at a share of the length.
fn at_share(points: &[[f64; 3]], shares: &[f64], share: f64) -> [f64; 3] {
    let after = shares.partition_point(|&own| own < share).clamp(1, points.len() - 1);
    let (p, q) = (points[after - 1], points[after]);
    let width = shares[after] - shares[after - 1];
    let weight = if width > 0.0 { ((share - shares[after - 1]) / width).clamp(0.0, 1.0) } else { 1.0 };
    std::array::from_fn(|i| p[i] + weight * (q[i] - p[i]))
}
