// Reads the arrays that the page carries.

const KINDS = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array };

function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** The manifest, with every slot `{offset, length, kind}` replaced by its typed array. */
export function readScene(document) {
  const manifest = JSON.parse(document.getElementById('homeo-scene').textContent);
  const block = document.getElementById('homeo-arrays');
  const bytes = decodeBase64(block.textContent);
  block.textContent = ''; // The decoded copy is enough.
  return replaceSlots(manifest, bytes.buffer);
}

function replaceSlots(value, buffer) {
  if (value === null || typeof value !== 'object') return value;
  if (Array.isArray(value)) return value.map((entry) => replaceSlots(entry, buffer));
  if (typeof value.offset === 'number' && value.kind in KINDS) {
    return new KINDS[value.kind](buffer, value.offset, value.length);
  }
  return Object.fromEntries(Object.entries(value).map(([key, entry]) => [key, replaceSlots(entry, buffer)]));
}

/** Maps quantized shares (0..1 per axis) of a frame to its coordinates. */
export function fromShares(frame, shares) {
  return shares.map((share, axis) => frame.low[axis] + share * (frame.high[axis] - frame.low[axis]));
}
