/** The page: a form, workers that pack and test, and what is drawn from their answers. */
import "./style.css";
import { Client, Stopped } from "./client";
import { colours, CurveView, type Curve } from "./curves";
import { csvOf, give } from "./files";
import { formOf, SetUpForm } from "./form";
import { GrainView } from "./grains";
import { column, grainColumns, type Packed, type Picture, type Strength, type Tested } from "./messages";
import { drawCircles, type Circle } from "./mohr";
import { drawEnvelope, ProbePad } from "./probe";
import { seldom } from "./seldom";
import { dimensionOf, fragmentOf, fromFragment, mistakes, protocolOf, recipeOf, usual, type SetUp } from "./setup";
import { words } from "./words";

const f = words.fields;
document.title = words.title;
document.querySelector("#page")!.innerHTML = `
  <header><h1>${words.title}</h1><p>${words.intro}</p></header>
  <main>${formOf()}
    <section><h2>${words.grainsTitle}</h2><canvas id="grains" role="img" aria-label="${words.grainsNone}"></canvas>
      <p class="soft" id="state">${words.grainsNone}</p><small id="seen">${words.grainsText}</small></section>
    <section><h2>${words.curve}</h2><div class="curve" id="curve"></div><ul class="key" id="key"></ul></section>
    <section><h2>${words.mohr}</h2><div id="mohr">${words.mohrNone}</div><p class="strength" id="strength"></p><small id="scatter"></small></section>
    <section id="whatif"><h2>${words.whatIf}</h2><p class="soft">${words.whatIfText}</p>
      <label for="from">${f.from} <output id="fromstrain"></output><input id="from" type="range" min="0" max="0" value="0" disabled></label>
      <label for="friction">${f.whatIf} <output id="angle">10°</output><input id="friction" type="range" min="0" max="45" value="10" disabled></label>
      <button id="fork" type="button" disabled>${words.whatIfRun}</button></section>
    <section><h2>${words.probe}</h2><p class="soft">${words.probeText}</p>
      <div class="pads"><div class="pad" id="pad" tabindex="0" role="application"></div><div class="envelope" id="envelope"></div></div>
      <p id="answer" role="status"></p><button id="envelopes" type="button" disabled>${words.envelope}</button>
      <small>${words.envelopeText}</small></section>
    <section><h2>${words.export}</h2><div class="buttons">${Object.entries(words.files)
      .map(([key, name]) => `<button type="button" data-file="${key}" ${key === "link" ? "" : "disabled"}>${name}</button>`)
      .join("")}</div><p class="soft" id="told" role="status"></p><small>${words.specimenText}</small></section>
    <section><h2>${words.teach}</h2><dl>${words.lessons.map(([name, text]) => `<dt>${name}</dt><dd>${text}</dd>`).join("")}</dl></section>
  </main>`;

const part = <E extends Element = HTMLElement>(id: string) => document.querySelector<E>(`#${id}`)!;
const status = (text: string) => void (part("status").textContent = text);
const wrong = (sentences: string[]) => {
  const list = document.createElement("ul");
  list.append(...sentences.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  part("mistakes").replaceChildren(...(sentences.length > 0 ? [words.wrong, list] : []));
};
const grains = new GrainView(part<HTMLCanvasElement>("grains"));
const curveView = new CurveView(part("curve"));
const pad = new ProbePad(part("pad"));
const form = new SetUpForm(document.querySelector("form")!, () => wrong([]));

let setUp: SetUp = usual();
let curves: Curve[] = [];
/** The circle of failure of each test, in the order of the tests; null of one that has none (yet). */
let circles: (Circle | null)[] = [];
let resolved = { recipe: "", protocol: "" };
let liquefied = 0; // tests of this run that ended without pressure
/** The laboratory whose grains are shown; it stays for what comes after a test. */
let shown: Client | null = null;
let others: Client[] = [];
/** Made while the page is read: its WebAssembly is compiled by the time that a test begins. */
let spare: Client | null = new Client();
let running = false;
let picture: Picture | null = null;

const tellState = seldom(300, () => {
  if (picture === null) return;
  const text = words.grainsLabel(picture.grains.length / grainColumns, picture.void_ratio, picture.coordination);
  part("state").textContent = text;
  part("grains").setAttribute("aria-label", text);
});

function show(next: Picture, moving = false) {
  if (next.dimension !== picture?.dimension) {
    part("seen").textContent = next.dimension === 3 ? words.spheresText : words.grainsText;
    part("grains").classList.toggle("turns", next.dimension === 3);
  }
  grains.show((picture = next), moving);
  tellState();
}

function curveOf(name: string, dashed: boolean): Curve {
  return { name, dashed, colour: colours[curves.length % colours.length], rows: [] };
}

/** Their names, once they are known, and what they hold so far. */
function showCurves() {
  curveView.show(setUp.test, curves);
  const names = curves.map(
    ({ name, dashed, colour }) => `<li><i class="${dashed ? "dashed" : ""}" style="color:${colour}"></i>${name}</li>`,
  );
  if (part("key").innerHTML !== names.join("")) part("key").innerHTML = names.join("");
}

function allow(yes: boolean) {
  running = !yes;
  part<HTMLButtonElement>("stop").disabled = yes;
  document.querySelector<HTMLButtonElement>("form .first")!.disabled = !yes;
  const after = yes && shown !== null;
  for (const id of ["from", "friction", "fork", "envelopes"]) part<HTMLInputElement>(id).disabled = !after;
  for (const button of document.querySelectorAll<HTMLButtonElement>("[data-file]"))
    if (button.dataset.file !== "link") button.disabled = !after;
  pad.use(after ? shown : null);
}

/** Asked of a laboratory at rest: one that tests would answer only at its end. */
async function showStrength(client: Client) {
  if (setUp.test === "isotropic") return;
  const found = circles.filter((circle) => circle !== null);
  const usable = found.filter(({ s, t }) => Number.isFinite(s / t));
  if (usable.length === 0) return void (part("scatter").textContent = found.length > 0 ? words.tooShort : "");
  const { friction_angle, standard_error, Nq } = await client.ask<Strength>({
    do: "strength",
    circles: usable.flatMap(({ s, t }) => [s, t]),
  });
  drawCircles(part("mohr"), usable, friction_angle);
  part("strength").textContent = words.strength(friction_angle, standard_error, Nq);
  part("scatter").textContent = usable.length > 1 ? words.scatter(usable.length) : words.oneTest;
}

interface Job {
  number: number;
  pressure: number;
  seed: number;
}

/** One test from its packing to its end, in a laboratory of its own. */
async function oneTest(client: Client, { number, seed, pressure }: Job, watched: boolean) {
  const curve = curves[number];
  const packed = await client.ask<Packed>({ do: "pack", recipe: recipeOf(setUp, seed, pressure) }, (note) => {
    if (watched && "draw" in note) status(words.packing(note.draw, note.voidRatio));
  });
  if (watched) show(await client.ask<Picture>({ do: "picture" }), true);
  const tested = await client.ask<Tested>({ do: "run", protocol: protocolOf(setUp, pressure), forks: 10 }, (note) => {
    if ("picture" in note && watched) show(note.picture, true);
    if (!("rows" in note)) return;
    curve.rows.push(...note.rows);
    showCurves();
  });
  const last = curve.rows[curve.rows.length - 1];
  if (setUp.test === "undrained" && last && last[column.p] < 2 * pressure) liquefied += 1; // Pa of kPa: a thousandth ends it
  if (watched) resolved = { recipe: packed.recipe, protocol: tested.protocol ?? "" };
  circles[number] = { s: tested.peak_s / 1e3, t: tested.peak_t / 1e3, colour: curve.colour };
}

async function runAll() {
  const found = mistakes((setUp = form.read()));
  wrong(found);
  if (found.length > 0) return;
  endAll();
  [curves, circles] = [[], []];
  drawCircles(part("mohr"), [], 0);
  part("strength").textContent = part("scatter").textContent = "";
  history.replaceState(null, "", fragmentOf(setUp));
  const jobs: Job[] = setUp.pressures
    .flatMap((pressure) => Array.from({ length: setUp.seeds }, (_, k) => ({ pressure, seed: k + 1 })))
    .map((job, number) => ({ ...job, number }));
  for (const { pressure, seed } of jobs)
    curves.push(curveOf(`${pressure} kPa${setUp.seeds > 1 ? `, seed ${seed}` : ""}`, false));
  showCurves();
  const all = jobs.length;
  const begin = performance.now();
  liquefied = 0;
  [shown, spare] = [spare ?? new Client(), null];
  others = Array.from({ length: Math.min(all - 1, Math.max(1, (navigator.hardwareConcurrency || 2) - 1), 7) }, () => new Client());
  allow(false);
  const work = async (client: Client) => {
    for (let job = jobs.shift(); job; job = jobs.shift()) {
      await oneTest(client, job, client === shown);
      status(words.testing(circles.filter(Boolean).length, all));
      await showStrength(client);
    }
  };
  try {
    await Promise.all([shown, ...others].map(work));
    status(words.done(all, (performance.now() - begin) / 1e3, liquefied));
    await afterTest();
  } catch (error) {
    if (!(error instanceof Stopped)) wrong([(error as Error).message]);
    status(words.stopped);
    endAll();
  }
  for (const client of others) client.end();
  others = [];
  allow(true);
}

/** States to go on from, and the picture of the end. */
async function afterTest() {
  if (shown === null) return;
  show(await shown.ask<Picture>({ do: "picture" }));
  const { kept } = await shown.ask<{ kept: Float64Array }>({ do: "kept" });
  const slider = part<HTMLInputElement>("from");
  slider.max = String(Math.max(0, kept.length - 1));
  slider.value = String(Math.floor((kept.length - 1) / 3));
  const tell = () => void (part("fromstrain").textContent = `${(100 * (kept[Number(slider.value)] ?? 0)).toFixed(2)} %`);
  slider.oninput = tell;
  tell();
}

async function goOn() {
  if (shown === null || running) return;
  const angle = Number(part<HTMLInputElement>("friction").value);
  const curve = curveOf(`${angle}° from ${part("fromstrain").textContent}`, true);
  curves.push(curve);
  allow(false);
  try {
    const from = Number(part<HTMLInputElement>("from").value);
    await shown.ask<Tested>({ do: "fork", from, friction: Math.tan((angle * Math.PI) / 180) }, (note) => {
      if ("picture" in note) show(note.picture, true);
      if (!("rows" in note)) return;
      curve.rows.push(...note.rows);
      showCurves();
    });
    show(await shown.ask<Picture>({ do: "picture" }));
  } catch (error) {
    if (!(error instanceof Stopped)) wrong([(error as Error).message]);
  }
  allow(true);
}

function endAll() {
  for (const client of [shown, ...others]) client?.end();
  [shown, others] = [null, []];
}

async function giveFile(kind: string) {
  if (kind === "link") {
    const address = location.href.replace(/#.*/, "") + fragmentOf(form.read());
    history.replaceState(null, "", fragmentOf(form.read()));
    await navigator.clipboard?.writeText(address).catch(() => undefined);
    part("told").textContent = words.copied;
  }
  if (kind === "test") give("test.toml", resolved.protocol, "application/toml");
  if (kind === "soil") give("soil.toml", resolved.recipe, "application/toml");
  if (kind === "curve") give("curves.csv", csvOf(curves, dimensionOf(setUp)), "text/csv");
  if (kind === "picture") grains.save((file) => give("grains.png", file, "image/png"));
  if (kind === "specimen" && shown !== null) {
    const { bytes } = await shown.ask<{ bytes: Uint8Array<ArrayBuffer> }>({ do: "save" });
    give("specimen.rvesnap", bytes, "application/octet-stream");
  }
}

document.querySelector("form")!.addEventListener("submit", (event) => {
  event.preventDefault();
  void runAll();
});
part("stop").addEventListener("click", endAll);
part("fork").addEventListener("click", () => void goOn());
part<HTMLInputElement>("friction").addEventListener("input", (event) => {
  part("angle").textContent = `${(event.target as HTMLInputElement).value}°`;
});
part("envelopes").addEventListener("click", async () => {
  if (shown === null) return;
  try {
    const { changes } = await shown.ask<{ changes: Float64Array }>({ do: "envelope", length: 1e-4, count: 24 });
    drawEnvelope(part("envelope"), changes);
  } catch (error) {
    wrong([(error as Error).message]);
  }
});
for (const button of document.querySelectorAll<HTMLButtonElement>("[data-file]"))
  button.addEventListener("click", () => void giveFile(button.dataset.file!));
pad.onAnswer = (xx, yy, ms) => {
  part("answer").textContent = words.probeAnswer(xx, yy, ms);
  void shown?.ask<Picture>({ do: "picture" }).then(show, () => undefined);
};
pad.onError = (error) => wrong([(error as Error).message]);

const linked = location.hash.length > 1 ? fromFragment(location.hash) : null;
if (location.hash.length > 1 && linked === null) wrong([words.oldLink]);
form.fill(linked ?? usual());
showCurves();
