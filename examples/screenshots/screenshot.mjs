// Writes a picture of a page of eomgen, with Node and a headless Chromium:
//
//     node examples/screenshots/screenshot.mjs PAGE PICTURE.png [WIDTH HEIGHT SECONDS light|dark SELECTOR]
//
// WIDTH and HEIGHT are those of the window in px; HEIGHT 0 shows the entire page. SECONDS is the time from the opening
// of the page to the picture. SELECTOR is the CSS selector of the element at the upper edge of the picture.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";

const TIMEOUT_MS = 90000;
const BROWSERS = ["chromium", "chromium-browser", "google-chrome"];

const [page, picture, width = "960", height = "640", seconds = "3", colours = "light", selector = "body"] = process.argv.slice(2);
if (picture === undefined) {
  console.error("usage: screenshot.mjs PAGE PICTURE.png [WIDTH HEIGHT SECONDS light|dark SELECTOR]");
  process.exit(2);
}

/** Starts the first installed browser. */
async function start(profile) {
  const flags = ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe", `--user-data-dir=${profile}`];
  for (const browser of BROWSERS) {
    const child = spawn(browser, flags, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    const started = await new Promise((done) => {
      child.once("spawn", () => done(true));
      child.once("error", () => done(false));
    });
    if (started) return child;
  }
  throw new Error(`none of ${BROWSERS.join(", ")} is installed`);
}

/** Returns a function that sends a command of the DevTools protocol and returns its result. */
function connect(child, loaded) {
  const waiting = new Map();
  let text = "";
  child.stdio[4].on("data", (data) => {
    text += data;
    const messages = text.split("\0");
    text = messages.pop();
    for (const message of messages.map((each) => JSON.parse(each))) {
      if (message.method === "Page.loadEventFired") loaded();
      const [done, failed] = waiting.get(message.id) ?? [];
      if (message.error) failed?.(new Error(message.error.message));
      else done?.(message.result);
    }
  });
  let id = 0;
  return (method, params, sessionId) => {
    id += 1;
    child.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((...ends) => waiting.set(id, ends));
  };
}

/** Removes a folder to which a closed browser may still write for some time. */
async function remove(folder) {
  for (let attempt = 0; ; attempt += 1) {
    try {
      rmSync(folder, { recursive: true, force: true });
      return;
    } catch (error) {
      if (attempt === 20) throw error;
      await new Promise((done) => setTimeout(done, 200));
    }
  }
}

const profile = mkdtempSync(join(tmpdir(), "screenshot-"));
let child;
const limit = setTimeout(() => {
  child?.kill("SIGKILL");
  console.error("the browser took too long");
  process.exit(1);
}, TIMEOUT_MS);
try {
  child = await start(profile);
  let loaded;
  const open = new Promise((done) => {
    loaded = done;
  });
  const send = connect(child, () => loaded());
  const { targetId } = await send("Target.createTarget", { url: "about:blank" });
  const { sessionId } = await send("Target.attachToTarget", { targetId, flatten: true });
  const ask = (method, params = {}) => send(method, params, sessionId);
  await ask("Page.enable");
  const size = { width: Number(width), height: Number(height) || 900 };
  await ask("Emulation.setDeviceMetricsOverride", { ...size, deviceScaleFactor: 1, mobile: size.width < 600 });
  await ask("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: colours }] });
  await ask("Page.navigate", { url: `file://${resolve(page)}` });
  await open;
  await new Promise((done) => setTimeout(done, 1000 * Number(seconds)));
  const expression = `document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect().top + scrollY`;
  const { result } = await ask("Runtime.evaluate", { expression });
  const { cssContentSize } = await ask("Page.getLayoutMetrics");
  const top = selector === "body" ? 0 : result.value;
  const clip = { x: 0, y: top, width: size.width, height: Number(height) || cssContentSize.height - top, scale: 1 };
  const { data } = await ask("Page.captureScreenshot", { format: "png", clip, captureBeyondViewport: true });
  writeFileSync(picture, Buffer.from(data, "base64"));
} finally {
  clearTimeout(limit);
  if (child) {
    const ended = new Promise((done) => child.once("exit", done));
    child.kill("SIGKILL");
    await ended;
  }
  await remove(profile);
}
