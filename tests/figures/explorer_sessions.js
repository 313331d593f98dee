// What a session does on the explorer's page, and what it notes there.

// Canvases have one size, whatever the fonts are.
document.head.append(Object.assign(document.createElement("style"), { textContent:
  "canvas { width: 600px !important; height: 240px !important; }" }));
var isMotionThere = () => runs[0].events.every(({ onset, end }, i) => state.time < onset || state.time >= end || motions.has(i));
var press = (query) => document.querySelector(query).click();
var at = (id, x, y) => { const box = element(id).getBoundingClientRect(); return { bubbles: true, cancelable: true, clientX: box.left + x, clientY: box.top + y }; };
var tap = (id, x, y = 100) => element(id).dispatchEvent(new MouseEvent("click", at(id, x, y)));
var wheel = (id, x, more) => element(id).dispatchEvent(new WheelEvent("wheel", { ...at(id, x, 100), ...more }));
var key = (name, more = {}, query = "body") => document.querySelector(query).dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true, ...more }));
var set = (query, value) => { const e = document.querySelector(query); e.value = value; for (const kind of ["input", "change"]) e.dispatchEvent(new Event(kind, { bubbles: true })); };
// Frames of a film at 20 a second: times, events and clocks that are shown.
function watch(count, isCalm = false) {
  const kept = { requestAnimationFrame, cancelAnimationFrame, matchMedia }, now = performance.now, seen = [];
  let clock = 1000, frames = [];
  drawDirty();
  performance.now = () => clock;
  Object.assign(window, {
    requestAnimationFrame: (frame) => frames.push(frame),
    cancelAnimationFrame: (number) => delete frames[number - 1],
    matchMedia: () => ({ matches: isCalm }),
  });
  play();
  for (let i = 0; i < count && playing; i++) {
    clock += isCalm ? 1000 : 50;
    const due = frames;
    frames = [];
    due.forEach((frame) => frame(clock));
    if (i % 5 === 0) seen.push(`${(1e3 * state.time).toFixed(3)} ${state.event} ${element("moment").textContent.split(" N")[1]}`);
  }
  stop();
  frames.forEach((frame) => frame(clock));
  performance.now = now;
  Object.assign(window, kept);
  return seen.join(" | ");
}
// What the worker tells when it is asked for runs of 5 blocks [id, thetas, all] and events { id, event } and works so
// many slices in between, by a clock on which each look at it takes a millisecond.
function work(...asked) {
  const told = [], port1 = {};
  let now = 0, due = 0;
  const channel = () => ({ port1, port2: { postMessage: () => (due += 1) } });
  const round = (values) => Array.from(values, (value) => Number(value.toPrecision(9))).join(" ");
  const tell = ({ kind, id, slot, share, event, ...data }) => told.push({
    run: () => `run ${id} ${slot} ${data.isFinal} ${data.stopped} ${data.transitions} ${round([data.end, ...data.events.map((one) => one.after)])}`,
    progress: () => `progress ${id} ${share.toFixed(6)}`,
    motion: () => `motion ${id} ${event} ${data.time.length} ${round([data.time[0], data.time.at(-1), ...data.forces.slice(-7)])} ${data.modes.slice(-7)}`,
  }[kind]());
  const made = new Function("postMessage", "performance", "MessageChannel", "onmessage", `${SCRIPT}; return onmessage;`);
  const hear = made(tell, { now: () => (now += 1) }, function () { return channel(); });
  const chain = (theta, nudge) => ({ blocks: 5, theta, normalLoad: 400, muS: 0.7, muK: 0.45, driveStiffness: 8e5, driveVelocity: 1e-4, mass: 0.012, stiffness: 2.5e6, nudge });
  for (const one of asked) {
    if (Array.isArray(one)) hear({ data: { id: one[0], chains: one[1].map((theta, i) => chain(theta, i / 10)), duration: 4, all: one[2] } });
    else if (one.id) hear({ data: one });
    else for (let i = 0; i < one && due; i++) (due -= 1), port1.onmessage();
  }
  return told.join(" | ");
}
function drawn(name) {
  const looks = {}, texts = [];
  let path = [];
  const note = (look, points) => {
    const sums = (looks[look] ??= [0, 0, 0, 0, 0]);
    for (const [x, y] of points) [1, x, y, x * x, y * y].forEach((term, i) => (sums[i] += term));
  };
  const corners = (x, y, w, h) => [[x, y], [x + w, y + h]];
  const noted = {
    beginPath() { path = []; },
    moveTo(x, y) { path.push([x, y]); },
    lineTo(x, y) { path.push([x, y]); },
    arc(x, y, size) { path.push(...corners(x, y, size, size)); },
    stroke() { note(`line ${this.strokeStyle} ${this.lineWidth} ${this.getLineDash()}`, path); },
    fill() { note(`area ${this.fillStyle}`, path); },
    fillRect(...box) { note(`area ${this.fillStyle}`, corners(...box)); },
    strokeRect(...box) { note(`box ${this.strokeStyle} ${this.lineWidth}`, corners(...box)); },
    fillText(text, x, y) { texts.push(text), note(`text ${this.fillStyle} ${this.textAlign}`, [[x, y]]); },
  };
  const canvas = CanvasRenderingContext2D.prototype, bars = OffscreenCanvasRenderingContext2D.prototype;
  const kept = Object.fromEntries(Object.keys(noted).map((does) => [does, canvas[does]])), put = bars.putImageData;
  Object.assign(canvas, noted);
  bars.putImageData = ({ data, width }) => {
    new Uint32Array(data.buffer).forEach((pixel, i) => pixel && note(`bar ${pixel}`, [[i % width, Math.floor(i / width)]]));
  };
  DRAW[name]();
  Object.assign(canvas, kept);
  bars.putImageData = put;
  const told = Object.entries(looks).map(([look, [n, x, y, xx, yy]]) => {
    const means = [x / n, y / n, Math.sqrt(xx / n), Math.sqrt(yy / n)];
    return [`${name}: ${look}`, `${n} ${means.map((mean) => mean.toFixed(3)).join(" ")}`];
  });
  return [[`${name}: texts`, texts.join(" | ")], ...told];
}
function shownNow() {
  const words = (id) => element(id).textContent.replace(/\s+/g, " ");
  const all = (query, what) => [...document.querySelectorAll(query)].map(what).join(" | ");
  return {
    ...Object.fromEntries(Object.keys(DRAW).flatMap(drawn)),
    ...Object.fromEntries(["answers", "readout", "moment", "step", "told", "ghost-name"].map((id) => [id, words(id)])),
    address: location.hash,
    command: command(),
    view: [view().start, view().end, state.time].map((time) => `${(1e3 * time).toFixed(6)} ms`).join(" "),
    inputs: all("input[type=range]", (e) => `${e.value} ${e.min} ${e.max} ${e.getAttribute("aria-valuetext")}`),
    outputs: all("output", (e) => e.textContent),
    pressed: all("[aria-pressed=true]", (e) => e.textContent),
    disabled: all(":disabled", (e) => e.id),
    hidden: all("[id][hidden]", (e) => e.id),
    names: all("canvas", (e) => e.getAttribute("aria-label")),
    cursor: element("cursor").style.transform.replace(/\.\d+/, ""),
  };
}
