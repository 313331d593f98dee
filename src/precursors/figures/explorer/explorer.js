"use strict";
// The page: its state, what is asked of the worker, what is drawn, and what the reader can do.

const element = (id) => document.getElementById(id);
const { duration: DURATION, scenes: SCENES, proved: PROVED } = JSON.parse(element("data").textContent);
const SCRIPT = element("worker").textContent;
const PACE = 4000; // s of film for a second of slip: 1 ms takes 4 s
const LONGEST = 20; // s of film for one event
const GAP = [0.4, 1.2]; // s of film for the time between two events, shortest and longest
const NARROWEST = 10e-6; // s, the narrowest view
const REACH = 22; // pixels around a mark in which a click means it
const NUDGE = 1e-6; // by which the load of block 1 differs in the second run
const APART = 1; // N, a difference between two runs that is seen

const WORDS = {
  precursor: ["precursor", "A slip of part of the row, before the whole row slips."],
  global: ["global slip", "A slip in which all blocks slide at the same instant."],
  load: ["F<sub>X</sub>", "Tangential load: the force [N] of the drive on block 1."],
  front: ["L<sub>p</sub>", "Front length: how far into the row a slip gets, from the pushed end. L is the length of the row."],
  apparent: ["μ<sub>sapp</sub>", "Apparent static friction: the largest F<sub>X</sub> up to the first global slip, divided by the total normal load F<sub>Z</sub>."],
  fig13: ["Fig. 13", "The paper’s figure of front length against load. It leaves out events that are shorter than one before them, and ends with the first global slip."],
  proved: ["✓ proved", "The transitions up to the first global slip are proved: no rounding error can change their order."],
};
const SLIDERS = {
  theta: { symbol: "θ", low: -1, high: 1, step: 0.01, write: fraction, about: "How unevenly the normal load is spread. Negative: more on the pushed end. 0: the same on each block. Positive: more on the far end." },
  n_blocks: { symbol: "N", low: 1, high: 40, step: 1, write: (x) => counts(x, "block"), about: "Number of blocks that the slider is cut into. Its length and mass stay the same." },
  mu_s: { symbol: "μ<sub>s</sub>", low: 0.05, high: 1.5, step: 0.01, write: (x) => x.toFixed(2), about: "Static friction: a stuck block starts to slide when the springs push with μ<sub>s</sub> times its normal load." },
  mu_k: { symbol: "μ<sub>k</sub>", low: 0, high: 1.5, step: 0.01, write: (x) => x.toFixed(2), about: "Kinetic friction: what holds back a sliding block. It is never above μ<sub>s</sub>." },
  drive_stiffness: { symbol: "K", low: 1e4, high: 1e8, write: (x) => `${scaled(x, 1e6)} MN/m`, about: "Stiffness of the spring between the drive and block 1." },
  drive_velocity: { symbol: "V", low: 1e-6, high: 0.1, write: (x) => `${scaled(x, 1e-3)} mm/s`, about: "Speed of the drive. While all blocks are stuck, F<sub>X</sub> grows by K V each second." },
};
const uniform = nearTheta(0);
// Steps: heading, text, what is set, and the event that is shown.
const STEPS = [
  {
    title: "What is a precursor?", slider: uniform, pick: "partial",
    text: () => `The drive pushes harder and harder, but friction holds the row. Then the blocks at the pushed end slip for a moment, and the others stay stuck: this is a ${word("precursor")} of the slip of the whole row. Press Play and watch ${word("load")} dip as the front stops after block ${event()?.front ?? ""}.`,
  },
  {
    title: "Why is the next one longer?", slider: uniform, pick: "longer",
    text: () => `A precursor leaves the springs compressed as far as it came. The next one needs a higher load to start, meets blocks that are already pushed, and runs further along the row. Go on with → and see ${word("front")} grow; a shorter slip comes in between now and then.`,
  },
  {
    title: "When does all of it slide?", slider: uniform, pick: "global",
    text: () => `The front reaches the last block while all the others still slide: a ${word("global")}. It is a wave, and it takes blocks along that a slow push would not have moved yet. That is why the row lets go at ${ratio()} F<sub>Z</sub> (${word("apparent")}), although each block could hold ${(state.slider.mu_s).toFixed(2)} times its normal load.`,
  },
  {
    title: "What does the normal load do?", slider: nearTheta(-1), pick: "partial",
    text: () => `The arrows show the normal load on each block; θ tilts it. With more on the pushed end, the first precursor comes late, and few are needed; with less there, it comes early, and many follow. Yet the global slip needs nearly the same load: ${word("apparent")} = ${[-1, 0, 1].map((theta) => apparentOf(nearTheta(theta)).toFixed(4)).join(", ")}.</p><p class="bar">${sceneButtons()}`,
  },
  {
    title: "Is there chance in it?", slider: nearTheta(1), pick: "global", twin: true, view: "all",
    text: () => `The dashed run is the same, but block 1 carries a millionth more load. ${parting() === null ? "No difference is seen so far" : `Until ${parting().toFixed(2)} s you cannot tell them apart; then each goes its own way`}. The rules leave nothing to chance, but slips amplify small differences, and no load is known so well.`,
  },
];

const state = { slider: { ...uniform.slider }, wish: {}, twin: false, step: 1, pick: "partial", view: "first", event: null, time: 0, ghost: uniform };
let runs = [], film = null, motions = new Map(), own = null, asked = 0, playing = null, shares = null, dirty = new Set(), worker = null, wanted = null;

function nearTheta(theta) {
  return SCENES.reduce((best, scene) => (Math.abs(scene.slider.theta - theta) < Math.abs(best.slider.theta - theta) ? scene : best));
}
function apparentOf(scene) {
  return Math.max(...scene.events.map(([, load]) => load)) / scene.slider.normal_load;
}
function fraction(value) {
  for (let below = 1; below <= 12; below++) {
    if (Math.abs(Math.round(value * below) - value * below) < 1e-11) return `${Math.round(value * below) || 0}${below > 1 ? `/${below}` : ""}`.replace("-", "−");
  }
  return value.toFixed(3).replace("-", "−");
}
function scaled(value, unit) {
  return value / unit >= 100 ? Math.round(value / unit).toString() : Number((value / unit).toPrecision(2)) === 0 ? "0" : (value / unit).toPrecision(2).replace(/e.*/, (power) => `·10^${Number(power.slice(1))}`);
}
function counts(n, what) {
  return `${n} ${what}${n === 1 ? "" : "s"}`;
}
function plain(text) {
  return String(text).replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);
}
function word(name) {
  const [short, about] = WORDS[name];
  return `<span class="word"><button type="button" class="why" aria-describedby="tip-${name}">${short}</button><span class="tip" role="tooltip" id="tip-${name}">${about}</span></span>`;
}
function sceneButtons() {
  const sorted = [...SCENES].sort((a, b) => a.slider.theta - b.slider.theta);
  return sorted.map((scene) => `<button type="button" data-scene="${SCENES.indexOf(scene)}" aria-pressed="${isScene(scene)}" title="${plain(scene.title)}">θ = ${fraction(scene.slider.theta)}</button>`).join("");
}
const same = (slider) => !state.slider.weights && Object.keys(slider).every((name) => slider[name] === state.slider[name]);
const isScene = (scene) => same(scene.slider);
const event = () => (state.event === null ? null : runs[0]?.events[state.event]);
const firstGlobal = (run = runs[0]) => run.events.find((event) => event.isGlobal);
const ratio = () => (runs[0] ? (Math.max(0, ...runs[0].counted.map((event) => event.before)) / runs[0].weights.reduce((sum, load) => sum + load)).toFixed(4) : "");

// Ask for the run of what is set: while a slider is held only up to the first global slip.
function solve(isHeld = false) {
  const slider = { ...state.slider, nudge: 0 };
  asked += 1;
  worker.postMessage({ id: asked, chains: state.twin ? [slider, { ...slider, nudge: NUDGE }] : [slider], duration: DURATION, all: !isHeld });
  showParameters();
  if (!isHeld) keepState();
}

function hear({ data }) {
  if (data.kind === "measurement") return showMeasurement(data);
  if (data.kind === "progress") return showProgress(data.share);
  if (data.kind === "motion") {
    if (data.id === runs[0]?.id) motions.set(data.event, data);
    return redraw("row", "load");
  }
  if (data.isFinal) showProgress(0);
  const isNew = data.id !== runs[0]?.id;
  Object.assign(data, { counted: countedOf(data.events) });
  runs[data.slot] = data;
  if (!state.twin) runs.length = 1;
  if (data.slot === 0) {
    if (isNew) motions.clear(), (wanted = null);
    magnify(data);
    film = filmOf(data);
    placeTime();
  }
  showAnswers();
  showLoads();
  showStep();
  redraw("row", "load", "slips", "lengths");
}

// The rows of Fig. 13: up to the first global slip, without events shorter than one before.
function countedOf(events) {
  let longest = 0;
  const end = events.findIndex((event) => event.isGlobal);
  return events.slice(0, end < 0 ? undefined : end + 1).filter((event) => event.front >= longest && (longest = event.front));
}

// When two runs are apart: the first event that has another front or load [s], or null.
function parting() {
  const [a, b] = runs;
  const at = b ? a.events.findIndex((event, i) => event.front !== b.events[i]?.front || Math.abs(event.after - b.events[i].after) > APART) : -1;
  return at < 0 ? null : a.events[at].onset;
}

// The film: seconds at which each event starts and ends when the run is played.
function filmOf(run) {
  let wall = 0, before = 0;
  const knots = { time: [0], wall: [0] };
  const add = (time, lasts) => (knots.time.push(time), knots.wall.push((wall += lasts)));
  for (const { onset, end } of run.events) {
    add(onset, Math.min(Math.max(2 * (onset - before), GAP[0]), GAP[1]));
    add((before = end), Math.min((end - onset) * PACE, LONGEST));
  }
  add(run.end, GAP[1]);
  return knots;
}
function along(from, to, x) {
  const i = Math.min(Math.max(lowerBound(from, x), 1), from.length - 1), span = from[i] - from[i - 1];
  return to[i - 1] + (to[i] - to[i - 1]) * Math.min(Math.max((x - from[i - 1]) / (span || 1), 0), 1);
}

// Where a new run is looked at: the event that the step shows, or the same event and time as before.
function placeTime() {
  const { id, events, counted, end, isFinal } = runs[0];
  const partial = counted.filter((event) => !event.isGlobal), middle = Math.max(Math.ceil(partial.length / 2) - 1, 0);
  const shown = { partial: partial[middle], longer: partial[Math.min(middle + 1, partial.length - 1)], global: firstGlobal() ?? counted.at(-1) }[state.pick];
  if (shown && !playing) [state.event, state.time] = [events.indexOf(shown), shown.onset];
  else if (state.event !== null && !playing) {
    // The event of an address, which belongs to the first run, may come with the end of that run.
    if (isFinal || id > 1) state.event = events.length ? Math.min(state.event, events.length - 1) : null;
    state.time = event()?.onset ?? 0;
  }
  state.time = Math.min(state.time, end);
}

function view() {
  if (typeof state.view === "object") return state.view;
  const { end, events } = runs[0], last = firstGlobal();
  if (state.view === "event" && event()) {
    const lasts = Math.max(event().end - event().onset, NARROWEST);
    return { start: Math.max(event().onset - 0.3 * lasts, 0), end: event().onset + 1.3 * lasts };
  }
  return { start: 0, end: state.view === "first" && last ? Math.min(1.04 * last.end, DURATION) : runs[0].stopped && end < DURATION ? 1.04 * end || DURATION : DURATION };
}

// The state of the row at a time: forces of the springs, modes, and displacements [m].
function frameAt(time) {
  const { events, arrays, n, k, weights, strength } = runs[0], { drive_stiffness: K, drive_velocity: V, length } = runs[0].slider;
  const next = lowerBound(events.map((e) => e.onset), time), at = next < events.length && events[next].onset === time ? next : next - 1;
  const now = at >= 0 && time < events[at].end ? at : null, row = now ?? at + 1;
  const rest = (number) => arrays.forces.slice(number * (n + 2), (number + 1) * (n + 2));
  let forces = rest(row), modes = new Int8Array(n + 2);
  if (now !== null) {
    const motion = motions.get(now);
    if (motion) {
      const i = Math.max(lowerBound(motion.time, time) - 1, 0);
      forces = motion.forces.subarray(i * (n + 2), (i + 1) * (n + 2));
      modes = motion.modes.subarray(i * (n + 2), (i + 1) * (n + 2));
    } else askMotion(now);
  } else forces[1] = at < 0 ? K * V * time : events[at].after + K * V * (time - events[at].end);
  const positions = (t, f) => {
    const x = [V * t - f[1] / K];
    for (let i = 2; i <= n; i++) x.push(x[i - 2] - f[i] / k);
    return x;
  };
  // The camera stays where the last slip left the far end, goes along if that end leaves the picture, and then eases back.
  const x = positions(time, forces), room = (0.07 * length) / runs[0].magnified;
  const far = (number) => (number < 0 ? 0 : positions(events[number].onset, rest(number))[n - 1]);
  const kept = at < 0 ? 0 : far(at), camera = kept + Math.max(x[n - 1] - kept - room, 0);
  const ease = now === null && at >= 0 ? Math.min((time - events[at].end) / (0.3 * ((events[next]?.onset ?? runs[0].end) - events[at].end) || 1), 1) : 0;
  const seen = camera + (x[n - 1] - camera) * ease * ease * (3 - 2 * ease);
  return {
    weights, strength: strength.slice(1), net: Array.from({ length: n }, (_, i) => forces[i + 1] - forces[i + 2]), modes: modes.slice(1, n + 1), shifts: x.map((value) => value - seen),
    magnified: runs[0].magnified, length, pushed: Math.max(forces[1], 0) / runs[0].highest, isGlobal: now !== null && events[now].isGlobal, ground: seen, now, at, load: forces[1],
  };
}

// Ask for the motion in an event, once; the worker follows one event at a time.
function askMotion(number) {
  if (motions.has(number) || number === wanted) return;
  wanted = number;
  worker.postMessage({ id: runs[0].id, event: number });
}

function magnify(run) {
  run.highest = 1.02 * run.events.reduce((high, event) => Math.max(high, event.before), 1e-9);
  const most = (0.34 * run.slider.length) / run.n / (run.highest / run.k), power = 10 ** Math.floor(Math.log10(most));
  run.magnified = power * [5, 4, 3, 2, 1.5, 1].find((factor) => factor * power <= most);
}

function showRow() {
  const frame = frameAt(state.time), { now, at } = frame, start = now ?? -1;
  drawRow(element("row"), frame);
  if (now !== null && state.event !== now) (state.event = now), redraw("lengths");
  else if (now === null && playing && at >= 0) state.event = at;
  const { box } = shares ?? {}, { start: from, end: to } = view();
  const share = (state.time - from) / (to - from);
  element("cursor").style.transform = box ? `translateX(${box.left + share * (box.right - box.left)}px)` : "";
  element("cursor").hidden = share < 0 || share > 1;
  const [low, high] = [from, to].map((t) => along(film.time, film.wall, t));
  element("scrubber").value = (1000 * (along(film.time, film.wall, state.time) - low)) / (high - low || 1);
  const lasts = start >= 0 ? runs[0].events[start].end - runs[0].events[start].onset : 0, pace = Math.min(PACE, LONGEST / lasts) / 1000;
  const clock = now === null ? `${state.time.toFixed(3)} s, all blocks stuck` : `${runs[0].events[now].onset.toFixed(3)} s + ${((state.time - runs[0].events[now].onset) * 1e6).toFixed(0)} µs`;
  element("moment").textContent = `${clock}, Fₓ = ${frame.load.toFixed(1)} N` + (playing ? (now === null ? " – time lapse" : ` – slow motion: 1 ms takes ${pace.toPrecision(1)} s`) : "");
  if (shownEvent !== state.event || shownRun !== runs[0]) showReadout();
}

let shownEvent, shownRun;
function showReadout() {
  [shownEvent, shownRun] = [state.event, runs[0]];
  const one = event(), { events, n, counted } = runs[0];
  element("previous").disabled = !events.length || state.event === 0;
  element("next").disabled = !events.length || state.event === events.length - 1;
  const kind = one?.isGlobal ? "global slip" : counted.includes(one) ? "precursor" : "shorter slip";
  const text = one
    ? `Event ${state.event + 1} of ${events.length}, ${one.isGlobal ? "global slip" : firstGlobal() && one.onset > firstGlobal().onset ? "partial slip" : kind}: ${one.front === 1 ? "block 1 slides" : `blocks 1 to ${one.front} slide${one.front === n && !one.isGlobal ? ", never all at once," : ""}`} for ${((one.end - one.onset) * 1e6).toFixed(0)} µs from ${one.onset.toFixed(3)} s on. Fₓ goes from ${one.before.toFixed(2)} to ${one.after.toFixed(2)} N.`
    : "Press Play, click an event in a figure, or press →.";
  element("readout").textContent = text;
  element("row").setAttribute("aria-label", `A row of ${counts(n, "block")}, pushed from the left by a spring. ${text}`);
  element("lengths").setAttribute("aria-label", `Front length against load: ${counted.map((e) => `${counts(e.front, "block")} at ${e.before.toFixed(1)} N`).join(", ").slice(0, 900)}`);
}

const isWide = (start, end) => end - start > 0.02; // s: the time of the run, not that of an event
function timeTicks(start, end, width) {
  if (isWide(start, end)) return [ticks(start, end, Math.min(8, width / 80)), "Time t [s]"];
  const zero = event()?.onset ?? start, [unit, name] = end - start < 2e-3 ? [1e-6, "µs"] : [1e-3, "ms"];
  const { values, decimals } = ticks((start - zero) / unit, (end - zero) / unit, Math.min(8, width / 80));
  return [{ values: values.map((value) => zero + value * unit), names: values.map((value) => value.toFixed(decimals)) }, `Time since the onset of the event [${name}]`];
}

function showLoad() {
  const { start, end } = view(), [context, width, height] = clear(element("load")), [run, second] = runs;
  const [low, high] = extent(run.arrays.time, run.arrays.load, start, end), isWhole = isWide(start, end);
  const [bottom, top] = Number.isFinite(low) ? (isWhole ? [0, 1.06 * Math.max(high, 1e-9)] : [low - 0.08 * (high - low || 1), high + 0.08 * (high - low || 1)]) : [0, 1];
  shares = axes(context, width, height, [start, end], [bottom, top], [null, "Load F\u2093 [N]"], timeTicks(start, end, width)[0]);
  const inside = (time, load) => time >= start && time <= end && load >= bottom && load <= top;
  for (const [onset, load] of state.ghost.events) if (inside(onset, load)) mark(context, "ring", shares.x(onset), shares.y(load), 5, palette.ghost);
  const draw = (time, load, colour, dash, thick = 1.5, parts = [[start, end]]) => {
    context.strokeStyle = colour;
    context.lineWidth = thick;
    context.setLineDash(dash);
    for (const [from, to] of parts) curve(context, shares, time, load, from, to);
    context.setLineDash([]);
  };
  if (own) draw(own.time, own.load, palette.own, []);
  const motion = isWhole ? null : motions.get(state.event);
  draw(run.arrays.time, run.arrays.load, palette.ink, [], 1.5, motion ? [[start, motion.time[0]], [motion.time.at(-1), end]] : [[start, end]]);
  if (second) draw(second.arrays.time, second.arrays.load, palette.second, [7, 4], 2);
  if (motion) draw(motion.time, motion.forces.filter((_, i) => i % (run.n + 2) === 1), palette.ink, []);
  const seen = run.events.filter((one) => inside(one.onset, one.before)), size = seen.length > 60 ? 2 : 3;
  for (const one of seen) if (size > 2 || one.isGlobal) mark(context, "dot", shares.x(one.onset), shares.y(one.before), size, palette[one.isGlobal ? "global" : "partial"]);
  element("load").setAttribute("aria-label", `Load against time: ${element("answers").textContent}`);
}

function showSlips() {
  const { start, end } = view(), [context, width, height] = clear(element("slips")), { bars, n } = runs[0];
  const every = Math.ceil(n / 6), values = Array.from({ length: Math.ceil(n / every) }, (_, i) => 1 + i * every);
  const [along, label] = timeTicks(start, end, width);
  const figure = axes(context, width, height, [start, end], [0.5, n + 0.5], [label, "Block"], along, { values, decimals: 0 });
  slideBars(context, figure, bars, n, start, end);
  element("slips").setAttribute("aria-label", "Slips over time: one line for each block, coloured while it slides");
}

let marks = []; // of the figure of front lengths: [x, y, number of the event]
function showLengths() {
  const [context, width, height] = clear(element("lengths")), [run, second] = runs, last = firstGlobal();
  const events = last ? run.events.slice(0, run.events.indexOf(last) + 1) : run.events;
  const highest = Math.max(1e-9, ...events.map((e) => e.before), ...state.ghost.events.map(([, load]) => load));
  const figure = axes(context, width, height, [0, 1.06 * highest], [0, 1.08], ["Load F\u2093 [N]", "Front length L\u209a / L"]);
  for (const [, load, share] of state.ghost.events) mark(context, "ring", figure.x(load), figure.y(share), 7, palette.ghost);
  marks = events.map((one, i) => {
    const x = figure.x(one.before), y = figure.y(one.front / run.n), isCounted = run.counted.includes(one);
    mark(context, isCounted ? "dot" : "cross", x, y, 4, isCounted ? palette[one.isGlobal ? "global" : "partial"] : palette.soft);
    if (i === state.event) mark(context, "ring", x, y, 10, palette.ink);
    return [x, y, i];
  });
  if (second) for (const one of second.counted) mark(context, "diamond", figure.x(one.before), figure.y(one.front / second.n), 7, palette.second);
}

const DRAW = { load: showLoad, slips: showSlips, lengths: showLengths, row: showRow };
// Draw in the next frame: one figure in a task, so that no task is long.
function redraw(...names) {
  if (!dirty.size) requestAnimationFrame(drawDirty);
  names.forEach((name) => dirty.add(name));
}
function drawDirty() {
  if (!runs[0]) return dirty.clear();
  const names = Object.keys(DRAW).filter((name) => dirty.has(name));
  dirty = new Set();
  names.forEach((name) => DRAW[name]());
  document.body.dataset.drawn = runs[0].id;
}

function showAnswers() {
  const [run] = runs, slip = firstGlobal();
  const stop = run.stopped ? `Stopped after ${run.transitions >= 200000 ? `${run.transitions.toLocaleString("en")} transitions` : "2,000,000 steps"} at ${run.end.toPrecision(3)} s` : "";
  const found = slip
    ? `${counts(run.counted.length, "event")} counted in ${word("fig13")} · ${word("apparent")} = ${ratio()} · first global slip at ${slip.onset.toFixed(3)} s`
    : `No global slip ${run.stopped ? "until then" : run.end < DURATION ? "so far" : `in ${DURATION} s`} · largest load ${ratio()} F<sub>Z</sub>`;
  const isProved = slip && PROVED.some((one) => same(one.slider) && slip.end <= one.duration);
  setHtml("answers", `${stop ? `${stop}. ` : ""}${found}${isProved ? " · " + word("proved") : ""}`);
}
const shown = {};
function setHtml(id, html) {
  if (shown[id] !== html) element(id).innerHTML = shown[id] = html;
}
function showProgress(share) {
  element("progress").value = share;
}

function showParameters() {
  for (const [name, { write, step }] of Object.entries(SLIDERS)) {
    const input = element(name), value = state.slider[name], text = name === "theta" && state.slider.weights ? "by hand" : write(value);
    input.value = step ? value : Math.log10(value);
    input.setAttribute("aria-valuetext", text);
    element(`${name}-value`).textContent = text;
  }
  element("ghost-name").textContent = `θ = ${fraction(state.ghost.slider.theta)}`;
  element("second-key").hidden = !state.twin;
  element("own-key").hidden = !own;
  for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", button.dataset.view === state.view);
}

function showStep() {
  for (const button of document.querySelectorAll("[data-step]")) button.setAttribute("aria-pressed", Number(button.dataset.step) === state.step);
  const step = STEPS[state.step - 1];
  setHtml("step", step ? `<h2>${step.title}</h2><p>${step.text()}</p>` : `<h2>Explore</h2><p>Move the sliders below, drag the normal loads by hand, or lay your own measurement over the curve. Start from a slider of the paper:</p><p class="bar">${sceneButtons()}`);
}

function goToStep(number) {
  stop();
  const step = STEPS[number - 1];
  Object.assign(state, { step: number, twin: step?.twin ?? false, pick: step?.pick ?? state.pick, view: step?.view ?? "first" });
  if (step) useScene(step.slider);
  else solve();
  showStep();
}
function useScene(scene) {
  Object.assign(state, { slider: { ...scene.slider }, wish: {}, ghost: scene });
  solve();
}

// Bars of the loads; they are made anew only when the number of blocks changes.
function showLoads() {
  const place = element("loads"), { weights, n } = runs[0], mean = state.slider.normal_load / n;
  if (!element("loads-part").open) return;
  if (place.children.length !== n) {
    place.innerHTML = weights.map((_, i) => `<label><input type="range" step="${mean / 40}" data-load="${i}" aria-label="normal load of block ${i + 1}"><output></output></label>`).join("");
  }
  weights.forEach((load, i) => {
    const [input, output] = place.children[i].children;
    Object.assign(input, { min: mean / 40, max: 3 * mean });
    if (document.activeElement !== input) input.value = load;
    output.textContent = `${load.toFixed(load < 10 ? 1 : 0)} N`;
    input.setAttribute("aria-valuetext", `${load.toFixed(1)} N`);
  });
}

// Choose an event and look at its onset.
function choose(number) {
  stop();
  Object.assign(state, { event: number, pick: null, time: runs[0].events[number].onset });
  if (state.view !== "event") {
    const { start, end } = view();
    if (state.time < start || state.time > end) state.view = "all";
  }
  showParameters();
  keepState();
  redraw("load", "slips", "lengths", "row");
}
function move(by) {
  const { events } = runs[0];
  if (events.length) choose(state.event === null ? 0 : Math.min(Math.max(state.event + by, 0), events.length - 1));
}

function play() {
  if (playing) return stop();
  state.pick = null;
  let { end } = view(), before = performance.now(), wall = along(film.time, film.wall, Math.max(state.time, view().start));
  if (state.time >= Math.min(end, runs[0].end) - 1e-12) wall = along(film.time, film.wall, view().start);
  const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const frame = (now) => {
    const passed = Math.min(Math.max(now - before, 0), 100) / 1000, at = lowerBound(film.wall, wall);
    // Less motion: from the onset of an event to its end and on to the next, a second each.
    if (isCalm && now - before < 1000) return (playing = requestAnimationFrame(frame));
    before = now;
    wall = isCalm ? film.wall[Math.min(at + (film.wall[at] <= wall ? 1 : 0), film.wall.length - 1)] : wall + passed;
    const next = Math.floor((lowerBound(film.wall, wall) - 1) / 2);
    if (runs[0].events[next]) askMotion(next);
    state.time = Math.min(along(film.wall, film.time, wall), end);
    redraw("row");
    if (state.time >= Math.min(end, runs[0].end) || wall >= film.wall.at(-1)) return stop();
    playing = requestAnimationFrame(frame);
  };
  playing = requestAnimationFrame(frame);
  element("play").textContent = "❚❚ Pause";
}
function stop() {
  if (playing) cancelAnimationFrame(playing);
  playing = null;
  element("play").textContent = "▶ Play";
  redraw("row", "lengths");
}

function setView(next) {
  state.view = next;
  showParameters();
  keepState();
  redraw("load", "slips", "row");
}
function zoom(factor, around = state.time) {
  const { start, end } = view(), span = Math.min(Math.max((end - start) * factor, NARROWEST), DURATION);
  const share = Math.min(Math.max((around - start) / (end - start), 0), 1), from = Math.min(Math.max(around - share * span, 0), DURATION - span);
  setView({ start: from, end: from + span });
}

// The state is in the address; what is there but makes no sense is ignored.
function keepState() {
  const kept = new URLSearchParams(Object.keys(SLIDERS).map((name) => [name, state.slider[name]]));
  if (state.slider.weights) kept.set("loads", loads().join(","));
  kept.set("step", state.step);
  if (state.twin) kept.set("twin", 1);
  kept.set("view", typeof state.view === "string" ? state.view : `${state.view.start},${state.view.end}`);
  if (state.event !== null && !state.pick) kept.set("event", state.event + 1);
  history.replaceState(null, "", `#${kept}`);
}
function restoreState() {
  const kept = new URLSearchParams(location.hash.slice(1)), numbers = (name) => (kept.get(name) ?? "").split(",").map(Number);
  for (const [name, { low, high }] of Object.entries(SLIDERS)) {
    const value = Number(kept.get(name));
    if (kept.get(name) && value >= low && value <= high) state.slider[name] = name === "n_blocks" ? Math.round(value) : value;
  }
  state.slider.mu_k = Math.min(state.slider.mu_k, state.slider.mu_s);
  if (kept.has("loads") && numbers("loads").length <= SLIDERS.n_blocks.high && numbers("loads").every((load) => load > 0 && load < 1e6)) {
    Object.assign(state.slider, { weights: numbers("loads"), n_blocks: numbers("loads").length });
  }
  if (kept.has("step")) state.step = Math.min(Math.max(Math.round(Number(kept.get("step"))) || 0, 0), STEPS.length);
  state.pick = STEPS[state.step - 1]?.pick ?? null;
  state.twin = kept.get("twin") === "1";
  const [start, end] = numbers("view");
  if (["first", "all", "event"].includes(kept.get("view"))) state.view = kept.get("view");
  else if (start >= 0 && end > start && end <= DURATION) state.view = { start, end };
  if (Number(kept.get("event")) >= 1) [state.event, state.pick] = [Math.round(Number(kept.get("event"))) - 1, null];
  state.ghost = SCENES.find(isScene) ?? nearTheta(state.slider.theta);
}

const loads = () => state.slider.weights.map((load) => Number(load.toPrecision(6)));
// The command that draws this run.
function command() {
  const names = { theta: "theta", n_blocks: "blocks", mu_s: "mu-s", mu_k: "mu-k", normal_load: "normal-load", drive_stiffness: "drive-stiffness", drive_velocity: "drive-velocity", slider_mass: "slider-mass", youngs_modulus: "youngs-modulus", cross_section: "cross-section", length: "length" };
  const options = Object.entries(names).filter(([name]) => !(state.slider.weights && ["theta", "n_blocks", "normal_load"].includes(name)));
  const text = options.map(([name, option]) => ` --${option} ${state.slider[name]}`).join("");
  return state.slider.weights ? `echo "${loads().join(" ")}" > loads.txt && precursors plot --weights loads.txt${text}` : `precursors plot${text}`;
}
async function copy(text) {
  const isCopied = await navigator.clipboard?.writeText(text).then(() => true, () => false);
  element("told").textContent = `${isCopied ? "Copied:" : "Copy this:"} ${text}`;
}
function savePicture() {
  const names = ["row", "load", "slips", "lengths"], sheets = names.map(element), width = Math.max(...sheets.map((sheet) => sheet.width));
  const whole = document.createElement("canvas"), context = whole.getContext("2d");
  whole.width = width;
  whole.height = sheets.reduce((sum, sheet) => sum + sheet.height, 0);
  context.fillStyle = palette.paper;
  context.fillRect(0, 0, whole.width, whole.height);
  sheets.reduce((y, sheet) => (context.drawImage(sheet, 0, y), y + sheet.height), 0);
  const anchor = Object.assign(document.createElement("a"), { href: whole.toDataURL(), download: "precursors.png" });
  anchor.click();
  element("told").textContent = "The figures are saved as precursors.png.";
}
function showMeasurement({ time, load, problem }) {
  own = problem ? own : { time, load };
  element("forget").hidden = !own;
  element("told").textContent = problem ?? `${time.length.toLocaleString("en")} points from ${time[0]} s to ${time.at(-1)} s.`;
  showParameters();
  redraw("load");
}

function build() {
  setHtml("steps", STEPS.map((step, i) => `<button type="button" data-step="${i + 1}" title="${step.title}" aria-label="Step ${i + 1}: ${step.title}">${i + 1}</button>`).join("") + `<button type="button" data-step="0">Explore</button>`);
  setHtml("sliders", Object.entries(SLIDERS).map(([name, { symbol, low, high, step, about }]) =>
    `<div class="slider"><button type="button" class="why" aria-describedby="tip-${name}">${symbol}</button><span class="tip" role="tooltip" id="tip-${name}">${about}</span>
    <input type="range" id="${name}" aria-label="${symbol.replace(/<\/?sub>/g, "")}" min="${step ? low : Math.log10(low)}" max="${step ? high : Math.log10(high)}" step="${step ?? 0.01}"><output id="${name}-value" for="${name}"></output></div>`).join(""));
}

function setSlider(name, position) {
  const { step } = SLIDERS[name], value = step ? position : Number((10 ** position).toPrecision(2));
  // The other coefficient of friction gives way, and comes back when it can.
  if (name === "mu_s" || name === "mu_k") {
    const other = name === "mu_s" ? "mu_k" : "mu_s", wish = (state.wish[other] ??= state.slider[other]);
    state.slider[other] = name === "mu_s" ? Math.min(wish, value) : Math.max(wish, value);
    delete state.wish[name];
  }
  if (name === "theta" || name === "n_blocks") state.slider.weights = null;
  state.slider[name] = value;
}

function listen() {
  const on = (id, type, does) => element(id).addEventListener(type, does);
  on("sliders", "input", ({ target }) => (setSlider(target.id, Number(target.value)), solve(true)));
  on("sliders", "change", () => solve());
  on("sliders", "submit", (happened) => happened.preventDefault());
  on("loads", "input", ({ target }) => {
    state.slider.weights = runs[0].weights.with(target.dataset.load, Number(target.value));
    solve(true);
  });
  on("loads", "change", () => solve());
  on("loads-part", "toggle", () => runs[0] && showLoads());
  on("steps", "click", ({ target }) => target.dataset.step && goToStep(Number(target.dataset.step)));
  on("step", "click", ({ target }) => target.dataset.scene && useScene(SCENES[target.dataset.scene]));
  on("previous", "click", () => move(-1));
  on("next", "click", () => move(1));
  on("play", "click", play);
  on("scrubber", "input", ({ target }) => {
    const { start, end } = view(), [low, high] = [start, end].map((t) => along(film.time, film.wall, t));
    stop();
    Object.assign(state, { pick: null, time: along(film.wall, film.time, low + ((high - low) * target.value) / 1000) });
  });
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => setView(button.dataset.view));
  on("closer", "click", () => zoom(0.4));
  on("wider", "click", () => zoom(2.5));
  const timeOf = (happened) => view().start + ((happened.offsetX - shares.box.left) / (shares.box.right - shares.box.left)) * (view().end - view().start);
  for (const id of ["load", "slips"]) {
    on(id, "click", (happened) => {
      const time = timeOf(happened), reach = (REACH / (shares.box.right - shares.box.left)) * (view().end - view().start);
      const far = runs[0].events.map(({ onset, end }) => Math.max(onset - time, time - end, 0)), best = far.indexOf(Math.min(...far));
      if (far[best] > reach || state.view === "event") return stop(), (state.time = Math.min(Math.max(time, 0), runs[0].end));
      state.view = "event";
      choose(best);
    });
    element(id).addEventListener("wheel", (happened) => {
      if (!happened.ctrlKey && !happened.metaKey) return; // the wheel alone scrolls the page
      happened.preventDefault();
      zoom(1.25 ** Math.sign(happened.deltaY), timeOf(happened));
    }, { passive: false });
  }
  on("lengths", "click", ({ offsetX, offsetY }) => {
    const far = marks.map(([x, y]) => Math.hypot(x - offsetX, y - offsetY)), best = far.indexOf(Math.min(...far));
    if (!(far[best] <= REACH)) return;
    state.view = "event";
    choose(best);
  });
  on("own", "change", async ({ target }) => {
    worker.postMessage({ text: await target.files[0].text() });
    target.value = "";
  });
  on("forget", "click", () => ((own = null), (element("forget").hidden = true), (element("told").textContent = ""), showParameters(), redraw("load")));
  on("reset", "click", () => ((element("told").textContent = ""), goToStep(state.step || 1)));
  on("link", "click", () => (keepState(), copy(location.href)));
  on("command", "click", () => copy(command()));
  on("picture", "click", savePicture);
  document.addEventListener("keydown", (happened) => {
    if (happened.key === "Escape") return document.body.classList.add("dismissed");
    if (happened.target.closest("input, summary") || happened.ctrlKey || happened.altKey || happened.metaKey) return;
    const does = { ArrowLeft: () => move(-1), ArrowRight: () => move(1), " ": happened.target.closest("button") ? null : play }[happened.key];
    if (does) happened.preventDefault(), does();
  });
  for (const type of ["pointerover", "focusin"]) document.addEventListener(type, () => document.body.classList.remove("dismissed"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => (readPalette(), redraw(...Object.keys(DRAW))));
  new ResizeObserver(() => redraw(...Object.keys(DRAW))).observe(document.querySelector("main"));
}

// A worker from a blob: a page that is opened as a file may not start one from another file.
worker = new Worker(URL.createObjectURL(new Blob([SCRIPT], { type: "text/javascript" })));
worker.onmessage = hear;
worker.onerror = (error) => (element("answers").textContent = `The solver has stopped: ${error.message ?? "this browser does not let the page start a worker"}.`);
readPalette();
build();
restoreState();
listen();
showStep();
solve();
