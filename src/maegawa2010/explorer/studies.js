// Studies of many sliders, from the tables of the project, and where the reader's slider lies.

const BAND = DATA.printed; // mu_sapp, give or take a unit of its last digit
const BIN = 0.005; // of mu_sapp: dots closer than this stand in rows on each other
const ACROSS = 5;

function spanOf(values) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  return [Math.floor(50 * low) / 50, Math.ceil(50 * high) / 50];
}
function drawBand(context, from, to) {
  context.fillStyle = palette.band;
  context.fillRect(...from, to[0] - from[0], to[1] - from[1]);
}

// mu_sapp of the sliders with the same printed inputs, a strip for each loading.
function drawDigits(context, width, height) {
  const across = spanOf(TILTS.flatMap(of("draws"))), none = { values: [], decimals: 0 };
  const labels = ["μ_sapp of sliders with the same printed inputs", ""];
  const figure = axes(context, width, height, across, [0, TILTS.length], labels, null, none);
  const { x, y, box } = figure, strip = (box.bottom - box.top) / TILTS.length;
  drawBand(context, [x(BAND[0]), box.top], [x(BAND[1]), box.bottom]);
  const said = TILTS.map((scene, t) => {
    const heights = {}, wide = (x(BIN) - x(0)) / ACROSS, base = y(t) - 0.12 * strip;
    for (const value of scene.draws) {
      const bin = Math.floor(value / BIN), before = (heights[bin] = (heights[bin] ?? -1) + 1);
      const up = base - 1.05 * wide * Math.floor(before / ACROSS);
      const at = x(bin * BIN) + ((before % ACROSS) + 0.5) * wide;
      mark(context, "dot", at, up, 0.45 * wide, palette[colourOf(scene)]);
    }
    mark(context, "ring", x(scene.mu_sapp), base, 6, palette.ink);
    const { k, n } = scene.within, share = `${Math.round((100 * k) / n)} %`;
    write(context, loadingOf(scene), box.left + 4, y(t + 1) + 10);
    context.fillStyle = palette.ink;
    write(context, share, x((BAND[0] + BAND[1]) / 2), y(t + 1) + 26, "center");
    return `${loadingOf(scene)}: ${share}`;
  });
  if (firstGlobal()) {
    const at = Math.min(Math.max(x(apparent()), box.left), box.right);
    context.strokeStyle = palette.ink;
    stroke(context, [[at, box.top - 4], [at, box.bottom]]);
    write(context, "your slider", at, 8, "center");
  }
  setHtml("study-key", `${keyTo("dot", "soft", "a slider with the same printed inputs")}
    ${keyTo("ring", "ink", "with the printed digits")}
    ${keyTo("box", "band", `as printed, ${BAND.map(twoDigits).join(" to ")}`)}`);
  return `μ_sapp of sliders with the same printed inputs. ${said.join("; ")}`;
}

// Medians of mu_sapp, and nine tenths of the runs, against the number of blocks.
function drawBlocks(context, width, height) {
  const medians = TILTS.flatMap(of("medians")), sizes = [...new Set(medians.map(([n]) => n))];
  const log = Math.log10, along = { values: sizes.map(log), names: sizes };
  const ends = [log(sizes[0]) - 0.08, log(sizes.at(-1)) + 0.1];
  const up = spanOf(medians.flatMap(([, ...values]) => values));
  const labels = ["Number of blocks N", "μ_sapp: medians, and 5 to 95 % of the runs"];
  const { x, y, box } = axes(context, width, height, ends, up, labels, along);
  drawBand(context, [box.left, y(BAND[1])], [box.right, y(BAND[0])]);
  const level = y(UNIFORM.slider.mu_k);
  context.fillStyle = context.strokeStyle = palette.ink;
  dashed(context, [[box.left, level], [box.right, level]]);
  TILTS.forEach((scene, t) => {
    const colour = palette[colourOf(scene)], points = [];
    for (const [n, low, median, high] of scene.medians) {
      const at = x(log(n)) + 5 * (t - 1);
      points.push([at, y(median)]);
      mark(context, "dot", at, y(median), 4, colour);
      stroke(context, [[at, y(low)], [at, y(high)]]);
    }
    stroke(context, points);
  });
  const n = state.slider.n_blocks, value = firstGlobal() && apparent();
  if (value && n >= sizes[0]) mark(context, "ring", x(log(n)), y(value), 7, palette.ink);
  setHtml("study-key", `${TILTS.map((scene) => keyTo("dot", colourOf(scene), loadingOf(scene)))
    .join(" ")} ${keyTo("ring", "ink", "your slider")} ${keyTo("box", "band", "as printed")}
    dashed: μ_k`);
  return `μ_sapp falls to μ_k as the number of blocks grows, for each loading`;
}
