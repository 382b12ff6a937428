// What pages share: their data, and a view that is turned and zoomed by pointer, wheel and keys.
"use strict";
const page = (() => {
  const scene = JSON.parse(document.getElementById("homeo-scene").textContent);
  const text = atob(document.getElementById("homeo-arrays").textContent);
  const bytes = Uint8Array.from(text, (character) => character.charCodeAt(0));
  const kinds = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array };
  const array = (slot) => new kinds[slot.kind](bytes.buffer, slot.offset, slot.length);
  const points = (slot, frame) => Float32Array.from(array(slot), (step, at) => {
    const low = frame.low[at % 3], high = frame.high[at % 3];
    return low + (step / 65535) * (high - low);
  });

  // `turn` has the columns of a rotation matrix; `zoom` goes up to `most`. A press that hardly moves is a click.
  function turnable(canvas, [across, down], most, draw, click = () => {}) {
    const view = { turn: [1, 0, 0, 0, 1, 0, 0, 0, 1], zoom: 1 };
    function rotate(across, down) {
      const [a, b, c, d] = [Math.cos(across), Math.sin(across), Math.cos(down), Math.sin(down)];
      const by = [a, b * d, -b * c, 0, c, d, b, -a * d, a * c];
      view.turn = view.turn.map((_, at) => [0, 1, 2].reduce((sum, k) => sum + by[3 * k + (at % 3)] * view.turn[3 * ((at / 3) | 0) + k], 0));
    }
    rotate(across, down);
    let held = null, moved = 0;
    canvas.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY]; moved = 0; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointerup", (event) => { held = null; if (moved < 4) click(event.offsetX, event.offsetY); });
    canvas.addEventListener("pointermove", (event) => {
      if (!held) return;
      moved += Math.abs(event.clientX - held[0]) + Math.abs(event.clientY - held[1]);
      rotate((event.clientX - held[0]) * 0.008, (event.clientY - held[1]) * 0.008);
      held = [event.clientX, event.clientY];
      draw();
    });
    const nearer = (factor) => { view.zoom = Math.min(most, Math.max(0.3, view.zoom * factor)); draw(); };
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); nearer(Math.exp(-event.deltaY * 0.001)); }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
      if (turns[event.key]) rotate(...turns[event.key]);
      else if (event.key === "+" || event.key === "=") nearer(1.1);
      else if (event.key === "-") nearer(1 / 1.1);
      else return;
      event.preventDefault();
      draw();
    });
    return view;
  }
  return { scene, array, points, turnable };
})();
