// The figures of the page: what they show of the run and of its predictability.

const REACH = 22; // pixels around a mark in which a click means it
const NARROWEST = 10e-6; // s, the narrowest view of an event
const LONG = 0.02; // s, above which the time is that of the run, not that of an event
const ENLARGED = 250; // times, of movement; less where blocks would touch
const chart = {}; // axes of the time, and marks of the front lengths: [x, y, number of the event]

function view() {
  const { end, stopped } = run, last = firstGlobal(), one = event();
  if (state.view === "event" && one) {
    const lasts = Math.max(one.end - one.onset, NARROWEST);
    return { start: Math.max(one.onset - 0.3 * lasts, 0), end: one.onset + 1.3 * lasts };
  }
  if (state.view === "first" && last) return { start: 0, end: Math.min(1.04 * last.end, DURATION) };
  return { start: 0, end: (stopped && 1.04 * end) || DURATION };
}

// The part of the view that is played: of an event all of it, and no more.
function played() {
  const { start, end } = state.view === "event" && event()
    ? { start: event().onset, end: event().end } : view();
  return { start, end: Math.min(end, run.end) };
}

// Spring forces at the onset of an event, or at the end of the run.
const restForces = (number) => (run.events[number] ?? run).force.slice();
const kindOf = (one) => (one.onset >= run.known ? "unsure" : one.isGlobal ? "global" : "partial");

// The row at a time: forces of the springs, modes, and displacements [m].
function frameAt(time) {
  const { events, n, k, weights, strength, highest, slider } = run;
  const { drive_stiffness: K, drive_velocity: V, length, mu_k: friction } = slider;
  const next = lowerBound(events.map(of("onset")), time);
  const at = next - Number(events[next]?.onset !== time), last = events[at];
  const now = time < last?.end ? at : null, motion = run.motions.get(now);
  let forces = restForces(now ?? at + 1), modes = new Int8Array(n + 2);
  if (now === null) forces[1] = (last?.after ?? 0) + K * V * (time - (last?.end ?? 0));
  else if (!motion) askMotion(now);
  else {
    const i = Math.max(lowerBound(motion.time, time) - 1, 0);
    [forces, modes] = [motion.forces[i], motion.modes[i]];
  }
  const positions = (t, f) => {
    const x = [V * t - f[1] / K];
    for (let i = 2; i <= n; i++) x.push(x[i - 2] - f[i] / k);
    return x;
  };
  const magnified = Math.min(ENLARGED, Math.floor((0.34 * length * k) / n / highest));
  // The camera stays where the last slip left the far end, goes along if that end leaves the
  // picture, and then eases back.
  const x = positions(time, forces), room = (0.07 * length) / magnified;
  const kept = at < 0 ? 0 : positions(last.onset, last.force)[n - 1];
  const camera = kept + Math.max(x[n - 1] - kept - room, 0);
  const rest = 0.3 * ((events[next]?.onset ?? run.end) - (last?.end ?? 0)) || 1;
  const ease = now === null && last ? Math.min((time - last.end) / rest, 1) : 0;
  const ground = camera + (x[n - 1] - camera) * ease * ease * (3 - 2 * ease);
  return {
    weights, strength: strength.slice(1), forces: forces.slice(1), modes: modes.slice(1, n + 1),
    before: restForces(Math.max(at, 0)).slice(1), friction, load: forces[1], length, magnified,
    ground, shifts: x.map((value) => value - ground), now, at, front: event()?.front,
    highest: state.view === "event" && event() ? 1.1 * event().before : highest,
    pushed: Math.max(forces[1], 0) / highest, added: last ? kindOf(last) : "partial",
    kind: last?.isGlobal ? "global" : "partial", lit: document.body.dataset.lit,
    hasPush: document.body.dataset.shows !== "1",
  };
}

function showRow() {
  const frame = frameAt(state.time), { now, at } = frame, one = run.events[now];
  drawRow(element("row"), frame);
  if (one && state.event !== now) (state.event = now), redraw("lengths");
  else if (!one && state.playing && at >= 0) state.event = at;
  const { start, end } = view(), share = (state.time - start) / (end - start);
  const { left, right } = chart.time?.box ?? { left: 0, right: 0 };
  element("cursor").style.transform = `translateX(${left + share * (right - left)}px)`;
  element("cursor").hidden = share < 0 || share > 1;
  const [low, high] = reel();
  element("scrubber").value = (1000 * (inFilm(state.time) - low)) / (high - low || 1);
  const since = state.time - one?.onset;
  const pace = one && secondsOf(one) / (one.end - one.onset) / 1000;
  const clock = !one ? `${quantity(state.time, "s")}, all blocks stuck`
    : `${quantity(one.onset, "s")}${since ? ` + ${quantity(since, "s")}` : ", block 1 lets go"}`;
  const slowed = one ? `slow motion: 1 ms takes ${Number(pace.toPrecision(1))} s` : "time lapse";
  element("scrubber").setAttribute("aria-valuetext", clock);
  setHtml("moment", `${clock}, F_X = ${quantity(frame.load, "N")}` +
    `${state.time < run.known ? "" : ", not predictable"}${state.playing ? ` – ${slowed}` : ""}`);
  showReadout();
}

function showReadout() {
  const one = event(), { events, n, counted } = run, slip = firstGlobal();
  element("previous").disabled = !events.length || state.event === 0;
  element("next").disabled = !events.length || state.event === events.length - 1;
  if (!one) return setHtml("readout", "Press Play, click an event in a figure, or press →.");
  const isShort = !(slip && one.onset > slip.onset) && !counted.includes(one);
  const kind = one.isGlobal ? "global slip" : isShort ? "shorter precursor" : "precursor";
  const who = one.front === 1 ? "block 1 slides" : `blocks 1 to ${one.front} slide`;
  const text = `Event ${state.event + 1} of ${events.length}, ${kind}: ${who}
    ${one.front === n && !one.isGlobal && n > 1 ? "in turn" : ""} for
    ${quantity(one.end - one.onset, "s")},
    F_X: ${quantity(one.before, "N")} → ${quantity(one.after, "N")}.`;
  if (!setHtml("readout", text)) return;
  setName("row", `A row of ${counts(n, "block")}, pushed from the left by a spring. ${text}`);
  // Words of the steps that tell of the event.
  const told = { blocks: `block ${one.front}`, added: one.isGlobal ? "red" : "blue" };
  for (const word of document.querySelectorAll("[data-lights=blocks], [data-lights=added]")) {
    word.textContent = told[word.dataset.lights];
  }
}

// What is heard of a figure.
const setName = (id, text) => element(id).setAttribute("aria-label", plain(text));

// Ticks and label of the time: of the run, or since the onset of an event.
function timeAxis({ start, end }, width) {
  const about = Math.min(8, width / 80), zero = event()?.onset ?? start;
  if (end - start > LONG) return [ticks(start, end, about), "Time t [s]"];
  const [unit, name] = end - start < 2e-3 ? [1e-6, "µs"] : [1e-3, "ms"];
  const { values, decimals } = ticks((start - zero) / unit, (end - zero) / unit, about);
  const names = values.map((value) => value.toFixed(decimals));
  const label = `Time since the onset of the event [${name}]`;
  return [{ values: values.map((value) => zero + value * unit), names }, label];
}

// Up to the first global slip and in an event K x_1: the load without its trend, which climbs one
// step in each slip. Of the whole run F_X, which swings about mu_k F_Z. Both are grey from where
// they are not predictable.
function showStairs() {
  const window = view(), { start, end } = window, isRun = end - start > LONG;
  const [context, width, height] = clear(element("stairs")), last = firstGlobal(), one = event();
  const { drive_stiffness: K, drive_velocity: V, mu_k } = run.slider, isLoad = state.view === "all";
  const drawn = (time, load) => load.map((force, i) => (isLoad ? force : K * V * time[i] - force));
  const motion = isRun ? null : run.motions.get(state.event);
  const upTo = lowerBound(run.arrays.time, end) + 1;
  const time = motion ? [start, ...motion.time, end] : run.arrays.time.subarray(0, upTo);
  const load = motion ? [one.before, ...motion.forces.map(of(1)), one.after]
    : run.arrays.load.subarray(0, upTo);
  const values = drawn(time, load);
  // Up to the global slip, whose step is the largest, the axis ends above the last precursor.
  const isCut = state.view === "first" && last && last !== run.events[0];
  const to = lowerBound(time, isCut ? last.onset : end) + 1;
  const seen = values.slice(lowerBound(time, start), to);
  const high = seen.reduce((a, b) => Math.max(a, b), 1e-9);
  const low = isRun ? 0 : seen.reduce((a, b) => Math.min(a, b), high);
  const room = 0.1 * (high - low || 1), up = [isRun ? 0 : low - room, high + room];
  const label = isLoad ? "Load F_X [N]" : "K x_1 = K V t − F_X, the load that slips released [N]";
  const [along] = timeAxis(window, width);
  const { x, y, box } = axes(context, width, height, [start, end], up, [null, label], along);
  if (isLoad) {
    context.strokeStyle = context.fillStyle = palette.ink;
    const level = y(mu_k * run.slider.normal_load);
    dashed(context, [[box.left, level], [box.right, level]]);
    write(context, "dashed: μ_k F_Z", box.right, 8, "right");
  }
  context.save();
  context.beginPath();
  context.rect(box.left, box.top - 6, box.right - box.left, box.bottom - box.top + 7);
  context.clip();
  const known = Math.min(Math.max(run.known, start), end);
  for (const [colour, from, to] of [["ink", start, known], ["unsure", known, end]]) {
    context.strokeStyle = palette[colour];
    context.lineWidth = 1.5;
    if (from < to) curve(context, x, y, time, values, from, to);
  }
  context.restore();
  chart.time = { x, box };
  setName("stairs", `${label}, against time: ${counts(run.events.length, "event")}.
    ${shown.answers}. ${shown.trust}`);
}

const keyOf = (shape, kinds) => KINDS.map((kind, i) =>
  kinds.has(kind) ? keyTo(shape, kind, NAMES[i]) : "").join(" ");

function showSlips() {
  const window = view(), { start, end } = window, { n } = run, every = Math.ceil(n / 4);
  const [context, width, height] = clear(element("slips"));
  const [along, label] = timeAxis(window, width);
  const values = Array.from({ length: Math.ceil(n / every) }, (_, i) => n - i * every);
  const up = { values, decimals: 0 }, labels = [label, "Block"];
  const figure = axes(context, width, height, [start, end], [0.5, n + 0.5], labels, along, up);
  setHtml("slips-key", keyOf("box", slideBars(context, figure, run, start, end)));
  setName("slips", "Slips over time: one line for each block, coloured while it slides");
}

function showLengths() {
  const [context, width, height] = clear(element("lengths")), { n, counted } = run;
  const { mu_k, normal_load } = run.slider, events = upToGlobal(run.events);
  const highest = Math.max(1e-9, ...events.map(of("before")), mu_k * normal_load);
  const labels = ["Load F_X [N]", "Front length L_p / L"];
  const { x, y, box } = axes(context, width, height, [0, 1.06 * highest], [0, 1.08], labels);
  let friction = 0;
  const line = run.weights.map((load, i) => [x((friction += mu_k * load)), y((i + 1) / n)]);
  context.strokeStyle = context.fillStyle = palette.ink;
  dashed(context, [[x(0), y(0)], ...line]);
  write(context, "dashed: F_X = μ_k W(L_p)", box.left + 6, box.top + 10);
  stroke(context, [[x(friction), box.top - 4], [x(friction), box.bottom]]);
  write(context, "μ_k F_Z", x(friction), 8, "center");
  chart.marks = events.map((one, i) => {
    const at = [x(one.before), y(one.front / n)], isCounted = counted.includes(one);
    mark(context, isCounted ? "dot" : "cross", ...at, 4, palette[isCounted ? kindOf(one) : "soft"]);
    if (i === state.event) mark(context, "ring", ...at, 10, palette.ink);
    return at;
  });
  const areShort = counted.length < events.length;
  setHtml("lengths-key", keyOf("dot", new Set(counted.map(kindOf))) +
    (areShort ? "<span><b>×</b> shorter than one before, not counted</span>" : ""));
  const told = counted.map((e) => `${counts(e.front, "block")} at ${quantity(e.before, "N")}`);
  setName("lengths", `Front length against load: ${told.join(", ").slice(0, 900)}`);
}

// The study of the last two steps, and in it the reader's slider.
function showStudy() {
  const { study } = STEPS[state.step - 1];
  if (study) setName("study", study(...clear(element("study"))));
}
