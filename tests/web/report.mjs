// A report made by the program, with the program's JSON of the same runs.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export function makeReport(scenes, engines) {
  const folder = mkdtempSync(join(tmpdir(), "carom-report-"));
  const args = ["run", ...scenes, ...engines.flatMap((name) => ["--engine", name]), "--report", folder, "--json", join(folder, "results.json"), "--all-balls", "--quiet"];
  try {
    execFileSync(process.env.CAROM_PROGRAM, args, { stdio: ["ignore", "ignore", "pipe"] });
  } catch (error) {
    // 1: a gate is violated, which is not asked here.
    if (error.status !== 1) throw error;
  }
  process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
  const file = join(folder, "index.html");
  return { file, page: readFileSync(file, "utf8"), results: JSON.parse(readFileSync(join(folder, "results.json"), "utf8")) };
}

/** The playback of a scene that stands in the page. */
export function playbackOf({ page }, id) {
  for (const [, text] of page.matchAll(/<script class="playback"[^>]*>(.*?)<\/script>/gs)) {
    const json = JSON.parse(text);
    if (json.scene.id === id) return json;
  }
  throw new Error(`no playback of ${id}`);
}
