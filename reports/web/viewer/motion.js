// Where the balls of one run are at any time: exact in the frames, and between two frames what flight says. Where a
// velocity jumps between them, the ball flies on from the frame before and back from the frame after, and the two
// flights meet at its impact.

const kSmooth = 0.02; // by the speeds: a smaller change is drawn as a smooth curve

export class Motion {
  constructor(playback, run) {
    Object.assign(this, run);
    this.playback = playback;
    this.scene = playback.scene;
    this.times = playback.times;
    this.balls = playback.balls.shown;
    this.end = this.times[this.frames - 1];
    this.gravity = this.scene.gravity ?? [0, 0, 0];
    this.turns = new Map();
  }

  /** The frame at or before a time. */
  frameAt(time) {
    let low = 0;
    let high = this.frames - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time + 1e-12 * this.end) low = middle; else high = middle - 1;
    }
    return low;
  }

  /** Positions and velocities at a time, written into `state` (made where there is none). */
  at(time, state = null) {
    const n = this.balls;
    const into = state ?? { x: new Float64Array(3 * n), v: new Float64Array(3 * n) };
    const k = this.frameAt(Math.min(time, this.end));
    into.frame = k;
    into.time = Math.min(time, this.end);
    const from = 3 * k * n;
    if (k === this.frames - 1) {
      into.x.set(this.positions.subarray(from, from + 3 * n));
      into.v.set(this.velocities.subarray(from, from + 3 * n));
      return into;
    }
    const h = this.times[k + 1] - this.times[k];
    const share = Math.min(Math.max((into.time - this.times[k]) / h, 0), 1);
    for (let i = 0; i < n; i += 1) this.between(i, from + 3 * i, h, share, into);
    return into;
  }

  between(ball, a, h, s, into) {
    const { positions: x, velocities: v, gravity: g } = this;
    const b = a + 3 * this.balls;
    let jump = 0;
    let speed = 0;
    for (let c = 0; c < 3; c += 1) {
      jump += (v[b + c] - v[a + c] - h * g[c]) ** 2;
      speed += v[a + c] ** 2 + v[b + c] ** 2;
    }
    if (jump <= kSmooth ** 2 * speed) {
      for (let c = 0; c < 3; c += 1) this.smooth(3 * ball + c, a + c, b + c, h, s, into);
      return;
    }
    let along = 0;
    let square = 0;
    for (let c = 0; c < 3; c += 1) {
      const gap = x[b + c] - h * v[b + c] + 0.5 * h * h * g[c] - x[a + c];
      const apart = (v[a + c] - v[b + c] + h * g[c]) * h;
      along += gap * apart;
      square += apart * apart;
    }
    const turn = square > 0 ? Math.min(Math.max(along / square, 0), 1) : 0.5;
    let miss = 0;
    for (let c = 0; c < 3; c += 1) {
      const t = turn * h;
      const back = h - t;
      miss += (x[b + c] - v[b + c] * back + 0.5 * g[c] * back * back - x[a + c] - v[a + c] * t - 0.5 * g[c] * t * t) ** 2;
    }
    const twice = miss > kSmooth * speed * h * h; // several impacts: nobody can tell where
    for (let c = 0; c < 3; c += 1) {
      const before = s < turn;
      const t = before ? s * h : (s - 1) * h;
      const at = before ? a + c : b + c;
      into.v[3 * ball + c] = v[at] + g[c] * t;
      into.x[3 * ball + c] = twice ? x[a + c] + s * (x[b + c] - x[a + c]) : x[at] + v[at] * t + 0.5 * g[c] * t * t;
    }
  }

  /** The cubic with the positions and velocities of both frames: under constant acceleration the flight itself. */
  smooth(at, a, b, h, s, into) {
    const { positions: x, velocities: v } = this;
    const r = 1 - s;
    into.x[at] = x[a] + s * s * (3 - 2 * s) * (x[b] - x[a]) + h * s * r * (r * v[a] - s * v[b]);
    into.v[at] = v[a] + s * (v[b] - v[a]);
  }

  /** The physical ω of a ball in a frame, rad/s. */
  spinOf(frame, ball) {
    const at = 3 * (frame * this.balls + ball);
    return this.spins ? [this.spins[at], this.spins[at + 1], this.spins[at + 2]] : [0, 0, 0];
  }

  /**
   * How the balls are turned at a time: quaternions x, y, z, w. ω is taken as constant from frame to frame.
   * @param kind  "physical", or "shown": the course program's look of it, ω = (ẑ × v)/r
   */
  turnsAt(kind, time, radii, into) {
    if (!this.turns.has(kind)) this.turns.set(kind, this.integrateTurns(kind, radii));
    const turns = this.turns.get(kind);
    const k = this.frameAt(Math.min(time, this.end));
    const rest = Math.min(time, this.end) - this.times[k];
    for (let i = 0; i < this.balls; i += 1) this.turn(kind, k, i, radii[i], rest, turns, 4 * (k * this.balls + i), into, 4 * i);
  }

  /** Turns a ball's quaternion, the one that begins at `from`, on by its ω of a frame for a time. */
  turn(kind, frame, ball, radius, time, turns, from, into, at) {
    const place = 3 * (frame * this.balls + ball);
    if (kind === "shown") turned(turns, from, -this.velocities[place + 1] / radius, this.velocities[place] / radius, 0, time, into, at);
    else if (this.spins) turned(turns, from, this.spins[place], this.spins[place + 1], this.spins[place + 2], time, into, at);
    else turned(turns, from, 0, 0, 0, time, into, at);
  }

  integrateTurns(kind, radii) {
    const n = this.balls;
    const turns = new Float32Array(4 * n * this.frames);
    for (let i = 0; i < n; i += 1) turns[4 * i + 3] = 1;
    for (let k = 0; k + 1 < this.frames; k += 1) {
      const h = this.times[k + 1] - this.times[k];
      for (let i = 0; i < n; i += 1) {
        const at = 4 * (k * n + i);
        this.turn(kind, k, i, radii[i], h, turns, at, turns, at + 4 * n);
      }
    }
    return turns;
  }

  /** The impulse on a ball between the frames around a time, N s. */
  impulseAt(time, ball, mass) {
    const k = Math.min(this.frameAt(time), this.frames - 2);
    const h = this.times[k + 1] - this.times[k];
    const a = 3 * (k * this.balls + ball);
    const b = a + 3 * this.balls;
    return [0, 1, 2].map((c) => mass * (this.velocities[b + c] - this.velocities[a + c] - h * this.gravity[c]));
  }
}

/** The quaternion at `from`, turned on by the constant ω for a time: exp(ω t / 2) q. */
function turned(turns, from, wx, wy, wz, time, into, at) {
  const rate = Math.sqrt(wx * wx + wy * wy + wz * wz);
  const half = 0.5 * rate * time;
  const s = rate > 0 ? Math.sin(half) / rate : 0;
  const x = wx * s;
  const y = wy * s;
  const z = wz * s;
  const w = Math.cos(half);
  const a = turns[from];
  const b = turns[from + 1];
  const c = turns[from + 2];
  const d = turns[from + 3];
  into[at] = w * a + x * d + y * c - z * b;
  into[at + 1] = w * b - x * c + y * d + z * a;
  into[at + 2] = w * c + x * b - y * a + z * d;
  into[at + 3] = w * d - x * a - y * b - z * c;
}

/** Momentum, centre of mass and its velocity; balls of infinite mass are left out. */
export function totals(state, masses) {
  const sum = { mass: 0, momentum: [0, 0, 0], centre: [0, 0, 0], velocity: [0, 0, 0], kinetic: 0 };
  for (let i = 0; i < masses.length; i += 1) {
    const m = masses[i];
    if (!Number.isFinite(m)) continue;
    sum.mass += m;
    for (let c = 0; c < 3; c += 1) {
      sum.centre[c] += m * state.x[3 * i + c];
      sum.momentum[c] += m * state.v[3 * i + c];
      sum.kinetic += 0.5 * m * state.v[3 * i + c] ** 2;
    }
  }
  if (sum.mass > 0) {
    sum.centre = sum.centre.map((x) => x / sum.mass);
    sum.velocity = sum.momentum.map((p) => p / sum.mass);
  }
  return sum;
}
