// Makes the picture of one run at one moment, as the switches say.

import { kBallColours, kGhost, kPlain, parted, ramp, tabled } from "./colours.js";
import { totals } from "./motion.js";
import { drawRoom } from "./picture.js";
import { divide } from "./tree.js";

const kManyBalls = 24;      // with more, colours by number say nothing
const kTrails = 60;         // balls with a trail
const kTrailFrames = 45;
const kImpulse_s = 0.7;     // of the person who watches: how long an impulse is seen
const kMostImpulses = 60;
const kDiverged = 1e-3;     // radii

/**
 * The masses and radii at a time, as events have changed them until then. A ball that is not there has neither: its mass
 * is NaN, so that it counts nowhere, and its radius 0.
 */
export function bodiesAt(playback, time) {
  const { balls: { mass, radius, first, shown }, changes, frames, scene } = playback;
  if (changes.length === 0) return { masses: mass, radii: radius };
  const [masses, radii] = [mass.slice(), radius.slice()];
  masses.fill(NaN, first, shown);
  radii.fill(0, first, shown);
  for (const change of changes) {
    if (change.frame / frames.intervals * scene.duration > time * (1 + 1e-12)) continue;
    masses[change.ball] = change.there ? change.mass ?? Infinity : NaN;
    radii[change.ball] = change.there ? change.radius : 0;
  }
  return { masses, radii };
}

/** What one run comes to over its whole time, for scales: speeds, momenta, impulses. */
export function scalesOf(motion, masses) {
  const scales = { speed: 0, momentum: 0, impulse: 0 };
  const n = motion.balls;
  for (let at = 0; at < n * motion.frames; at += 1) {
    const speed = Math.hypot(motion.velocities[3 * at], motion.velocities[3 * at + 1], motion.velocities[3 * at + 2]);
    const mass = masses[at % n];
    scales.speed = Math.max(scales.speed, speed);
    if (Number.isFinite(mass)) scales.momentum = Math.max(scales.momentum, mass * speed);
  }
  for (const { time, ball } of motion.impacts.slice(0, 2000)) {
    if (Number.isFinite(masses[ball])) {
      scales.impulse = Math.max(scales.impulse, Math.hypot(...motion.impulseAt(time, ball, masses[ball])));
    }
  }
  return scales;
}

const point = (list, i) => [list[3 * i], list[3 * i + 1], list[3 * i + 2]];

export function colourOf(ball, count) {
  return count <= kManyBalls ? kBallColours[ball % kBallColours.length] : kPlain;
}

/**
 * Writes what is to be seen into a picture.
 * @param shot  motion, state, bodies, view, theme, toggles, colouring, scales, rate, twin (state of the run that it is
 *              held against, or nothing), ghost (draw the twin too), turns (room for a quaternion of each ball)
 */
export function drawScene(picture, shot) {
  const { toggles } = shot;
  picture.begin(shot.view.low.map((x, c) => 0.5 * (x + shot.view.high[c])));
  drawRoom(picture, shot.motion.scene, shot.view, shot.theme);
  drawBalls(picture, shot);
  if (toggles.trails) drawTrails(picture, shot);
  if (toggles.momentum || toggles.velocity) drawArrows(picture, shot);
  if (toggles.impulse && shot.scales.impulse > 0) drawImpulses(picture, shot);
  if (toggles.centre || toggles.frame) drawCentre(picture, shot);
  if (toggles.tree) drawTree(picture, shot);
}

function drawBalls(picture, shot) {
  const { motion, state: { x, time }, bodies: { masses, radii }, toggles, twin } = shot;
  const turns = toggles.spin === "off" ? null : shot.turns;
  if (turns) motion.turnsAt(toggles.spin, time, radii, turns);
  const look = { turns, ball: 0, alpha: 1, ring: false };
  const ghost = { alpha: 0.35 };
  for (let i = 0; i < motion.balls; i += 1) {
    if (Number.isNaN(masses[i])) continue;
    const away = twin ? distance(shot.state, twin, i) / radii[i] : 0;
    look.ball = i;
    look.ring = (shot.colouring === "parted" && away > kDiverged) || shot.chosen === i;
    picture.ball(x[3 * i], x[3 * i + 1], x[3 * i + 2], radii[i], shade(shot, i, away), look);
    if (shot.ghost && twin) picture.ball(twin.x[3 * i], twin.x[3 * i + 1], twin.x[3 * i + 2], radii[i], kGhost, ghost);
  }
}

/** The cells as far as they lie in the box: outside of it there is no ball to look for. */
function drawTree(picture, { motion, state, bodies, theme }) {
  const { dimension, box } = motion.scene;
  const within = (x, c) => (box ? Math.min(Math.max(x, box.min[c]), box.max[c]) : x);
  for (const { centre, half, depth } of divide(state, bodies, dimension).cells) {
    const [low, high] = [-half, half].map((side) => centre.map((x, c) => within(x + side, c)));
    picture.cube(low.map((x, c) => 0.5 * (x + high[c])), low.map((x, c) => 0.5 * (high[c] - x)), theme.tree, dimension,
      Math.max(0.9 - 0.1 * depth, 0.35));
  }
}

export function distance(state, twin, i) {
  return Math.hypot(state.x[3 * i] - twin.x[3 * i], state.x[3 * i + 1] - twin.x[3 * i + 1], state.x[3 * i + 2] - twin.x[3 * i + 2]);
}

const shadeOfSpeed = tabled(ramp);
const shadeOfDifference = tabled(parted);

function shade({ motion, state: { v }, colouring, scales, twin }, i, away) {
  if (colouring === "parted" && twin) return shadeOfDifference((Math.log10(Math.max(away, 1e-12)) + 4) / 4);
  if (colouring === "speed") return shadeOfSpeed(Math.sqrt(v[3 * i] ** 2 + v[3 * i + 1] ** 2 + v[3 * i + 2] ** 2) / (scales.speed || 1));
  return colourOf(i, motion.balls);
}

function drawTrails(picture, { motion, state, bodies, toggles }) {
  const n = motion.balls;
  const first = Math.max(0, state.frame - kTrailFrames);
  const centreNow = totals(state, bodies.masses).centre;
  const shift = (k) => {
    if (!toggles.frame) return [0, 0, 0];
    const then = totals({ x: motion.positions.subarray(3 * k * n, 3 * (k + 1) * n), v: state.v }, bodies.masses).centre;
    return centreNow.map((x, c) => x - then[c]);
  };
  const shifts = [];
  for (let k = first; k <= state.frame; k += 1) shifts.push(shift(k));
  for (let i = 0; i < Math.min(n, kTrails); i += 1) {
    let from = null;
    for (let k = first; k <= state.frame + 1; k += 1) {
      const now = k > state.frame;
      const to = now ? point(state.x, i) : point(motion.positions, k * n + i).map((x, c) => x + shifts[k - first][c]);
      if (from) picture.stroke(from, to, colourOf(i, n), { width: 2, alpha: 0.15 + 0.75 * (k - first) / (state.frame + 1 - first) });
      from = to;
    }
  }
}

const kMomentumFirst = [true, false];
const kVelocityFirst = [false, true];

/**
 * From the surface on, so that no arrow hides in its ball. Velocity and momentum point one way: the shorter one lies on
 * the longer one, and a momentum is thicker, so that both are seen.
 */
function drawArrows(picture, { motion, state: { x, v }, bodies, theme, toggles, scales, unit }) {
  const drift = toggles.frame ? totals({ x, v }, bodies.masses).velocity : [0, 0, 0];
  const perSpeed = toggles.velocity && scales.speed > 0 ? 2 * unit / scales.speed : 0;
  const perMomentum = toggles.momentum && scales.momentum > 0 ? 2 * unit / scales.momentum : 0;
  for (let i = 0; i < motion.balls; i += 1) {
    const m = bodies.masses[i];
    if (Number.isNaN(m)) continue;
    const vx = v[3 * i] - drift[0];
    const vy = v[3 * i + 1] - drift[1];
    const vz = v[3 * i + 2] - drift[2];
    const speed = Math.sqrt(vx * vx + vy * vy + vz * vz);
    if (speed === 0) continue;
    const out = bodies.radii[i] / speed;
    const fromX = x[3 * i] + out * vx;
    const fromY = x[3 * i + 1] + out * vy;
    const fromZ = x[3 * i + 2] + out * vz;
    const p = Number.isFinite(m) ? perMomentum * m : 0;
    for (const momentum of p > perSpeed ? kMomentumFirst : kVelocityFirst) {
      const s = momentum ? p : perSpeed;
      if (s > 0) picture.arrow(fromX, fromY, fromZ, s * vx, s * vy, s * vz, momentum ? theme.momentum : theme.velocity, unit, momentum ? 1.8 : 1);
    }
  }
}

function drawImpulses(picture, { motion, state, bodies, theme, scales, unit, rate }) {
  const next = motion.times[Math.min(state.frame + 1, motion.frames - 1)] - motion.times[state.frame];
  const since = state.time - Math.max(kImpulse_s * rate, next);
  const seen = motion.impacts.filter((impact) => impact.time <= state.time && impact.time > since).slice(-kMostImpulses);
  for (const { time, ball, other } of seen) {
    for (const i of other >= 0 ? [ball, other] : [ball]) {
      if (!Number.isFinite(bodies.masses[i])) continue;
      const impulse = motion.impulseAt(time, i, bodies.masses[i]);
      const size = Math.hypot(...impulse) || 1;
      const from = point(state.x, i).map((x, c) => x + bodies.radii[i] * impulse[c] / size);
      picture.arrow(...from, ...impulse.map((x) => x * 2.2 * unit / scales.impulse), theme.impulse, unit, 1.3);
    }
  }
}

function drawCentre(picture, { state, bodies, theme, unit }) {
  const sum = totals(state, bodies.masses);
  if (sum.mass === 0) return;
  for (let c = 0; c < 3; c += 1) {
    const step = [0, 0, 0];
    step[c] = 0.35 * unit;
    picture.stroke(sum.centre.map((x, a) => x - step[a]), sum.centre.map((x, a) => x + step[a]), theme.centre, { width: 3, front: true });
  }
}
