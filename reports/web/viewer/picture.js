// What is drawn at one moment, as plain lists that both painters (paint_gl.js, paint_2d.js) draw: balls, strokes that
// are as wide in pixels at their two ends as they say (an arrow's head is a stroke that narrows to a point), and sheets.

export class Picture {
  constructor() {
    this.balls = [];
    this.strokes = [];
    this.sheets = [];
  }

  /** @param look  turned: quaternion where a texture shows it; alpha; ring: whether it is marked */
  ball(centre, radius, colour, { turned = null, alpha = 1, ring = false } = {}) {
    this.balls.push({ centre, radius, colour, turned, alpha, ring });
  }

  stroke(from, to, colour, { width = 1.5, end = width, alpha = 1, front = false } = {}) {
    this.strokes.push({ from, to, colour, width, end, alpha, front });
  }

  arrow(from, by, colour, unit) {
    const length = Math.hypot(...by);
    if (!(length > 0.02 * unit)) return;
    const head = Math.min(0.4 * length, 0.35 * unit) / length;
    const neck = from.map((x, c) => x + (1 - head) * by[c]);
    const tip = from.map((x, c) => x + by[c]);
    this.stroke(from, neck, colour, { width: 3 });
    this.stroke(neck, tip, colour, { width: 11, end: 0.5 });
  }

  /** A flat four-cornered sheet. */
  sheet(corners, colour, alpha) {
    this.sheets.push({ corners, colour, alpha });
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
