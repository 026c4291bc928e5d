// The same picture where there is no WebGL: balls from the farthest to the nearest as discs, a turned ball with the
// three great circles of its axes.

import { transform } from "./camera.js";
import { css } from "./colours.js";
import { kBall, kStroke } from "./picture.js";

function rotate([x, y, z, w], v) {
  const c = [y * v[2] - z * v[1] + w * v[0], z * v[0] - x * v[2] + w * v[1], x * v[1] - y * v[0] + w * v[2]];
  return [v[0] + 2 * (y * c[2] - z * c[1]), v[1] + 2 * (z * c[0] - x * c[2]), v[2] + 2 * (x * c[1] - y * c[0])];
}

const eachOf = ({ numbers, count, stride }, read) => Array.from({ length: count }, (_, k) => read(numbers.subarray(k * stride, (k + 1) * stride)));

const ballOf = (row) => ({ centre: row.subarray(0, 3), radius: row[kBall.radius], colour: [...row.subarray(kBall.colour, kBall.colour + 3)],
  alpha: row[kBall.alpha], turned: row[kBall.textured] ? row.subarray(kBall.turned, kBall.turned + 4) : null, ring: row[kBall.ring] });

const strokeOf = (row) => ({ from: row.subarray(0, 3), to: row.subarray(kStroke.to, kStroke.to + 3), width: row[kStroke.width],
  end: row[kStroke.end], halo: row[kStroke.halo], colour: [...row.subarray(kStroke.colour, kStroke.colour + 3)], alpha: row[kStroke.alpha] });

export class Paint2d {
  static name = "canvas";

  static on(canvas) {
    const context = canvas.getContext("2d");
    return context ? new Paint2d(canvas, context) : null;
  }

  constructor(canvas, context) {
    this.canvas = canvas;
    this.context = context;
  }

  begin(theme) {
    this.context.fillStyle = css(theme.paper);
    this.context.fillRect(0, 0, this.canvas.width, this.canvas.height);
  }

  paint(picture, camera, part, theme, offset, scale) {
    const { context } = this;
    const { view, projection, half, distance } = camera.matrices(part.width / part.height, offset, picture.origin);
    const place = (p) => {
      const seen = transform(view, p);
      const clip = transform(projection, seen);
      return { x: part.left + 0.5 * part.width * (1 + clip[0] / clip[3]),
        y: part.top + 0.5 * part.height * (1 - clip[1] / clip[3]), depth: seen[2], front: clip[3] > 0 };
    };
    const perMetre = (depth) => 0.5 * part.height / half * (camera.flat ? 1 : distance / Math.max(-depth, 1e-9));
    context.save();
    context.beginPath();
    context.rect(part.left, part.top, part.width, part.height);
    context.clip();
    for (const { corners, colour, alpha } of picture.sheets) this.fill(corners.map(place), css(colour, alpha));
    const balls = [picture.balls, picture.ghosts].flatMap((rows) => eachOf(rows, ballOf))
      .map((ball) => ({ ball, at: place(ball.centre) })).filter(({ at }) => at.front);
    balls.sort((a, b) => a.at.depth - b.at.depth);
    for (const { ball, at } of balls) this.disc(ball, at, ball.radius * perMetre(at.depth), place, theme, scale);
    for (const stroke of [picture.strokes, picture.arrows, picture.fronts].flatMap((rows) => eachOf(rows, strokeOf))) {
      const [a, b] = [place(stroke.from), place(stroke.to)];
      if (stroke.halo > 0) this.line(a, b, stroke, stroke.width + 2 * stroke.halo, stroke.end + 2 * stroke.halo, theme.paper, scale);
      this.line(a, b, stroke, stroke.width, stroke.end, stroke.colour, scale);
    }
    context.restore();
  }

  fill(points, style) {
    const { context } = this;
    context.beginPath();
    points.forEach((p) => context.lineTo(p.x, p.y));
    context.fillStyle = style;
    context.fill();
  }

  line(a, b, { alpha }, width, end, colour, scale) {
    if (!a.front || !b.front) return;
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    const [nx, ny] = [-0.5 * scale * (b.y - a.y) / length, 0.5 * scale * (b.x - a.x) / length];
    this.fill([{ x: a.x + nx * width, y: a.y + ny * width }, { x: b.x + nx * end, y: b.y + ny * end },
      { x: b.x - nx * end, y: b.y - ny * end }, { x: a.x - nx * width, y: a.y - ny * width }], css(colour, alpha));
  }

  disc(ball, at, radius, place, theme, scale) {
    const { context } = this;
    context.globalAlpha = ball.alpha;
    context.beginPath();
    context.arc(at.x, at.y, Math.max(radius, 0.7), 0, 2 * Math.PI);
    context.fillStyle = css(ball.colour);
    context.fill();
    context.lineWidth = ball.ring ? Math.max(2.5 * scale, 0.16 * radius) : scale;
    context.strokeStyle = css(theme.ink, ball.ring ? 1 : 0.6);
    context.stroke();
    if (ball.turned && radius > 4) this.circles(ball, place, theme, scale);
    context.globalAlpha = 1;
  }

  circles(ball, place, theme, scale) {
    const { context } = this;
    const front = place(ball.centre).depth;
    context.lineWidth = 1.5 * scale;
    context.strokeStyle = css(theme.paper);
    context.beginPath();
    for (const [u, v] of [[[1, 0, 0], [0, 1, 0]], [[0, 1, 0], [0, 0, 1]], [[0, 0, 1], [1, 0, 0]]]) {
      let drawing = false;
      for (let k = 0; k <= 32; k += 1) {
        const [c, s] = [Math.cos(k / 16 * Math.PI), Math.sin(k / 16 * Math.PI)];
        const out = rotate(ball.turned, u.map((x, axis) => c * x + s * v[axis]));
        const p = place(out.map((x, axis) => ball.centre[axis] + ball.radius * x));
        const seen = p.depth >= front;
        if (seen && drawing) context.lineTo(p.x, p.y); else if (seen) context.moveTo(p.x, p.y);
        drawing = seen;
      }
    }
    context.stroke();
  }

  finish() {}
  close() {}
}
