// Figures of many sliders, from tables of the workflow, together with the reader's slider.

const BIN = 0.005; // width of a bin of mu_sapp, in which dots are stacked
const ACROSS = 5; // dots beside each other in a bin

function spanOf(values) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return [Math.floor(50 * low) / 50, Math.ceil(50 * high) / 50];
}
function drawBand(context, from, to) {
  context.fillStyle = palette.band;
  context.fillRect(...from, to[0] - from[0], to[1] - from[1]);
}

// Draw mu_sapp of sliders with the same printed inputs, a strip for each loading.
function drawDigits(context, width, height) {
  const across = spanOf(TILTS.flatMap(of("draws"))), none = { values: [], decimals: 0 };
  const labels = ["μ_sapp of sliders with the same printed inputs", ""];
  const figure = axes(context, width, height, across, [0, TILTS.length], labels, null, none);
  const { x, y, box } = figure, strip = (box.bottom - box.top) / TILTS.length;
  drawBand(context, [x(BAND[0]), box.top], [x(BAND[1]), box.bottom]);
  if (firstGlobal()) {
    const at = Math.min(Math.max(x(apparent()), box.left), box.right);
    context.strokeStyle = context.fillStyle = palette.ink;
    stroke(context, [[at, box.top - 4], [at, box.bottom]]);
    write(context, "your slider", at, 8, "center");
  }
  const shares = TILTS.map((scene, t) => {
    const heights = {}, wide = (x(BIN) - x(0)) / ACROSS, base = y(t) - 0.12 * strip;
    for (const value of scene.draws) {
      const bin = Math.floor(value / BIN), before = (heights[bin] = (heights[bin] ?? -1) + 1);
      const up = base - 1.05 * wide * Math.floor(before / ACROSS);
      const at = x(bin * BIN) + ((before % ACROSS) + 0.5) * wide;
      mark(context, "dot", at, up, 0.45 * wide, palette[colourOf(scene)]);
    }
    mark(context, "ring", x(scene.mu_sapp), base, 6, palette.ink);
    const { k, n } = scene.within, share = `${Math.round((100 * k) / n)} % as printed`;
    context.fillStyle = palette.soft;
    write(context, loadingOf(scene), box.left + 4, y(t + 1) + 10);
    write(context, share, box.right - 4, y(t + 1) + 10, "right");
    return `${loadingOf(scene)}: ${share}`;
  });
  return {
    key: `${keyTo("dot", "soft", "a slider with the same printed inputs")}
      ${keyTo("ring", "ink", "the reproduced slider")}
      ${keyTo("box", "band", `as printed, ${BAND.map(twoDigits).join(" to ")}`)}`,
    name: `μ_sapp of sliders with the same printed inputs. ${shares.join("; ")}`,
  };
}

// Draw F_X/F_Z over time for three loadings, and its mean from the first global slip to the last.
function drawMeans(context, width, height) {
  const { mu_k, mu_s, normal_load } = run.slider, foot = 28, strip = (height - foot) / 3;
  const room = Math.max(mu_s - mu_k, 0.05), up = [mu_k - 0.7 * room, mu_k + room];
  const runs = [...run.loadings].sort((a, b) => a.slider.theta - b.slider.theta);
  const means = runs.map((one, i) => {
    const { time, load } = one.arrays, { mean, first, last, peak } = meanOf(one), isLow = i === 2;
    context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, devicePixelRatio * i * strip);
    const labels = [isLow ? "Time t [s]" : null, "F_X/F_Z"];
    const figure = axes(context, width, strip + isLow * foot, [0, DURATION], up, labels);
    const { x, y, box } = figure, level = y(mu_k);
    context.strokeStyle = palette.ink;
    dashed(context, [[box.left, level], [box.right, level]]);
    const over = { time, load: load.map((force) => force / normal_load), known: one.known };
    drawLoad(context, figure, over, 0, time.at(-1), colourOf(one));
    context.strokeStyle = context.fillStyle = palette.ink;
    context.lineWidth = 3;
    if (mean) stroke(context, [[x(first), y(mean)], [x(last), y(mean)]]);
    context.lineWidth = 1;
    const tilt = `θ = ${fraction(one.slider.theta)}`, loading = `${loadingOf(one)}, ${tilt}`;
    const numbers = mean ? `peak ${peak.toFixed(3)}, mean ${mean.toFixed(4)}` : "no mean yet";
    write(context, width < NARROW ? tilt : loading, box.left + 6, box.top + 10);
    write(context, numbers, box.right - 4, box.top + 10, "right", "bold");
    return `${loading}: ${numbers}`;
  });
  return {
    key: `${keyTo("box", "ink", "mean from the first global slip to the last")}
      ${keyTo("box", "unsure", "single slips are not predictable, but the mean is")} dashed: μ_k`,
    name: `F_X/F_Z over time for three distributions of the normal load. ${means.join("; ")}`,
  };
}
// Mean and peak of F_X/F_Z from the onset of the first global slip to that of the last, if there are
// two.
function meanOf({ arrays: { time, load }, events, slider }) {
  const onsets = events.filter(of("isGlobal")).map(of("onset")), [first] = onsets;
  const last = onsets.at(-1);
  if (!(first < last)) return {};
  let sum = 0, peak = 0;
  for (let i = lowerBound(time, first) + 1; time[i] <= last; i++) {
    sum += ((time[i] - time[i - 1]) * (load[i] + load[i - 1])) / 2;
    peak = Math.max(peak, load[i]);
  }
  const unit = slider.normal_load;
  return { mean: sum / (last - first) / unit, peak: peak / unit, first, last };
}
