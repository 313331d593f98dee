"use strict";
// Draws axes, curves, marks and the row of blocks on canvases. Nothing here depends on the state of
// the page.

const KINDS = ["partial", "global", "backward", "unsure"];
const NAMES = ["precursor", "global slip", "backward slip", "not predictable"];
const TILT_COLOURS = ["trailing", "uniform", "leading"];
// Parts of the picture of the row that a word of the text can highlight; the others fade.
const PARTS = ["blocks", "bars", "frames", "arrows", "drive", "line", "load", "stairs", "added",
  "released"];
const FADED = 0.16;
const NARROW = 500; // px, below which a figure has shorter words
const PALE = 0.6; // opacity of the areas that a slip added or released
const palette = {};

// Read the colours from the style sheet, which has a light and a dark scheme.
function readPalette() {
  const style = getComputedStyle(document.documentElement);
  const names = ["paper", "ink", "soft", "line", "grid", "band", "stuck", "strong"];
  for (const name of [...names, ...KINDS, ...TILT_COLOURS]) {
    palette[name] = style.getPropertyValue(`--${name}`).trim();
  }
}
// Colour of a number on a block.
const inkOn = (kind) => ({ stuck: palette.paper, partial: "#000000" })[kind] ?? "#ffffff";

// Clear a canvas and fit it to the pixels of the screen: [context, width, height].
function clear(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const ratio = window.devicePixelRatio || 1;
  const size = { width: Math.round(width * ratio), height: Math.round(height * ratio) };
  if (canvas.width !== size.width || canvas.height !== size.height) Object.assign(canvas, size);
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.lineWidth = context.globalAlpha = 1;
  context.fillStyle = palette.paper;
  context.fillRect(0, 0, width, height);
  context.textBaseline = "middle";
  context.setLineDash([]);
  return [context, width, height];
}

// Write a text; an underscore marks a subscript: F_X, μ_sapp.
function write(context, text, x, y, align = "left", weight = "") {
  const parts = String(text).split(/_(sapp|\w)/).map((part, i) => {
    const size = i % 2 ? 9 : 12, family = 'system-ui, "DejaVu Sans", sans-serif';
    const font = (context.font = `${weight} ${size}px ${family}`);
    return { part, font, lower: i % 2 ? 4 : 0, wide: context.measureText(part).width };
  });
  const width = parts.reduce((sum, { wide }) => sum + wide, 0);
  let left = x - width * { left: 0, center: 0.5, right: 1 }[align];
  for (const { part, font, lower, wide } of parts) {
    context.font = font;
    context.fillText(part, left, y + lower);
    left += wide;
  }
}

// Draw lines, each through its points [x, y].
function stroke(context, ...lines) {
  context.beginPath();
  for (const line of lines) {
    line.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  }
  context.stroke();
}

function area(context, points, colour) {
  context.fillStyle = colour;
  context.beginPath();
  points.forEach((point) => context.lineTo(...point));
  context.fill();
}

function dashed(context, points) {
  context.setLineDash([5, 4]);
  stroke(context, points);
  context.setLineDash([]);
}

// About `count` round numbers from low to high, and the number of their decimals.
function ticks(low, high, count) {
  const rough = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999);
  const values = [];
  for (let i = Math.ceil(low / step); i * step <= high * (1 + 1e-12); i++) values.push(i * step);
  return { values, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

// Draw axes with the ranges x and y [low, high]; `labels` are [of x or null, of y]. Returns functions
// x(value) and y(value), and the box.
function axes(context, width, height, x, y, labels, xTicks, yTicks) {
  const bottom = height - (labels[0] ? 36 : 8);
  const box = { left: 52, right: width - 14, top: 18, bottom };
  const toX = (value) => box.left + ((value - x[0]) / (x[1] - x[0])) * (box.right - box.left);
  const toY = (value) => bottom - ((value - y[0]) / (y[1] - y[0])) * (bottom - box.top);
  const named = ({ values, decimals, names }) =>
    values.map((value, i) => [value, names?.[i] ?? value.toFixed(decimals)]);
  const along = named(xTicks ?? ticks(...x, Math.min(8, width / 80)));
  const up = named(yTicks ?? ticks(...y, 4));
  context.strokeStyle = palette.grid;
  context.fillStyle = palette.soft;
  stroke(context, ...along.map(([value]) => [[toX(value), box.top], [toX(value), bottom]]));
  stroke(context, ...up.map(([value]) => [[box.left, toY(value)], [box.right, toY(value)]]));
  for (const [value, name] of up) write(context, name, box.left - 6, toY(value), "right");
  write(context, labels[1], 4, 8);
  if (labels[0]) {
    for (const [value, name] of along) write(context, name, toX(value), bottom + 11, "center");
    write(context, labels[0], (box.left + box.right) / 2, height - 7, "center");
  }
  return { x: toX, y: toY, box };
}

// The first index of a sorted array with a value not less than x.
function lowerBound(values, x) {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < x) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Draw a curve, without points that are less than half a pixel from the one before.
function curve(context, x, y, time, value, start, end) {
  const points = [], to = Math.min(lowerBound(time, end) + 1, time.length);
  for (let i = Math.max(lowerBound(time, start) - 1, 0); i < to; i++) {
    const point = [x(time[i]), y(value[i])], before = points.at(-1) ?? [Infinity, 0];
    if (Math.abs(point[0] - before[0]) + Math.abs(point[1] - before[1]) >= 0.5) points.push(point);
  }
  stroke(context, points);
}

// Draw a load over time within the box of a figure, in grey where it is not predictable.
function drawLoad(context, { x, y, box }, { time, load, known }, start, end, colour) {
  const until = Math.min(Math.max(known, start), end);
  context.save();
  context.beginPath();
  context.rect(box.left, box.top - 6, box.right - box.left, box.bottom - box.top + 7);
  context.clip();
  context.lineWidth = 1.5;
  for (const [name, from, to] of [[colour, start, until], ["unsure", until, end]]) {
    context.strokeStyle = palette[name];
    if (from < to) curve(context, x, y, time, load, from, to);
  }
  context.restore();
}

// Draw when each block slides, a line for each block. Bars of backward slips have half the height;
// slips that are not predictable are grey. Returns the kinds of slips drawn.
function slideBars(context, { x, box }, { n, events, arrays, known }, start, end) {
  const kinds = new Set(), pitch = (box.bottom - box.top) / n, gap = n > 25 ? 0.5 : 1.5;
  for (const { first, last, onset, end: stop, isGlobal } of events) {
    if (stop < start || onset > end) continue;
    const since = {}; // the transition with which each block began to slide
    const fill = (block, time) => {
      const isBackward = arrays.mode[since[block]] < 0;
      const kind = KINDS[onset >= known ? 3 : isBackward ? 2 : Number(isGlobal)];
      const left = Math.max(x(arrays.time[since[block]]), box.left);
      const wide = Math.max(Math.min(x(time), box.right) - left, 2), top = isBackward ? 0.5 : 0;
      kinds.add(kind);
      context.fillStyle = palette[kind];
      const y = box.top + (n - block + top) * pitch + gap / 2;
      context.fillRect(left, y, wide, (1 - top) * pitch - gap);
      delete since[block];
    };
    for (let j = first + 1; j <= last; j++) {
      const block = arrays.block[j];
      if (block in since) fill(block, arrays.time[j]);
      if (arrays.mode[j]) since[block] = j;
    }
    for (const block in since) fill(block, stop);
  }
  return kinds;
}

// Draw a mark at a point in pixels: dot, ring or cross.
function mark(context, shape, x, y, size, colour) {
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = 2;
  if (shape === "cross") {
    const arm = (way) => [[x - size, y - way * size], [x + size, y + way * size]];
    return stroke(context, arm(1), arm(-1));
  }
  context.beginPath();
  context.arc(x, y, size, 0, 2 * Math.PI);
  if (shape === "dot") context.fill();
  else context.stroke();
}

function spring(context, from, to, y, turns) {
  const lead = Math.min(4, (to - from) / 4), step = (to - from - 2 * lead) / (2 * turns);
  const turn = (_, i) => [from + lead + (i + 0.5) * step, y + (i % 2 ? 5 : -5)];
  const coils = Array.from({ length: 2 * turns }, turn);
  stroke(context, [[from, y], ...coils, [to - lead, y], [to, y]]);
}

// Draw an arrow that points down.
function arrow(context, x, from, to) {
  const head = Math.max(to - 5, from);
  stroke(context, [[x, from], [x, to]], [[x - 3.5, head], [x, to], [x + 3.5, head]]);
}

// Draw the row as in Fig. 9; below each block the net force of its springs between the limits of static
// friction; and below these, if the frame `hasPush`, the push along the row. `shifts` [m] are
// displacements relative to the camera, drawn `magnified` times as large; `pushed` is how far the
// drive's spring is compressed, from 0 to 1; `lit` is the part that is highlighted.
function drawRow(canvas, frame) {
  const { weights, strength, forces, modes, shifts, magnified, pushed, ground, lit } = frame;
  const [context, width, height] = clear(canvas), n = weights.length;
  const left = Math.max(70, 0.13 * width), pitch = (width - left - Math.max(24, 0.1 * width)) / n;
  const scale = (magnified * pitch * n) / frame.length, size = Math.min(0.58 * pitch, 42);
  const floor = Math.round(0.28 * height), y = floor - size / 2;
  const [middle, half] = (frame.hasPush ? [0.42, 0.07] : [0.61, 0.24]).map((at) => at * height);
  const pushTop = 0.57 * height;
  const centres = shifts.map((shift, i) => left + (i + 0.5) * pitch + shift * scale);
  const isNarrow = width < NARROW;
  const show = (name, i) => {
    const isOut = lit === name && (name !== "blocks" || i === frame.front - 1);
    context.globalAlpha = isOut || !PARTS.includes(lit) ? 1 : FADED;
  };
  const caption = (text, at) => {
    context.fillStyle = palette.soft;
    write(context, text, 4, at);
  };

  context.strokeStyle = palette.line;
  show("ground");
  stroke(context, [[0, floor + 1.5], [width, floor + 1.5]]);
  const dash = Math.max(0.02e-3 * scale, 4);
  for (let x = dash - ((((ground * scale) % dash) + dash) % dash); x < width; x += dash) {
    stroke(context, [[x, floor + 2], [x - 6, floor + 8]]);
  }
  context.strokeStyle = palette.soft;
  context.lineWidth = 1.5;
  for (let i = 1; i < n; i++) {
    spring(context, centres[i - 1] + size / 2, centres[i] - size / 2, y, pitch > 30 ? 3 : 1);
  }
  show("drive");
  const side = centres[0] - size / 2, plate = side - 0.8 * left * (1 - 0.65 * pushed);
  spring(context, plate, side, y, 5);
  caption("drive", Math.max(floor - 1.5 * size - 12, 22));
  context.fillStyle = context.strokeStyle = palette.ink;
  context.fillRect(plate - 5, floor - 1.5 * size - 2, 5, 1.5 * size + 2);
  write(context, "→", plate - 8, y, "right");

  const heaviest = Math.max(...weights), strongest = Math.max(...strength) || 1;
  const tallest = Math.min(floor - size - 16, 1.2 * size + 16), wide = Math.min(0.5 * pitch, 26);
  for (const [i, x] of centres.entries()) {
    const way = modes[i], lean = 0.22 * size * way, top = floor - size;
    const kind = !way ? "stuck" : way < 0 ? "backward" : frame.kind, colour = palette[kind];
    show("arrows");
    context.strokeStyle = palette.soft;
    if (weights[i] > 0) arrow(context, x, top - 6 - (tallest * weights[i]) / heaviest, top - 3);
    show("blocks", i);
    const base = [[x - size / 2, floor], [x + size / 2, floor]];
    area(context, [...base, [x + size / 2 + lean, top], [x - size / 2 + lean, top]], colour);
    context.fillStyle = inkOn(kind);
    if (size >= 18) write(context, i + 1, x + lean / 2, y, "center");

    const limit = (half * strength[i]) / strongest;
    const share = (half * (forces[i] - forces[i + 1])) / strongest;
    show("bars");
    context.fillStyle = colour;
    context.fillRect(x - wide / 2, Math.min(middle, middle - share), wide, Math.abs(share));
    context.strokeStyle = palette.ink;
    stroke(context, [[x - wide / 2 - 2, middle], [x + wide / 2 + 2, middle]]);
    show("frames");
    context.strokeStyle = palette[lit === "frames" ? "ink" : "line"];
    context.strokeRect(x - wide / 2, middle - limit, wide, 2 * limit);
  }
  show("arrows");
  caption("normal load", 8);
  show("bars");
  caption("net force", middle - 8);
  show("frames");
  caption("and limit", middle + 8);
  if (frame.hasPush) {
    // Edges of the parts of the slider that the blocks represent.
    const inner = centres.slice(1).map((x, i) => (centres[i] + x) / 2);
    const edges = [centres[0] - pitch / 2, ...inner, centres.at(-1) + pitch / 2];
    drawPush(context, frame, edges, centres, pushTop, height - 22, show);
    show("line");
    context.fillStyle = palette.ink;
    const friction = isNarrow ? "F_X − μ_k W" : "F_X minus kinetic friction";
    write(context, `dashed: ${friction}`, width - 4, pushTop - 8, "right");
    show("stairs");
    caption(isNarrow ? "push in springs" : "push in each spring: thin before the slip, thick now",
      pushTop - 8);
  }
  show("ground");
  caption(`Movement is drawn ${magnified} times as large.`, height - 7);
  const ends = isNarrow ? "trailing → leading" : "trailing edge, pushed → leading edge";
  write(context, ends, width - 4, height - 7, "right");
}

// Draw the push in each spring before a slip and now, and the areas that the slip added and released.
// The dashed line is the load that remains after kinetic friction: F_X at the onset minus mu_k times
// the normal load from the trailing edge.
function drawPush(context, frame, edges, centres, top, bottom, show) {
  const { weights, forces, before, friction, highest } = frame, load = before[0];
  const y = (force) => bottom - ((bottom - top) * force) / highest;
  const springs = [edges[0], ...centres, edges.at(-1)], line = [[edges[0], y(load)]];
  const step = (force, i) => [[springs[i], y(force)], [springs[i + 1], y(force)]];
  const stairs = (values) => Array.from(values, step).flat();
  const fills = { added: frame.added, released: "unsure" };
  for (const [part, sign] of [["added", 1], ["released", -1]]) {
    const far = forces.map((force, i) => (sign * (force - before[i]) > 0 ? force : before[i]));
    show(part);
    context.globalAlpha *= PALE;
    area(context, [...stairs(far), ...stairs(before).reverse()], palette[fills[part]]);
    context.globalAlpha /= PALE;
  }
  show("stairs");
  context.strokeStyle = palette.ink;
  for (const [values, width] of [[before, 0.8], [forces, 2]]) {
    context.lineWidth = width;
    stroke(context, [[edges[0], bottom], ...stairs(values)]);
  }
  for (let i = 0, left = load; i < weights.length && left > 0; i++) {
    const share = Math.min(left / (friction * weights[i]), 1);
    left = share < 1 ? 0 : left - friction * weights[i];
    line.push([edges[i] + share * (edges[i + 1] - edges[i]), y(left)]);
  }
  show("line");
  context.lineWidth = 1.5;
  dashed(context, line);
  show("load");
  context.fillStyle = palette.ink;
  write(context, "F_X", edges[0] - 6, y(load), "right");
}
