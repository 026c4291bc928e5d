// The page is whole without this. It adds a switch of the theme, a filter of the scenes, and values under the
// pointer (or the arrow keys) in the plots.
"use strict";

const theme = {
  get() { try { return localStorage.getItem("carom-theme"); } catch { return null; } },
  set(name) {
    document.documentElement.dataset.theme = name;
    try { localStorage.setItem("carom-theme", name); } catch { /* a page from a file may have no storage */ }
  },
};
if (theme.get()) theme.set(theme.get());

function make(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

function addThemeSwitch() {
  const isDark = () => {
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  };
  const button = make("button", { type: "button" });
  const name = () => { button.textContent = isDark() ? "Light theme" : "Dark theme"; };
  button.addEventListener("click", () => { theme.set(isDark() ? "light" : "dark"); name(); });
  name();
  document.querySelector("nav").append(button);
}

function addFilter() {
  const words = make("input", { type: "search", placeholder: "title or group" });
  const verdict = make("select");
  for (const name of ["any", "pass", "fail", "shown", "unsupported", "error"]) verdict.append(make("option", {}, name));
  const count = make("span");
  count.setAttribute("role", "status");
  const bodies = [...document.querySelectorAll(".matrix tbody:has(.group)")];
  const apply = () => {
    let shown = 0;
    let all = 0;
    for (const body of bodies) {
      const group = body.querySelector(".group").textContent.trim();
      let any = false;
      for (const row of body.querySelectorAll("[data-scene]")) {
        const text = `${group} ${row.querySelector("th").textContent}`.toLowerCase();
        const fits = text.includes(words.value.trim().toLowerCase()) &&
          (verdict.value === "any" || row.querySelector(`.cell.${verdict.value}`));
        row.hidden = !fits;
        document.getElementById(row.dataset.scene).hidden = !fits;
        all += 1;
        if (fits) { shown += 1; any = true; }
      }
      body.hidden = !any;
    }
    count.textContent = shown === all ? "" : `${shown} of ${all} scenes`;
  };
  words.addEventListener("input", apply);
  verdict.addEventListener("change", apply);
  document.getElementById("filter").append(
    make("label", {}, "Find", words), make("label", {}, "Verdict", verdict), count);
}

// The inverse of what Axis (src/report/page/axis.h) does.
function valueAt(svg, fraction) {
  const [low, high] = svg.dataset.y.split(" ").map(Number);
  const measure = low + fraction * (high - low);
  const threshold = Number(svg.dataset.threshold);
  if (svg.dataset.scale === "linear") return measure;
  if (svg.dataset.scale === "log") return measure <= low ? 0 : 10 ** measure;
  return Math.sign(measure) * threshold * (10 ** Math.abs(measure) - 1);
}

// The points of a path made of M and L alone, as [[x, y], …].
function pointsOf(path) {
  return [...path.getAttribute("d").matchAll(/[ML](-?[\d.]+) (-?[\d.]+)/g)].map((m) => [Number(m[1]), Number(m[2])]);
}

function heightAt(points, x) {
  const next = points.findIndex((p) => p[0] >= x);
  if (next < 0) return null;
  const [x1, y1] = points[next];
  if (next === 0) return x1 - x < 1 ? y1 : null;
  const [x0, y0] = points[next - 1];
  return x1 === x0 ? y1 : y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

function format(value) {
  if (value === 0) return "0";
  const digits = Math.abs(value) >= 1e-3 && Math.abs(value) < 1e4 ? value.toPrecision(3) : value.toExponential(1);
  return digits.replace("e+", "e").replace(/^-/, "−");
}

function addReadout(figure) {
  const svg = figure.querySelector("svg.drawing");
  const area = svg.querySelector("svg.area");
  const width = Number(area.getAttribute("width"));
  const height = Number(area.getAttribute("height"));
  const [start, end] = svg.dataset.x.split(" ").map(Number);
  const lines = [...area.querySelectorAll("path[data-label]")].map((path) => ({
    label: path.dataset.label, colour: path.getAttribute("class").replace("line ", ""), points: pointsOf(path) }));
  const cursor = document.createElementNS(area.namespaceURI, "path");
  cursor.setAttribute("class", "cursor");
  const readout = make("div", { className: "readout" });
  figure.append(readout);
  let x = 0;

  const show = (place) => {
    x = Math.min(Math.max(place, 0), width);
    cursor.setAttribute("d", `M${x} 0v${height}`);
    area.append(cursor);
    readout.replaceChildren(make("span", {}, `t = ${format(start + (end - start) * x / width)} s`));
    for (const line of lines) {
      const y = heightAt(line.points, x);
      if (y === null) continue;
      const item = make("span", { className: line.colour }, `${line.label} ≈ ${format(valueAt(svg, 1 - y / height))}`);
      item.style.color = "var(--own)";
      readout.append(item);
    }
  };
  const hide = () => { cursor.remove(); readout.replaceChildren(); };

  svg.addEventListener("pointermove", (event) => {
    const box = svg.getBoundingClientRect();
    const scale = svg.viewBox.baseVal.width / box.width;
    show((event.clientX - box.left) * scale - Number(area.getAttribute("x")));
  });
  svg.addEventListener("pointerleave", hide);
  svg.addEventListener("blur", hide);
  svg.tabIndex = 0;
  readout.setAttribute("aria-live", "polite");
  svg.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!way) return;
    event.preventDefault();
    show(x + way * width / 50);
  });
}

addEventListener("DOMContentLoaded", () => {
  addThemeSwitch();
  addFilter();
  document.querySelectorAll(".plot:has(svg.drawing[data-x])").forEach(addReadout);
});

// On paper nothing can be opened, so everything is.
let opened = [];
addEventListener("beforeprint", () => {
  opened = [...document.querySelectorAll("details:not([open])")];
  opened.forEach((each) => { each.open = true; });
});
addEventListener("afterprint", () => opened.forEach((each) => { each.open = false; }));
