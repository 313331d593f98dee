// What the page says: its words, its sliders and its six steps, and how it writes numbers.

const { duration: DURATION, tolerance: TOLERANCE, half_a_digit: PRINTED, scenes: SCENES, proved: PROVED } = JSON.parse(document.getElementById("data").textContent);

const WORDS = {
  precursor: ["precursor", "A slip of part of the row, before the whole row slips."],
  global: ["global slip", "A slip in which all blocks slide at the same instant."],
  load: ["F<sub>X</sub>", "Tangential load: the force of the drive on block 1."],
  line: ["F<sub>X</sub> − μ<sub>k</sub> W", "W is the normal load from the pushed end up to a point. While they slide, its blocks take μ<sub>k</sub> W of the load F<sub>X</sub>, and the rest is pushed on. At the front nothing is left: F<sub>X</sub> = μ<sub>k</sub> W(L<sub>p</sub>)."],
  staircase: ["K x<sub>1</sub>", "How far block 1 has moved, times the stiffness K of the drive. It is the load that the slips have released so far: K V t − F<sub>X</sub>."],
  front: ["L<sub>p</sub>", "Front length: how far into the row a slip gets, from the pushed end. L is the length of the row."],
  apparent: ["μ<sub>sapp</sub>", "Apparent static friction: the largest F<sub>X</sub> up to the first global slip, divided by the total normal load F<sub>Z</sub>."],
  fig13: ["Fig. 13", "The paper’s figure of front length against load. It leaves out events that are shorter than one before them, and ends with the first global slip."],
  proved: ["✓ proved", "The transitions up to the first global slip are proved: no rounding error can change their order."],
  predictable: ["predictable", "A second run, whose inputs differ only in their last digits, has the same transitions in the same order. Rounding errors change their times by less than a nanosecond."],
};
const SLIDERS = {
  theta: { symbol: "θ", name: "tilt of the load, theta", low: -1, high: 1, step: 0.01, write: fraction, about: "How unevenly the normal load is spread. Negative: more on the pushed end. 0: the same on each block. Positive: more on the far end." },
  n_blocks: { symbol: "N", name: "number of blocks, N", low: 1, high: 40, step: 1, write: (x) => counts(x, "block"), about: "Number of blocks that the slider is cut into. Its length and mass stay the same." },
  mu_s: { symbol: "μ<sub>s</sub>", name: "static friction, mu s", low: 0.05, high: 1.5, step: 0.01, write: (x) => x.toFixed(2), about: "Static friction: a stuck block starts to slide when the springs push with μ<sub>s</sub> times its normal load." },
  mu_k: { symbol: "μ<sub>k</sub>", name: "kinetic friction, mu k", low: 0, high: 1.5, step: 0.01, write: (x) => x.toFixed(2), about: "Kinetic friction: what holds back a sliding block. It is never above μ<sub>s</sub>." },
  drive_stiffness: { symbol: "K", name: "stiffness of the drive, K", low: 1e4, high: 1e8, write: (x) => `${digits(x / 1e6)} MN/m`, about: "Stiffness of the spring between the drive and block 1." },
  drive_velocity: { symbol: "V", name: "speed of the drive, V", low: 1e-6, high: 0.1, write: (x) => `${digits(x * 1e3)} mm/s`, about: "Speed of the drive. While all blocks are stuck, F<sub>X</sub> grows by K V each second." },
};
const UNIFORM = nearTheta(0);
const TILTS = [...new Set([-1, 0, 1].map(nearTheta))];
const THETAS = [...TILTS.map((scene) => scene.slider.theta), 0.01]; // of step 4
// Steps: heading, text, the slider and event that are shown, the part of time and whether it is played, and the study.
const STEPS = [
  {
    title: "What is a precursor?", scene: UNIFORM, pick: "partial", view: "event", plays: true,
    text: (word) => `The bar under each block is the net force of its springs, and its frame is the limit of static friction. <b>A block slips when its bar meets its frame.</b> The blocks at the pushed end slip first, while the others stay stuck: this is a ${word("precursor")} of the slip of the whole row. Sliding blocks take friction from the push, and what is left, ${word("line")}, falls along the row. Where it meets zero the front stops${event() ? `, here after block ${event().front}` : ""}: ${word("load")} dips, and ${word("staircase")} climbs one step.`,
  },
  {
    title: "Why is the next one longer?", scene: UNIFORM, pick: "longer", view: "event", plays: true,
    text: (word) => `A precursor leaves the springs pushed, up to the dashed line: grey is what earlier ones left, blue what this one adds. The next starts at a higher load, so the line meets zero farther along the row. Press → for the next, and see ${word("front")} grow. Now and then a shorter slip comes in between.`,
  },
  {
    title: "When does the whole row slide?", scene: UNIFORM, pick: "global", view: "event", plays: true,
    text: (word) => `When the line reaches the far end: when ${word("load")} is about μ<sub>k</sub> F<sub>Z</sub>, with the whole normal load F<sub>Z</sub>. A wave then runs through the row and reaches the last block while all the others still slide: a ${word("global")}. So the row lets go at ${ratio()} F<sub>Z</sub> (this number is ${word("apparent")}), although each block could hold ${state.slider.mu_s.toFixed(2)} times its normal load.`,
  },
  {
    title: "What does the normal load do?", scene: nearTheta(-1), pick: "partial", study: "tilts",
    text: (word) => `The arrows show the normal load on each block. θ tilts it, and bends the dashed line: with more load on the pushed end the line falls early, and precursors are few and late; with less there, many come early. For every tilt it ends at F<sub>X</sub> − μ<sub>k</sub> F<sub>Z</sub>. At the paper’s three tilts ${word("apparent")} agrees to 0.01; <b>change the tilt by 0.01 and it does not</b>.</p><p class="bar">${THETAS.map((theta) => `<button type="button" data-theta="${theta}"></button>`).join("")}`,
  },
  {
    title: "Would another slider agree?", scene: nearTheta(1), pick: "global", study: "digits",
    text: (word) => `The paper prints its inputs with one to three digits: μ<sub>s</sub> = 0.70 is anything from 0.695 to 0.705, and V = 0.1 mm/s anything from 0.05 to 0.15. Each dot is a slider with <b>the same printed inputs</b>: μ<sub>s</sub>, μ<sub>k</sub>, K, V, M, E and θ are drawn at random and the slider is solved while you watch. (The article has other draws.) Few of the dots lie in the grey band, the printed ${word("apparent")} of 0.49 ± 0.01.`,
  },
  {
    title: "Does the number of blocks matter?", scene: UNIFORM, blocks: 40, pick: "global", study: "blocks",
    text: (word) => `A real slider is not made of blocks. Cut it more finely, and ${word("apparent")} falls to μ<sub>k</sub> for every tilt: with 0.1 % noise in the loads, the medians of the paper’s three loadings are 0.485, 0.486 and 0.506 for 10 blocks, and 0.450, 0.452 and 0.452 for 320. A ring is a value that is not ${word("predictable")}: rounding errors decide it. <b>Verdict: the paper’s six numbers come out, but with ten blocks each is one draw of many. Cut finely, the loadings agree, and the coefficient is μ<sub>k</sub>.</b>`,
  },
];
// An entry of a legend: dot, ring or box in a colour of the style sheet.
const keyTo = (shape, colour, text) => `<span><i class="${shape}" style="--of: var(--${colour})"></i> ${text}</span>`;
function nearTheta(theta) {
  return SCENES.reduce((best, scene) => (Math.abs(scene.slider.theta - theta) < Math.abs(best.slider.theta - theta) ? scene : best));
}
function fraction(value) {
  for (let below = 1; below <= 12; below++) {
    if (Math.abs(Math.round(value * below) - value * below) < 1e-11) return `${Math.round(value * below) || 0}${below > 1 ? `/${below}` : ""}`.replace("-", "−");
  }
  return digits(value).replace("-", "−");
}
const digits = (value) => Number(value.toPrecision(4)).toString();
// A quantity with four digits: 2.739 s, 50.09 µs.
function quantity(value, unit) {
  const size = Math.abs(value), power = size >= 1e3 ? 1e3 : size >= 1 || !size ? 1 : size >= 0.99995e-3 ? 1e-3 : 1e-6;
  const sign = { 1e3: "k", 1: "", 1e-3: "m", 1e-6: "µ" }[power];
  return `${size < 1e-9 ? "0" : (value / power).toFixed(Math.max(0, 3 - Math.max(0, Math.floor(Math.log10(size / power)))))} ${sign}${unit}`;
}
const counts = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
// A word with its explanation; `place` keeps the name of the explanation apart from that elsewhere on the page.
function explained(place, name) {
  const [short, about] = WORDS[name], tip = `tip-${place}-${name}`;
  return `<span class="word"><button type="button" class="why" aria-describedby="${tip}">${short}</button><span class="tip" role="tooltip" id="${tip}">${about}</span></span>`;
}
// A text without its explanations and marks.
const plain = (html) => html.replace(/<span class="tip".*?<\/span>/g, "").replace(/<[^>]*>/g, "");
const wayOf = ({ slider }) => 1 + Math.sign(slider.theta); // of the tilt: 0, 1 or 2
const colourOf = (scene) => TILT_COLOURS[wayOf(scene)];
const loadingOf = (scene) => ["more load at the pushed end", "even load", "more load at the far end"][wayOf(scene)];
