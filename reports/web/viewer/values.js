import { make } from "./dom.js";
import { distance } from "./scenery.js";
import { totals } from "./motion.js";
import { language } from "./words/words.js";

const kRows = 40;

/** The numbers of every ball of the first run, how far it is from its twin in the second, and sums of each run. */
export class Values {
  constructor() {
    // Who scrolls with the keyboard stands on it, and shall not be sent away by new numbers.
    this.scroll = make("div", { className: "cv-scroll", tabIndex: 0, role: "region" });
    this.sumsBox = make("div");
    this.note = make("p", { className: "cv-note" });
    this.element = make("div", { className: "cv-values" }, this.sumsBox, this.scroll, this.note);
  }

  show(motions, states, bodies) {
    const { words } = language;
    const scene = motions[0].scene;
    const axes = scene.dimension === 2 ? ["x", "y"] : ["x", "y", "z"];
    const c = words.columns;
    const heads = [c.ball, c.mass, c.radius, ...axes.map((a) => `${a}, m`), ...axes.map((a) => `v_${a}, m/s`), c.speed];
    if (scene.spin) heads.push(c.spin);
    if (states[1]) heads.push(c.away);
    const rows = [];
    for (let i = 0; i < Math.min(motions[0].balls, kRows); i += 1) {
      if (Number.isNaN(bodies.masses[i])) continue;
      rows.push(this.row(i, axes.length, scene, motions[0], states, bodies));
    }
    const table = make("table", {},
      make("thead", {}, make("tr", {}, ...heads.map((text) => make("th", { scope: "col" }, text)))),
      make("tbody", {}, ...rows));
    this.sumsBox.replaceChildren(this.sums(motions, states, bodies, axes.length));
    this.scroll.setAttribute("aria-label", words.values);
    this.scroll.replaceChildren(table);
    this.note.textContent = motions[0].balls > kRows ? words.valuesMany(kRows, motions[0].balls) : "";
  }

  row(i, axes, scene, motion, states, { masses, radii }) {
    const at = (list, axis) => list[3 * i + axis];
    const numbers = [masses[i], radii[i]];
    for (let axis = 0; axis < axes; axis += 1) numbers.push(at(states[0].x, axis));
    for (let axis = 0; axis < axes; axis += 1) numbers.push(at(states[0].v, axis));
    numbers.push(Math.hypot(at(states[0].v, 0), at(states[0].v, 1), at(states[0].v, 2)));
    if (scene.spin) {
      const spin = motion.spinOf(states[0].frame, i);
      numbers.push(scene.dimension === 2 ? spin[2] : Math.hypot(...spin));
    }
    if (states[1]) numbers.push(distance(states[0], states[1], i));
    return make("tr", {}, make("th", { scope: "row" }, String(i)), ...numbers.map(cell));
  }

  sums(motions, states, { masses }, axes) {
    const { words } = language;
    const all = states.slice(0, motions.length).map((state) => totals(state, masses));
    const told = (momentum) => make("td", { className: "cv-momentum", "data-value": JSON.stringify(momentum) },
      `(${momentum.map((x) => language.number(x, 5)).join("; ")})`);
    const line = (name, cells) => make("tr", {}, make("th", { scope: "row" }, name), ...cells);
    return make("table", { className: "cv-sums" }, make("tbody", {},
      line("", motions.map((motion) => make("th", { scope: "col" }, words.label(motion.about.label)))),
      line(words.sums.impacts, motions.map((motion, k) => make("td", { className: "cv-impacts", "data-value": String(motion.counted[states[k].frame]) }, String(motion.counted[states[k].frame])))),
      line(words.sums.momentum, all.map((sum) => told(sum.momentum.slice(0, axes)))),
      line(words.sums.kinetic, all.map((sum) => cell(sum.kinetic)))));
  }
}

function cell(value) {
  return make("td", { "data-value": String(value) }, language.number(value, 5));
}
