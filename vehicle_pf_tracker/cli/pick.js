// The page of `pick`: vehicles, counting lines, zones, regions and points of the road, drawn and edited over any frame.
"use strict";

// The model. An item has a kind, a name and points in px: two corners of a box, two ends of a line, the corners of
// a polygon, or one point. A vehicle's box belongs to a frame; the rest holds for all.
const tenths = value => Math.round(value * 10) / 10;
const copy = points => points.map(one => [...one]);
const corners_of = ({points}) => points.map(corner => corner.map(tenths));
const KINDS = {
  targets: {
    title: "vehicle", closed: true, least: 2, most: 2,
    advice: "Drag a box around each vehicle: tight, wheels and roof included, its shadow not. Any frame will do;"
      + " the same name in a later frame corrects its box from there on.",
    section: items => items.map(({name, frame, points}) => ({name, frame, box: box(points)})),
    items: (section = []) => section.map(({name = "", frame = 1, box: [x, y, width, height]}) =>
      ({name: String(name), frame, points: [[x, y], [x + width, y + height]]})),
  },
  lines: {
    title: "line", closed: false, least: 2, most: 2,
    advice: "Drag a line across the road, at wheel height. The arrow is the first of the two directions.",
    ...by_name(
      ({points: [from, to], directions}) => ({from: from.map(tenths), to: to.map(tenths), directions}),
      ({from, to, directions = ["in", "out"]}) => ({points: copy([from, to]), directions: [...directions]})),
  },
  zones: {
    title: "zone", closed: true, least: 3,
    advice: "Click the corners of an area to count in; close it on its first corner.",
    ...by_name(corners_of, corners => ({points: copy(corners)})),
  },
  roi: {
    title: "region", closed: true, least: 3,
    advice: "Click the corners of an area in which vehicles are looked for, or in which they are not (outside);"
      + " close it on its first corner.",
    ...by_name(
      item => ({[item.side]: corners_of(item)}),
      body => ({side: Object.keys(body)[0], points: copy(Object.values(body)[0])})),
  },
  pairs: {
    title: "road point", closed: false, least: 1, most: 1,
    advice: "Click points of the road whose position you know, four or more, and type their x and y in metres."
      + " Spread them over the road; no three of four on a line.",
    section: items => items.map(({name, points: [pixel], road}) => ({name, pixel: pixel.map(tenths), road})),
    items: (section = []) => section.map(({name, pixel, road}, index) =>
      ({name: String(name ?? index + 1), points: copy([pixel]), road: [...road]})),
  },
};

function by_name(entry, item) {
  return {
    section: items => Object.fromEntries(items.map(one => [one.name, entry(one)])),
    items: (section = {}) => Object.entries(section).map(([name, body]) => ({name, ...item(body)})),
  };
}
function box([[x, y], [to_x, to_y]]) {
  return [Math.min(x, to_x), Math.min(y, to_y), Math.abs(x - to_x), Math.abs(y - to_y)].map(tenths);
}
function items_of(content) {
  return Object.entries(KINDS).flatMap(([kind, {items}]) => items(content[kind] ?? undefined).map(one => ({kind, ...one})));
}
function content_of(items) {
  const sections = Object.entries(KINDS).map(([kind, {section}]) => [kind, items.filter(one => one.kind === kind), section]);
  return Object.fromEntries(sections.filter(([, own]) => own.length).map(([kind, own, section]) => [kind, section(own)]));
}
// Why the items cannot be written yet; empty if they can. The server checks the rest.
function problem(items) {
  const seen = new Set(), pairs = items.filter(one => one.kind === "pairs");
  for (const {kind, name, frame} of items) {
    const key = JSON.stringify([kind, name, frame]);
    if (!name.trim() && kind !== "targets") return `A ${KINDS[kind].title} has no name.`;
    if (name && kind !== "pairs" && seen.has(key)) return `Two are named ${name}.`;
    seen.add(key);
  }
  if (pairs.length && pairs.length < 4) return "The road needs four points or more.";
  if (!pairs.every(one => one.road.every(Number.isFinite))) return "A point of the road has no x or y.";
  return "";
}
function new_item(kind, points, frame, items) {
  const prefix = kind === "targets" || kind === "pairs" ? "" : `${KINDS[kind].title} `;
  let number = 1;
  while (items.some(one => one.kind === kind && one.name === prefix + number)) number += 1;
  const more = {targets: {frame}, lines: {directions: ["in", "out"]}, roi: {side: "inside"}, pairs: {road: [NaN, NaN]}}[kind];
  return {kind, name: prefix + number, points, ...more};
}
// The handles of an item: where each is, and the index of the point that it moves in x and in y.
function handles({kind, points}) {
  const indices = kind === "targets" ? [[0, 0], [1, 0], [1, 1], [0, 1]] : points.map((_, index) => [index, index]);
  return indices.map(([ix, iy]) => ({at: [points[ix][0], points[iy][1]], ix, iy}));
}
function edges(item) {
  const corners = handles(item).map(one => one.at), count = corners.length - (KINDS[item.kind].closed ? 0 : 1);
  return corners.slice(0, count).map((corner, index) => [corner, corners[(index + 1) % corners.length]]);
}
const distance = ([x, y], [to_x, to_y]) => Math.hypot(to_x - x, to_y - y);
function distance_to_edge(place, [a, b]) {
  const along = [b[0] - a[0], b[1] - a[1]], square = along[0] ** 2 + along[1] ** 2;
  const share = square ? ((place[0] - a[0]) * along[0] + (place[1] - a[1]) * along[1]) / square : 0;
  const near = Math.min(Math.max(share, 0), 1);
  return distance(place, [a[0] + near * along[0], a[1] + near * along[1]]);
}
// The item at a place, by a handle or else by an edge, the newest first; null if there is none within `reach`.
function grab(items, place, reach) {
  const newest = [...items].reverse();
  for (const item of newest)
    for (const handle of handles(item)) if (distance(place, handle.at) <= reach) return {item, handle};
  const item = newest.find(one => edges(one).some(edge => distance_to_edge(place, edge) <= reach));
  return item ? {item, handle: null} : null;
}
// Move a whole item, or one of its handles, from where its points were.
function move({item, handle}, points, [dx, dy]) {
  item.points = points.map(([x, y], index) => [
    x + (handle && handle.ix !== index ? 0 : dx), y + (handle && handle.iy !== index ? 0 : dy)]);
}
if (typeof module !== "undefined") module.exports = {items_of, content_of, problem, new_item, grab, move, box};

// The page. A press takes an item there is and otherwise begins a new one.
function page() {
  const at = id => document.getElementById(id);
  const image = at("image"), svg = at("drawing"), slider = at("frame"), loupe = at("loupe");
  const ZOOM = 8; // in the loupe, times the size of the image's pixels
  const REACH = 8; // px of the screen around a handle or an edge
  let items = [], kind = "", shown = 0; // number of the frame that is seen; 0 while the next one is loaded
  let selected = null, taken = null, draft = null; // an item; what is being moved; the points of a new one

  const scale = () => image.naturalWidth / svg.getBoundingClientRect().width;
  const here = () => items.filter(one => one.frame === undefined || one.frame === shown);
  function show(number) {
    slider.value = number;
    at("number").value = slider.value;
    shown = svg.dataset.frame = 0;
    image.src = "frame/" + slider.value;
  }
  function point(event) {
    const area = svg.getBoundingClientRect();
    return [(event.clientX - area.left) * scale(), (event.clientY - area.top) * scale()].map((value, axis) =>
      Math.min(Math.max(value, 0), axis ? image.naturalHeight : image.naturalWidth));
  }
  function made(name, attributes, text = "") {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    return element;
  }
  function shapes(item) {
    const unit = scale(), is_selected = item === selected, corners = handles(item).map(one => one.at);
    const look = [item.kind, is_selected ? "selected" : "", here().includes(item) ? "" : "other"].join(" ");
    const [x, y] = corners[0], arm = 10 * unit;
    const path = corners.length === 1 ? `M${x - arm} ${y}h${2 * arm}M${x} ${y - arm}v${2 * arm}`
      : `M${corners.join("L")}${KINDS[item.kind].closed ? "Z" : arrow(item.points, arm)}`;
    const found = [made("path", {d: path, class: look})];
    if (item.name) found.push(made("text", {x: x + 4 * unit, y: y - 4 * unit, "font-size": 15 * unit}, item.name));
    if (is_selected) found.push(...corners.map(([cx, cy]) => made("circle", {cx, cy, r: 5 * unit})));
    return found;
  }
  // From the middle of a line to its right-hand side: the first of its directions.
  function arrow([[x, y], [to_x, to_y]], arm) {
    const length = Math.hypot(to_x - x, to_y - y) || 1, across = [(y - to_y) / length, (to_x - x) / length];
    const tip = [(x + to_x) / 2 + 2 * arm * across[0], (y + to_y) / 2 + 2 * arm * across[1]];
    const wings = [1, -1].map(side => [
      tip[0] - 0.6 * arm * (across[0] + side * across[1]), tip[1] - 0.6 * arm * (across[1] - side * across[0])]);
    return `M${(x + to_x) / 2} ${(y + to_y) / 2}L${tip}M${wings[0]}L${tip}L${wings[1]}`;
  }
  function draw() {
    svg.setAttribute("viewBox", `0 0 ${image.naturalWidth} ${image.naturalHeight}`);
    svg.replaceChildren(...items.flatMap(shapes));
    if (draft) svg.append(made("path", {d: outline(draft.points), class: kind}));
  }
  function check() {
    at("said").textContent = problem(items);
    at("done").disabled = !items.length || Boolean(problem(items));
  }
  function outline(points) {
    const [x, y, width, height] = box([points[0], points.at(-1)]);
    return kind === "targets" ? `M${x} ${y}h${width}v${height}h${-width}Z` : `M${points.join("L")}`;
  }
  function field(label, value, take) {
    const made = document.createElement("input");
    made.placeholder = made.ariaLabel = label;
    made.value = value;
    made.oninput = () => { take(made.value); check(); draw(); };
    return made;
  }
  function fields(item) {
    const rename = text => { item.name = item.kind === "targets" ? text.replace(/[^A-Za-z0-9_-]/g, "") : text; };
    const found = [field("name", item.name, rename)];
    if (item.side) {
      const sides = document.createElement("select");
      sides.append(...["inside", "outside"].map(side => new Option(side)));
      sides.value = item.side;
      sides.onchange = () => { item.side = sides.value; };
      found.push(sides);
    }
    for (const side of [0, 1]) {
      if (item.directions) found.push(field(side ? "back" : "along the arrow", item.directions[side],
        text => { item.directions[side] = text; }));
      if (item.road) found.push(field(`${"xy"[side]}, m`, Number.isFinite(item.road[side]) ? item.road[side] : "",
        text => { item.road[side] = text.trim() ? Number(text.replace(",", ".")) : NaN; }));
    }
    return found;
  }
  function list() {
    at("list").replaceChildren(...items.map(item => {
      const row = document.createElement("li"), remove = document.createElement("button");
      row.className = item === selected ? "selected" : "";
      row.onclick = () => select(item);
      row.addEventListener("focusin", row.onclick);
      remove.textContent = "delete";
      remove.onclick = event => { event.stopPropagation(); drop(item); };
      const place = item.kind === "targets" ? `frame ${item.frame}: ${box(item.points)}`
        : item.points.map(one => one.map(tenths)).join(" – ");
      row.append(`${KINDS[item.kind].title} `, ...fields(item), ` ${place} px `, remove);
      return row;
    }));
    check();
    draw();
  }
  function select(item) {
    if (item === selected) return;
    selected = item;
    items.forEach((one, index) => { at("list").children[index].className = one === selected ? "selected" : ""; });
    if (item && !here().includes(item)) show(item.frame); else draw();
  }
  function drop(item) {
    items = items.filter(one => one !== item);
    selected = null;
    list();
  }
  function choose(name) {
    [kind, draft] = [name, null];
    at("advice").textContent = KINDS[kind].advice;
    for (const one of at("kinds").children) one.ariaPressed = one.value === kind;
    draw();
  }
  function finish() {
    const {points} = draft, [first, last] = [points[0], points.at(-1)], {least, most} = KINDS[kind];
    const is_large = most !== 2 || (kind === "targets" ? Math.min(...box(points).slice(2)) >= 2 : distance(first, last) >= 2);
    draft = null;
    if (points.length >= least && is_large) {
      selected = new_item(kind, points, shown, items);
      items.push(selected);
    }
    list();
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
  async function send(content) {
    at("done").disabled = at("cancel").disabled = true;
    let words = "The command has ended already; start it again.", is_over = true;
    try {
      const answer = await fetch("done", {method: "POST", body: JSON.stringify(content)});
      is_over = answer.ok;
      words = is_over ? "Finished; this page can be closed." : await answer.text();
    } catch { /* nobody answers */ }
    at("said").textContent = words;
    at("done").disabled = at("cancel").disabled = is_over;
  }
  svg.onpointerdown = event => {
    if (!shown || event.button !== 0) return;
    svg.setPointerCapture(event.pointerId);
    const place = point(event), reach = REACH * scale();
    if (draft) { // a polygon
      draft.points.pop(); // where the pointer was
      if (draft.points.length > 2 && distance(place, draft.points[0]) <= reach) finish();
      else draft.points.push(place, place);
      return;
    }
    taken = grab(here(), place, reach);
    if (taken) Object.assign(taken, {from: place, points: taken.item.points});
    else draft = {points: KINDS[kind].most === 1 ? [place] : [place, place]};
    select(taken && taken.item);
    if (KINDS[kind].most === 1 && draft) finish();
  };
  svg.onpointermove = event => {
    if (!shown) return;
    const place = point(event);
    if (taken) move(taken, taken.points, place.map((value, axis) => value - taken.from[axis]));
    else if (draft) draft.points[draft.points.length - 1] = place;
    draw();
    magnify(event);
  };
  svg.onpointerup = event => {
    if (!shown || event.button !== 0) return;
    if (draft && KINDS[kind].most === 2) finish();
    if (taken) list();
    taken = null;
  };
  svg.onpointercancel = () => { taken = draft = null; draw(); };
  svg.onpointerleave = () => { loupe.style.display = "none"; };
  document.onkeydown = event => {
    if (event.target.tagName === "INPUT" && event.target !== slider) return;
    if (event.key === "Escape") { draft = null; draw(); }
    if (selected && (event.key === "Delete" || event.key === "Backspace")) drop(selected);
  };
  slider.oninput = () => show(slider.value);
  at("back").onclick = () => show(Math.max(Number(slider.value) - 1, 1));
  at("on").onclick = () => show(Math.min(Number(slider.value) + 1, Number(slider.max)));
  at("done").onclick = () => send(content_of(items));
  at("cancel").onclick = () => send(null);
  image.onload = () => { shown = svg.dataset.frame = Number(slider.value); taken = draft = null; check(); draw(); };
  image.onerror = () => { at("said").textContent = "This frame cannot be read."; };
  fetch("info").then(answer => answer.json()).then(info => {
    items = items_of(info.document);
    for (const name of info.sections) {
      const button = document.createElement("button");
      button.value = name;
      button.textContent = KINDS[name].title;
      button.onclick = () => choose(name);
      at("kinds").append(button);
    }
    slider.max = info.frames;
    choose(info.sections[0]);
    list();
    show(info.frame);
  });
}
if (typeof document !== "undefined") page();
