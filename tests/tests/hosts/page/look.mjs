// Opens a page in an offline headless browser, runs a probe in it and prints the result of the probe
// and all errors of the page and the browser. Controls the browser by the DevTools protocol over
// pipes.
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";

const [browser, page, probe, profile, look] = process.argv.slice(2);
const { width, dark, still, scripts } = JSON.parse(look);
const flags = ["--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", `--user-data-dir=${profile}`];
const child = spawn(browser, flags, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
const [to, from] = [child.stdio[3], child.stdio[4]];
const waiting = new Map();
const errors = [];
let [sent, text, loaded] = [0, "", undefined];

function receive(message) {
  const { id, method, params, result, error } = message;
  if (id !== undefined) {
    const [done, failed] = waiting.get(id);
    if (error) failed(new Error(error.message));
    else done(result);
  }
  if (method === "Page.loadEventFired") loaded();
  if (method === "Runtime.exceptionThrown") errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
  if (method === "Log.entryAdded" && params.entry.level === "error") errors.push(params.entry.text);
  if (method === "Runtime.consoleAPICalled" && params.type === "error") errors.push(JSON.stringify(params.args));
  if (method === "Network.requestWillBeSent" && !/^(file|data):/.test(params.request.url)) errors.push(params.request.url);
}

from.on("data", (data) => {
  text += data;
  const messages = text.split("\0");
  text = messages.pop();
  for (const message of messages) receive(JSON.parse(message));
});

function send(method, params = {}, sessionId = undefined) {
  sent += 1;
  const id = sent;
  to.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
  return new Promise((done, failed) => waiting.set(id, [done, failed]));
}

const limit = setTimeout(() => {
  child.kill("SIGKILL");
  console.error("the browser took too long");
  process.exit(1);
}, 90000);
try {
  const { targetId } = await send("Target.createTarget", { url: "about:blank" });
  const { sessionId } = await send("Target.attachToTarget", { targetId, flatten: true });
  const ask = (method, params) => send(method, params, sessionId);
  for (const domain of ["Page", "Runtime", "Log", "Network"]) await ask(`${domain}.enable`);
  await ask("Network.emulateNetworkConditions", { offline: true, latency: 0, downloadThroughput: 0, uploadThroughput: 0 });
  await ask("Emulation.setDeviceMetricsOverride", { width, height: 900, deviceScaleFactor: 1, mobile: width < 600 });
  const features = [
    { name: "prefers-color-scheme", value: dark ? "dark" : "light" },
    { name: "prefers-reduced-motion", value: still ? "reduce" : "no-preference" },
  ];
  await ask("Emulation.setEmulatedMedia", { features });
  if (!scripts) await ask("Emulation.setScriptExecutionDisabled", { value: true });
  const open = new Promise((done) => {
    loaded = done;
  });
  await ask("Page.navigate", { url: `file://${page}` });
  await open;
  const expression = readFileSync(probe, "utf8");
  const { result, exceptionDetails } = await ask("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
  if (exceptionDetails) errors.push(exceptionDetails.exception?.description ?? exceptionDetails.text);
  console.log(JSON.stringify({ ...result.value, errors }));
} finally {
  clearTimeout(limit);
  child.kill();
}
