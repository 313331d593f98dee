// What the page says: its words, its sliders and its six steps, and how it writes numbers. An
// underscore sets what follows as an index: F_X.

const DATA = JSON.parse(document.getElementById("data").textContent);
const { duration: DURATION, tolerance: TOLERANCE, scenes: SCENES, proved: PROVED } = DATA;

// Words that are explained, and that single out what they mean in the picture: [text, explanation].
const WORDS = {
  precursor: ["precursor", "A slip of part of the row, before the whole row slips."],
  global: ["global slip", "A slip in which all blocks slide at the same instant."],
  bars: ["bar", "The net force of the two springs that hold the block."],
  frames: ["frame", "The limit of static friction: μ_s times the normal load of the block."],
  blocks: ["block", "The front: the farthest block that this slip reaches."],
  line: ["dashed line", `F_X − μ_k W, where W is the normal load from the trailing edge up to a
    point. Friction takes μ_k W on the way, and at the front nothing is left: F_X = μ_k W(L_p).`],
  load: ["F_X", "Tangential load: the force of the drive on block 1."],
  left: ["Grey", "Earlier slips left this push in the springs."],
  added: ["colour", "This slip pushes the springs ahead of it, while F_X itself dips."],
  front: ["front length L_p", `How far into the row a slip gets, from the trailing edge. L is the
    length of the row.`],
  drive: ["drive", "It moves with the speed V and pushes block 1 through a spring of stiffness K."],
  stairs: ["K x_1", `How far block 1 has moved, times K: the load that all slips so far have
    released, K V t − F_X.`],
  apparent: ["μ_sapp", `Apparent static friction: the largest F_X up to the first global slip,
    divided by the normal load F_Z of the row.`],
  arrows: ["arrows", "The normal loads w of the blocks. Their sum is F_Z, whatever the tilt."],
  fig13: ["Fig. 13", `The paper’s figure of front length against load. It leaves out events that
    are shorter than one before them, and ends with the first global slip.`],
  proved: ["✓ proved", `The transitions up to the first global slip are proved: no rounding error
    can change their order.`],
  predictable: ["predictable", `A second run, whose inputs differ only in their last digits, has the
    same transitions in the same order. Rounding errors change their times by less than 1 ns.`],
};
const twoDigits = (x) => x.toFixed(2);
const SLIDERS = {
  theta: {
    symbol: "θ", name: "tilt of the load, theta", range: [-0.99, 0.99], step: 0.01,
    write: fraction,
    about: `How unevenly the normal load is spread. Negative: more at the trailing edge. 0: the same
      on each block. Positive: more at the leading edge.`,
  },
  n_blocks: {
    symbol: "N", name: "number of blocks, N", range: [1, 40], step: 1,
    write: (x) => counts(x, "block"), about: "The slider’s length and mass stay the same.",
  },
  mu_s: {
    symbol: "μ_s", name: "static friction, mu s", range: [0.05, 1.5], step: 0.01,
    write: twoDigits, about: "A stuck block slips when its springs push with μ_s w.",
  },
  mu_k: {
    symbol: "μ_k", name: "kinetic friction, mu k", range: [0, 1.5], step: 0.01,
    write: twoDigits, about: "Friction holds a sliding block back with μ_k w; never above μ_s w.",
  },
  drive_stiffness: {
    symbol: "K", name: "stiffness of the drive, K", range: [1e4, 1e8],
    write: (x) => `${digits(x / 1e6)} MN/m`, about: "Spring between the drive and block 1.",
  },
  drive_velocity: {
    symbol: "V", name: "speed of the drive, V", range: [1e-6, 0.1],
    write: (x) => `${digits(x * 1e3)} mm/s`, about: "At rest F_X grows by K V each second.",
  },
};
const UNIFORM = nearTheta(0);
const TILTS = [...new Set([-1, 0, 1].map(nearTheta))];
const BUTTONS = [...TILTS, { slider: { theta: DATA.tilted.theta }, mu_sapp: DATA.tilted.mu_sapp }];
// Texts of a number of each of the paper's loadings: "a, b and c".
const listed = (texts) => texts.join(", ").replace(/, ([^,]*)$/, " and $1");
const ofTilts = (write) => listed(TILTS.map(write));
const SPREAD = Math.max(...TILTS.map(of("mu_sapp"))) - Math.min(...TILTS.map(of("mu_sapp")));
const range = (value, half, decimals) =>
  `${(value - half).toFixed(decimals)} to ${(value + half).toFixed(decimals)}`;
const ratio = () => (run ? apparent() : UNIFORM.mu_sapp)?.toFixed(4);
const { half_a_digit: HALF, all_six: ALL_SIX } = DATA;

// Steps: heading, text, the slider and event that are shown, the part of time and whether it is
// played, and the study.
const STEPS = [
  {
    title: "What is a precursor?", scene: UNIFORM, pick: "partial", view: "event", plays: true,
    text: (word) => `The slider is cut into blocks with springs between them, and the
      ${word("drive")} pushes the first. The ${word("bars")} under a block is the net force of its
      springs, the ${word("frames")} is the limit of static friction. <b>A block slips when its bar
      meets its frame.</b> The blocks slip in turn from the trailing edge, here up to
      ${word("blocks")}; the others stay stuck. This is a ${word("precursor")} of the slip of the
      whole row.`,
  },
  {
    title: "Where does it stop?", scene: UNIFORM, pick: "longer", view: "event", plays: true,
    text: (word) => `Each sliding block takes its kinetic friction from the load
      ${word("load")}. The ${word("line")} is what is left. <b>Where it meets zero, the slip
      stops</b>, here after ${word("blocks")}. ${word("left")} is the push before the slip, and the
      ${word("added")} what the slip adds. The next slip starts at a higher load, so its line meets
      zero farther along. Press → and see the ${word("front")} grow; now and then a shorter slip
      comes in between.`,
  },
  {
    title: "When does the whole row slide?", scene: UNIFORM, pick: "global", view: "event",
    plays: true,
    text: (word) => `The spring of the ${word("drive")} presses with ${word("load")}. Each slip
      relaxes it, and ${word("stairs")} climbs one step. When F_X is about μ_k F_Z, with the normal
      load F_Z of the whole row, the ${word("line")} reaches the leading edge. A wave then runs
      through the row, and all blocks slide: a ${word("global")}. So the row lets go at
      <b>${ratio()} F_Z</b>. This number is ${word("apparent")}, although each block holds
      ${twoDigits(state.slider.mu_s)} times its normal load.`,
  },
  {
    title: "What does the normal load do?", scene: nearTheta(-1), pick: "partial",
    text: (word) => `The ${word("arrows")} show the normal load of each block. θ tilts it and bends
      the ${word("line")}. With more load at the trailing edge the line falls early: precursors are
      few and late. With less there, they are many and early. For every tilt the line ends at
      F_X − μ_k F_Z. At the paper’s three tilts ${word("apparent")} differs by only
      ${SPREAD.toFixed(4)}. <b>Change the tilt by ${digits(DATA.tilted.theta)}, and this
      agreement is gone</b>.</p><p class="bar">${BUTTONS.map(({ slider: { theta }, mu_sapp }) =>
      `<button type="button" data-theta="${theta}">θ = ${fraction(theta)}
      <br>${mu_sapp?.toFixed(4) ?? "–"}</button>`).join("")}`,
  },
  {
    title: "Would another slider agree?", scene: nearTheta(1), pick: "global", study: drawDigits,
    text: (word) => `The paper prints its inputs with one to three digits:
      μ_s = ${twoDigits(UNIFORM.slider.mu_s)} is anything from
      ${range(UNIFORM.slider.mu_s, HALF.mu_s, 3)}, and V anything from
      ${range(1e3 * UNIFORM.slider.drive_velocity, 1e3 * HALF.drive_velocity, 2)} mm/s. Each dot is
      a slider whose inputs round to the printed ones, drawn at random. Only
      ${ofTilts(({ within: { k, n } }) => Math.round((100 * k) / n))} % have the printed
      ${word("apparent")}, ${BAND.map(twoDigits).join(" to ")}, and
      <b>${ALL_SIX ? `${ALL_SIX[0] || "none"} of ${ALL_SIX[1]}` : "few"} all six numbers of the
      paper</b>. The line is your slider: move K, or V.`,
  },
  {
    title: "What holds?", scene: UNIFORM, blocks: 40, pick: "global", view: "all",
    study: drawBlocks,
    text: (word) => `<b>After the first global slip the time mean of ${word("load")} is μ_k F_Z,
      for every loading and number of blocks</b>, as the drive does the work that friction takes.
      In the paper’s scenes it is ${ofTilts(({ mean }) => mean?.toFixed(4) ?? "–")} F_Z. The
      largest F_X lies above it by as much as the slips are large. Many blocks make them small: with
      ${digits(DATA.noise)} % noise in the loads, the medians of ${word("apparent")} are
      ${ofTilts(({ medians }) => medians[0][2].toFixed(3))} with ${TILTS[0].medians[0][0]} blocks,
      and ${ofTilts(({ medians }) => medians.at(-1)[2].toFixed(3))} with
      ${TILTS[0].medians.at(-1)[0]}. <b>So 0.49 belongs to the ten blocks</b>, and each of the
      paper’s six numbers is one draw of many.`,
  },
];
// An entry of a legend: dot, ring or box in a colour of the style sheet.
const keyTo = (shape, colour, text) =>
  `<span><i class="${shape}" style="--of: var(--${colour})"></i> ${text}</span>`;
function of(name) {
  return (values) => values[name];
}
function nearTheta(theta) {
  const far = ({ slider }) => Math.abs(slider.theta - theta);
  return SCENES.reduce((best, scene) => (far(scene) < far(best) ? scene : best));
}
function fraction(value) {
  let below = 1;
  while (below < 13 && Math.abs(Math.round(value * below) - value * below) > 1e-11) below++;
  const over = `${Math.round(value * below) || 0}${below > 1 ? `/${below}` : ""}`;
  return (below < 13 ? over : digits(value)).replace("-", "−");
}
function digits(value) {
  return Number(value.toPrecision(4)).toString();
}
// A quantity with four digits: 2.739 s, 50.09 µs.
function quantity(value, unit) {
  const size = Math.abs(value);
  const prefixes = [[1e3, "k"], [1, ""], [0.99995e-3, "m"], [1e-9, "µ"]];
  const [least, sign] = prefixes.find(([least]) => size >= least) ?? [1, ""];
  const number = value / ({ k: 1e3, m: 1e-3, µ: 1e-6 }[sign] ?? 1);
  const before = Math.max(0, Math.floor(Math.log10(Math.abs(number))));
  return `${size < 1e-9 ? "0" : number.toFixed(Math.max(0, 3 - before))} ${sign}${unit}`;
}
const counts = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
const marked = (text) => text.replace(/([FLKxμ])_(sapp|[XZpsk1])/g, "$1<sub>$2</sub>");
// A word with its explanation; `place` tells it from that elsewhere on the page.
function explained(place, name) {
  const [text, about] = WORDS[name], tip = `tip-${place}-${name}`;
  return `<span class="word"><button type="button" class="why" data-lights="${name}"
    aria-describedby="${tip}">${text}</button><span class="tip" role="tooltip"
    id="${tip}">${about}</span></span>`;
}
// A text without its explanations and marks.
const plain = (html) =>
  marked(html).replace(/<span class="tip".*?<\/span>|<[^>]*>/gs, "").replace(/\s+/g, " ");
const wayOf = ({ slider }) => 1 + Math.sign(slider.theta); // of the tilt: 0, 1 or 2
const colourOf = (scene) => TILT_COLOURS[wayOf(scene)];
const loadingOf = (scene) =>
  ["more load at the trailing edge", "uniform load", "more load at the leading edge"][wayOf(scene)];
