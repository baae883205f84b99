"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const SVG = "http://www.w3.org/2000/svg";

function element(parent, name, attributes, text) {
  const node = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes || {})) node.setAttribute(key, value);
  if (text !== undefined) node.textContent = text;
  parent.appendChild(node);
  return node;
}

// A column of a vehicle at a time: linear between samples, the ends held.
function at(vehicle, column, time) {
  const values = vehicle[column];
  if (!values.length) return 0;
  const place = Math.min(Math.max((time - vehicle.start) / data.step, 0), values.length - 1);
  const low = Math.floor(place), high = Math.min(low + 1, values.length - 1);
  // The last step is shorter than the others.
  const last = vehicle.end - vehicle.start - data.step * (values.length - 2);
  const whole = low === values.length - 2 && last > 0 ? last / data.step : 1;
  return values[low] + (values[high] - values[low]) * Math.min((place - low) / whole, 1);
}

function position(vehicle, time) {
  return vehicle.east.length ? [at(vehicle, "east", time), at(vehicle, "north", time)] : vehicle.pad;
}

// ---- map: the world group is scaled, what should keep its size lies in an overlay ----
const map = byId("map");
const world = element(map, "g"), overlay = element(map, "g");
const view = { scale: 1, x: 0, y: 0 };
const onPaper = ([east, north]) => [view.x + view.scale * east, view.y - view.scale * north];
const fixed = [];

function drawMap() {
  const line = { fill: "none", "vector-effect": "non-scaling-stroke" };
  for (const target of data.targets) {
    element(world, "circle", { ...line, cx: target.east, cy: target.north, r: target.safe_distance,
      fill: "#f1f1f1", stroke: "#bbb" });
  }
  for (const vehicle of data.vehicles) {
    const style = { ...line, stroke: vehicle.colour };
    vehicle.layer = element(world, "g");
    for (const circle of vehicle.circles) {
      element(vehicle.layer, "circle", { ...style, cx: circle.east, cy: circle.north, r: circle.radius,
        "stroke-dasharray": "4 3" });
    }
    const points = vehicle.east.map((east, k) => east + "," + vehicle.north[k]);
    element(vehicle.layer, "polyline", { ...style, points: points.join(" "), "stroke-opacity": 0.45 });
    vehicle.flown = element(vehicle.layer, "polyline", { ...style, "stroke-width": 3 });
    vehicle.points = points;
  }
  for (const target of data.targets) {
    const group = element(overlay, "g", { class: "target" });
    element(group, "text", { class: "halo" }, target.label);
    fixed.push([group, [target.east, target.north]]);
  }
  const depot = element(overlay, "g");
  element(depot, "rect", { x: -5, y: -5, width: 10, height: 10, fill: "#222" });
  element(depot, "text", { x: 8, y: 16, class: "halo" }, "depot");
  fixed.push([depot, data.depot]);
  for (const vehicle of data.vehicles) {
    vehicle.mark = element(overlay, "g", { class: "vehicle", "data-vehicle": vehicle.name });
    vehicle.arrow = element(vehicle.mark, "path", { d: "M0,-11 L7,8 L0,4 L-7,8 Z", fill: vehicle.colour, stroke: "#fff" });
    element(vehicle.mark, "text", { x: 9, y: -7, class: "halo" }, vehicle.number);
  }
  element(map, "line", { id: "scale", stroke: "#222", "stroke-width": 2 });
  element(map, "text", { id: "scale-text", class: "halo" });
}

function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return [5, 2, 1].map((step) => step * power).find((step) => step <= length) || power;
}

function placeMap() {
  world.setAttribute("transform", `translate(${view.x},${view.y}) scale(${view.scale},${-view.scale})`);
  for (const [node, place] of fixed) node.setAttribute("transform", `translate(${onPaper(place)})`);
  const length = roundLength(140 / view.scale), foot = map.clientHeight - 14;
  const bar = byId("scale");
  for (const [key, value] of Object.entries({ x1: 14, x2: 14 + length * view.scale, y1: foot, y2: foot })) {
    bar.setAttribute(key, value);
  }
  const text = byId("scale-text");
  text.setAttribute("x", 14);
  text.setAttribute("y", foot - 6);
  text.textContent = `${length} m`;
  show(now);
}

function fit() {
  const [west, south, east, north] = data.extent;
  const wide = Math.max(map.clientWidth, 100), high = Math.max(map.clientHeight, 100), rim = 34;
  view.scale = Math.min((wide - 2 * rim) / Math.max(east - west, 1), (high - 2 * rim) / Math.max(north - south, 1));
  view.x = wide / 2 - (view.scale * (east + west)) / 2;
  view.y = high / 2 + (view.scale * (north + south)) / 2;
  placeMap();
}

function zoom(factor, x, y) {
  const scale = Math.min(Math.max(view.scale * factor, 1e-3), 1e4);
  view.x = x + ((view.x - x) * scale) / view.scale;
  view.y = y + ((view.y - y) * scale) / view.scale;
  view.scale = scale;
  placeMap();
}

map.addEventListener("wheel", (event) => {
  event.preventDefault();
  const box = map.getBoundingClientRect();
  zoom(Math.exp(-0.0015 * event.deltaY), event.clientX - box.left, event.clientY - box.top);
}, { passive: false });
map.addEventListener("pointerdown", (event) => { map.setPointerCapture(event.pointerId); });
map.addEventListener("pointermove", (event) => {
  if (!(event.buttons & 1)) return;
  view.x += event.movementX;
  view.y += event.movementY;
  placeMap();
});
byId("fit").addEventListener("click", fit);
window.addEventListener("resize", fit);

// ---- charts ----
const paper = { wide: 600, high: 170, left: 44, right: 8, top: 20, foot: 22 };
const acrossTime = (time) => paper.left + ((paper.wide - paper.left - paper.right) * time) / Math.max(data.duration, 1e-9);
const cursors = [];

function drawChart(chart) {
  const svg = element(byId("charts"), "svg", { class: "chart", viewBox: `0 0 ${paper.wide} ${paper.high}`,
    preserveAspectRatio: "none", "data-column": chart.column });
  const inAir = data.vehicles.flatMap((vehicle) => vehicle[chart.column]);
  const most = 1.08 * Math.max(1e-9, ...chart.limits.map((limit) => limit.value), inAir.reduce((a, b) => Math.max(a, b), 0));
  const up = (value) => paper.high - paper.foot - ((paper.high - paper.foot - paper.top) * value) / most;
  element(svg, "text", { x: paper.left, y: 13 }, chart.title);
  const step = roundLength(most / 3);
  for (let value = 0; value <= most; value += step) {
    element(svg, "line", { class: "grid", x1: paper.left, x2: paper.wide - paper.right, y1: up(value), y2: up(value) });
    element(svg, "text", { x: paper.left - 5, y: up(value) + 4, "text-anchor": "end" }, +value.toPrecision(6));
  }
  const tick = roundLength(data.duration / 5 || 1);
  for (let time = 0; time <= data.duration; time += tick) {
    element(svg, "text", { x: acrossTime(time), y: paper.high - 6, "text-anchor": "middle" }, `${+time.toPrecision(6)} s`);
  }
  for (const limit of chart.limits) {
    element(svg, "line", { class: "limit", x1: paper.left, x2: paper.wide - paper.right, y1: up(limit.value), y2: up(limit.value) });
    element(svg, "text", { x: paper.wide - paper.right, y: up(limit.value) - 3, "text-anchor": "end" }, limit.name);
  }
  for (const vehicle of data.vehicles) {
    const points = vehicle[chart.column].map((value, k) =>
      `${acrossTime(Math.min(vehicle.start + k * data.step, vehicle.end)).toFixed(2)},${up(value).toFixed(2)}`);
    vehicle.lines.push(element(svg, "polyline", { points: points.join(" "), fill: "none", stroke: vehicle.colour,
      "stroke-width": 1.3 }));
  }
  cursors.push(element(svg, "line", { class: "cursor", y1: paper.top, y2: paper.high - paper.foot }));
  const pick = (event) => {
    const box = svg.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * paper.wide;
    seek(((x - paper.left) / (paper.wide - paper.left - paper.right)) * data.duration);
  };
  svg.addEventListener("pointerdown", pick);
  svg.addEventListener("pointermove", (event) => { if (event.buttons & 1) pick(event); });
}

// ---- time ----
let now = 0, playing = false, lastFrame = 0;

// Of the flights of a vehicle the last that has begun, or the first.
function isCurrent(vehicle) {
  const flights = data.vehicles.filter((other) => other.number === vehicle.number);
  return vehicle === (flights.filter((other) => other.start <= now).pop() || flights[0]);
}

function show(time) {
  now = Math.min(Math.max(time, 0), data.duration);
  byId("time").value = now;
  byId("clock").textContent = `${now.toFixed(1)} s`;
  for (const vehicle of data.vehicles) {
    const place = position(vehicle, now), next = position(vehicle, now + 0.2), before = position(vehicle, now - 0.2);
    const [x, y] = onPaper(place);
    vehicle.mark.setAttribute("display", isCurrent(vehicle) ? "inline" : "none");
    vehicle.mark.setAttribute("transform", `translate(${x.toFixed(2)},${y.toFixed(2)})`);
    vehicle.mark.setAttribute("data-east", place[0].toFixed(3));
    vehicle.mark.setAttribute("data-north", place[1].toFixed(3));
    const heading = (Math.atan2(next[0] - before[0], next[1] - before[1]) * 180) / Math.PI;
    vehicle.arrow.setAttribute("transform", `rotate(${heading.toFixed(1)})`);
    const flown = Math.ceil(Math.min(Math.max((now - vehicle.start) / data.step, 0), vehicle.points.length));
    vehicle.flown.setAttribute("points", vehicle.points.slice(0, flown).concat([place.join(",")]).join(" "));
    const inAir = vehicle.east.length && now >= vehicle.start && now <= vehicle.end;
    vehicle.state.textContent = inAir
      ? data.charts.map((chart) => `${at(vehicle, chart.column, now).toFixed(1)} ${chart.unit}`).join(", ")
      : "on its pad";
  }
  for (const cursor of cursors) {
    cursor.setAttribute("x1", acrossTime(now));
    cursor.setAttribute("x2", acrossTime(now));
  }
}

function play(on) {
  playing = on;
  byId("play").textContent = on ? "Pause" : "Play";
  if (on) requestAnimationFrame((frame) => { lastFrame = frame; requestAnimationFrame(advance); });
}

function advance(frame) {
  if (!playing) return;
  show(now + ((frame - lastFrame) / 1000) * Number(byId("pace").value));
  lastFrame = frame;
  if (now >= data.duration) play(false); else requestAnimationFrame(advance);
}

function seek(time) { play(false); show(time); }
byId("time").addEventListener("input", (event) => seek(Number(event.target.value)));
byId("play").addEventListener("click", () => { if (!playing && now >= data.duration) show(0); play(!playing); });

// ---- text ----
function fillTable(id, rows) {
  rows.forEach((cells, index) => {
    const row = byId(id).insertRow();
    for (const cell of cells) {
      const node = document.createElement(index ? "td" : "th");
      node.textContent = cell;
      row.appendChild(node);
    }
  });
}

function fillList(id, lines) {
  for (const line of lines.length ? lines : ["none"]) {
    byId(id).appendChild(document.createElement("li")).textContent = line;
  }
}

function fillLegend() {
  for (const vehicle of data.vehicles) {
    const label = byId("legend").appendChild(document.createElement("label"));
    const box = label.appendChild(document.createElement("input"));
    box.type = "checkbox";
    box.checked = true;
    const swatch = label.appendChild(document.createElement("span"));
    swatch.className = "swatch";
    swatch.style.background = vehicle.colour;
    label.appendChild(document.createElement("span")).textContent = `vehicle ${vehicle.name}`;
    vehicle.state = label.appendChild(document.createElement("span"));
    vehicle.state.className = "state";
    box.addEventListener("change", () => {
      for (const node of [vehicle.layer, vehicle.mark, ...vehicle.lines]) node.style.display = box.checked ? "" : "none";
    });
  }
}

for (const vehicle of data.vehicles) vehicle.lines = [];
byId("title").textContent = data.title;
byId("subtitle").textContent = data.subtitle;
byId("time").max = data.duration;
drawMap();
fillLegend();
data.charts.forEach(drawChart);
fillTable("vehicles", data.table);
fillTable("execution", data.execution);
fillList("certificate", data.certificate);
fillList("warnings", data.warnings);
// A link to a moment: report.html#t=12.5
const wanted = /^#t=([0-9.]+)$/.exec(location.hash);
if (wanted) now = Number(wanted[1]);
fit();
