"use strict";
// Draws on canvases: axes, curves and marks of the figures, and the row of blocks. Nothing here knows the page's state.

const FONT = "12px system-ui, 'DejaVu Sans', sans-serif";
const KINDS = ["partial", "global", "backward", "unsure"];
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
  context.textBaseline = "middle";
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

// Least and largest value of a curve inside [start, end], with the values at both ends.
function extent(time, value, start, end) {
  const from = lowerBound(time, start), to = lowerBound(time, end);
  let [low, high] = [Infinity, -Infinity];
  const see = (v) => ([low, high] = [Math.min(low, v), Math.max(high, v)]);
  for (const [at, t] of [[from, start], [to, end]]) {
    if (at > 0 && at < time.length) see(value[at - 1] + ((value[at] - value[at - 1]) * (t - time[at - 1])) / (time[at] - time[at - 1] || 1));
  }
  for (let i = from; i < to; i++) see(value[i]);
  return [low, high];
}

// A curve: of the points in one column of pixels only the first, the extremes and the last are drawn.
function curve(context, figure, time, value, start, end) {
  const from = Math.max(lowerBound(time, start) - 1, 0), to = Math.min(lowerBound(time, end) + 1, time.length);
  const { box } = figure;
  context.save();
  context.beginPath();
  context.rect(box.left, box.top - 6, box.right - box.left, box.bottom - box.top + 7);
  context.clip();
  const points = [];
  for (let i = from; i < to; ) {
    const column = Math.round(figure.x(time[i]));
    let low = i, high = i, last = i;
    for (; i < to && Math.round(figure.x(time[i])) === column; last = i++) {
      if (value[i] < value[low]) low = i;
      if (value[i] > value[high]) high = i;
      if (i === last) points.push(i);
    }
    points.push(...(low < high ? [low, high, last] : [high, low, last]));
  }
  stroke(context, points.map((i) => [figure.x(time[i]), figure.y(value[i])]));
  context.restore();
}

// Slides of the blocks as a picture with two pixels for each block and column, which is as fast for any number of slides.
// A backward slip has the lower one alone. Slips that are not predictable are grey.
function slideBars(context, { box }, { n, events, arrays, known }, start, end) {
  const columns = Math.max(Math.round(box.right - box.left), 1), scale = columns / (end - start);
  const picture = new ImageData(columns, 2 * n), pixels = new Uint32Array(picture.data.buffer);
  const colours = KINDS.map((kind) => {
    const [r, g, b] = channels(palette[kind]);
    return (255 << 24) | (b << 16) | (g << 8) | r;
  });
  for (const { first, last, onset, end: stop, isGlobal } of events) {
    if (stop < start || onset > end) continue;
    const since = []; // the transition with which each block began to slide
    const fill = (block, time) => {
      const j = since[block], from = Math.max(Math.floor((arrays.time[j] - start) * scale), 0), to = Math.max(Math.ceil((time - start) * scale), from + 2);
      const isBackward = arrays.mode[j] < 0, colour = colours[onset >= known ? 3 : isBackward ? 2 : Number(isGlobal)];
      for (const half of isBackward ? [1] : [0, 1]) {
        const row = (2 * (n - block) + half) * columns;
        pixels.fill(colour, row + from, row + Math.min(to, columns));
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
}

// A mark at a point in pixels: dot, ring or cross.
function mark(context, shape, x, y, size, colour) {
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = 2;
  const [left, right, top, bottom] = [x - size, x + size, y - size, y + size];
  if (shape === "cross") return stroke(context, [[left, top], [right, bottom]], [[left, bottom], [right, top]]);
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

// The row as in Fig. 9, and below each block the net force of its springs against the limits of static friction.
// `shifts` [m] are displacements in view of the camera, `magnified` so many times; `pushed` is the share of the drive's
// spring that is pressed.
function drawRow(canvas, { weights, strength, net, modes, shifts, magnified, length, pushed, isGlobal, ground }) {
  const [context, width, height] = clear(canvas), n = weights.length;
  const left = Math.max(70, 0.13 * width), pitch = (width - left - Math.max(24, 0.1 * width)) / n;
  const perMetre = (pitch * n) / length, size = Math.min(0.58 * pitch, 42);
  const floor = Math.round(0.52 * height), middle = Math.round(0.79 * height), tallest = 0.28 * height - 8, half = height - middle - 18;
  const heaviest = Math.max(...weights), strongest = Math.max(...strength) || 1;
  const centre = (i) => left + (i + 0.5) * pitch + shifts[i] * magnified * perMetre;
  const y = floor - size / 2;
  context.strokeStyle = palette.line;
  stroke(context, [[0, floor + 1.5], [width, floor + 1.5]]);
  const dash = 0.02e-3 * magnified * perMetre, first = -((((ground * magnified * perMetre) % dash) + dash) % dash);
  for (let x = first; x < width; x += Math.max(dash, 4)) stroke(context, [[x + 6, floor + 2], [x, floor + 8]]);

  context.strokeStyle = palette.soft;
  context.lineWidth = 1.5;
  const pushedSide = centre(0) - size / 2, plate = pushedSide - 0.8 * left * (1 - 0.65 * pushed);
  spring(context, plate, pushedSide, y, 5);
  for (let i = 1; i < n; i++) spring(context, centre(i - 1) + size / 2, centre(i) - size / 2, y, pitch > 30 ? 3 : 1);
  context.fillStyle = palette.ink;
  context.fillRect(plate - 5, floor - 1.5 * size - 2, 5, 1.5 * size + 2);
  context.strokeStyle = palette.ink;
  arrow(context, null, plate - 26, plate - 8, y);

  context.textAlign = "center";
  context.textBaseline = "middle";
  for (let i = 0; i < n; i++) {
    const x = centre(i), lean = 0.22 * size * modes[i], way = modes[i];
    context.strokeStyle = palette.soft;
    if (weights[i] > 0) arrow(context, x, floor - size - 6 - (tallest * weights[i]) / heaviest, floor - size - 3);
    const colour = palette[way === 0 ? "stuck" : way < 0 ? "backward" : isGlobal ? "global" : "partial"];
    context.fillStyle = colour;
    context.beginPath();
    context.moveTo(x - size / 2, floor), context.lineTo(x + size / 2, floor);
    context.lineTo(x + size / 2 + lean, floor - size), context.lineTo(x - size / 2 + lean, floor - size);
    context.fill();
    context.fillStyle = inkOn(colour);
    if (size >= 18) context.fillText(i + 1, x + lean / 2, y);

    const limit = (half * strength[i]) / strongest, share = (half * net[i]) / strongest, bar = Math.min(0.5 * pitch, 26), foot = left + (i + 0.5) * pitch;
    context.strokeStyle = palette.line;
    context.lineWidth = 1;
    context.strokeRect(foot - bar / 2, middle - limit, bar, 2 * limit);
    context.fillStyle = colour;
    context.fillRect(foot - bar / 2, Math.min(middle, middle - share), bar, Math.abs(share));
    context.strokeStyle = palette.ink;
    stroke(context, [[foot - bar / 2 - 2, middle], [foot + bar / 2 + 2, middle]]);
    context.lineWidth = 1.5;
  }
  context.fillStyle = palette.soft;
  context.textAlign = "left";
  context.fillText("normal load", 4, 14);
  context.fillText("drive", 4, floor - 1.5 * size - 14);
  context.fillText("spring", 4, middle - 15), context.fillText("force and", 4, middle), context.fillText("limit", 4, middle + 15);
  const factor = `Displacements are drawn ${magnified.toLocaleString("en")} times as large`;
  context.fillText(width < 500 ? factor : `${factor}; the drive’s spring has its own scale.`, 4, height - 7);
}
