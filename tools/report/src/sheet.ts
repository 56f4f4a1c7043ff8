// The page of `rvelab sheet`: key numbers, then groups of numbers with their figures, then models.
import { buttons } from "./download";
import { csvOfFigure, drawFigure } from "./sheet_figure";
import type { Figure, Sheet } from "./sheet_data";
import type { Table } from "./data";
import { tableOf } from "./tables";
import "./style.css";
import "./sheet.css";

const sheet: Sheet = JSON.parse(document.getElementById("data")!.textContent!);
const element = (id: string) => document.getElementById(id)!;
const redraws: (() => void)[] = [];
let onPaper = false;  // while it is printed, two figures stand in a row

function add<Name extends keyof HTMLElementTagNameMap>(to: HTMLElement, name: Name, text = "", kind = "") {
  const made = document.createElement(name);
  made.textContent = text;
  if (kind) made.className = kind;
  to.append(made);
  return made;
}

/** Writes what follows an underscore behind a symbol as its index: "N_q". */
function setIndexed(place: HTMLElement, text: string) {
  place.replaceChildren(...text.split(/(?<=[A-Za-z\u0370-\u03ff])_([A-Za-z0-9\u0370-\u03ff]+(?:[.,][A-Za-z0-9]+)*)/).map((part, k) => {
    if (k % 2 === 0) return document.createTextNode(part);
    const index = document.createElement("sub");
    index.textContent = part;
    return index;
  }));
}

/** A table whose columns have symbols with an index. */
function symbolTable(rows: Table, columns: number[]): HTMLElement {
  const box = tableOf(rows);
  box.querySelectorAll("tr").forEach((line) => columns.forEach((column) => {
    const place = line.children[column];
    if (place instanceof HTMLElement) setIndexed(place, place.textContent ?? "");
  }));
  return box;
}

function addHeadline() {
  for (const each of sheet.headline) {
    const card = add(element("headline"), "div", "", "card");
    card.title = each.definition;
    setIndexed(add(card, "div", "", "label"), each.where ? `${each.label}, ${each.where}` : each.label);
    add(card, "div", each.value, "value");
    if (each.interval) add(card, "div", `95 % interval ${each.interval}`, "note");
    if (each.published) add(card, "div", `published ${each.published}`, "note");
  }
}

function addFigure(to: HTMLElement, figure: Figure) {
  const box = add(to, "figure", "", "sheet-figure");
  add(box, "h3", figure.title);
  const area = add(box, "div", "", "plot-area"), legend = add(box, "div", "", "legend");
  const foot = add(box, "figcaption");
  add(foot, "span", figure.caption);
  const draw = () => {
    const drawn = drawFigure(figure, onPaper ? 380 : Math.min(620, Math.max(280, area.clientWidth || 480)));
    area.innerHTML = drawn.svg;
    legend.replaceChildren(...drawn.legend.map(({ sample, label }) => {
      const line = document.createElement("span");
      line.innerHTML = `<svg class="sample" width="36" height="12" aria-hidden="true">${sample}</svg>`;
      line.append(label);
      return line;
    }));
    return drawn.whole;
  };
  foot.append(buttons(() => figure.key, () => csvOfFigure(figure), draw));
  redraws.push(() => void draw());
}

function addDetails(to: HTMLElement, title: string, rows: Table, columns: number[]) {
  if (rows.length < 2) return;
  const part = add(to, "details");
  add(part, "summary", title);
  part.append(symbolTable(rows, columns));
}

function addFigures(to: HTMLElement, figures: Figure[]) {
  if (!figures.length) return;
  const grid = add(to, "div", "", "figures");
  figures.forEach((figure) => addFigure(grid, figure));
}

function addGroups() {
  for (const group of sheet.groups) {
    const panel = add(element("groups"), "section");
    add(panel, "h2", group.name);
    const tables = add(panel, "div", "", "tables");
    if (group.list.length > 1) tables.append(symbolTable(group.list, [0]));
    group.matrices.forEach((rows) => tables.append(symbolTable(rows, [0])));
    addFigures(panel, group.figures);
    addDetails(panel, "Definitions, sources and tests", group.about, [0, 2]);
  }
  for (const model of sheet.models) {
    const panel = add(element("groups"), "section");
    add(panel, "h2", `Model: ${model.name}`);
    model.remarks.forEach((remark) => add(panel, "p", remark, "note"));
    const tables = add(panel, "div", "", "tables");
    tables.append(symbolTable(model.parameters, [0]), tableOf(model.misfits));
    addFigures(panel, model.figures);
  }
}

function redraw() { redraws.forEach((draw) => draw()); }

function begin() {
  element("title").textContent = sheet.title;
  element("about").textContent = `rvelab ${sheet.version}. Means over specimens \u00b1 standard error. Compression is positive.`;
  addHeadline();
  element("remarks-panel").hidden = !sheet.remarks.length;
  sheet.remarks.forEach((remark) => add(element("remarks"), "li", remark));
  addGroups();
  redraw();
  element("theme").addEventListener("click", () => {
    const dark = getComputedStyle(document.documentElement).getPropertyValue("--dark").trim() === "1";
    document.documentElement.dataset.theme = dark ? "light" : "dark";
    redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  let width = innerWidth;
  addEventListener("resize", () => { if (innerWidth !== width) { width = innerWidth; redraw(); } });
  addEventListener("beforeprint", () => {
    document.querySelectorAll("details").forEach((part) => { part.open = true; });
    onPaper = true;
    redraw();
  });
  addEventListener("afterprint", () => { onPaper = false; redraw(); });
  document.documentElement.dataset.ready = "1";
}

begin();
