"use strict";
// The paper's chain, solved transition by transition in the browser: the twin of solver/plain.py.
//
// Units inside: force in N, time in tau, velocity in N/tau, with tau = 2 / (largest angular frequency). The state is the
// force T_i in the spring behind each block and its velocity v_i. Between transitions (Eqs. 2-6)
//   dT_i/dt = c_i (v_{i-1} - v_i),   dv_i/dt = T_i - T_{i+1} - mode_i mu_k w_i  for a block that slides.

const WINDOW = 0.6875; // length of a Taylor window [tau]
const ORDER = 24; // (2 WINDOW)^ORDER / ORDER! is below 1e-19
const ROUNDING = 8 * Number.EPSILON;
const FACTORIAL = Float64Array.from({ length: ORDER + 3 }, (_, n) => (n < 2 ? 1 : 0));
for (let n = 2; n < FACTORIAL.length; n++) FACTORIAL[n] = n * FACTORIAL[n - 1];

// N blocks of a slider (Eqs. 7, 9 and 10).
function chainOf({ blocks, theta, normalLoad, muS, muK, driveStiffness, driveVelocity, mass, stiffness }) {
  const loads = Array.from({ length: blocks }, (_, j) =>
    blocks === 1 ? normalLoad : (normalLoad / blocks) * (1 + ((2 * j + 1 - blocks) / (blocks - 1)) * theta),
  );
  const m = mass / blocks, k = blocks * stiffness;
  const tau = 2 / Math.sqrt(Math.max(4 * k, 2 * k + driveStiffness) / m);
  const c = new Float64Array(blocks + 2); // c[i] belongs to the spring behind block i
  for (let i = 1; i <= blocks; i++) c[i] = ((i === 1 ? driveStiffness : k) * tau * tau) / m;
  const perBlock = (mu) => Float64Array.from([0, ...loads.map((w) => mu * w), 0]);
  return {
    n: blocks, c, tau, strength: perBlock(muS), friction: perBlock(muK), drive: (driveVelocity * m) / tau,
    velocityUnit: tau / m, // m/s per N/tau
  };
}

// Taylor rows of the velocities from their row 0: row n is the n-th derivative.
function expand(chain, rows, force, mode, last) {
  const { n, c, friction } = chain;
  rows.forEach((row, order) => { if (order) row.fill(0); });
  for (let i = 1; i <= last; i++) {
    if (mode[i]) rows[1][i] = force[i] - force[i + 1] - mode[i] * friction[i];
  }
  for (let order = 2; order <= ORDER; order++) {
    const row = rows[order], before = rows[order - 2];
    for (let i = 1; i <= last; i++) {
      if (mode[i]) row[i] = c[i] * (before[i - 1] - before[i]) - c[i + 1] * (before[i] - before[i + 1]);
    }
  }
}

// Event functions of the window: v of a block that slides, both margins mu_s w -+ G of a block that sticks.
function* eventFunctions(chain, rows, force, mode, last) {
  const { c, strength } = chain;
  for (let i = 1; i <= last; i++) {
    if (mode[i]) {
      yield [i, 0, rows.map((row) => mode[i] * row[i])];
      continue;
    }
    const net = new Float64Array(ORDER + 1);
    net[0] = force[i] - force[i + 1];
    for (let n = 1; n <= ORDER; n++) net[n] = c[i] * rows[n - 1][i - 1] + c[i + 1] * rows[n - 1][i + 1];
    yield [i, 1, net.map((d, n) => (n ? -d : strength[i] - d))];
    yield [i, -1, net.map((d, n) => (n ? d : strength[i] + d))];
  }
}

// The earliest root of a function in [0, end], or end. With |g''| <= bound, the positive root s of
// g + g' s - bound s^2/2 is a step that cannot pass a root of g.
function earliestRoot(derivatives, end) {
  let bound = 0, power = 1;
  for (let n = 2; n <= ORDER; n++, power *= end / (n - 2)) bound += Math.abs(derivatives[n]) * power;
  let t = 0;
  for (let tries = 0; tries < 200; tries++) {
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
  return t;
}

// Carry the state along the Taylor rows for a time t [tau].
function advance(chain, rows, force, last, t) {
  const { c, drive } = chain;
  const slip = new Float64Array(chain.n + 2);
  slip[0] = drive * t;
  for (let i = 1; i <= last; i++) {
    let v = 0, x = 0;
    for (let n = ORDER; n >= 0; n--) {
      v = rows[n][i] + (v * t) / (n + 1);
      x = rows[n][i] + (x * t) / (n + 2);
    }
    slip[i] = x * t;
    rows[0][i] = v;
  }
  for (let i = 1; i <= Math.min(last + 1, chain.n); i++) force[i] += c[i] * (slip[i - 1] - slip[i]);
}

// Follow one slip event from its onset, at which block 1 lets go; `note(t, block, mode, force, velocity)` hears every
// transition, and every window (block 0). Returns the duration of the event [tau].
function slipEvent(chain, force, longest, note, window = WINDOW) {
  const { n, strength, drive } = chain;
  const rows = Array.from({ length: ORDER + 1 }, () => new Float64Array(n + 2));
  const mode = new Int8Array(n + 2);
  rows[0][0] = drive;
  let sliding = 1, farthest = 1, elapsed = 0;
  mode[1] = 1;
  note(0, 1, 1, force, rows[0]);
  while (sliding && elapsed < longest) {
    const last = Math.min(farthest + 1, n);
    expand(chain, rows, force, mode, last);
    let t = Math.min(window, longest - elapsed), block = 0, kind = 0;
    for (const [i, way, derivatives] of eventFunctions(chain, rows, force, mode, last)) {
      const root = earliestRoot(derivatives, t);
      if (root < t) [t, block, kind] = [root, i, way];
    }
    advance(chain, rows, force, last, t);
    elapsed += t;
    if (block) {
      const net = force[block] - force[block + 1];
      rows[0][block] = 0;
      // The switching rule: it lets go in the direction of the force, or sticks where friction can hold it.
      const next = kind || (Math.abs(net) <= strength[block] * (1 + ROUNDING) ? 0 : Math.sign(net));
      sliding += Math.abs(next) - Math.abs(mode[block]);
      mode[block] = next;
      farthest = Math.max(farthest, block);
      while (farthest > 1 && !mode[farthest]) farthest--;
    }
    note(elapsed, block, mode[block], force, rows[0]);
  }
  return elapsed;
}

// The run from rest: transitions, and the slip events with the spring forces at their onset.
function simulate(chain, duration, most = 200000) {
  const { n, c, tau, strength, drive } = chain;
  const force = new Float64Array(n + 2);
  const time = [], block = [], mode = [], load = [], events = [];
  let clock = 0, lost = 0; // onset of the event [s]: two doubles
  while (time.length < most) {
    const wait = ((strength[1] - (force[1] - force[2])) / (c[1] * drive)) * tau;
    const add = wait + lost, onset = clock + add;
    if (onset > duration) break;
    lost = add - (onset - clock);
    clock = onset;
    force[1] = force[2] + strength[1];
    const event = { onset, force: force.slice(), first: time.length, before: force[1], front: 1, mostSliding: 0 };
    const states = new Int8Array(n + 1);
    let sliding = 0;
    const elapsed = slipEvent(chain, force, (duration - onset) / tau, (t, i, m, forces) => {
      if (!i) return;
      time.push(clock + (lost + t * tau)), block.push(i), mode.push(m), load.push(forces[1]);
      sliding += Math.abs(m) - Math.abs(states[i]);
      states[i] = m;
      event.front = Math.max(event.front, i);
      event.mostSliding = Math.max(event.mostSliding, sliding);
    });
    const passed = elapsed * tau + lost, end = clock + passed;
    lost = passed - (end - clock);
    clock = end;
    events.push(Object.assign(event, { end, after: force[1], last: time.length, isGlobal: event.mostSliding === n }));
  }
  return { chain, duration, time, block, mode, load, events };
}

// The rows of Fig. 13: up to the first global slip, without events shorter than one before.
function precursors(events) {
  const counted = [];
  let longest = 0;
  for (const event of events) {
    if (event.front >= longest) counted.push(event);
    longest = Math.max(longest, event.front);
    if (event.isGlobal) break;
  }
  return counted;
}

if (typeof module !== "undefined") module.exports = { chainOf, simulate, slipEvent, precursors };
