// Reads and writes the state of the page as its address.

const MOST_EVENTS = 1e6; // of a run

// Write the step, and the values that differ from those of the step: #step=mean&blocks=40.
function writeAddress() {
  const { name, scene } = STEPS[state.step - 1], parts = new URLSearchParams();
  parts.set("step", name.toLowerCase());
  for (const name in SLIDERS) {
    const value = state.slider[name];
    if (value !== scene.slider[name]) parts.set(optionOf(name), value);
  }
  if (state.pick === null && state.event !== null) parts.set("event", state.event + 1);
  history.replaceState(null, "", `#${parts}`);
}
// Set the state from the address; parts that are not valid are left out and named.
function readAddress() {
  const names = STEPS.map(({ name }) => name.toLowerCase()), values = {}, refused = [];
  const limits = { event: { range: [1, MOST_EVENTS], step: 1 } };
  for (const [name, limit] of Object.entries(SLIDERS)) limits[optionOf(name)] = { ...limit, name };
  let number = 1;
  for (const [key, text] of new URLSearchParams(location.hash.slice(1))) {
    const { range: [low, high] = [], step, name = key } = limits[key] ?? {}, value = Number(text);
    const isWhole = step !== 1 || Number.isInteger(value);
    if (key === "step" && names.includes(text)) number = names.indexOf(text) + 1;
    else if (text && value >= low && value <= high && isWhole) values[name] = value;
    else {
      const rule = key === "step" ? `must be one of ${names.join(", ")}`
        : limits[key] ? `must be ${step === 1 ? "a whole number " : ""}from ${low} to ${high}`
        : `must be step, ${Object.keys(limits).join(", ")}`;
      refused.push(`${key}=${text}: ${limits[key] || key === "step" ? "" : "the name "}${rule}`);
    }
  }
  goToStep(number);
  const { event, ...slider } = values, wish = { ...state.slider, ...slider };
  if (wish.mu_k > wish.mu_s) refused.push(`mu-k=${wish.mu_k}: must not be above mu-s`);
  else if (Object.keys(slider).length) useSlider(wish);
  if (event) Object.assign(state, { pick: null, event: event - 1 });
  writeAddress();
  const lines = refused.map((text) => `Left out of the address: ${text}.`);
  element("refused").textContent = lines.join(" ");
}
