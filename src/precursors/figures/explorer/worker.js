"use strict";
// Runs in a worker, after solver.js: solves requests in short slices, so that a newer request is heard in between.

const SLICE = 8; // ms
const PATIENCE = 200; // ms of work on a request, after which what is there is shown
const FINE = 0.1; // Taylor window of a motion that is played [tau]
const MOST_STATES = 4000; // of a motion

let job = null, waiting = null, motion = null, idle = true;
const clock = new MessageChannel();
clock.port1.onmessage = work;

onmessage = ({ data }) => {
  if (data.text !== undefined) return postMessage({ kind: "measurement", ...readMeasurement(data.text) });
  if (data.event !== undefined) motion = job?.id === data.id ? follow(job, data.event) : motion;
  else if (job && job.key === JSON.stringify(data.chains)) hearAgain(data);
  else if (job && !job.shown) waiting = data; // the one before is shown first: else a fast hand would see nothing
  else begin(data);
  if (idle) clock.port2.postMessage(0);
  idle = false;
};

// The same chains once more, for example because a slider is let go.
function hearAgain({ id, all }) {
  Object.assign(job, { id, all });
  waiting = null;
  if (job.done) job.runs.forEach((_, slot) => send(slot, true));
}

function begin(request) {
  const runs = request.chains.map((slider) => {
    const chain = chainOf(slider);
    const weights = chain.weights.map((load, j) => (j ? load : load * (1 + slider.nudge)));
    return newRun(slider.nudge ? chainOf({ ...slider, weights }) : chain, request.duration);
  });
  job = { ...request, key: JSON.stringify(request.chains), runs, started: performance.now(), shown: false, first: false, done: false };
  job.steps = stages(job);
  waiting = motion = null;
}

// All runs up to the first global slip, then all runs to their end.
function* stages({ runs }) {
  const steps = runs.map(solve);
  for (const isLast of [false, true]) {
    for (const [slot, run] of runs.entries()) {
      for (let count = -1; isLast || !run.events.at(-1)?.isGlobal || count === -1; ) {
        const step = steps[slot].next();
        if (step.done) break;
        count = run.events.length;
        yield step.value;
      }
      send(slot, isLast);
    }
    job.first = job.shown = true;
  }
}

// One slice of work; then the messages that have come in are heard.
function work() {
  const until = performance.now() + SLICE;
  let time = 0;
  do {
    if (motion) {
      if (motion.next().done) motion = null;
    } else if (job && waiting && job.shown) begin(waiting);
    else if (job && !job.done && (job.all || !job.first)) {
      const step = job.steps.next();
      if (step.done) job.done = true;
      else time = step.value;
    } else {
      idle = true;
      return;
    }
  } while (performance.now() < until);
  if (job && !job.done && performance.now() - job.started > PATIENCE) {
    if (!job.shown) job.runs.forEach((_, slot) => send(slot, false));
    job.shown = true;
    postMessage({ kind: "progress", id: job.id, share: time / job.duration });
  }
  clock.port2.postMessage(0);
}

// What the page draws of a run so far: the curve F_X(t), the slides of all blocks, the events and the forces between them.
function send(slot, isFinal) {
  const { id, runs, duration } = job, run = runs[slot], { chain, time, block, mode, load, events } = run;
  const curve = { time: [0], load: [0] }, slides = { start: [], end: [], block: [], kind: [] };
  const forces = new Float64Array((events.length + 1) * (chain.n + 2));
  events.forEach((event, e) => {
    forces.set(event.force, e * (chain.n + 2));
    curve.time.push(event.onset), curve.load.push(event.before);
    const open = {}; // the slide that each sliding block is in
    for (let j = event.first; j < event.last; j++) {
      curve.time.push(time[j]), curve.load.push(load[j]);
      if (block[j] in open) slides.end[open[block[j]]] = time[j];
      delete open[block[j]];
      if (!mode[j]) continue;
      open[block[j]] = slides.start.length;
      slides.start.push(time[j]), slides.end.push(event.end), slides.block.push(block[j]);
      slides.kind.push(mode[j] === -1 ? 2 : event.isGlobal ? 1 : 0);
    }
    curve.time.push(event.end), curve.load.push(event.after);
  });
  forces.set(run.force, events.length * (chain.n + 2));
  if (run.end === duration) curve.time.push(duration), curve.load.push(run.force[1]);
  const arrays = { time: Float64Array.from(curve.time), load: Float64Array.from(curve.load), forces };
  const bars = { start: Float64Array.from(slides.start), end: Float64Array.from(slides.end), block: Uint8Array.from(slides.block), kind: Uint8Array.from(slides.kind) };
  const told = events.map(({ force, ...event }) => event);
  postMessage(
    { kind: "run", id, slot, isFinal, arrays, bars, events: told, end: run.end, stopped: run.stopped, transitions: time.length,
      n: chain.n, k: chain.k, weights: chain.weights, strength: Array.from(chain.strength), slider: job.chains[slot] },
    [...Object.values(arrays), ...Object.values(bars)].map((array) => array.buffer),
  );
}

// The motion in an event: times, forces and modes at the ends of small steps.
function* follow({ id, runs, duration }, number) {
  const { chain, events } = runs[0], event = events[number], modes = new Int8Array(chain.n + 2);
  const length = (event.end - event.onset) / chain.tau, window = Math.min(Math.max(FINE, length / MOST_STATES), WINDOW);
  const states = { time: [], forces: [], modes: [] };
  let due = 0;
  const steps = slipEvent(chain, event.force.slice(), (duration - event.onset) / chain.tau, (t, i, mode, force) => {
    if (i) modes[i] = mode;
    if (t < due && !(i && length < MOST_STATES * FINE)) return;
    due = t + length / MOST_STATES;
    states.time.push(event.onset + t * chain.tau), states.forces.push(...force), states.modes.push(...modes);
  }, window);
  for (const t of steps) {
    if (t > length) break;
    yield t;
  }
  postMessage({ kind: "motion", id, event: number, time: Float64Array.from(states.time), forces: Float32Array.from(states.forces), modes: Int8Array.from(states.modes) });
}

// Times [s] and loads [N] of a text with two columns, or the `problem` with the line that it is in.
// Semicolons, tabs, spaces or commas part the columns. Unless commas do, a number may have a decimal comma.
function readMeasurement(text) {
  const time = [], load = [], lines = text.replace(/^\ufeff/, "").split(/\r\n?|\n/);
  const isNumber = (word) => /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(word);
  const sign = [";", "\t"].find((sign) => lines.some((line) => line.includes(sign)));
  for (const [at, whole] of lines.entries()) {
    const line = whole.trim().replaceAll('"', "");
    if (!line || line.startsWith("#")) continue;
    const commas = !sign && (/,\s/.test(line) || !/\s/.test(line));
    const words = line.split(sign ?? (commas ? "," : /\s+/)).slice(0, 2).map((word) => word.trim());
    const numbers = commas ? words : words.map((word) => word.replace(",", "."));
    if (!time.length && !numbers.some(isNumber)) continue; // a header
    const wrong = numbers.findIndex((word) => !isNumber(word));
    if (wrong >= 0) return { problem: `Line ${at + 1}: “${words[wrong].slice(0, 40)}” is not a number.` };
    if (numbers.length < 2) return { problem: `Line ${at + 1}: there must be two numbers, time [s] and load [N].` };
    if (Number(numbers[0]) < time.at(-1)) return { problem: `Line ${at + 1}: the time goes back to ${words[0]} s.` };
    time.push(Number(numbers[0])), load.push(Number(numbers[1]));
  }
  return time.length ? { time, load } : { problem: "No line of the file has two numbers, time [s] and load [N]." };
}
