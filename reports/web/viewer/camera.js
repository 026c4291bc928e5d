// Matrices are column by column, as WebGL takes them.

/** Looks at a point: from the front in the plane, from anywhere around it in space. */
export class Camera {
  constructor(dimension, box) {
    this.flat = dimension === 2;
    this.box = box;
    this.reset();
  }

  reset() {
    this.target = this.box.low.map((x, c) => 0.5 * (x + this.box.high[c]));
    this.yaw = this.flat ? 0 : 0.55;
    this.pitch = this.flat ? 0 : 0.35;
    this.zoom = 1;
    this.moved = false;
  }

  /** What somebody has chosen to see; nothing where it is as at first. */
  get state() {
    const { flat, target, yaw, pitch, zoom } = this;
    return this.moved ? { flat, target, yaw, pitch, zoom } : null;
  }

  /** Looks as another camera did. From the plane to space there is no such thing. */
  take(state) {
    if (state?.flat === this.flat) Object.assign(this, state, { moved: true });
  }

  /** Half of what is seen in height at the target, m. */
  halfHeight(aspect) {
    const [w, h, d] = this.box.high.map((x, c) => x - this.box.low[c]);
    const half = this.flat ? 0.5 * Math.max(h, w / aspect) : 0.5 * Math.hypot(w, h, d) * Math.max(1, 0.9 / aspect);
    return 1.06 * Math.max(half, 1e-300) / this.zoom;
  }

  /** Right, up and towards the viewer. */
  axes() {
    const [cy, sy, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    return { right: [cy, 0, -sy], up: [-sy * sp, cp, -cy * sp], back: [sy * cp, sp, cy * cp] };
  }

  /** @param offset  by how much the whole is moved; origin: what places are told from */
  matrices(aspect, offset = [0, 0, 0], origin = [0, 0, 0]) {
    const { right, up, back } = this.axes();
    const half = this.halfHeight(aspect);
    const distance = this.flat ? 10 * half : half / Math.tan(kHalfAngle);
    const eye = this.target.map((x, c) => x - origin[c] + offset[c] + distance * back[c]);
    const dot = (a) => -(a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2]);
    const view = [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
      dot(right), dot(up), dot(back), 1];
    const near = this.flat ? -90 * half : 0.02 * distance;
    const far = this.flat ? 110 * half : distance + 60 * half;
    const projection = this.flat
      ? [1 / (half * aspect), 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, -2 / (far - near), 0, 0, 0,
        -(far + near) / (far - near), 1]
      : [1 / (Math.tan(kHalfAngle) * aspect), 0, 0, 0, 0, 1 / Math.tan(kHalfAngle), 0, 0, 0, 0,
        -(far + near) / (far - near), -1, 0, 0, -2 * far * near / (far - near), 0];
    return { view, projection, half, distance, eye };
  }

  orbit(dx, dy) {
    if (this.flat) return;
    this.moved = true;
    this.yaw -= dx;
    this.pitch = Math.min(Math.max(this.pitch + dy, -1.5), 1.5);
  }

  /** Moves the target; dx and dy in halves of the height that is seen. */
  pan(dx, dy, aspect) {
    const { right, up } = this.axes();
    const half = this.halfHeight(aspect);
    this.moved = true;
    this.target = this.target.map((x, c) => x - half * (dx * right[c] - dy * up[c]));
  }

  zoomBy(factor) {
    this.moved = true;
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.05), 1e4);
  }
}

const kHalfAngle = 0.32;

export function transform(m, [x, y, z], w = 1) {
  return [0, 1, 2, 3].map((r) => m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r] * w);
}

/** The first ball that is seen at a point of the picture (from -1 to 1, y up), or -1. */
export function pick(camera, aspect, offset, [px, py], state, radii) {
  const { view, half, distance } = camera.matrices(aspect, offset);
  const origin = camera.flat ? [px * half * aspect, py * half, 0] : [0, 0, 0];
  const toward = camera.flat ? [0, 0, -1] : [px * half * aspect / distance, py * half / distance, -1];
  const length = Math.hypot(...toward);
  let nearest = Infinity;
  let found = -1;
  for (let i = 0; i < radii.length; i += 1) {
    const c = transform(view, [state.x[3 * i], state.x[3 * i + 1], state.x[3 * i + 2]]);
    const away = [c[0] - origin[0], c[1] - origin[1], c[2] - origin[2]];
    const along = (away[0] * toward[0] + away[1] * toward[1] + away[2] * toward[2]) / length;
    const square = away[0] ** 2 + away[1] ** 2 + away[2] ** 2 - along * along;
    // A ball of a few pixels is hard to hit: a little beside it counts.
    const reach = Math.max(radii[i], 0.02 * half);
    if (square > reach * reach || along >= nearest) continue;
    nearest = along;
    found = i;
  }
  return found;
}
