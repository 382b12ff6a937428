// The picture of a bundle: the surface with its cuts on the left, the solid tori over its disks on the right.
"use strict";
(() => {
  const { scene, array, points, turnable } = page;
  const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a) => { const size = Math.hypot(...a) || 1; return a.map((x) => x / size); };

  // The surface, of size 1 about the origin.
  const { low, high } = scene.frame;
  const centre = [0, 1, 2].map((k) => (low[k] + high[k]) / 2);
  const half = Math.hypot(...[0, 1, 2].map((k) => high[k] - low[k])) / 2 || 1;
  const fit = (p) => add(p, centre, -1).map((x) => (1.25 * x) / half);
  const raw = points(scene.places, scene.frame), triangles = array(scene.triangles);
  const places = Array.from({ length: raw.length / 3 }, (_, v) => fit([raw[3 * v], raw[3 * v + 1], raw[3 * v + 2]]));
  const normals = places.map(() => [0, 0, 0]);
  let edge = 0;
  const cornersOf = (t) => [triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]];
  for (let t = 0; t < triangles.length / 3; t++) {
    const c = cornersOf(t), n = cross(add(places[c[1]], places[c[0]], -1), add(places[c[2]], places[c[0]], -1));
    edge += Math.hypot(...add(places[c[1]], places[c[0]], -1));
    c.forEach((v) => (normals[v] = add(normals[v], n)));
  }
  edge /= triangles.length / 3;
  const plane = scene.chart && points(scene.chart, scene.unit), corners = array(scene.corners), disks = array(scene.disks);
  const layers = scene.layers, turns = 2 * Math.PI, count = 1 + disks.reduce((a, b) => Math.max(a, b), 0);
  const palette = [[214, 69, 65], [42, 127, 184], [46, 148, 83], [137, 84, 168], [196, 130, 20], [20, 150, 150]].map((c) => c.map((x) => x / 255));
  const hue = (cut) => (scene.cuts.length > 1 ? palette[cut % palette.length] : palette[0]);
  const state = { bend: scene.genus === 1 ? 0 : 1, fibres: true, disk: true, section: true, arrows: true, cuts: true, picked: Math.floor(triangles.length / 12) };

  // Over a point of a disk, at a height in levels: a prism at bend 0, a solid torus at bend 1.
  function over(vertex, height, x, y) {
    const disk = disks[vertex], at = x === undefined ? [plane[3 * vertex], plane[3 * vertex + 1]] : [x, y];
    const size = (count > 1 ? 0.31 : 0.42) * (count > 1 ? 1 : 1.8 - 0.8 * state.bend);
    const length = size * (2.6 * (1 - state.bend) + turns * 2 * state.bend);
    const s = (height / layers - 0.5) * length, bow = (state.bend * turns) / length;
    let p = [size * at[0], size * at[1], s];
    if (bow > 1e-6) {
      const radius = 1 / bow + p[0];
      p = [radius * Math.cos(bow * s) - (1 - state.bend) / bow, p[1], radius * Math.sin(bow * s)];
    }
    // The prism stands upright, the torus lies.
    const [c, d] = [Math.cos(((1 - state.bend) * Math.PI) / 2), Math.sin(((1 - state.bend) * Math.PI) / 2)];
    p = [p[0], p[1] * c + p[2] * d, p[2] * c - p[1] * d];
    return count > 1 ? add(p, [0, disk ? -0.62 : 0.62, 0]) : p;
  }

  const viewer = document.getElementById("viewer");
  const probe = document.createElement("canvas").getContext("webgl2");
  if (!probe) return;
  viewer.textContent = "";
  viewer.classList.add("live");
  const stage = viewer.appendChild(document.createElement("div"));
  stage.style.cssText = "display:grid;grid-template-columns:1fr 1fr;min-width:0;min-height:0";

  // A pane with triangles and lines in it.
  function pane(title, tilt) {
    const host = stage.appendChild(document.createElement("div"));
    host.className = "pane";
    const canvas = host.appendChild(document.createElement("canvas"));
    canvas.className = "stage";
    canvas.style.width = canvas.style.height = "100%";
    canvas.tabIndex = 0;
    canvas.setAttribute("aria-label", title + "; arrow keys turn it, plus and minus come nearer");
    const words = host.appendChild(document.createElement("div"));
    words.className = "pane-title";
    words.textContent = title;
    const labels = host.appendChild(document.createElement("div"));
    const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    const made = gl.createProgram();
    const sources = [[gl.VERTEX_SHADER, `in vec3 point, normal; in vec4 colour; out vec4 shade; out vec3 facing;
      uniform mat3 turn; uniform float zoom, lift; uniform vec2 aspect;
      void main() {
        vec3 p = turn * point * zoom; float far = 4.2 - p.z;
        gl_Position = vec4(p.xy * aspect * 2.9, (far - 4.2) * 0.2 * far - lift * far, far);
        shade = colour; facing = turn * normal;
      }`], [gl.FRAGMENT_SHADER, `in vec4 shade; in vec3 facing; out vec4 result;
      void main() {
        float size = length(facing), light = 1.0;
        if (size > 0.0) light = 0.5 + 0.5 * abs(dot(facing / size, normalize(vec3(0.3, 0.5, 0.8))));
        result = vec4(shade.rgb * light, shade.a);
      }`]];
    for (const [type, source] of sources) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + source);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    gl.useProgram(made);
    const place = (name) => gl.getUniformLocation(made, name);
    let batches = [], marks = [], click = () => {};
    const seen = (p) => {
      const q = [0, 1, 2].map((k) => view.zoom * (view.turn[k] * p[0] + view.turn[k + 3] * p[1] + view.turn[k + 6] * p[2]));
      const short = Math.min(canvas.clientWidth, canvas.clientHeight), far = 4.2 - q[2];
      return [canvas.clientWidth / 2 + (q[0] * 1.45 * short) / far, canvas.clientHeight / 2 - (q[1] * 1.45 * short) / far, far];
    };
    function draw() {
      const scale = window.devicePixelRatio || 1;
      canvas.width = Math.max(1, canvas.clientWidth * scale);
      canvas.height = Math.max(1, canvas.clientHeight * scale);
      const short = Math.min(canvas.width, canvas.height);
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(0, 0, 0, 0);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.enable(gl.BLEND);
      gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
      gl.uniformMatrix3fv(place("turn"), false, view.turn);
      gl.uniform1f(place("zoom"), view.zoom);
      gl.uniform2f(place("aspect"), short / canvas.width, short / canvas.height);
      for (const batch of batches) {
        gl.uniform1f(place("lift"), batch.lift);
        gl.depthMask(!batch.clear);
        gl.bindVertexArray(batch.bound);
        gl.drawArrays(batch.lines ? gl.LINES : gl.TRIANGLES, 0, batch.length);
      }
      gl.depthMask(true);
      labels.textContent = "";
      for (const mark of marks) {
        const [x, y, far] = seen(mark.at), label = labels.appendChild(document.createElement("span"));
        label.textContent = (mark.index > 0 ? "+" : "−") + Math.abs(mark.index);
        if (!mark.index) label.textContent = "0";
        label.style.opacity = far > 4.25 ? 0.35 : 1;
        label.title = mark.name;
        label.style.cssText += `;position:absolute;left:${x + 7}px;top:${y - 20}px;font-weight:700;font-size:14px;pointer-events:none;text-shadow:0 0 3px var(--card),0 0 3px var(--card)`;
      }
    }
    function fill(list, signs = []) {
      batches.forEach((batch) => { gl.deleteVertexArray(batch.bound); batch.buffers.forEach((made) => gl.deleteBuffer(made)); });
      marks = signs;
      batches = list.map((item) => {
        const bound = gl.createVertexArray(), buffers = [];
        gl.bindVertexArray(bound);
        for (const [name, size, data] of [["point", 3, item.points], ["normal", 3, item.normals], ["colour", 4, item.colours]]) {
          const at = gl.getAttribLocation(made, name);
          if (at < 0 || !data) { if (at >= 0) gl.vertexAttrib3f(at, 0, 0, 0); continue; }
          buffers.push(gl.createBuffer());
          gl.bindBuffer(gl.ARRAY_BUFFER, buffers[buffers.length - 1]);
          gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW);
          gl.enableVertexAttribArray(at);
          gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
        }
        return { bound, buffers, length: item.points.length / 3, lines: item.lines, lift: item.lift || 0, clear: item.clear };
      });
      draw();
    }
    const view = turnable(canvas, tilt, 8, draw, (x, y) => click(x, y));
    new ResizeObserver(draw).observe(host);
    return { fill, draw, seen, onClick: (given) => (click = given) };
  }
  const left = pane("The surface", [-0.4, 0.75]);
  const right = pane(count > 1 ? "Two solid tori, to be glued" : "The solid torus over the disk, rolled up or unrolled", [-0.15, count > 1 ? 0.45 : 0.7]);

  // Lists of points and colours.
  const batch = (more) => ({ points: [], colours: [], ...more });
  const push = (to, p, colour, alpha = 1) => { to.points.push(...p); to.colours.push(...colour, alpha); };
  const stroke = (to, path, colour, alpha) => { for (let k = 0; k + 1 < path.length; k++) { push(to, path[k], colour, alpha); push(to, path[k + 1], colour, alpha); } };
  // A tube about a path, of a radius.
  function tube(to, path, radius, colour) {
    const rings = path.map((p, k) => {
      const d = unit(add(path[Math.min(k + 1, path.length - 1)], path[Math.max(k - 1, 0)], -1));
      const e = unit(cross(d, Math.abs(d[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0])), f = cross(d, e);
      return [0, 1, 2, 3, 4, 5].map((s) => { const a = (s * turns) / 6, n = add(e.map((x) => x * Math.cos(a)), f, Math.sin(a)); return [add(p, n, radius), n]; });
    });
    for (let k = 0; k + 1 < rings.length; k++) for (let s = 0; s < 6; s++) {
      const r = (s + 1) % 6;
      for (const [p, n] of [rings[k][s], rings[k][r], rings[k + 1][s], rings[k + 1][s], rings[k][r], rings[k + 1][r]]) { push(to, p, colour); to.normals.push(...n); }
    }
  }
  const gold = [0.93, 0.55, 0.1], ink = [0.13, 0.16, 0.22], fibreColour = [0.85, 0.1, 0.55];

  function surface() {
    const skin = batch({ normals: [], lift: -0.002 }), wires = batch({ lines: true }), solid = batch({ normals: [], lift: 0.002 });
    const tint = [[0.80, 0.84, 0.90], [0.90, 0.86, 0.76]];
    for (let t = 0; t < triangles.length / 3; t++) {
      const c = cornersOf(t), colour = t === state.picked ? [0.98, 0.80, 0.90] : tint[disks[corners[3 * t]] % 2];
      c.forEach((v, k) => {
        push(skin, places[v], colour);
        skin.normals.push(...normals[v]);
        push(wires, places[v], ink, 0.16);
        push(wires, places[c[(k + 1) % 3]], ink, 0.16);
      });
    }
    if (state.cuts) scene.cuts.forEach((cut, number) => tube(solid, cut.map((v) => places[v]), 0.010, hue(number)));
    const list = [skin, wires, solid], signs = [];
    if (scene.field && state.arrows) {
      const vectors = points(scene.field.vectors, scene.unit), step = Math.max(1, Math.ceil(vectors.length / 3 / 2500));
      const lines = batch({ lines: true, lift: 0.004 });
      for (let v = 0; v < vectors.length / 3; v += step) {
        const n = unit(normals[v]), w = [vectors[3 * v], vectors[3 * v + 1], vectors[3 * v + 2]];
        const d = add(w, n, -dot(w, n)), size = Math.hypot(...d);
        if (size < 1e-3) continue;
        const along = unit(d), tip = add(places[v], along, 0.75 * edge), side = cross(n, along);
        stroke(lines, [places[v], tip], ink, 0.9);
        for (const s of [-1, 1]) stroke(lines, [tip, add(add(tip, along, -0.25 * edge), side, s * 0.14 * edge)], ink, 0.9);
      }
      const balls = batch({ normals: [], lift: 0.006 });
      for (const mark of scene.field.singular) {
        const at = fit(mark.at), colour = mark.index > 0 ? palette[0] : mark.index < 0 ? palette[1] : [0.5, 0.5, 0.5];
        for (let i = 0; i < 8; i++) for (let j = 0; j < 12; j++) {
          const q = (a, b) => [Math.sin((a * Math.PI) / 8) * Math.cos((b * Math.PI) / 6), Math.sin((a * Math.PI) / 8) * Math.sin((b * Math.PI) / 6), Math.cos((a * Math.PI) / 8)];
          for (const n of [q(i, j), q(i + 1, j), q(i, j + 1), q(i, j + 1), q(i + 1, j), q(i + 1, j + 1)]) { push(balls, add(at, n, 0.035), colour); balls.normals.push(...n); }
        }
        signs.push({ ...mark, at });
      }
      list.push(lines, balls);
    }
    // The fibre: unit vectors at the middle of the picked triangle.
    const c = cornersOf(state.picked), middle = c.reduce((sum, v) => add(sum, places[v], 1 / 3), [0, 0, 0]);
    const e = unit(add(places[c[0]], middle, -1)), n = unit(cross(add(places[c[1]], places[c[0]], -1), add(places[c[2]], places[c[0]], -1))), f = cross(n, e);
    const circle = Array.from({ length: 49 }, (_, k) => add(add(add(middle, n, 0.012), e, 0.13 * Math.cos((k * turns) / 48)), f, 0.13 * Math.sin((k * turns) / 48)));
    const ring = batch({ normals: [], lift: 0.01 });
    tube(ring, circle, 0.008, fibreColour);
    list.push(ring);
    left.fill(list, signs);
  }

  function solidTori() {
    const shell = batch({ lines: true }), floor = batch({ normals: [], clear: true }), rims = batch({ normals: [] }), thin = batch({ lines: true });
    const steps = 96, heights = Array.from({ length: steps + 1 }, (_, k) => (layers * k) / steps);
    if (scene.boundary) {
      const boundary = array(scene.boundary), sparse = Math.ceil(boundary.length / 3 / (40 * count));
      for (let k = 0; k < boundary.length; k += 3) {
        const [a, b, cut] = [boundary[k], boundary[k + 1], boundary[k + 2]];
        tube(rims, [over(a, 0), over(b, 0)], 0.008, hue(cut));
        if (state.bend < 1) tube(rims, [over(a, layers), over(b, layers)], 0.008, hue(cut));
        for (let level = 0; level < layers; level++) stroke(shell, [over(a, level), over(b, level)], hue(cut), 0.16);
        if ((k / 3) % sparse === 0) stroke(shell, heights.map((h) => over(a, h)), hue(cut), 0.35);
      }
    }
    if (state.disk) for (let t = 0; t < corners.length / 3; t++) {
      const p = [0, 1, 2].map((k) => over(corners[3 * t + k], 0)), n = cross(add(p[1], p[0], -1), add(p[2], p[0], -1));
      p.forEach((q, k) => {
        push(floor, q, t === state.picked ? [0.95, 0.5, 0.75] : [0.72, 0.77, 0.86], 0.75);
        floor.normals.push(...n);
        stroke(thin, [q, p[(k + 1) % 3]], ink, 0.18);
      });
    }
    if (state.fibres) for (let disk = 0; disk < count; disk++) {
      const vertex = disks.indexOf(disk);
      for (const [radius, many] of [[0, 1], [0.5, 8]]) for (let k = 0; k < many; k++) {
        const a = (k * turns) / many;
        stroke(thin, heights.map((h) => over(vertex, h, radius * Math.cos(a), radius * Math.sin(a))), ink, 0.35);
      }
    }
    const list = [shell, thin, rims];
    if (scene.field && state.section) {
      const ends = array(scene.field.lines), levels = array(scene.field.heights), lines = batch({ lines: true });
      for (let k = 0; k < ends.length; k += 2) {
        const [a, b, from, to] = [ends[k], ends[k + 1], levels[k] - 32768, levels[k + 1] - 32768];
        const parts = Math.max(1, Math.min(24, 2 * Math.ceil(Math.abs(to - from))));
        const at = (s) => { const h = from + (to - from) * s, x = (i) => plane[3 * a + i] * (1 - s) + plane[3 * b + i] * s; return over(a, state.bend < 1 ? ((h % layers) + layers) % layers : h, x(0), x(1)); };
        for (let s = 0; s < parts; s++) {
          const [p, q] = [at(s / parts), at((s + 1) / parts)];
          if (Math.hypot(...add(p, q, -1)) < 0.6) stroke(lines, [p, q], gold, ends.length > 2000 ? 0.4 : 0.7);
        }
      }
      list.push(lines);
    }
    const bold = batch({ normals: [] });
    for (let k = 0; k + 1 < scene.seam.length; k++) {
      const [[v, h], [w, g]] = [scene.seam[k], scene.seam[k + 1]];
      // Unrolled, a piece from the ceiling on goes on at the floor.
      const down = state.bend < 1 ? Math.floor(Math.min(h, g) / layers) * layers : 0;
      tube(bold, [over(v, h - down), over(w, g - down)], 0.012, ink);
    }
    const c = [0, 1, 2].map((k) => corners[3 * state.picked + k]), middle = [0, 1].map((i) => c.reduce((sum, v) => sum + plane[3 * v + i] / 3, 0));
    tube(bold, heights.map((h) => over(c[0], h, ...middle)), 0.012, fibreColour);
    right.fill([...list, bold, floor]);
  }
  const all = () => { surface(); solidTori(); };

  left.onClick((x, y) => {
    let best = null;
    for (let t = 0; t < triangles.length / 3; t++) {
      const [a, b, c] = cornersOf(t).map((v) => left.seen(places[v]));
      const side = (p, q) => (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
      const signs = [side(a, b), side(b, c), side(c, a)], far = a[2] + b[2] + c[2];
      if ((signs.every((s) => s >= 0) || signs.every((s) => s <= 0)) && (!best || far < best[1])) best = [t, far];
    }
    if (best) { state.picked = best[0]; all(); }
  });

  const panel = viewer.appendChild(document.createElement("div"));
  panel.className = "panel";
  function row(kind, name, input) {
    const label = panel.appendChild(document.createElement("label"));
    label.className = "row " + kind;
    const words = document.createElement("span");
    words.textContent = name;
    label.append(...(kind === "check" ? [input, words] : [words, input]));
    return input;
  }
  const slider = document.createElement("input");
  Object.assign(slider, { type: "range", min: 0, max: 1, step: 0.01, value: state.bend });
  row("slider", "roll up", slider).addEventListener("input", () => { state.bend = Number(slider.value); solidTori(); });
  const boxes = [["cuts", "paths of the cut"], ["disk", "level 0 of the frame"], ["fibres", "some fibres"]];
  if (scene.field) boxes.push(["arrows", "field"], ["section", "section"]);
  for (const [key, name] of boxes) {
    const box = document.createElement("input");
    Object.assign(box, { type: "checkbox", checked: state[key] });
    row("check", name, box).addEventListener("change", () => { state[key] = box.checked; all(); });
  }
  all();
})();
