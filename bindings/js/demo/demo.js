// SPDX-License-Identifier: Apache-2.0
// The page around <sac-player>: files that are opened or dropped, and figures.
import { SacPlayer } from './player.js';

await customElements.whenDefined('sac-player');
const $ = (id) => document.getElementById(id);
const player = $('player');
const builtin = { input: new URL('walker.sac', document.baseURI).href, name: 'A walking figure' };
let clip = builtin;
let shown = null, mostLayers = 0;
let decodes = [], renders = [], pictures = [];

const count = new Intl.NumberFormat('en');
const bytesText = (n) => (n < 10000 ? `${count.format(n)} B` : n < 1e7 ? `${(n / 1000).toFixed(1)} kB` : `${(n / 1e6).toFixed(1)} MB`);
const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1] ?? NaN;
const ms = (value) => (Number.isFinite(value) ? `${value.toFixed(value < 10 ? 1 : 0)} ms` : '–');

async function show(next) {
  clip = next;
  $('name').textContent = next.name;
  document.title = `${next.name} – sac`;
  $('builtin').hidden = next === builtin;
  for (const id of ['bytes', 'rate', 'bpvf', 'vertices', 'triangles', 'frames', 'start', 'decode', 'memory']) $(id).textContent = '–';
  $('ratio').textContent = '';
  decodes = [];
  if (next !== shown) {
    mostLayers = 0;
    $('layers').value = $('layers').max = 1;
    $('layer-row').hidden = true;
  }
  shown = next;
  player.options = { interpolation: $('between').value };
  // All of them are wanted at the slider's end, also those of later groups that have more.
  if (mostLayers > 0 && $('layers').value < mostLayers) player.options.layers = Number($('layers').value);
  try {
    await player.load(next.input);
    paint();
    player.wireframe = $('wireframe').checked;
  } catch { /* the player shows what is wrong */ }
}

function open(files) {
  const list = [...files];
  const file = list.find((f) => /\.sac$/i.test(f.name)) ?? list[0];
  if (file) void show({ input: file, name: file.name });
}

function paint() {
  const { mesh } = player;
  if (!mesh || mesh.geometry.attributes.color) return;
  mesh.material.color.set($('color').value);
  player.viewer.dirty = true;
}

function figures() {
  const { mesh, viewer } = player;
  if (!mesh || !viewer) return;
  const { stats, frames, frameRate, duration } = mesh;
  layerSlider(stats.layers);
  const vertices = mesh.userData.sourceVertices;
  const { index } = mesh.geometry;
  if (vertices) {
    $('vertices').textContent = count.format(vertices);
    $('triangles').textContent = count.format(index.count / 3);
  }
  if (stats.bytes) $('bytes').textContent = bytesText(stats.bytes);
  if (frames && vertices) {
    $('frames').textContent = `${count.format(frames)} at ${+frameRate.toFixed(2)} Hz`;
    $('rate').textContent = bytesText(Math.round(stats.bytes / duration));
    $('bpvf').textContent = ((8 * stats.bytes) / (vertices * frames)).toFixed(4);
    $('ratio').textContent = `1 : ${count.format(Math.round((12 * vertices * frames) / stats.bytes))} of raw floats`;
  }
  $('start').textContent = ms(stats.firstShapeMs);
  $('decode').textContent = ms(median(decodes));
  $('render').textContent = ms(median(renders));
  $('memory').textContent = stats.memory ? `${(stats.memory / 2 ** 20).toFixed(0)} MiB` : '–';
  const now = performance.now();
  pictures = pictures.filter((t) => now - t < 1000);
  $('fps').textContent = String(pictures.length);
  graph();
}

// Streams of groups without layers have one, and no slider.
function layerSlider(layers) {
  if (layers > mostLayers) {
    const slider = $('layers'), all = mostLayers === 0 || Number(slider.value) === mostLayers;
    mostLayers = layers;
    slider.max = layers;
    if (all) slider.value = layers;
  }
  $('layer-row').hidden = mostLayers < 2;
  $('layer-count').textContent = `${$('layers').value} of ${mostLayers}`;
}

// Begins the clip again, at the same time.
async function again() {
  const time = player.currentTime, { paused } = player;
  await show(clip);
  if (paused) player.pause();
  player.currentTime = time;
}

function graph() {
  const canvas = $('graph'), context = canvas.getContext('2d');
  const { width, height } = canvas;
  context.clearRect(0, 0, width, height);
  const most = Math.max(...decodes, 4);
  context.fillStyle = '#5db2ff';
  decodes.forEach((value, i) => {
    const h = Math.max((value / most) * (height - 8), 1.5);
    context.fillRect(i * (width / 128), height - h, width / 128 - 1, h);
  });
}

player.addEventListener('sac-frame', () => {
  decodes.push(player.mesh.stats.decodeMs);
  if (decodes.length > 128) decodes.shift();
});
const draw = player.viewer.onRender;
player.viewer.onRender = () => {
  draw();
  renders.push(player.viewer.renderMs);
  if (renders.length > 60) renders.shift();
  pictures.push(performance.now());
};
setInterval(figures, 250);

$('open').onclick = () => $('file').click();
$('file').onchange = () => {
  open($('file').files);
  $('file').value = '';
};
$('builtin').onclick = () => show(builtin);
$('between').onchange = again;
$('layers').onchange = again;
$('follow').onchange = () => player.setAttribute('follow', String($('follow').checked));
$('wireframe').onchange = () => (player.wireframe = $('wireframe').checked);
$('color').oninput = paint;

const drop = $('drop');
let inside = 0;
addEventListener('dragenter', (e) => {
  e.preventDefault();
  ++inside;
  drop.hidden = false;
});
addEventListener('dragleave', () => (drop.hidden = --inside <= 0));
addEventListener('dragover', (e) => e.preventDefault());
addEventListener('drop', (e) => {
  e.preventDefault();
  inside = 0;
  drop.hidden = true;
  open(e.dataTransfer.files);
});

// `sac view` serves the clip that it was given beside the page, and says so in the address.
const asked = new URLSearchParams(location.search).get('clip');
void show(asked ? { input: new URL(asked, document.baseURI).href, name: decodeURIComponent(asked.split('/').pop()) } : builtin);
void SacPlayer;
