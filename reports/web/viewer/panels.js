import { EnergyBars, Momenta, OverTime } from "./charts.js";
import { make } from "./dom.js";
import { Values } from "./values.js";
import { language } from "./words/words.js";

/** The closable boxes beside the picture: energy, plots over time, momenta, values, and what this playback leaves out. */
export class Panels {
  /** @param open  names of the boxes that are open, as `open` of earlier panels told them */
  constructor(viewer, open = ["energy", "overTime"]) {
    this.viewer = viewer;
    this.bars = new EnergyBars();
    this.overTime = new OverTime();
    this.momenta = new Momenta();
    this.values = new Values();
    this.note = make("p", { className: "cv-note" });
    this.boxes = {
      energy: this.box(open.includes("energy"), this.bars.element),
      overTime: this.box(open.includes("overTime"), this.overTime.element),
      momenta: this.box(open.includes("momenta"), this.momenta.element),
      values: this.box(open.includes("values"), this.values.element),
    };
    this.about = make("div", { className: "cv-about cv-note" });
    this.element = make("div", { className: "cv-panels" }, ...Object.values(this.boxes), this.about);
  }

  box(open, content) {
    const box = make("details", { open }, make("summary"), content);
    box.addEventListener("toggle", () => { this.stale = true; this.viewer.show(); });
    return box;
  }

  get open() {
    return Object.keys(this.boxes).filter((name) => this.boxes[name].open);
  }

  say() {
    const { words } = language;
    for (const [name, box] of Object.entries(this.boxes)) box.querySelector("summary").textContent = words[name];
    const { playback, motions } = this.viewer;
    const facts = [words.rounding(language.number(playback.rounding.position_m, 2), language.number(playback.rounding.speed_mps, 2))];
    if (playback.balls.shown < playback.balls.count) facts.push(words.shownBalls(playback.balls.shown, playback.balls.count));
    if (playback.frames.every > 1) facts.push(words.thinned(playback.frames.every));
    if (playback.leftOut.length > 0) facts.push(words.leftOut(playback.leftOut.join(", ")));
    for (const motion of motions) {
      if (motion.frames === playback.times.length) continue;
      const ended = motion.about.label === "truth" && playback.scene.events.length > 0 ? words.truthEnded : words.ended;
      facts.push(ended(words.label(motion.about.label), language.number(motion.end)));
    }
    for (const run of playback.runs) if (run.status !== "ok") facts.push(words.notThere(words.label(run.label), run.reason || run.status));
    this.about.replaceChildren(...facts.map((fact) => make("p", {}, fact)));
    this.stale = true;
  }

  /** Other runs are shown. */
  changed() {
    this.stale = true;
  }

  show() {
    const { viewer, boxes } = this;
    const { motions, states, clock, theme } = viewer;
    if (boxes.energy.open) this.bars.show(motions, clock.time);
    if (boxes.overTime.open) {
      if (this.stale || this.drawn !== theme) this.overTime.build(motions, theme, (time) => viewer.goTo(time));
      this.drawn = theme;
      this.stale = false;
      this.overTime.show(clock.time);
    }
    if (boxes.momenta.open) {
      this.momenta.show(states[0], viewer.bodies.masses, viewer.stage.camera, (i) => viewer.colourOfBall(i), theme);
    }
    if (boxes.values.open) this.values.show(motions, states, viewer.bodies);
  }

  close() {
    this.overTime.close();
  }
}
