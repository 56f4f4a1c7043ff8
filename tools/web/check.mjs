// What tools/web/check does in the browser: five visits, and the figures of README.md.
import { mkdirSync, readdirSync, readFileSync, statSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import puppeteer from "puppeteer-core";

const [file, out, native] = process.argv.slice(2);
mkdirSync(out, { recursive: true });
const address = pathToFileURL(file).href;
const failures = [];
const expect = (held, what) => {
  console.log(`${held ? "ok  " : "FAIL"}  ${what}`);
  if (!held) failures.push(what);
};

const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const outside = [];
async function opened(fragment = "", width = 1400, height = 1000, dark = false) {
  const page = await browser.newPage();
  page.on("request", (request) => {
    if (!/^(file|blob|data):/.test(request.url())) outside.push(request.url());
  });
  page.on("pageerror", (error) => expect(false, `no error in the page: ${error.message}`));
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" }]);
  await page.setViewport({ width, height });
  const client = await page.createCDPSession();
  await client.send("Page.setDownloadBehavior", { behavior: "allow", downloadPath: out });
  await page.goto(address + fragment);
  return page;
}
const set = (page, values) =>
  page.evaluate((given) => {
    for (const [name, value] of Object.entries(given)) {
      const field = document.querySelector(`[name="${name}"]`);
      field.value = value;
      field.dispatchEvent(new Event("change", { bubbles: true }));
    }
  }, values);
const text = (page, id) => page.$eval(`#${id}`, (element) => element.textContent);
async function tested(page, values) {
  await set(page, values);
  const begin = Date.now();
  await page.click("form .first");
  await page.waitForFunction(() => !document.querySelector("form .first").disabled, { timeout: 240_000, polling: 50 });
  return (Date.now() - begin) / 1e3;
}
const picture = (page, name) => page.screenshot({ path: join(out, `${name}.png`), fullPage: true });

// 1. A sieve curve to a friction angle.
let page = await opened();
await tested(page, { preset: "hostun", grains: "200", pressures: "50, 100, 200", strain: "4" });
expect(/φ = \d/.test(await text(page, "strength")), `a sieve curve gives a friction angle: ${await text(page, "strength")}`);
await picture(page, "1_sieve");
const link = await page.evaluate(() => location.hash);
await page.close();

// A tab opened by its link shows the same set-up.
page = await opened(link);
const shown = await page.$$eval("form [name]", (fields) => Object.fromEntries(fields.map((each) => [each.name, each.value])));
expect(shown.preset === "hostun" && shown.pressures === "50, 100, 200" && shown.strain === "4", "its link opens the same set-up");
await page.close();

// 2. Two frictions, by going on from a kept state.
page = await opened("", 1400, 1000, true);
await tested(page, { strain: "4" });
await page.$eval("#friction", (slider) => {
  slider.value = "5";
  slider.dispatchEvent(new Event("input", { bubbles: true }));
});
await page.click("#fork");
await page.waitForFunction(() => !document.querySelector("#fork").disabled, { timeout: 120_000 });
expect((await page.$$("#key li")).length === 2, "the curve with less friction stands beside the first");

// The pad answers.
const pad = await page.$("#pad");
await pad.focus();
const times = [];
for (let k = 0; k < 12; ++k) {
  const before = await text(page, "answer");
  await page.keyboard.press("ArrowDown");
  await page.waitForFunction((was) => document.querySelector("#answer").textContent !== was, { timeout: 10_000 }, before);
  times.push(Number(/(\d+) ms/.exec(await text(page, "answer"))[1]));
}
times.sort((a, b) => a - b);
expect(times[6] < 50, `the pad answers in ${times[6]} ms (median of 12, 400 discs; bar 50)`);
await page.click("#envelopes");
await page.waitForSelector("#envelope polygon", { timeout: 30_000 });
await picture(page, "2_two_frictions_dark");

// 4. Export, and what the program makes of it.
await page.click('[data-file="specimen"]');
await page.click('[data-file="curve"]');
await new Promise((done) => setTimeout(done, 1500));
expect(readdirSync(out).includes("specimen.rvesnap") && statSync(join(out, "specimen.rvesnap")).size > 10_000, "the specimen is given");
expect(readFileSync(join(out, "curves.csv"), "utf8").split("\n").length > 200, "the curves are given");
await page.close();

// 3. Liquefaction on a small screen.
page = await opened("", 390, 844);
await tested(page, { preset: "loose", grains: "200", test: "undrained", strain: "2" });
expect((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, "390 pixels hold the page");
await picture(page, "3_undrained_390");
await page.close();

// 5. Wrong input.
page = await opened("", 2560, 1300);
await set(page, { friction: "95", pressures: "abc" });
await page.click("form .first");
expect((await page.$$("#mistakes li")).length === 2, "wrong input gets a sentence for each mistake");
await picture(page, "5_wrong_2560");
await page.close();

// Time and frames: dense discs to 15 %, as `rvelab pack pack_dense` and `rvelab run biaxial`.
page = await opened();
await page.evaluate(() => {
  const count = () => {
    window.ticks = (window.ticks ?? 0) + 1;
    requestAnimationFrame(count);
  };
  count();
});
await page.evaluate(() => (window.ticks = 0));
const seconds = await tested(page, { strain: "15" });
const frames = (await page.evaluate(() => window.ticks)) / seconds;
expect(frames >= 30, `${frames.toFixed(0)} frames a second while it runs (bar 30)`);
console.log(`time  pack and biaxial of 400 discs: ${seconds.toFixed(1)} s in the page${native ? `, ${native} s natively` : ""}`);
if (native) expect(seconds < 3 * Number(native), `within 3 times the native time: ${(seconds / Number(native)).toFixed(1)}`);
await picture(page, "6_biaxial");
for (let k = 0; k < 20; ++k) await tested(page, { grains: "100", strain: "1" });
const heap = (await page.metrics()).JSHeapUsedSize / 1e6;
expect(heap < 300, `${heap.toFixed(0)} MB of JavaScript heap in the page after 20 tests (bar 300; the worker's memory is beside it)`);
await page.close();
expect(outside.length === 0, `no request leaves the page (${outside.length} did)`);
const packed = gzipSync(readFileSync(file)).length / 1e3;
expect(packed < 1000, `${packed.toFixed(0)} kB packed (bar 1000)`);
await browser.close();
process.exit(failures.length > 0 ? 1 : 0);
