//! Mean value maps between closed triangle meshes, by the angles and normals of spherical triangles (Ju, Schaefer, Warren 2005;
//! Floater, Kos, Reimers 2005), in doubles; no use where a point lies in the plane of a triangle.

type Place = [f64; 3];

fn minus(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Place, b: Place) -> Place {
    [(1, 2), (2, 0), (0, 1)].map(|(k, l)| a[k] * b[l] - a[l] * b[k])
}

/// Where a point goes.
pub fn image([points, images]: [&[Place]; 2], triangles: &[[u32; 3]], at: Place) -> Place {
    let (mut total, mut sum) = (0.0, [0.0; 3]);
    for triangle in triangles {
        let to = triangle.map(|v| minus(points[v as usize], at));
        let mut mean = [0.0; 3];
        let mut normals = [[0.0; 3]; 3];
        for k in 0..3 {
            let [a, b] = [to[(k + 1) % 3], to[(k + 2) % 3]];
            let normal = cross(a, b);
            let size = dot(normal, normal).sqrt();
            normals[k] = normal.map(|c| c / size);
            let angle = size.atan2(dot(a, b));
            (0..3).for_each(|l| mean[l] += 0.5 * angle * normals[k][l]);
        }
        for k in 0..3 {
            let weight = dot(normals[k], mean) / dot(normals[k], to[k]);
            total += weight;
            (0..3).for_each(|l| sum[l] += weight * images[triangle[k] as usize][l]);
        }
    }
    sum.map(|c| c / total)
}

/// The Jacobian determinant, by differences over `step`.
pub fn determinant(cages: [&[Place]; 2], triangles: &[[u32; 3]], at: Place, step: f64) -> f64 {
    let column = |k: usize| {
        let moved = |by: f64| {
            let mut place = at;
            place[k] += by;
            image(cages, triangles, place)
        };
        let [near, far] = [1.0, 2.0].map(|n| minus(moved(n * step), moved(-n * step)));
        [0, 1, 2].map(|l| (8.0 * near[l] - far[l]) / (12.0 * step))
    };
    dot(column(0), cross(column(1), column(2)))
}

/// How often the mesh winds round a point, by the solid angles of its triangles.
pub fn winding(points: &[Place], triangles: &[[u32; 3]], at: Place) -> f64 {
    let angle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| minus(points[v as usize], at));
        let [p, q, r] = [a, b, c].map(|x| dot(x, x).sqrt());
        let below = p * q * r + dot(a, b) * r + dot(b, c) * p + dot(c, a) * q;
        2.0 * dot(a, cross(b, c)).atan2(below)
    };
    triangles.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}
