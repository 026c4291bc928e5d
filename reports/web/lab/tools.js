// What a click on a ball does, and the same for the keyboard: a ball by its number, made heavier or lighter.

import { button, make } from "../viewer/dom.js";
import { language } from "../viewer/words/words.js";

const kTools = ["choose", "heavier", "lighter"];
export const kChanges = {
  heavier: { scale_mass: 1.1, scale_radius: 1.05 },
  lighter: { scale_mass: 0.9, scale_radius: 0.95 },
};

export class Tools {
  /** @param asked  choose(ball or nothing), change(action) */
  constructor(asked) {
    this.tool = "choose";
    this.ball = undefined;
    this.legend = make("legend");
    this.radios = kTools.map((tool) => {
      const radio = make("input", { type: "radio", name: "lab-tool", value: tool });
      radio.addEventListener("change", () => { this.tool = tool; });
      const text = make("span");
      return { tool, radio, text, label: make("label", {}, radio, " ", text) };
    });
    this.number = make("input", { type: "number", min: 0, className: "lab-ball" });
    this.number.addEventListener("change", () => {
      const asked_ball = Number(this.number.value);
      const there = this.number.value !== "" && Number.isInteger(asked_ball) && asked_ball >= 0 && asked_ball < this.count;
      this.ball = there ? asked_ball : undefined;
      this.show();
      asked.choose(this.ball);
    });
    this.ballName = make("span");
    this.changes = Object.entries(kChanges).map(([name, action]) => ({ name, made: button(`lab-${name}`, () => asked.change(action)) }));
    // The lab tells a screen reader the same by its own line.
    this.changeNote = make("span", { className: "lab-changed cv-note", "aria-hidden": "true" });
    this.element = make("fieldset", { className: "lab-tools" }, this.legend, ...this.radios.map(({ label }) => label),
      make("label", {}, this.ballName, " ", this.number), ...this.changes.map(({ made }) => made), this.changeNote);
    this.count = 0;
  }

  /** @param change  the ball that was changed, its mass and radius after that; or nothing */
  tellChange(change) {
    this.change = change;
    this.changeNote.textContent = this.changeText;
  }

  get changeText() {
    if (!this.change) return "";
    const { ball, mass, radius } = this.change;
    return language.words.lab.changed(ball, language.number(mass), language.number(radius));
  }

  say() {
    this.tellChange(this.change);
    const { lab } = language.words;
    this.legend.textContent = lab.click;
    for (const { tool, text, label } of this.radios) {
      text.textContent = lab.tools[tool];
      label.title = lab.byHowMuch[tool] ?? "";
    }
    this.ballName.textContent = lab.ball;
    for (const { name, made } of this.changes) {
      made.textContent = lab[name];
      made.title = lab.byHowMuch[name];
    }
  }

  /** @param count  how many balls there are to choose from */
  show(count = this.count) {
    this.count = count;
    if (!(this.ball < count)) this.ball = undefined;
    for (const { tool, radio } of this.radios) radio.checked = tool === this.tool;
    this.number.max = Math.max(count - 1, 0);
    this.number.value = this.ball ?? "";
    for (const { made } of this.changes) made.disabled = this.ball === undefined;
  }
}
