// Visits as a new user makes them. Each gives what it found in one line and a picture; a claim that does not hold
// is an error with what was found.
import { execFileSync } from "node:child_process";
import { copyFileSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { open } from "./browser.mjs";
import { choose, fill, free, packAndTest, press, saved, slide, text, words } from "./page.mjs";

function claim(holds, sentence) {
  if (!holds) throw new Error(sentence);
}

async function picture(tab, folder, name) {
  await tab.screenshot({ path: join(folder, `${name}.png`), fullPage: true });
}

/** The rows of the CSV that the page saves: {column: value}. */
function rowsOf(csv) {
  const [head, ...lines] = readFileSync(csv, "utf8").trim().split("\n");
  const names = head.split(",");
  return lines.map((line) => Object.fromEntries(line.match(/("[^"]*"|[^,]+)/g).map((value, k) => [names[k], value])));
}

const angle = /φ = ([\d.]+)°(?: ± ([\d.]+)°)?, N_q = ([\d.]+)/;

/** A sieve curve, three pressures: a friction angle with its error. */
async function sieveCurve({ browser, address, folder }) {
  const { tab } = await open(browser, address);
  await choose(tab, words.grading, words.gradings.sieve);
  await fill(tab, words.fields.sieve10, 0.2);
  await fill(tab, words.fields.sieve50, 0.3);
  await fill(tab, words.fields.sieve60, 0.33);
  await fill(tab, words.fields.voidRatio, "");
  await fill(tab, words.fields.grains, 200);
  await fill(tab, words.fields.pressures, "50, 100, 200");
  await fill(tab, words.fields.strain, 4);
  await packAndTest(tab);
  const [, phi, error, nq] = await text(tab, angle, 10);
  const legend = await tab.$$eval("#key li", (items) => items.map((item) => item.innerText.trim()).join(", "));
  claim(legend === "50 kPa, 100 kPa, 200 kPa", `the legend has the tests in the order ${legend}`);
  await picture(tab, folder, "1_sieve_curve");
  await tab.close();
  claim(phi > 10 && phi < 40, `a friction angle of ${phi} degrees of discs`);
  claim(error !== undefined && Number(error) < 10, `an error of ${error} degrees of three tests`);
  const expected = Math.exp(Math.PI * Math.tan((phi * Math.PI) / 180)) * Math.tan(Math.PI / 4 + (phi * Math.PI) / 360) ** 2;
  claim(Math.abs(nq / expected - 1) < 0.02, `N_q ${nq}, of ${phi} degrees it is ${expected.toFixed(1)}`);
  return `friction angle ${phi} +- ${error} degrees, N_q ${nq}`;
}

/** The same test gone on from a kept state with grains that hardly rub: it carries less. */
async function twoFrictions({ browser, address, folder, scratch }) {
  const { tab } = await open(browser, address);
  await fill(tab, words.fields.grains, 200);
  await fill(tab, words.fields.strain, 4);
  await packAndTest(tab);
  await slide(tab, words.fields.whatIf, 5);
  await press(tab, words.whatIfRun);
  await free(tab, words.whatIfRun, 120);
  await picture(tab, folder, "2_two_frictions");
  const rows = rowsOf(await saved(browser, tab, words.files.curve, scratch));
  await tab.close();
  const tests = [...new Set(rows.map((row) => row.test))];
  claim(tests.length === 2, `curves of ${tests.length} tests, wanted the first and what goes on from it`);
  const [first, other] = tests.map((test) => Number(rows.filter((row) => row.test === test).at(-1).q_Pa));
  claim(other < 0.8 * first, `q ${other} Pa with 5 degrees between grains, ${first} Pa with 23`);
  return `q at the end ${(first / 1e3).toFixed(1)} kPa, gone on with 5 degrees ${(other / 1e3).toFixed(1)} kPa`;
}

/** Packs, tests and takes the picture; the friction angle that the page tells, degrees. */
async function testedAngle(tab, folder, name) {
  await packAndTest(tab);
  const [, phi] = await text(tab, angle, 10);
  await picture(tab, folder, name);
  return phi;
}

/** Dense discs at constant volume: their largest stress ratio is about that of drained tests, whatever the deviator does. */
async function dense({ browser, address, folder }) {
  const { tab } = await open(browser, address);
  await choose(tab, words.fields.test, words.tests.undrained);
  await fill(tab, words.fields.grains, 200);
  await fill(tab, words.fields.strain, 4);
  const phi = await testedAngle(tab, folder, "8_dense_undrained");
  await tab.close();
  claim(phi > 15 && phi < 45, `a friction angle of ${phi} degrees at constant volume`);
  return `friction angle ${phi} degrees`;
}

/** Loose discs at constant volume lose their mean stress. */
async function liquefaction({ browser, address, folder, scratch }) {
  const { tab } = await open(browser, address);
  await choose(tab, words.fields.preset, "Loose discs");
  await choose(tab, words.fields.test, words.tests.undrained);
  await fill(tab, words.fields.strain, 4);
  await packAndTest(tab);
  await picture(tab, folder, "3_liquefaction");
  const told = await tab.evaluate(() => document.querySelector("#status").textContent);
  const rows = rowsOf(await saved(browser, tab, words.files.curve, scratch));
  await tab.close();
  const p = rows.filter((row) => row.stage === rows.at(-1).stage).map((row) => Number(row.p_Pa));
  const least = Math.min(...p);
  claim(least < 0.8 * p[0], `p falls from ${p[0]} to ${least} Pa only`);
  claim(told.includes("liquefied") === least < 1e-3 * p[0], `p falls from ${p[0]} to ${least} Pa, and the page says: ${told}`);
  return `p from ${(p[0] / 1e3).toFixed(1)} to at least ${(least / 1e3).toFixed(2)} kPa`;
}

/** What the page saves is what the program reads. Packed and tested by the program from the two TOML files, or imported
 *  as the page left it: a test that goes on gives the same bits. */
async function exported({ browser, address, folder, scratch, program }) {
  const { tab } = await open(browser, address);
  await fill(tab, words.fields.grains, 200);
  await fill(tab, words.fields.strain, 2);
  await packAndTest(tab);
  await picture(tab, folder, "4_export");
  for (const [button, name] of [["specimen", "page.rvesnap"], ["soil", "soil.toml"], ["test", "test.toml"]])
    copyFileSync(await saved(browser, tab, words.files[button], scratch), join(folder, name));
  await tab.close();
  const call = (line) => execFileSync(program, line.split(" "), { cwd: folder, encoding: "utf8", stdio: "pipe" });
  call("pack soil.toml -o packed.h5 --force");
  call("run test.toml --specimen packed.h5 -o program.h5 --force");
  call("import page.rvesnap -o page.h5 --force");
  for (const from of ["program", "page"]) call(`run test.toml --specimen ${from}.h5 -o on_from_${from}.h5 --force`);
  call("compare on_from_program.h5 on_from_page.h5");
  return "the program goes on from page.rvesnap to the same bits as from its own test";
}

/** Ellipses laid with their long axes near x, and spheres in space: a friction angle of either. */
async function ellipses({ browser, address, folder }) {
  const { tab } = await open(browser, address);
  await choose(tab, words.fields.preset, "Bedded ellipses");
  await fill(tab, words.fields.grains, 200);
  await fill(tab, words.fields.strain, 4);
  const phi = await testedAngle(tab, folder, "6_ellipses");
  await tab.close();
  claim(phi > 15 && phi < 50, `a friction angle of ${phi} degrees of ellipses`);
  return `friction angle ${phi} degrees`;
}

async function spheres({ browser, address, folder, scratch }) {
  const { tab } = await open(browser, address, { width: 1280, height: 900 }, true);
  await choose(tab, words.fields.preset, "Glass spheres");
  await fill(tab, words.fields.grains, 300);
  await fill(tab, words.fields.strain, 4);
  const phi = await testedAngle(tab, folder, "7_spheres");
  const rows = rowsOf(await saved(browser, tab, words.files.curve, scratch));
  await tab.close();
  claim(phi > 15 && phi < 45, `a friction angle of ${phi} degrees of spheres`);
  const [xx, zz] = ["xx", "zz"].map((name) => Number(rows.at(-1)[`sigma_${name}_Pa`]));
  claim(zz < xx && xx < 0, `sigma_xx ${xx} and sigma_zz ${zz} Pa at the end of a compression along z`);
  return `friction angle ${phi} degrees`;
}

/** A wrong number is told with its field, and nothing runs; so is a link that is none. */
async function wrongInput({ browser, address, folder }) {
  const { tab } = await open(browser, address);
  await fill(tab, words.fields.grains, 5);
  await press(tab, words.run);
  const told = await text(tab, /Grains: give a number from \d+ to \d+/, 5);
  await picture(tab, folder, "5_wrong_input");
  await tab.close();
  const damaged = await open(browser, `${address}#%7Bdamaged`);
  await text(damaged.tab, new RegExp(words.oldLink.slice(0, 30)), 5);
  await damaged.tab.close();
  return told[0];
}

export const visits = {
  "sieve curve": sieveCurve,
  "two frictions": twoFrictions,
  "dense, constant volume": dense,
  liquefaction,
  export: exported,
  ellipses,
  spheres,
  "wrong input": wrongInput,
};
