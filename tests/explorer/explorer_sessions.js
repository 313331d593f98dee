// What a session does on the explorer's page, and what it notes there.

// Canvases have one size, whatever the fonts are.
document.head.append(Object.assign(document.createElement("style"), { textContent:
  "canvas { width: 600px !important; height: 240px !important; }" }));
// A study of some sliders; the page draws many.
STUDIES.digits.count = 30, STUDIES.blocks.count = 60;
var isMotionThere = () => run.events.every(({ onset, end }, i) => state.time < onset || state.time >= end || motions.has(i));
var press = (query) => document.querySelector(query).click();
var at = (id, x, y) => { const box = element(id).getBoundingClientRect(); return { bubbles: true, cancelable: true, clientX: box.left + x, clientY: box.top + y }; };
var tap = (id, x, y = 100) => element(id).dispatchEvent(new MouseEvent("click", at(id, x, y)));
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
    if (i % 5 === 0) seen.push(`${(1e3 * state.time).toFixed(3)} ${state.event} ${element("moment").textContent.split("N")[1]} ${(1e6 * frameAt(state.time).shifts[0]).toFixed(2)}`);
  }
  seen.push(clock);
  stop();
  frames.forEach((frame) => frame(clock));
  performance.now = now;
  Object.assign(window, kept);
  return seen.join(" | ");
}
// What a worker tells when it is asked for runs of 5 blocks [id, theta, all], the twin's with another true, and for
// motions { event, onset, end }, and works so many slices in between, by a clock on which each look takes a millisecond.
function work(...asked) {
  const told = [], port1 = {};
  let now = 0, due = 0;
  const channel = () => ({ port1, port2: { postMessage: () => (due += 1) } });
  const round = (values) => Array.from(values, (value) => Number(value.toPrecision(9))).join(" ");
  const tell = ({ kind, id, share, event, ...data }) => told.push({
    run: () => `run ${id} ${data.isFinal} ${data.stopped} ${data.arrays.time.length} ${round([data.end, ...data.events.map((one) => one.after)])}`,
    progress: () => `progress ${id} ${share.toFixed(6)}`,
    motion: () => `motion ${id} ${event} ${data.time.length} ${round([data.time[0], data.time.at(-1), ...data.forces.slice(-7)])} ${data.modes.slice(-7)}`,
  }[kind]());
  const made = new Function("postMessage", "performance", "MessageChannel", "onmessage", `${element("worker").textContent}; return onmessage;`);
  const hear = made(tell, { now: () => (now += 1) }, function () { return channel(); });
  const slider = (theta) => ({ ...UNIFORM.slider, n_blocks: 5, theta });
  for (const one of asked) {
    const [id, theta, all, isTwin = false] = Array.isArray(one) ? one : [];
    if (id) hear({ data: { id, slider: slider(theta), duration: 4, all, isTwin } });
    else if (one.event) hear({ data: { id: 9, slider: slider(0), duration: 4, force: Float64Array.from([0, 56, 0, 0, 0, 0, 0]), ...one } });
    else for (let i = 0; i < one && due; i++) (due -= 1), port1.onmessage();
  }
  return told.join(" | ");
}
// A figure: its texts, and for each look the number of points, their means in x and y and their mean square.
function drawn(name) {
  const looks = {}, texts = [];
  let path = [];
  const note = (look, points) => {
    const sums = (looks[look] ??= [0, 0, 0, 0]);
    for (const [x, y] of points) [1, x, y, x * x + 3 * y * y].forEach((term, i) => (sums[i] += term));
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
  const told = Object.entries(looks).map(([look, [n, x, y, squares]]) => `${look}: ${n} @${(x / n).toFixed(2)} @${(y / n).toFixed(2)} @${Math.sqrt(squares / n).toFixed(2)}`);
  return [texts.join(" "), ...told.sort()].join(" | ");
}
function shownNow() {
  const words = (id) => element(id).innerText.replace(/\n/g, "").replace(/\s+/g, " ");
  const all = (query, what) => [...document.querySelectorAll(query)].map(what).join(" | ");
  const [answers, trust, readout] = ["answers", "trust", "readout"].map(words);
  return {
    ...Object.fromEntries(Object.keys(DRAW).map((name) => [name, drawn(name)])),
    answers: `${answers}${element("answers").className && " (grey)"}`, trust, readout, step: words("step"), told: words("told"), command: command(),
    moment: `${words("moment")} | ${[view().start, view().end, state.time].map((time) => (1e3 * time).toFixed(5)).join(" ")}`
      + ` | ${element("cursor").style.transform.replace(/\.\d+/, "")}`,
    controls: [
      all("input[type=range]", (e) => `${e.value} ${e.getAttribute("aria-valuetext") ?? ""}`), all("output", (e) => e.textContent), words("lengths-key"),
      ...["[aria-pressed=true]", ":disabled", "[id][hidden]"].map((query) => all(query, (e) => (e.checkVisibility({ visibilityProperty: true }) ? e.id || e.textContent : ""))),
      all(".tip", (e) => (e.checkVisibility() ? e.id : "")).replaceAll(" | ", ""),
    ].join(" || "),
    ranges: all("input[type=range]", (e) => `${e.min} ${e.max} ${e.step}`),
    names: all("canvas", (e) => e.getAttribute("aria-label")?.replace(readout, "")),
  };
}
