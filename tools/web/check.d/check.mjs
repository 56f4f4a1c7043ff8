// The built page in Chromium: what it weighs, how fast it is beside the program, and visits. Run by tools/web/check.
//
//   node check.mjs dist/index.html PROGRAM FOLDER
//
// Prints one line a figure, its bar beside it; ends with 1 where a bar is missed or a visit fails. Pictures and files
// go into FOLDER.
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import { launch, open, pageMemory, serve } from "./browser.mjs";
import { fill, named, packAndTest, press, saved, text, words } from "./page.mjs";
import { visits } from "./visits.mjs";

const [page, program, folder] = process.argv.slice(2, 5).map((path) => resolve(path));
const scratch = join(folder, "saved");
mkdirSync(folder, { recursive: true });

let missed = 0;
function tell(what, value, unit, bar, holds) {
  if (!holds) ++missed;
  console.log(`${what.padEnd(62)} ${value} ${unit}${bar ? ` (${bar})` : ""}${holds ? "" : "  MISSED"}`);
}

/** Pack and biaxial of the usual set-up beside the same two files in the program, its kernel the one of SSE2. */
async function speed(browser, address) {
  const { tab, outside, errors } = await open(browser, address);
  await tab.bringToFront();
  const before = await tab.evaluate(() => window.pictureTimes.length);
  const seconds = await packAndTest(tab);
  const times = (await tab.evaluate(() => window.pictureTimes)).slice(before + 1);  // the first is of the packing
  const rate = (1000 * (times.length - 1)) / (times.at(-1) - times[0]);
  copyFileSync(await saved(browser, tab, words.files.soil, scratch), join(folder, "soil.toml"));
  copyFileSync(await saved(browser, tab, words.files.test, scratch), join(folder, "test.toml"));
  const begin = performance.now();
  const call = (...given) => execFileSync(program, given, { cwd: folder, env: { ...process.env, RVELAB_ISA: "baseline" }, stdio: "pipe" });
  call("pack", "soil.toml", "-o", "soil.h5", "--threads", "1", "--force");
  call("run", "test.toml", "--specimen", "soil.h5", "-o", "test.h5", "--force");
  const native = (performance.now() - begin) / 1e3;
  tell("pack and biaxial of 400 discs, page", seconds.toFixed(1), "s", "", true);
  tell("the same by the program with SSE2", native.toFixed(1), "s", "", true);
  tell("page / program", (seconds / native).toFixed(2), "", "bar 3", seconds <= 3 * native);
  tell("pictures a second while it runs", rate.toFixed(1), "", "bar 30", rate >= 30);
  tell("requests that leave the page", outside.length, "", "bar 0", outside.length === 0);
  if (errors.length) tell("errors in the console", errors.join("; "), "", "bar none", false);
  return tab;
}

/** Single steps on the pad by an arrow key, 400 discs: the longest of twenty answers. */
async function probe(tab) {
  const pad = await named(tab, "application", words.probePad);
  await pad.evaluate((element) => element.scrollIntoView({ block: "center" }));
  await pad.focus();
  const [head, tail] = words.probeAnswer(0, 0, 0).split("0 ms");
  if (tail !== "") throw new Error(`the answer of the pad does not end with its time: ${head}`);
  const times = [];
  for (let k = 0; k < 20; ++k) {
    await tab.evaluate(() => { document.querySelector("#answer").textContent = ""; });
    await tab.keyboard.press(k % 2 ? "ArrowUp" : "ArrowRight");
    times.push(Number((await text(tab, /answered in (\d+) ms/, 20))[1]));
  }
  times.sort((a, b) => a - b);
  tell("answer of the pad to a strain of 2e-4, median of 20", times[10], "ms", "bar 50", times[10] <= 50);
  tell("answer of the pad, longest", times[19], "ms", "bar 50", times[19] <= 50);
}

async function memory(browser, tab) {
  await fill(tab, words.fields.grains, 100);
  await fill(tab, words.fields.strain, 1);
  for (let k = 0; k < 20; ++k) await packAndTest(tab);
  const megabytes = await pageMemory(browser);
  tell("memory of the page after 20 tests", megabytes.toFixed(0), "MB", "bar 300", megabytes <= 300);
}

/** The link opened in a new browser shows and gives the same test. */
async function link(address) {
  const first = await launch();
  const { tab } = await open(first, address);
  await fill(tab, words.fields.grains, 100);
  await fill(tab, words.fields.friction, 21);
  await fill(tab, words.fields.strain, 1);
  await packAndTest(tab);
  const curve = readFileSync(await saved(first, tab, words.files.curve, scratch), "utf8");
  await press(tab, words.files.link);
  const linked = tab.url();
  await first.close();
  const second = await launch();
  const again = await open(second, linked);
  await packAndTest(again.tab);
  const same = readFileSync(await saved(second, again.tab, words.files.curve, scratch), "utf8") === curve;
  await second.close();
  tell("a closed tab opened again by its link: the same curve", same ? "yes" : "no", "", "", same && linked.includes("#"));
}

async function sizes(browser, address) {
  for (const [width, height, dark] of [[390, 844, false], [390, 844, true], [1280, 900, true], [2560, 1440, false]]) {
    const { tab } = await open(browser, address, { width, height }, dark);
    await tab.screenshot({ path: join(folder, `${width}${dark ? "_dark" : ""}.png`), fullPage: true });
    const beyond = await tab.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    tell(`${width} pixels${dark ? ", dark" : ""}: the page beyond the window`, Math.max(0, beyond), "pixels", "bar 0", beyond <= 0);
    await tab.close();
  }
}

const weight = gzipSync(readFileSync(page)).length / 1e6;
tell("first load, compressed by gzip", weight.toFixed(2), "MB", "bar 1", weight <= 1);
const server = await serve(page);
const browser = await launch();
try {
  const tab = await speed(browser, server.address);
  await probe(tab);
  await memory(browser, tab);
  await tab.close();
  await sizes(browser, server.address);
  await link(server.address);
  const places = { "sieve curve": pathToFileURL(page).href };  // one visit opens the page from a file
  for (const [name, visit] of Object.entries(visits)) {
    const address = places[name] ?? server.address;
    const told = await visit({ browser, address, folder, scratch, program }).catch((error) => error);
    tell(`visit: ${name}`, told instanceof Error ? told.message : told, "", "", !(told instanceof Error));
  }
  tell("what the server was asked for besides the page", server.other.length, "", "bar 0", server.other.length === 0);
} finally {
  await browser.close();
  server.close();
}
process.exit(missed > 0 ? 1 : 0);
