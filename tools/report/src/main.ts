// The page of `rvelab report`: one test is shown, its record is marked on all curves; charts, circles and tables of all
// tests of its name.
import { report, stateOf, type Section, type State, type Table } from "./data";
import { recordAt, type Way } from "./curves";
import { Chart, type Picked, type Shown } from "./chart";
import { buttons } from "./download";
import { loops } from "./loops";
import { mohr } from "./mohr";
import { rose } from "./rose";
import { Specimen } from "./specimen";
import { escaped } from "./svg_plot";
import { tableOf } from "./tables";
import "uplot/dist/uPlot.min.css";
import "./style.css";

const element = <Name extends keyof HTMLElementTagNameMap = "div">(id: string) => document.getElementById(id) as HTMLElementTagNameMap[Name];
const sectionChoice = element<"select">("section"), runChoice = element<"select">("run"), stageChoice = element<"select">("stage-choice");

let shown: Shown;
let charts: Chart[] = [];
let roseText = { svg: "", csv: "" }, mohrText = { svg: "", csv: "" }, loopsText = { svg: "", csv: "" };
let current: State | undefined;

// While the slider is dragged the rose waits.
let roseWaits = 0;
const specimen = new Specimen((record) => move(record), (state) => {
  current = state;
  clearTimeout(roseWaits);
  roseWaits = window.setTimeout(() => void drawRose(), 120);
});

function move(record: number, run = shown.run) {
  if (run !== shown.run) {
    runChoice.value = String(run);
    shown = { ...shown, run };
    specimen.choose(shown.section, shown.section.runs[run]);
    // Another line is the thick one now.
    shown = { ...shown, record };
    charts.forEach((chart) => chart.draw(shown));
  }
  shown = { ...shown, record };
  charts.forEach((chart) => chart.move(shown));
  void specimen.show(record);
}

function picked({ line, point }: Picked) {
  const run = line.runs.includes(shown.run) ? shown.run : line.runs[0];
  move(recordAt(shown.section, line, point, run, shown.stage), run);
}

function step(by: number) {
  const rows = shown.section.runs[shown.run].columns[0].values.length;
  move(Math.min(rows - 1, Math.max(0, shown.record + by)));
}

function addChart(x: string, y: string) {
  const chart = new Chart(charts.length, x, y, picked, step, (gone) => {
    charts = charts.filter((other) => other !== gone);
    gone.element.remove();
  });
  charts.push(chart);
  element("charts").append(chart.element);
  chart.draw(shown);
}

function redraw() {
  charts.forEach((chart) => chart.draw(shown));
  specimen.paint();
  drawMohr();
  drawLoops();
  void drawRose();
}

function fillTables(section: Section) {
  const box = element("tables");
  box.replaceChildren();
  const add = (title: string, open: boolean, rows?: Table, words?: string, text?: string) => {
    if (!(rows && rows.length > 1) && !words && !text) return;
    const part = document.createElement("details"), head = document.createElement("summary");
    part.open = open;
    head.textContent = title;
    part.append(head);
    if (words) { const line = document.createElement("p"); line.textContent = words; part.append(line); }
    if (rows && rows.length > 1) part.append(tableOf(rows));
    if (text) { const pre = document.createElement("pre"); pre.textContent = text; part.append(pre); }
    box.append(part);
  };
  const first = section.kinds.length > 1 ? section.differences : undefined;
  add("Results", true, section.means);
  add("Difference of the first two groups", true, first);
  add("Loops: shear modulus and damping", true, section.loops);
  add("Error of the stresses, and run time", true, section.errors, section.errors_in_words);
  add("What was asked", false, section.asked);
  add("Specimen of the first test", false, section.specimen);
  add("Protocol with every default", false, undefined, undefined, section.protocol);
}

function drawMohr() {
  const width = Math.min(760, Math.max(300, element("mohr").clientWidth || 640));
  const found = mohr(shown.section, width);
  element("mohr-panel").hidden = !found;
  if (!found) return;
  mohrText = found;
  element("mohr").innerHTML = found.svg;
  element("mohr-words").textContent = found.words.join(" ");
}

function drawLoops() {
  const found = loops(shown.section);
  element("loops-panel").hidden = !found;
  if (!found) return;
  loopsText = found;
  element("loops").innerHTML = found.svg;
}

async function drawRose() {
  const of = shown, pooled = element<"select">("rose-of").value === "kind";
  let states = current && current.contacts > 0 ? [current] : [];
  if (pooled) {
    const kind = of.section.runs[of.run].kind;
    states = await Promise.all(of.section.runs.filter((run) => run.kind === kind).map((run) => stateOf(of.section, run, run.states.states.length - 1)));
  }
  if (of.section !== shown.section) return;
  const name = pooled ? `${of.section.kinds[of.section.runs[of.run].kind].label}, end of ${states.length} tests` : of.section.runs[of.run].file;
  const found = states.length ? rose(states, escaped(name)) : undefined;
  element("rose-panel").hidden = !found;
  if (!found) return;
  roseText = found;
  element("rose").innerHTML = found.svg;
  element("rose-words").textContent = `${name}. ${found.words}`;
}

function choose(number: number) {
  const section = report.sections[number];
  const stages = [...new Set(section.runs.flatMap((run) => run.stage ?? []))].sort((a, b) => a - b);
  const all = section.curves[0]?.[0] !== "strain" || stages.length < 2;
  stageChoice.replaceChildren(new Option("all stages", "-1"), ...stages.map((stage) => new Option(section.stages?.[stage] ?? String(stage), String(stage))));
  stageChoice.value = all ? "-1" : String(section.last_stage);
  element("stage-box").hidden = stages.length < 2;
  runChoice.replaceChildren(...section.kinds.map((kind, k) => {
    const group = document.createElement("optgroup");
    group.label = kind.label;
    section.runs.forEach((run, m) => { if (run.kind === k) group.append(new Option(run.file, String(m))); });
    return group;
  }));
  runChoice.value = "0";
  element("run-box").hidden = section.runs.length < 2;
  element("way-box").hidden = section.runs.length < 2;
  const run = section.runs[0], states = run.states.states;
  shown = { section, run: 0, record: states[states.length - 1].record, stage: +stageChoice.value,
    way: element<"select">("way").value as Way, estimate: element<"input">("estimate").checked };
  element("estimate-box").hidden = !section.runs.some((one) => one.columns.some((column) => column.errors?.some((error) => error != null)));
  element("estimate-words").textContent = section.errors_in_words ?? "";
  charts.forEach((chart) => chart.element.remove());
  charts = [];
  current = undefined;
  specimen.choose(section, run);
  section.curves.forEach(([x, y]) => addChart(x, y));
  fillTables(section);
  element("specimen-head").textContent = section.kind === "mpm" ? "Material points" : "Specimen";
  drawMohr();
  drawLoops();
  move(shown.record);
}

function begin() {
  element("title").textContent = report.title;
  const count = (kind: string, word: string) => {
    const n = report.sections.filter((section) => section.kind === kind).reduce((sum, section) => sum + section.runs.length, 0);
    return n ? `${n} ${word}${n === 1 ? "" : "s"}, ` : "";
  };
  element("about").textContent = `${count("test", "test")}${count("mpm", "MPM run")}rvelab ${report.version}. Compression is positive.`;
  sectionChoice.replaceChildren(...report.sections.map((section, k) => new Option(section.name, String(k))));
  element("section-box").hidden = report.sections.length < 2;
  sectionChoice.addEventListener("change", () => choose(+sectionChoice.value));
  runChoice.addEventListener("change", () => {
    const run = shown.section.runs[+runChoice.value], states = run.states.states;
    move(states[states.length - 1].record, +runChoice.value);
  });
  stageChoice.addEventListener("change", () => { shown = { ...shown, stage: +stageChoice.value }; charts.forEach((chart) => chart.draw(shown)); });
  element("way").addEventListener("change", () => { shown = { ...shown, way: element<"select">("way").value as Way }; charts.forEach((chart) => chart.draw(shown)); });
  element("estimate").addEventListener("change", () => { shown = { ...shown, estimate: element<"input">("estimate").checked }; charts.forEach((chart) => chart.draw(shown)); });
  element("add-chart").addEventListener("click", () => addChart(...(charts[charts.length - 1]?.axes() ?? shown.section.curves[0])));
  element("rose-of").addEventListener("change", () => void drawRose());
  element("mohr-downloads").append(buttons(() => "mohr_circles", () => mohrText.csv, () => mohrText.svg));
  element("loops-downloads").append(buttons(() => "loops", () => loopsText.csv, () => loopsText.svg));
  element("rose-downloads").append(buttons(() => "contact_rose", () => roseText.csv, () => roseText.svg));
  element("theme").addEventListener("click", () => {
    const dark = getComputedStyle(document.documentElement).getPropertyValue("--dark").trim() === "1";
    document.documentElement.dataset.theme = dark ? "light" : "dark";
    redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; drawMohr(); drawLoops(); } });
  choose(0);
  document.documentElement.dataset.ready = "1";
}

begin();
