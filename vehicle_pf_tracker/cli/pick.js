// The page of `pick`: boxes to drag or points to click, over any frame of the source.
"use strict";
const at = id => document.getElementById(id);
const image = at("image"), svg = at("drawing"), slider = at("frame"), loupe = at("loupe");
const ZOOM = 8; // in the loupe, times the size of the image's pixels
const tenths = value => Math.round(value * 10) / 10;
const picked = [];
let tool = null; // `boxes` or `points`
let shown = 0; // number of the frame that is seen; 0 while the next one is loaded
let start = null, drawn = null;

const boxes = {
  title: "Pick targets",
  advice: "Drag a box around each vehicle: tight, wheels and roof included, its shadow not. Any frame will do;"
    + " the same name in a later frame corrects its box from there on.",
  press(place) { start = place; },
  move(place) { if (start) drawn = box(start, place); },
  release(place) {
    if (!start) return;
    const made = box(start, place);
    start = drawn = null;
    if (made[2] >= 2 && made[3] >= 2) picked.push({name: free_name(), frame: shown, box: made});
  },
  shapes: () => [
    ...picked.map(one => rectangle(one.box, one.frame === shown ? "" : "other")),
    ...(drawn ? [rectangle(drawn, "")] : []),
  ],
  words: one => ` frame ${one.frame}: ${one.box.join(", ")} px `,
  fields: one => [field("name", one.name, text => { one.name = text.replace(/[^A-Za-z0-9_-]/g, ""); })],
  complete: () => picked.length > 0,
};

const points = {
  title: "Pick points of the road",
  advice: "Click points of the road whose place you know, four or more, and type their x and y in metres."
    + " Spread them over the road; no three of four on a line.",
  press() {},
  move() {},
  release(place) { picked.push({pixel: place.map(tenths), road: [NaN, NaN]}); },
  shapes: () => picked.flatMap((one, index) => cross(one.pixel, index + 1)),
  words: one => ` pixel ${one.pixel.join(", ")} `,
  fields: one => ["x, m", "y, m"].map((name, axis) => field(
    name, Number.isFinite(one.road[axis]) ? one.road[axis] : "",
    text => { one.road[axis] = text.trim() ? Number(text.replace(",", ".")) : NaN; })),
  complete: () => picked.length > 3 && picked.every(one => one.road.every(Number.isFinite)),
};

function show(number) {
  slider.value = number;
  at("number").value = slider.value;
  shown = 0;
  image.src = "frame/" + slider.value;
}
function point(event) {
  const area = svg.getBoundingClientRect();
  const x = (event.clientX - area.left) / area.width * image.naturalWidth;
  const y = (event.clientY - area.top) / area.height * image.naturalHeight;
  return [Math.min(Math.max(x, 0), image.naturalWidth), Math.min(Math.max(y, 0), image.naturalHeight)];
}
function box(a, b) {
  return [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1])].map(tenths);
}
function free_name() {
  let number = 1;
  while (picked.some(one => one.name === String(number))) number += 1;
  return String(number);
}
function shape(kind, attributes, text = "") {
  const made = document.createElementNS("http://www.w3.org/2000/svg", kind);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = text;
  return made;
}
function rectangle([x, y, width, height], kind) {
  return shape("rect", {x, y, width, height, class: kind});
}
function cross([x, y], number) {
  const arm = image.naturalWidth / 80;
  const path = `M${x - arm} ${y}H${x + arm}M${x} ${y - arm}V${y + arm}`;
  return [shape("path", {d: path}), shape("text", {x: x + arm / 3, y: y - arm / 3, "font-size": 1.5 * arm}, number)];
}
function field(name, value, take) {
  const made = document.createElement("input");
  made.placeholder = made.ariaLabel = name;
  made.value = value;
  made.oninput = () => { take(made.value); at("done").disabled = !tool.complete(); };
  return made;
}
function draw() {
  svg.setAttribute("viewBox", `0 0 ${image.naturalWidth} ${image.naturalHeight}`);
  svg.replaceChildren(...tool.shapes());
  at("done").disabled = !tool.complete();
}
function list() {
  at("list").replaceChildren(...picked.map((one, index) => {
    const item = document.createElement("li"), remove = document.createElement("button");
    remove.textContent = "remove";
    remove.onclick = () => { picked.splice(index, 1); list(); };
    item.append(...tool.fields(one), tool.words(one), remove);
    return item;
  }));
  draw();
}
function magnify(event) {
  const [x, y] = point(event), size = loupe.width / ZOOM, context = loupe.getContext("2d");
  context.imageSmoothingEnabled = false;
  context.fillRect(0, 0, loupe.width, loupe.height);
  context.drawImage(image, x - size / 2, y - size / 2, size, size, 0, 0, loupe.width, loupe.height);
  context.strokeStyle = "#40dc40";
  context.strokeRect(loupe.width / 2, -1, 0, loupe.height + 2);
  context.strokeRect(-1, loupe.height / 2, loupe.width + 2, 0);
  const area = svg.getBoundingClientRect(), across = event.clientX - area.left, down = event.clientY - area.top;
  loupe.style.left = (across + 190 < area.width ? across + 24 : across - 190) + "px";
  loupe.style.top = (down + 190 < area.height ? down + 24 : down - 190) + "px";
  loupe.style.display = "block";
}
async function send(answer) {
  at("done").disabled = at("cancel").disabled = true;
  let accepted = false;
  try {
    accepted = (await fetch("done", {method: "POST", body: JSON.stringify(answer)})).ok;
  } catch {
    at("said").textContent = "The command has ended already; start it again.";
    return;
  }
  at("said").textContent = accepted ? "Finished; this page can be closed." : "This was not accepted.";
  at("done").disabled = at("cancel").disabled = accepted;
}
svg.onpointerdown = event => {
  if (!shown || event.button !== 0) return;
  svg.setPointerCapture(event.pointerId);
  tool.press(point(event));
};
svg.onpointermove = event => { if (shown) { tool.move(point(event)); draw(); magnify(event); } };
svg.onpointerup = event => { if (shown && event.button === 0) { tool.release(point(event)); list(); } };
svg.onpointercancel = () => { start = drawn = null; draw(); };
svg.onpointerleave = () => { loupe.style.display = "none"; };
slider.oninput = () => show(slider.value);
at("back").onclick = () => show(Math.max(Number(slider.value) - 1, 1));
at("on").onclick = () => show(Math.min(Number(slider.value) + 1, Number(slider.max)));
at("done").onclick = () => send(picked);
at("cancel").onclick = () => send(null);
image.onload = () => { shown = Number(slider.value); start = drawn = null; at("said").textContent = ""; draw(); };
image.onerror = () => { at("said").textContent = "This frame cannot be read."; };
fetch("info").then(answer => answer.json()).then(info => {
  tool = info.tool === "points" ? points : boxes;
  document.title = at("title").textContent = tool.title;
  at("advice").textContent = tool.advice;
  slider.max = info.frames;
  show(info.frame);
});
