// Chromium without a window, what it asks of the network, and the processes that a page takes.
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import puppeteer from "puppeteer-core";

const program = process.env.CHROMIUM ?? "/usr/bin/chromium";

/** A browser that draws without a graphics card. Closing it frees its folder. */
export function launch() {
  return puppeteer.launch({
    executablePath: program,
    headless: true,
    protocolTimeout: 1_800_000,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage"],
  });
}

/** A static web server that knows the one file; `gone` counts what else it is asked for. */
export async function serve(file) {
  const page = readFileSync(file);
  const other = [];
  const server = createServer((request, response) => {
    const path = new URL(request.url, "http://page").pathname;
    if (path === "/" || path === "/index.html") {
      response.writeHead(200, { "content-type": "text/html; charset=utf-8" }).end(page);
    } else {
      if (path !== "/favicon.ico") other.push(path);  // the browser asks for it, not the page
      response.writeHead(404).end();
    }
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return { address: `http://127.0.0.1:${server.address().port}/`, other, close: () => server.close() };
}

/** A tab with the page. Requests other than the page itself and what it made itself (data:, blob:) are in `outside`;
 *  errors of the page and of its console in `errors`. Pictures are counted where the canvas is cleared. */
export async function open(browser, address, size = { width: 1280, height: 900 }, dark = false) {
  const tab = await browser.newPage();
  const outside = [], errors = [];
  tab.on("request", (request) => {
    const url = request.url();
    if (/^(data|blob):/.test(url) || url.split("#")[0] === address.split("#")[0] || url.endsWith("/favicon.ico")) return;
    outside.push(url);
  });
  tab.on("pageerror", (error) => errors.push(String(error)));
  tab.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  await tab.setViewport(size);
  await tab.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  await tab.evaluateOnNewDocument(() => {
    window.pictureTimes = [];  // ms
    const clear = WebGL2RenderingContext.prototype.clear;
    WebGL2RenderingContext.prototype.clear = function (mask) {
      window.pictureTimes.push(performance.now());
      clear.call(this, mask);
    };
  });
  await tab.goto(address);
  return { tab, outside, errors };
}

/** Memory of the pages' processes that no other process shares, MB: script, WebAssembly and pictures. */
export async function pageMemory(browser) {
  const session = await browser.target().createCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  await session.detach();
  let kilobytes = 0;
  for (const { type, id } of processInfo) {
    if (type !== "renderer") continue;
    const text = readFileSync(`/proc/${id}/smaps_rollup`, "utf8");
    for (const [, size] of text.matchAll(/^Private_\w+:\s+(\d+) kB/gm)) kilobytes += Number(size);
  }
  return kilobytes / 1024;
}
