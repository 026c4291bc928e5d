// The viewer: one component, used by the report (report.js) and by the lab. It plays one or two runs of a scene by
// one clock.

import "uplot/dist/uPlot.min.css";
import "./viewer.css";

import { countAcross, expectedAcross } from "./barrier.js";
import { Clock, nameOfSpeed } from "./clock.js";
import { kThemes } from "./colours.js";
import { Controls } from "./controls.js";
import { distances } from "./charts.js";
import { isDark, make, save } from "./dom.js";
import { csvOf } from "./export.js";
import { Motion } from "./motion.js";
import { Panels } from "./panels.js";
import { Pace } from "./pace.js";
import { extent, Picture } from "./picture.js";
import { Playback } from "./playback.js";
import { bodiesAt, colourOf, distance, drawScene, scalesOf } from "./scenery.js";
import { Stage } from "./stage.js";
import { language } from "./words/words.js";

const kPanels_ms = 200;     // between two updates of numbers while it plays
const kAnnounce_ms = 2500;  // between two announcements of impacts
const kSpinStates = ["off", "physical", "shown"];
const kLayouts = ["one", "beside", "over"];

export class Viewer {
  /**
   * @param host     an empty element
   * @param json     a playback
   * @param options  engines: labels of the first and the second run; onBall({ball, button, shift, time}): a ball was clicked;
   *                 choices: labels that may be chosen although the playback lacks them; onEngines([a, b], missing): these
   *                 were chosen, and the playback may lack one, which is then to be run;
   *                 changedAt: the time at which somebody has changed a ball last, s;
   *                 time, toggles, layout, speed, boxes, camera, changedAt, playing: as an earlier viewer's state();
   *                 autoplay: unless less motion is asked for; global: keys of the whole page
   */
  static async mount(host, json, options = {}) {
    const viewer = new Viewer(host, await Playback.read(json), options);
    await viewer.choose(viewer.labels[0], viewer.labels[1]);
    viewer.mounted = true;
    if (options.time) viewer.goTo(options.time);
    if (options.playing || (options.autoplay && !matchMedia("(prefers-reduced-motion: reduce)").matches)) viewer.toggle();
    return viewer;
  }

  constructor(host, playback, options) {
    this.host = host;
    this.playback = playback;
    this.options = options;
    this.clock = new Clock(playback.scene.duration);
    this.clock.speed = options.speed ?? 1;
    this.pace = new Pace();
    this.toggles = { impulse: false, velocity: false, spin: playback.scene.spin ? "physical" : "off", momentum: false,
      trails: false, centre: false, frame: false, tree: false, ...options.toggles };
    this.layout = options.layout ?? "one";
    this.colouring = options.colouring ?? "ball";
    this.chosen = -1;
    const played = playback.played.map((run) => run.label);
    const wished = (options.engines ?? []).filter((label) => played.includes(label));
    const own = played.find((label) => label === "carom") ?? played[0];
    this.labels = [wished[0] ?? own, wished[1] ?? ""];
    this.motions = [];
    this.states = [];
    this.pictures = [new Picture(), new Picture()];
    this.controls = new Controls(this);
    this.panels = new Panels(this, options.boxes);
    this.live = make("p", { className: "cv-live", role: "status", "aria-live": "polite" });
    this.announced = 0;
    this.shut = new AbortController();
    host.classList.add("carom-viewer");
    host.replaceChildren(make("p", { className: "cv-note" }, language.words.loading));
    // Who clicked a button with a pointer means the picture by the next key; who pressed one by a key stands on it.
    host.addEventListener("click", ({ detail, target }) => {
      if (detail > 0 && target.closest("button, summary")) this.stage?.canvas.focus({ preventScroll: true });
    }, { signal: this.shut.signal });
    this.keyTarget = options.global ? document : host;
    this.onKey = (event) => this.controls.key(event);
    this.keyTarget.addEventListener("keydown", this.onKey);
    this.onLanguage = () => { this.controls.say(); this.show(); };
    language.listeners.add(this.onLanguage);
    this.onTheme = () => this.show();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", this.onTheme);
    this.themeWatch = new MutationObserver(this.onTheme);
    this.themeWatch.observe(document.documentElement, { attributeFilter: ["data-theme"] });
  }

  /** Shows these two runs; the second may be empty. */
  async choose(a, b) {
    if (b === a) b = "";
    const asked = [a, b].filter(Boolean);
    const there = this.playback.played.map((run) => run.label);
    const missing = !asked.every((label) => there.includes(label));
    if (this.mounted) this.options.onEngines?.([a, b], missing);
    if (this.mounted && missing) return;
    this.labels = [a, b];
    const runs = await Promise.all(asked.map((label) => this.playback.run(label)));
    if (this.closed || asked.join() !== this.labels.filter(Boolean).join()) return;
    if (runs.length === 0) {
      // The menus stay: another engine may run it.
      this.host.replaceChildren(this.controls.head, make("p", { className: "cv-note" }, language.words.nothing), this.controls.dialog);
      this.controls.say();
      return;
    }
    this.motions = runs.map((run) => new Motion(this.playback, run));
    this.states = [];
    this.turns = new Float32Array(4 * this.playback.balls.shown);
    if (this.motions.length === 2 && this.layout === "one") this.layout = "beside";
    if (this.motions.length === 1) this.layout = "one";
    this.bodies = this.bodiesShown(this.clock.time);
    this.scales = scalesOf(this.motions[0], this.playback.balls.mass);
    this.apart = this.motions.length === 2 ? distances(...this.motions) : null;
    const view = extent(this.playback.scene, this.motions.slice(0, 1), this.playback.balls.radius);
    if (!this.stage) this.build(view);
    this.view = view;
    this.controls.say();
    this.panels.changed();
    this.show();
  }

  build(view) {
    this.stage = new Stage({
      dimension: this.playback.scene.dimension, box: view, plain: this.options.plain,
      changed: () => this.request(), clicked: (found) => this.clicked(found),
    });
    this.stage.camera.take(this.options.camera);
    this.stage.takesClicks = Boolean(this.options.onBall);
    this.host.replaceChildren(this.controls.head, make("div", { className: "cv-body" },
      make("div", { className: "cv-left" }, this.stage.element, this.stage.message, this.controls.counts, this.controls.transport, this.controls.switches, this.live, this.controls.caption),
      this.panels.element), this.controls.dialog);
  }

  get theme() { return isDark() ? kThemes.dark : kThemes.light; }

  /** What another viewer needs to go on where this one is. */
  state() {
    return { time: this.clock.time, toggles: { ...this.toggles }, layout: this.layout, colouring: this.colouring,
      speed: this.clock.speed, engines: this.labels.filter(Boolean), boxes: this.panels.open, playing: this.clock.playing,
      camera: this.stage?.camera.state, changedAt: this.options.changedAt };
  }

  // --- what a person does

  toggle() {
    this.clock.toggle();
    this.last = null;
    const { words } = language;
    this.tell(this.clock.playing ? words.plays : words.paused(language.number(this.clock.time)));
    this.show();
  }

  goTo(time) {
    this.clock.goTo(time);
    this.show();
  }

  restart() {
    this.goTo(0);
    this.tellTime();
  }

  faster(steps) {
    this.clock.faster(steps);
    this.tell(`${language.words.speed}: × ${nameOfSpeed(this.clock.speed)}`);
    this.show();
  }

  stepFrames(by) {
    this.clock.playing = false;
    const { times } = this.playback;
    const frame = this.motions[0].frameAt(this.clock.time);
    const between = this.clock.time > times[frame] + 1e-9 * this.clock.duration;
    const next = frame + by + (by < 0 && between ? 1 : 0);
    this.goTo(times[Math.min(Math.max(next, 0), times.length - 1)]);
    this.tellTime();
  }

  stepImpacts(by) {
    this.clock.playing = false;
    const impacts = this.motions.flatMap((motion) => motion.impacts).sort((a, b) => a.time - b.time);
    const little = 1e-7 * this.clock.duration;
    const found = by > 0 ? impacts.find((impact) => impact.time > this.clock.time + little)
      : impacts.findLast((impact) => impact.time < this.clock.time - little);
    if (!found) {
      this.tell(language.words.noMoreImpacts);
      return;
    }
    this.goTo(found.time);
    this.announce(impacts.filter((impact) => Math.abs(impact.time - found.time) <= little), true);
  }

  switch(name) {
    if (name === "spin") {
      const order = this.playback.scene.spin ? kSpinStates : ["off", "shown"];
      this.toggles.spin = order[(order.indexOf(this.toggles.spin) + 1) % order.length];
    } else {
      this.toggles[name] = !this.toggles[name];
    }
    this.tell(this.controls.toldToggle(name));
    this.show();
  }

  setLayout(layout) {
    this.layout = layout;
    this.tell(language.words.layouts[layout]);
    this.show();
  }

  nextLayout() {
    if (this.motions.length === 2) this.setLayout(kLayouts[(kLayouts.indexOf(this.layout) + 1) % kLayouts.length]);
  }

  clicked({ ball, button, shift }) {
    this.chosen = ball;
    this.options.onBall?.({ ball, button, shift, time: this.clock.time });
    this.show();
  }

  saveCsv() {
    save(`${this.fileName}.csv`, new Blob([csvOf(this.motions)], { type: "text/csv" }));
  }

  savePng() {
    this.stage.quality = 1;
    this.paint();
    this.stage.withNames(this.theme).toBlob((blob) => save(`${this.fileName}.png`, blob), "image/png");
  }

  get fileName() { return this.playback.scene.id.replaceAll(/[^\w.-]+/g, "-"); }

  // --- drawing

  /** Everything anew, now. */
  show() {
    this.panelsDue = 0;
    this.request();
  }

  request() {
    if (this.asked || this.closed || !this.stage) return;
    this.asked = requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    this.asked = null;
    if (this.closed) return;
    const before = this.clock.time;
    const seconds = this.last ? Math.min((now - this.last) / 1000, 0.25) : 0;
    this.last = now;
    if (seconds > 0) this.pace.took(1000 * seconds);
    const moved = this.clock.tick(seconds);
    this.stage.quality = this.clock.playing ? this.pace.quality : 1;
    this.paint();
    if (moved) this.announce(this.impactsBetween(before, this.clock.time), false);
    if (moved && !this.clock.playing) this.tell(language.words.paused(language.number(this.clock.time)));
    if (now >= (this.panelsDue ?? 0) || !this.clock.playing) {
      this.panelsDue = now + kPanels_ms;
      this.controls.show();
      this.panels.show();
    } else {
      this.controls.showTime();
    }
    if (this.clock.playing) this.request(); else this.last = null;
  }

  paint() {
    const time = this.clock.time;
    this.motions.forEach((motion, k) => { this.states[k] = motion.at(time, this.states[k]); });
    this.bodies = this.bodiesShown(time);
    const shots = this.shots();
    shots.forEach((shot, k) => drawScene(this.pictures[k], shot));
    const pictures = shots.map((shot, k) => ({ picture: this.pictures[k], state: shot.state, radii: shot.bodies.radii,
      offset: this.offset(shot), run: shot.motion.about.label, name: this.nameOf(shot) }));
    this.stage.paint(pictures, this.theme);
  }

  /** What stands over a picture: whose it is, and that it stands still where its run is not known any more. */
  nameOf({ motion, ghost, twin }) {
    const { words } = language;
    const labels = this.motions.map(({ about }) => words.label(about.label));
    if (ghost && twin) return words.ghost(...labels);
    const name = words.label(motion.about.label);
    return this.clock.time > motion.end * (1 + 1e-9) ? words.pastEnd(name, language.number(motion.end)) : name;
  }

  shots() {
    const [view, theme] = [this.view, this.theme];
    const size = Math.max(...view.high.map((x, c) => x - view.low[c]));
    const common = { bodies: this.bodies, view, theme, toggles: this.toggles, colouring: this.colouring, scales: this.scales,
      rate: this.clock.rate * this.clock.speed, unit: 0.07 * size, chosen: this.chosen, turns: this.turns };
    const both = this.motions.length === 2;
    const first = { ...common, motion: this.motions[0], state: this.states[0], twin: both ? this.states[1] : null,
      ghost: this.layout === "over" };
    if (!both || this.layout !== "beside") return [first];
    return [first, { ...common, motion: this.motions[1], state: this.states[1], twin: this.states[0] }];
  }

  /** In its own frame the centre of mass stays where it began. */
  offset({ motion, state, bodies }) {
    if (!this.toggles.frame) return [0, 0, 0];
    const centre = (list) => {
      let mass = 0;
      const sum = [0, 0, 0];
      for (let i = 0; i < motion.balls; i += 1) {
        if (!Number.isFinite(bodies.masses[i])) continue;
        mass += bodies.masses[i];
        for (let c = 0; c < 3; c += 1) sum[c] += bodies.masses[i] * list[3 * i + c];
      }
      return sum.map((x) => (mass > 0 ? x / mass : 0));
    };
    const start = centre(motion.positions);
    return centre(state.x).map((x, c) => x - start[c]);
  }

  colourOfBall(ball) { return colourOf(ball, this.motions[0].balls); }

  /** At the very time at which somebody has just changed a ball, it is to be seen as it is from then on. */
  bodiesShown(time) {
    return time === this.options.changedAt ? this.bodiesAfter(time) : bodiesAt(this.playback, time);
  }

  /** The masses and radii from the first frame on that shows what happened at a time. */
  bodiesAfter(time) {
    return bodiesAt(this.playback, time + this.clock.duration / this.playback.frames.intervals);
  }

  // --- what is told

  /** The largest distance of a ball from its twin: now, and in all. */
  apartNow() {
    if (!this.apart) return null;
    let now = 0;
    for (let i = 0; i < this.motions[0].balls; i += 1) now = Math.max(now, distance(this.states[0], this.states[1], i));
    return { now, most: this.apart.reduce((a, b) => Math.max(a, b), 0) };
  }

  /** The balls at the scene's first barrier, against the exact probability. */
  barrier() {
    const [barrier] = this.playback.scene.barriers;
    if (!barrier) return null;
    const motion = this.motions[0];
    return { ...countAcross(barrier, motion, this.states[0]), all: motion.balls,
      ...expectedAcross(barrier, motion, this.playback.balls.mass) };
  }

  /** How many pairs Carom's broad phases look at in the frame that is shown; nothing where balls cannot meet. */
  tests() {
    const [{ tests }] = this.motions;
    if (!tests) return null;
    const { frame } = this.states[0];
    return { bruteForce: tests.bruteForce[frame], tree: tests.tree[frame] };
  }

  slab() {
    const [slab] = this.playback.scene.slabs;
    if (!slab) return null;
    return { beyond: countAcross(slab, this.motions[0], this.states[0]).sent, all: this.motions[0].balls };
  }

  impactsBetween(from, to) {
    return this.motions[0].impacts.filter((impact) => impact.time > from && impact.time <= to);
  }

  /** Below the picture, and to a screen reader once it is silent. */
  tell(text) {
    this.announced = performance.now();
    this.live.textContent = text;
  }

  tellTime() {
    this.tell(language.words.clock(language.number(this.clock.time), language.number(this.clock.duration)));
  }

  announce(impacts, atOnce) {
    if (impacts.length === 0) return;
    if (!atOnce && performance.now() < this.announced + kAnnounce_ms) return;
    const { words } = language;
    const { time, ball, other } = impacts[0];
    const kind = other >= 0 ? "ball" : other === -1 ? "wall" : "unknown";
    const text = words.impactWith[kind](language.number(time), ball, other);
    this.tell(impacts.length > 1 ? text + words.more(impacts.length - 1) : text);
  }

  /** Draws so many pictures and waits for each. @returns the mean time of one, ms */
  measure(pictures) {
    const pixel = new Uint8Array(4);
    const { gl } = this.stage.painter;
    const wait = () => gl?.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    this.paint();
    wait();
    const start = performance.now();
    for (let k = 0; k < pictures; k += 1) {
      this.clock.time = k / pictures * this.clock.duration;
      this.paint();
      wait();
    }
    return (performance.now() - start) / pictures;
  }

  close() {
    this.closed = true;
    this.shut.abort();
    cancelAnimationFrame(this.asked);
    this.keyTarget.removeEventListener("keydown", this.onKey);
    language.listeners.delete(this.onLanguage);
    matchMedia("(prefers-color-scheme: dark)").removeEventListener("change", this.onTheme);
    this.themeWatch.disconnect();
    this.panels.close();
    this.stage?.close();
    this.host.replaceChildren();
  }
}
