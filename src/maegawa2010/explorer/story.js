// The texts of the page: explained words, sliders and steps, and the format of numbers. An underscore
// marks a subscript: F_X.

const DATA = JSON.parse(document.getElementById("data").textContent);
const { duration: DURATION, tolerance: TOLERANCE, scenes: SCENES, proved: PROVED } = DATA;

// Words with an explanation, which highlight their meaning in the picture: [text, explanation].
const WORDS = {
  precursor: ["precursor", "A slip of part of the row, before the whole row slips."],
  global: ["global slip", "A slip in which all blocks slide at the same instant."],
  bars: ["bar", "The net force of the springs on the block."],
  frames: ["frame", "The limit of static friction: μ_s times the normal load of the block."],
  blocks: ["block", "The front: the farthest block that this slip reaches."],
  line: ["dashed line", `F_X − μ_k W: the push at the onset of the slip, minus the kinetic friction
    of all blocks from the trailing edge up to this point. W is the normal load of these blocks.`],
  load: ["F_X", "The push (tangential load): the force of the drive on block 1."],
  stairs: ["stairs", "The push in each spring, from the drive’s spring on the left to the last spring."],
  added: ["colour", "Push that this slip adds to the springs."],
  released: ["grey", "Push that this slip takes from the springs."],
  front: ["front length L_p", `How far a slip reaches into the row from the trailing edge. L is the
    length of the row.`],
  drive: ["drive", "It moves with the speed V and pushes block 1 through a spring of stiffness K."],
  apparent: ["μ_sapp", `Apparent static friction: the largest push F_X up to the first global slip,
    divided by the normal load F_Z of the row.`],
  arrows: ["arrows", "The normal loads w of the blocks. Their sum is F_Z for every θ."],
  fig13: ["Fig. 13", `The paper’s figure of front length against push. It leaves out events that
    are shorter than an earlier one, and ends with the first global slip.`],
  proved: ["✓ proved", `The transitions up to the first global slip are proved: no rounding error
    can change their order.`],
  predictable: ["predictable", `A second run, whose inputs differ only in their last digits, has the
    same transitions in the same order. Rounding errors change their times by less than 1 ns.`],
};
const twoDigits = (x) => x.toFixed(2);
const SLIDERS = {
  theta: {
    symbol: "θ", name: "tilt of the normal load, theta", range: [-0.99, 0.99], step: 0.01,
    write: fraction,
    about: `Distribution of the normal load. Negative: more at the trailing edge. 0: the same on
      each block. Positive: more at the leading edge.`,
  },
  n_blocks: {
    symbol: "N", name: "number of blocks, N", range: [1, 40], step: 1,
    write: (x) => counts(x, "block"), about: "The slider’s length and mass stay the same.",
  },
  mu_s: {
    symbol: "μ_s", name: "static friction, mu s", range: [0.05, 1.5], step: 0.01,
    write: twoDigits, about: "A stuck block slips when the net force of its springs is μ_s w.",
  },
  mu_k: {
    symbol: "μ_k", name: "kinetic friction, mu k", range: [0, 1.5], step: 0.01,
    write: twoDigits, about: "The friction on a sliding block is μ_k w. μ_k is at most μ_s.",
  },
  drive_stiffness: {
    symbol: "K", name: "stiffness of the drive, K", range: [1e4, 1e8],
    write: (x) => `${digits(x / 1e6)} MN/m`,
    about: "Stiffness of the spring between the drive and block 1.",
  },
  drive_velocity: {
    symbol: "V", name: "speed of the drive, V", range: [1e-6, 0.1],
    write: (x) => `${digits(x * 1e3)} mm/s`, about: "While all blocks stick, F_X grows by K V each second.",
  },
};
const UNIFORM = nearTheta(0);
const TILTS = [...new Set([-1, 0, 1].map(nearTheta))];
const BUTTONS = [...TILTS, { slider: { theta: DATA.tilted.theta }, mu_sapp: DATA.tilted.mu_sapp }];
// A text for each of the paper's loadings, joined as "a, b and c".
const listed = (texts) => texts.join(", ").replace(/, ([^,]*)$/, " and $1");
const ofTilts = (write) => listed(TILTS.map(write));
const SPREAD = Math.max(...TILTS.map(of("mu_sapp"))) - Math.min(...TILTS.map(of("mu_sapp")));
const range = (value, half, decimals) =>
  `${(value - half).toFixed(decimals)} to ${(value + half).toFixed(decimals)}`;
const ratio = () => (run ? apparent() : UNIFORM.mu_sapp)?.toFixed(4);
const { half_a_digit: HALF_DIGIT, all_six: ALL_SIX, printed: BAND } = DATA; // BAND: of mu_sapp
const PAPERS = (BAND[0] + BAND[1]) / 2;

// Steps: name, title and text; the slider and the event that are shown (`pick`); the time shown
// (`view`), and whether it is animated (`plays`); how much of the page is visible (`shows`); and a
// study in place of the row.
const STEPS = [
  {
    name: "Slip", title: "What is a precursor?", scene: UNIFORM, pick: "partial", view: "event",
    plays: true, shows: "slip",
    text: (word) => `The slider is modelled as a row of blocks with springs between them,
      and the ${word("drive")} pushes the first block. The ${word("bars")} under a block shows the
      net force of its springs. The ${word("frames")} shows its limit of static friction. <b>A block
      slips when its bar reaches its frame.</b> The blocks slip one after another from the pushed end,
      the trailing edge, here up to ${word("blocks")}. The other blocks stay stuck. Such a partial
      slip is a ${word("precursor")} of the slip of the whole row.`,
  },
  {
    name: "Push", title: "Where does it stop?", scene: UNIFORM, pick: "longer", view: "event",
    plays: true,
    text: (word) => `The ${word("stairs")} show the push in each spring: the thin line before
      the slip, the thick line now. The slip adds the ${word("added")} area and removes the
      ${word("released")} one. The ${word("line")} is the push ${word("load")} minus the kinetic
      friction of the blocks up to this point. <b>The farthest slips stop where friction has used up
      the push.</b> This slip reaches ${word("blocks")}<span data-reason></span> Press → for the next
      slip: the ${word("front")} grows with the push, apart from a shorter slip now and then.`,
  },
  {
    name: "Mean", title: "What does the tilt not change?", scene: nearTheta(1),
    pick: "global", view: "all", study: drawMeans,
    text: (word) => `From the first ${word("global")} on, the push
      ${word("load")} rises and falls. Its peaks depend on θ, the tilt of the normal load. <b>Its mean
      over a long time does not depend on θ: it is the kinetic friction μ_k F_Z</b>, because the drive
      does as much work as friction takes. Move N: with more blocks the peaks fall. At the first
      global slip, ${word("apparent")} falls to
      ${ofTilts(({ finest }) => finest.mu_sapp.toFixed(3))} with ${TILTS[0].finest.n_blocks} blocks
      (medians with ${digits(DATA.noise)} % noise in the normal loads). <b>So the paper’s
      ${twoDigits(PAPERS)} depends on its ten blocks.</b> If μ_k is very low, blocks slide
      backward, and the mean is above μ_k F_Z.`,
  },
  {
    name: "Peak", title: "When does the whole row slide?", scene: UNIFORM, pick: "global",
    view: "event", plays: true,
    text: (word) => `Each slip relaxes the spring of the ${word("drive")} a little, but the push
      ${word("load")} keeps growing. When it is about μ_k F_Z, where F_Z is the normal load of the
      whole row, the ${word("line")} reaches the leading edge. A wave then runs through the row, and
      all blocks slide: a ${word("global")}. The row slips at a push of <b>${ratio()} F_Z</b>,
      although each block can hold ${twoDigits(state.slider.mu_s)} times its normal load. The push at
      this slip, divided by F_Z, is ${word("apparent")}.`,
  },
  {
    name: "Tilt", title: "What does the tilt change?", scene: nearTheta(-1), pick: "partial",
    text: (word) => `The ${word("arrows")} show the normal load of each block. θ tilts the
      normal loads, and the ${word("line")} bends. With more normal load at the trailing edge the line
      falls early, so precursors are few and late. With less normal load there, they are many and
      early. For every θ the line ends at F_X − μ_k F_Z. At the paper’s three θ,
      ${word("apparent")} differs by only ${SPREAD.toFixed(4)}. <b>At
      θ = ${digits(DATA.tilted.theta)}, ${word("apparent")} is
      different</b>.</p><p class="bar">${BUTTONS.map(({ slider: { theta }, mu_sapp }) =>
      `<button type="button" data-theta="${theta}">θ = ${fraction(theta)}
      <br>${mu_sapp?.toFixed(4) ?? "–"}</button>`).join("")}`,
  },
  {
    name: "Digits", title: "Would another slider agree?", scene: nearTheta(1), pick: "global",
    study: drawDigits,
    text: (word) => `The paper prints its inputs with one to three digits:
      μ_s = ${twoDigits(UNIFORM.slider.mu_s)} stands for any value from
      ${range(UNIFORM.slider.mu_s, HALF_DIGIT.mu_s, 3)}, and V for any speed from
      ${range(1e3 * UNIFORM.slider.drive_velocity, 1e3 * HALF_DIGIT.drive_velocity, 2)} mm/s. Each dot is
      a slider with random inputs that round to the printed ones. Only
      ${ofTilts(({ within: { k, n } }) => Math.round((100 * k) / n))} % have the printed
      ${word("apparent")}, ${BAND.map(twoDigits).join(" to ")}, and
      <b>${ALL_SIX ? `${ALL_SIX[0] || "none"} of ${ALL_SIX[1]}` : "few"} have all six numbers of the
      paper</b>. The line marks your slider: move K or V.`,
  },
];
// An entry of a legend: a dot, ring or box in a colour of the style sheet.
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
const marked = (text) => text.replace(/([FLKxμ])_(sapp|[XZpsk1])/g, "$1<sub>$2</sub>")
  .replace(/(<span class="tip".*?<\/span>)<\/span>([.,:;])/gs, "$1$2</span>"); // on one line
// A word with its explanation; `place` makes its id unique on the page.
function explained(place, name) {
  const [text, about] = WORDS[name], tip = `tip-${place}-${name}`;
  return `<span class="word"><button type="button" class="why" data-lights="${name}"
    aria-describedby="${tip}">${text}</button><span class="tip" role="tooltip"
    id="${tip}">${about}</span></span>`;
}
// A text without explanations and HTML.
const plain = (html) =>
  marked(html).replace(/<span class="tip".*?<\/span>|<[^>]*>/gs, "").replace(/\s+/g, " ");
const wayOf = ({ slider }) => 1 + Math.sign(slider.theta); // of the tilt: 0, 1 or 2
const colourOf = (scene) => TILT_COLOURS[wayOf(scene)];
const loadingOf = (scene) =>
  ["more load at the trailing edge", "uniform load", "more load at the leading edge"][wayOf(scene)];
