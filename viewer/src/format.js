// Numbers for people.

/** A coordinate with as many digits as four parts in ten thousand of its range need. */
export function number(value, range) {
  const size = Math.abs(range) || Math.abs(value) || 1;
  if (size >= 1e6 || size < 1e-4) return value.toExponential(3);
  const decimals = Math.max(0, Math.min(8, 3 - Math.floor(Math.log10(size))));
  // Adding 0 turns -0, as in -0.0001 rounded, into 0.
  return (Number(value.toFixed(decimals)) + 0).toFixed(decimals).replace('-', '\u2212');
}
