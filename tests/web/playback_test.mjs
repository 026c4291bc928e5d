// What the C++ side packs, the browser's side unpacks: held against the program's own JSON, in node.

import assert from "node:assert/strict";
import test, { before } from "node:test";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { makeReport, playbackOf } from "./report.mjs";

const viewer = (name) => import(pathToFileURL(join(process.env.CAROM_SOURCE_DIR, "reports/web/viewer", name)));
let report;
let Playback;
let Motion;
before(async () => {
  report = makeReport(["friction/two-spinning-balls", "gas/hundred-2d", "gas/short-3d", "impact/oblique-space", "course/impulse"], ["carom", "carom:step"]);
  ({ Playback } = await viewer("playback.js"));
  ({ Motion } = await viewer("motion.js"));
});

test("Playback_EndsWhereTheEngineDoes_WithinItsRounding", async () => {
  for (const scene of report.results.scenes) {
    const playback = await Playback.read(playbackOf(report, scene.id));
    for (const run of scene.runs) {
      const motion = new Motion(playback, await playback.run(run.engine));
      const { position_m, speed_mps, spin_radps } = playback.rounding;
      const last = motion.frames - 1;
      assert.equal(motion.frames, scene.frames + 1);
      assert.equal(motion.counted[last], run.collisions);
      run.final.forEach((ball, i) => {
        for (let axis = 0; axis < scene.dimension; axis += 1) {
          const at = 3 * (last * motion.balls + i) + axis;
          assert.ok(Math.abs(motion.positions[at] - ball.position[axis]) <= 0.5 * position_m, `${scene.id} ball ${i}`);
          assert.ok(Math.abs(motion.velocities[at] - ball.velocity[axis]) <= 0.5 * speed_mps, `${scene.id} ball ${i}`);
        }
        if (motion.spins) assert.ok(Math.abs(motion.spins[3 * (last * motion.balls + i) + 2] - ball.spin.at(-1)) <= 0.5 * spin_radps);
      });
    }
  }
});

test("Motion_IsTheFlight_BetweenFramesAndThroughAnImpact", async () => {
  const playback = await Playback.read(playbackOf(report, "impact/oblique-space"));
  const motion = new Motion(playback, await playback.run("carom"));
  const [impact] = motion.impacts;
  const [before, after] = [motion.at(impact.time - 0.004), motion.at(impact.time + 0.004)];
  const k = motion.frameAt(impact.time);
  for (let c = 0; c < 3; c += 1) {
    const from = 3 * (k * motion.balls + impact.ball) + c;
    const to = from + 3 * motion.balls;
    const flown = motion.positions[from] + motion.velocities[from] * (impact.time - 0.004 - motion.times[k]);
    const left = motion.positions[to] - motion.velocities[to] * (motion.times[k + 1] - impact.time - 0.004);
    assert.ok(Math.abs(before.x[3 * impact.ball + c] - flown) < 10 * playback.rounding.position_m);
    assert.ok(Math.abs(after.x[3 * impact.ball + c] - left) < 10 * playback.rounding.position_m);
  }
});

test("Motion_TurnsByTheSpin_AndKeepsQuaternionsOfLengthOne", async () => {
  const playback = await Playback.read(playbackOf(report, "friction/two-spinning-balls"));
  const motion = new Motion(playback, await playback.run("carom"));
  const turns = new Float32Array(4 * motion.balls);
  const time = 0.5 * motion.impacts[0].time;
  motion.turnsAt("physical", time, playback.balls.radius, turns);
  const angle = motion.spins[2] * time;
  // In the plane a turn is about z: (0, 0, sin α/2, cos α/2), up to the sign of the whole.
  const sign = Math.sign(turns[3] * Math.cos(angle / 2)) || 1;
  assert.ok(Math.abs(turns[2] - sign * Math.sin(angle / 2)) < 1e-4 && Math.abs(Math.hypot(...turns.subarray(0, 4)) - 1) < 1e-4);
});

test("Tree_IsTheEnginesOwn_ByWhatItLooksAt", async () => {
  const { divide } = await viewer("tree.js");
  for (const id of ["gas/hundred-2d", "gas/short-3d"]) {
    const playback = await Playback.read(playbackOf(report, id));
    const motion = new Motion(playback, await playback.run("carom"));
    const { mass: masses, radius: radii, count } = playback.balls;
    let other = 0;
    for (let k = 0; k < motion.frames; k += 1) {
      const { tests, cells } = divide(motion.at(motion.times[k]), { masses, radii }, playback.scene.dimension);
      assert.equal(motion.tests.bruteForce[k], count * (count - 1) / 2);
      assert.ok(cells.length > 4 && motion.tests.tree[k] < 0.7 * motion.tests.bruteForce[k], `${id}: ${motion.tests.tree[k]}`);
      // Places are rounded here by 2⁻¹⁵ of a radius: now and then a ball is on the other side of a cell's border.
      if (tests !== motion.tests.tree[k]) other += 1;
    }
    assert.ok(other <= 0.05 * motion.frames, `${id}: ${other} of ${motion.frames} frames`);
  }
});

test("Energy_ThatAnEventBrings_IsNeitherLostNorGained", async () => {
  const { energiesAt } = await viewer("energies.js");
  const playback = await Playback.read(playbackOf(report, "course/impulse"));
  const motion = new Motion(playback, await playback.run("carom"));
  const [{ runs }] = report.results.scenes.filter(({ id }) => id === "course/impulse");
  const { events } = runs[0].energy_by_cause;
  assert.ok(Math.abs(energiesAt(motion, 0).added) === 0 && Math.abs(events) > 1e-3);
  for (let time = 0; time <= 10; time += 0.05) assert.equal(energiesAt(motion, time).lost, 0, `${time} s`);
  assert.ok(Math.abs(energiesAt(motion, 10).added - events) < 1e-12, `${energiesAt(motion, 10).added} for ${events}`);
});

test("Pace_DrawsFewerPixels_OnlyWhilePicturesAreSlow", async () => {
  const { Pace } = await viewer("pace.js");
  const pace = new Pace();
  const after = (pictures, ms) => {
    for (let k = 0; k < pictures; k += 1) pace.took(ms);
    return pace.quality;
  };
  assert.equal(after(4, 200), 1);
  assert.equal(after(1, 16), 1);
  assert.ok(after(5, 200) < 1);
  const least = after(100, 200);
  assert.ok(least > 0.3 && least < 0.5);
  assert.equal(after(1000, 35), least); // neither slow nor fast: it stays
  assert.equal(after(1000, 16), 1);
});

test("Transmission_IsThatOfTheBooks", async () => {
  const { transmission } = await viewer("barrier.js");
  const unit = { mass: 1, height: 1, thickness: 1, hbar: 1 };
  // Published for ħ = m = V = a = 1, E = 1/2; E = V by the third formula: 1/(1 + 1/2).
  assert.ok(Math.abs(transmission({ ...unit, energy: 0.5 }) - 0.41997) < 5e-6);
  assert.ok(Math.abs(transmission({ ...unit, energy: 1 }) - 2 / 3) < 1e-15);
  // It is steady across E = V, and never above 1.
  assert.ok(Math.abs(transmission({ ...unit, energy: 1 + 1e-7 }) - 2 / 3) < 1e-6);
  assert.ok(Math.abs(transmission({ ...unit, energy: 1 - 1e-7 }) - 2 / 3) < 1e-6);
  for (let energy = 0.1; energy < 20; energy += 0.1) assert.ok(transmission({ ...unit, energy }) <= 1);
});

test("Words_AreThereInBothLanguages", async () => {
  const [{ en }, { de }] = await Promise.all([viewer("words/en.js"), viewer("words/de.js")]);
  const shape = (words, at = "") => Object.entries(words).flatMap(([key, value]) =>
    (value && typeof value === "object" && !Array.isArray(value) ? shape(value, `${at}${key}.`)
      : `${at}${key}: ${Array.isArray(value) ? value.length : typeof value}`));
  assert.deepEqual(shape(de).sort(), shape(en).sort());
  const { formulas } = await viewer("formulas.js");
  assert.deepEqual(Object.keys(formulas).sort(), Object.keys(en.modes).sort());
});
