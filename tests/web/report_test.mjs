// The player in the report, in a real browser: every mode of the course, numbers, keys, languages, exports.

import assert from "node:assert/strict";
import test, { after, before } from "node:test";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

import { openBrowser } from "./browser.mjs";
import { makeReport } from "./report.mjs";

let report;
let browser;
let page;
before(async () => {
  report = makeReport(["course/", "impact/oblique", "wall/drop-elastic", "friction/two-spinning-balls"], ["carom", "carom:step"]);
  browser = await openBrowser();
  page = await browser.page();
  await page.goto(pathToFileURL(report.file).href);
});
after(() => browser?.close());

const scenes = () => report.results.scenes;
const section = (id) => page.locator("section.scene").filter({ has: page.locator(`p.id code:text-is("${id}")`) });

async function open(id) {
  // By key: a page that grows or shrinks above the button between press and release takes no click.
  const opener = section(id).locator(".play-scene");
  if (await opener.getAttribute("aria-expanded") === "true") await opener.press("Enter");
  await opener.press("Enter");
  const viewer = section(id).locator(".carom-viewer");
  await viewer.locator(".cv-play").waitFor();
  await page.waitForFunction((e) => e.caromViewer && e.dataset.time !== undefined, await viewer.elementHandle());
  return viewer;
}

const time = async (viewer) => Number(await viewer.getAttribute("data-time"));
const values = (locator) => locator.evaluateAll((cells) => cells.map((cell) => Number(cell.dataset.value)));
const drawn = (viewer) => viewer.evaluate((e) => new Promise((done) => {
  e.caromViewer.show();
  requestAnimationFrame(() => requestAnimationFrame(done));
}));
const toEnd = async (viewer) => {
  await viewer.evaluate((e) => e.caromViewer.goTo(e.caromViewer.clock.duration));
  await drawn(viewer);
};

test("Report_PlaysEveryModeOfTheCourse_InBothLanguages", async () => {
  for (const { id } of scenes().filter((scene) => scene.id.startsWith("course/"))) {
    const viewer = await open(id);
    for (const [language, word] of [["de", "Was man sieht."], ["en", "What you see."]]) {
      await viewer.locator(".cv-language").selectOption(language);
      const told = await viewer.locator(".cv-mode").innerText();
      assert.ok(told.includes(word), `${id}: ${told}`);
      assert.equal(await viewer.locator(".cv-mode > p").count(), 3, id);
      assert.ok(await viewer.locator(".cv-mode math").count() >= 1, id);
      assert.equal(await viewer.getAttribute("lang"), language);
    }
    assert.equal(await viewer.locator(".cv-stage").getAttribute("data-painter"), "webgl2");
  }
});

test("Report_ShowsTheEnginesOwnNumbers_AtTheEnd", async () => {
  for (const id of ["impact/oblique", "friction/two-spinning-balls", "course/normal-mode"]) {
    const viewer = await open(id);
    const values_box = viewer.locator(".cv-panels details").nth(3);
    if (!await values_box.evaluate((e) => e.open)) await values_box.locator("summary").click();
    await toEnd(viewer);
    const scene = scenes().find((each) => each.id === id);
    const { final, collisions } = scene.runs.find((run) => run.engine === "carom");
    assert.deepEqual(await values(values_box.locator(".cv-impacts")), [collisions]);
    const rows = values_box.locator(".cv-scroll tbody tr");
    assert.equal(await rows.count(), final.length);
    const kinetic = [0, 0];
    for (let i = 0; i < final.length; i += 1) {
      const shown = await values(rows.nth(i).locator("td"));
      const told = [final[i].mass, final[i].radius, ...final[i].position.slice(0, 2), ...final[i].velocity.slice(0, 2)];
      told.forEach((value, k) => assert.ok(Math.abs(shown[k] - value) <= 1e-5 * Math.max(1, Math.abs(value)), `${id} ball ${i}: ${shown[k]} for ${value}`));
      kinetic[0] += 0.5 * final[i].mass * (final[i].velocity[0] ** 2 + final[i].velocity[1] ** 2);
    }
    const [translation] = await values(viewer.locator(".cv-energy-translation"));
    assert.ok(Math.abs(translation - kinetic[0]) <= 1e-12 * kinetic[0], `${translation} for ${kinetic[0]}`);
  }
});

test("Report_CountsTheBarrierAsTheEngineDoes", async () => {
  const viewer = await open("course/quantum-barrier");
  await toEnd(viewer);
  const { final } = scenes().find((scene) => scene.id === "course/quantum-barrier").runs[0];
  const passed = final.filter((ball) => ball.position[0] > 3).length;
  const told = await viewer.locator(".cv-counts").innerText();
  assert.ok(told.includes(`${passed} of 1000`) && told.includes("T = 0.41997"), told);
});

test("Report_TellsWhoTunnels_ThroughTheThinSlab", async () => {
  const viewer = await open("course/thin-slab");
  await viewer.locator(".cv-engine-a").selectOption("carom:step");
  await page.waitForFunction((e) => e.caromViewer.motions[0].about.label === "carom:step", await viewer.elementHandle());
  await toEnd(viewer);
  assert.match(await viewer.locator(".cv-counts").innerText(), /Beyond the slab: 1 of 1/);
});

test("Report_ObeysItsKeys", async () => {
  const viewer = await open("impact/oblique");
  const { duration, frames } = scenes().find((scene) => scene.id === "impact/oblique");
  const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
    await drawn(viewer);
  };
  const pressed = (name) => viewer.locator(`.cv-toggle-${name}`).getAttribute("aria-pressed");
  await viewer.locator("canvas.cv-canvas").focus();
  for (const [key, name] of [["3", "impulse"], ["v", "velocity"], ["q", "tree"], ["m", "momentum"], ["t", "trails"], ["e", "spin"]]) {
    assert.equal(await pressed(name), "false", name);
    await press(key);
    assert.equal(await pressed(name), "true", name);
  }
  assert.match(await viewer.locator(".cv-counts").innerText(), /Pair tests in this frame, as Carom counts them: 1 by brute force, 1 with its quadtree/);
  await press("ArrowRight", "ArrowRight");
  assert.ok(Math.abs(await time(viewer) - 2 * duration / frames) < 1e-9);
  await press("ArrowLeft");
  assert.ok(Math.abs(await time(viewer) - duration / frames) < 1e-9);
  // Centres 2 r = 0.2 m apart, offset 0.1 m: the ball flies 1 − √(0.04 − 0.01) = 0.8268 m at 1 m/s.
  await press("Shift+ArrowRight");
  const reach = 1 - Math.sqrt(0.03);
  assert.ok(Math.abs(await time(viewer) - reach) < 0.004, `${await time(viewer)}`);
  assert.match(await viewer.locator(".cv-live").innerText(), /balls 0 and 1 meet/);
  await press("ArrowDown", "ArrowDown");
  assert.equal(await viewer.locator(".cv-speed").inputValue(), "0.25");
  await press("Space");
  await page.waitForFunction(([e, t]) => Number(e.dataset.time) > t, [await viewer.elementHandle(), reach + 0.004]);
  await press("Space");
  assert.equal(await viewer.getAttribute("data-playing"), "false");
  await press("r");
  assert.equal(await time(viewer), 0);
  await press("h");
  assert.ok(await viewer.locator("dialog").evaluate((e) => e.open));
  await page.keyboard.press("Escape");
});

test("Report_HoldsTwoEnginesAgainstEachOther", async () => {
  const viewer = await open("impact/oblique");
  await viewer.locator(".cv-engine-b").selectOption("carom:step");
  await page.waitForFunction((e) => e.caromViewer.motions.length === 2, await viewer.elementHandle());
  await toEnd(viewer);
  const pair = scenes().find((scene) => scene.id === "impact/oblique").pairs[0];
  const told = await viewer.evaluate((e) => e.caromViewer.apartNow());
  assert.ok(Math.abs(told.most - pair.position) < 1e-5, `${told.most} for ${pair.position}`);
  for (const layout of ["beside", "over", "one"]) {
    await viewer.locator(".cv-layout").selectOption(layout);
    await drawn(viewer);
    assert.equal(await viewer.locator(".cv-name").count(), layout === "beside" ? 2 : 1);
  }
});

test("Report_SavesNumbersAndPictures", async () => {
  const viewer = await open("impact/oblique");
  const [csv] = await Promise.all([page.waitForEvent("download"), viewer.locator(".cv-csv").click()]);
  const lines = readFileSync(await csv.path(), "utf8").trim().split("\n");
  assert.equal(lines[0], "engine,time_s,ball,x_m,y_m,vx_mps,vy_mps");
  assert.equal(lines.length, 1 + 2 * 121);
  const last = lines.at(-1).split(",");
  const { final } = scenes().find((scene) => scene.id === "impact/oblique").runs[0];
  assert.ok(Math.abs(Number(last[3]) - final[1].position[0]) < 1e-5);
  const [png] = await Promise.all([page.waitForEvent("download"), viewer.locator(".cv-png").click()]);
  const bytes = readFileSync(await png.path());
  assert.equal(bytes.toString("latin1", 1, 4), "PNG");
  assert.ok(bytes.length > 2000, `${bytes.length}`);
});

test("Report_IsUsable_OnAPhone", async () => {
  await page.setViewportSize({ width: 390, height: 844 });
  const viewer = await open("friction/two-spinning-balls");
  const box = await viewer.boundingBox();
  assert.ok(box.x >= 0 && box.x + box.width <= 391, JSON.stringify(box));
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 391, `${wide}`);
  await page.setViewportSize({ width: 1200, height: 900 });
});

test("Report_DrawsOnAPlainCanvas_WhereThereIsNoWebGl", async () => {
  const plain = await browser.page();
  await plain.addInitScript(() => {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function getContext(kind, ...rest) {
      return kind.startsWith("webgl") ? null : get.call(this, kind, ...rest);
    };
  });
  await plain.goto(pathToFileURL(report.file).href);
  await plain.locator(".play-scene").first().click();
  const stage = plain.locator(".cv-stage");
  await stage.waitFor();
  assert.equal(await stage.getAttribute("data-painter"), "canvas");
  assert.match(await plain.locator(".cv-message").innerText(), /WebGL/);
  assert.deepEqual(plain.failures, []);
  await plain.close();
});

test("Report_AsksNoNetwork_AndFailsNowhere", () => {
  assert.deepEqual(page.failures, []);
  assert.deepEqual(page.asked.filter((address) => !/^(file|blob|data):/.test(address)), []);
});
