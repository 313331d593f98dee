"use strict";
// Links sliders, solver and figures: what is simulated, what of it is in view, and which event is chosen.

(async () => {
  const PIXELS_OF_A_BAR = 2; // what is narrower is drawn so wide
  const REACH = 14; // pixels around an event in which a click means it
  const ROOM = 0.35; // of an event's duration, free before and after it
  const RELATIVE_BELOW = 0.02; // s, narrower windows count time from an event's onset
  const FINE = 0.1; // Taylor window of the drawn motion [tau]
  const PLAY = 4000; // ms that an event is played for

  const element = (id) => document.getElementById(id);
  const { colors, scenes, duration, narrowest } = JSON.parse(element("data").textContent);
  const figures = JSON.parse(element("figures").textContent);
  await Bokeh.embed.embed_items(figures.documents, figures.items);
  const model = (name) => Bokeh.documents[0].get_model_by_name(name);
  const [load, raster, lengths, profile] = ["load", "raster", "lengths", "profile"].map(model);
  const range = load.x_range;
  const source = (name) => model(name === "profile" ? "profile source" : name);
  const sliders = [...document.querySelectorAll("#parameters input")];

  let parameters = { ...Object.values(scenes)[0] };
  let run = null, slides = [], counted = [], chosen = null, motion = null, playing = 0;

  // The first index of a sorted array at which key(value) is not less than x.
  function lowerBound(values, x, key = (value) => value) {
    let low = 0, high = values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (key(values[middle]) < x) low = middle + 1;
      else high = middle;
    }
    return low;
  }
  const columnsOf = (rows, names) => Object.fromEntries(names.map((name) => [name, rows.map((row) => row[name])]));
  const numberOf = (event) => run.events.indexOf(event) + 1;
  const lengthOf = (event) => (event.front / parameters.n_blocks) * parameters.length * 1e3;
  const kindOf = (event) =>
    event.isGlobal ? "global slip" : counted.includes(event) ? "precursor" : event.front < longestBefore(event) ? "short slip" : "partial slip";
  const longestBefore = (event) => Math.max(0, ...run.events.slice(0, numberOf(event) - 1).map((other) => other.front));
  const colorOf = (event) => (event.isGlobal ? colors.global : colors.partial);
  const firstGlobal = () => run.events.find((event) => event.isGlobal);

  // Simulate, and show everything.
  function solve() {
    const started = performance.now();
    run = simulate(
      chainOf({
        blocks: parameters.n_blocks, theta: parameters.theta, normalLoad: parameters.normal_load,
        muS: parameters.mu_s, muK: Math.min(parameters.mu_k, parameters.mu_s), driveStiffness: parameters.drive_stiffness,
        driveVelocity: parameters.drive_velocity, mass: parameters.slider_mass,
        stiffness: (parameters.youngs_modulus * parameters.cross_section) / parameters.length,
      }),
      duration,
    );
    counted = precursors(run.events);
    findSlides();
    document.body.dataset.milliseconds = (performance.now() - started).toFixed(1);
    range.setv({ bounds: [0, duration], max_interval: duration });
    raster.y_range.setv({ start: 0.4, end: parameters.n_blocks + 0.6 });
    const step = Math.ceil(parameters.n_blocks / 12);
    model("blocks").ticks = Array.from({ length: parameters.n_blocks }, (_, i) => i + 1).filter((i) => (i - 1) % step === 0);
    showParameters();
    showLengths();
    choose(chosen === null ? null : Math.min(chosen, run.events.length - 1), false);
    showWindow();
  }

  // Every slide of a block: from the transition that starts it to the block's next one.
  function findSlides() {
    slides = [];
    const open = new Map();
    run.events.forEach((event, number) => {
      for (let j = event.first; j < event.last; j++) {
        const before = open.get(run.block[j]);
        if (before) before.end = run.time[j];
        open.delete(run.block[j]);
        if (run.mode[j] === 0) continue;
        const slide = { event: number, block: run.block[j], mode: run.mode[j], start: run.time[j], end: event.end, load: run.load[j] };
        open.set(run.block[j], slide);
        slides.push(slide);
      }
      open.clear();
    });
  }

  function showParameters() {
    for (const slider of sliders) {
      const value = parameters[slider.id];
      slider.value = "logarithmic" in slider.dataset ? Math.log10(value) : value;
      element(`${slider.id}-value`).textContent = "logarithmic" in slider.dataset ? value.toPrecision(3) : value.toPrecision(4) * 1;
    }
    for (const button of document.querySelectorAll("[data-scene]")) {
      const scene = scenes[button.dataset.scene];
      button.setAttribute("aria-pressed", String(Object.keys(scene).every((name) => scene[name] === parameters[name])));
    }
    const slip = firstGlobal();
    const ratio = (Math.max(0, ...counted.map((event) => event.before)) / parameters.normal_load).toFixed(4);
    element("answers").innerHTML = slip
      ? `${counted.length} events counted in Fig. 13, &mu;<sub>sapp</sub> = ${ratio}, first global slip at ${slip.onset.toFixed(3)} s`
      : `no global slip in ${duration} s; largest load at an onset ${ratio} F<sub>Z</sub>`;
    element("first").disabled = !slip;
  }

  function showLengths() {
    const slip = firstGlobal();
    const rows = run.events.slice(0, slip ? numberOf(slip) : undefined).map((event) => ({
      load: event.before, reached: event.front / parameters.n_blocks, event: numberOf(event), kind: kindOf(event),
      onset: event.onset, length: lengthOf(event), isCounted: counted.includes(event),
    }));
    const names = ["load", "reached", "event", "kind", "onset", "length"];
    source("counted").data = columnsOf(rows.filter((row) => row.isCounted), names);
    source("short").data = columnsOf(rows.filter((row) => !row.isCounted), names);
    lengths.x_range.setv({ start: 0, end: 1.08 * Math.max(1, ...rows.map((row) => row.load)) });
  }

  // Points of F_X(t) in the window: within slips every transition, in a narrow window the motion between them.
  function curve(start, end) {
    const time = [], force = [];
    const add = (t, f) => (time.push(t), force.push(f));
    const rate = parameters.drive_stiffness * parameters.drive_velocity;
    let first = Math.max(lowerBound(run.events, start, (event) => event.end) - 1, 0);
    if (first === 0) add(0, 0);
    for (const event of run.events.slice(first)) {
      if (event.onset > end && time[time.length - 1] > end) break;
      add(event.onset, event.before);
      if (end - start < RELATIVE_BELOW && event.end > start && event.onset < end) {
        follow(event).forEach((state) => add(state.time, state.load));
      } else {
        for (let j = event.first; j < event.last; j++) add(run.time[j], run.load[j]);
      }
      add(event.end, event.after);
    }
    const last = run.events[run.events.length - 1];
    if (!(time[time.length - 1] > end)) add(duration, last ? last.after + rate * (duration - last.end) : rate * duration);
    return { time, load: force };
  }

  // The motion in an event: time, load, velocities and modes at the ends of small steps.
  function follow(event) {
    if (event.motion) return event.motion;
    const { chain } = run, states = [];
    slipEvent(chain, event.force.slice(), (duration - event.onset) / chain.tau, (t, i, m, force, velocity) => {
      const v = Array.from(velocity.subarray(1, chain.n + 1), (value) => value * chain.velocityUnit);
      states.push({ time: event.onset + t * chain.tau, load: force[1], velocity: v });
    }, FINE);
    return (event.motion = states);
  }

  function showWindow() {
    const { start, end } = range;
    const drawn = curve(start, end);
    source("curve").data = drawn;
    let low = Infinity, high = -Infinity;
    const see = (f) => ((low = Math.min(low, f)), (high = Math.max(high, f)));
    const at = (t) => {
      const i = Math.min(Math.max(lowerBound(drawn.time, t), 1), drawn.time.length - 1);
      const [t0, t1, f0, f1] = [drawn.time[i - 1], drawn.time[i], drawn.load[i - 1], drawn.load[i]];
      return t1 > t0 ? f0 + ((f1 - f0) * (t - t0)) / (t1 - t0) : f1;
    };
    [start, end].forEach((t) => see(at(t)));
    drawn.time.forEach((t, i) => { if (t >= start && t <= end) see(drawn.load[i]); });
    const room = 0.08 * (high - low) || 1;
    load.y_range.setv({ start: low - room, end: high + room });
    const inside = run.events.filter((event) => event.onset >= start && event.onset <= end);
    source("onsets").data = {
      ...columnsOf(inside, ["onset", "before"]), event: inside.map(numberOf), length: inside.map(lengthOf),
      kind: inside.map(kindOf), color: inside.map(colorOf),
    };
    const bar = (PIXELS_OF_A_BAR * (end - start)) / (raster.inner_width || 800);
    const seen = slides.filter((slide) => slide.end >= start && slide.start <= end);
    source("slides").data = {
      ...columnsOf(seen, ["start", "block", "load"]), event: seen.map((slide) => slide.event + 1),
      left: seen.map((slide) => Math.max(slide.start, start)),
      right: seen.map((slide) => Math.min(Math.max(slide.end, slide.start + bar), end)),
      bottom: seen.map((slide) => slide.block - 0.42), top: seen.map((slide) => slide.block + 0.42),
      way: seen.map((slide) => (slide.mode > 0 ? "forward" : "backward")),
      lasts: seen.map((slide) => 1e6 * (slide.end - slide.start)),
      color: seen.map((slide) => (slide.mode < 0 ? colors.backward : colorOf(run.events[slide.event]))),
    };
    showTicks(start, end);
    showReadout();
    keepState();
  }

  // Ticks at round numbers of seconds or, in a narrow window, of time since the onset of an event.
  function showTicks(start, end) {
    const span = end - start;
    let zero = 0, unit = 1, label = "Time t [s]";
    const event = nearest((start + end) / 2).event;
    if (span < RELATIVE_BELOW && event !== null) {
      zero = run.events[event].onset;
      const [factor, name] = span < 2e-3 ? [1e-6, "\u00b5s"] : [1e-3, "ms"];
      unit = factor;
      label = `Time since the onset of event ${event + 1} [${name}]`;
    }
    const rough = span / unit / 8;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const labels = new Map();
    for (let i = Math.ceil((start - zero) / unit / step); i * step * unit + zero <= end; i++) {
      labels.set(zero + i * step * unit, (i * step || 0).toFixed(decimals));
    }
    for (const plot of [load, raster]) plot.below[0].major_label_overrides = labels;
    raster.below[0].axis_label = label;
    model("ticks").ticks = [...labels.keys()];
  }

  function showReadout() {
    if (chosen === null) return (element("readout").textContent = "");
    const event = run.events[chosen];
    element("readout").textContent =
      `Event ${chosen + 1} of ${run.events.length}, ${kindOf(event)}: onset ${event.onset.toFixed(9)} s, lasts ` +
      `${(1e6 * (event.end - event.onset)).toFixed(2)} \u00b5s, F\u2093 ${event.before.toFixed(3)} \u2192 ` +
      `${event.after.toFixed(3)} N, L\u209a ${lengthOf(event).toFixed(1)} mm (${event.front} of ${parameters.n_blocks} blocks).`;
  }

  // The event nearest to a time, and how far away it is: 0 inside the event.
  function nearest(time) {
    const after = lowerBound(run.events, time, (event) => event.onset);
    let best = { distance: Infinity, event: null };
    for (const i of [after - 1, after]) {
      if (i < 0 || i >= run.events.length) continue;
      const distance = Math.max(run.events[i].onset - time, time - run.events[i].end, 0);
      if (distance < best.distance) best = { distance, event: i };
    }
    return best;
  }

  // Choose an event (or none): its ring in Fig. 13, its motion, and with `jump` the window around it.
  function choose(event, jump = true) {
    chosen = event === null || event < 0 ? null : event;
    stop();
    motion = chosen === null ? null : follow(run.events[chosen]);
    const one = chosen === null ? [] : [run.events[chosen]];
    source("chosen").data = { load: one.map((e) => e.before), reached: one.map((e) => e.front / parameters.n_blocks) };
    element("play").disabled = element("moment").disabled = chosen === null;
    profile.x_range.setv({ start: 0.4, end: parameters.n_blocks + 0.6 });
    const fastest = motion ? motion.flatMap((state) => state.velocity) : [];
    const high = fastest.reduce((a, b) => Math.max(a, b), motion ? 1e-9 : 1), low = fastest.reduce((a, b) => Math.min(a, b), 0);
    profile.y_range.setv({ start: 1.05 * low, end: 1.05 * high });
    showMoment(Number(element("moment").value));
    if (chosen !== null && jump) {
      const { onset, end } = run.events[chosen];
      setWindow(onset - ROOM * (end - onset), end + ROOM * (end - onset));
    }
  }

  // The velocities of all blocks at a moment of the chosen event, from 0 (onset) to 1 (end).
  function showMoment(share) {
    if (!motion) {
      model("cursor").location = null;
      source("profile").data = { block: [], velocity: [], color: [] };
      return;
    }
    const { onset, end } = run.events[chosen];
    const time = onset + share * (end - onset);
    const state = motion[Math.min(lowerBound(motion, time, (s) => s.time), motion.length - 1)];
    model("cursor").location = time;
    source("profile").data = {
      block: state.velocity.map((_, i) => i + 1), velocity: state.velocity,
      color: state.velocity.map((v) => (v < 0 ? colors.backward : colorOf(run.events[chosen]))),
    };
  }

  function play() {
    const started = performance.now(), from = Number(element("moment").value) % 1;
    const frame = (now) => {
      const share = Math.min(from + Math.max(now - started, 0) / PLAY, 1);
      element("moment").value = share;
      showMoment(share);
      playing = share < 1 ? requestAnimationFrame(frame) : 0;
    };
    stop();
    playing = requestAnimationFrame(frame);
  }
  function stop() {
    if (playing) cancelAnimationFrame(playing);
    playing = 0;
  }

  let scheduled = null; // work for the next frame: "window" or "solve"
  function schedule(what) {
    if (scheduled === null) {
      requestAnimationFrame(() => {
        const task = scheduled;
        scheduled = null;
        if (task === "solve") solve();
        else showWindow();
      });
    }
    scheduled = scheduled === "solve" ? "solve" : what;
  }

  function setWindow(start, end) {
    const missing = Math.max(narrowest - (end - start), 0) / 2;
    range.setv({ start: Math.max(start - missing, 0), end: Math.min(end + missing, duration) });
    schedule("window");
  }

  // The state is in the address: parameters, window, event.
  function keepState() {
    const state = new URLSearchParams(sliders.map((slider) => [slider.id, parameters[slider.id]]));
    state.set("from", range.start);
    state.set("to", range.end);
    if (chosen !== null) state.set("event", chosen + 1);
    history.replaceState(null, "", `#${state}`);
  }
  function restoreState() {
    const state = new URLSearchParams(location.hash.slice(1));
    for (const slider of sliders) {
      const value = Number(state.get(slider.id));
      const actual = "logarithmic" in slider.dataset ? Math.log10(value) : value;
      if (state.has(slider.id) && actual >= slider.min && actual <= slider.max) parameters[slider.id] = value;
    }
    parameters.n_blocks = Math.round(parameters.n_blocks);
    const [from, to] = ["from", "to"].map((name) => Number(state.get(name)));
    range.setv(to > from && from >= 0 && to <= duration ? { start: from, end: to } : { start: 0, end: duration });
    if (state.has("event")) chosen = Math.max(Number(state.get("event")) - 1, 0) || 0;
  }

  async function showOwn(file) {
    const rows = (await file.text()).split(/\r?\n/).map((line) => line.split(/[,;\s]+/).map(Number));
    const points = rows.filter(([t, f]) => Number.isFinite(t) && Number.isFinite(f));
    source("own").data = { time: points.map((row) => row[0]), load: points.map((row) => row[1]) };
  }

  for (const slider of sliders) {
    slider.addEventListener("input", () => {
      const value = Number(slider.value);
      parameters[slider.id] = "logarithmic" in slider.dataset ? 10 ** value : value;
      if (slider.id === "mu_s") parameters.mu_k = Math.min(parameters.mu_k, parameters.mu_s);
      if (slider.id === "mu_k") parameters.mu_s = Math.max(parameters.mu_k, parameters.mu_s);
      schedule("solve");
    });
  }
  for (const button of document.querySelectorAll("[data-scene]")) {
    button.addEventListener("click", () => {
      parameters = { ...scenes[button.dataset.scene] };
      chosen = null;
      schedule("solve");
    });
  }
  for (const name of ["start", "end"]) range.properties[name].change.connect(() => schedule("window"));
  raster.properties.inner_width.change.connect(() => schedule("window"));
  for (const plot of [load, raster]) {
    plot.on_event("tap", (click) => {
      const { distance, event } = nearest(click.x);
      if ((distance * load.inner_width) / (range.end - range.start) <= REACH) choose(event);
    });
  }
  lengths.on_event("tap", (click) => {
    const across = lengths.inner_width / (lengths.x_range.end - lengths.x_range.start);
    const up = lengths.inner_height / (lengths.y_range.end - lengths.y_range.start);
    const slip = firstGlobal();
    let best = REACH, found = null;
    run.events.slice(0, slip ? numberOf(slip) : undefined).forEach((event, i) => {
      const distance = Math.hypot((event.before - click.x) * across, (event.front / parameters.n_blocks - click.y) * up);
      if (distance <= best) [best, found] = [distance, i];
    });
    if (found !== null) choose(found);
  });
  element("whole").addEventListener("click", () => setWindow(0, duration));
  element("first").addEventListener("click", () => setWindow(0, 1.03 * firstGlobal().onset));
  element("next").addEventListener("click", () => run.events.length && choose(chosen === null ? 0 : Math.min(chosen + 1, run.events.length - 1)));
  element("previous").addEventListener("click", () => run.events.length && choose(Math.max((chosen ?? 1) - 1, 0)));
  element("play").addEventListener("click", play);
  element("moment").addEventListener("input", () => (stop(), showMoment(Number(element("moment").value))));
  element("own").addEventListener("change", () => showOwn(element("own").files[0]));
  restoreState();
  solve();
  document.body.dataset.ready = "true";
})();
