// Makes the picture of one run at one moment, as the switches say.

import { kBallColours, kGhost, kPlain, parted, ramp } from "./colours.js";
import { totals } from "./motion.js";
import { drawRoom, Picture } from "./picture.js";
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
 * @param shot  motion, state, bodies, view, theme, toggles, colouring, scales, rate, twin (state of the run that it is
 *              held against, or nothing), ghost (draw the twin too)
 */
export function pictureOf(shot) {
  const picture = new Picture();
  const { motion, state, bodies, theme, toggles } = shot;
  drawRoom(picture, motion.scene, shot.view, theme);
  const turns = new Float32Array(4 * motion.balls);
  if (toggles.spin !== "off") motion.turnsAt(toggles.spin, state.time, bodies.radii, turns);
  for (let i = 0; i < motion.balls; i += 1) {
    if (Number.isNaN(bodies.masses[i])) continue;
    const away = shot.twin ? distance(state, shot.twin, i) / bodies.radii[i] : 0;
    picture.ball(point(state.x, i), bodies.radii[i], shade(shot, i, away), {
      turned: toggles.spin === "off" ? null : turns.subarray(4 * i, 4 * i + 4),
      ring: (shot.colouring === "parted" && away > kDiverged) || shot.chosen === i,
    });
    if (shot.ghost && shot.twin) picture.ball(point(shot.twin.x, i), bodies.radii[i], kGhost, { alpha: 0.35 });
  }
  if (toggles.trails) drawTrails(picture, shot);
  drawArrows(picture, shot);
  if (toggles.centre || toggles.frame) drawCentre(picture, shot);
  if (toggles.tree) {
    drawTree(picture, shot);
  }
  return picture;
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

function shade({ motion, state, colouring, scales, twin }, i, away) {
  if (colouring === "parted" && twin) return parted((Math.log10(Math.max(away, 1e-12)) + 4) / 4);
  if (colouring === "speed") return ramp(Math.hypot(...point(state.v, i)) / (scales.speed || 1));
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

function drawArrows(picture, shot) {
  const { motion, state, bodies, theme, toggles, scales, unit } = shot;
  const drift = toggles.frame ? totals(state, bodies.masses).velocity : [0, 0, 0];
  for (let i = 0; i < motion.balls; i += 1) {
    if (Number.isNaN(bodies.masses[i])) continue;
    const v = point(state.v, i).map((x, c) => x - drift[c]);
    // From the surface on, so that no arrow hides in its ball.
    const speed = Math.hypot(...v);
    const from = point(state.x, i).map((x, c) => x + (speed > 0 ? bodies.radii[i] * v[c] / speed : 0));
    if (toggles.velocity && scales.speed > 0) picture.arrow(from, v.map((x) => x * 2 * unit / scales.speed), theme.velocity, unit);
    const m = bodies.masses[i];
    if (toggles.momentum && scales.momentum > 0 && Number.isFinite(m)) {
      picture.arrow(from, v.map((x) => m * x * 2 * unit / scales.momentum), theme.momentum, unit);
    }
  }
  if (toggles.impulse && scales.impulse > 0) drawImpulses(picture, shot);
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
      picture.arrow(from, impulse.map((x) => x * 2.2 * unit / scales.impulse), theme.impulse, unit);
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
