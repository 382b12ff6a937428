// The part of the page that can be played with: vertices of the target are dragged, and composite mean value maps follow.
// What is counted here is sampled on a grid; the map above is the one that is certified.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("domains").textContent);
  const canvas = document.getElementById("play");
  const pen = canvas.getContext("2d");
  const meter = document.getElementById("meter");
  const stepsBox = document.getElementById("steps");
  const show = document.getElementById("show");
  const source = data.source, rings = data.source.map((ring) => ring.length);
  let target = data.target.map((ring) => ring.map((p) => p.slice()));
  const CELLS = 56, MOST_STEPS = 64, GRAB = 14;

  // Mean value weights of all vertices for a point inside; null on the boundary, where the nearest grid point will do.
  function apply(from, to, x, y) {
    let total = 0, u = 0, v = 0;
    for (let r = 0; r < from.length; r++) {
      const ring = from[r], goal = to[r], n = ring.length;
      let px = ring[n - 1][0] - x, py = ring[n - 1][1] - y, pr = Math.hypot(px, py);
      for (let i = 0, j = n - 1; i < n; j = i++) {
        const qx = ring[i][0] - x, qy = ring[i][1] - y, qr = Math.hypot(qx, qy);
        const cross = px * qy - py * qx, dot = px * qx + py * qy;
        if (pr === 0) return goal[j];
        const t = dot > 0 ? cross / (pr * qr + dot) : (pr * qr - dot) / cross;
        if (!Number.isFinite(t)) {
          const s = pr / (pr + qr || 1);
          return [goal[j][0] + s * (goal[i][0] - goal[j][0]), goal[j][1] + s * (goal[i][1] - goal[j][1])];
        }
        const a = t / pr, b = t / qr;
        total += a + b;
        u += a * goal[j][0] + b * goal[i][0];
        v += a * goal[j][1] + b * goal[i][1];
        px = qx; py = qy; pr = qr;
      }
    }
    return [u / total, v / total];
  }

  const between = (t) => source.map((ring, r) => ring.map((p, i) => [0, 1].map((k) => (1 - t) * p[k] + t * target[r][i][k])));

  // Grid points inside the source, and cells whose corners are.
  const low = [0, 1].map((k) => Math.min(...source[0].map((p) => p[k])));
  const high = [0, 1].map((k) => Math.max(...source[0].map((p) => p[k])));
  const size = Math.max(high[0] - low[0], high[1] - low[1]) / CELLS;
  const columns = Math.ceil((high[0] - low[0]) / size) + 1, rows = Math.ceil((high[1] - low[1]) / size) + 1;
  function inside(x, y) {
    let odd = false;
    for (const ring of source) {
      for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
        const [a, b] = [ring[i], ring[j]];
        if (a[1] > y !== b[1] > y && x < ((b[0] - a[0]) * (y - a[1])) / (b[1] - a[1]) + a[0]) odd = !odd;
      }
    }
    return odd;
  }
  const grid = [];
  for (let j = 0; j < rows; j++) {
    for (let i = 0; i < columns; i++) {
      const x = low[0] + i * size, y = low[1] + j * size;
      grid.push(inside(x, y) ? [x, y] : null);
    }
  }
  const cells = [];
  for (let j = 0; j + 1 < rows; j++) {
    for (let i = 0; i + 1 < columns; i++) {
      const corners = [j * columns + i, j * columns + i + 1, (j + 1) * columns + i + 1, (j + 1) * columns + i];
      if (corners.every((k) => grid[k])) cells.push(corners);
    }
  }

  function composite(steps) {
    let points = grid.map((p) => p && p.slice());
    let from = source;
    for (let step = 1; step <= steps; step++) {
      const to = step === steps ? target : between(step / steps);
      points = points.map((p) => p && apply(from, to, p[0], p[1]));
      from = to;
    }
    return points;
  }

  const area = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  const isFolded = (points) => ([a, b, c, d]) => {
    const [p, q, r, s] = [points[a], points[b], points[c], points[d]];
    // Cut along one diagonal or the other, both halves are positive unless the map folds, or bends more than the grid shows.
    return !((area(p, q, r) > 0 && area(p, r, s) > 0) || (area(p, q, s) > 0 && area(q, r, s) > 0));
  };

  // Both shapes and what is dragged must stay in view.
  const all = data.source.concat(data.target).flat();
  const box = [0, 1].map((k) => [Math.min(...all.map((p) => p[k])), Math.max(...all.map((p) => p[k]))]);
  const room = 1.25;
  const centre = box.map(([a, b]) => (a + b) / 2);
  const scale = () => Math.min(canvas.width / (box[0][1] - box[0][0]), canvas.height / (box[1][1] - box[1][0])) / room;
  const place = ([x, y]) => [canvas.width / 2 + (x - centre[0]) * scale(), canvas.height / 2 - (y - centre[1]) * scale()];
  const unplace = (x, y) => [centre[0] + (x - canvas.width / 2) / scale(), centre[1] - (y - canvas.height / 2) / scale()];

  let picture = checkers();
  function checkers() {
    const board = document.createElement("canvas");
    board.width = board.height = 512;
    const ink = board.getContext("2d");
    for (let i = 0; i < 16; i++) {
      for (let j = 0; j < 16; j++) {
        ink.fillStyle = (i + j) % 2 ? `hsl(${i * 22} 65% ${45 + j * 2}%)` : "#f5f2ea";
        ink.fillRect(i * 32, j * 32, 32, 32);
      }
    }
    return board;
  }

  function drawTriangle(from, to) {
    const [a, b, c] = to.map(place);
    pen.save();
    pen.beginPath();
    pen.moveTo(...a); pen.lineTo(...b); pen.lineTo(...c);
    pen.closePath();
    pen.clip();
    const [p, q, r] = from;
    const d = area(p, q, r);
    const m = [0, 1].map((k) => {
      const du = ((b[k] - a[k]) * (r[1] - p[1]) - (c[k] - a[k]) * (q[1] - p[1])) / d;
      const dv = ((c[k] - a[k]) * (q[0] - p[0]) - (b[k] - a[k]) * (r[0] - p[0])) / d;
      return [du, dv, a[k] - du * p[0] - dv * p[1]];
    });
    pen.transform(m[0][0], m[1][0], m[0][1], m[1][1], m[0][2], m[1][2]);
    pen.drawImage(picture, 0, 0);
    pen.restore();
  }

  function draw() {
    const wanted = stepsBox.value === "auto" ? 0 : Number(stepsBox.value);
    let steps = wanted || 1, points = composite(steps), folded = cells.filter(isFolded(points));
    while (!wanted && folded.length && steps < MOST_STEPS) {
      steps *= 2;
      points = composite(steps);
      folded = cells.filter(isFolded(points));
    }
    const dark = matchMedia("(prefers-color-scheme:dark)").matches;
    pen.clearRect(0, 0, canvas.width, canvas.height);
    if (show.value === "picture") {
      const on = (k) => {
        const [x, y] = grid[k];
        const side = Math.max(high[0] - low[0], high[1] - low[1]);
        return [((x - low[0]) / side) * picture.width, picture.height - ((y - low[1]) / side) * picture.height];
      };
      for (const [a, b, c, d] of cells) {
        drawTriangle([on(a), on(b), on(c)], [points[a], points[b], points[c]]);
        drawTriangle([on(a), on(c), on(d)], [points[a], points[c], points[d]]);
      }
    } else {
      const line = (k, l) => {
        if (points[k] && points[l]) {
          pen.moveTo(...place(points[k]));
          pen.lineTo(...place(points[l]));
        }
      };
      for (const [colour, step, limit] of [["#0072b2", 1, columns], ["#d55e00", columns, 0]]) {
        pen.beginPath();
        pen.strokeStyle = colour;
        pen.lineWidth = 0.8;
        for (let k = 0; k + step < grid.length; k++) if (!limit || (k + 1) % limit) line(k, k + step);
        pen.stroke();
      }
    }
    pen.fillStyle = "#d0006080";
    for (const cell of folded) {
      pen.beginPath();
      cell.forEach((k, i) => (i ? pen.lineTo(...place(points[k])) : pen.moveTo(...place(points[k]))));
      pen.fill();
    }
    const ink = dark ? "#eee" : "#111";
    for (const ring of target) {
      pen.beginPath();
      ring.forEach((p, i) => (i ? pen.lineTo(...place(p)) : pen.moveTo(...place(p))));
      pen.closePath();
      pen.strokeStyle = ink;
      pen.lineWidth = 1.5;
      pen.stroke();
      pen.fillStyle = ink;
      for (const p of ring) {
        pen.beginPath();
        pen.arc(...place(p), rings[0] > 60 ? 3 : 5, 0, 7);
        pen.fill();
      }
    }
    const word = folded.length ? "folded" : "none folded";
    meter.textContent = `${steps} step${steps > 1 ? "s" : ""}: ${folded.length} of ${cells.length} grid cells ${word} (sampled)`;
    meter.className = folded.length ? "bad" : "good";
  }

  let held = null;
  const at = (event) => {
    const edge = canvas.getBoundingClientRect();
    return [((event.clientX - edge.left) * canvas.width) / edge.width, ((event.clientY - edge.top) * canvas.height) / edge.height];
  };
  canvas.addEventListener("pointerdown", (event) => {
    const [x, y] = at(event);
    let best = GRAB * GRAB;
    target.forEach((ring, r) => ring.forEach((p, i) => {
      const [px, py] = place(p), d = (px - x) ** 2 + (py - y) ** 2;
      if (d < best) [best, held] = [d, [r, i]];
    }));
    if (held) canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    target[held[0]][held[1]] = unplace(...at(event));
    draw();
  });
  canvas.addEventListener("pointerup", () => (held = null));
  document.getElementById("reset").addEventListener("click", () => {
    target = data.target.map((ring) => ring.map((p) => p.slice()));
    draw();
  });
  document.getElementById("straight").addEventListener("click", () => {
    target = data.source.map((ring) => ring.map((p) => p.slice()));
    draw();
  });
  document.getElementById("file").addEventListener("change", async (event) => {
    if (event.target.files[0]) {
      picture = await createImageBitmap(event.target.files[0]);
      show.value = "picture";
      draw();
    }
  });
  stepsBox.addEventListener("change", draw);
  show.addEventListener("change", draw);
  draw();
})();
