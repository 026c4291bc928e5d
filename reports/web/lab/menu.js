// The menu of modes: those of the course as buttons, every other scene in one list. Its elements stay while words change,
// so that whoever stands on one with the keyboard goes on from there.

import { button, make } from "../viewer/dom.js";
import { language } from "../viewer/words/words.js";

// The modes as the course comes to them; others of the course follow.
const kOrder = ["normal-mode", "brute-force", "quadtree", "octree", "impulse", "velocity-arrows", "effet", "thin-slab", "quantum-barrier"]
  .map((name) => `course/${name}`);

const isOfCourse = ({ id }) => id.startsWith("course/");
const place = ({ id }) => (kOrder.includes(id) ? kOrder.indexOf(id) : kOrder.length);
const ownTitle = ({ id }) => language.words.modes[id]?.title;

/** The title of a scene, and in which language it is. */
export function titleOf(scene) {
  const own = ownTitle(scene);
  return { text: own ?? scene.title ?? scene.id, lang: own ? language.id : "en" };
}

export class Menu {
  /** @param open  (id): a mode was chosen */
  constructor(open) {
    this.open = open;
    this.heading = make("h2");
    this.list = make("ul");
    this.scenes = make("select", { className: "lab-scenes" });
    this.scenes.addEventListener("change", () => { if (this.scenes.value) open(this.scenes.value); });
    this.none = make("option", { value: "" });
    this.element = make("nav", { className: "lab-menu" }, this.heading, this.list, this.scenes);
    this.entries = [];
    this.fill([]);
  }

  /** The one that comes first in the course, or at all. */
  static first(modes) {
    return modes.find(({ id }) => id === kOrder[0]) ?? modes[0];
  }

  fill(modes) {
    this.entries = modes.filter(isOfCourse).sort((a, b) => place(a) - place(b)).map((mode) => {
      const made = button("lab-mode", () => this.open(mode.id));
      made.dataset.id = mode.id;
      return { mode, made };
    });
    this.list.replaceChildren(...this.entries.map(({ made }) => make("li", {}, made)));
    const groups = new Map();
    this.others = modes.filter((mode) => !isOfCourse(mode)).map((mode) => {
      const made = make("option", { value: mode.id });
      const group = mode.id.split("/")[0];
      if (!groups.has(group)) groups.set(group, make("optgroup", { label: group }));
      groups.get(group).append(made);
      return { mode, made };
    });
    this.scenes.replaceChildren(this.none, ...groups.values());
    this.scenes.hidden = this.others.length === 0;
  }

  /** Words anew, and which scene is open. */
  say(open) {
    const { lab } = language.words;
    this.element.setAttribute("aria-label", lab.modes);
    this.heading.textContent = lab.modes;
    this.none.textContent = lab.otherScenes;
    this.scenes.setAttribute("aria-label", lab.otherScenes);
    for (const { mode, made } of [...this.entries, ...this.others]) {
      const { text, lang } = titleOf(mode);
      made.textContent = text;
      made.lang = lang;
    }
    for (const { mode, made } of this.entries) {
      if (mode.id === open) made.setAttribute("aria-current", "true"); else made.removeAttribute("aria-current");
    }
    this.scenes.value = this.others.some(({ mode }) => mode.id === open) ? open : "";
  }
}
