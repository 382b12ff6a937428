//! Statistics of the distortion, and its histogram as inline SVG.

use super::page::{grouped, rounded};
use std::fmt::Write;

const BINS: usize = 48;

/// The distribution of the distortion over the cells.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Statistics {
    /// Cells.
    pub cells: usize,
    /// Cells whose distortion is not finite.
    pub collapsed: usize,
    /// The least ratio that half of the cells do not exceed (infinite where most cells collapse).
    pub median: f64,
    /// The least ratio that 95 % of the cells do not exceed.
    pub percentile_95: f64,
    /// The largest finite ratio, 1 where there is none.
    pub largest: f64,
    /// End of the axis, in powers of ten.
    pub decades: f64,
    /// Finite cells by bin; bins split `0..decades` evenly.
    pub bins: Vec<usize>,
}

impl Statistics {
    /// Counts; `None` where there are no cells. NaN counts as infinite.
    pub fn of(distortion: &[f64]) -> Option<Self> {
        if distortion.is_empty() {
            return None;
        }
        let clean = |&ratio: &f64| if ratio.is_nan() { f64::INFINITY } else { ratio.max(1.0) };
        let mut sorted: Vec<f64> = distortion.iter().map(clean).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let finite = sorted.partition_point(|ratio| ratio.is_finite());
        let quantile = |share: f64| sorted[((share * sorted.len() as f64).ceil() as usize).clamp(1, sorted.len()) - 1];
        let largest = sorted[..finite].last().copied().unwrap_or(1.0);
        let decades = (largest.log10() * 1.02).max(0.5);
        let mut bins = vec![0; BINS];
        for ratio in &sorted[..finite] {
            bins[((ratio.log10() / decades * BINS as f64) as usize).min(BINS - 1)] += 1;
        }
        let collapsed = sorted.len() - finite;
        let (median, percentile_95) = (quantile(0.5), quantile(0.95));
        Some(Self { cells: sorted.len(), collapsed, median, percentile_95, largest, decades, bins })
    }

    /// The ratio at which the colour scale ends: a power of ten that most cells do not exceed.
    pub fn colour_end(&self) -> f64 {
        let typical = if self.percentile_95.is_finite() { self.percentile_95 } else { self.largest };
        10_f64.powf(typical.log10().ceil().clamp(1.0, 6.0))
    }
}

/// Plot area in the units of the drawing.
const LEFT: f64 = 52.0;
const RIGHT: f64 = 628.0;
const TOP: f64 = 46.0;
const BOTTOM: f64 = 214.0;

/// The histogram as an `<svg>` element that takes its colours from the page.
pub(super) fn histogram_svg(statistics: &Statistics) -> String {
    let mut svg = String::new();
    let summary = format!(
        "Histogram of the distortion of {} cells on a logarithmic axis from 1 to {}. Median {}, 95 percent of the cells at most {}.",
        grouped(statistics.cells),
        rounded(statistics.largest),
        rounded(statistics.median),
        rounded(statistics.percentile_95)
    );
    // Writing to a string cannot fail, so results of `write!` are ignored here and below.
    let _ = write!(svg, r#"<svg class="histogram" viewBox="0 0 640 262" role="img" aria-label="{summary}">"#);
    let tallest = statistics.bins.iter().copied().max().unwrap_or(0).max(1);
    let top_share = nice_share(100.0 * tallest as f64 / statistics.cells as f64);
    draw_grid(&mut svg, top_share);
    draw_bars(&mut svg, statistics, top_share);
    draw_axis(&mut svg, statistics);
    draw_marks(&mut svg, statistics);
    svg.push_str("</svg>");
    svg
}

fn x_of(statistics: &Statistics, ratio: f64) -> f64 {
    LEFT + (RIGHT - LEFT) * (ratio.log10() / statistics.decades).clamp(0.0, 1.0)
}

/// The next of 1, 2, 4, 5, 10, 20, … percent.
fn nice_share(percent: f64) -> f64 {
    let power = 10_f64.powf(percent.max(0.01).log10().floor());
    [1.0, 2.0, 4.0, 5.0, 10.0].iter().map(|step| step * power).find(|&nice| nice >= percent).unwrap_or(100.0).min(100.0)
}

fn draw_grid(svg: &mut String, top_share: f64) {
    for step in 0..=4 {
        let y = BOTTOM - (BOTTOM - TOP) * f64::from(step) / 4.0;
        let label = rounded(top_share * f64::from(step) / 4.0);
        let _ = write!(svg, r#"<line class="grid" x1="{LEFT}" x2="{RIGHT}" y1="{y:.1}" y2="{y:.1}"/>"#);
        let _ = write!(svg, r#"<text x="{}" y="{:.1}" text-anchor="end">{label}</text>"#, LEFT - 6.0, y + 4.0);
    }
    let _ = write!(svg, r#"<text x="4" y="14">share of the cells, %</text>"#);
}

fn draw_bars(svg: &mut String, statistics: &Statistics, top_share: f64) {
    let width = (RIGHT - LEFT) / BINS as f64;
    let ratio_at = |bin: usize| 10_f64.powf(statistics.decades * bin as f64 / BINS as f64);
    for (bin, &count) in statistics.bins.iter().enumerate().filter(|(_, count)| **count > 0) {
        let share = 100.0 * count as f64 / statistics.cells as f64;
        // One unit at least, so that a single cell among a million can be seen.
        let height = ((BOTTOM - TOP) * share / top_share).max(1.0);
        let (x, y) = (LEFT + width * bin as f64, BOTTOM - height);
        let _ = write!(svg, r#"<rect x="{:.2}" y="{y:.2}" width="{:.2}" height="{height:.2}">"#, x + 0.5, width - 1.0);
        let (from, to) = (rounded(ratio_at(bin)), rounded(ratio_at(bin + 1)));
        let _ = write!(svg, "<title>{from} to {to}: {} cells</title></rect>", grouped(count));
    }
}

fn draw_axis(svg: &mut String, statistics: &Statistics) {
    let _ = write!(svg, r#"<line class="axis" x1="{LEFT}" x2="{RIGHT}" y1="{BOTTOM}" y2="{BOTTOM}"/>"#);
    let multiples: &[f64] = match statistics.decades {
        short if short < 0.8 => &[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0],
        middle if middle < 3.0 => &[1.0, 2.0, 5.0],
        _ => &[1.0],
    };
    let stride = (statistics.decades / 12.0).ceil().max(1.0) as usize;
    for decade in (0..=statistics.decades.floor() as i32).step_by(stride) {
        for multiple in multiples {
            let ratio = multiple * 10_f64.powi(decade);
            if ratio.log10() > statistics.decades {
                continue;
            }
            let x = x_of(statistics, ratio);
            let _ = write!(svg, r#"<line class="axis" x1="{x:.1}" x2="{x:.1}" y1="{BOTTOM}" y2="{}"/>"#, BOTTOM + 5.0);
            let label = if decade > 4 {
                format!("10<tspan dy=\"-5\" font-size=\"9\">{decade}</tspan>")
            } else {
                rounded(ratio)
            };
            let _ = write!(svg, r#"<text x="{x:.1}" y="{}" text-anchor="middle">{label}</text>"#, BOTTOM + 19.0);
        }
    }
    let middle = (LEFT + RIGHT) / 2.0;
    let _ = write!(
        svg,
        r#"<text x="{middle}" y="{}" text-anchor="middle">largest over smallest stretch in a cell (a ratio, logarithmic axis)</text>"#,
        BOTTOM + 40.0
    );
}

fn draw_marks(svg: &mut String, statistics: &Statistics) {
    let marks = [("median", statistics.median), ("95 %", statistics.percentile_95)];
    let mut free_from = LEFT;
    for (name, ratio) in marks.into_iter().filter(|(_, ratio)| ratio.is_finite()) {
        let x = x_of(statistics, ratio);
        let label = format!("{name} {}", rounded(ratio));
        // About seven units per character; a label that would hit the one before it moves to the right.
        let half = 3.5 * label.chars().count() as f64;
        let centre = x.max(free_from + half).min(RIGHT - half);
        free_from = centre + half + 6.0;
        let _ = write!(svg, r#"<line class="mark" x1="{x:.1}" x2="{x:.1}" y1="{}" y2="{BOTTOM}"/>"#, TOP - 10.0);
        let _ =
            write!(svg, r#"<text class="mark" x="{centre:.1}" y="{}" text-anchor="middle">{label}</text>"#, TOP - 14.0);
    }
}
