// The page: its state, its requests to the worker, and its reactions to the reader.

const element = (id) => document.getElementById(id);
const PACE = 4000; // slow motion of slips: 1 ms takes 4 s of film
const EVENT = [3, 20]; // s of film for one event: shortest (if shown alone) and longest
const GAP = [0.4, 1.2]; // s of film between two events: shortest and longest
const PAUSE = 1.5; // s before the film of a step is repeated

const state = {
  slider: { ...UNIFORM.slider }, wish: {}, // values now, and those to return to
  step: 1, pick: "partial", view: "first", event: null, time: 0,
  playing: null, isToPlay: false, repeats: false, // whether the film plays and repeats
};
let run = null; // the run shown, with its film and its motions
let request = null; // the current request to the worker, with the one that follows
const dirty = new Set(); // figures to draw in the next frame
const shown = {}; // HTML of elements by id

const isCalm = () => matchMedia("(prefers-reduced-motion: reduce)").matches;
const event = () => (state.event === null ? null : run?.events[state.event]);
const firstGlobal = () => run.events.find(of("isGlobal"));
const reel = () => [played().start, played().end].map(inFilm); // s of film, ends
const isStudied = () => document.body.dataset.study !== "";
const apparent = () => Math.max(0, ...run.counted.map(of("before"))) / run.slider.normal_load;

// Request the run of the current values; while a slider is held, up to the first global slip only.
function solve(isHeld = false) {
  for (const id of ["answers", "readout", "step"]) {
    element(id).setAttribute("aria-live", isHeld ? "off" : "polite");
  }
  const id = (request?.id ?? 0) + 1, { theta } = state.slider;
  const isOfMeans = isStudied() && STEPS[state.step - 1].study === drawMeans;
  const thetas = isOfMeans ? [theta, 0, -theta] : [theta];
  const sliders = thetas.map((theta) => ({ ...state.slider, theta })), all = !isHeld || isOfMeans;
  const next = { id, sliders, duration: DURATION, tolerance: TOLERANCE, all };
  if (!isHeld) writeAddress();
  // A run is shown before the next one begins, or a fast drag would show nothing.
  if (request && !request.isShown) request.next = next;
  else begin(next);
  showParameters();
}
function begin(next) {
  request = next;
  worker.postMessage(request);
}

function receive(data) {
  if (data.kind === "motion") {
    if (data.id === run.id) run.motions.set(data.event, data);
    redraw("row", "load");
  } else if (data.id === request.id) {
    const { next, moves } = request;
    show(data);
    request.isShown = true;
    if (next) begin({ ...next, moves });
    else if (moves) delete request.moves, move(moves);
  }
}

function show(next) {
  const { id, isFinal, runs: loadings } = next, [own] = loadings;
  const { motions, wanted, isPlaced } = id === run?.id ? run : { motions: new Map() };
  run = { ...own, id, isFinal, loadings, motions, wanted, isPlaced, counted: countedOf(own.events) };
  run.highest = 1.02 * Math.max(1e-9, ...run.events.map(of("before")));
  run.film = filmOf(run);
  placeTime();
  showAnswers();
  showStep();
  redraw();
  if (state.isToPlay && !isCalm()) play();
  state.isToPlay = false;
}

// The events counted in Fig. 13: without events shorter than an earlier one.
function countedOf(events) {
  let longest = 0;
  return upToGlobal(events).filter(({ front }) => front >= longest && (longest = front));
}
function upToGlobal(events) {
  const end = events.findIndex(of("isGlobal"));
  return end < 0 ? events : events.slice(0, end + 1);
}

// The film: its time [s] at the start and at the end of each event.
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
function secondsOf({ onset, end }) {
  const least = state.view === "event" ? EVENT[0] : 0;
  return Math.min(Math.max((end - onset) * PACE, least), EVENT[1]);
}
function along(from, to, x) {
  const i = Math.min(Math.max(lowerBound(from, x), 1), from.length - 1);
  const share = (x - from[i - 1]) / (from[i] - from[i - 1] || 1);
  return to[i - 1] + (to[i] - to[i - 1]) * Math.min(Math.max(share, 0), 1);
}
const inFilm = (time) => along(run.film.time, run.film.wall, time);
const inRun = (wall) => along(run.film.wall, run.film.time, wall);

// Set event and time in a new run: the event of the step, or the same event and time as before.
function placeTime() {
  const { events, counted, end, isFinal } = run;
  if (!state.playing) {
    const global = firstGlobal() ?? counted.at(-1);
    const partial = counted.filter((one) => !one.isGlobal);
    const middle = Math.max(Math.ceil(partial.length / 2) - 1, 0);
    const longer = partial[Math.min(middle + 1, partial.length - 1)];
    const picked = { partial: partial[middle], longer, global }[state.pick];
    if (picked) state.event = events.indexOf(picked);
    // An incomplete run may not have the event yet.
    else if (isFinal || firstGlobal()) state.event = clamp(state.event);
    if (event() && (picked || !run.isPlaced)) {
      state.time = event().onset;
      run.isPlaced = true;
    }
  }
  state.time = Math.min(state.time, end);
}
// The nearest valid number of an event, or null.
const clamp = (number) => (number === null || !run.events.length ? null
  : Math.min(Math.max(number, 0), run.events.length - 1));

// Request the motion in an event, once; the worker computes one at a time.
function askMotion(number) {
  if (run.motions.has(number) || number === run.wanted) return;
  run.wanted = number;
  worker.postMessage({ id: run.id, event: number });
}

const DRAW = {
  slips: showSlips, load: showLoad, lengths: showLengths, row: showRow, study: showStudy,
};
// Draw figures in the next frame, by default all.
function redraw(...names) {
  for (const name of names.length ? names : Object.keys(DRAW)) dirty.add(name);
  requestAnimationFrame(drawDirty);
}
function drawDirty() {
  const names = Object.keys(DRAW).filter((name) => dirty.delete(name));
  if (run) names.forEach((name) => DRAW[name]());
}

function showAnswers() {
  const { known, end, stopped, counted, slider } = run, slip = firstGlobal();
  const word = (name) => explained("answers", name), until = quantity(Math.min(known, end), "s");
  const isLost = slip ? slip.onset >= known : known <= end;
  const isSame = (one) => Object.keys(one).every((key) => one[key] === slider[key]);
  const isProved = PROVED.some((one) => isSame(one.slider) && slip?.end <= one.duration);
  const searched = stopped ? "until then" : end < DURATION ? "so far" : `in ${DURATION} s`;
  setHtml("answers", !slip ? `No global slip ${searched} · largest push ${ratio()} F_Z`
    : `${counts(counted.length, "event")}, counted as in ${word("fig13")} · ${word("apparent")} =
      ${ratio()} · first global slip at ${quantity(slip.onset, "s")}
      ${isProved ? ` · ${word("proved")}` : ""}`);
  const lost = `The motion is not ${word("predictable")} beyond ${until} in double precision;
    ${slip ? word("apparent") : "the push"} of this run is one draw of many.`;
  const reach = known < end ? `until ${until}, where rounding errors take over`
    : `for all of its ${until}`;
  setHtml("trust", (stopped ? `Stopped at ${quantity(end, "s")}, after many transitions. ` : "") +
    (isLost ? lost : `The motion is ${word("predictable")} ${reach}.`));
  element("answers").classList.toggle("lost", isLost);
}
// Set the HTML of an element; returns whether it has changed.
function setHtml(id, html) {
  if (shown[id] === html) return false;
  shown[id] = html;
  element(id).innerHTML = marked(html);
  return true;
}

function setPressed(query, isPressed) {
  for (const button of document.querySelectorAll(query)) {
    button.setAttribute("aria-pressed", isPressed(button.dataset));
  }
}
function showParameters() {
  for (const [name, { write, step }] of Object.entries(SLIDERS)) {
    const input = element(name), value = state.slider[name], text = write(value);
    input.value = step ? value : Math.log10(value);
    input.setAttribute("aria-valuetext", text);
    element(`${name}-value`).textContent = text;
  }
  element("command").textContent = command();
  setPressed("[data-view]", ({ view }) => view === state.view);
  setPressed("[data-theta]", ({ theta }) => Number(theta) === state.slider.theta);
  setPressed("[data-step]", ({ step }) => Number(step) === state.step);
}

// All steps are in the same place, so that nothing below them moves; only one is visible.
function showStep() {
  for (const [i, { title, text }] of STEPS.entries()) {
    const id = `step-${i + 1}`, isSeen = i + 1 === state.step;
    element(id).classList.toggle("seen", isSeen);
    if (!isSeen && shown[id]) continue;
    setHtml(id, `<h2>${title}</h2><p>${text((name) => explained(id, name))}</p>`);
  }
  element("onward").disabled = state.step === STEPS.length;
  delete shown.readout;
  showParameters();
}

function goToStep(number) {
  stop();
  const { scene, pick, view = "first", plays = false, study, shows = "all" } = STEPS[number - 1];
  Object.assign(state, { step: number, pick, view, isToPlay: plays, repeats: plays });
  Object.assign(document.body.dataset, { shows, study: study?.name ?? "", lit: "" });
  useSlider(scene.slider);
  showStep();
}
function useSlider(slider) {
  Object.assign(state, { slider: { ...slider }, wish: {} });
  solve();
}

// Select an event and show its onset, or animate it if it is shown alone. The row replaces a study.
function choose(number) {
  stop();
  document.body.dataset.study = "";
  Object.assign(state, { event: number, pick: null, time: run.events[number].onset });
  if (state.view === "first" && state.time > view().end) state.view = "all";
  setView(state.view);
  if (state.view === "event" && !isCalm()) play();
  writeAddress();
}
// Select another event. A key that is pressed before the run of the step is there waits for it.
function move(by) {
  if (!request.isShown) return (request.moves = (request.moves ?? 0) + by);
  const next = clamp(state.event === null ? 0 : state.event + by);
  if (next !== null) choose(next);
}
function setView(next) {
  state.view = next;
  run.film = filmOf(run);
  showParameters();
  redraw();
}

function play() {
  if (state.playing) return stop();
  state.pick = null;
  const { film } = run, { start, end } = played(), [first, last] = reel();
  let before = performance.now();
  let wall = state.time < end - 1e-12 ? inFilm(Math.max(state.time, start)) : first;
  const frame = (now) => {
    state.playing = requestAnimationFrame(frame);
    const passed = Math.max(now - before, 0) / 1000;
    // With reduced motion: onsets and ends of events only, one each second.
    if (isCalm() && passed < 1) return;
    before = now;
    wall = isCalm() ? film.wall[lowerBound(film.wall, wall + 1e-9)] ?? last
      : wall + Math.min(passed, 0.1);
    const next = Math.floor((lowerBound(film.wall, wall) - 1) / 2);
    if (run.events[next]) askMotion(next);
    state.time = Math.min(inRun(wall), end);
    redraw("row");
    if (wall >= last && !state.repeats) stop();
    else if (wall >= last + PAUSE) wall = first;
  };
  state.playing = requestAnimationFrame(frame);
  element("play").textContent = "❚❚ Pause";
}
function stop() {
  if (state.playing) cancelAnimationFrame(state.playing);
  Object.assign(state, { playing: null, repeats: false });
  element("play").textContent = "▶ Play";
  redraw("row", "lengths");
}

// The command that draws the same run.
const optionOf = (name) => name.replace("n_", "").replaceAll("_", "-");
const command = () => `precursors plot${Object.entries(state.slider).map(([name, value]) =>
  ` --${optionOf(name)} ${value}`).join("")}`;

function build() {
  setHtml("steps", STEPS.map(({ name, title }, i) => `<button type="button" data-step="${i + 1}"
    aria-label="${name}: ${title}">${name}</button>`).join("") +
    `<button type="button" class="strong" id="onward" aria-label="Next step">Next</button>`);
  setHtml("step", STEPS.map((_, i) => `<div id="step-${i + 1}"></div>`).join(""));
  setHtml("sliders", Object.entries(SLIDERS).map(([id, { symbol, name, range, step, about }]) => {
    const [low, high] = step ? range : range.map(Math.log10);
    return `<label title="${plain(about)}"><b>${symbol}</b> <output id="${id}-value"></output>
      <input type="range" id="${id}" aria-label="${name}"
      min="${low}" max="${high}" step="${step ?? 0.01}"></label>`;
  }).join(""));
}

function setSlider(name, position) {
  const value = SLIDERS[name].step ? position : Number((10 ** position).toPrecision(2));
  // The other coefficient of friction gives way, and returns to its value when it can.
  const other = { mu_s: "mu_k", mu_k: "mu_s" }[name];
  if (other) {
    const wish = (state.wish[other] ??= state.slider[other]);
    state.slider[other] = name === "mu_s" ? Math.min(wish, value) : Math.max(wish, value);
    delete state.wish[name];
  }
  state.slider[name] = value;
}

// Open the event nearest to a click, if it is near enough; `far` are the distances [px].
function openNearest(far) {
  const best = far.indexOf(Math.min(...far)), isNear = far[best] <= REACH;
  if (isNear) (state.view = "event"), choose(best);
  return isNear;
}

function listen() {
  const on = (id, type, does) => element(id).addEventListener(type, does);
  on("sliders", "input", ({ target }) => {
    document.body.dataset.shows = "all";
    setSlider(target.id, Number(target.value));
    solve(true);
  });
  on("sliders", "change", () => solve());
  on("steps", "click", ({ target: { id, dataset } }) => {
    if (id === "onward" || dataset.step) goToStep(Number(dataset.step ?? state.step + 1));
  });
  on("step", "click", ({ target: { dataset: { theta } } }) =>
    theta && useSlider({ ...UNIFORM.slider, theta: Number(theta) }));
  on("previous", "click", () => move(-1));
  on("next", "click", () => move(1));
  on("play", "click", play);
  on("scrubber", "input", ({ target }) => {
    const [low, high] = reel();
    stop();
    Object.assign(state, { pick: null, time: inRun(low + ((high - low) * target.value) / 1000) });
  });
  on("views", "click", ({ target: { dataset } }) => dataset.view && setView(dataset.view));
  for (const id of ["load", "slips"]) {
    on(id, "click", ({ offsetX }) => {
      const { start, end } = view(), { left, right } = chart.time.box;
      const perPixel = (end - start) / (right - left), time = start + (offsetX - left) * perPixel;
      const far = ({ onset, end }) => Math.max(onset - time, time - end, 0) / perPixel;
      if (state.view !== "event" && openNearest(run.events.map(far))) return;
      stop();
      state.time = Math.min(Math.max(time, 0), run.end);
    });
  }
  on("lengths", "click", ({ offsetX, offsetY }) =>
    openNearest(chart.marks.map(([x, y]) => Math.hypot(x - offsetX, y - offsetY))));
  document.addEventListener("keydown", (happened) => {
    const { key, target, ctrlKey, altKey, metaKey } = happened;
    if (key === "Escape") document.body.classList.add("dismissed");
    if (target.closest("input, summary") || ctrlKey || altKey || metaKey) return;
    const space = target.closest("button") ? null : play;
    const does = { ArrowLeft: () => move(-1), ArrowRight: () => move(1), " ": space }[key];
    if (does) happened.preventDefault(), does();
  });
  // The film of a step repeats until the reader acts.
  for (const type of ["pointerdown", "keydown"]) {
    document.addEventListener(type, () => (state.repeats = false), true);
  }
  // The word under the pointer or with the focus highlights its meaning in the picture.
  for (const type of ["pointerover", "focusin"]) {
    document.addEventListener(type, ({ target }) => {
      document.body.classList.remove("dismissed");
      document.body.dataset.lit = target.closest?.("[data-lights]")?.dataset.lights ?? "";
      redraw("row");
    });
  }
  const recolour = () => (readPalette(), redraw());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", recolour);
  // Print with the colours of the light scheme.
  for (const [type, isPrint] of [["beforeprint", true], ["afterprint", false]]) {
    addEventListener(type, () => {
      document.documentElement.classList.toggle("print", isPrint);
      recolour();
      drawDirty();
    });
  }
  new ResizeObserver(() => redraw()).observe(document.querySelector("main"));
}

// The worker starts from a blob, because a page opened as a file may not load it from a file.
const code = new Blob([element("worker").textContent], { type: "text/javascript" });
const worker = new Worker(URL.createObjectURL(code));
worker.onmessage = ({ data }) => receive(data);
worker.onerror = ({ message = "this browser does not let the page start a worker" }) =>
  setHtml("answers", `The solver has stopped: ${message}.`);
readPalette();
build();
listen();
readAddress();
addEventListener("hashchange", readAddress);
