// The picture of a fundamental domain: truncated tetrahedra in the unit ball, to be turned and pulled apart.
"use strict";
(() => {
  const { scene, array, turnable } = page;
  const points = (slot) => page.points(slot, scene.frame);
  const viewer = document.getElementById("viewer");

  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) return;

  // Panel and canvas.
  viewer.textContent = "";
  viewer.classList.add("live");
  const stage = viewer.appendChild(document.createElement("div"));
  stage.className = "pane";
  canvas.className = "stage";
  canvas.style.width = canvas.style.height = "100%";
  canvas.tabIndex = 0;
  canvas.setAttribute("aria-label", "Fundamental domain in the ball; arrow keys turn it, plus and minus come nearer");
  stage.appendChild(canvas);
  const panel = viewer.appendChild(document.createElement("div"));
  panel.className = "panel";
  const state = { explode: 0.25, depth: 0, sides: true, boundary: true, edges: true, ball: true };
  function row(kind, name, input) {
    const label = panel.appendChild(document.createElement("label"));
    label.className = "row " + kind;
    const words = document.createElement("span");
    words.textContent = name;
    label.append(...(kind === "check" ? [input, words] : [words, input]));
    return input;
  }
  const slider = document.createElement("input");
  Object.assign(slider, { type: "range", min: 0, max: 1, step: 0.01, value: state.explode });
  row("slider", "explode", slider).addEventListener("input", () => { state.explode = Number(slider.value); draw(); });
  const depth = document.createElement("select");
  scene.pieces.forEach((count, number) => {
    const option = depth.appendChild(document.createElement("option"));
    option.value = number;
    option.textContent = number ? `${number} away: ${count} pieces` : `domain: ${count} pieces`;
  });
  row("", "cover", depth).addEventListener("change", () => { state.depth = Number(depth.value); draw(); });
  for (const [key, name] of [["sides", "hexagons"], ["boundary", "geodesic boundary"], ["edges", "edges"], ["ball", "unit sphere"]]) {
    const box = document.createElement("input");
    Object.assign(box, { type: "checkbox", checked: state[key] });
    row("check", name, box).addEventListener("change", () => { state[key] = box.checked; draw(); });
  }

  // What is drawn.
  function program(vertex, fragment) {
    const made = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + source);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    gl.linkProgram(made);
    return made;
  }
  const place = `
    uniform mat3 turn; uniform float explode, zoom; uniform vec2 aspect;
    vec4 seen(vec3 point, vec3 middle) {
      vec3 p = turn * (mix(point, middle, 0.15 * explode) + explode * middle);
      float far = 3.4 - p.z * zoom;
      return vec4(p.xy * zoom * aspect * 2.6, (far - 3.4) * 0.2 * far, far);
    }`;
  const faces = program(place + `
    in vec3 point, normal, middle, colour; in float kind; out vec3 shade, facing; flat out float sort;
    void main() { gl_Position = seen(point, middle); shade = colour; facing = turn * normal; sort = kind; }`, `
    uniform vec2 shown; in vec3 shade, facing; flat in float sort; out vec4 result;
    void main() {
      if (sort < 0.5 ? shown.x < 0.5 : shown.y < 0.5) discard;
      vec3 n = normalize(gl_FrontFacing ? facing : -facing);
      float light = 0.42 + 0.5 * max(dot(n, normalize(vec3(0.5, 0.7, 0.8))), 0.0) + 0.18 * max(dot(n, normalize(vec3(-0.8, 0.1, 0.5))), 0.0);
      result = vec4(shade * light * (gl_FrontFacing ? 1.0 : 0.6), 1.0);
    }`);
  const strokes = program(place + `
    in vec3 point, middle; void main() { gl_Position = seen(point, middle); gl_Position.z -= 0.004 * gl_Position.w; }`, `
    uniform vec4 ink; out vec4 result; void main() { result = ink; }`);

  function buffer(target, data) {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return made;
  }
  function attributes(made, table, indices) {
    const bound = gl.createVertexArray();
    gl.bindVertexArray(bound);
    for (const [name, size, data] of table) {
      const at = gl.getAttribLocation(made, name);
      if (at < 0) continue;
      buffer(gl.ARRAY_BUFFER, data);
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
    }
    if (indices) buffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    gl.bindVertexArray(null);
    return bound;
  }
  const kind = array(scene.kinds), owner = array(scene.owners), middles = points(scene.middles);
  const wide = (slot) => Uint32Array.from(array(slot));
  const middle = Float32Array.from({ length: 3 * owner.length }, (_, at) => middles[3 * owner[(at / 3) | 0] + (at % 3)]);
  const colour = Float32Array.from({ length: 3 * kind.length }, (_, at) => scene.colours[kind[(at / 3) | 0]][at % 3] / 255);
  const table = [
    ["point", 3, points(scene.positions)], ["normal", 3, points(scene.normals)], ["middle", 3, middle],
    ["colour", 3, colour], ["kind", 1, Float32Array.from(kind)],
  ];
  const solid = attributes(faces, table, wide(scene.triangles));
  const wires = attributes(strokes, table, wide(scene.lines));
  const circle = [];
  for (let axis = 0; axis < 3; axis++) {
    for (let step = 0; step < 128; step++) {
      for (const end of [step, step + 1]) {
        const angle = (end * Math.PI) / 64, p = [0, 0, 0];
        p[axis] = Math.cos(angle);
        p[(axis + 1) % 3] = Math.sin(angle);
        circle.push(...p);
      }
    }
  }
  const sphere = attributes(strokes, [["point", 3, new Float32Array(circle)], ["middle", 3, new Float32Array(circle.length)]]);

  function draw() {
    const scale = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, canvas.clientWidth * scale);
    canvas.height = Math.max(1, canvas.clientHeight * scale);
    const short = Math.min(canvas.width, canvas.height);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const dark = getComputedStyle(document.documentElement).colorScheme.includes("dark");
    const start = (made, explode) => {
      gl.useProgram(made);
      const at = (name) => gl.getUniformLocation(made, name);
      gl.uniformMatrix3fv(at("turn"), false, view.turn);
      gl.uniform1f(at("explode"), explode);
      gl.uniform1f(at("zoom"), view.zoom);
      gl.uniform2f(at("aspect"), short / canvas.width, short / canvas.height);
      return at;
    };
    const count = scene.pieces[state.depth];
    gl.uniform2f(start(faces, state.explode)("shown"), state.boundary ? 1 : 0, state.sides ? 1 : 0);
    gl.bindVertexArray(solid);
    gl.drawElements(gl.TRIANGLES, 3 * scene.trianglesPerPiece * count, gl.UNSIGNED_INT, 0);
    if (state.edges) {
      gl.uniform4f(start(strokes, state.explode)("ink"), 0.08, 0.09, 0.12, 1);
      gl.bindVertexArray(wires);
      gl.drawElements(gl.LINES, 2 * scene.linesPerPiece * count, gl.UNSIGNED_INT, 0);
    }
    if (state.ball) {
      const grey = dark ? 0.55 : 0.7;
      gl.uniform4f(start(strokes, 0)("ink"), grey, grey, grey, 1);
      gl.bindVertexArray(sphere);
      gl.drawArrays(gl.LINES, 0, circle.length / 3);
    }
  }

  const view = turnable(canvas, [-0.5, 0.45], 3, draw);
  new ResizeObserver(draw).observe(stage);
  draw();
})();
