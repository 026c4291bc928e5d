// A headless Chromium for the tests, closed when they end. Modules of npm stand where the build put them.

import { createRequire } from "node:module";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const require = createRequire(join(process.env.CAROM_NODE_DIR, "node_modules/"));
const { chromium } = require("playwright-core");

// A loaded machine draws with its processor, and slowly.
export const kPatience_ms = 60000;

export async function openBrowser() {
  const profile = mkdtempSync(join(tmpdir(), "carom-chromium-"));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.CAROM_CHROMIUM,
    viewport: { width: 1200, height: 900 },
    locale: "en-GB",
    acceptDownloads: true,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--disable-quic",
      "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
  context.setDefaultTimeout(kPatience_ms);
  return {
    context,
    /** A page that remembers what went wrong on it, and what it asked of a network. */
    async page() {
      const page = await context.newPage();
      page.failures = [];
      page.asked = [];
      page.on("pageerror", (error) => page.failures.push(String(error.stack)));
      page.on("console", (message) => { if (message.type() === "error") page.failures.push(message.text()); });
      page.on("request", (request) => page.asked.push(request.url()));
      return page;
    },
    async close() {
      await context.close();
      rmSync(profile, { recursive: true, force: true });
    },
  };
}
