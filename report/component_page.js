// SPDX-License-Identifier: Apache-2.0
// Shows components of a clip: each as colours on the mesh, its weights as a curve, and a slider that moves the mesh.
(() => {
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const gradient = data.domain === "gradient";
const channels = gradient ? 9 : 3;
const colors = ["#dfe4ea", "#f5d94e", "#ee7b30", "#a61b29"];  // from nothing to the component's largest value

function numbersOf(base64, Type) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Type(bytes.buffer, 0, bytes.length / Type.BYTES_PER_ELEMENT);
}

const rest = numbersOf(data.rest, Float32Array), triangles = numbersOf(data.triangles, Uint32Array);
const tableOfWeights = numbersOf(data.weights, Float32Array);
const vertices = rest.length / 3, count = data.components.length, frames = data.frames;
const components = data.components.map((c) => ({
  name: c.name, centre: c.centre, scale: c.scale, nodes: numbersOf(c.nodes, Uint32Array),
  values: numbersOf(c.values, Int16Array),
}));
const weights = new Float64Array(count);

function add(parent, tag, text, attributes = {}) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return parent.appendChild(element);
}

const figure = (x) => (x === 0 ? "0" : Math.abs(x) < 1e-4 ? x.toExponential(2) : String(+x.toPrecision(3)));

// The positions that displacements pose.
function poseDisplacements(out) {
  out.set(rest);
  components.forEach((c, k) => {
    const w = weights[k] * c.scale;
    if (w === 0) return;
    for (let i = 0; i < c.nodes.length; ++i) {
      const at = 3 * c.nodes[i];
      for (let a = 0; a < 3; ++a) out[at + a] += w * c.values[3 * i + a];
    }
  });
}

// The gradients of the hat functions of each triangle's corners, 9 numbers a triangle (corner by corner), and its area;
// zeros where it has none.
function makeHats() {
  const hats = new Float64Array(3 * triangles.length), areas = new Float64Array(triangles.length / 3);
  const edge = (j, from, to) => [0, 1, 2].map((a) => rest[3 * triangles[3 * j + to] + a] - rest[3 * triangles[3 * j + from] + a]);
  const cross = (x, y) => [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
  const square = (x) => x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
  for (let j = 0; j < areas.length; ++j) {
    const a = edge(j, 0, 1), b = edge(j, 0, 2), c = edge(j, 1, 2), normal = cross(a, b), twice = Math.sqrt(square(normal));
    if (!(twice > 1e-6 * Math.max(square(a), square(b), square(c)))) continue;
    areas[j] = twice / 2;
    [c, [-b[0], -b[1], -b[2]], a].forEach((opposite, corner) => {
      const g = cross(normal, opposite);
      for (let i = 0; i < 3; ++i) hats[9 * j + 3 * corner + i] = g[i] / (twice * twice);
    });
  }
  return {hats, areas};
}

// The Laplacian of the rest shape as rows of neighbours; what is held has a large diagonal. A row of a vertex without
// area is that of a vertex that stays.
function makeLaplacian({hats, areas}) {
  const rows = Array.from({length: vertices}, () => new Map());
  for (let j = 0; j < areas.length; ++j) {
    if (areas[j] === 0) continue;
    for (let a = 0; a < 3; ++a) {
      for (let b = 0; b < 3; ++b) {
        let dot = 0;
        for (let i = 0; i < 3; ++i) dot += hats[9 * j + 3 * a + i] * hats[9 * j + 3 * b + i];
        const row = rows[triangles[3 * j + a]], column = triangles[3 * j + b];
        row.set(column, (row.get(column) || 0) + areas[j] * dot);
      }
    }
  }
  const first = new Uint32Array(vertices + 1), diagonal = new Float64Array(vertices);
  rows.forEach((row, v) => { first[v + 1] = first[v] + row.size; });
  const column = new Uint32Array(first[vertices]), value = new Float64Array(first[vertices]);
  rows.forEach((row, v) => {
    let at = first[v];
    for (const [c, x] of row) {
      column[at] = c;
      value[at++] = x;
      if (c === v) diagonal[v] = x;
    }
  });
  return {first, column, value, diagonal};
}

// For each vertex the number of its connected component over triangles with area, and which of these are held.
function makePieces(areas, mass) {
  const parent = Uint32Array.from({length: vertices}, (_, v) => v);
  const root = (v) => { while (parent[v] !== v) v = parent[v] = parent[parent[v]]; return v; };
  for (let j = 0; j < areas.length; ++j) {
    if (areas[j] === 0) continue;
    for (let a = 1; a < 3; ++a) parent[root(triangles[3 * j + a])] = root(triangles[3 * j]);
  }
  const piece = Uint32Array.from({length: vertices}, (_, v) => root(v));
  const still = new Uint8Array(vertices), held = new Uint8Array(vertices), sum = new Float64Array(vertices);
  const hold = (v) => { still[v] = 1; held[piece[v]] = 1; };
  data.still.forEach(hold);
  for (let v = 0; v < vertices; ++v) {
    if (mass[v] === 0) hold(v);
    sum[piece[v]] += mass[v];
  }
  return {piece, still, held, sum};
}

// Poses gradients by the Poisson system of the rest shape (Sumner and Popovic 2004), by conjugate gradients that begin
// with the offsets of the pose before.
function makeGradientPose() {
  const shape = makeHats(), {hats, areas} = shape, matrix = makeLaplacian(shape);
  const mass = new Float64Array(vertices);
  for (let j = 0; j < areas.length; ++j) for (let a = 0; a < 3; ++a) mass[triangles[3 * j + a]] += areas[j] / 3;
  const {piece, still, held, sum} = makePieces(areas, mass);
  const q = new Float64Array(9 * areas.length), offsets = new Float64Array(3 * vertices);

  const gradientOf = (j, out) => {
    const at = 9 * j, x = q[at], y = q[at + 1], z = q[at + 2], square = x * x + y * y + z * z, angle = Math.sqrt(square);
    const s = angle > 1e-4 ? Math.sin(angle) / angle : 1 - square / 6;
    const c = angle > 1e-4 ? (1 - Math.cos(angle)) / square : 0.5 - square / 24;
    const r = [1 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y, c * x * y + s * z, 1 - c * (x * x + z * z),
      c * y * z - s * x, c * x * z - s * y, c * y * z + s * x, 1 - c * (x * x + y * y)];
    const p = [1 + q[at + 3], q[at + 6], q[at + 7], q[at + 6], 1 + q[at + 4], q[at + 8], q[at + 7], q[at + 8], 1 + q[at + 5]];
    for (let i = 0; i < 3; ++i) {
      for (let k = 0; k < 3; ++k) {
        out[3 * i + k] = r[3 * i] * p[k] + r[3 * i + 1] * p[3 + k] + r[3 * i + 2] * p[6 + k] - (i === k ? 1 : 0);
      }
    }
  };
  const rightSide = () => {
    const b = new Float64Array(3 * vertices), change = new Float64Array(9);
    q.fill(0);
    components.forEach((c, k) => {
      const w = weights[k] * c.scale;
      if (w === 0) return;
      for (let i = 0; i < c.nodes.length; ++i) {
        for (let a = 0; a < 9; ++a) q[9 * c.nodes[i] + a] += w * c.values[9 * i + a];
      }
    });
    for (let j = 0; j < areas.length; ++j) {
      if (areas[j] === 0) continue;
      gradientOf(j, change);
      for (let a = 0; a < 3; ++a) {
        const v = triangles[3 * j + a], h = 9 * j + 3 * a;
        for (let i = 0; i < 3; ++i) {
          b[3 * v + i] += areas[j] * (change[3 * i] * hats[h] + change[3 * i + 1] * hats[h + 1] + change[3 * i + 2] * hats[h + 2]);
        }
      }
    }
    return b;
  };
  // Rows and columns of still vertices are left out.
  const multiply = (x, out) => {
    for (let v = 0; v < vertices; ++v) {
      let a = 0, b = 0, c = 0;
      if (!still[v]) {
        for (let i = matrix.first[v]; i < matrix.first[v + 1]; ++i) {
          const u = 3 * matrix.column[i], m = matrix.value[i];
          a += m * x[u];
          b += m * x[u + 1];
          c += m * x[u + 2];
        }
      }
      out[3 * v] = a;
      out[3 * v + 1] = b;
      out[3 * v + 2] = c;
    }
  };
  const clear = (x) => { for (let v = 0; v < vertices; ++v) if (still[v]) x.fill(0, 3 * v, 3 * v + 3); };
  const dot = (x, y) => { let sum = 0; for (let i = 0; i < x.length; ++i) sum += x[i] * y[i]; return sum; };
  const solve = () => {
    const r = rightSide(), z = new Float64Array(r.length), step = new Float64Array(r.length), t = new Float64Array(r.length);
    clear(r);
    const size = dot(r, r);
    multiply(offsets, t);
    for (let i = 0; i < r.length; ++i) r[i] -= t[i];
    let last = 0;
    for (let round = 0; round < 2000 && dot(r, r) > 1e-8 * size; ++round) {
      for (let v = 0; v < vertices; ++v) {
        for (let a = 0; a < 3; ++a) z[3 * v + a] = matrix.diagonal[v] > 0 ? r[3 * v + a] / matrix.diagonal[v] : 0;
      }
      const now = dot(r, z), turn = last > 0 ? now / last : 0;
      for (let i = 0; i < step.length; ++i) step[i] = z[i] + turn * step[i];
      multiply(step, t);
      const length = now / dot(step, t);
      for (let i = 0; i < step.length; ++i) {
        offsets[i] += length * step[i];
        r[i] -= length * t[i];
      }
      last = now;
    }
    if (size === 0) offsets.fill(0);
  };
  // Each piece that nothing holds keeps its centroid.
  const place = () => {
    const mean = new Float64Array(3 * vertices);
    for (let v = 0; v < vertices; ++v) for (let a = 0; a < 3; ++a) mean[3 * piece[v] + a] += mass[v] * offsets[3 * v + a];
    for (let v = 0; v < vertices; ++v) {
      if (held[piece[v]]) continue;
      for (let a = 0; a < 3; ++a) offsets[3 * v + a] -= mean[3 * piece[v] + a] / sum[piece[v]];
    }
  };
  return (out) => {
    solve();
    place();
    for (let i = 0; i < out.length; ++i) out[i] = rest[i] + offsets[i];
  };
}

// The size of a component at each vertex, from 0 to 1: of triangles the mean around a vertex.
function sizesOf(k) {
  const c = components[k], size = new Float32Array(vertices), around = gradient ? new Float32Array(vertices) : null;
  if (gradient) for (const v of triangles) ++around[v];
  for (let i = 0; i < c.nodes.length; ++i) {
    let square = 0;
    for (let a = 0; a < channels; ++a) square += c.values[channels * i + a] ** 2;
    if (!gradient) size[c.nodes[i]] = Math.sqrt(square);
    else for (let a = 0; a < 3; ++a) size[triangles[3 * c.nodes[i] + a]] += Math.sqrt(square);
  }
  let largest = 0;
  for (let v = 0; v < vertices; ++v) {
    if (gradient && around[v] > 0) size[v] /= around[v];
    largest = Math.max(largest, size[v]);
  }
  if (largest > 0) for (let v = 0; v < vertices; ++v) size[v] /= largest;
  return size;
}

const stops = colors.map((c) => new THREE.Color(c));
function paint(attribute, size) {
  const color = new THREE.Color();
  for (let v = 0; v < vertices; ++v) {
    const at = (size ? size[v] : 0) * (stops.length - 1), i = Math.min(Math.floor(at), stops.length - 2);
    color.copy(stops[i]).lerp(stops[i + 1], at - i).toArray(attribute.array, 3 * v);
  }
  attribute.needsUpdate = true;
}

// The mesh in a scene, which is drawn into the page and, once for each component, into its picture.
function makeScene(canvas) {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
  const positions = Float32Array.from(rest), box = new THREE.Box3().setFromArray(rest);
  const centre = box.getCenter(new THREE.Vector3()), radius = Math.max(1e-30, box.getSize(new THREE.Vector3()).length() / 2);
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
  const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({side: THREE.DoubleSide, vertexColors: THREE.VertexColors}));
  mesh.frustumCulled = false;
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xeef1f5);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x8a93a0, 0.55), mesh);
  const camera = new THREE.PerspectiveCamera(30, 1, radius / 100, radius * 100);
  camera.position.set(0.5, 0.3, 1).setLength(3.6 * radius).add(centre);
  camera.add(new THREE.DirectionalLight(0xffffff, 0.75));
  scene.add(camera);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.target.copy(centre);
  controls.update();
  const draw = (width = canvas.clientWidth, height = canvas.clientHeight, ratio = window.devicePixelRatio) => {
    renderer.setPixelRatio(ratio);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
    canvas.dataset.triangles = renderer.info.render.triangles;
  };
  controls.addEventListener("change", () => draw());
  window.addEventListener("resize", () => draw());
  return {geometry, positions, draw, colors: geometry.getAttribute("color")};
}

const low = data.positive ? 0 : -1;
const report = document.getElementById("report");
add(report, "h1", data.title);
add(report, "p", `${count} components of ${gradient ? "deformation gradients" : "displacements"}, ${frames} frames, ` +
  `${vertices} vertices, ${triangles.length / 3} triangles. Erms ${figure(data.erms)} (x 1000, longest side 1), largest ` +
  `error ${figure(data.max_error)} model units. The rigid motion of each frame is left out here.`, {class: "note"});
const layout = add(report, "div", undefined, {class: "columns"});
const left = add(layout, "div", undefined, {class: "left"}), list = add(layout, "div");
const canvas = add(left, "canvas", undefined, {class: "shape"});
const bar = add(left, "div", undefined, {class: "row"});
const play = add(bar, "button", "Play", {type: "button"}), reset = add(bar, "button", "Rest shape", {type: "button"});
const slider = add(bar, "input", undefined, {type: "range", class: "wide", min: 0, max: Math.max(0, frames - 1), value: 0});
const where = add(bar, "span", "", {class: "note"});
const chosenName = add(left, "p", "", {class: "note"});
const curveBox = add(left, "div", undefined, {class: "curve"});
const curve = add(curveBox, "canvas");
const scaleLine = add(left, "p", "Colours: from nothing to the component's largest value ", {class: "note"});
add(scaleLine, "span", undefined, {class: "scale"}).style.background = `linear-gradient(to right, ${colors.join(",")})`;
add(left, "p", "Drag to turn, wheel to zoom. A click on a component shows it; its slider moves the mesh.", {class: "note"});

let scene = null;
try {
  scene = makeScene(canvas);
} catch (error) {
  canvas.replaceWith(add(left, "p", "The mesh needs WebGL, which this browser does not offer.", {class: "note"}));
}
const pose = gradient ? makeGradientPose() : poseDisplacements;

// Shapes follow at most once a picture.
let waiting = false;
function show() {
  if (waiting || !scene) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    pose(scene.positions);
    scene.geometry.getAttribute("position").needsUpdate = true;
    scene.geometry.computeVertexNormals();
    scene.draw();
    canvas.dataset.moved = scene.positions.reduce((most, x, i) => Math.max(most, Math.abs(x - rest[i])), 0);
  });
}

const weightAt = (f, k) => tableOfWeights[f * count + k];
const chart = new Chart(curve, {
  type: "line",
  data: {labels: Array.from({length: frames}, (_, f) => f), datasets: [
    {data: [], borderColor: "#0b57d0", borderWidth: 1.6, pointRadius: 0, tension: 0},
    {data: [], borderColor: "#d9480f", backgroundColor: "#d9480f", pointRadius: 5, showLine: false, clip: false},
  ]},
  options: {
    animation: false, maintainAspectRatio: false, plugins: {legend: {display: false}},
    scales: {x: {title: {display: true, text: "frame"}, ticks: {maxRotation: 0, autoSkipPadding: 20}, grid: {display: false}},
      y: {min: low, max: 1, title: {display: true, text: "weight"}}},
    onClick: (event) => {
      const f = chart.scales.x.getValueForPixel(event.x);
      if (f >= 0 && f < frames) goTo(Math.round(f));
    },
  },
});

let chosen = 0;
const rows = components.map((c, k) => {
  const row = add(list, "div", undefined, {class: "component", tabindex: 0});
  const picture = add(row, "canvas", undefined, {class: "picture", width: 216, height: 168});
  const line = add(row, "div", undefined, {class: "line"});
  add(line, "b", c.name);
  const nodes = gradient ? triangles.length / 3 : vertices;
  add(line, "span", `${figure(100 * c.nodes.length / Math.max(1, nodes))} % of the ${gradient ? "triangles" : "vertices"}`, {class: "note"});
  const value = add(line, "output", "0.00");
  const below = add(row, "div");
  const spark = add(below, "canvas", undefined, {class: "spark", width: 600, height: 68});
  const input = add(below, "input", undefined, {type: "range", min: low, max: 1, step: 0.01, value: 0, "aria-label": `weight of ${c.name}`});
  input.addEventListener("input", () => {
    weights[k] = +input.value;
    value.textContent = weights[k].toFixed(2);
    choose(k);
    show();
  });
  row.addEventListener("click", () => choose(k));
  drawSpark(spark, k);
  return {row, picture, input, value};
});

// The weights of a component as a line, the axis at 0.
function drawSpark(target, k) {
  const context = target.getContext("2d"), {width, height} = target;
  const x = (f) => 2 + (width - 4) * f / Math.max(1, frames - 1), y = (w) => height - 3 - (height - 6) * (w - low) / (1 - low);
  context.strokeStyle = "#c3cbd6";
  context.beginPath();
  context.moveTo(0, y(0));
  context.lineTo(width, y(0));
  context.stroke();
  context.strokeStyle = "#0b57d0";
  context.lineWidth = 2;
  context.beginPath();
  for (let f = 0; f < frames; ++f) context[f === 0 ? "moveTo" : "lineTo"](x(f), y(weightAt(f, k)));
  context.stroke();
}

function choose(k) {
  if (count === 0) return;
  rows[chosen].row.classList.remove("chosen");
  chosen = k;
  rows[k].row.classList.add("chosen");
  chosenName.textContent = `${components[k].name}: weight of each frame`;
  chart.data.datasets[0].data = Array.from({length: frames}, (_, f) => weightAt(f, k));
  mark();
  if (scene) {
    paint(scene.colors, sizesOf(k));
    scene.draw();
  }
}

function mark() {
  const f = +slider.value;
  chart.data.datasets[1].data = chart.data.labels.map((at) => (at === f ? weights[chosen] : null));
  chart.update();
  where.textContent = `frame ${f} of ${frames}`;
}

function take(of) {
  for (let k = 0; k < count; ++k) {
    weights[k] = of(k);
    rows[k].input.value = weights[k];
    rows[k].value.textContent = weights[k].toFixed(2);
  }
  mark();
  show();
}

function goTo(frame) {
  slider.value = frame;
  take((k) => weightAt(frame, k));
}
slider.addEventListener("input", () => goTo(+slider.value));
reset.addEventListener("click", () => take(() => 0));
let timer = null;
play.addEventListener("click", () => {
  play.textContent = timer ? "Play" : "Stop";
  if (timer) timer = clearInterval(timer);
  else timer = setInterval(() => goTo((+slider.value + 1) % frames), 1000 / data.fps);
});

// The pictures, of the rest shape.
if (scene) {
  scene.geometry.computeVertexNormals();
  rows.forEach(({picture}, k) => {
    paint(scene.colors, sizesOf(k));
    scene.draw(216, 168, 1);
    picture.getContext("2d").drawImage(canvas, 0, 0, 216, 168);
  });
}
choose(0);
let liveliest = 0;
const effort = (f) => { let sum = 0; for (let k = 0; k < count; ++k) sum += weightAt(f, k) ** 2; return sum; };
for (let f = 1; f < frames; ++f) if (effort(f) > effort(liveliest)) liveliest = f;
if (frames > 0) goTo(liveliest);
document.body.dataset.components = rows.length;
document.body.dataset.ready = "yes";
})();
