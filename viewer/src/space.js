// Display coordinates: both sides are moved and scaled into the ball of radius 1 about the origin.

import { fromShares } from './data.js';

/** Scale and offset that take shares of a frame to display coordinates. */
function fit(frame, low, high, radius) {
  const centre = low.map((value, axis) => (value + high[axis]) / 2);
  return {
    scale: frame.high.map((value, axis) => (value - frame.low[axis]) / radius),
    offset: frame.low.map((value, axis) => (value - centre[axis]) / radius),
  };
}

export function sourceSpace(scene) {
  const { low, high } = scene.source_frame;
  const centre = low.map((value, axis) => (value + high[axis]) / 2);
  // The pillars of a shell reach beyond its surfaces.
  const points = scene.shell && scene.leaves ? scene.leaves.points.source : scene.vertices.source;
  let radius = 0;
  for (let i = 0; i < points.length; i += 3) {
    const p = fromShares(scene.source_frame, [points[i] / 65535, points[i + 1] / 65535, points[i + 2] / 65535]);
    radius = Math.max(radius, Math.hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]));
  }
  return fit(scene.source_frame, low, high, radius || 1);
}

export function targetSpace(scene) {
  const flat = scene.dimension === 2;
  const box = scene.target === 'square' || scene.target === 'cube';
  const low = box ? [0, 0, 0] : [-1, -1, flat ? 0 : -1];
  const high = [1, 1, flat ? 0 : 1];
  return fit(scene.image_frame, low, high, box ? Math.sqrt(flat ? 2 : 3) / 2 : 1);
}

export function toDisplay(space, shares) {
  return shares.map((share, axis) => share * space.scale[axis] + space.offset[axis]);
}
