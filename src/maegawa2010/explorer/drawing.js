"use strict";
// Draws on canvases: axes, curves and marks of the figures, and the row of blocks. Nothing here knows the page's state.

const FONT = "12px system-ui, 'DejaVu Sans', sans-serif";
const KINDS = ["partial", "global", "backward", "unsure"];
const NAMES = ["partial slip", "global slip", "backward slip", "not predictable"];
const TILT_COLOURS = ["pushed", "even", "far"];
let palette = {};

// Colours come from the style sheet, which knows light and dark.
function readPalette() {
  const style = getComputedStyle(document.documentElement);
  const names = ["paper", "ink", "soft", "line", "grid", "band", "raised", "stuck", "on", "strong", ...KINDS, ...TILT_COLOURS];
  palette = Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

const channels = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
// Black or white, whichever is seen better on a colour.
function inkOn(colour) {
  const [r, g, b] = channels(colour).map((value) => (value / 255) ** 2.2);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18 ? "#000000" : "#ffffff";
}

// Clear a canvas, which has as many pixels as the screen gives it: [context, width, height].
function clear(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas, ratio = window.devicePixelRatio || 1;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.fillStyle = palette.paper;
  context.fillRect(0, 0, width, height);
  context.font = FONT;
  context.textBaseline = "middle";
  context.lineWidth = 1;
  context.setLineDash([]);
  return [context, width, height];
}

// Draw lines, each through its points [x, y].
function stroke(context, ...lines) {
  context.beginPath();
  for (const points of lines) points.forEach((point, i) => (i ? context.lineTo(...point) : context.moveTo(...point)));
  context.stroke();
}

function area(context, points, colour) {
  context.fillStyle = colour;
  context.beginPath();
  points.forEach((point) => context.lineTo(...point));
  context.fill();
}

// About `count` round numbers from low to high, and their decimals.
function ticks(low, high, count) {
  const rough = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999);
  const values = [];
  for (let i = Math.ceil(low / step); i * step <= high * (1 + 1e-12); i++) values.push(i * step);
  return { values, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

// Axes of a figure with ranges x and y [low, high]; `labels` are [of x or null, of y]. Returns x(value), y(value) and the box.
function axes(context, width, height, x, y, labels, xTicks, yTicks) {
  const box = { left: 52, right: width - 14, top: 18, bottom: height - (labels[0] ? 36 : 8) };
  const toX = (value) => box.left + ((value - x[0]) / (x[1] - x[0])) * (box.right - box.left);
  const toY = (value) => box.bottom - ((value - y[0]) / (y[1] - y[0])) * (box.bottom - box.top);
  xTicks ??= ticks(...x, Math.min(8, width / 80));
  yTicks ??= ticks(...y, 4);
  context.strokeStyle = palette.grid;
  context.fillStyle = palette.soft;
  stroke(context, ...xTicks.values.map((value) => [[toX(value), box.top], [toX(value), box.bottom]]));
  stroke(context, ...yTicks.values.map((value) => [[box.left, toY(value)], [box.right, toY(value)]]));
  context.textAlign = "right";
  for (const value of yTicks.values) context.fillText(value.toFixed(yTicks.decimals), box.left - 6, toY(value));
  context.textAlign = "left";
  context.fillText(labels[1], 4, 8);
  context.textAlign = "center";
  if (labels[0]) {
    xTicks.values.forEach((value, i) => context.fillText(xTicks.names?.[i] ?? value.toFixed(xTicks.decimals), toX(value), box.bottom + 11));
    context.fillText(labels[0], (box.left + box.right) / 2, height - 7);
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

// A curve inside the box, without points that cannot be told from the one before.
function curve(context, { x, y, box }, time, value, start, end) {
  const points = [];
  for (let i = Math.max(lowerBound(time, start) - 1, 0), to = lowerBound(time, end); i <= to && i < time.length; i++) {
    const [across, up] = [x(time[i]), y(value[i])], [lastAcross, lastUp] = points.at(-1) ?? [];
    if (!(Math.abs(across - lastAcross) + Math.abs(up - lastUp) < 0.5)) points.push([across, up]);
  }
  context.save();
  context.beginPath();
  context.rect(box.left, box.top - 6, box.right - box.left, box.bottom - box.top + 7);
  context.clip();
  stroke(context, points);
  context.restore();
}

// Slides of the blocks as a picture with two pixels for each block and column, which is as fast for any number of slides.
// A backward slip has the lower one alone. Slips that are not predictable are grey. Returns the kinds that are there.
function slideBars(context, { box }, { n, events, arrays, known }, start, end) {
  const columns = Math.max(Math.round(box.right - box.left), 1), scale = columns / (end - start);
  const picture = new ImageData(columns, 2 * n), pixels = new Uint32Array(picture.data.buffer), kinds = new Set();
  const colours = KINDS.map((kind) => {
    const [r, g, b] = channels(palette[kind]);
    return (255 << 24) | (b << 16) | (g << 8) | r;
  });
  for (const { first, last, onset, end: stop, isGlobal } of events) {
    if (stop < start || onset > end) continue;
    const since = []; // the transition with which each block began to slide
    const fill = (block, time) => {
      const j = since[block], from = Math.max(Math.floor((arrays.time[j] - start) * scale), 0), to = Math.max(Math.ceil((time - start) * scale), from + 2);
      const isBackward = arrays.mode[j] < 0, kind = onset >= known ? 3 : isBackward ? 2 : Number(isGlobal);
      kinds.add(KINDS[kind]);
      for (const half of isBackward ? [1] : [0, 1]) {
        const row = (2 * (n - block) + half) * columns;
        pixels.fill(colours[kind], row + from, row + Math.min(to, columns));
      }
    };
    for (let j = first + 1; j <= last; j++) {
      const block = arrays.block[j];
      if (block in since) fill(block, arrays.time[j]);
      if (arrays.mode[j]) since[block] = j;
      else delete since[block];
    }
    for (const block in since) fill(block, stop);
  }
  const buffer = new OffscreenCanvas(columns, 2 * n);
  buffer.getContext("2d").putImageData(picture, 0, 0);
  context.imageSmoothingEnabled = false;
  context.drawImage(buffer, box.left, box.top, box.right - box.left, box.bottom - box.top);
  context.strokeStyle = palette.paper;
  context.lineWidth = n > 25 ? 0.5 : 1.5;
  const borders = Array.from({ length: n + 1 }, (_, i) => box.top + (i * (box.bottom - box.top)) / n);
  stroke(context, ...borders.map((y) => [[box.left, y], [box.right, y]]));
  return kinds;
}

// A mark at a point in pixels: dot, ring or cross.
function mark(context, shape, x, y, size, colour) {
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = 2;
  if (shape === "cross") return stroke(context, [[x - size, y - size], [x + size, y + size]], [[x - size, y + size], [x + size, y - size]]);
  context.beginPath();
  context.arc(x, y, size, 0, 2 * Math.PI);
  if (shape === "dot") context.fill();
  else context.stroke();
}

function spring(context, from, to, y, turns) {
  const lead = Math.min(4, (to - from) / 4), step = (to - from - 2 * lead) / (2 * turns);
  const turn = (_, i) => [from + lead + (i + 0.5) * step, y + (i % 2 ? 5 : -5)];
  stroke(context, [[from, y], ...Array.from({ length: 2 * turns }, turn), [to - lead, y], [to, y]]);
}

function arrow(context, x, from, to, y = null) {
  const way = Math.sign(to - from) * Math.min(5, Math.abs(to - from)), point = (along, across) => (y === null ? [x + across, along] : [along, y + across]);
  stroke(context, [point(from, 0), point(to, 0)], [point(to - way, -3.5), point(to, 0), point(to - way, 3.5)]);
}

// The row as in Fig. 9; below each block the net force of its springs against the limits of static friction; and below
// these the push along the row. `shifts` [m] are displacements in view of the camera, `magnified` so many times; `pushed`
// is the share of the drive's spring that is pressed.
function drawRow(canvas, frame) {
  const { weights, strength, forces, modes, shifts, magnified, length, pushed, isGlobal, ground } = frame;
  const [context, width, height] = clear(canvas), n = weights.length;
  const left = Math.max(70, 0.13 * width), pitch = (width - left - Math.max(24, 0.1 * width)) / n;
  const perMetre = (pitch * n) / length, size = Math.min(0.58 * pitch, 42);
  const floor = Math.round(0.28 * height), middle = Math.round(0.42 * height), tallest = 0.28 * height - size - 16, half = 0.07 * height, top = Math.round(0.56 * height);
  const heaviest = Math.max(...weights), strongest = Math.max(...strength) || 1;
  const centres = shifts.map((shift, i) => left + (i + 0.5) * pitch + shift * magnified * perMetre);
  const y = floor - size / 2;
  context.strokeStyle = palette.line;
  stroke(context, [[0, floor + 1.5], [width, floor + 1.5]]);
  const dash = 0.02e-3 * magnified * perMetre, first = -((((ground * magnified * perMetre) % dash) + dash) % dash);
  for (let x = first; x < width; x += Math.max(dash, 4)) stroke(context, [[x + 6, floor + 2], [x, floor + 8]]);

  context.strokeStyle = palette.soft;
  context.lineWidth = 1.5;
  const pushedSide = centres[0] - size / 2, plate = pushedSide - 0.8 * left * (1 - 0.65 * pushed);
  spring(context, plate, pushedSide, y, 5);
  for (let i = 1; i < n; i++) spring(context, centres[i - 1] + size / 2, centres[i] - size / 2, y, pitch > 30 ? 3 : 1);
  context.fillStyle = palette.ink;
  context.fillRect(plate - 5, floor - 1.5 * size - 2, 5, 1.5 * size + 2);
  context.strokeStyle = palette.ink;
  arrow(context, null, plate - 26, plate - 8, y);

  context.textAlign = "center";
  centres.forEach((x, i) => {
    const lean = 0.22 * size * modes[i], way = modes[i];
    context.strokeStyle = palette.soft;
    if (weights[i] > 0) arrow(context, x, floor - size - 6 - (tallest * weights[i]) / heaviest, floor - size - 3);
    const colour = palette[way === 0 ? "stuck" : way < 0 ? "backward" : isGlobal ? "global" : "partial"];
    area(context, [[x - size / 2, floor], [x + size / 2, floor], [x + size / 2 + lean, floor - size], [x - size / 2 + lean, floor - size]], colour);
    context.fillStyle = inkOn(colour);
    if (size >= 18) context.fillText(i + 1, x + lean / 2, y);

    const limit = (half * strength[i]) / strongest, share = (half * (forces[i] - forces[i + 1])) / strongest, bar = Math.min(0.5 * pitch, 26);
    context.strokeStyle = palette.line;
    context.lineWidth = 1;
    context.strokeRect(x - bar / 2, middle - limit, bar, 2 * limit);
    context.fillStyle = colour;
    context.fillRect(x - bar / 2, Math.min(middle, middle - share), bar, Math.abs(share));
    context.strokeStyle = palette.ink;
    stroke(context, [[x - bar / 2 - 2, middle], [x + bar / 2 + 2, middle]]);
    context.lineWidth = 1.5;
  });
  // The edges of the parts of the row that the blocks stand for.
  const edges = [centres[0] - pitch / 2, ...centres.slice(1).map((x, i) => (centres[i] + x) / 2), centres.at(-1) + pitch / 2];
  drawPush(context, frame, edges, centres, top, height - 22);
  context.fillStyle = palette.soft;
  context.textAlign = "left";
  const factor = `Displacements are drawn ${magnified.toLocaleString("en")} times as large${width < 500 ? "" : "; the drive’s spring has its own scale."}`;
  const names = [["normal load", 8], ["drive", floor - 1.5 * size - 12], ["net force", middle - 8], ["and limit", middle + 8], ["push in each spring", top - 8], [factor, height - 7]];
  names.forEach(([text, y]) => context.fillText(text, 4, y));
  context.textAlign = "right";
  context.fillText(`dashed: ${width < 500 ? "" : "what sliding friction leaves of it, "}Fₓ − μₖ W`, width - 4, top - 8);
}

// The push that each spring carries: what the events before left in it, and what the last one added. The dashed line is
// what sliding friction leaves of the load: F_X less mu_k times the normal load from the pushed end.
function drawPush(context, { weights, forces, before, added, friction, highest, load }, edges, centres, top, bottom) {
  const y = (force) => bottom - ((bottom - top) * force) / highest, springs = [edges[0], ...centres, edges.at(-1)], line = [[edges[0], y(load)]];
  const steps = (values) => [[edges[0], bottom], ...Array.from(values, (force, i) => [[springs[i], y(force)], [springs[i + 1], y(force)]]).flat()];
  area(context, steps(forces), added);
  area(context, steps(forces.map((force, i) => (i ? Math.min(before[i], force) : force))), palette.band);
  context.strokeStyle = palette.ink;
  stroke(context, steps(forces));
  for (let i = 0, left = load; i < weights.length && left > 0; i++) {
    const share = Math.min(left / (friction * weights[i]), 1);
    left = share < 1 ? 0 : left - friction * weights[i];
    line.push([edges[i] + share * (edges[i + 1] - edges[i]), y(left)]);
  }
  context.setLineDash([5, 4]);
  context.lineWidth = 2;
  stroke(context, line);
  context.fillStyle = palette.ink;
  context.textAlign = "right";
  context.fillText("Fₓ", edges[0] - 6, y(load));
}
