import { de } from "./de.js";
import { en } from "./en.js";

const kLanguages = { en, de };
const kStore = "carom-language";

export const languages = Object.entries(kLanguages).map(([id, words]) => ({ id, name: words.name }));

function remembered() {
  try { return localStorage.getItem(kStore); } catch { return null; } // a page from a file may have no storage
}

/** The language of the page's viewers: the one chosen before, else the first of the browser's that there is. */
class Language {
  constructor() {
    const wished = [remembered(), ...(globalThis.navigator?.languages ?? [])].filter(Boolean);
    this.id = wished.map((tag) => tag.slice(0, 2)).find((tag) => tag in kLanguages) ?? "en";
    this.listeners = new Set();
  }

  get words() { return kLanguages[this.id]; }

  choose(id) {
    if (!(id in kLanguages) || id === this.id) return;
    this.id = id;
    try { localStorage.setItem(kStore, id); } catch { /* then it is forgotten */ }
    for (const listener of this.listeners) listener();
  }

  /** A number as people read it in this language, with so many digits. */
  number(value, digits = 4) {
    if (!Number.isFinite(value)) return value > 0 ? "∞" : value < 0 ? "−∞" : "–";
    const size = Math.abs(value);
    const text = size !== 0 && (size < 1e-3 || size >= 1e5)
      ? value.toExponential(digits - 1).replace(/\.?0*e\+?/, "e")
      : String(Number(value.toPrecision(digits)));
    return (this.id === "de" ? text.replace(".", ",") : text).replaceAll("-", "−");
  }
}

export const language = new Language();
