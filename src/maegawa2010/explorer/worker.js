// Runs in two workers, after solver.js: one solves the chain, the other its twin. They work in short slices, so that a
// newer request is heard in between.

const SLICE = 8; // ms
const PATIENCE = 200; // ms of work on a request, after which what is there is shown
const FINE = 0.1; // Taylor window of a motion that is played [tau]
const MOST_STATES = 4000; // of a motion
const ROUNDINGS = 64; // in which a number of the twin differs, as in analysis/horizon.py

let job = null, motion = null, idle = true;
const clock = new MessageChannel();
clock.port1.onmessage = work;

onmessage = ({ data }) => {
  if (data.force) motion = follow(data);
  else {
    const run = newRun(data.isTwin ? twinOf(data.slider) : chainOf(data.slider), data.duration);
    job = { ...data, run, steps: solve(run), started: performance.now(), isFirst: false, isShown: false, isDone: false };
    if (!data.study) motion = null;
  }
  if (idle) clock.port2.postMessage(0);
  idle = false;
};

// A slider whose numbers differ by roundings from those of another: its run shows how far rounding errors grow.
function twinOf(slider) {
  let count = 0;
  const near = (value) => value * (1 + (ROUNDINGS / 2) * Number.EPSILON * Math.SQRT2 * Math.cos(++count * count));
  const twin = Object.fromEntries(Object.entries(slider).map(([name, value]) => [name, near(value)]));
  const weights = chainOf(slider).weights.map(near);
  return chainOf({ ...twin, mu_k: Math.min(twin.mu_k, twin.mu_s), n_blocks: slider.n_blocks, weights });
}

// One slice of work; then the messages that have come in are heard. A run is sent at its first global slip and at its end.
function work() {
  const until = performance.now() + SLICE;
  do {
    if (motion) {
      if (motion.next().done) motion = null;
    } else if (job && !job.isDone && (job.all || !job.isFirst)) {
      job.isDone = job.steps.next().done;
      const isFirst = job.isFirst || Boolean(job.run.events.at(-1)?.isGlobal);
      if (job.isDone || isFirst !== job.isFirst) send();
      job.isFirst = isFirst;
    } else return (idle = true);
  } while (performance.now() < until);
  if (job && !job.study && !job.isDone && performance.now() - job.started > PATIENCE) {
    if (!job.isShown) send();
    postMessage({ kind: "progress", id: job.id, share: job.run.end / job.duration });
  }
  clock.port2.postMessage(0);
}

// What the page draws of a run so far: its transitions between the start and the end, which have block 0, its events, and
// the spring forces between them.
function send() {
  const { id, run, slider, isDone } = job, { chain, events, end, stopped } = run, last = events.at(-1)?.last ?? 0;
  const between = (first, values, end) => [first, ...values.slice(0, last), end], forces = new Float64Array((events.length + 1) * (chain.n + 2));
  [...events.map((event) => event.force), run.force].forEach((force, e) => forces.set(force, e * (chain.n + 2)));
  const arrays = {
    time: Float64Array.from(between(0, run.time, end)), load: Float64Array.from(between(0, run.load, run.force[1])),
    block: Uint8Array.from(between(0, run.block, 0)), mode: Int8Array.from(between(0, run.mode, 0)), forces,
  };
  const { n, k, weights, strength } = chain, told = events.map(({ force, ...event }) => event);
  postMessage({ kind: "run", id, isFinal: isDone, arrays, events: told, end, stopped, n, k, weights, strength, slider }, Object.values(arrays).map((array) => array.buffer));
  job.isShown = true;
}

// The motion in an event from the spring forces at its onset: times, forces and modes at the ends of small steps.
function* follow({ id, slider, duration, event, onset, end, force, start }) {
  const chain = chainOf(slider), modes = new Int8Array(chain.n + 2);
  const length = (end - onset) / chain.tau, window = Math.min(Math.max(FINE, length / MOST_STATES), WINDOW);
  const states = { time: [], forces: [], modes: [] };
  let due = 0;
  const steps = motionFrom(chain, force, (duration - onset) / chain.tau, (t, i, mode, forces) => {
    if (i) modes[i] = mode;
    if (t < due && !(i && length < MOST_STATES * FINE)) return;
    due = t + length / MOST_STATES;
    states.time.push(onset + t * chain.tau), states.forces.push(...forces), states.modes.push(...modes);
  }, window, start);
  for (const t of steps) {
    if (t > length) break;
    yield t;
  }
  postMessage({ kind: "motion", id, event, time: Float64Array.from(states.time), forces: Float32Array.from(states.forces), modes: Int8Array.from(states.modes) });
}
