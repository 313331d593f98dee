// The figures of a run, with its predictability.

const REACH = 22; // px, distance from a mark within which a click selects it
const NARROWEST = 10e-6; // s, shortest view of an event
const LONG = 0.02; // s, longer views have the time of the run, shorter ones that of the event
const ENLARGED = 250; // largest magnification of displacements; less if blocks would touch
const chart = {}; // axes of the figures over time, and places [x, y] of the front lengths

function view() {
  const { end, stopped } = run, last = firstGlobal(), one = event();
  if (state.view === "event" && one) {
    const lasts = Math.max(one.end - one.onset, NARROWEST);
    return { start: Math.max(one.onset - 0.3 * lasts, 0), end: one.onset + 1.3 * lasts };
  }
  if (state.view === "first" && last) return { start: 0, end: Math.min(1.04 * last.end, DURATION) };
  return { start: 0, end: (stopped && 1.04 * end) || DURATION };
}

// The part of the view that is animated: in the view of an event, the event only.
function played() {
  const { start, end } = state.view === "event" && event()
    ? { start: event().onset, end: event().end } : view();
  return { start, end: Math.min(end, run.end) };
}

// Spring forces at the onset of an event, or at the end of the run.
const restForces = (number) => (run.events[number] ?? run).force.slice();
const kindOf = (one) => (one.onset >= run.known ? "unsure" : one.isGlobal ? "global" : "partial");

// The row at a time [s]: forces of the springs [N], modes, and displacements [m].
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
  // The camera stays where the leading edge was before the last slip, follows it if it leaves the
  // picture, and then moves back to it smoothly.
  const x = positions(time, forces), room = (0.07 * length) / magnified;
  const left = at < 0 ? 0 : positions(last.onset, last.force)[n - 1];
  const camera = left + Math.max(x[n - 1] - left - room, 0);
  const rest = 0.3 * ((events[next]?.onset ?? run.end) - (last?.end ?? 0)) || 1;
  const ease = now === null && last ? Math.min((time - last.end) / rest, 1) : 0;
  const ground = camera + (x[n - 1] - camera) * ease * ease * (3 - 2 * ease);
  return {
    weights, strength: strength.slice(1), forces: forces.slice(1), modes: modes.slice(1, n + 1),
    before: (time <= last?.end ? last.force : forces).slice(1), friction, load: forces[1], length,
    magnified,
    ground, shifts: x.map((value) => value - ground), now, at, front: event()?.front,
    highest: state.view === "event" && event() ? 1.1 * event().before : highest,
    pushed: Math.max(forces[1], 0) / highest, added: last ? kindOf(last) : "partial",
    kind: last?.isGlobal ? "global" : "partial", lit: document.body.dataset.lit,
    hasPush: document.body.dataset.shows !== "slip",
  };
}

function showRow() {
  const frame = frameAt(state.time), { now, at } = frame, one = run.events[now];
  drawRow(element("row"), frame);
  if (one && state.event !== now) (state.event = now), redraw("lengths");
  else if (!one && state.playing && at >= 0) state.event = at;
  const { start, end } = view(), share = (state.time - start) / (end - start);
  const { left, right, top, bottom } = chart.time?.box ?? { left: 0, right: 0 };
  const cursor = element("cursor");
  cursor.style.transform = `translateX(${left + share * (right - left)}px)`;
  cursor.style.height = `${bottom - top + 6}px`;
  cursor.hidden = share < 0 || share > 1;
  const [low, high] = reel();
  element("scrubber").value = (1000 * (inFilm(state.time) - low)) / (high - low || 1);
  const since = state.time - one?.onset;
  const pace = one && secondsOf(one) / (one.end - one.onset) / 1000;
  const clock = !one ? `${quantity(state.time, "s")}, all blocks stuck`
    : `${quantity(one.onset, "s")}${since ? ` + ${quantity(since, "s")}` : ", block 1 starts to slide"}`;
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
  // Update the words of the steps that depend on the event.
  const words = { blocks: `block ${one.front}`, added: one.isGlobal ? "red" : "blue" };
  for (const word of document.querySelectorAll("[data-lights=blocks], [data-lights=added]")) {
    word.textContent = words[word.dataset.lights];
  }
  const reason = reasonOf(one);
  document.querySelector("[data-reason]").innerHTML = marked(reason);
  setName("row", `A row of ${counts(n, "block")}, pushed from the left by a spring. ${text}
    This slip reaches block ${one.front}${reason}`);
}

// Why a slip ends at its front: the push is used up, or the next block stays below its limit.
function reasonOf(one) {
  const { n, weights, strength, slider } = run, { front } = one;
  let left = one.before, spent = 0; // load that remains, blocks whose friction it overcame
  for (const load of weights) {
    const share = Math.min(left / (slider.mu_k * load), 1);
    spent += share;
    left -= share * slider.mu_k * load;
  }
  if (front === n) {
    return left > 0 ? `, the last, and ${digits(left)} N of the push are left.`
      : ", the last, although the line ends before it.";
  }
  if (front > spent + 1) return ", beyond the end of the line.";
  if (front >= spent - 1) return ", where the line ends.";
  const after = restForces(run.events.indexOf(one) + 1), net = after[front + 1] - after[front + 2];
  return `, before the line ends: the net force on block ${front + 1} is then
    ${digits(Math.abs(net))} N, below its limit of ${digits(strength[front + 1])} N.`;
}

// Set the accessible name of a figure.
const setName = (id, text) => element(id).setAttribute("aria-label", plain(text));

// Ticks and label of the time axis: time of the run, or time since the onset of an event.
function timeAxis({ start, end }, width) {
  const about = Math.min(8, width / 80), zero = event()?.onset ?? start;
  if (end - start > LONG) return [ticks(start, end, about), "Time t [s]"];
  const [unit, name] = end - start < 2e-3 ? [1e-6, "µs"] : [1e-3, "ms"];
  const { values, decimals } = ticks((start - zero) / unit, (end - zero) / unit, about);
  const names = values.map((value) => value.toFixed(decimals));
  const label = `Time since the onset of the event [${name}]`;
  return [{ values: values.map((value) => zero + value * unit), names }, label];
}

// Draw F_X over time, in grey where it is not predictable.
function showLoad() {
  const window = view(), { start, end } = window, isRun = end - start > LONG;
  const [context, width, height] = clear(element("load")), one = event();
  const motion = isRun ? null : run.motions.get(state.event);
  const time = motion ? [start, ...motion.time, end] : run.arrays.time;
  const load = motion ? [one.before, ...motion.forces.map(of(1)), one.after] : run.arrays.load;
  const seen = load.slice(lowerBound(time, start), lowerBound(time, end) + 1);
  const high = seen.reduce((a, b) => Math.max(a, b), 1e-9);
  const low = isRun ? 0 : seen.reduce((a, b) => Math.min(a, b), high);
  const room = 0.1 * (high - low || 1), up = [isRun ? 0 : low - room, high + room];
  const label = "Push F_X [N]", [along] = timeAxis(window, width);
  const { x, y, box } = axes(context, width, height, [start, end], up, [null, label], along);
  const level = y(run.slider.mu_k * run.slider.normal_load);
  context.strokeStyle = context.fillStyle = palette.ink;
  if (level > box.top && level < box.bottom) {
    dashed(context, [[box.left, level], [box.right, level]]);
    write(context, "dashed: μ_k F_Z", box.right, 8, "right");
  }
  drawLoad(context, { x, y, box }, { time, load, known: run.known }, start, end, "ink");
  setName("load", `${label}, against time: ${counts(run.events.length, "event")}.
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
  chart.time = figure;
  setHtml("slips-key", keyOf("box", slideBars(context, figure, run, start, end)));
  setName("slips", "Slips over time: one line for each block, coloured while it slides");
}

// Draw front lengths against the load, as in Fig. 13.
function showLengths() {
  const [context, width, height] = clear(element("lengths")), { n, counted } = run;
  const { mu_k, normal_load } = run.slider, events = upToGlobal(run.events);
  const highest = Math.max(1e-9, ...events.map(of("before")), mu_k * normal_load);
  const labels = ["Push F_X [N]", "Front length L_p / L"];
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
  const points = counted.map((e) => `${counts(e.front, "block")} at ${quantity(e.before, "N")}`);
  setHtml("lengths-key", keyOf("dot", new Set(counted.map(kindOf))) +
    (areShort ? "<span><b>×</b> shorter than an earlier one, not counted</span>" : ""));
  setName("lengths", `Front length against push: ${points.join(", ").slice(0, 900)}`);
}

// Draw the study of a step.
function showStudy() {
  if (!isStudied()) return;
  const { key, name } = STEPS[state.step - 1].study(...clear(element("study")));
  setHtml("study-key", key);
  setName("study", name);
}
