// A chart: axes, zoom and ticks by uPlot; lines, bands and error bars of curves.ts; a mark at the record that is shown.
import uPlot from "uplot";
import { columnOf, shown, shownWithError, withUnit, type Section } from "./data";
import { linesOf, type Line, type Way } from "./curves";
import { buttons, csvOf } from "./download";
import { faint, ink, styleOf } from "./palette";
import { escaped, SvgPlot, symbolPath } from "./svg_plot";

export interface Shown { section: Section; run: number; record: number; stage: number; way: Way; estimate: boolean }
export interface Picked { line: Line; point: number }

const bars = 8;      // error bars of a mean
const marks = 5;     // symbols of a line

/** Places along a line, evenly. */
const places = (line: Line, count: number) =>
  Array.from({ length: Math.min(count, line.x.length) }, (_, k) => Math.round(((k + 0.5) / count) * (line.x.length - 1)));

export class Chart {
  readonly element = document.createElement("figure");
  private plot?: uPlot;
  private lines: Line[] = [];
  private shown!: Shown;
  private readonly area = document.createElement("div");
  private readonly mark = document.createElement("div");
  private readonly readout = document.createElement("output");
  private readonly legend = document.createElement("div");
  private readonly choices: Record<"x" | "y", HTMLSelectElement>;
  private readonly logs: Record<"x" | "y", HTMLInputElement>;

  constructor(private number: number, private x: string, private y: string, private pick: (picked: Picked) => void,
              private step: (by: number) => void, remove: (chart: Chart) => void) {
    this.element.className = "chart";
    const bar = document.createElement("div");
    bar.className = "bar";
    this.choices = { y: document.createElement("select"), x: document.createElement("select") };
    this.logs = { y: document.createElement("input"), x: document.createElement("input") };
    for (const axis of ["y", "x"] as const) {
      const label = document.createElement("label"), log = document.createElement("label");
      label.append(axis, this.choices[axis]);
      this.choices[axis].className = axis;
      this.choices[axis].addEventListener("change", () => { this[axis] = this.choices[axis].value; this.draw(this.shown); });
      this.logs[axis].type = "checkbox";
      this.logs[axis].className = `log-${axis}`;
      this.logs[axis].addEventListener("change", () => this.draw(this.shown));
      log.append(this.logs[axis], " log");
      const pair = document.createElement("span");
      pair.className = "pair";
      pair.append(label, log);
      bar.append(pair);
    }
    const close = document.createElement("button");
    close.type = "button";
    close.textContent = "\u00d7";
    close.className = "close";
    close.setAttribute("aria-label", "remove this chart");
    close.addEventListener("click", () => remove(this));
    bar.append(close);
    this.area.className = "plot";
    this.area.tabIndex = 0;
    this.area.setAttribute("role", "img");
    this.area.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1, PageUp: 10, PageDown: -10 }[event.key];
      if (by) { event.preventDefault(); this.step(by); }
    });
    this.mark.className = "mark";
    this.legend.className = "legend";
    const foot = document.createElement("figcaption");
    foot.append(this.readout, buttons(() => `${this.y}_${this.x}`, () => this.csv(), () => this.svg()));
    this.element.append(bar, this.area, this.legend, foot);
    new ResizeObserver(() => this.fit()).observe(this.area);
  }

  axes(): [string, string] { return [this.x, this.y]; }

  /** Names of the quantities that any test of the section has. */
  private offer(section: Section) {
    const columns = new Map(section.runs.flatMap((run) => run.columns.map((column) => [column.key, column] as const)));
    if (!columns.has(this.x)) this.x = columns.keys().next().value!;
    if (!columns.has(this.y)) this.y = columns.has("q") ? "q" : [...columns.keys()][1] ?? this.x;
    for (const axis of ["x", "y"] as const) {
      this.choices[axis].replaceChildren(...[...columns.values()].map((column) => {
        const option = new Option(withUnit(column.label, column.unit), column.key);
        option.title = column.meaning;
        return option;
      }));
      this.choices[axis].value = this[axis];
    }
  }

  private label(key: string) {
    const column = this.shown.section.runs.map((run) => columnOf(run, key)).find((found) => found);
    return column ? withUnit(column.label, column.unit) : key;
  }

  /** Smallest and largest value with a margin; on a log axis of the positive ones. */
  private range(axis: "x" | "y"): [number, number] {
    const log = this.logs[axis].checked;
    // No spreading into calls: a test may have more records than a call takes arguments.
    const reach = { low: Infinity, high: -Infinity };
    const take = (value: number) => {
      if (!Number.isFinite(value) || (log && value <= 0)) return;
      reach.low = Math.min(reach.low, value);
      reach.high = Math.max(reach.high, value);
    };
    for (const line of this.lines) line[axis].forEach(take);
    if (reach.low > reach.high) return log ? [0.1, 1] : [0, 1];
    if (axis === "y") {
      // An estimate that is many times the values must not make them a flat line.
      const by = 0.5 * (reach.high - reach.low || Math.abs(reach.high) || 1), least = reach.low - by, most = reach.high + by;
      for (const line of this.lines)
        for (const band of [line.scatter, line.deviation, this.shown.estimate && !log ? line.error : undefined])
          band?.forEach((value, k) => [line.y[k] - value, line.y[k] + value].forEach((end) => { if (end >= least && end <= most) take(end); }));
    }
    let { low, high } = reach;
    if (log) return low < high ? [low / 1.05, high * 1.05] : [low / 2, high * 2];
    if (low === high) { const by = Math.abs(low) || 1; low -= by / 2; high += by / 2; }
    const margin = (axis === "x" ? 0.02 : 0.05) * (high - low);
    return [low >= 0 && low < 0.2 * high ? 0 : low - margin, high <= 0 && high > 0.2 * low ? 0 : high + margin];
  }

  draw(shown: Shown) {
    this.shown = shown;
    this.offer(shown.section);
    this.lines = linesOf(shown.section, this.x, this.y, shown.stage, shown.way);
    this.plot?.destroy();
    const axis = (label: string, size: number | uPlot.Axis.Size) => ({ label, labelSize: 20, size, stroke: ink(), font: "12px system-ui",
      labelFont: "12px system-ui", grid: { stroke: faint(), width: 1 }, ticks: { stroke: faint(), width: 1, size: 5 },
      values: (_: uPlot, values: (number | null)[]) => values.map((value) => (value == null ? "" : shownTick(value))) });
    const scale = (name: "x" | "y") => ({ time: false, distr: (this.logs[name].checked ? 3 : 1) as 1 | 3,
      range: (): [number, number] => this.range(name) });
    const reachX = this.range("x");
    this.plot = new uPlot({
      width: this.area.clientWidth || 300, height: this.height(), legend: { show: false }, padding: [10, 12, 0, 0],
      cursor: { points: { show: false }, x: false, y: false, drag: { x: true, y: true, uni: 20 } },
      scales: { x: scale("x"), y: scale("y") }, series: [{}, { show: true, scale: "y", paths: () => null, points: { show: false } }],
      axes: [{ ...axis(this.label(this.x), 36), space: 60 }, axis(this.label(this.y), (_, values) => 22 + 7.4 * Math.max(3, ...(values ?? []).map((text) => text.length)))],
      hooks: { draw: [(plot) => this.paint(plot)], setScale: [() => queueMicrotask(() => this.place())] },
    }, [reachX, [null, null]], this.area);
    this.plot.over.append(this.mark);
    this.listen(this.plot.over);
    this.list();
    this.move(shown);
    this.area.setAttribute("aria-label", `${this.label(this.y)} against ${this.label(this.x)}; arrow keys move along the test that is shown`);
  }

  private height() { return Math.max(230, Math.min(360, 0.62 * this.area.clientWidth)); }
  private fit() {
    if (this.plot && this.area.clientWidth > 0 && this.area.clientWidth !== this.plot.width) {
      this.plot.setSize({ width: this.area.clientWidth, height: this.height() });
      this.place();
    }
  }

  private band(line: Line): { of: number[]; alpha: number }[] {
    return [...(line.scatter ? [{ of: line.scatter, alpha: 0.14 }] : []),
      ...(this.shown.estimate && line.error ? [{ of: line.error, alpha: 0.3 }] : [])];
  }

  private paint(plot: uPlot) {
    const ctx = plot.ctx, ratio = devicePixelRatio || 1;
    const X = (value: number) => plot.valToPos(value, "x", true), Y = (value: number) => plot.valToPos(value, "y", true);
    const fits = (line: Line, k: number) => Number.isFinite(line.x[k]) && Number.isFinite(line.y[k])
      && !(this.logs.x.checked && line.x[k] <= 0) && !(this.logs.y.checked && line.y[k] <= 0);
    ctx.save();
    ctx.beginPath();
    ctx.rect(plot.bbox.left, plot.bbox.top, plot.bbox.width, plot.bbox.height);
    ctx.clip();
    ctx.lineJoin = "round";
    for (const line of this.lines) {
      const style = styleOf(line.kind), own = line.runs.includes(this.shown.run);
      for (const { of, alpha } of this.band(line)) {
        ctx.globalAlpha = alpha;
        ctx.fillStyle = style.colour;
        const rows = line.x.map((_, k) => k).filter((k) => fits(line, k) && Number.isFinite(of[k]));
        ctx.beginPath();
        rows.forEach((k, m) => ctx[m ? "lineTo" : "moveTo"](X(line.x[k]), Y(line.y[k] + of[k])));
        rows.reverse().forEach((k) => ctx.lineTo(X(line.x[k]), Y(Math.max(line.y[k] - of[k], this.logs.y.checked ? 1e-3 * line.y[k] : -Infinity))));
        ctx.fill();
      }
      ctx.globalAlpha = 1;
      ctx.strokeStyle = style.colour;
      ctx.setLineDash(style.dash.map((length) => ratio * length));
      ctx.lineWidth = ratio * (line.mean || own ? 2.2 : 1.1);
      ctx.beginPath();
      let pen = false;
      line.x.forEach((x, k) => {
        if (!fits(line, k)) { pen = false; return; }
        ctx[pen ? "lineTo" : "moveTo"](X(x), Y(line.y[k]));
        pen = true;
      });
      ctx.stroke();
      ctx.setLineDash([]);
      ctx.lineWidth = 1.4 * ratio;
      if (line.deviation)
        for (const k of places(line, bars)) {
          const x = X(line.x[k]), low = Y(line.y[k] - line.deviation[k]), high = Y(line.y[k] + line.deviation[k]), wide = 4 * ratio;
          ctx.stroke(new Path2D(`M${x} ${low}V${high}M${x - wide} ${low}h${2 * wide}M${x - wide} ${high}h${2 * wide}`));
        }
      ctx.fillStyle = style.colour;
      if (this.shown.section.kinds.length > 1)
        for (const k of places(line, marks)) {
          if (!fits(line, k)) continue;
          const path = new Path2D(symbolPath(style.symbol, X(line.x[k]), Y(line.y[k]), 3.6 * ratio));
          if (style.symbol !== "cross") ctx.fill(path);
          ctx.stroke(path);
        }
    }
    ctx.restore();
  }

  /** The legend stands below the chart, not over its curves; one entry a kind. */
  private list() {
    const said = new Set<number>();
    this.legend.replaceChildren();
    for (const line of this.lines) {
      if (said.has(line.kind)) continue;
      said.add(line.kind);
      const count = this.lines.filter((other) => other.kind === line.kind).length;
      const entry = document.createElement("span");
      entry.innerHTML = sample(line.kind, this.shown.section.kinds.length > 1);
      entry.append(count > 1 ? `${this.shown.section.kinds[line.kind].label} (${count} tests)` : line.label);
      this.legend.append(entry);
    }
    const notes = [];
    if (this.lines.some((line) => line.scatter)) notes.push("band: one standard deviation of the tests; bars: standard error of the mean");
    if (this.shown.estimate && this.lines.some((line) => line.error)) notes.push("dark band: error estimate");
    if (notes.length) { const note = document.createElement("small"); note.textContent = notes.join("; "); this.legend.append(note); }
  }

  /** Marks the record that is shown. */
  move(shown: Shown) {
    this.shown = shown;
    this.place();
    const run = shown.section.runs[shown.run];
    const value = (key: string) => `${this.label(key).replace(/ \(.*\)$/, "")} ${this.value(key)}`;
    this.readout.textContent = `${run.file}: ${value(this.x)}, ${value(this.y)}`;
  }

  private value(key: string) {
    const column = columnOf(this.shown.section.runs[this.shown.run], key);
    const error = column?.errors?.[this.shown.record];
    const value = column?.values[this.shown.record];
    return (error != null && value != null ? shownWithError(value, error) : shown(value)) + (column?.unit ? ` ${column.unit}` : "");
  }

  private place() {
    const run = this.shown.section.runs[this.shown.run];
    const x = columnOf(run, this.x)?.values[this.shown.record], y = columnOf(run, this.y)?.values[this.shown.record];
    const inside = this.shown.stage < 0 || !run.stage || run.stage[this.shown.record] === this.shown.stage;
    this.mark.hidden = x == null || y == null || !inside || !this.plot;
    if (this.mark.hidden) return;
    const left = this.plot!.valToPos(x!, "x"), top = this.plot!.valToPos(y!, "y");
    this.mark.style.transform = `translate(${left}px, ${top}px)`;
    this.mark.style.borderColor = styleOf(run.kind).colour;
  }

  private listen(over: HTMLElement) {
    const look = (event: PointerEvent | MouseEvent) => {
      const box = over.getBoundingClientRect();
      const found = this.nearest(event.clientX - box.left, event.clientY - box.top);
      if (found) this.pick(found);
    };
    let asked = 0;
    over.addEventListener("pointermove", (event) => {
      if (event.buttons || event.pointerType === "touch") return;
      cancelAnimationFrame(asked);
      asked = requestAnimationFrame(() => look(event));
    });
    over.addEventListener("click", look);
  }

  private nearest(left: number, top: number): Picked | undefined {
    let best = 40 ** 2, found: Picked | undefined;
    for (const line of this.lines)
      line.x.forEach((x, point) => {
        const by = (this.plot!.valToPos(x, "x") - left) ** 2 + (this.plot!.valToPos(line.y[point], "y") - top) ** 2;
        if (by < best) { best = by; found = { line, point }; }
      });
    return found;
  }

  private csv() {
    const rows: (string | number | undefined)[][] = [["group", "tests", this.label(this.x), this.label(this.y), "standard deviation",
      "standard error of the mean", "error estimate"]];
    for (const line of this.lines)
      line.x.forEach((x, k) => rows.push([this.shown.section.kinds[line.kind].label, line.runs.map((run) => this.shown.section.runs[run].file).join(" "),
        x, line.y[k], line.scatter?.[k], line.deviation?.[k], line.error?.[k]]));
    return csvOf(rows);
  }

  private svg() {
    const axis = (name: "x" | "y", key: string) => {
      const scale = this.plot!.scales[name];
      return { label: this.label(key), low: scale.min!, high: scale.max!, log: this.logs[name].checked };
    };
    const plot = new SvgPlot(axis("x", this.x), axis("y", this.y));
    for (const line of this.lines) {
      const style = styleOf(line.kind);
      for (const { of, alpha } of this.band(line)) {
        const rows = line.x.map((_, k) => k).filter((k) => Number.isFinite(of[k]) && Number.isFinite(line.y[k]));
        plot.path([...rows.map((k): [number, number] => [line.x[k], line.y[k] + of[k]]),
          ...rows.reverse().map((k): [number, number] => [line.x[k], line.y[k] - of[k]])], `fill="${style.colour}" fill-opacity="${alpha}"`, true);
      }
      plot.path(line.x.map((x, k) => [x, line.y[k]]), `stroke="${style.colour}" stroke-width="1.6" stroke-dasharray="${style.dash.join(" ")}"`);
      if (line.deviation)
        for (const k of places(line, bars))
          plot.path([[line.x[k], line.y[k] - line.deviation[k]], [line.x[k], line.y[k] + line.deviation[k]]], `stroke="${style.colour}" stroke-width="1.4"`);
      if (this.shown.section.kinds.length > 1)
        for (const k of places(line, marks)) plot.symbol(style.symbol, line.x[k], line.y[k], style.colour);
    }
    const said = new Set<number>();
    const legend = this.lines.filter((line) => !said.has(line.kind) && said.add(line.kind)).map((line) =>
      ({ sample: sample(line.kind, this.shown.section.kinds.length > 1).replace(/<\/?svg[^>]*>/g, ""), label: line.label }));
    return plot.text(`${this.label(this.y)} against ${this.label(this.x)}`, legend);
  }
}

/** A tick as it is printed: at most three digits. */
function shownTick(value: number) {
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return shown(value).replace(/\.00e/, "e").replace(/0e/, "e");
  return String(+value.toPrecision(4)).replace("-", "\u2212");
}

/** Line and symbol of a kind. */
export function sample(kind: number, symbol: boolean): string {
  const style = styleOf(kind);
  return `<svg class="sample" width="36" height="12" aria-hidden="true"><path d="M0 0H36" transform="translate(0 ${0})" stroke="${style.colour}" stroke-width="2" stroke-dasharray="${style.dash.join(" ")}"/>`
    + (symbol ? `<path d="${symbolPath(style.symbol, 18, 0, 4)}" fill="${style.symbol === "cross" ? "none" : style.colour}" stroke="${style.colour}" stroke-width="1.5"/>` : "") + "</svg>";
}
export { escaped };
