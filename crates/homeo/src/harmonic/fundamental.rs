//! The method of fundamental solutions (section 5.1.3).

use std::f64::consts::TAU;

use faer::{Mat, c64};
use homeo_core::planar::{PlanarDomain, Point2};

use super::condition::BoundaryData;
use super::{HarmonicFunctionError, HarmonicFunctions, check_length};

/// Where sites and nodes lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FundamentalParams {
    /// About how many sites there are, evenly along the boundary.
    pub sites: usize,
    /// How far outside they lie, in units of the distance between sites; nearer where the outside is narrow.
    pub distance: f64,
    /// How many nodes for each site: values are fitted there.
    pub nodes_per_site: usize,
}

impl Default for FundamentalParams {
    fn default() -> Self {
        Self { sites: 200, distance: 2.0, nodes_per_site: 4 }
    }
}

/// A site that has no room is tried nearer to the boundary so often, by half each time, and then left out.
const MOST_HALVINGS: usize = 8;

/// Most entries of the dense least-squares matrix.
const MOST_ENTRIES: usize = 40_000_000;

/// Functions that are sums of logarithms of distances to sites outside, and linear functions.
///
/// Harmonic inside to rounding; given values are met in the least squares sense at nodes on the boundary, and missed
/// between and at them, most near corners. On the boundary the sum itself is returned.
///
/// # Complexity
/// A singular value decomposition of `#nodes` by `#sites + 3`; a logarithm for each site at a point.
///
/// ```
/// use homeo::harmonic::{BoundaryData, FundamentalParams, FundamentalSolutions, HarmonicFunctions, Profile};
/// use homeo_core::planar::PlanarDomain;
/// let square = PlanarDomain::new(vec![vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]])?;
/// let data = BoundaryData::new(&[[0.0], [2.0], [2.0], [0.0]], Profile::Linear)?;
/// let functions = FundamentalSolutions::new(&square, &data, &FundamentalParams::default())?;
/// let mut value = [0.0];
/// functions.values_into([0.3, 1.9], &mut value)?;
/// assert!((value[0] - 0.3).abs() < 1e-10 && functions.boundary_residual() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct FundamentalSolutions {
    domain: PlanarDomain,
    /// What coordinates are multiplied by, and the centre, scaled: both keep numbers near 1.
    scale: f64,
    centre: Point2,
    /// Scaled, from the centre.
    sites: Vec<Point2>,
    /// Site by site, then those of 1, x and y: all functions.
    weights: Vec<f64>,
    functions: usize,
    residual: f64,
}

/// A node on the boundary and what it is a mean of.
struct Node {
    point: Point2,
    vertices: [usize; 2],
    share: f64,
}

impl FundamentalSolutions {
    /// Places sites and fits their weights.
    ///
    /// # Errors
    /// A parameter is out of range, there is not one row of values for each vertex, or the fit fails.
    pub fn new(
        domain: &PlanarDomain,
        data: &BoundaryData,
        params: &FundamentalParams,
    ) -> Result<Self, HarmonicFunctionError> {
        data.check(domain.vertex_count())?;
        let bad = |name, value, range| Err(HarmonicFunctionError::BadParameter { name, value, range });
        match params {
            FundamentalParams { sites: 0, .. } => return bad("sites", 0.0, "1 or more"),
            FundamentalParams { distance, .. } if *distance <= 0.0 || !distance.is_finite() => {
                return bad("distance", *distance, "a number above 0");
            }
            FundamentalParams { nodes_per_site, .. } if *nodes_per_site < 2 => {
                return bad("nodes_per_site", *nodes_per_site as f64, "2 or more");
            }
            _ => {}
        }
        let scale = 2f64.powi(-(domain.diagonal().log2().floor() as i32));
        let [low, high] = domain.bounds();
        let centre = [0, 1].map(|k| 0.5 * (low[k] + high[k]) * scale);
        let mut fit = Self {
            domain: domain.clone(),
            scale,
            centre,
            sites: Vec::new(),
            weights: Vec::new(),
            functions: data.functions,
            residual: 0.0,
        };
        fit.sites = sites(domain, params).into_iter().map(|p| fit.local(p)).collect();
        let nodes = nodes(domain, params.sites.saturating_mul(params.nodes_per_site));
        let (rows, columns) = (nodes.len(), fit.sites.len() + 3);
        if rows.saturating_mul(columns) > MOST_ENTRIES {
            return Err(HarmonicFunctionError::TooLarge { unknowns: columns, most: MOST_ENTRIES / rows });
        }
        fit.solve(&nodes, data)?;
        Ok(fit)
    }

    /// How many unknowns each function has: one for each site and three.
    pub fn unknown_count(&self) -> usize {
        self.sites.len() + 3
    }

    /// By how much given values are missed at the nodes, at most.
    pub fn boundary_residual(&self) -> f64 {
        self.residual
    }

    fn local(&self, point: Point2) -> Point2 {
        [0, 1].map(|k| point[k] * self.scale - self.centre[k])
    }

    /// Least squares by singular values; those below rounding are left out.
    fn solve(&mut self, nodes: &[Node], data: &BoundaryData) -> Result<(), HarmonicFunctionError> {
        let (rows, columns) = (nodes.len(), self.sites.len() + 3);
        let basis: Vec<Vec<f64>> = nodes.iter().map(|node| self.basis(self.local(node.point))).collect();
        let right = Mat::from_fn(rows, self.functions, |i, f| nodes[i].value(data, f));
        let matrix = Mat::from_fn(rows, columns, |i, j| basis[i][j]);
        let failed = HarmonicFunctionError::Singular("its singular values were not found");
        let decomposition = matrix.thin_svd().map_err(|_| failed)?;
        let values: Vec<f64> = decomposition.S().column_vector().iter().copied().collect();
        let least = values.first().copied().unwrap_or(0.0) * f64::EPSILON * rows as f64;
        let turned = decomposition.U().transpose() * &right;
        let divided = Mat::from_fn(values.len(), self.functions, |i, f| {
            if values[i] > least { turned[(i, f)] / values[i] } else { 0.0 }
        });
        let weights = decomposition.V() * &divided;
        let missed = &matrix * &weights - &right;
        self.weights =
            (0..columns * self.functions).map(|k| weights[(k / self.functions, k % self.functions)]).collect();
        let all = (0..rows).flat_map(|i| (0..self.functions).map(move |f| (i, f)));
        self.residual = all.map(|(i, f)| missed[(i, f)].abs()).fold(0.0, f64::max);
        match self.weights.iter().all(|w| w.is_finite()) {
            true => Ok(()),
            false => Err(HarmonicFunctionError::Singular("the weights are not finite")),
        }
    }

    /// The values of all basis functions at a local point.
    fn basis(&self, [x, y]: Point2) -> Vec<f64> {
        let logarithm = |site: &Point2| -(x - site[0]).hypot(y - site[1]).ln() / TAU;
        self.sites.iter().map(logarithm).chain([1.0, x, y]).collect()
    }

    fn row(&self, basis: usize) -> &[f64] {
        &self.weights[basis * self.functions..(basis + 1) * self.functions]
    }

    fn check(&self, point: Point2) -> Result<Point2, HarmonicFunctionError> {
        if !point.iter().all(|x| x.is_finite()) {
            return Err(HarmonicFunctionError::NotFinite { point });
        }
        match self.domain.contains(point) {
            true => Ok(self.local(point)),
            false => Err(HarmonicFunctionError::Outside { point }),
        }
    }
}

impl Node {
    fn value(&self, data: &BoundaryData, function: usize) -> f64 {
        let [begin, end] = self.vertices.map(|v| data.at_vertex(v)[function]);
        begin + (end - begin) * data.profile.at(self.share)
    }
}

/// Evenly along the boundary, about so many in all; at least one on each edge.
fn nodes(domain: &PlanarDomain, count: usize) -> Vec<Node> {
    let length = |[a, b]: [Point2; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    let spacing = domain.edges().map(length).sum::<f64>() / count as f64;
    let mut nodes = Vec::new();
    let mut first = 0;
    for ring in domain.rings() {
        for i in 0..ring.len() {
            let next = (i + 1) % ring.len();
            let (a, b) = (ring[i], ring[next]);
            let n = (length([a, b]) / spacing).ceil().max(1.0) as usize;
            nodes.extend((0..n).map(|j| {
                let share = (j as f64 + 0.5) / n as f64;
                let point = [0, 1].map(|k| a[k] + share * (b[k] - a[k]));
                Node { point, vertices: [first + i, first + next], share }
            }));
        }
        first += ring.len();
    }
    nodes
}

/// Sites to the right of edges, outside the domain and not too near to it.
fn sites(domain: &PlanarDomain, params: &FundamentalParams) -> Vec<Point2> {
    let edges: Vec<[Point2; 2]> = domain.edges().collect();
    let length = |[a, b]: [Point2; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
    let usual = params.distance * edges.iter().copied().map(length).sum::<f64>() / params.sites as f64;
    let vertices: Vec<Point2> = domain.vertices().collect();
    let outside = |node: &Node| {
        let [a, b] = node.vertices.map(|v| vertices[v]);
        let normal = [b[1] - a[1], a[0] - b[0]].map(|x| x / length([a, b]));
        (0..=MOST_HALVINGS).find_map(|halvings| {
            let offset = usual * 0.5f64.powi(halvings as i32);
            let site = [0, 1].map(|k| node.point[k] + offset * normal[k]);
            let is_free = edges.iter().all(|edge| distance(site, edge) > 0.5 * offset);
            (is_free && !domain.contains(site)).then_some(site)
        })
    };
    nodes(domain, params.sites).iter().filter_map(outside).collect()
}

fn distance(p: Point2, [a, b]: &[Point2; 2]) -> f64 {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let s = ((u[0] * v[0] + u[1] * v[1]) / (u[0] * u[0] + u[1] * u[1])).clamp(0.0, 1.0);
    (v[0] - s * u[0]).hypot(v[1] - s * u[1])
}

impl HarmonicFunctions for FundamentalSolutions {
    fn function_count(&self) -> usize {
        self.functions
    }

    fn values_into(&self, point: Point2, values: &mut [f64]) -> Result<(), HarmonicFunctionError> {
        check_length(values.len(), self.functions)?;
        let [x, y] = self.check(point)?;
        values.fill(0.0);
        let mut add = |basis: usize, value: f64| {
            values.iter_mut().zip(self.row(basis)).for_each(|(sum, weight)| *sum += weight * value);
        };
        for (i, site) in self.sites.iter().enumerate() {
            add(i, -(x - site[0]).hypot(y - site[1]).ln() / TAU);
        }
        [1.0, x, y].into_iter().enumerate().for_each(|(k, value)| add(self.sites.len() + k, value));
        Ok(())
    }

    fn gradients_into(
        &self,
        point: Point2,
        values: &mut [f64],
        gradients: &mut [Point2],
    ) -> Result<(), HarmonicFunctionError> {
        check_length(gradients.len(), self.functions)?;
        self.values_into(point, values)?;
        let [x, y] = self.check(point)?;
        gradients.fill([0.0; 2]);
        let mut add = |basis: usize, slope: c64| {
            let slope = slope * self.scale;
            let sums = gradients.iter_mut().zip(self.row(basis));
            sums.for_each(|(sum, w)| *sum = [sum[0] + w * slope.re, sum[1] + w * slope.im]);
        };
        for (i, site) in self.sites.iter().enumerate() {
            let (dx, dy) = (x - site[0], y - site[1]);
            add(i, c64::new(dx, dy) * (-1.0 / (TAU * (dx * dx + dy * dy))));
        }
        add(self.sites.len() + 1, c64::new(1.0, 0.0));
        add(self.sites.len() + 2, c64::new(0.0, 1.0));
        Ok(())
    }
}
