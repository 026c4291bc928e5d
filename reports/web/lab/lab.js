// The lab: a menu of modes, the viewer, and what a person does to the scene. Engines run on the server, natively.

import "./lab.css";

import { button, keepFocus, make } from "../viewer/dom.js";
import { Viewer } from "../viewer/viewer.js";
import { language } from "../viewer/words/words.js";
import { api } from "./api.js";
import { LawBox, lawToml } from "./law_box.js";
import { Menu, titleOf } from "./menu.js";
import { SceneBox } from "./scene_box.js";
import { fragmentOf, sharedIn } from "./share.js";
import { kChanges, Tools } from "./tools.js";

const kGoing_ms = 300; // between two keys of somebody who goes through a menu
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
    this.menu = new Menu((id) => this.openMode(id));
    this.tools = new Tools({ choose: (ball) => this.choseBall(ball), change: (action) => this.change(action) });
    this.lawBox = new LawBox((law) => this.tryLaw(law));
    this.sceneBox = new SceneBox({
      run: (toml) => this.runText(toml), open: (toml) => this.runText(toml, { camera: null }), undo: () => this.undo(), share: () => this.share(),
    });
    this.build();
    language.listeners.add(() => this.say());
  }

  build() {
    this.title = make("h1", {}, "Carom lab");
    this.lead = make("p", { className: "cv-note" });
    this.skip = button("lab-skip", () => this.viewer?.stage?.canvas.focus());
    this.error = make("p", { className: "lab-error", role: "alert", lang: "en" });
    this.busy = make("p", { className: "lab-busy", role: "status", "aria-live": "polite" });
    // Heard and not seen: what a look at the page tells.
    this.said = make("p", { className: "lab-said", role: "status", "aria-live": "polite" });
    this.sceneTitle = make("h2");
    this.viewerHost = make("div");
    this.host.replaceChildren(this.skip, make("header", {}, this.title, this.lead), make("div", { className: "lab-body" }, this.menu.element,
      make("main", {}, this.sceneTitle, this.error, this.busy, this.said, this.tools.element, this.viewerHost, this.lawBox.element, this.sceneBox.element)));
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
    this.menu.fill(this.modes);
    this.say();
    if (!await this.openAddress()) {
      const { textContent, lang } = this.error;
      await this.openMode(Menu.first(this.modes)?.id);
      this.tellError(textContent, lang);
    }
    addEventListener("hashchange", () => this.openAddress());
  }

  /** Opens the scene or the mode of the address. @returns whether it has one that can be read */
  async openAddress() {
    const mode = /^#m=(.+)$/.exec(location.hash)?.[1];
    const shared = await sharedIn(location.hash);
    if (shared) await this.openShared(shared);
    else if (mode) await this.openMode(decodeURIComponent(mode));
    else if (location.hash.startsWith("#s=")) this.tellError(language.words.lab.badLink);
    return Boolean(this.viewer);
  }

  // --- scenes

  async openMode(id) {
    if (!id) return;
    this.wanted = id;
    clearTimeout(this.choosing);
    await this.guarded(async () => {
      if (this.wanted !== id) return; // somebody goes through the list, and is farther by now
      const { toml } = await api.scene(id).catch((error) => {
        this.wanted = this.id;
        this.say();
        throw error;
      });
      this.id = id;
      this.history = [];
      this.forgetLaw();
      this.viewer?.close();
      this.viewer = null;
      this.tools.tool = kFirstTool[id] ?? "choose";
      this.chooseFirst(kFirstEngines[id]);
      history.replaceState(null, "", `#m=${encodeURIComponent(id)}`);
      await this.run(toml, { toggles: kFirstToggles[id], autoplay: true });
      this.tell(this.sceneTitle.textContent, language.words.modes[id]?.see);
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
    this.wanted = id;
    clearTimeout(this.choosing);
    await this.guarded(async () => {
      this.id = id;
      this.chosen = engines ?? this.chosen;
      if (law) {
        this.lawBox.set(law);
        this.putLawBeside(law);
      } else {
        this.forgetLaw();
      }
      await this.run(toml, { camera: null });
      this.tell(this.sceneTitle.textContent);
    });
  }

  /** A text that is not the one shown is no mode of the course any more: neither its words nor its address are its own. */
  runText(toml, options = {}) {
    const same = toml === this.toml;
    return this.guarded(async () => {
      await this.run(toml, options, { remember: true, id: same ? this.id : null });
      if (!same) this.standFor(null);
    }, this.sceneBox.error);
  }

  async undo() {
    const before = this.history.pop();
    if (before === undefined) return;
    await this.guarded(async () => {
      await this.run(before.toml, {}, { id: before.id });
      this.standFor(before.id);
    }, this.sceneBox.error);
  }

  /** What the address and the menu say is open. */
  standFor(id) {
    this.wanted = id;
    history.replaceState(null, "", id ? `#m=${encodeURIComponent(id)}` : location.pathname);
    this.say();
  }

  /** A playback of the chosen engines; where none of them can run the scene, of Carom. And the runs that failed. */
  async playbackOf(toml) {
    const playback = await this.ask(toml);
    const failed = playback.runs.filter((run) => this.chosen.includes(run.label) && run.status !== "ok");
    if (playback.runs.some((run) => run.positions || run.same_as) || this.chosen.includes(kFallback)) return { playback, failed };
    this.chooseFirst([kFallback, ""]);
    return { playback: await this.ask(toml), failed };
  }

  async ask(toml) {
    const engines = this.chosen.filter((label) => label && label !== kTruth && label !== kOwnLaw);
    const request = { toml, engines: engines.length > 0 ? engines : [kFallback], truth: this.chosen.includes(kTruth) };
    if (this.chosen.includes(kOwnLaw)) request.law = lawToml(this.law);
    return api.run(request);
  }

  /** Runs the scene in the chosen engines and plays it on from where the last one was. */
  async run(toml, options, { remember = false, id = this.id } = {}) {
    this.busy.textContent = language.words.lab.running;
    const { playback, failed } = await this.playbackOf(toml).finally(() => { this.busy.textContent = ""; });
    if (id) playback.scene.id = id;
    if (remember && this.toml !== undefined) this.history.push({ toml: this.toml, id: this.id });
    this.toml = toml;
    this.id = id;
    this.tools.tellChange(null);
    this.sceneBox.text.value = toml;
    const kept = this.viewer?.state() ?? {};
    const giveFocusBack = keepFocus(this.viewerHost);
    this.viewer?.close();
    const host = make("div");
    this.viewerHost.replaceChildren(host);
    this.viewer = await Viewer.mount(host, playback, {
      ...kept, ...options, engines: this.chosen, global: true, choices: this.choices(), toggles: { ...kept.toggles, ...options.toggles },
      onEngines: (labels, missing) => this.chooseEngines(labels, missing), onBall: (found) => this.clickedBall(found),
    });
    host.caromViewer = this.viewer;
    this.say();
    giveFocusBack();
    this.tellError(failed.map((run) => language.words.notThere(language.words.label(run.label), run.reason || run.status)).join("\n"));
  }

  choices() {
    return [...this.engines, ...(this.law ? [kOwnLaw] : []), kTruth];
  }

  /** Who goes through a menu by keys comes by others first: only where they stay is run. */
  chooseEngines(labels, missing) {
    this.chosen = labels;
    this.before = null;
    clearTimeout(this.choosing);
    if (missing) this.choosing = setTimeout(() => this.runChosen(), kGoing_ms);
  }

  runChosen() {
    return this.guarded(async () => {
      await this.run(this.toml, {});
      this.tell(this.viewer.labels.filter(Boolean).map((label) => language.words.label(label)).join(", "));
    });
  }

  // --- what a person does to a ball

  choseBall(ball) {
    if (!this.viewer) return;
    this.viewer.chosen = ball ?? -1;
    this.viewer.show();
  }

  clickedBall({ ball, button: pressed, time }) {
    this.tools.ball = ball;
    this.tools.show();
    const lighter = this.tools.tool === "lighter" || pressed === 2;
    if (this.tools.tool === "choose") return;
    this.change(lighter ? kChanges.lighter : kChanges.heavier, time);
  }

  change(action, time = this.viewer.clock.time) {
    const { ball } = this.tools;
    return this.guarded(async () => {
      const { toml } = await api.withEvent(this.toml, { time, ball, ...action });
      await this.run(toml, { time, changedAt: time }, { remember: true });
      this.viewer.chosen = ball;
      const { masses, radii } = this.viewer.bodiesAfter(time);
      this.tools.tellChange({ ball, mass: masses[ball], radius: radii[ball] });
      this.tell(this.tools.changeText);
    });
  }

  // --- law and link

  async tryLaw(law) {
    if (!law) {
      this.forgetLaw();
      await this.guarded(() => this.run(this.toml, { layout: "one" }));
      return null;
    }
    const report = await api.law(lawToml(law));
    this.putLawBeside(law);
    await this.guarded(() => this.run(this.toml, { layout: "beside" }));
    return report;
  }

  /** The law runs as an engine of its own, beside the first; where it was chosen already it stays in its place. */
  putLawBeside(law) {
    this.law = law;
    if (!this.chosen.includes(kOwnLaw)) this.chosen = [this.chosen[0] || kFallback, kOwnLaw];
  }

  forgetLaw() {
    this.law = null;
    const others = this.chosen.filter((label) => label !== kOwnLaw);
    this.chosen = [others[0] || kFallback, others[1] ?? ""];
  }

  async share() {
    const fragment = await fragmentOf({ toml: this.toml, id: this.id, engines: this.chosen, ...(this.law ? { law: this.law } : {}) });
    history.replaceState(null, "", fragment);
    this.sceneBox.showLink(location.href);
    await navigator.clipboard?.writeText(location.href).catch(() => {});
    this.busy.textContent = language.words.lab.shared;
  }

  /** Does one thing after the other, so that a late answer never replaces a newer one; what fails is told where it was asked. */
  guarded(work, told = this.error) {
    this.queue = (this.queue ?? Promise.resolve()).then(async () => {
      for (const error of [this.error, this.sceneBox.error]) error.textContent = "";
      try {
        await work();
      } catch (error) {
        told.lang = error.lang ?? "en"; // the server's words are English
        told.textContent = error.message;
      }
    });
    return this.queue;
  }

  tellError(text, lang = language.id) {
    this.error.lang = lang;
    this.error.textContent = text;
  }

  // --- words

  /** Tells by voice what is to be seen at once. */
  tell(...parts) {
    this.said.textContent = parts.filter(Boolean).join(". ");
  }

  say() {
    const { lab } = language.words;
    document.documentElement.lang = language.id;
    document.title = lab.title;
    this.title.textContent = lab.title;
    this.lead.textContent = lab.lead;
    this.skip.textContent = lab.skip;
    this.lawBox.say();
    this.sceneBox.say();
    this.menu.say(this.wanted);
    this.tools.say();
    this.tools.show(this.viewer?.playback.balls.shown ?? 0);
    const mode = this.modes.find(({ id }) => id === this.id);
    const { text, lang } = titleOf(mode ?? { title: this.viewer?.playback.scene.title ?? "" });
    this.sceneTitle.textContent = text;
    this.sceneTitle.lang = lang;
  }
}

const kOwnLaw = "law@own"; // as the server calls the run by the law that was typed
const kTruth = "truth";
const kFallback = "carom";

const lab = new Lab(document.getElementById("lab"));
document.getElementById("lab").caromLab = lab;
lab.start();
