// The box in which somebody types a law of impact, and sees what it keeps and breaks beside the right one.

import { button, make } from "../viewer/dom.js";
import { language } from "../viewer/words/words.js";

export const kExamples = [
  { id: "right", normal: "-(1 + e) * m * vn", definitions: "" },
  { id: "course", normal: "-2 * m * vn", definitions: "" },
  { id: "times-e", normal: "-e * 2 * m * vn", definitions: "" },
  { id: "own-mass", normal: "-(1 + e) * m1 * vn", definitions: "" },
  { id: "sum", normal: "-(1 + e) * (m1 + m2) * vn", definitions: "" },
  { id: "speeds", normal: "m2 * (abs(vn1) + abs(vn2))", definitions: "" },
  { id: "squares", normal: "", definitions: `normal_1 = m1 * (x - vn1)
normal_2 = m2 * (x + w - vn2)
w = -e * vn
k = m1 * vn1^2 + m2 * vn2^2
q = (m1 + m2) * k - m1 * m2 * w^2
root = sign(m1 * vn1 + m2 * vn2) * sqrt(max(q, 0))
x = (-m2 * w + root) / (m1 + m2)` },
];

const kRows = 3;
const kLawKeys = ["normal", "normal_1", "normal_2", "tangential", "tangential_1", "tangential_2"];

/** A line as it was typed or as it stands in a law file: a name and an expression, with quotation marks or without. */
function definitionOf(line, place) {
  const found = /^\s*([A-Za-z_]\w*)\s*=\s*(?:"([^"]+)"|([^"]*[^"\s]))\s*$/.exec(line);
  if (found) return [found[1], found[2] ?? found[3]];
  const error = new Error(language.words.lab.badDefinition(place, line.trim()));
  error.lang = language.id;
  throw error;
}

/** The law file of what was typed: strings of JSON are strings of TOML. Empty lines and comments (#) say nothing. */
export function lawToml({ normal, definitions }) {
  const lines = definitions.split("\n").map((line, k) => (/^\s*(#|$)/.test(line) ? null : definitionOf(line, k + 1))).filter(Boolean);
  const toml = ([name, text]) => `${name} = ${JSON.stringify(text)}`;
  const pushes = [...(normal.trim() ? [["normal", normal]] : []), ...lines.filter(([name]) => kLawKeys.includes(name))];
  const own = lines.filter(([name]) => !kLawKeys.includes(name));
  return `${[`name = "lab"`, ...pushes.map(toml), ...(own.length > 0 ? ["[let]", ...own.map(toml)] : [])].join("\n")}\n`;
}

export class LawBox {
  /** @param tried  (law: {normal, definitions} or nothing) → a promise of the report */
  constructor(tried) {
    this.tried = tried;
    this.normal = make("input", { type: "text", className: "lab-normal", value: kExamples[0].normal, spellcheck: false, autocapitalize: "off" });
    this.definitions = make("textarea", { className: "lab-let", rows: kRows, spellcheck: false });
    this.example = make("select", { className: "lab-example" });
    this.example.addEventListener("change", () => {
      const found = kExamples.find(({ id }) => id === this.example.value);
      if (found) this.fill(found);
    });
    this.try = button("lab-try", () => this.run());
    this.remove = button("lab-untry", () => {
      this.report = null;
      this.result.replaceChildren();
      this.tried(null);
    });
    this.normal.addEventListener("keydown", (event) => { if (event.key === "Enter") this.run(); });
    this.error = make("p", { className: "lab-error", role: "alert", lang: "en" });
    this.result = make("div", { className: "lab-rules" });
    this.summary = make("summary");
    this.texts = { example: make("span"), normal: make("span"), let: make("span"), names: make("p", { className: "cv-note" }) };
    this.element = make("details", { className: "lab-box lab-law" }, this.summary,
      make("label", { className: "cv-field" }, this.texts.example, this.example),
      make("label", { className: "cv-field" }, this.texts.normal, this.normal),
      make("label", { className: "cv-field" }, this.texts.let, this.definitions),
      this.texts.names, make("div", { className: "cv-buttons" }, this.try, this.remove), this.error, this.result);
  }

  get law() { return { normal: this.normal.value, definitions: this.definitions.value }; }

  fill({ normal, definitions = "" }) {
    this.normal.value = normal;
    this.definitions.value = definitions;
    this.definitions.rows = Math.max(definitions.split("\n").length, kRows);
  }

  set(law) {
    this.fill(law);
    this.element.open = true;
  }

  say() {
    const { lab } = language.words;
    this.summary.textContent = lab.lawTitle;
    this.texts.example.textContent = lab.example;
    this.texts.normal.textContent = lab.normal;
    this.texts.let.textContent = lab.definitions;
    this.texts.names.textContent = lab.names;
    this.try.textContent = lab.tryLaw;
    this.remove.textContent = lab.untryLaw;
    const chosen = this.example.value;
    this.example.replaceChildren(make("option", { value: "" }, "–"),
      ...kExamples.map(({ id }) => make("option", { value: id }, lab.examples[id])));
    this.example.value = chosen;
    if (this.report) this.show(this.report);
  }

  async run() {
    this.error.textContent = "";
    this.try.disabled = true;
    try {
      this.report = await this.tried(this.law);
      this.show(this.report);
    } catch (error) {
      this.report = null;
      this.result.replaceChildren();
      this.error.lang = error.lang ?? "en";
      this.error.textContent = error.message;
    } finally {
      this.try.disabled = false;
    }
  }

  show(report) {
    const { lab } = language.words;
    const share = (x) => (x > 0 ? `${language.number(100 * x, 3)} %` : "–");
    const rows = report.rules.map((rule) => make("tr", { className: rule.holds ? "lab-holds" : "lab-broken" },
      make("th", { scope: "row" }, lab.rules[rule.rule] ?? rule.meaning),
      make("td", {}, rule.holds ? `✓ ${lab.kept}` : `✗ ${lab.broken}`), make("td", {}, share(rule.broken_share)),
      make("td", { "data-value": String(rule.worst) }, rule.worst === null ? "∞" : language.number(rule.worst, 3)),
      make("td", {}, language.number(rule.right_worst ?? Infinity, 3))));
    const heads = [lab.rule, "", lab.brokenShare, lab.worst, lab.rightWorst];
    const note = make("p", { className: "cv-note" }, lab.pairs(report.pairs) + (report.not_finite > 0 ? ` ${lab.notFinite(report.not_finite)}` : ""));
    this.result.replaceChildren(make("div", { className: "cv-scroll-x", tabIndex: 0, role: "region", "aria-label": lab.lawTitle }, make("table", {},
      make("thead", {}, make("tr", {}, ...heads.map((text) => make("th", { scope: "col" }, text)))), make("tbody", {}, ...rows))), note);
  }
}
