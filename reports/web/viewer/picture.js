// What is drawn at one moment, as plain lists that both painters (paint_gl.js, paint_2d.js) draw: balls, strokes that
// are as wide in pixels at their two ends as they say (an arrow's head is a stroke that narrows to a point), and sheets.
// Balls and strokes are numbers one after the other, as WebGL takes them; a picture is written over from frame to frame,
// so that thousands of balls leave nothing for the collector of garbage.

/** Rows of so many numbers each. */
class Rows {
  constructor(stride) {
    this.stride = stride;
    this.numbers = new Float32Array(64 * stride);
    this.count = 0;
  }

  /** A further row. @returns where in `numbers` it begins */
  add() {
    const at = this.count * this.stride;
    if (at + this.stride > this.numbers.length) {
      const more = new Float32Array(2 * this.numbers.length);
      more.set(this.numbers);
      this.numbers = more;
    }
    this.count += 1;
    return at;
  }
}

// Where in its row a number stands.
export const kBall = { centre: 0, radius: 3, turned: 4, colour: 8, alpha: 11, textured: 12, ring: 13, stride: 14 };
export const kStroke = { from: 0, to: 3, width: 6, end: 7, halo: 8, colour: 9, alpha: 12, stride: 13 };

const kHead_px = 11;
const kShaft_px = 3;
const kHalo_px = 1.5;
const kThinnest = 0.5; // of the shaft and head of an arrow: how thin a short one gets

export class Picture {
  constructor() {
    this.balls = new Rows(kBall.stride);
    this.ghosts = new Rows(kBall.stride);    // balls that others are seen through
    this.strokes = new Rows(kStroke.stride);
    this.arrows = new Rows(kStroke.stride);  // seen through balls, too
    this.fronts = new Rows(kStroke.stride);  // nothing stands before them
    this.sheets = [];
    this.origin = [0, 0, 0];
  }

  /** Begins anew. @param origin  what places are told from: far from zero a short number would not hold them */
  begin(origin) {
    for (const rows of [this.balls, this.ghosts, this.strokes, this.arrows, this.fronts]) rows.count = 0;
    this.sheets.length = 0;
    this.origin = origin;
  }

  /** @param turns  quaternions of all balls where a texture shows them, or nothing; ball  its number among them */
  ball(x, y, z, radius, colour, { turns = null, ball = 0, alpha = 1, ring = false }) {
    const rows = alpha < 1 ? this.ghosts : this.balls;
    const at = rows.add();
    const { numbers } = rows;
    numbers[at] = x - this.origin[0];
    numbers[at + 1] = y - this.origin[1];
    numbers[at + 2] = z - this.origin[2];
    numbers[at + kBall.radius] = radius;
    for (let c = 0; c < 4; c += 1) numbers[at + kBall.turned + c] = turns ? turns[4 * ball + c] : c === 3 ? 1 : 0;
    for (let c = 0; c < 3; c += 1) numbers[at + kBall.colour + c] = colour[c];
    numbers[at + kBall.alpha] = alpha;
    numbers[at + kBall.textured] = turns ? 1 : 0;
    numbers[at + kBall.ring] = ring ? 1 : 0;
  }

  line(rows, ax, ay, az, bx, by, bz, colour, width, end, halo, alpha) {
    const at = rows.add();
    const { numbers } = rows;
    const [ox, oy, oz] = this.origin;
    numbers[at] = ax - ox;
    numbers[at + 1] = ay - oy;
    numbers[at + 2] = az - oz;
    numbers[at + kStroke.to] = bx - ox;
    numbers[at + kStroke.to + 1] = by - oy;
    numbers[at + kStroke.to + 2] = bz - oz;
    numbers[at + kStroke.width] = width;
    numbers[at + kStroke.end] = end;
    numbers[at + kStroke.halo] = halo;
    for (let c = 0; c < 3; c += 1) numbers[at + kStroke.colour + c] = colour[c];
    numbers[at + kStroke.alpha] = alpha;
  }

  stroke(from, to, colour, { width = 1.5, end = width, alpha = 1, front = false } = {}) {
    this.line(front ? this.fronts : this.strokes, ...from, ...to, colour, width, end, 0, alpha);
  }

  /**
   * An arrow with an edge in the colour of the paper, which sets it off from what it crosses.
   * @param unit   the length from which on its head is as long as heads are
   * @param thick  how many times as thick as others
   */
  arrow(x, y, z, dx, dy, dz, colour, unit, thick = 1) {
    const length = Math.hypot(dx, dy, dz);
    if (!(length > 0.02 * unit)) return;
    const head = Math.min(0.4 * length, 0.35 * unit);
    const thin = thick * Math.max(head / (0.35 * unit), kThinnest);
    const s = 1 - head / length;
    const [nx, ny, nz] = [x + s * dx, y + s * dy, z + s * dz];
    this.line(this.arrows, x, y, z, nx, ny, nz, colour, kShaft_px * thin, kShaft_px * thin, kHalo_px, 1);
    this.line(this.arrows, nx, ny, nz, x + dx, y + dy, z + dz, colour, kHead_px * thin, 0.5, kHalo_px, 1);
  }

  /** A flat four-cornered sheet. */
  sheet(corners, colour, alpha) {
    this.sheets.push({ corners: corners.map((corner) => corner.map((x, c) => x - this.origin[c])), colour, alpha });
  }

  cube(centre, half, colour, dimension, alpha) {
    const corner = (bits) => centre.map((x, c) => (c < dimension ? x + (bits >> c & 1 ? half[c] : -half[c]) : x));
    for (let bits = 0; bits < 1 << dimension; bits += 1) {
      for (let c = 0; c < dimension; c += 1) {
        if (!(bits >> c & 1)) this.stroke(corner(bits), corner(bits | 1 << c), colour, { alpha });
      }
    }
  }
}

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** A piece of the plane normal·x = offset around a point, as wide as `reach` to every side. */
export function patch(normal, offset, around, reach, flat) {
  const away = offset - normal.reduce((sum, n, c) => sum + n * around[c], 0);
  const foot = around.map((x, c) => x + away * normal[c]);
  let u = flat ? [-normal[1], normal[0], 0] : cross(normal, Math.abs(normal[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0]);
  const length = Math.hypot(...u);
  u = u.map((x) => x / length);
  const v = flat ? [0, 0, 0] : cross(normal, u);
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => foot.map((x, c) => x + reach * (a * u[c] + b * v[c])));
}

/** Box, walls, slabs and barriers. */
export function drawRoom(picture, scene, view, theme) {
  const flat = scene.dimension === 2;
  const around = view.low.map((x, c) => 0.5 * (x + view.high[c]));
  const reach = Math.max(...view.high.map((x, c) => x - view.low[c]));
  if (scene.box) {
    const { min, max } = scene.box;
    picture.cube(min.map((x, c) => 0.5 * (x + max[c])), max.map((x, c) => 0.5 * (x - min[c])), theme.wall, scene.dimension, 0.9);
  }
  const outline = (corners, colour, alpha) => {
    if (flat) picture.stroke(corners[0], corners[1], colour, { width: 2, alpha });
    else corners.forEach((corner, k) => picture.stroke(corner, corners[(k + 1) % 4], colour, { alpha }));
  };
  for (const wall of scene.walls.slice(scene.box ? 2 * scene.dimension : 0)) {
    const corners = patch(wall.normal, wall.offset, around, (flat ? 2 : 0.5) * reach, flat);
    outline(corners, theme.wall, 0.9);
    if (!flat) picture.sheet(corners, theme.wall, 0.12);
  }
  for (const [sheets, colour] of [[scene.slabs, theme.slab], [scene.barriers, theme.barrier]]) {
    for (const { normal, offset, thickness } of sheets) {
      const size = (flat ? 2 : 0.5) * reach;
      const faces = [-0.5, 0.5].map((side) => patch(normal, offset + side * thickness, around, size, flat));
      faces.forEach((corners) => outline(corners, colour, 0.9));
      if (flat) picture.sheet([faces[0][0], faces[0][1], faces[1][1], faces[1][0]], colour, 0.3);
      else faces.forEach((corners) => picture.sheet(corners, colour, 0.2));
    }
  }
}

/** The smallest box around everything that a run shows; where balls fly far, around most of it. */
export function extent(scene, motions, radii) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  if (scene.box) {
    scene.box.min.forEach((x, c) => { low[c] = x; high[c] = scene.box.max[c]; });
  } else {
    for (const motion of motions) {
      const stride = Math.max(1, Math.floor(motion.frames / 60));
      for (let k = 0; k < motion.frames; k += k + stride < motion.frames ? stride : Math.max(1, motion.frames - 1 - k)) {
        for (let i = 0; i < motion.balls; i += 1) {
          for (let c = 0; c < 3; c += 1) {
            const x = motion.positions[3 * (k * motion.balls + i) + c];
            low[c] = Math.min(low[c], x - radii[i]);
            high[c] = Math.max(high[c], x + radii[i]);
          }
        }
      }
    }
  }
  // What a ball may come out of is seen from both sides.
  const wide = Math.max(...high.map((x, c) => x - low[c]));
  for (const { normal, offset, thickness } of [...scene.slabs, ...scene.barriers]) {
    const axis = normal.findIndex((n) => Math.abs(n) === 1);
    if (axis < 0) continue;
    low[axis] = Math.min(low[axis], offset * normal[axis] - thickness - 0.15 * wide);
    high[axis] = Math.max(high[axis], offset * normal[axis] + thickness + 0.15 * wide);
  }
  if (scene.dimension === 2) low[2] = high[2] = 0;
  // A ball that only moves along a line is seen with room beside its path.
  const size = Math.max(...high.map((x, c) => x - low[c]));
  for (let c = 0; c < scene.dimension; c += 1) {
    const short = 0.25 * size - (high[c] - low[c]);
    if (short > 0) { low[c] -= 0.5 * short; high[c] += 0.5 * short; }
  }
  return { low, high };
}
