// Studies: sliders that are solved one after the other while the reader watches, and the dots of their mu_sapp.

const BAND = [0.48, 0.5]; // the printed 0.49, give or take 0.01
const AXIS = [0.4, 0.62];

const STUDIES = {
  // The paper's tilts and one more, whose coefficients stand on the buttons of step 4.
  tilts: { name: "tilts", count: THETAS.length, duration: DURATION, sliderOf: (i) => ({ ...UNIFORM.slider, theta: THETAS[i] }) },
  // Sliders with the same printed inputs. Draw i differs from them in the same way under each of the paper's loadings.
  digits: {
    name: "digits", count: 400 * TILTS.length, duration: 2 * DURATION,
    sliderOf(i) {
      const { slider } = TILTS[i % TILTS.length], random = randomOf(Math.floor(i / TILTS.length));
      const printed = { ...slider, theta: Number(slider.theta.toFixed(3)) };
      for (const [name, half] of Object.entries(PRINTED)) printed[name] += half * (2 * random() - 1);
      return printed;
    },
    draw(context, width, height, points) {
      const figure = axes(context, width, height, AXIS, [0, TILTS.length], ["μsapp of sliders with the same printed inputs", ""], null, { values: [], decimals: 0 });
      context.fillStyle = palette.band;
      context.fillRect(figure.x(BAND[0]), figure.box.top, figure.x(BAND[1]) - figure.x(BAND[0]), figure.box.bottom - figure.box.top);
      points.forEach(({ value, isKnown }, i) => {
        const row = (i % TILTS.length) + 0.5, colour = palette[isKnown ? colourOf(TILTS[i % TILTS.length]) : "unsure"];
        if (value) mark(context, "dot", figure.x(Math.min(Math.max(value, AXIS[0]), AXIS[1])), figure.y(row - 0.4 + 0.6 * ((i * 0.618) % 1)), 1.7, colour);
      });
      const texts = TILTS.map((scene, t) => {
        const of = points.filter((_, i) => i % TILTS.length === t), inside = of.filter(({ value }) => value >= BAND[0] && value <= BAND[1]);
        if (scene.mu_sapp) mark(context, "ring", figure.x(scene.mu_sapp), figure.y(t + 0.4), 6, palette.ink);
        return `${loadingOf(scene)}: ${Math.round((100 * inside.length) / (of.length || 1))} % of ${of.length} inside`;
      });
      context.textAlign = "left";
      context.fillStyle = palette.ink;
      texts.forEach((text, t) => context.fillText(text, figure.box.left + 4, figure.y(t + 0.9)));
      return `μsapp of sliders with the same printed inputs. ${texts.join("; ")}`;
    },
    keyOf: () => `${keyTo("ring", "ink", "the slider with the printed digits")} ${keyTo("box", "band", "as printed, 0.49 ± 0.01")}`,
  },
  // The paper's sliders, cut into more and more blocks.
  blocks: {
    name: "blocks", count: 36 * TILTS.length, duration: DURATION,
    sliderOf: (i) => ({ ...TILTS[i % TILTS.length].slider, n_blocks: 5 + Math.floor(i / TILTS.length) }),
    draw(context, width, height, points) {
      const figure = axes(context, width, height, [2, 41], AXIS, ["Number of blocks N", "μsapp"]), friction = figure.y(UNIFORM.slider.mu_k);
      context.strokeStyle = context.fillStyle = palette.ink;
      stroke(context, [[figure.box.left, friction], [figure.box.right, friction]]);
      context.textAlign = "left";
      context.fillText(`μₖ = ${UNIFORM.slider.mu_k}`, figure.box.left + 4, friction + 9);
      points.forEach(({ value, isKnown }, i) => {
        const x = figure.x(5 + Math.floor(i / TILTS.length) + 0.2 * ((i % TILTS.length) - 1));
        if (value) mark(context, isKnown ? "dot" : "ring", x, figure.y(value), 3, palette[colourOf(TILTS[i % TILTS.length])]);
      });
      return `μsapp falls towards μk as the number of blocks grows. ${points.filter(({ isKnown }) => !isKnown).length} of ${points.length} values are not predictable`;
    },
    keyOf: (points) => TILTS.map((scene) => keyTo("dot", colourOf(scene), loadingOf(scene))).join(" ") + (points.every(({ isKnown }) => isKnown) ? "" : keyTo("ring", "ink", "not predictable")),
  },
};
const found = Object.fromEntries(Object.keys(STUDIES).map((name) => [name, []]));
const study = () => STUDIES[STEPS[state.step - 1].study];

// Numbers from 0 to 1 that depend on the seed alone (mulberry32).
function randomOf(seed) {
  return () => {
    seed = (seed + 0x6d2b79f5) | 0;
    let mixed = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

// Solve the next slider of the study, if there is one.
function goOnWithStudy() {
  const { name, sliderOf, duration, count } = study() ?? {}, i = found[name]?.length;
  if (i < count) ask({ slider: sliderOf(i), duration, study: name, all: false });
}
function noteInStudy(name, run) {
  const slip = firstGlobal(run);
  found[name].push({ value: slip ? apparentIn(run) : null, isKnown: slip && slip.onset < run.known });
  redraw("lengths"), showStep();
}
