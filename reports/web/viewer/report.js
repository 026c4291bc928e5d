// In the report each scene's playback lies in a script element beside a button; nothing of it is read before the
// button is pressed. One player is open at a time: browsers have few WebGL contexts.

import { button, make } from "./dom.js";
import { Viewer } from "./viewer.js";
import { language } from "./words/words.js";

let open = null;

function shut() {
  open?.viewer?.close();
  open?.host.remove();
  open?.button.setAttribute("aria-expanded", "false");
  open = null;
}

async function toggle(data, opener) {
  const again = open?.button === opener;
  shut();
  say();
  if (again) return;
  const host = make("div");
  opener.after(host);
  opener.setAttribute("aria-expanded", "true");
  open = { button: opener, host };
  say();
  const mine = open;
  const viewer = await Viewer.mount(host, JSON.parse(data.textContent));
  if (open !== mine) { viewer.close(); return; }
  mine.viewer = viewer;
  host.caromViewer = viewer;
  viewer.stage?.canvas.focus({ preventScroll: true });
}

function say() {
  const { words } = language;
  for (const opener of document.querySelectorAll(".play-scene")) {
    opener.textContent = opener.getAttribute("aria-expanded") === "true" ? `✕ ${words.shut}` : `▶ ${words.open}`;
    opener.lang = language.id;
  }
}

addEventListener("DOMContentLoaded", () => {
  for (const data of document.querySelectorAll("script.playback")) {
    const opener = button("play-scene", () => toggle(data, opener));
    opener.setAttribute("aria-expanded", "false");
    data.after(opener);
  }
  language.listeners.add(say);
  say();
});
