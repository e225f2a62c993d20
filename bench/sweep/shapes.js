// SPDX-License-Identifier: Apache-2.0
// Shows frames of a clip: the original above, the decoded shapes below with their errors as colours. All turn together.
"use strict";

// The colours of errors from 1e-6 to 1e-1 of the diagonal, on a logarithmic scale (display_mesh.h).
const errorColors = ["#30508f", "#3f9fb5", "#8fd07c", "#f5d94e", "#ee7b30", "#a61b29"];

function numbersOf(base64, Type) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return new Type(bytes.buffer, 0, Math.floor(bytes.length / Type.BYTES_PER_ELEMENT));
}

// The positions of one frame, in model units relative to `centre`.
function positionsOf(samples, frame, shapes, centre) {
  const n = shapes.vertices, out = new Float32Array(3 * n);
  for (let i = 0; i < 3 * n; ++i) {
    const a = i % 3, low = shapes.low[a], extent = shapes.high[a] - low;
    out[i] = low + extent * (2 * samples[3 * n * frame + i] / 65535 - 0.5) - centre[a];
  }
  return out;
}

function boxOf(positions) {
  const box = new THREE.Box3();
  box.setFromArray(positions);
  return box;
}

function colorTable() {
  const stops = errorColors.map((c) => new THREE.Color(c));
  return Array.from({length: 256}, (_, i) => {
    const at = i / 255 * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
    return stops[k].clone().lerp(stops[k + 1], at - k);
  });
}

function meshOf(positions, triangles, colors) {
  const geometry = new THREE.BufferGeometry();
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  if (colors) geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
  geometry.computeVertexNormals();
  const material = new THREE.MeshLambertMaterial(
    {side: THREE.DoubleSide, color: colors ? 0xffffff : 0xb9c3cf, vertexColors: colors ? THREE.VertexColors : THREE.NoColors});
  return new THREE.Mesh(geometry, material);
}

// Makes the cells, each of which is a scene drawn into its part of the canvas. All cells share one camera.
function makeStrip(canvas, columns, radius) {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true});
  renderer.setPixelRatio(window.devicePixelRatio);
  renderer.setScissorTest(true);
  const camera = new THREE.PerspectiveCamera(30, 1, radius / 100, radius * 100);
  camera.position.set(0.5, 0.3, 1).setLength(3.3 * radius);
  camera.add(new THREE.DirectionalLight(0xffffff, 0.75));
  const controls = new THREE.OrbitControls(camera, canvas);
  const cells = [];
  for (let i = 0; i < 2 * columns; ++i) {
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(i < columns ? 0xeef1f5 : 0xe3e8ee);
    scene.add(new THREE.HemisphereLight(0xffffff, 0x8a93a0, 0.55));
    cells.push(scene);
  }
  const draw = () => {
    const width = canvas.clientWidth, height = canvas.clientHeight;
    renderer.setSize(width, height, false);
    const w = width / columns, h = height / 2;
    camera.aspect = w / h;
    camera.updateProjectionMatrix();
    cells.forEach((scene, i) => {
      scene.add(camera);
      const x = (i % columns) * w, y = i < columns ? h : 0;
      renderer.setViewport(x, y, w, h);
      renderer.setScissor(x, y, w, h);
      renderer.render(scene, camera);
    });
    canvas.dataset.triangles = renderer.info.render.triangles;
  };
  controls.addEventListener("change", draw);
  window.addEventListener("resize", draw);
  return {cells, draw};
}

function drawShapes(parent, clip, data) {
  const make = (tag, className, text) => {
    const element = document.createElement(tag);
    if (className) element.className = className;
    if (text) element.textContent = text;
    return element;
  };
  const shapes = clip.shapes, columns = shapes.frames.length;
  const triangles = numbersOf(shapes.triangles, Uint16Array), original = numbersOf(shapes.original, Uint16Array);
  if (!shapes.decoded.length || !triangles.length) return parent.append(make("p", "note", "Nothing to show."));

  const row = make("div", "row"), select = make("select");
  for (const {result} of shapes.decoded) {
    const r = data.results[result], title = data.codecs.find((c) => c.name === r.codec).title;
    const option = make("option", "", `${title}, ${r.setting}: ${r.bpvf.toPrecision(3)} bpvf, KG ${Number(r.kg).toPrecision(3)} %`);
    select.append(option);
  }
  const scale = make("div", "key"), bar = make("div", "scale"), ticks = make("div", "ticks");
  bar.style.background = `linear-gradient(to right, ${errorColors.join(",")})`;
  for (const t of ["1e-6", "1e-5", "1e-4", "1e-3", "0.01", "0.1"]) ticks.append(make("span", "", t));
  scale.append(bar, ticks, make("span", "note", "error, in diagonals of the first frame's box"));
  row.append(select, scale);
  const canvas = make("canvas", "strip");
  const shown = shapes.vertices === clip.vertices ? "" : `, ${shapes.vertices} of ${clip.vertices} vertices`;
  parent.append(row, canvas, make("p", "note", `Frames ${shapes.frames.join(", ")}${shown}: the original above, decoded ` +
    "below. Drag to turn, wheel to zoom."));

  const centres = shapes.frames.map((_, f) => boxOf(positionsOf(original, f, shapes, [0, 0, 0])).getCenter(new THREE.Vector3()).toArray());
  const radius = Math.max(1e-30, ...shapes.frames.map((_, f) =>
    boxOf(positionsOf(original, f, shapes, [0, 0, 0])).getSize(new THREE.Vector3()).length() / 2));
  let strip;
  try {
    strip = makeStrip(canvas, columns, radius);
  } catch (error) {
    canvas.replaceWith(make("p", "note", "Shapes need WebGL, which this browser does not offer."));
    return undefined;
  }
  const table = colorTable();
  for (let f = 0; f < columns; ++f) strip.cells[f].add(meshOf(positionsOf(original, f, shapes, centres[f]), triangles));
  let last = [];
  const show = () => {
    for (const mesh of last) {
      mesh.parent.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    const samples = shapes.decoded[select.selectedIndex].samples;
    const places = numbersOf(samples, Uint16Array), bytes = numbersOf(samples, Uint8Array), n = shapes.vertices;
    last = shapes.frames.map((_, f) => {
      const colors = new Float32Array(3 * n);
      for (let v = 0; v < n; ++v) table[bytes[6 * n * columns + n * f + v]].toArray(colors, 3 * v);
      const mesh = meshOf(positionsOf(places, f, shapes, centres[f]), triangles, colors);
      strip.cells[columns + f].add(mesh);
      return mesh;
    });
    strip.draw();
  };
  select.addEventListener("change", show);
  show();
  return undefined;
}
