import { kSpeeds, nameOfSpeed } from "./clock.js";
import { css, parted } from "./colours.js";
import { button, make } from "./dom.js";
import { formulas } from "./formulas.js";
import { Timeline } from "./timeline.js";
import { language, languages } from "./words/words.js";

const kSwitches = [["velocity", "V"], ["impulse", "3"], ["momentum", "M"], ["spin", "E"], ["trails", "T"], ["tree", "Q"], ["centre", "C"], ["frame", ""]];
const kTurn = 0.12;
// Modes about how pairs are found: the number of tests is told with or without the tree.
const kCountedModes = ["course/brute-force", "course/quadtree", "course/octree"];

/** Menus, buttons and keys of a viewer. Everything that a pointer can do, the keyboard can. */
export class Controls {
  constructor(viewer) {
    this.viewer = viewer;
    this.buildHead();
    this.buildTransport();
    this.buildSwitches();
    this.caption = make("div", { className: "cv-caption" });
    this.counts = make("p", { className: "cv-counts" });
    this.dialog = make("dialog", { className: "cv-help" });
  }

  labelled(name, control) {
    const text = make("span");
    this.labels ??= {};
    this.labels[name] = text;
    return make("label", { className: `cv-field cv-field-${name}` }, text, control);
  }

  buildHead() {
    const { viewer } = this;
    this.engines = [0, 1].map((k) => {
      const select = make("select", { className: `cv-engine-${"ab"[k]}` });
      select.addEventListener("change", () => viewer.choose(this.engines[0].value, this.engines[1].value));
      return select;
    });
    this.layout = make("select", { className: "cv-layout" });
    this.layout.addEventListener("change", () => viewer.setLayout(this.layout.value));
    this.colouring = make("select", { className: "cv-colouring" });
    this.colouring.addEventListener("change", () => { viewer.colouring = this.colouring.value; viewer.show(); });
    this.language = make("select", { className: "cv-language" });
    this.language.append(...languages.map(({ id, name }) => make("option", { value: id, lang: id }, name)));
    this.language.addEventListener("change", () => language.choose(this.language.value));
    this.help = button("cv-help-button", () => this.showHelp());
    this.head = make("div", { className: "cv-head" }, this.labelled("engineA", this.engines[0]),
      this.labelled("engineB", this.engines[1]), this.labelled("layout", this.layout),
      this.labelled("colours", this.colouring), this.labelled("language", this.language), this.help);
  }

  buildTransport() {
    const { viewer } = this;
    this.buttons = {
      restart: button("cv-restart", () => viewer.restart()),
      impactBack: button("cv-impact-back", () => viewer.stepImpacts(-1)),
      frameBack: button("cv-frame-back", () => viewer.stepFrames(-1)),
      play: button("cv-play", () => viewer.toggle()),
      frameOn: button("cv-frame-on", () => viewer.stepFrames(1)),
      impactOn: button("cv-impact-on", () => viewer.stepImpacts(1)),
    };
    const signs = { restart: "↺", impactBack: "⇤", frameBack: "◁", frameOn: "▷", impactOn: "⇥" };
    for (const [name, sign] of Object.entries(signs)) this.buttons[name].textContent = sign;
    this.speed = make("select", { className: "cv-speed" },
      ...kSpeeds.map((speed) => make("option", { value: speed }, `× ${nameOfSpeed(speed)}`)));
    this.speed.addEventListener("change", () => { viewer.clock.speed = Number(this.speed.value); viewer.show(); });
    this.time = make("output", { className: "cv-time" });
    this.rate = make("span", { className: "cv-note cv-rate" });
    this.timeline = new Timeline(viewer.clock.duration, (time) => viewer.goTo(time));
    this.transport = make("div", { className: "cv-transport" }, this.timeline.element,
      make("div", { className: "cv-buttons", role: "group" }, ...Object.values(this.buttons)),
      this.labelled("speed", this.speed), this.time, this.rate);
  }

  buildSwitches() {
    const { viewer } = this;
    this.toggles = {};
    this.switches = make("div", { className: "cv-switches", role: "group" });
    for (const [name] of kSwitches) {
      this.toggles[name] = button(`cv-toggle cv-toggle-${name}`, () => viewer.switch(name));
      this.switches.append(this.toggles[name]);
    }
    const view = [["zoomIn", "+", () => viewer.stage.camera.zoomBy(1.25)], ["zoomOut", "−", () => viewer.stage.camera.zoomBy(0.8)],
      ["resetView", "⌂", () => viewer.stage.camera.reset()]];
    this.viewButtons = view.map(([name, sign, act]) => {
      const made = button("cv-view", () => { act(); viewer.request(); });
      made.textContent = sign;
      made.dataset.name = name;
      return made;
    });
    this.csv = button("cv-csv", () => viewer.saveCsv());
    this.png = button("cv-png", () => viewer.savePng());
    this.switches.append(...this.viewButtons, this.csv, this.png);
  }

  /** All words anew, in the language of the page, and the menus of what there is. */
  say() {
    const { words } = language;
    const { viewer } = this;
    viewer.host.lang = language.id;
    for (const [name, text] of Object.entries(this.labels)) text.textContent = words[name];
    const there = viewer.playback.played.map((run) => run.label);
    const played = viewer.options.choices ? [...new Set([...viewer.options.choices, ...there])] : there;
    const options = played.map((label) => [label, words.label(label)]);
    this.fill(this.engines[0], options, viewer.labels[0]);
    this.fill(this.engines[1], [["", words.none], ...options.filter(([label]) => label !== viewer.labels[0])], viewer.labels[1]);
    this.fill(this.layout, Object.entries(words.layouts), viewer.layout);
    this.fill(this.colouring, Object.entries(words.colourings), viewer.colouring);
    this.language.value = language.id;
    this.help.textContent = `${words.help} (H)`;
    for (const name of ["restart", "impactBack", "frameBack", "frameOn", "impactOn"]) name_of(this.buttons[name], words[name]);
    for (const made of this.viewButtons) name_of(made, words[made.dataset.name]);
    this.csv.textContent = words.exportCsv;
    this.png.textContent = words.exportPng;
    for (const made of [this.csv, this.png]) made.title = `${words.export}: ${made.textContent}`;
    this.engines[1].setAttribute("aria-label", words.engineBesides);
    this.timeline.slider.setAttribute("aria-label", words.timeline);
    const space = viewer.playback.scene.dimension === 3;
    const { canvas, message } = viewer.stage ?? {};
    canvas?.setAttribute("aria-label", words.picture(words.drag[space ? "space" : "plane"]));
    if (message) message.textContent = words.noWebGl;
    this.sayCaption();
    this.sayHelp();
    viewer.panels.say();
  }

  fill(select, options, chosen) {
    select.replaceChildren(...options.map(([value, text]) => make("option", { value }, text)));
    select.value = chosen;
  }

  sayCaption() {
    const { words } = language;
    const { playback } = this.viewer;
    const mode = words.modes[playback.scene.id];
    const parts = [];
    if (mode) {
      parts.push(make("p", {}, make("strong", {}, words.sees), " ", mode.see));
      const formula = make("div", { className: "cv-formula" });
      formula.innerHTML = formulas[playback.scene.id] ?? "";
      parts.push(make("p", {}, make("strong", {}, words.formula), " ", mode.formula), formula,
        make("p", {}, make("strong", {}, words.tries), " ", mode.try));
    }
    this.mode = make("div", { className: "cv-mode" }, ...parts);
    this.legend = make("p", { className: "cv-legend cv-note" });
    this.caption.replaceChildren(this.legend, this.mode);
  }

  sayHelp() {
    const { words } = language;
    const rows = words.keys.map(([key, text]) => make("div", {}, make("dt", {}, make("kbd", {}, key)), make("dd", {}, text)));
    const shut = button("cv-close", () => this.dialog.close());
    shut.textContent = words.close;
    this.dialog.setAttribute("aria-label", words.keysTitle);
    const everywhere = make("input", { type: "checkbox", className: "cv-keys-everywhere", checked: keysEverywhere() });
    everywhere.addEventListener("change", () => setKeysEverywhere(everywhere.checked));
    this.dialog.replaceChildren(make("h3", {}, words.keysTitle), make("dl", {}, ...rows),
      make("p", {}, make("label", {}, everywhere, ` ${words.keysEverywhere}`)), shut);
  }

  showHelp() {
    if (this.dialog.open) this.dialog.close(); else this.dialog.showModal();
  }

  /** The state of all menus and buttons. */
  show() {
    const { viewer } = this;
    const { words } = language;
    const { clock, toggles } = viewer;
    this.showTime();
    const playing = clock.playing;
    this.buttons.play.textContent = playing ? "❚❚" : "▶";
    name_of(this.buttons.play, playing ? words.pause : words.play);
    this.speed.value = clock.speed;
    this.rate.textContent = words.rate(language.number(clock.rate * clock.speed, 3));
    this.layout.value = viewer.layout;
    this.layout.disabled = viewer.motions.length < 2;
    this.colouring.value = viewer.colouring;
    this.colouring.querySelector("[value=parted]").disabled = viewer.motions.length < 2;
    for (const [name, key] of kSwitches) {
      const made = this.toggles[name];
      const more = name === "spin" ? `: ${words.spinStates[toggles.spin]}` : "";
      made.textContent = `${this.nameOfToggle(name)}${more}${key ? ` (${key})` : ""}`;
      made.title = words.hints[name];
      made.setAttribute("aria-pressed", String(name === "spin" ? toggles.spin !== "off" : toggles[name]));
    }
    this.timeline.draw(viewer.motions, viewer.theme);
    this.showCounts();
  }

  nameOfToggle(name) {
    const { toggles } = language.words;
    return name === "tree" ? toggles.tree[this.viewer.playback.scene.dimension - 2] : toggles[name];
  }

  /** What is said when a switch was turned. */
  toldToggle(name) {
    const { words } = language;
    const state = this.viewer.toggles[name];
    return `${this.nameOfToggle(name)}: ${name === "spin" ? words.spinStates[state] : words.onOff[state ? 0 : 1]}`;
  }

  showTime() {
    const { clock, host } = this.viewer;
    this.time.textContent = language.words.clock(language.number(clock.time, 4), language.number(clock.duration));
    host.dataset.time = clock.time;
    host.dataset.playing = clock.playing;
    this.timeline.show(clock.time);
  }

  showCounts() {
    const { viewer } = this;
    const { words } = language;
    const lines = [];
    const { dimension, id } = viewer.playback.scene;
    const tests = viewer.toggles.tree || kCountedModes.includes(id) ? viewer.tests() : null;
    if (tests) lines.push(words.tests(tests.bruteForce, tests.tree, words.toggles.tree[dimension - 2]));
    const barrier = viewer.barrier();
    if (barrier) {
      const { sent, back, all, expected, error } = barrier;
      lines.push(words.barrier(sent, back, all, language.number(expected, 5), language.number(error, 2), language.number(sent / (sent + back))));
    }
    const slab = viewer.slab();
    if (slab) lines.push(words.slab(slab.beyond, slab.all));
    const apart = viewer.apartNow();
    if (apart) lines.push(words.difference(language.number(apart.now, 3), language.number(apart.most, 3)));
    this.counts.replaceChildren(...lines.map((line) => make("span", {}, line)));
    this.legend.hidden = viewer.colouring !== "parted" || !apart;
    if (!this.legend.hidden && !this.legend.firstChild) {
      const bar = make("span", { className: "cv-ramp", "aria-hidden": "true" });
      bar.style.background = `linear-gradient(90deg, ${css(parted(0))}, ${css(parted(1))})`;
      this.legend.replaceChildren(bar, " ", words.legendParted);
    }
  }

  /** One key. What a person types into a field stays there. */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const { viewer } = this;
    const at = event.target;
    if (at.matches?.("textarea, select, input:not([type=range], [type=checkbox]), [contenteditable]")) return;
    if (event.key === " " && at.matches?.("button, summary, a, input[type=checkbox]")) return;
    if (event.key.startsWith("Arrow") && at.matches?.(".cv-scroll, [role=tab]")) return;
    if (!viewer.stage || !(keysEverywhere() || at === viewer.stage.canvas || this.dialog.open)) return;
    const act = this.actionOf(event);
    if (!act) return;
    event.preventDefault();
    act();
    viewer.show();
  }

  actionOf(event) {
    const { viewer } = this;
    const { camera } = viewer.stage;
    const move = (x, y) => () => (camera.flat ? camera.pan(-x, y) : camera.orbit(x, y));
    const centre = () => {
      const { toggles } = viewer;
      if (!toggles.centre) viewer.switch("centre");
      else if (!toggles.frame) viewer.switch("frame");
      else {
        toggles.frame = false;
        viewer.switch("centre");
      }
    };
    const actions = {
      " ": () => viewer.toggle(), r: () => viewer.restart(), h: () => this.showHelp(), "?": () => this.showHelp(),
      3: () => viewer.switch("impulse"), v: () => viewer.switch("velocity"), e: () => viewer.switch("spin"),
      q: () => viewer.switch("tree"), m: () => viewer.switch("momentum"), t: () => viewer.switch("trails"), c: centre,
      b: () => viewer.nextLayout(), w: move(0, kTurn), s: move(0, -kTurn), a: move(-kTurn, 0), d: move(kTurn, 0),
      "+": () => camera.zoomBy(1.25), "-": () => camera.zoomBy(0.8), 0: () => camera.reset(),
      arrowleft: () => (event.shiftKey ? viewer.stepImpacts(-1) : viewer.stepFrames(-1)),
      arrowright: () => (event.shiftKey ? viewer.stepImpacts(1) : viewer.stepFrames(1)),
      arrowup: () => viewer.faster(1), arrowdown: () => viewer.faster(-1),
    };
    return actions[event.key.toLowerCase()];
  }
}

// Single keys get in the way of who steers a browser by voice, or by keys of their own: they may be kept to the picture.
const kKeysStore = "carom-keys";
let everywhere_here = true; // where a page has no storage

function keysEverywhere() {
  try { return (localStorage.getItem(kKeysStore) ?? "everywhere") === "everywhere"; } catch { return everywhere_here; }
}

function setKeysEverywhere(on) {
  everywhere_here = on;
  try { localStorage.setItem(kKeysStore, on ? "everywhere" : "picture"); } catch { /* then until the page is closed */ }
}

function name_of(made, name) {
  made.title = name;
  made.setAttribute("aria-label", name);
}
