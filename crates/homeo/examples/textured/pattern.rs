//! The texture: squares in two shades, in another colour for each chart.

/// Squares along each side of the image.
pub const SQUARES: usize = 28;

/// The colour at texture coordinates in the unit square; the second one goes up.
pub fn colour([u, v]: [f64; 2]) -> [f64; 3] {
    let [column, row] = [u, v].map(|x| (x * SQUARES as f64).clamp(0.0, SQUARES as f64 - 0.5) as usize);
    // Three charts of eight rows, with two rows between them.
    let [dark, light] = match row {
        0..=8 => [[0.10, 0.42, 0.62], [0.93, 0.95, 0.97]],
        9..=18 => [[0.80, 0.45, 0.10], [0.97, 0.94, 0.88]],
        _ => [[0.20, 0.50, 0.28], [0.93, 0.97, 0.92]],
    };
    if (column + row) % 2 == 0 { dark } else { light }
}

/// The image of the texture, so many pixels along each side.
pub fn image(size: usize) -> Vec<[u8; 3]> {
    let middle = |i: usize| (i as f64 + 0.5) / size as f64;
    let pixel = |i: usize| colour([middle(i % size), 1.0 - middle(i / size)]).map(|x| (255.0 * x) as u8);
    (0..size * size).map(pixel).collect()
}
