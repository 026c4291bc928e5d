// Reads what src/report/playback.h writes. Runs in browsers and in node.

async function inflate(text) {
  const letters = atob(text);
  const packed = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i += 1) packed[i] = letters.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Signed integers as pack_integers() packs them. */
export async function unpackIntegers(text) {
  const bytes = await inflate(text);
  const count = bytes.length / 4;
  const numbers = new Int32Array(count);
  for (let i = 0; i < count; i += 1) {
    const word = bytes[i] | bytes[count + i] << 8 | bytes[2 * count + i] << 16 | bytes[3 * count + i] << 24;
    numbers[i] = word >>> 1 ^ -(word & 1);
  }
  return numbers;
}

/** Doubles as pack_doubles() packs them. */
export async function unpackDoubles(text) {
  const bytes = await inflate(text);
  const count = bytes.length / 8;
  const ordered = new Uint8Array(bytes.length);
  for (let i = 0; i < count; i += 1) {
    for (let byte = 0; byte < 8; byte += 1) ordered[8 * i + byte] = bytes[byte * count + i];
  }
  return new Float64Array(ordered.buffer);
}

/** Sums of first differences, in place. */
function addUp(numbers) {
  for (let k = 1; k < numbers.length; k += 1) numbers[k] += numbers[k - 1];
  return numbers;
}

/** A quantity of all balls in all frames, three numbers each: index 3 (frame * balls + ball) + axis. */
async function unpackStates(text, { frames, balls, axes, grid }) {
  const numbers = await unpackIntegers(text);
  const states = new Float64Array(3 * frames * balls);
  let at = 0;
  for (const axis of axes) {
    for (let i = 0; i < balls; i += 1) {
      let now = 0;
      for (let k = 0; k < frames; k += 1, at += 1) {
        now = now + numbers[at] | 0;
        states[3 * (k * balls + i) + axis] = now * grid;
      }
    }
  }
  return states;
}

/** Positions, from the velocities and what the flight from frame to frame misses them by: (1) in playback.h. */
async function unpackPositions(text, velocities, { frames, balls, axes, grid, times }) {
  const missed = await unpackIntegers(text);
  const states = new Float64Array(3 * frames * balls);
  const farthest = 2 ** 29 * grid;
  const jump = new Float64Array(axes.length);
  for (let i = 0; i < balls; i += 1) {
    axes.forEach((axis, place) => { states[3 * i + axis] = missed[(place * balls + i) * frames] * grid; });
    for (let k = 1; k < frames; k += 1) {
      const h = times[k] - times[k - 1];
      const to = 3 * (k * balls + i);
      const from = to - 3 * balls;
      let lead = 0;
      for (let place = 0; place < axes.length; place += 1) {
        jump[place] = velocities[to + axes[place]] - velocities[from + axes[place]];
        if (Math.abs(jump[place]) > Math.abs(jump[lead])) lead = place;
      }
      const first = missed[(lead * balls + i) * frames + k] * grid;
      const once = jump[lead] !== 0 && Number.isFinite(jump[lead]) && Math.abs(first) <= 0.5 * h * Math.abs(jump[lead]) + grid;
      for (let place = 0; place < axes.length; place += 1) {
        const axis = axes[place];
        const aside = once && place !== lead ? first * (jump[place] / jump[lead]) : 0;
        const flight = 0.5 * h * (velocities[from + axis] + velocities[to + axis]) + aside;
        states[to + axis] = states[from + axis] + Math.min(Math.max(flight, -farthest), farthest)
          + missed[(place * balls + i) * frames + k] * grid;
      }
    }
  }
  return states;
}

const kTimeUnits = 2 ** 30;

async function unpackImpacts(text, duration) {
  const numbers = await unpackIntegers(text);
  const count = numbers.length / 3;
  const impacts = [];
  let time = 0;
  for (let i = 0; i < count; i += 1) {
    time += numbers[i];
    impacts.push({ time: time / kTimeUnits * duration, ball: numbers[count + i], other: numbers[2 * count + i] });
  }
  return impacts;
}

/** A playback whose runs are unpacked when they are asked for. */
export class Playback {
  constructor(json) {
    if (json.format !== "carom-playback-2") throw new Error(`not a playback: ${json.format}`);
    this.scene = json.scene;
    this.rounding = json.rounding;
    this.leftOut = json.left_out;
    this.frames = json.frames;
    this.balls = { count: json.balls.count, shown: json.balls.shown, first: json.balls.first ?? json.balls.shown };
    this.changes = json.balls.changes ?? [];
    this.runs = json.runs;
    this.packedBalls = json.balls;
    this.unpacked = new Map();
    this.times = [];
    const { intervals, every } = json.frames;
    for (let k = 0; k < intervals; k += every) this.times.push(k / intervals * json.scene.duration);
    this.times.push(json.scene.duration);
  }

  static async read(json) {
    const playback = new Playback(json);
    for (const name of ["mass", "radius", "inertia"]) {
      playback.balls[name] = await unpackDoubles(playback.packedBalls[name]);
    }
    return playback;
  }

  /** Runs that have states, the truth among them. */
  get played() {
    return this.runs.filter((run) => run.positions || run.same_as);
  }

  /** The states of the run with this label. */
  async run(label) {
    const about = this.runs.find((run) => run.label === label);
    if (!about) throw new Error(`no run ${label}`);
    const packed = about.same_as ? this.runs.find((run) => run.label === about.same_as) : about;
    if (!this.unpacked.has(packed.label)) this.unpacked.set(packed.label, this.unpack(packed));
    return { ...await this.unpacked.get(packed.label), about };
  }

  async unpack(packed) {
    const shape = { frames: packed.known, balls: this.balls.shown };
    const plane = this.scene.dimension === 2;
    const axes = plane ? [0, 1] : [0, 1, 2];
    const { position_m, speed_mps, spin_radps } = this.rounding;
    const energy = await unpackDoubles(packed.energy);
    const counted = await unpackIntegers(packed.counted);
    addUp(counted);
    const tests = packed.tree_tests
      ? { bruteForce: addUp(await unpackIntegers(packed.brute_force_tests)), tree: addUp(await unpackIntegers(packed.tree_tests)) }
      : null;
    const velocities = await unpackStates(packed.velocities, { ...shape, axes, grid: speed_mps });
    return {
      frames: packed.known,
      positions: await unpackPositions(packed.positions, velocities, { ...shape, axes, grid: position_m, times: this.times }),
      velocities,
      spins: packed.spins
        ? await unpackStates(packed.spins, { ...shape, axes: plane ? [2] : axes, grid: spin_radps })
        : null,
      translation: energy.subarray(0, packed.known),
      rotation: energy.subarray(packed.known, 2 * packed.known),
      potential: energy.subarray(2 * packed.known),
      counted,
      tests,
      added: packed.added ? await unpackDoubles(packed.added) : new Float64Array(packed.known),
      impacts: packed.impacts ? await unpackImpacts(packed.impacts, this.scene.duration) : [],
      moreImpacts: packed.more_impacts ?? false,
    };
  }
}
