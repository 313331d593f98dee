// Runs in a worker, after solver.js. It simulates each slider and a twin that differs by roundings,
// in short slices of time, so that it can react to a newer request in between.

const SLICE = 8; // ms
const PATIENCE = 200; // ms after which an incomplete run is shown
const FINE = 0.1; // Taylor window of a motion that is animated [tau]
const MOST_STATES = 4000; // of a motion
const ROUNDINGS = 64; // by which inputs of the twin differ, as in analysis/horizon.py
const APART = 10; // ratio of the distance of a run from its twin to its rounding errors

let job = null, motion = null, isIdle = true;
const clock = new MessageChannel();
clock.port1.onmessage = work;

onmessage = ({ data }) => {
  if (data.event === undefined) {
    const pairs = data.sliders.map((slider) => newPair(slider, data.duration));
    job = { ...data, pairs, sent: performance.now() };
    motion = null;
  } else if (data.id === job.id) motion = follow(job.pairs[0].runs[0], data);
  if (isIdle) clock.port2.postMessage(0);
  isIdle = false;
};

// A run and its twin, the number of transitions on which they agree so far, and until when they agree
// [s].
function newPair(slider, duration) {
  const runs = [chainOf, twinOf].map((make) => newRun(make(slider), duration));
  for (const run of runs) run.steps = solve(run);
  return { slider, runs, same: 0, known: Infinity };
}

// A slider whose inputs differ by roundings: its run shows how rounding errors grow.
function twinOf(slider) {
  const size = (ROUNDINGS / 2) * Number.EPSILON * Math.SQRT2, twin = { ...slider };
  let count = 0;
  const near = (value) => value * (1 + size * Math.cos(++count * count));
  for (const name in slider) twin[name] = near(slider[name]);
  const weights = chainOf(slider).weights.map(near), mu_k = Math.min(twin.mu_k, twin.mu_s);
  return chainOf({ ...twin, mu_k, n_blocks: slider.n_blocks, weights });
}

function work() {
  const until = performance.now() + SLICE;
  while (performance.now() < until) {
    if (motion) motion = motion.next().done ? null : motion;
    else if (job && !job.isOver) goOn(job);
    else return (isIdle = true);
  }
  clock.port2.postMessage(0);
}

// Simulate one window of the run that is farthest behind. The first slider comes first, until both
// its runs have their first global slips or are done. The runs are sent then, from time to time, and
// at the end.
function goOn({ pairs, all, tolerance, sent }) {
  const runs = (job.isThere ? pairs : pairs.slice(0, 1)).flatMap((pair) => pair.runs);
  const run = runs.reduce((a, b) => (a.isDone || (!b.isDone && b.end < a.end) ? b : a));
  run.isDone = run.steps.next().done;
  run.isThere ||= run.isDone || Boolean(run.events.at(-1)?.isGlobal);
  pairs.forEach((pair) => compare(pair, tolerance));
  const isThere = pairs[0].runs.every((run) => run.isThere || run.isDone);
  const areDone = pairs.every(({ runs }) => runs.every(({ isDone }) => isDone));
  const isOver = areDone || (isThere && !all), isFirst = isThere && !job.isThere;
  const isLate = performance.now() - sent > PATIENCE;
  Object.assign(job, { isThere, isOver });
  if (isOver || isFirst || isLate) send(areDone);
}

// Compare the transitions of a run and its twin. The twin is done once they disagree: on a block, on a
// mode, or on a time by more than the tolerance [s].
function compare(pair, tolerance) {
  const [run, twin] = pair.runs, n = Math.min(run.time.length, twin.time.length);
  const isSame = (i) => run.block[i] === twin.block[i] && run.mode[i] === twin.mode[i] &&
    Math.abs(run.time[i] - twin.time[i]) < APART * tolerance;
  while (pair.same < n && isSame(pair.same)) pair.same++;
  const areOver = run.isDone && twin.isDone && run.time.length !== twin.time.length;
  if (pair.known < Infinity || (pair.same === n && !areOver)) return;
  pair.known = Math.min(run.time[pair.same] ?? Infinity, twin.time[pair.same] ?? Infinity);
  twin.isDone = true;
}

function send(isFinal) {
  postMessage({ id: job.id, isFinal, runs: job.pairs.map(drawnOf) });
  job.sent = performance.now();
}
// What the page draws of a run so far: its events and transitions, and rows for the start and the end,
// which have block 0.
function drawnOf({ slider, runs: [run], known }) {
  const { n, k, weights, strength } = run.chain, { events, end, force, stopped } = run;
  const last = events.at(-1)?.last ?? 0;
  const column = (name, first, final) => [first, ...run[name].slice(0, last), final];
  const arrays = {
    time: Float64Array.from(column("time", 0, end)),
    load: Float64Array.from(column("load", 0, force[1])),
    block: Uint8Array.from(column("block", 0, 0)), mode: Int8Array.from(column("mode", 0, 0)),
  };
  // Without a drop of friction a released block has no net force: rounding decides whether it sticks.
  if (slider.mu_k === slider.mu_s) known = events[0]?.onset ?? Infinity;
  return { slider, n, k, weights, strength, arrays, events, end, force, stopped, known };
}

// Compute the motion in an event: times, forces and modes at the ends of small steps.
function* follow({ chain, duration, events }, { id, event }) {
  const { onset, end, force } = events[event], { n, tau } = chain;
  const mode = new Int8Array(n + 2), length = (end - onset) / tau;
  const window = Math.min(Math.max(FINE, length / MOST_STATES), WINDOW);
  const time = [], forces = [], modes = [];
  let due = 0;
  const note = (t, i, way, force) => {
    if (i) mode[i] = way;
    if (t < due && !(i && length < MOST_STATES * FINE)) return;
    due = t + length / MOST_STATES;
    time.push(onset + t * tau), forces.push(force.slice()), modes.push(mode.slice());
  };
  yield* motionFrom(chain, force.slice(), (duration - onset) / tau, note, window);
  postMessage({ kind: "motion", id, event, time, forces, modes });
}
