// The canvas: its size, its painter, its camera, and what a pointer does on it.

import { Camera, pick } from "./camera.js";
import { css } from "./colours.js";
import { make } from "./dom.js";
import { Paint2d } from "./paint_2d.js";
import { PaintGl } from "./paint_gl.js";

const kMostPixels = 2;      // of the canvas by one of the page
const kClick_px = 5;        // a pointer that moved less was a click
const kTap_px = 12;         // a finger is not as steady
const kLongPress_ms = 450;  // a finger that rests so long on a ball is a click of the right button
const kRight = 2;
const kName_px = 14;        // the height of a name in a saved picture

export class Stage {
  /** @param asked  changed(): draw anew; clicked({ball, button, shift}); */
  constructor({ dimension, box, changed, clicked, plain }) {
    this.camera = new Camera(dimension, box);
    this.changed = changed;
    this.clicked = clicked;
    this.plain = plain;
    this.message = make("p", { className: "cv-message", role: "status", hidden: true });
    this.names = make("div", { className: "cv-names" });
    this.element = make("div", { className: "cv-stage" }, this.names);
    this.panes = [];
    this.quality = 1; // pixels along an edge, by those of the screen
    this.take(plain ? null : PaintGl);
    this.watch = new ResizeObserver(() => changed());
    this.watch.observe(this.element);
  }

  take(Painter) {
    this.canvas?.remove();
    this.canvas = make("canvas", { className: "cv-canvas", role: "application", tabIndex: 0 });
    this.element.prepend(this.canvas);
    this.painter = Painter?.on(this.canvas) ?? null;
    if (!this.painter) {
      const canvas = make("canvas", { className: "cv-canvas", role: "application", tabIndex: 0 });
      this.canvas.replaceWith(canvas);
      this.canvas = canvas;
      this.painter = Paint2d.on(canvas);
    }
    this.element.dataset.painter = this.painter.constructor.name;
    this.message.hidden = this.painter instanceof PaintGl || this.plain === "quietly";
    this.canvas.addEventListener("webglcontextlost", () => { if (!this.closed) { this.take(null); this.changed(); } });
    this.listen();
  }

  listen() {
    const { canvas } = this;
    let last = null;
    let moved = 0;
    let most = kClick_px;
    let holding = null;
    const touches = new Map();
    const held = ({ clientX, clientY, shiftKey }) => {
      if (touches.size !== 1 || moved > most) return;
      moved = Infinity; // lifting the finger is no click any more
      const found = this.ballAt(clientX, clientY);
      if (found) this.clicked({ ...found, button: kRight, shift: shiftKey });
    };
    canvas.addEventListener("contextmenu", (event) => { if (this.takesClicks) event.preventDefault(); });
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      touches.set(event.pointerId, [event.clientX, event.clientY]);
      last = [event.clientX, event.clientY];
      moved = touches.size > 1 ? Infinity : 0;
      most = event.pointerType === "touch" ? kTap_px : kClick_px;
      clearTimeout(holding);
      if (event.pointerType === "touch" && this.takesClicks) holding = setTimeout(() => held(event), kLongPress_ms);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!touches.has(event.pointerId)) return;
      const before = spread(touches);
      touches.set(event.pointerId, [event.clientX, event.clientY]);
      if (touches.size === 2) {
        this.camera.zoomBy(spread(touches) / (before || 1));
        moved = Infinity;
      } else {
        const [dx, dy] = [event.clientX - last[0], event.clientY - last[1]];
        moved += Math.hypot(dx, dy);
        if (moved > most) this.drag(dx, dy, event.shiftKey || event.buttons === 4);
      }
      last = [event.clientX, event.clientY];
      this.changed();
    });
    const up = (event) => {
      clearTimeout(holding);
      if (!touches.delete(event.pointerId) || event.type !== "pointerup" || moved > most) return;
      const found = this.ballAt(event.clientX, event.clientY);
      if (found) this.clicked({ ...found, button: event.button, shift: event.shiftKey });
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.camera.zoomBy(Math.exp(-0.0015 * event.deltaY));
      this.changed();
    }, { passive: false });
  }

  drag(dx, dy, shift) {
    const height = this.canvas.clientHeight;
    if (this.camera.flat || shift) this.camera.pan(2 * dx / height, 2 * dy / height);
    else this.camera.orbit(0.008 * dx, 0.008 * dy);
  }

  /** The ball at a point of the page, or nothing. */
  ballAt(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const scale = this.canvas.width / box.width;
    const [px, py] = [(x - box.left) * scale, (y - box.top) * scale];
    for (const { part, state, radii, offset, run } of this.panes) {
      const at = [2 * (px - part.left) / part.width - 1, 1 - 2 * (py - part.top) / part.height];
      if (Math.abs(at[0]) > 1 || Math.abs(at[1]) > 1) continue;
      const ball = pick(this.camera, part.width / part.height, offset, at, state, radii);
      if (ball >= 0) return { ball, run };
    }
    return null;
  }

  /** Makes the canvas as large as it is seen. @returns its scale */
  fit() {
    const scale = Math.min(devicePixelRatio || 1, kMostPixels) * this.quality;
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((x) => Math.max(Math.round(x * scale), 1));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    return scale;
  }

  /** The parts of the canvas for so many pictures: beside each other, or below each other where it is high. */
  parts(count) {
    const { width, height } = this.canvas;
    if (count === 1) return [{ left: 0, top: 0, width, height }];
    const [half, low] = [width >> 1, height >> 1];
    return width >= height
      ? [{ left: 0, top: 0, width: half - 1, height }, { left: half + 1, top: 0, width: width - half - 1, height }]
      : [{ left: 0, top: 0, width, height: low - 1 }, { left: 0, top: low + 1, width, height: height - low - 1 }];
  }

  /** @param pictures  picture, state, radii, offset and run of each part */
  paint(pictures, theme) {
    const scale = this.fit();
    this.painter.begin(theme);
    const parts = this.parts(pictures.length);
    this.panes = pictures.map((pane, k) => ({ ...pane, part: parts[k] }));
    this.nameParts(scale);
    for (const { picture, part, offset } of this.panes) this.painter.paint(picture, this.camera, part, theme, offset, scale);
  }

  nameParts(scale) {
    const names = this.panes.map(({ name }) => name);
    const shape = JSON.stringify([names, this.panes.map(({ part }) => part), scale]);
    if (shape === this.named) return;
    this.named = shape;
    this.names.replaceChildren(...this.panes.map(({ name, part }) => {
      const label = make("span", { className: "cv-name" }, name);
      label.style.left = `${part.left / scale}px`;
      label.style.top = `${part.top / scale}px`;
      return label;
    }));
  }

  /** What was just painted, with the names of its parts in it, as a canvas of its own. */
  withNames(theme) {
    const { width, height } = this.canvas;
    const whole = make("canvas", { width, height });
    const context = whole.getContext("2d");
    context.drawImage(this.canvas, 0, 0);
    const size = kName_px * width / Math.max(this.canvas.clientWidth, 1);
    context.font = `${size}px system-ui, sans-serif`;
    context.textBaseline = "top";
    for (const { name, part } of this.panes) {
      context.fillStyle = css(theme.paper, 0.8);
      context.fillRect(part.left + 0.4 * size, part.top + 0.4 * size, context.measureText(name).width + size, 1.5 * size);
      context.fillStyle = css(theme.ink);
      context.fillText(name, part.left + 0.9 * size, part.top + 0.65 * size);
    }
    return whole;
  }

  close() {
    this.closed = true;
    this.watch.disconnect();
    this.painter.close();
  }
}

function spread(touches) {
  const points = [...touches.values()];
  return points.length < 2 ? 0 : Math.hypot(points[0][0] - points[1][0], points[0][1] - points[1][1]);
}
