//! What a mesh is: manifold, orientable, disk, ball, with every violation.
//!
//! [`analyse_triangles`] and [`analyse_tetrahedra`] look at a mesh once and say everything in a
//! report; [`self_intersections`] finds triangles that meet where they should not. Counts, yes-or-no
//! answers and violations rest on integers and exact signs; angles, areas and volumes are estimates.
//!
//! # When is a tetrahedral mesh a ball?
//!
//! Counting does not suffice: take a tetrahedron out of (sphere times circle), and all vertex links
//! are spheres or disks, the boundary is a sphere, the Euler characteristic is 1, as for a ball.
//! Hence "yes" is only said for one of two reasons, which the report names, and "no" for a reason
//! among the counts (not a connected manifold; boundary not exactly one sphere; not orientable).
//! Everything else is "unknown".
//!
//! **It is embedded in space and its boundary is one sphere.** Let `T` be a connected complex of
//! tetrahedra in which all vertex links are spheres or disks, and `f` the map to space that is linear
//! on cells, with these properties, all of them decided by exact signs:
//!
//! 1. the cells can be ordered consistently, and then all have positive volume (or all negative);
//! 2. `f` is one-to-one on the boundary: no two boundary vertices at one point, and no two boundary
//!    triangles that meet away from common vertices and edges;
//! 3. of the pieces of the boundary, seen from inside `T`, exactly one encloses a positive volume.
//!
//! Then `f` is one-to-one. For a point `q` off the images of all triangles the number of points
//! that `f` sends to `q` is a sum of signs of cells, all `+1` by 1; so it equals the degree of `f` over
//! `q`, which is the winding number of the boundary around `q`. By 2 each piece of the boundary is an
//! embedded closed surface, which winds once (or minus once) around the points inside and not at all
//! around those outside (Jordan and Brouwer). By 3 the sum is at most 1: almost every point is covered
//! once or not at all. Let now `f(x) = f(y) = q` with `x` different from `y`. By 2 one of them, say
//! `x`, is not on the boundary. The cells around `x` close up, so that the directions from `q` into
//! their images wrap the sphere of directions, every turn positive, with degree at least 1: they
//! cover a neighbourhood of `q`. The cells at `y` cover a part of positive volume of every
//! neighbourhood of `q` once more, in contradiction to what was said of almost every point.
//!
//! So `f(T)` is a compact region with boundary `f(boundary)`. If that is one sphere, the region is a ball
//! by Alexander's theorem (J. W. Alexander, On the subdivision of 3-space by a polyhedron, 1924): a
//! polyhedral sphere in space bounds a polyhedral ball.
//!
//! **It collapses to a point.** A manifold that collapses to a point is a ball (J. H. C. Whitehead,
//! 1939); the same for graphs gives handle bodies. This needs no coordinates. The search for a
//! collapse is greedy and may fail for a ball; some balls have no collapse at all (those with badly
//! knotted edges or holes).
//!
//! Hence a mesh without coordinates, or with some cells inverted, is a ball if the collapse is found,
//! and otherwise "unknown".
//!
//! # Cost
//! All of it is linear in the number of cells for meshes of bounded degree, but for the search for
//! intersections of the boundary, which is `O(n log n)` in its size.

mod ball;
mod collapse;
mod connectivity;
mod gluing;
mod intersections;
mod links;
mod measure;
mod report;
mod shape;
mod surface;
#[cfg(test)]
mod tests;
mod violation;
mod volume;

pub use intersections::{SelfIntersections, self_intersections};
pub use report::{
    AngleRange, Answer, BoundaryLoop, Finding, Intersections, Options, SurfaceGeometry, SurfacePart, SurfaceReport,
    VolumeBoundary, VolumeGeometry, VolumeReport,
};
pub use surface::analyse_triangles;
pub use violation::{ElementKind, MOST_LISTED, Severity, Violation};
pub use volume::analyse_tetrahedra;
