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

// The part of the view that is played: of an event all of it, and no more.
function played() {
  const { start, end } = state.view === "event" && event() ? { start: event().onset, end: event().end } : view();
  return { start, end: Math.min(end, run.end) };
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
    weights, strength: strength.slice(1), forces: forces.slice(1), before: restForces(Math.max(at, 0)).slice(1), friction: run.slider.mu_k, highest: run.highest, added: palette[at < 0 ? "partial" : kindOf(events[at])], modes: modes.slice(1, n + 1), shifts: x.map((value) => value - seen),
    magnified: run.magnified, length, pushed: Math.max(forces[1], 0) / run.highest, isGlobal: now !== null && events[now].isGlobal, ground: seen, now, at, load: forces[1],
  };
}
// Spring forces at the onset of an event.
const restForces = (number) => run.arrays.forces.slice(number * (run.n + 2), (number + 1) * (run.n + 2));

function showRow() {
  const frame = frameAt(state.time), { now, at } = frame;
  drawRow(element("row"), frame);
  if (now !== null && state.event !== now) (state.event = now), redraw("lengths");
  else if (now === null && playing && at >= 0) state.event = at;
  const { start: from, end: to } = view(), share = (state.time - from) / (to - from);
  element("cursor").style.transform = shares ? `translateX(${shares.box.left + share * (shares.box.right - shares.box.left)}px)` : "";
  element("cursor").hidden = share < 0 || share > 1;
  const [low, high] = [played().start, played().end].map((t) => along(film.time, film.wall, t));
  element("scrubber").value = (1000 * (along(film.time, film.wall, state.time) - low)) / (high - low || 1);
  const one = run.events[now], pace = one && secondsOf(one) / (one.end - one.onset) / 1000;
  const clock = one ? `${quantity(one.onset, "s")}${state.time > one.onset ? ` + ${quantity(state.time - one.onset, "s")}` : ", block 1 lets go"}` : `${quantity(state.time, "s")}, all blocks stuck`;
  const speed = !playing ? "" : one ? ` – slow motion: 1 ms takes ${Number(pace.toPrecision(1))} s` : " – time lapse";
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
const setName = (id, text) => element(id).setAttribute("aria-label", text);

const isWide = (start, end) => end - start > 0.02; // s: the time of the run, not that of an event
function timeTicks(start, end, width) {
  if (isWide(start, end)) return [ticks(start, end, Math.min(8, width / 80)), "Time t [s]"];
  const zero = event()?.onset ?? start, [unit, name] = end - start < 2e-3 ? [1e-6, "µs"] : [1e-3, "ms"];
  const { values, decimals } = ticks((start - zero) / unit, (end - zero) / unit, Math.min(8, width / 80));
  return [{ values: values.map((value) => zero + value * unit), names: values.map((value) => value.toFixed(decimals)) }, `Time since the onset of the event [${name}]`];
}

// K x_1: the load without its trend, which climbs one step in each slip. It is grey from where it is not predictable, and
// there the twin goes another way, which is dashed.
function showStairs() {
  const { start, end } = view(), [context, width, height] = clear(element("stairs")), isWhole = isWide(start, end);
  const { drive_stiffness: K, drive_velocity: V } = run.slider, last = firstGlobal(), one = event(), motion = motions.get(state.event);
  let [time, load] = [run.arrays.time, run.arrays.load].map((column) => column.subarray(0, lowerBound(run.arrays.time, end) + 1));
  if (!isWhole && motion) [time, load] = [[start, ...motion.time, end], [one.before, ...motion.forces.filter((_, i) => i % (run.n + 2) === 1), one.after]];
  const releasedIn = (time, load) => load.map((force, i) => K * V * time[i] - force), released = releasedIn(time, load);
  // Up to the global slip, whose step is the largest, the axis ends above the last precursor.
  const until = state.view === "first" && last && last !== run.events[0] ? last.onset : end, seen = released.slice(lowerBound(time, start), lowerBound(time, until) + 1);
  const high = seen.reduce((a, b) => Math.max(a, b), 1e-9), low = isWhole ? 0 : seen.reduce((a, b) => Math.min(a, b), high), room = 0.1 * (high - low || 1);
  const figure = axes(context, width, height, [start, end], [isWhole ? 0 : low - room, high + room], [null, "K x₁ = K V t − Fₓ: the load that slips have released [N]"], timeTicks(start, end, width)[0]);
  const known = Math.min(Math.max(run.known, start), end);
  const draw = (time, values, colour, from, to) => {
    context.strokeStyle = palette[colour];
    context.lineWidth = 1.5;
    if (from < to) curve(context, figure, time, values, from, to);
  };
  context.setLineDash([5, 4]);
  if (isWhole && twin && known < end) draw(twin.arrays.time, releasedIn(twin.arrays.time, twin.arrays.load), "unsure", known, end);
  context.setLineDash([]);
  draw(time, released, "ink", start, known);
  draw(time, released, "unsure", known, end);
  const slips = run.events.filter((one) => one.onset >= start && one.end <= end);
  context.lineWidth = 3;
  for (const one of isWhole && slips.length <= 60 ? slips : []) {
    context.strokeStyle = palette[kindOf(one)];
    stroke(context, [[one.onset, one.before], [one.end, one.after]].map(([t, force]) => [figure.x(t), Math.max(figure.y(K * V * t - force), figure.box.top - 6)]));
  }
  showLimit(context, figure, "not predictable");
  shares = figure;
  setName("stairs", `The load that slips have released, K x1, against time: a step up in each of ${counts(run.events.length, "event")}. ${plain(shown.answers)}. ${plain(shown.trust)}`);
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
  context.textAlign = isLate ? "right" : "left";
  if (text) context.fillText(isLate ? `${text} →` : `→ ${text}`, at + (isLate ? -6 : 6), box.bottom - 9);
}
const kindOf = (one) => (one.onset >= run.known ? "unsure" : one.isGlobal ? "global" : "partial");

function showSlips() {
  const { start, end } = view(), [context, width, height] = clear(element("slips")), { n } = run;
  const every = Math.ceil(n / 4), values = Array.from({ length: Math.ceil(n / every) }, (_, i) => n - i * every);
  const [along, label] = timeTicks(start, end, width);
  const figure = axes(context, width, height, [start, end], [0.5, n + 0.5], [label, "Block"], along, { values, decimals: 0 });
  const kinds = slideBars(context, figure, run, start, end);
  setHtml("slips-key", KINDS.map((kind, i) => (kinds.has(kind) ? keyTo("box", kind, NAMES[i]) : "")).join(" "));
  showLimit(context, figure);
  setName("slips", "Slips over time: one line for each block, coloured while it slides");
}

let marks = []; // of the figure of front lengths: [x, y, number of the event]
function showLengths() {
  const { draw, name, keyOf } = study() ?? {}, last = firstGlobal();
  const events = last ? run.events.slice(0, run.events.indexOf(last) + 1) : run.events;
  marks = [];
  if (draw) return setHtml("lengths-key", keyOf(found[name])), setName("lengths", draw(...clear(element("lengths")), found[name]));
  const [context, width, height] = clear(element("lengths")), highest = Math.max(1e-9, ...events.map((e) => e.before));
  const figure = axes(context, width, height, [0, 1.06 * highest], [0, 1.08], ["Load Fₓ [N]", "Front length Lₚ / L"]);
  let friction = 0;
  context.strokeStyle = context.fillStyle = palette.ink;
  context.setLineDash([5, 4]);
  stroke(context, [[figure.x(0), figure.y(0)], ...run.weights.map((load, i) => [figure.x((friction += run.slider.mu_k * load)), figure.y((i + 1) / run.n)])]);
  context.setLineDash([]);
  context.textAlign = "left";
  context.fillText("dashed: Fₓ = μₖ W(Lₚ)", figure.box.left + 6, figure.box.top + 10);
  marks = events.map((one, i) => {
    const x = figure.x(one.before), y = figure.y(one.front / run.n), isCounted = run.counted.includes(one);
    mark(context, isCounted ? "dot" : "cross", x, y, 4, palette[isCounted ? kindOf(one) : "soft"]);
    if (i === state.event) mark(context, "ring", x, y, 10, palette.ink);
    return [x, y, i];
  });
  const kinds = new Set(run.counted.map(kindOf)), shorter = `<span><b>×</b> shorter than one before, not counted</span>`;
  setHtml("lengths-key", KINDS.map((kind, i) => (kinds.has(kind) ? keyTo("dot", kind, NAMES[i]) : "")).join(" ") + (run.counted.length < events.length ? shorter : ""));
  setName("lengths", `Front length against load: ${run.counted.map((e) => `${counts(e.front, "block")} at ${quantity(e.before, "N")}`).join(", ").slice(0, 900)}`);
}
