import uPlot from "uplot";
import { css } from "./colours.js";
import { make } from "./dom.js";
import { energiesAt, kParts } from "./energies.js";
import { language } from "./words/words.js";

const kTold = [...kParts, "lost", "added"];
const kBelowZero = { lost: "gained", added: "taken" };
const kDrawnMomenta = 150;
// The lines of both runs, the whole energy and the translation's: to be told apart without their colours.
const kDashes = [[undefined, [5, 4]], [[14, 5], [2, 4]]];

/** A stacked bar for each run, its parts told in words beside it. */
export class EnergyBars {
  constructor() {
    this.element = make("div", { className: "cv-bars" });
    this.rows = [];
  }

  show(motions, time) {
    const { words } = language;
    if (this.rows.length !== motions.length || this.language !== language.id) this.build(motions, words);
    motions.forEach((motion, index) => {
      const energies = energiesAt(motion, time);
      const row = this.rows[index];
      row.name.textContent = words.label(motion.about.label);
      const whole = Math.max(energies.start, energies.start + energies.added, energies.total) || 1;
      for (const part of kTold) {
        const value = energies[part];
        if (part !== "added") row.parts[part].style.width = `${Math.max(0, 100 * value / whole)}%`;
        const { number, term, item } = row.numbers[part];
        number.textContent = `${language.number(Math.abs(value), 5)} J`;
        number.dataset.value = value;
        term.textContent = words.energies[value < 0 ? kBelowZero[part] ?? part : part];
        item.hidden = part !== "translation" && !motion[part]?.some((x) => x !== 0) && value === 0;
      }
    });
  }

  build(motions, words) {
    this.language = language.id;
    this.rows = motions.map(() => {
      const name = make("strong");
      const parts = {};
      const numbers = {};
      const bar = make("div", { className: "cv-bar", "aria-hidden": "true" });
      const list = make("ul", { className: "cv-parts" });
      for (const part of kTold) {
        const number = make("output", { className: `cv-number cv-energy-${part}` });
        const term = make("span", {}, words.energies[part]);
        const item = make("li", {}, make("span", { className: `cv-key cv-${part}`, "aria-hidden": "true" }), term, " ", number);
        if (part !== "added") {
          parts[part] = make("span", { className: `cv-part cv-${part}` });
          bar.append(parts[part]);
        }
        numbers[part] = { number, term, item };
        list.append(item);
      }
      return { name, parts, numbers, element: make("div", { className: "cv-row" }, name, bar, list) };
    });
    this.element.replaceChildren(...this.rows.map((row) => row.element));
  }
}

/** The largest distance of any ball from its twin in another run, in every frame that both have. */
export function distances(a, b) {
  const frames = Math.min(a.frames, b.frames);
  const list = new Float64Array(frames);
  for (let k = 0; k < frames; k += 1) {
    let most = 0;
    for (let i = 0; i < a.balls; i += 1) {
      const at = 3 * (k * a.balls + i);
      most = Math.max(most, (a.positions[at] - b.positions[at]) ** 2 + (a.positions[at + 1] - b.positions[at + 1]) ** 2 +
        (a.positions[at + 2] - b.positions[at + 2]) ** 2);
    }
    list[k] = Math.sqrt(most);
  }
  return list;
}

/** Energy over time, and with two runs the distance between them; a line marks the time that is shown. */
export class OverTime {
  constructor() {
    this.element = make("div", { className: "cv-plots" });
    this.plots = [];
    this.time = 0;
  }

  build(motions, theme, goTo) {
    this.close();
    const { words } = language;
    const width = Math.max(260, Math.min(this.element.clientWidth || 340, 560));
    const axis = { stroke: css(theme.ink), grid: { stroke: css(theme.quiet, 0.3), width: 1 }, font: "12px system-ui" };
    const value = (_, x) => (x === null ? "" : language.number(x));
    const values = (_, list) => list.map((x) => (x === null ? "" : language.number(x, 3)));
    const make_plot = (title, series, log) => {
      const times = motions[0].times;
      const cut = (list) => times.map((_, k) => (k < list.length && Number.isFinite(list[k]) ? list[k] : null));
      const plot = new uPlot({
        title, width, height: 190, pxAlign: 0,
        scales: { x: { time: false }, y: log ? { distr: 3 } : {} },
        axes: [{ ...axis, values }, { ...axis, size: 62, values }],
        series: [{ label: "t, s", value }, ...series.map(({ label, stroke, dash }) => ({ label, stroke, dash, width: 2, value, points: { show: false } }))],
        legend: { live: false, markers: { dash: (u, i) => (u.series[i].dash ? "dashed" : "solid") } },
        cursor: { drag: { x: false, y: false } },
        hooks: {
          draw: [(u) => {
            const x = u.valToPos(this.time, "x", true);
            u.ctx.save();
            u.ctx.strokeStyle = css(theme.ink);
            u.ctx.lineWidth = 2;
            u.ctx.setLineDash([]);
            u.ctx.beginPath();
            u.ctx.moveTo(x, u.bbox.top);
            u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
            u.ctx.stroke();
            u.ctx.restore();
          }],
        },
      }, [times, ...series.map(({ list }) => cut(list))], this.element);
      plot.over.addEventListener("click", (event) => goTo(plot.posToVal(event.offsetX, "x")));
      this.plots.push(plot);
    };
    const colours = [css(theme.velocity), css(theme.impulse)];
    const lines = motions.flatMap((motion, index) => {
      const total = motion.translation.map((x, k) => x + motion.rotation[k] + motion.potential[k]);
      const [whole, translation] = kDashes[index];
      const line = { label: words.label(motion.about.label), list: total, stroke: colours[index], dash: whole };
      if (total.every((x, k) => x === motion.translation[k])) return [line];
      return [line, { label: `${words.label(motion.about.label)}: ${words.energies.translation}`, list: motion.translation, stroke: colours[index], dash: translation }];
    });
    make_plot(words.plots.energy, lines, false);
    if (motions.length === 2) {
      // Below the rounding of the playback nothing is known; a logarithmic axis has no zero.
      const floor = 0.5 * motions[0].playback.rounding.position_m;
      const apart = [...distances(...motions)].map((x) => Math.max(x, floor));
      if (apart.some((x) => x > floor)) {
        make_plot(words.plots.difference, [{ label: "max |Δx|", list: apart, stroke: css(theme.momentum) }], true);
      }
    }
  }

  show(time) {
    this.time = time;
    for (const plot of this.plots) plot.redraw(false);
  }

  close() {
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
  }
}

/** The momenta of the balls, each from where the last one ends, and their sum. */
export class Momenta {
  constructor() {
    this.canvas = make("canvas", { className: "cv-momenta", role: "img" });
    this.note = make("p", { className: "cv-note" });
    this.element = make("div", {}, this.canvas, this.note);
  }

  show(state, masses, camera, colourOf, theme) {
    const { words } = language;
    const scale = devicePixelRatio || 1;
    const [width, height] = [this.canvas.clientWidth || 300, this.canvas.clientHeight || 200];
    this.canvas.width = width * scale;
    this.canvas.height = height * scale;
    const { right, up } = camera.axes();
    const flat = (p) => [right, up].map((axis) => axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2]);
    const chain = [[0, 0]];
    const rest = [0, 0];
    masses.forEach((m, i) => {
      if (!Number.isFinite(m)) return;
      const p = flat([0, 1, 2].map((c) => m * state.v[3 * i + c]));
      if (i < kDrawnMomenta) chain.push([chain.at(-1)[0] + p[0], chain.at(-1)[1] + p[1]]);
      else { rest[0] += p[0]; rest[1] += p[1]; }
    });
    if (masses.length > kDrawnMomenta) chain.push([chain.at(-1)[0] + rest[0], chain.at(-1)[1] + rest[1]]);
    this.draw(chain, width, height, scale, colourOf, theme);
    this.note.textContent = words.momentaNote + (masses.length > kDrawnMomenta ? ` ${words.momentaMany(kDrawnMomenta)}` : "");
    this.canvas.setAttribute("aria-label", words.momenta);
  }

  draw(chain, width, height, scale, colourOf, theme) {
    const context = this.canvas.getContext("2d");
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, width, height);
    const [xs, ys] = [0, 1].map((c) => chain.map((p) => p[c]));
    const [left, top] = [Math.min(...xs), Math.max(...ys)];
    // The picture keeps its scale while the chain only turns: it grows with the sum of all lengths.
    const size = Math.max(Math.max(...xs) - left, top - Math.min(...ys), 1e-300);
    const unit = Math.min((width - 40) / size, (height - 40) / size);
    const middle = [0.5 * (width - unit * (Math.max(...xs) - left)), 0.5 * (height - unit * (top - Math.min(...ys)))];
    const place = (p) => [middle[0] + unit * (p[0] - left), middle[1] + unit * (top - p[1])];
    for (let k = 1; k < chain.length; k += 1) arrow(context, place(chain[k - 1]), place(chain[k]), css(colourOf(k - 1)), 2.5);
    arrow(context, place(chain[0]), place(chain.at(-1)), css(theme.ink), 4);
  }
}

function arrow(context, [ax, ay], [bx, by], style, width) {
  const length = Math.hypot(bx - ax, by - ay);
  if (length < 1) return;
  const [ux, uy] = [(bx - ax) / length, (by - ay) / length];
  const head = Math.min(4 * width, length);
  context.strokeStyle = context.fillStyle = style;
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(ax, ay);
  context.lineTo(bx - 0.8 * head * ux, by - 0.8 * head * uy);
  context.stroke();
  context.beginPath();
  context.moveTo(bx, by);
  context.lineTo(bx - head * ux + 0.45 * head * uy, by - head * uy - 0.45 * head * ux);
  context.lineTo(bx - head * ux - 0.45 * head * uy, by - head * uy + 0.45 * head * ux);
  context.fill();
}
