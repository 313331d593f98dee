"use strict";
// Solves the paper's chain transition by transition, with the algorithm of solver/plain.py.
//
// Units inside: force in N, time in tau, velocity in N/tau; tau = 2 / (largest angular frequency).
// The state is the force T_i in the spring behind each block and its velocity v_i. Between
// transitions dT_i/dt = c_i (v_{i-1} - v_i), and for a block that slides (Eqs. 2-6)
// dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i.

const WINDOW = 0.6875; // length of a Taylor window [tau]
const ORDER = 24; // (2 WINDOW)^ORDER / ORDER! is below 1e-19
const MOST_TRANSITIONS = 200000;
const MOST_WINDOWS = 2000000;
const ZERO = 16 * Number.EPSILON; // a net force counts as zero below this share of its parts

// The chain of a slider (Eqs. 9 and 10), whose keys are the arguments of `Chain.from_slider`. Normal
// loads are linear along the slider (Eq. 7), or given as `weights`.
function chainOf(slider) {
  const { n_blocks: n, theta, normal_load: load, drive_stiffness: K } = slider;
  const tilted = (_, j) => (load / n) * (1 + ((2 * j + 1 - n) / (n - 1 || 1)) * theta);
  const weights = slider.weights ?? Array.from({ length: n }, tilted);
  const m = slider.slider_mass / n;
  const k = (n * slider.youngs_modulus * slider.cross_section) / slider.length;
  const tau = 2 / Math.sqrt(Math.max(4 * k, 2 * k + K) / m);
  const springs = [0, K, ...Array(n - 1).fill(k), 0]; // number i is behind block i
  const c = Float64Array.from(springs, (stiffness) => (stiffness * tau * tau) / m);
  const perBlock = (mu) => Float64Array.from([NaN, ...weights.map((w) => mu * w)]);
  const [strength, friction] = [slider.mu_s, slider.mu_k].map(perBlock);
  return { n, c, tau, k, weights, strength, friction, drive: (slider.drive_velocity * m) / tau };
}

// Fill the Taylor rows of the velocities from row 0; row r starts at r (n + 2) and has the r-th
// derivatives.
function expand({ n, c, friction }, rows, force, mode, last) {
  const size = c.length;
  rows.fill(0, size);
  for (let i = 1; i <= last; i++) {
    if (mode[i]) rows[size + i] = force[i] - force[i + 1] - mode[i] * friction[i];
  }
  for (let order = 2; order <= ORDER; order++) {
    const row = order * size, before = row - 2 * size;
    for (let i = 1; i <= last; i++) {
      if (!mode[i]) continue;
      const at = before + i;
      rows[row + i] = c[i] * (rows[at - 1] - rows[at]) - c[i + 1] * (rows[at] - rows[at + 1]);
    }
  }
}

// Set the factors t^r / r! of a Taylor series, up to order ORDER + 1.
function setTerms(terms, t) {
  terms[0] = 1;
  for (let r = 0; r <= ORDER; r++) terms[r + 1] = (terms[r] * t) / (r + 1);
}

// The first transition before `end`: [time, block, way]. Way 0: the velocity of a sliding block
// reaches zero. Way +1 or -1: the margin mu_s w - G or mu_s w + G of a stuck block with the net force
// G does. A bound shows for most of these functions that they have no root.
function firstTransition({ n, c, strength }, rows, force, mode, last, end, terms, series) {
  const size = c.length;
  let first = [end, 0, 0];
  const look = (block, way) => {
    const root = earliestRoot(series, first[0], zeroBelow(force, strength, block));
    if (root < first[0]) first = [root, block, way];
  };
  setTerms(terms, end);
  for (let i = 1; i <= last; i++) {
    if (mode[i]) {
      let least = 0;
      for (let r = ORDER; r >= 0; r--) {
        series[r] = mode[i] * rows[r * size + i];
        least += (r ? Math.min(series[r], 0) : series[r]) * terms[r];
      }
      if (least <= 0) look(i, 0);
      continue;
    }
    series[0] = force[i] - force[i + 1];
    let largest = Math.abs(series[0]);
    for (let r = ORDER; r >= 1; r--) {
      const at = (r - 1) * size + i;
      series[r] = c[i] * rows[at - 1] + c[i + 1] * rows[at + 1];
      largest += Math.abs(series[r]) * terms[r];
    }
    if (largest < strength[i]) continue;
    series.forEach((d, r) => (series[r] = r ? -d : strength[i] - d));
    look(i, 1);
    series.forEach((d, r) => (series[r] = r ? -d : 2 * strength[i] - d));
    look(i, -1);
  }
  return first;
}

// Size below which a net force is lost in rounding errors.
const zeroBelow = (force, strength, i) =>
  ZERO * (Math.abs(force[i]) + Math.abs(force[i + 1]) + strength[i]);

// The earliest root of a function g in [0, end], or end. If |g''| <= bound, the positive root s of
// g + g' s - bound s^2/2 is a step that cannot pass a root of g. A root at the start (to within
// `zero`) belongs to the transition before: it is divided out. If g then falls, the root is at 0.
function earliestRoot(derivatives, end, zero) {
  const first = derivatives.findIndex((d) => Math.abs(d) > zero);
  if (first < 0) return end;
  if (first > 0) {
    if (derivatives[first] < 0) return 0;
    let scale = 1;
    const divided = (_, n) => (scale *= n / (n + first) || 1) * (derivatives[n + first] ?? 0);
    derivatives = derivatives.map(divided);
  }
  let bound = 0, power = 1;
  for (let n = 2; n <= ORDER; power *= end / (++n - 2)) bound += Math.abs(derivatives[n]) * power;
  let t = 0;
  for (;;) {
    let g = 0, slope = 0;
    for (let n = ORDER; n >= 0; n--) {
      g = derivatives[n] + (g * t) / (n + 1);
      if (n) slope = derivatives[n] + (slope * t) / n;
    }
    if (g <= 0 && slope <= 0) return t;
    const root = Math.sqrt(slope * slope + 2 * bound * Math.max(g, 0));
    const step = slope > 0 ? (slope + root) / bound : (2 * Math.max(g, 0)) / (root - slope);
    t += step;
    if (!(t < end)) return end;
    if (step <= 4e-16) return t;
  }
}

// Advance the state by a time t [tau] with the Taylor rows.
function advance({ n, c, drive }, rows, force, last, t, terms, slip) {
  const size = c.length;
  setTerms(terms, t);
  slip.fill(0);
  slip[0] = drive * t;
  for (let i = 1; i <= last; i++) {
    let v = 0, x = 0;
    for (let r = ORDER; r >= 0; r--) {
      v += rows[r * size + i] * terms[r];
      x += rows[r * size + i] * terms[r + 1];
    }
    slip[i] = x;
    rows[i] = v;
  }
  for (let i = 1; i <= Math.min(last + 1, n); i++) force[i] += c[i] * (slip[i - 1] - slip[i]);
}

// Simulate a slip event, from the release of block 1 until nothing moves; yield before every window.
// `note(t, block, mode, force, moving)` is called after every transition and window (then block is
// 0); `moving` is the number of sliding blocks.
function* motionFrom(chain, force, longest, note, window = WINDOW) {
  const { n, c, strength, drive } = chain;
  const rows = new Float64Array(c.length + ORDER * c.length), slip = new Float64Array(c.length);
  const mode = new Int8Array(c.length), terms = [], series = [];
  rows[0] = drive;
  mode[1] = 1;
  let moving = 1, farthest = 1, elapsed = 0;
  note(0, 1, 1, force, moving);
  while (moving && elapsed < longest) {
    yield;
    const last = Math.min(farthest + 1, n);
    expand(chain, rows, force, mode, last);
    const end = Math.min(window, longest - elapsed);
    const first = firstTransition(chain, rows, force, mode, last, end, terms, series);
    const [t, block, way] = first;
    advance(chain, rows, force, last, t, terms, slip);
    elapsed += t;
    if (block) {
      const net = force[block] - force[block + 1];
      rows[block] = 0;
      // A stopped block sticks if static friction holds it, or slides in the direction of the force.
      const holds = Math.abs(net) <= strength[block] + zeroBelow(force, strength, block);
      const next = way || (holds ? 0 : Math.sign(net));
      moving += Math.abs(next) - Math.abs(mode[block]);
      mode[block] = next;
      farthest = Math.max(farthest, block);
      while (moving && !mode[farthest]) farthest--;
    }
    note(elapsed, block, mode[block], force, moving);
  }
}

// A run from rest at its start. It will have transitions, and slip events with the spring forces at
// their onsets.
const newRun = (chain, duration) => ({
  chain, duration, time: [], block: [], mode: [], load: [], events: [],
  end: 0, force: new Float64Array(chain.c.length), stopped: false,
});

// Simulate a run; yield before every window. A run that reaches a limit is `stopped` at its `end`.
function* solve(run) {
  const { chain, duration, force } = run, { n, c, tau, strength, drive } = chain;
  let windows = 0;
  for (;;) {
    const wait = ((strength[1] - (force[1] - force[2])) / (c[1] * drive)) * tau;
    const onset = run.end + wait;
    if (onset > duration) {
      force[1] += (c[1] * drive * (duration - run.end)) / tau;
      run.end = duration;
      return;
    }
    force[1] = force[2] + strength[1];
    const event = { onset, force: force.slice(), before: force[1], first: run.time.length };
    const longest = (duration - onset) / tau;
    let front = 1, most = 1, elapsed = 0;
    const motion = motionFrom(chain, force, longest, (t, i, mode, forces, moving) => {
      elapsed = t;
      if (!i) return;
      run.time.push(onset + t * tau), run.block.push(i), run.mode.push(mode);
      run.load.push(forces[1]);
      front = Math.max(front, i);
      most = Math.max(most, moving);
    });
    while (!motion.next().done && !run.stopped) {
      run.stopped = run.time.length >= MOST_TRANSITIONS || ++windows >= MOST_WINDOWS;
      yield;
    }
    run.end = elapsed < longest ? onset + elapsed * tau : duration;
    const last = run.time.length, isGlobal = most === n;
    run.events.push({ ...event, front, last, isGlobal, end: run.end, after: force[1] });
    if (run.stopped || elapsed >= longest) return;
  }
}
