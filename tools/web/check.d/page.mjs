// The page as a user meets it: fields and buttons by the names that a screen reader reads out.
import { mkdirSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { join } from "node:path";
import { transformWithEsbuild } from "vite";

const source = new URL("../src/words.ts", import.meta.url);
const script = (await transformWithEsbuild(readFileSync(source, "utf8"), "words.ts")).code;
/** The wording of the page, from its one file. */
export const { words } = await import(`data:text/javascript;base64,${Buffer.from(script).toString("base64")}`);

/** The element of a role and a name; an error after five seconds without it. */
export function named(tab, role, name) {
  return tab.waitForSelector(`::-p-aria([name=${JSON.stringify(name)}][role=${JSON.stringify(role)}])`, { timeout: 5000 });
}

/** Types a value over what a field holds. */
export async function fill(tab, name, value) {
  const field = await named(tab, "textbox", name).catch(() => named(tab, "spinbutton", name));
  await field.evaluate((input) => input.select());
  await tab.keyboard.press("Delete");
  await field.type(String(value));
  await tab.keyboard.press("Tab");
}

/** Chooses of a list by its text. */
export async function choose(tab, name, text) {
  const list = await named(tab, "combobox", name);
  const value = await list.evaluate((select, wanted) => [...select.options].find((o) => o.text === wanted)?.value, text);
  if (value === undefined) throw new Error(`the list "${name}" has no "${text}"`);
  await list.select(value);
}

/** Moves a slider whose name begins with `name`: what it stands at may follow. */
export async function slide(tab, name, value) {
  await tab.evaluate(
    (label, wanted) => {
      const found = [...document.querySelectorAll("input[type=range]")].find((input) => input.labels[0]?.innerText.startsWith(label));
      found.value = wanted;
      for (const kind of ["input", "change"]) found.dispatchEvent(new Event(kind, { bubbles: true }));
    },
    name,
    String(value),
  );
}

export async function press(tab, name) {
  const button = await named(tab, "button", name);
  await button.evaluate((element) => element.scrollIntoView({ block: "center" }));
  await button.click();
}

/** Waits until the page's text fits `pattern`; the match. */
export async function text(tab, pattern, seconds) {
  const handle = await tab.waitForFunction(
    (source) => new RegExp(source).exec(document.body.innerText)?.slice(0, 5),
    { timeout: 1000 * seconds, polling: 200 },
    pattern.source,
  );
  return handle.jsonValue();
}

/** Waits until a button can be pressed again. */
export function free(tab, name, seconds) {
  return tab.waitForFunction(
    (label) => [...document.querySelectorAll("button")].some((b) => b.textContent.trim() === label && !b.disabled),
    { timeout: 1000 * seconds, polling: 100 },
    name,
  );
}

/** Presses "Pack and test" and waits for the end; the seconds that the page tells. */
export async function packAndTest(tab, seconds = 600) {
  await press(tab, words.run);
  await free(tab, words.run, seconds);
  const told = await tab.$eval("[role=alert]", (element) => element.innerText.trim());
  if (told) throw new Error(`the page says: ${told}`);
  return Number((await text(tab, /\d+ tests? in ([\d.]+) s/, 5))[1]);
}

/** What a press of a button saves: name and path of the file in `folder`, which is emptied first. */
export async function saved(browser, tab, button, folder) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const session = await browser.target().createCDPSession();
  await session.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder });
  await press(tab, button);
  for (let tries = 0; tries < 100; ++tries) {
    const [name] = readdirSync(folder).filter((each) => !each.endsWith(".crdownload"));
    if (name) return join(folder, name);
    await new Promise((later) => setTimeout(later, 100));
  }
  throw new Error(`"${button}" saved no file within 10 s`);
}
