// Runs in a worker, after solver.js: it solves a slider and its twin side by side, in short slices,
// so that a newer request is heard in between.

const SLICE = 8; // ms
const PATIENCE = 200; // ms of work on a request, after which what is there is shown
const FINE = 0.1; // Taylor window of a motion that is played [tau]
const MOST_STATES = 4000; // of a motion
const ROUNDINGS = 64; // in which a number of the twin differs, as in analysis/horizon.py
const APART = 10; // how much further apart a run and its twin are than rounding errors

let job = null, motion = null, isIdle = true;
const clock = new MessageChannel();
clock.port1.onmessage = work;

onmessage = ({ data }) => {
  if (data.event === undefined) {
    const runs = [chainOf, twinOf].map((make) => newRun(make(data.slider), data.duration));
    job = { ...data, runs, steps: runs.map(solve), started: performance.now() };
    motion = null;
  } else if (data.id === job.id) motion = follow(job.runs[0], data);
  if (isIdle) clock.port2.postMessage(0);
  isIdle = false;
};

// A slider whose numbers differ by roundings: its run shows how far rounding errors grow.
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

// Solve one window of the run that is behind. Both are sent at their first global slips and at
// their ends.
function goOn({ runs, steps, all, started }) {
  const [run, twin] = runs, i = Number(run.isDone || (!twin.isDone && twin.end < run.end));
  runs[i].isDone = steps[i].next().done;
  runs[i].isThere ||= runs[i].isDone || Boolean(runs[i].events.at(-1)?.isGlobal);
  const isThere = run.isThere && twin.isThere, areDone = run.isDone && twin.isDone;
  const isLate = performance.now() - started > PATIENCE;
  if (areDone || (isThere && !job.isThere) || (isLate && !job.isShown)) send(areDone);
  Object.assign(job, { isThere, isOver: areDone || (isThere && !all) });
}

// Until when a run and its twin have the same transitions, at the same time [s] to the tolerance.
function agreement(run, twin, slider, tolerance) {
  // A block that lets go has no net force then: whether it sticks again is a matter of rounding.
  if (slider.mu_k === slider.mu_s) return run.events[0]?.onset ?? Infinity;
  const isSame = (i) => run.block[i] === twin.block[i] && run.mode[i] === twin.mode[i] &&
    Math.abs(run.time[i] - twin.time[i]) < APART * tolerance;
  const n = Math.min(run.time.length, twin.time.length), areDone = run.isDone && twin.isDone;
  let i = 0;
  while (i < n && isSame(i)) i++;
  if (i === n && (run.time.length === twin.time.length || !areDone)) return Infinity;
  return Math.min(run.time[i] ?? Infinity, twin.time[i] ?? Infinity);
}

// What the page draws of a run so far: its transitions between the start and the end, which have
// block 0, and its events.
function send(isFinal) {
  const { id, slider, tolerance, runs } = job, [run, twin] = runs, last = run.events.at(-1)?.last;
  const { n, k, weights, strength } = run.chain, { events, end, force, stopped } = run;
  const column = (name, first, final) => [first, ...run[name].slice(0, last ?? 0), final];
  const arrays = {
    time: Float64Array.from(column("time", 0, end)),
    load: Float64Array.from(column("load", 0, force[1])),
    block: Uint8Array.from(column("block", 0, 0)), mode: Int8Array.from(column("mode", 0, 0)),
  };
  const known = agreement(run, twin, slider, tolerance), chain = { n, k, weights, strength };
  postMessage({ id, isFinal, slider, ...chain, arrays, events, end, force, stopped, known });
  job.isShown = true;
}

// The motion in an event: times, forces and modes at the ends of small steps.
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
