// The scene as its file says it: to read, to change, to save and to open.

import { button, make, save } from "../viewer/dom.js";
import { language } from "../viewer/words/words.js";

export class SceneBox {
  /** @param asked  run(toml), open(toml), undo(), share() */
  constructor(asked) {
    this.text = make("textarea", { className: "lab-toml", rows: 16, spellcheck: false });
    this.run = button("lab-run", () => asked.run(this.text.value));
    this.undo = button("lab-undo", () => asked.undo());
    this.save = button("lab-save", () => save("scene.toml", new Blob([this.text.value], { type: "application/toml" })));
    this.share = button("lab-share", () => asked.share());
    this.file = make("input", { type: "file", accept: ".toml", className: "lab-open" });
    this.file.addEventListener("change", async () => {
      const [file] = this.file.files;
      if (file) asked.open(await file.text());
      this.file.value = "";
    });
    // Beside the text that it is about: the page's own is far above, out of sight.
    this.error = make("p", { className: "lab-error", role: "alert", lang: "en" });
    this.summary = make("summary");
    this.label = make("span");
    this.openLabel = make("span");
    this.link = make("input", { type: "text", readOnly: true, className: "lab-link", hidden: true });
    this.element = make("details", { className: "lab-box lab-scene" }, this.summary,
      make("label", { className: "cv-field" }, this.label, this.text),
      make("div", { className: "cv-buttons" }, this.run, this.undo, this.save, this.share),
      this.error, make("label", { className: "cv-field" }, this.openLabel, this.file), this.link);
  }

  say() {
    const { lab } = language.words;
    this.summary.textContent = lab.sceneTitle;
    this.label.textContent = lab.toml;
    this.run.textContent = lab.runText;
    this.undo.textContent = lab.undo;
    this.save.textContent = lab.saveToml;
    this.share.textContent = lab.share;
    this.openLabel.textContent = lab.open;
    this.link.setAttribute("aria-label", lab.link);
  }

  showLink(address) {
    this.element.open = true;
    this.link.hidden = false;
    this.link.value = address;
    this.link.select();
  }
}
