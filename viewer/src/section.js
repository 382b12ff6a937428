// Plane sections of the tetrahedra, computed here because the plane moves with a slider.

/**
 * The section of all tetrahedra where `value(vertex)` is zero, as triangles with both sides' shares.
 * `value` is called once per vertex.
 */
export function section(scene, value) {
  const { source, image } = scene.vertices;
  const values = Float32Array.from({ length: source.length / 3 }, (_, vertex) => value(vertex));
  const cells = scene.volume;
  const [outSource, outImage] = [[], []];
  const emit = (a, b) => {
    const share = values[a] / (values[a] - values[b]);
    for (let axis = 0; axis < 3; axis++) {
      outSource.push((source[3 * a + axis] + share * (source[3 * b + axis] - source[3 * a + axis])) / 65535);
      outImage.push((image[3 * a + axis] + share * (image[3 * b + axis] - image[3 * a + axis])) / 65535);
    }
  };
  const above = [];
  const below = [];
  for (let cell = 0; cell < cells.length; cell += 4) {
    above.length = 0;
    below.length = 0;
    for (let k = 0; k < 4; k++) (values[cells[cell + k]] >= 0 ? above : below).push(cells[cell + k]);
    if (above.length === 1) below.forEach((other) => emit(above[0], other));
    else if (below.length === 1) above.forEach((other) => emit(below[0], other));
    else if (above.length === 2) {
      const [[a, b], [x, y]] = [above, below];
      for (const [p, q] of [[a, x], [a, y], [b, y], [a, x], [b, y], [b, x]]) emit(p, q);
    }
  }
  return { source: new Float32Array(outSource), image: new Float32Array(outImage) };
}
