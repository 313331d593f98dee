// The page: its state, what is asked of the workers, and what the reader can do.

const element = (id) => document.getElementById(id);
const PACE = 4000; // s of film for a second of slip: 1 ms takes 4 s
const EVENT = [3, 20]; // s of film for one event, shortest where it is alone, and longest
const GAP = [0.4, 1.2]; // s of film for the time between two events, shortest and longest
const STALE = 300; // ms for which a slider may move on before the twin has been heard again
const TWIN = 10; // how much further apart a run and its twin are than rounding errors: see ROUNDINGS

const state = { slider: { ...UNIFORM.slider }, wish: {}, step: 1, pick: "partial", view: "first", event: null, time: 0 };
let run = null, twin = null, film = null, motions = new Map(), playing = null, isToPlay = false, shares = null, dirty = new Set(), wanted = null;
// What is asked of the workers: the request that they work on, the one that waits for it, and what they have told.
let asked = 0, current = null, waiting = null, told = [], heardTwin = 0;

const same = (slider) => !state.slider.weights && Object.keys(slider).every((name) => slider[name] === state.slider[name]);
const isCalm = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
const event = () => (state.event === null ? null : run?.events[state.event]);
const firstGlobal = (of = run) => of.events.find((event) => event.isGlobal);
const apparentIn = (of) => Math.max(0, ...of.counted.map((event) => event.before)) / of.weights.reduce((sum, load) => sum + load);
const ratio = () => (run ? apparentIn(run) : UNIFORM.mu_sapp)?.toFixed(4);

// Ask for the run of what is set: while a slider is held only up to the first global slip.
function solve(isHeld = false) {
  for (const id of ["answers", "readout", "step"]) element(id).setAttribute("aria-live", isHeld ? "off" : "polite");
  ask({ slider: state.slider, duration: DURATION, all: !isHeld });
  showParameters();
}
// A run is shown before the next one is begun: else a fast hand would see nothing. A study gives way at once.
function ask(request) {
  waiting = null;
  if (current && !current.study && !current.isShown) return (waiting = request);
  current = { ...request, id: ++asked };
  told = [];
  post(false);
  if (current.all || current.study) post(true);
}
function post(isTwin) {
  current.isTwinAsked = isTwin;
  workers[Number(isTwin)].postMessage({ ...current, isTwin });
}

function hear(isTwin, data) {
  if (data.kind === "motion") {
    if (data.id === run?.id) motions.set(data.event, data);
    return redraw("row", "stairs");
  }
  if (data.id !== current.id) return;
  if (data.kind === "progress") return isTwin || (element("progress").value = data.share);
  told[Number(isTwin)] = data;
  const [next, other] = told;
  if (!next || (!other && (current.all || current.study))) return;
  if (other) heardTwin = performance.now();
  else if (!current.isTwinAsked) post(true);
  // While a slider is held, the picture does not wait for the twin, and has the predictability of the one before.
  Object.assign(next, { counted: countedOf(next.events), known: other ? agreement(next, other) : run.known });
  current.isShown = Boolean(other) || performance.now() - heardTwin < STALE;
  if (current.study) noteInStudy(current.study, next), goOnWithStudy();
  else show(next, other);
  if (waiting && current.isShown) ask(waiting);
  else if (next.isFinal && other?.isFinal && !current.study) (element("progress").value = 0), goOnWithStudy();
}

// Until when a run and its twin have the same transitions, which come at the same time [s] to the tolerance.
function agreement(one, other) {
  // A block that lets go has no net force then, and whether it sticks again is a matter of rounding.
  if (one.slider.mu_k === one.slider.mu_s) return one.events[0]?.onset ?? Infinity;
  const [a, b] = [one.arrays, other.arrays], n = Math.min(a.time.length, b.time.length);
  let i = 0;
  while (i < n && a.block[i] === b.block[i] && a.mode[i] === b.mode[i] && Math.abs(a.time[i] - b.time[i]) < TWIN * TOLERANCE) i++;
  if (i === n && (a.time.length === b.time.length || !one.isFinal || !other.isFinal)) return Infinity;
  return Math.min(a.time[i] ?? Infinity, b.time[i] ?? Infinity);
}

function show(next, other) {
  if (next.id !== run?.id) motions.clear(), (wanted = null);
  [run, twin] = [next, other];
  magnify(run);
  film = filmOf(run);
  placeTime();
  showAnswers();
  showLoads();
  showStep();
  redraw(...Object.keys(DRAW));
  if (isToPlay && !isCalm()) play();
  isToPlay = false;
}

// The rows of Fig. 13: up to the first global slip, without events shorter than one before.
function countedOf(events) {
  let longest = 0;
  const end = events.findIndex((event) => event.isGlobal);
  return events.slice(0, end < 0 ? undefined : end + 1).filter((event) => event.front >= longest && (longest = event.front));
}

// The film: seconds at which each event starts and ends when the run is played.
function filmOf({ events, end }) {
  let wall = 0, before = 0;
  const knots = { time: [0], wall: [0] };
  const add = (time, lasts) => (knots.time.push(time), knots.wall.push((wall += lasts)));
  for (const one of events) {
    add(one.onset, Math.min(Math.max(2 * (one.onset - before), GAP[0]), GAP[1]));
    add((before = one.end), secondsOf(one));
  }
  add(end, GAP[1]);
  return knots;
}
const secondsOf = ({ onset, end }) => Math.min(Math.max((end - onset) * PACE, state.view === "event" ? EVENT[0] : 0), EVENT[1]);
function along(from, to, x) {
  const i = Math.min(Math.max(lowerBound(from, x), 1), from.length - 1), span = from[i] - from[i - 1];
  return to[i - 1] + (to[i] - to[i - 1]) * Math.min(Math.max((x - from[i - 1]) / (span || 1), 0), 1);
}

// Where a new run is looked at: the event that the step shows, or the same event and time as before.
function placeTime() {
  const { events, counted, end, isFinal } = run;
  const partial = counted.filter((event) => !event.isGlobal), middle = Math.max(Math.ceil(partial.length / 2) - 1, 0);
  const picked = { partial: partial[middle], longer: partial[Math.min(middle + 1, partial.length - 1)], global: firstGlobal() ?? counted.at(-1) }[state.pick];
  if (picked && !playing) [state.event, state.time] = [events.indexOf(picked), picked.onset];
  else if (state.event !== null && !playing) {
    // A run that is shown before it is solved may lack the event as yet.
    if (isFinal || firstGlobal()) state.event = events.length ? Math.min(state.event, events.length - 1) : null;
    state.time = event()?.onset ?? 0;
  }
  state.time = Math.min(state.time, end);
}

// Ask for the motion in an event, once; a worker follows one event at a time.
function askMotion(number) {
  if (motions.has(number) || number === wanted) return;
  wanted = number;
  const { onset, end, start } = run.events[number];
  workers[0].postMessage({ id: run.id, slider: run.slider, duration: DURATION, event: number, onset, end, start, force: restForces(number) });
}

function magnify(of) {
  of.highest = 1.02 * of.events.reduce((high, event) => Math.max(high, event.before), 1e-9);
  const most = (0.34 * of.slider.length) / of.n / (of.highest / of.k), power = 10 ** Math.floor(Math.log10(most));
  of.magnified = power * [5, 4, 3, 2, 1.5, 1].find((factor) => factor * power <= most);
}

const DRAW = { stairs: showStairs, slips: showSlips, lengths: showLengths, row: showRow };
// Draw in the next frame.
function redraw(...names) {
  if (!dirty.size) requestAnimationFrame(drawDirty);
  names.forEach((name) => dirty.add(name));
}
function drawDirty() {
  if (!run) return dirty.clear();
  const names = Object.keys(DRAW).filter((name) => dirty.has(name));
  dirty = new Set();
  names.forEach((name) => DRAW[name]());
  document.body.dataset.drawn = run.id;
}

function showAnswers() {
  const slip = firstGlobal(), word = (name) => explained("answers", name), isLost = slip ? slip.onset >= run.known : run.known <= run.end;
  const stopped = run.stopped ? `Stopped at ${quantity(run.end, "s")}, after very many transitions. ` : "";
  const result = slip
    ? `${counts(run.counted.length, "event")}, counted as in ${word("fig13")} · ${word("apparent")} = ${ratio()} · first global slip at ${quantity(slip.onset, "s")}`
    : `No global slip ${run.stopped ? "until then" : run.end < DURATION ? "so far" : `in ${DURATION} s`} · largest load ${ratio()} F<sub>Z</sub>`;
  const isProved = slip && PROVED.some((one) => same(one.slider) && slip.end <= one.duration);
  const until = Math.min(run.known, run.end), reach = run.known < run.end ? `until ${quantity(until, "s")}, where rounding errors take over` : `for all of its ${quantity(until, "s")}`;
  setHtml("answers", `${result}${isProved ? ` · ${word("proved")}` : ""}`);
  setHtml("trust", stopped + (isLost ? `Beyond ${quantity(until, "s")} not ${word("predictable")} in double precision; ${slip ? word("apparent") : "the load"} of this run is one draw.` : `The motion is ${word("predictable")} ${reach}.`));
  element("answers").classList.toggle("lost", isLost);
}
const shown = {};
function setHtml(id, html) {
  if (shown[id] !== html) element(id).innerHTML = shown[id] = html;
}

function showParameters() {
  for (const [name, { write, step }] of Object.entries(SLIDERS)) {
    const input = element(name), value = state.slider[name], text = name === "theta" && state.slider.weights ? "by hand" : write(value);
    input.value = step ? value : Math.log10(value);
    input.setAttribute("aria-valuetext", text);
    element(`${name}-value`).textContent = text;
  }
  for (const button of document.querySelectorAll("[data-view]")) button.setAttribute("aria-pressed", button.dataset.view === state.view);
}

// All steps lie in one place, so that nothing below them moves; only one is seen.
function showStep() {
  for (const button of document.querySelectorAll("[data-step]")) button.setAttribute("aria-pressed", Number(button.dataset.step) === state.step);
  for (const [i, { title, text }] of STEPS.entries()) {
    const id = `step-${i + 1}`, isSeen = i + 1 === state.step;
    element(id).classList.toggle("seen", isSeen);
    if (isSeen || !shown[id]) setHtml(id, `<h2>${title}</h2><p>${text((name) => explained(id, name))}</p>`);
  }
  for (const button of document.querySelectorAll("[data-theta]")) {
    const theta = Number(button.dataset.theta), { value } = found.tilts[THETAS.indexOf(theta)] ?? {};
    button.setAttribute("aria-pressed", state.slider.theta === theta && !state.slider.weights);
    button.textContent = `θ = ${fraction(theta)}\n${value?.toFixed(4) ?? "…"}`;
  }
}

function goToStep(number) {
  stop();
  const { scene, blocks = scene.slider.n_blocks, pick, view = "first", plays = false } = STEPS[number - 1];
  Object.assign(state, { step: number, pick, view });
  isToPlay = plays;
  useSlider({ ...scene.slider, n_blocks: blocks });
  showStep();
}
function useSlider(slider) {
  Object.assign(state, { slider: { ...slider }, wish: {} });
  solve();
}

// Bars of the loads; they are made anew only when the number of blocks changes.
function showLoads() {
  const place = element("loads"), { weights, n } = run, mean = state.slider.normal_load / n;
  if (!element("loads-part").open) return;
  if (place.children.length !== n) {
    place.innerHTML = weights.map((_, i) => `<label><input type="range" step="${mean / 40}" data-load="${i}" aria-label="normal load of block ${i + 1}"><output></output></label>`).join("");
  }
  weights.forEach((load, i) => {
    const [input, output] = place.children[i].children;
    Object.assign(input, { min: mean / 40, max: 3 * mean });
    if (document.activeElement !== input) input.value = load;
    output.textContent = quantity(load, "N");
    input.setAttribute("aria-valuetext", quantity(load, "N"));
  });
}

// Choose an event and look at its onset; alone, it is played.
function choose(number) {
  stop();
  Object.assign(state, { event: number, pick: null, time: run.events[number].onset });
  if (state.view === "first" && state.time > view().end) state.view = "all";
  setView(state.view);
  if (state.view === "event" && !isCalm()) play();
}
function move(by) {
  const { events } = run;
  if (events.length) choose(state.event === null ? 0 : Math.min(Math.max(state.event + by, 0), events.length - 1));
}
function setView(next) {
  state.view = next;
  film = run && filmOf(run);
  showParameters();
  redraw(...Object.keys(DRAW));
}

function play() {
  if (playing) return stop();
  state.pick = null;
  const { start, end } = played();
  let before = performance.now(), wall = along(film.time, film.wall, state.time < end - 1e-12 ? Math.max(state.time, start) : start);
  const frame = (now) => {
    const passed = Math.min(Math.max(now - before, 0), 100) / 1000, at = lowerBound(film.wall, wall);
    // Less motion: from the onset of an event to its end and on to the next, a second each.
    if (isCalm() && now - before < 1000) return (playing = requestAnimationFrame(frame));
    before = now;
    wall = isCalm() ? film.wall[Math.min(at + (film.wall[at] <= wall ? 1 : 0), film.wall.length - 1)] : wall + passed;
    const next = Math.floor((lowerBound(film.wall, wall) - 1) / 2);
    if (run.events[next]) askMotion(next);
    state.time = Math.min(along(film.wall, film.time, wall), end);
    redraw("row");
    if (state.time >= end || wall >= film.wall.at(-1)) return stop();
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

// The command that draws this run.
function command() {
  const names = { theta: "theta", n_blocks: "blocks", mu_s: "mu-s", mu_k: "mu-k", normal_load: "normal-load", drive_stiffness: "drive-stiffness", drive_velocity: "drive-velocity", slider_mass: "slider-mass", youngs_modulus: "youngs-modulus", cross_section: "cross-section", length: "length" };
  const options = Object.entries(names).filter(([name]) => !(state.slider.weights && ["theta", "n_blocks", "normal_load"].includes(name)));
  const text = options.map(([name, option]) => ` --${option} ${state.slider[name]}`).join("");
  return state.slider.weights ? `printf "%s\\n" ${state.slider.weights.map((load) => Number(load.toPrecision(6))).join(" ")} > loads.txt && precursors plot --weights loads.txt${text}` : `precursors plot${text}`;
}
async function copy(text) {
  const isCopied = await navigator.clipboard?.writeText(text).then(() => true, () => false);
  element("told").textContent = `${isCopied ? "Copied:" : "Copy this:"} ${text}`;
}

function build() {
  setHtml("steps", STEPS.map(({ title }, i) => `<button type="button" data-step="${i + 1}" aria-label="Step ${i + 1}: ${title}">${i + 1}</button>`).join(""));
  setHtml("step", STEPS.map((_, i) => `<div id="step-${i + 1}"></div>`).join(""));
  setHtml("sliders", Object.entries(SLIDERS).map(([id, { symbol, name, low, high, step, about }]) =>
    `<div class="slider"><button type="button" class="why" aria-describedby="tip-${id}">${symbol}</button><span class="tip" role="tooltip" id="tip-${id}">${about}</span>
    <input type="range" id="${id}" aria-label="${name}" min="${step ? low : Math.log10(low)}" max="${step ? high : Math.log10(high)}" step="${step ?? 0.01}"><output id="${id}-value" for="${id}"></output></div>`).join(""));
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
  on("loads", "input", ({ target }) => {
    state.slider.weights = run.weights.with(target.dataset.load, Number(target.value));
    solve(true);
  });
  for (const id of ["sliders", "loads"]) on(id, "change", () => solve());
  on("loads-part", "toggle", () => run && showLoads());
  on("steps", "click", ({ target }) => target.dataset.step && goToStep(Number(target.dataset.step)));
  on("step", "click", ({ target }) => target.dataset.theta && useSlider({ ...UNIFORM.slider, theta: Number(target.dataset.theta) }));
  on("previous", "click", () => move(-1));
  on("next", "click", () => move(1));
  on("play", "click", play);
  on("scrubber", "input", ({ target }) => {
    const [low, high] = [played().start, played().end].map((t) => along(film.time, film.wall, t));
    stop();
    Object.assign(state, { pick: null, time: along(film.wall, film.time, low + ((high - low) * target.value) / 1000) });
  });
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => setView(button.dataset.view));
  const closeUp = (number) => ((state.view = "event"), choose(number));
  for (const id of ["stairs", "slips"]) {
    on(id, "click", ({ offsetX }) => {
      const { start, end } = view(), perPixel = (end - start) / (shares.box.right - shares.box.left), time = start + (offsetX - shares.box.left) * perPixel;
      const far = run.events.map(({ onset, end }) => Math.max(onset - time, time - end, 0)), best = far.indexOf(Math.min(...far));
      if (far[best] <= REACH * perPixel && state.view !== "event") return closeUp(best);
      stop();
      state.time = Math.min(Math.max(time, 0), run.end);
    });
  }
  on("lengths", "click", ({ offsetX, offsetY }) => {
    const far = marks.map(([x, y]) => Math.hypot(x - offsetX, y - offsetY)), best = far.indexOf(Math.min(...far));
    if (far[best] <= REACH) closeUp(best);
  });
  on("command", "click", () => copy(command()));
  document.addEventListener("keydown", (happened) => {
    if (happened.key === "Escape") return document.body.classList.add("dismissed");
    if (happened.target.closest("input, summary") || happened.ctrlKey || happened.altKey || happened.metaKey) return;
    const does = { ArrowLeft: () => move(-1), ArrowRight: () => move(1), " ": happened.target.closest("button") ? null : play }[happened.key];
    if (does) happened.preventDefault(), does();
  });
  for (const type of ["pointerover", "focusin"]) document.addEventListener(type, () => document.body.classList.remove("dismissed"));
  const recolour = () => (readPalette(), redraw(...Object.keys(DRAW)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour);
  // On paper the colours are those of the light page.
  for (const [type, isPrint] of [["beforeprint", true], ["afterprint", false]]) {
    window.addEventListener(type, () => (document.documentElement.classList.toggle("print", isPrint), recolour(), drawDirty()));
  }
  new ResizeObserver(() => redraw(...Object.keys(DRAW))).observe(document.querySelector("main"));
}

// Workers from a blob: a page that is opened as a file may not start one from another file.
const workers = [false, true].map((isTwin) => {
  const worker = new Worker(URL.createObjectURL(new Blob([element("worker").textContent], { type: "text/javascript" })));
  worker.onmessage = ({ data }) => hear(isTwin, data);
  worker.onerror = (error) => (element("answers").textContent = `The solver has stopped: ${error.message ?? "this browser does not let the page start a worker"}.`);
  return worker;
});
readPalette();
build();
listen();
goToStep(1);
