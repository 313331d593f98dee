"use strict";
// The figures of the page: what they show of the run, of its predictability and of a study.

const REACH = 22; // pixels around a mark in which a click means it
const NARROWEST = 10e-6; // s, the narrowest view of an event

function view() {
  const { end, events, stopped } = run, last = firstGlobal();
  if (state.view === "event" && event()) {
    const lasts = Math.max(event().end - event().onset, NARROWEST);
    return { start: Math.max(event().onset - 0.3 * lasts, 0), end: event().onset + 1.3 * lasts };
  }
  return { start: 0, end: state.view === "first" && last ? Math.min(1.04 * last.end, DURATION) : stopped && end < DURATION ? 1.04 * end || DURATION : DURATION };
}

// The state of the row at a time: forces of the springs, modes, and displacements [m].
function frameAt(time) {
  const { events, arrays, n, k, weights, strength } = run, { drive_stiffness: K, drive_velocity: V, length } = run.slider;
  const next = lowerBound(events.map((e) => e.onset), time), at = next < events.length && events[next].onset === time ? next : next - 1;
  const now = at >= 0 && time < events[at].end ? at : null, row = now ?? at + 1;
  let forces = restForces(row), modes = new Int8Array(n + 2);
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
  const x = positions(time, forces), room = (0.07 * length) / run.magnified;
  const far = (number) => (number < 0 ? 0 : positions(events[number].onset, restForces(number))[n - 1]);
  const kept = at < 0 ? 0 : far(at), camera = kept + Math.max(x[n - 1] - kept - room, 0);
  const ease = now === null && at >= 0 ? Math.min((time - events[at].end) / (0.3 * ((events[next]?.onset ?? run.end) - events[at].end) || 1), 1) : 0;
  const seen = camera + (x[n - 1] - camera) * ease * ease * (3 - 2 * ease);
  return {
    weights, strength: strength.slice(1), net: Array.from({ length: n }, (_, i) => forces[i + 1] - forces[i + 2]), modes: modes.slice(1, n + 1), shifts: x.map((value) => value - seen),
    magnified: run.magnified, length, pushed: Math.max(forces[1], 0) / run.highest, isGlobal: now !== null && events[now].isGlobal, ground: seen, now, at, load: forces[1],
  };
}
// Spring forces at the onset of an event.
function restForces(number) {
  return run.arrays.forces.slice(number * (run.n + 2), (number + 1) * (run.n + 2));
}

function showRow() {
  const frame = frameAt(state.time), { now, at } = frame;
  drawRow(element("row"), frame);
  if (now !== null && state.event !== now) (state.event = now), redraw("lengths");
  else if (now === null && playing && at >= 0) state.event = at;
  const { start: from, end: to } = view(), share = (state.time - from) / (to - from);
  element("cursor").style.transform = shares ? `translateX(${shares.box.left + share * (shares.box.right - shares.box.left)}px)` : "";
  element("cursor").hidden = share < 0 || share > 1;
  const [low, high] = [from, to].map((t) => along(film.time, film.wall, t));
  element("scrubber").value = (1000 * (along(film.time, film.wall, state.time) - low)) / (high - low || 1);
  const one = run.events[now], pace = one && Math.min(PACE, LONGEST / (one.end - one.onset)) / 1000;
  const clock = one ? `${quantity(one.onset, "s")}${state.time > one.onset ? ` + ${quantity(state.time - one.onset, "s")}` : ", block 1 lets go"}` : `${quantity(state.time, "s")}, all blocks stuck`;
  const speed = !playing ? "" : one ? ` – slow motion: 1 ms takes ${pace.toPrecision(1)} s` : " – time lapse";
  element("scrubber").setAttribute("aria-valuetext", clock);
  element("moment").textContent = `${clock}, Fₓ = ${quantity(frame.load, "N")}${state.time < run.known ? "" : ", not predictable"}${speed}`;
  showReadout();
}

function showReadout() {
  const one = event(), { events, n, counted } = run;
  element("previous").disabled = !events.length || state.event === 0;
  element("next").disabled = !events.length || state.event === events.length - 1;
  const isLate = firstGlobal() && one?.onset > firstGlobal().onset;
  const kind = one?.isGlobal ? "global slip" : isLate ? "partial slip" : counted.includes(one) ? "precursor" : "shorter slip";
  const who = one?.front === 1 ? "block 1 slides" : `blocks 1 to ${one?.front} slide${one?.front === n && !one.isGlobal ? " in turn" : ""}`;
  const text = one
    ? `Event ${state.event + 1} of ${events.length}, ${kind}: ${who} for ${quantity(one.end - one.onset, "s")}, Fₓ: ${quantity(one.before, "N")} → ${quantity(one.after, "N")}.`
    : "Press Play, click an event in a figure, or press →.";
  if (element("readout").textContent === text) return;
  element("readout").textContent = text;
  setName("row", `A row of ${counts(n, "block")}, pushed from the left by a spring. ${text}`);
}

// What is heard of a figure.
function setName(id, text) {
  element(id).setAttribute("aria-label", text);
}

const isWide = (start, end) => end - start > 0.02; // s: the time of the run, not that of an event
function timeTicks(start, end, width) {
  if (isWide(start, end)) return [ticks(start, end, Math.min(8, width / 80)), "Time t [s]"];
  const zero = event()?.onset ?? start, [unit, name] = end - start < 2e-3 ? [1e-6, "µs"] : [1e-3, "ms"];
  const { values, decimals } = ticks((start - zero) / unit, (end - zero) / unit, Math.min(8, width / 80));
  return [{ values: values.map((value) => zero + value * unit), names: values.map((value) => value.toFixed(decimals)) }, `Time since the onset of the event [${name}]`];
}

// A curve over time, grey from where it is not predictable. There the twin goes another way, which is dashed.
function drawOverTime(id, label, valueOf, count) {
  const { start, end } = view(), [context, width, height] = clear(element(id)), isWhole = isWide(start, end);
  const { time, load } = isWhole ? run.arrays : withMotion(run.arrays, motions.get(state.event)), known = Math.min(Math.max(run.known, start), end);
  const values = load.map((force, i) => valueOf(time[i], force)), [low, high] = extent(time, values, start, end), span = high - low || 1;
  const range = !Number.isFinite(low) ? [0, 1] : isWhole ? [0, 1.06 * Math.max(high, 1e-9)] : [low - 0.08 * span, high + 0.08 * span];
  const figure = axes(context, width, height, [start, end], range, [null, label], timeTicks(start, end, width)[0], ticks(...range, count));
  const draw = (time, values, colour, from, to) => {
    context.strokeStyle = palette[colour];
    context.lineWidth = 1.5;
    if (from < to) curve(context, figure, time, values, from, to);
  };
  context.setLineDash([5, 4]);
  if (isWhole && twin) draw(twin.arrays.time, twin.arrays.load.map((force, i) => valueOf(twin.arrays.time[i], force)), "unsure", known, end);
  context.setLineDash([]);
  draw(time, values, "ink", start, known);
  draw(time, values, "unsure", known, end);
  showLimit(context, figure, id === "load" && "not predictable");
  return { context, figure };
}
// Times and loads of a run, with those of the motion in one event in their place.
function withMotion({ time, load }, motion) {
  if (!motion) return { time, load };
  const from = lowerBound(time, motion.time[0]), to = lowerBound(time, motion.time.at(-1));
  const around = (values, inside) => [...values.subarray(0, from), ...inside, ...values.subarray(to)];
  return { time: around(time, motion.time), load: around(load, motion.forces.filter((_, i) => i % (run.n + 2) === 1)) };
}
// The line from which the run is not predictable.
function showLimit(context, { x, box }, text) {
  const { start, end } = view();
  if (!(run.known < end)) return;
  const at = x(Math.max(run.known, start)), isLate = at > box.right - 110;
  context.strokeStyle = context.fillStyle = palette.soft;
  context.lineWidth = 1;
  context.setLineDash([2, 3]);
  stroke(context, [[at, box.top], [at, box.bottom]]);
  context.setLineDash([]);
  context.textAlign = isLate ? "right" : "left";
  if (text) context.fillText(isLate ? `${text} →` : `→ ${text}`, at + (isLate ? -6 : 6), box.bottom - 9);
}
const kindOf = (one) => (one.onset >= run.known ? "unsure" : one.isGlobal ? "global" : "partial");

function showLoad() {
  const { context, figure } = drawOverTime("load", "Load Fₓ [N]", (time, load) => load, 4), { start, end } = view();
  const seen = run.events.filter((one) => one.onset >= start && one.onset <= end), size = seen.length > 60 ? 2 : 3;
  for (const one of seen) if (size > 2 || one.isGlobal) mark(context, "dot", figure.x(one.onset), figure.y(one.before), size, palette[kindOf(one)]);
  shares = figure;
  setName("load", `Load against time: ${plain(shown.answers)}. ${plain(shown.trust)}`);
}

// K x_1: the load without its trend, which climbs one step in each slip.
function showStairs() {
  const rate = run.slider.drive_stiffness * run.slider.drive_velocity, { start, end } = view();
  const { context, figure } = drawOverTime("stairs", "K x₁ = K V t − Fₓ [N]", (time, load) => rate * time - load, 4);
  const seen = run.events.filter((one) => one.onset >= start && one.end <= end);
  context.lineWidth = 3;
  for (const one of isWide(start, end) && seen.length <= 60 ? seen : []) {
    context.strokeStyle = palette[kindOf(one)];
    stroke(context, [[figure.x(one.onset), figure.y(rate * one.onset - one.before)], [figure.x(one.end), figure.y(rate * one.end - one.after)]]);
  }
  setName("stairs", `The load that slips have released, K x1, against time: a step up in each of ${counts(run.events.length, "event")}`);
}

function showSlips() {
  const { start, end } = view(), [context, width, height] = clear(element("slips")), { n } = run;
  const every = Math.ceil(n / 6), values = Array.from({ length: Math.ceil(n / every) }, (_, i) => n - i * every);
  const [along, label] = timeTicks(start, end, width);
  const figure = axes(context, width, height, [start, end], [0.5, n + 0.5], [label, "Block"], along, { values, decimals: 0 });
  slideBars(context, figure, run, start, end);
  showLimit(context, figure);
  setName("slips", "Slips over time: one line for each block, coloured while it slides");
}

let marks = []; // of the figure of front lengths: [x, y, number of the event]
function showLengths() {
  marks = [];
  if (study()) return setName("lengths", study().draw(...clear(element("lengths")), found[study().name]));
  const [context, width, height] = clear(element("lengths")), last = firstGlobal();
  const events = last ? run.events.slice(0, run.events.indexOf(last) + 1) : run.events;
  const highest = Math.max(1e-9, ...events.map((e) => e.before));
  const figure = axes(context, width, height, [0, 1.06 * highest], [0, 1.08], ["Load Fₓ [N]", "Front length Lₚ / L"]);
  marks = events.map((one, i) => {
    const x = figure.x(one.before), y = figure.y(one.front / run.n), isCounted = run.counted.includes(one);
    mark(context, isCounted ? "dot" : "cross", x, y, 4, palette[isCounted ? kindOf(one) : "soft"]);
    if (i === state.event) mark(context, "ring", x, y, 10, palette.ink);
    return [x, y, i];
  });
  setName("lengths", `Front length against load: ${run.counted.map((e) => `${counts(e.front, "block")} at ${quantity(e.before, "N")}`).join(", ").slice(0, 900)}`);
}
