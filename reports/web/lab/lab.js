// The lab: a menu of modes, the viewer, and what a person does to the scene. Engines run on the server, natively.

import "./lab.css";

import { button, make } from "../viewer/dom.js";
import { Viewer } from "../viewer/viewer.js";
import { language } from "../viewer/words/words.js";
import { api } from "./api.js";
import { LawBox, lawToml } from "./law_box.js";
import { SceneBox } from "./scene_box.js";
import { fragmentOf, sharedIn } from "./share.js";

const kHeavier = { scale_mass: 1.1, scale_radius: 1.05 };
const kLighter = { scale_mass: 0.9, scale_radius: 0.95 };
const kTools = ["choose", "heavier", "lighter"];
// The modes as the course comes to them; others of the course follow.
const kOrder = ["normal-mode", "brute-force", "quadtree", "octree", "impulse", "velocity-arrows", "effet", "thin-slab", "quantum-barrier"]
  .map((name) => `course/${name}`);
const kFirstTool = { "course/impulse": "heavier" };
const kFirstEngines = { "course/thin-slab": ["carom:step", "carom"] };
const kFirstToggles = {
  "course/velocity-arrows": { velocity: true }, "course/quadtree": { tree: true }, "course/octree": { tree: true },
  "course/impulse": { impulse: true },
};

class Lab {
  constructor(host) {
    this.host = host;
    this.modes = [];
    this.engines = [];
    this.chosen = ["carom", ""];
    this.history = [];
    this.tool = "choose";
    this.lawBox = new LawBox((law) => this.tryLaw(law));
    this.sceneBox = new SceneBox({ run: (toml) => this.runText(toml), undo: () => this.undo(), share: () => this.share() });
    this.build();
    language.listeners.add(() => this.say());
  }

  build() {
    this.title = make("h1", {}, "Carom lab");
    this.lead = make("p", { className: "cv-note" });
    this.menu = make("nav", { className: "lab-menu" });
    this.error = make("p", { className: "lab-error", role: "alert" });
    this.busy = make("p", { className: "lab-busy", role: "status", "aria-live": "polite" });
    this.sceneTitle = make("h2");
    this.tools = make("fieldset", { className: "lab-tools" });
    this.viewerHost = make("div");
    this.host.replaceChildren(make("header", {}, this.title, this.lead), make("div", { className: "lab-body" }, this.menu,
      make("main", {}, this.sceneTitle, this.error, this.busy, this.tools, this.viewerHost, this.lawBox.element, this.sceneBox.element)));
  }

  async start() {
    this.say();
    try {
      [this.modes, this.engines] = await Promise.all([api.modes(), api.engines()]);
    } catch (error) {
      this.error.textContent = error.message;
      return;
    }
    this.engines = this.engines.map(({ label }) => label);
    this.say();
    const shared = await sharedIn(location.hash);
    if (shared) await this.openShared(shared);
    else await this.openMode(decodeURIComponent(/^#m=(.+)$/.exec(location.hash)?.[1] ?? "") || (this.modes.find(({ id }) => id === kOrder[0]) ?? this.modes[0])?.id);
    addEventListener("hashchange", async () => {
      const next = await sharedIn(location.hash);
      if (next) this.openShared(next);
    });
  }

  // --- scenes

  async openMode(id) {
    if (!id) return;
    await this.guarded(async () => {
      const { toml } = await api.scene(id);
      this.id = id;
      this.history = [];
      this.law = null;
      this.viewer?.close();
      this.viewer = null;
      this.tool = kFirstTool[id] ?? "choose";
      this.chooseFirst(kFirstEngines[id]);
      history.replaceState(null, "", `#m=${encodeURIComponent(id)}`);
      await this.run(toml, { toggles: kFirstToggles[id], autoplay: true });
    });
  }

  /** The engines with which a mode begins; what a person chose before comes back with the next mode. */
  chooseFirst(engines) {
    if (engines) {
      this.before ??= this.chosen;
      this.chosen = engines;
    } else if (this.before) {
      this.chosen = this.before;
      this.before = null;
    }
  }

  async openShared({ toml, engines, law, id }) {
    await this.guarded(async () => {
      this.id = id;
      this.chosen = engines ?? this.chosen;
      this.law = law ?? null;
      if (law) this.lawBox.set(law);
      await this.run(toml, {});
    });
  }

  runText(toml) {
    return this.guarded(() => this.run(toml, {}, true));
  }

  async undo() {
    const before = this.history.pop();
    if (before !== undefined) await this.guarded(() => this.run(before, {}));
  }

  /** Runs the scene in the chosen engines and plays it on from where the last one was. */
  async run(toml, options, remember = false) {
    const engines = this.chosen.filter((label) => label && label !== kTruth && !label.startsWith(kLawEngine));
    const request = { toml, engines: engines.length > 0 ? engines : ["carom"], truth: this.chosen.includes(kTruth) };
    if (this.law) request.law = lawToml(this.law);
    this.busy.textContent = language.words.lab.running;
    const playback = await api.run(request).finally(() => { this.busy.textContent = ""; });
    if (this.id) playback.scene.id = this.id;
    if (remember && this.toml !== undefined) this.history.push(this.toml);
    this.toml = toml;
    this.sceneBox.text.value = toml;
    const kept = this.viewer?.state() ?? {};
    this.viewer?.close();
    const own = playback.runs.find((run) => run.engine === kLawEngine)?.label;
    const [first, second] = this.chosen;
    const labels = own && this.law ? [first || own, own] : [first, second];
    const host = make("div");
    this.viewerHost.replaceChildren(host);
    this.viewer = await Viewer.mount(host, playback, {
      ...kept, ...options, engines: labels, global: true, choices: this.choices(own), toggles: { ...kept.toggles, ...options.toggles },
      onEngines: (labels) => this.chooseEngines(labels), onBall: (found) => this.clickedBall(found),
    });
    host.caromViewer = this.viewer;
    this.say();
    const failed = playback.runs.filter((run) => labels.includes(run.label) && run.status !== "ok");
    this.error.textContent = failed.map((run) => language.words.notThere(language.words.label(run.label), run.reason || run.status)).join("\n");
  }

  choices(own) {
    return [...this.engines, ...(own ? [own] : []), kTruth];
  }

  chooseEngines(labels) {
    this.chosen = labels;
    this.before = null;
    return this.guarded(() => this.run(this.toml, { engines: labels }));
  }

  // --- what a person does to a ball

  clickedBall({ ball, button: pressed, time }) {
    this.ball = ball;
    this.sayTools();
    const lighter = this.tool === "lighter" || pressed === 2;
    if (this.tool === "choose") return;
    this.change(lighter ? kLighter : kHeavier, time);
  }

  change(action, time = this.viewer.clock.time) {
    return this.guarded(async () => {
      const { toml } = await api.withEvent(this.toml, { time, ball: this.ball, ...action });
      await this.run(toml, { time }, true);
      this.viewer.chosen = this.ball;
    });
  }

  // --- law and link

  async tryLaw(law) {
    if (!law) {
      this.law = null;
      this.chosen = [this.chosen[0] || "carom", ""];
      await this.guarded(() => this.run(this.toml, { layout: "one" }));
      return null;
    }
    const report = await api.law(lawToml(law));
    this.law = law;
    await this.guarded(() => this.run(this.toml, { layout: "beside" }));
    return report;
  }

  async share() {
    const fragment = await fragmentOf({ toml: this.toml, id: this.id, engines: this.chosen, ...(this.law ? { law: this.law } : {}) });
    history.replaceState(null, "", fragment);
    this.sceneBox.showLink(location.href);
    await navigator.clipboard?.writeText(location.href).catch(() => {});
    this.busy.textContent = language.words.lab.shared;
  }

  /** Does one thing after the other, so that a late answer never replaces a newer one; what fails is told. */
  guarded(work) {
    this.queue = (this.queue ?? Promise.resolve()).then(async () => {
      this.error.textContent = "";
      try {
        await work();
      } catch (error) {
        this.error.textContent = error.message;
      }
    });
    return this.queue;
  }

  // --- words

  say() {
    const { lab } = language.words;
    document.documentElement.lang = language.id;
    document.title = lab.title;
    this.title.textContent = lab.title;
    this.lead.textContent = lab.lead;
    this.lawBox.say();
    this.sceneBox.say();
    this.sayMenu();
    this.sayTools();
    const mode = this.modes.find(({ id }) => id === this.id);
    this.sceneTitle.textContent = mode ? titleOf(mode) : this.viewer?.playback.scene.title ?? "";
  }

  sayMenu() {
    const { lab } = language.words;
    const place = ({ id }) => (kOrder.includes(id) ? kOrder.indexOf(id) : kOrder.length);
    const course = this.modes.filter(({ id }) => id.startsWith("course/")).sort((a, b) => place(a) - place(b));
    const others = this.modes.filter(({ id }) => !id.startsWith("course/"));
    const entries = course.map((mode) => {
      const made = button("lab-mode", () => this.openMode(mode.id));
      made.textContent = titleOf(mode);
      made.dataset.id = mode.id;
      if (mode.id === this.id) made.setAttribute("aria-current", "true");
      return make("li", {}, made);
    });
    const select = make("select", { className: "lab-scenes", "aria-label": lab.otherScenes });
    const groups = Map.groupBy ? Map.groupBy(others, ({ id }) => id.split("/")[0]) : grouped(others);
    select.append(make("option", { value: "" }, lab.otherScenes), ...[...groups].map(([group, modes]) =>
      make("optgroup", { label: group }, ...modes.map((mode) => make("option", { value: mode.id }, titleOf(mode))))));
    select.value = others.some(({ id }) => id === this.id) ? this.id : "";
    select.addEventListener("change", () => this.openMode(select.value));
    this.menu.setAttribute("aria-label", lab.modes);
    this.menu.replaceChildren(make("h2", {}, lab.modes), make("ul", {}, ...entries), ...(others.length > 0 ? [select] : []));
  }

  sayTools() {
    const { lab } = language.words;
    const tools = kTools.map((tool) => {
      const radio = make("input", { type: "radio", name: "lab-tool", value: tool, checked: tool === this.tool });
      radio.addEventListener("change", () => { this.tool = tool; });
      return make("label", {}, radio, ` ${lab.tools[tool]}`);
    });
    const changes = [["heavier", kHeavier], ["lighter", kLighter]].map(([name, action]) => {
      const made = button(`lab-${name}`, () => this.change(action));
      made.textContent = lab[name];
      made.disabled = this.ball === undefined || !this.viewer;
      return made;
    });
    const count = this.viewer?.playback.balls.shown ?? 0;
    if (this.ball >= count) this.ball = undefined;
    const ball = make("input", { type: "number", min: 0, max: Math.max(count - 1, 0), className: "lab-ball", value: this.ball ?? "" });
    ball.addEventListener("change", () => {
      const asked = Number(ball.value);
      this.ball = ball.value !== "" && asked >= 0 && asked < count ? asked : undefined;
      if (this.viewer) { this.viewer.chosen = this.ball ?? -1; this.viewer.show(); }
      changes.forEach((made) => { made.disabled = this.ball === undefined; });
    });
    this.tools.replaceChildren(make("legend", {}, lab.click), ...tools, make("label", {}, `${lab.ball} `, ball), ...changes);
  }
}

const kLawEngine = "carom:law";
const kTruth = "truth";

function grouped(modes) {
  const groups = new Map();
  for (const mode of modes) {
    const group = mode.id.split("/")[0];
    groups.set(group, [...(groups.get(group) ?? []), mode]);
  }
  return groups;
}

const titleOf = ({ id, title }) => language.words.modes[id]?.title ?? title ?? id;

const lab = new Lab(document.getElementById("lab"));
document.getElementById("lab").caromLab = lab;
lab.start();
