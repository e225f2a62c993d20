// SPDX-License-Identifier: Apache-2.0
// Builds the report from the embedded data: for each clip plots, a table of Bjontegaard rates, shapes and all figures.
(() => {
"use strict";

const data = JSON.parse(document.getElementById("data").textContent);
const palette = ["#0b57d0", "#d9480f", "#2b8a3e", "#862e9c", "#c2255c", "#0c8599", "#846358", "#e0a800", "#495057",
  "#5c940d", "#f06595", "#a61e4d"];

// The measures by which results are plotted. `of` gives undefined for values that a logarithmic axis cannot show.
const positive = (x) => (x > 0 && Number.isFinite(x) ? x : undefined);
const measures = [
  {title: "KG error, %", of: (r) => positive(r.kg)},
  {title: "STED", of: (r) => positive(r.sted)},
  {title: "Largest error, of the diagonal", of: (r, clip) => positive(r.max_error / clip.diagonal), low: true},
  {title: "Decoding, ms of CPU a frame", of: (r, clip) => positive(1000 * r.decode_cpu_s / clip.frames), low: true},
];

function add(parent, tag, text, attributes = {}) {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return parent.appendChild(element);
}

function figure(x, digits = 3) {
  if (x === null || x === undefined) return "∞";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-4) return x.toExponential(digits - 1);
  return size >= 10 ** digits ? String(Math.round(x)) : x.toPrecision(digits);
}

// Labels of ticks: at powers of ten where the axis spans more than 2.5 decades, otherwise also at 2 and 5 times them.
function tick(value, index, ticks) {
  const wide = Math.log10(ticks[ticks.length - 1].value / ticks[0].value) > 2.5;
  const lead = Math.round(value / 10 ** Math.floor(Math.log10(value) + 1e-9));
  return (wide ? lead === 1 : lead === 1 || lead === 2 || lead === 5) ? String(+value.toPrecision(3)) : "";
}

// The curves of a clip: for each codec its results, in the order in which they were planned.
function curvesOf(clip) {
  return data.codecs.map((codec, index) => ({
    codec, color: palette[index % palette.length],
    results: data.results.filter((r) => r.clip_index === clip.index && r.codec === codec.name && !r.error),
  })).filter((curve) => curve.results.length > 0);
}

function drawPlot(parent, clip, curves, measure) {
  const box = add(parent, "div", undefined, {class: measure.low ? "plot low" : "plot"});
  const canvas = add(box, "canvas", undefined, {"aria-label": `${measure.title} over bits a vertex and frame`, role: "img"});
  const axis = (text) => ({
    type: "logarithmic", title: {display: true, text}, ticks: {callback: tick, maxRotation: 0, autoSkip: false},
    grid: {color: "#e6eaef"},
  });
  const chart = new Chart(canvas, {
    type: "scatter",
    data: {
      datasets: curves.map((curve) => ({
        label: curve.codec.title, borderColor: curve.color, backgroundColor: curve.color, showLine: true,
        borderWidth: curve.codec === data.codecs[0] ? 3 : 1.5, pointRadius: 3, pointHoverRadius: 6,
        data: curve.results.map((r) => ({x: positive(r.bpvf), y: measure.of(r, clip), result: r}))
          .filter((p) => p.x !== undefined && p.y !== undefined).sort((a, b) => a.x - b.x),
      })),
    },
    options: {
      animation: false, maintainAspectRatio: false,
      scales: {x: axis("bits a vertex and frame, all bytes counted"), y: axis(measure.title)},
      plugins: {
        legend: {display: false},
        tooltip: {callbacks: {label: (item) => {
          const r = item.raw.result;
          return [`${item.dataset.label}, ${r.setting}`, `${figure(r.bpvf)} bpvf, KG ${figure(r.kg)} %`,
            `STED ${figure(r.sted)} (spatial ${figure(r.sted_s)}, temporal ${figure(r.sted_t)})`,
            `largest error ${figure(r.max_error)}, ${figure(r.max_error / clip.diagonal)} of the diagonal`,
            `encoded in ${figure(r.encode_cpu_s)} s, decoded in ${figure(r.decode_cpu_s)} s`];
        }}},
      },
    },
  });
  // The number of points within the plot is noted in the page, so that tests can check it.
  const {left, right, top, bottom} = chart.chartArea;
  const inside = (p) => p.x >= left - 1 && p.x <= right + 1 && p.y >= top - 1 && p.y <= bottom + 1;
  canvas.dataset.points = curves.reduce((n, _, i) => n + chart.getDatasetMeta(i).data.filter(inside).length, 0);
  return chart;
}

function drawLegend(parent, curves, charts) {
  const legend = add(parent, "div", undefined, {class: "legend"});
  curves.forEach((curve, index) => {
    const button = add(legend, "button", undefined, {type: "button", "aria-pressed": "true"});
    add(button, "i").style.background = curve.color;
    button.append(curve.codec.title);
    button.addEventListener("click", () => {
      const shown = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", shown);
      for (const chart of charts) chart.setDatasetVisibility(index, shown);
      for (const chart of charts) chart.update();
    });
  });
  return legend;
}

function drawTable(parent, headings, rows) {
  const table = add(add(parent, "div", undefined, {class: "scroll"}), "table");
  const head = add(add(table, "thead"), "tr");
  for (const [text, kind] of headings) add(head, "th", text, {class: kind});
  const body = add(table, "tbody");
  for (const row of rows) {
    const line = add(body, "tr");
    row.forEach((text, i) => add(line, "td", text, {class: headings[i][1]}));
  }
  return table;
}

function drawRates(parent, clip, curves) {
  const others = curves.filter((curve) => curve.codec !== data.codecs[0]);
  if (others.length === 0) return;
  add(parent, "h3", "Bjøntegaard rates");
  add(parent, "p", `How many more bits than ${data.codecs[0].title} a codec takes at equal error, as the mean over the ` +
    "errors that both reach (monotone cubics through the logarithms). Points that another of the same codec beats are left out.",
    {class: "note"});
  const rateOf = (curve, measure) => data.bd_rates.find((b) =>
    b.clip === clip.index && b.measure === measure && data.codecs[b.codec] === curve.codec);
  const cells = (rate) => rate && rate.percent !== null
    ? [`${rate.percent >= 0 ? "+" : "−"}${figure(Math.abs(rate.percent))} %`, `${figure(1 + rate.percent / 100)} times`,
      `${figure(rate.low)} to ${figure(rate.high)}`]
    : ["no error in common", "", ""];
  drawTable(parent, [["codec", ""], ["at equal KG", "number"], ["", "number"], ["over KG, %", ""], ["at equal STED", "number"],
    ["", "number"], ["over STED", ""]],
  others.map((curve) => [curve.codec.title, ...cells(rateOf(curve, "kg")), ...cells(rateOf(curve, "sted"))]))
    .classList.add("rates");
}

function drawFigures(parent, clip) {
  const details = add(parent, "details");
  add(details, "summary", "All figures");
  add(details, "p", `Times are CPU seconds of a process, user and system, with reading and writing; ${data.jobs} ` +
    `${data.jobs === 1 ? "was" : "were"} run at a time. Peak memory is resident.`, {class: "note"});
  const columns = [["bytes", (r) => r.bytes], ["bpvf", (r) => figure(r.bpvf, 4)], ["KG, %", (r) => figure(r.kg, 4)],
    ["STED", (r) => figure(r.sted, 4)], ["spatial", (r) => figure(r.sted_s, 4)], ["temporal", (r) => figure(r.sted_t, 4)],
    ["largest error", (r) => figure(r.max_error)], ["encode s", (r) => figure(r.encode_cpu_s)],
    ["MB", (r) => figure(r.encode_peak_mb)], ["decode s", (r) => figure(r.decode_cpu_s)], ["MB", (r) => figure(r.decode_peak_mb)]];
  drawTable(details, [["codec", ""], ["setting", ""], ...columns.map(([title]) => [title, "number"])],
    data.results.filter((r) => r.clip_index === clip.index && !r.error).map((r) =>
      [data.codecs.find((c) => c.name === r.codec).title, r.setting, ...columns.map(([, of]) => of(r))]))
    .classList.add("figures");
}

function drawClip(parent, clip) {
  const section = add(parent, "section");
  add(section, "h2", clip.name);
  add(section, "p", `${clip.vertices} vertices, ${clip.triangles} triangles, ${clip.frames} frames; diagonal of the first ` +
    `frame's box ${figure(clip.diagonal)}`, {class: "note"});
  const curves = curvesOf(clip);
  const charts = [];
  const legend = drawLegend(section, curves, charts);
  const plots = add(section, "div", undefined, {class: "plots"});
  for (const measure of measures) charts.push(drawPlot(plots, clip, curves, measure));
  add(legend, "span", "A click hides a curve.", {class: "note"});
  const exact = data.results.filter((r) => r.clip_index === clip.index && r.kg === 0);
  if (exact.length) {
    add(section, "p", "Not on logarithmic axes, being exact: " + exact.map((r) =>
      `${data.codecs.find((c) => c.name === r.codec).title} (${r.setting}), ${figure(r.bpvf)} bpvf`).join("; ") + ".");
  }
  const failed = data.results.filter((r) => r.clip_index === clip.index && r.error);
  for (const r of failed) add(section, "p", `Failed: ${r.codec}, ${r.setting}: ${r.error}`);
  drawRates(section, clip, curves);
  add(section, "h3", "Shapes");
  drawShapes(section, clip, data);
  drawFigures(section, clip);
}

const report = document.getElementById("report");
add(report, "h1", "Rate and distortion");
add(report, "p", "Each setting of each codec was encoded by one process and decoded by another, which got nothing but files. " +
  "All bytes count, the triangles' too. Errors are those of the decoded vertices, measured by sac for every codec.", {class: "note"});
const list = add(report, "ul");
for (const codec of data.codecs) {
  add(list, "li", codec.missing ? `${codec.title}: missing, ${codec.missing}` : [codec.title, codec.version].filter(Boolean).join(", "));
}
data.clips.forEach((clip, index) => drawClip(report, Object.assign(clip, {index})));
document.body.dataset.ready = "yes";
})();
