// Links the panels: decides what of a scene is in view, hands it to the figures, and jumps to events.
"use strict";

(async () => {
  const PIXELS_OF_A_BAR = 2; // what is narrower is drawn so wide
  const REACH = 14; // pixels around an event in which a click means it
  const ROOM = 0.35; // of an event's duration, left free before and after it after a jump
  const RELATIVE_BELOW = 0.02; // s, windows narrower than this count time from an event's onset

  const read = (id) => JSON.parse(document.getElementById(id).textContent);
  const unpack = (text) =>
    new Float64Array(Uint8Array.from(atob(text), (character) => character.charCodeAt(0)).buffer);
  const unpackAll = (columns) =>
    Object.fromEntries(Object.entries(columns).map(([name, text]) => [name, unpack(text)]));

  const { colors, scenes } = read("data");
  for (const scene of scenes) {
    for (const part of ["curve", "slides", "events"]) scene[part] = unpackAll(scene[part]);
  }
  const figures = read("figures");
  await Bokeh.embed.embed_items(figures.documents, figures.items);
  const model = (name) => Bokeh.documents[0].get_model_by_name(name);
  const [load, raster, lengths] = ["load", "raster", "lengths"].map(model);
  const range = load.x_range;
  const ticker = model("ticks");
  const sources = Object.fromEntries(
    ["curve", "onsets", "slides", "short", "kept", "chosen"].map((name) => [name, model(name)]),
  );

  let scene = scenes[0];
  let chosen = null; // number of the event last jumped to, from 0

  // First index of a sorted array whose value is not less than x.
  function lowerBound(values, x) {
    let [low, high] = [0, values.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[middle] < x) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  function loadAt(time) {
    const { time: t, load: f } = scene.curve;
    const i = Math.min(Math.max(lowerBound(t, time), 1), t.length - 1);
    return f[i - 1] + ((f[i] - f[i - 1]) * (time - t[i - 1])) / (t[i] - t[i - 1]);
  }

  // Points of F_X(t) from one time to another, with the ends between points.
  function curveBetween(start, end) {
    const { time, load: force } = scene.curve;
    const [first, last] = [lowerBound(time, start), lowerBound(time, end)];
    return {
      time: Float64Array.of(start, ...time.subarray(first, last), end),
      load: Float64Array.of(loadAt(start), ...force.subarray(first, last), loadAt(end)),
    };
  }

  const lengthOf = (event) => (scene.events.front[event] / scene.blocks) * scene.length_mm;
  const kindOf = (s, event) =>
    s.events.is_global[event] ? "global slip" : s.events.kept[event] ? "precursor" : "partial slip";
  const colorOf = (event) => (scene.events.is_global[event] ? colors.global : colors.partial);
  const upTo = (n) => Array.from({ length: n }, (_, i) => i);
  const pick = (columns, rows) =>
    Object.fromEntries(Object.entries(columns).map(([name, values]) => [name, rows.map((i) => values[i])]));

  function showCurve(start, end, margin) {
    const curve = curveBetween(Math.max(start - margin, 0), Math.min(end + margin, scene.duration));
    sources.curve.data = curve;
    const seen = curveBetween(start, end).load;
    let [low, high] = [Infinity, -Infinity];
    for (const force of seen) [low, high] = [Math.min(low, force), Math.max(high, force)];
    const room = 0.08 * (high - low) || 1;
    load.y_range.setv({ start: low - room, end: high + room });
  }

  function showOnsets(start, end) {
    const { events } = scene;
    const inside = upTo(events.onset.length).filter((i) => events.onset[i] >= start && events.onset[i] <= end);
    sources.onsets.data = {
      ...pick({ onset: events.onset, before: events.before }, inside),
      event: inside.map((i) => i + 1),
      length: inside.map(lengthOf),
      what: inside.map((i) => kindOf(scene, i)),
      color: inside.map(colorOf),
    };
  }

  function showSlides(start, end, narrowest) {
    const { slides } = scene;
    const inside = upTo(slides.start.length).filter((i) => slides.end[i] >= start && slides.start[i] <= end);
    sources.slides.data = {
      ...pick({ start: slides.start, end: slides.end, load: slides.load, event: slides.event, block: slides.block }, inside),
      left: inside.map((i) => Math.max(slides.start[i], start)),
      right: inside.map((i) => Math.min(Math.max(slides.end[i], slides.start[i] + narrowest), end)),
      bottom: inside.map((i) => slides.block[i] - 0.42),
      top: inside.map((i) => slides.block[i] + 0.42),
      mode: inside.map((i) => (slides.mode[i] > 0 ? "forward" : "backward")),
      lasts: inside.map((i) => 1e6 * (slides.end[i] - slides.start[i])),
      length: inside.map((i) => lengthOf(slides.event[i] - 1)),
      color: inside.map((i) => (slides.mode[i] < 0 ? colors.backward : colorOf(slides.event[i] - 1))),
    };
  }

  // The event nearest to a time: 0 inside it, else how far its onset or end is.
  function nearestEvent(time) {
    const { onset, end } = scene.events;
    const after = lowerBound(onset, time);
    let best = [Infinity, null];
    for (const i of [after - 1, after]) {
      if (i < 0 || i >= onset.length) continue;
      const distance = Math.max(onset[i] - time, time - end[i], 0);
      if (distance < best[0]) best = [distance, i];
    }
    return { distance: best[0], event: best[1] };
  }

  // Ticks at round numbers of seconds or, in a narrow window, of time since an event's onset.
  function showTicks(start, end) {
    const span = end - start;
    let [zero, unit, label] = [0, 1, "Time t [s]"];
    const { event } = nearestEvent((start + end) / 2);
    if (span < RELATIVE_BELOW && event !== null) {
      zero = scene.events.onset[event];
      const [factor, name] = span < 2e-3 ? [1e-6, "\u00b5s"] : [1e-3, "ms"];
      unit = factor;
      label = `Time since the onset of event ${event + 1} at ${zero.toFixed(9)} s [${name}]`;
    }
    const rough = span / unit / 8;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const first = Math.ceil((start - zero) / unit / step);
    const last = Math.floor((end - zero) / unit / step);
    const numbers = upTo(Math.max(last - first + 1, 0)).map((i) => (first + i) * step);
    const ticks = numbers.map((number) => zero + number * unit);
    const labels = new Map(ticks.map((tick, i) => [tick, (numbers[i] || 0).toFixed(decimals)]));
    for (const plot of [load, raster]) plot.below[0].major_label_overrides = labels;
    raster.below[0].axis_label = label;
    ticker.ticks = ticks;
  }

  function showWindow() {
    const { start, end } = range;
    const span = end - start;
    showCurve(start, end, span);
    showOnsets(start, end);
    showSlides(start, end, (PIXELS_OF_A_BAR * span) / (raster.inner_width || 800));
    showTicks(start, end);
    showReadout();
  }

  function showReadout() {
    const span = range.end - range.start;
    const width =
      span < 1e-3 ? `${(1e6 * span).toFixed(1)} \u00b5s` : span < 1 ? `${(1e3 * span).toFixed(3)} ms` : `${span.toFixed(3)} s`;
    let text = `Window ${width}.`;
    if (chosen !== null) {
      const { onset, end, before, after, front } = scene.events;
      const i = chosen;
      const unfinished = Number.isNaN(after[i]);
      text +=
        ` Event ${i + 1} of ${onset.length}, ${kindOf(scene, i)}: onset ${onset[i].toFixed(9)} s, ` +
        (unfinished ? "not over when the run ends, " : `lasts ${(1e6 * (end[i] - onset[i])).toFixed(2)} \u00b5s, `) +
        `F_X ${before[i].toFixed(3)}` + (unfinished ? "" : ` \u2192 ${after[i].toFixed(3)}`) +
        ` N, L_p ${lengthOf(i).toFixed(1)} mm (${front[i]} of ${scene.blocks} blocks).`;
    }
    document.getElementById("readout").textContent = text;
  }

  let scheduled = false;
  function schedule() {
    if (scheduled) return;
    scheduled = true;
    requestAnimationFrame(() => {
      scheduled = false;
      showWindow();
    });
  }

  function setWindow(start, end) {
    const missing = Math.max(scene.narrowest - (end - start), 0) / 2;
    range.setv({ start: Math.max(start - missing, 0), end: Math.min(end + missing, scene.duration) });
    schedule();
  }

  function jumpTo(event) {
    const { onset, end, before, front } = scene.events;
    chosen = event;
    const room = ROOM * (end[event] - onset[event]);
    sources.chosen.data = { load: [before[event]], reached: [front[event] / scene.blocks] };
    setWindow(onset[event] - room, end[event] + room);
  }

  const firstGlobal = (s) => s.events.is_global.indexOf(1);

  function choose(next) {
    scene = next;
    chosen = null;
    sources.chosen.data = { load: [], reached: [] };
    for (const button of document.querySelectorAll("[data-scene]")) {
      button.setAttribute("aria-pressed", String(button.dataset.scene === scene.name));
    }
    const event = firstGlobal(scene);
    model("first global slip").location = event < 0 ? null : scene.events.onset[event];
    document.getElementById("growth").disabled = event < 0;
    range.setv({ bounds: [0, scene.duration], max_interval: scene.duration });
    raster.y_range.setv({ start: 0.4, end: scene.blocks + 0.6 });
    model("blocks").ticks = blockTicks();
    setWindow(0, scene.duration);
  }

  function blockTicks() {
    const step = Math.ceil(scene.blocks / 12);
    return upTo(scene.blocks).map((i) => i + 1).filter((block) => (block - 1) % step === 0 || block === scene.blocks);
  }

  // Fig. 13: what happened up to and including the first global slip of each scene.
  function showLengths() {
    const palette = { "-1": colors.global, 0: "#000000", 1: colors.partial };
    const rows = scenes.flatMap((s) => {
      const last = firstGlobal(s) < 0 ? s.events.onset.length - 1 : firstGlobal(s);
      return upTo(last + 1).map((i) => ({
        load: s.events.before[i],
        reached: s.events.front[i] / s.blocks,
        length: (s.events.front[i] / s.blocks) * s.length_mm,
        event: i + 1,
        scene: `${s.name}, ${s.theta}`,
        name: s.name,
        what: s.events.kept[i] ? kindOf(s, i) : "short event",
        onset: s.events.onset[i],
        color: palette[s.sign],
        fill: s.sign < 0 ? palette[s.sign] : "rgba(255, 255, 255, 0)",
        size: 9 + 3 * s.sign,
        kept: s.events.kept[i],
      }));
    });
    const table = (chosenRows) =>
      Object.fromEntries(Object.keys(rows[0] ?? {}).map((name) => [name, chosenRows.map((row) => row[name])]));
    sources.kept.data = table(rows.filter((row) => row.kept));
    sources.short.data = table(rows.filter((row) => !row.kept));
    const most = rows.reduce((largest, row) => Math.max(largest, row.load), 1);
    lengths.x_range.setv({ start: 0, end: 1.08 * most, reset_start: 0, reset_end: 1.08 * most });
    return rows;
  }

  function onLengths(rows, click) {
    const across = lengths.inner_width / (lengths.x_range.end - lengths.x_range.start);
    const up = lengths.inner_height / (lengths.y_range.end - lengths.y_range.start);
    let best = [REACH, null];
    for (const row of rows) {
      const distance = Math.hypot((row.load - click.x) * across, (row.reached - click.y) * up);
      if (distance <= best[0]) best = [distance, row];
    }
    const row = best[1];
    if (row === null) return;
    if (row.name !== scene.name) choose(scenes.find((s) => s.name === row.name));
    jumpTo(row.event - 1);
  }

  function onTime(click) {
    const { distance, event } = nearestEvent(click.x);
    if ((distance * load.inner_width) / (range.end - range.start) <= REACH) jumpTo(event);
  }

  // The next event in a direction: of the one last jumped to, or of the middle of the window.
  function step(direction) {
    const { onset } = scene.events;
    if (onset.length === 0) return;
    const after = lowerBound(onset, (range.start + range.end) / 2);
    const next = chosen === null ? (direction > 0 ? after : after - 1) : chosen + direction;
    jumpTo(Math.min(Math.max(next, 0), onset.length - 1));
  }

  const rows = showLengths();
  for (const name of ["start", "end"]) range.properties[name].change.connect(schedule);
  raster.properties.inner_width.change.connect(schedule);
  load.on_event("tap", onTime);
  raster.on_event("tap", onTime);
  lengths.on_event("tap", (click) => onLengths(rows, click));
  for (const button of document.querySelectorAll("[data-scene]")) {
    button.addEventListener("click", () => choose(scenes.find((s) => s.name === button.dataset.scene)));
  }
  document.getElementById("whole").addEventListener("click", () => setWindow(0, scene.duration));
  document.getElementById("growth").addEventListener("click", () =>
    setWindow(0, 1.03 * scene.events.onset[firstGlobal(scene)]),
  );
  document.getElementById("previous").addEventListener("click", () => step(-1));
  document.getElementById("next").addEventListener("click", () => step(+1));
  choose(scene);
  document.body.dataset.ready = "true";
})();
