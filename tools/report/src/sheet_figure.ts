// A figure of a data sheet: lines, symbols with error bars, published curves in grey.
import { csvOf } from "./download";
import { styleOf, symbols } from "./palette";
import type { Figure, Series } from "./sheet_data";
import { SvgPlot, symbolPath, type Axis } from "./svg_plot";

const most = 20;  // symbols of one curve

const soft = () => getComputedStyle(document.documentElement).getPropertyValue("--soft").trim();
const strokeOf = (series: Series) => (series.measured ? soft() : styleOf(series.kind).colour);
const dashOf = (series: Series) => styleOf(series.kind).dash.join(" ");

/** Range of an axis over the finite values, with a margin; a linear one that comes near zero begins there. */
function rangeOf(values: (number | null)[], label: string, log: boolean): Axis {
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    if (value == null || !Number.isFinite(value) || (log && value <= 0)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) [low, high] = log ? [1, 10] : [0, 1];
  if (log) {
    const margin = Math.max(1.15, (high / low) ** 0.04);
    return { label, low: low / margin, high: high * margin, log };
  }
  const span = high - low || Math.abs(high) || 1;
  return { label, low: low >= 0 && low < 0.3 * high ? 0 : low - 0.06 * span, high: high + 0.06 * span, log };
}

/** Rows of symbols that are drawn: all, or some of many. */
function rowsOf(series: Series): number[] {
  const n = series.x.length, step = Math.max(1, Math.ceil(n / most));
  return Array.from({ length: n }, (_, k) => k).filter((k) => k % step === 0 || k === n - 1);
}

function draw(plot: SvgPlot, series: Series, log: boolean) {
  const colour = strokeOf(series), symbol = symbols[series.kind % symbols.length];
  const at = (k: number): [number, number] => [series.x[k] ?? NaN, series.y[k] ?? NaN];
  if (series.line) {
    const dash = dashOf(series);
    plot.path(series.x.map((_, k) => at(k)), `stroke="${colour}" stroke-width="${series.measured ? 1.2 : 1.8}"${dash ? ` stroke-dasharray="${dash}"` : ""}`);
    return;
  }
  for (const k of rowsOf(series)) {
    const [x, y] = at(k), error = series.error[k];
    if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
    if (error != null && error > 0) plot.path([[x, log && y <= error ? y / 1e3 : y - error], [x, y + error]], `stroke="${colour}" stroke-width="1.2"`);
    if (series.measured) plot.raw(`<path d="${symbolPath(symbol, plot.X(x), plot.Y(y), 4)}" fill="none" stroke="${colour}" stroke-width="1.5"/>`);
    else plot.symbol(symbol, x, y, colour);
  }
}

/** A line, a symbol, or both, as the curves of one name are drawn. */
function sampleOf(own: Series[]): string {
  const line = own.find((series) => series.line), points = own.find((series) => !series.line);
  const dash = line ? dashOf(line) : "";
  return (line ? `<path d="M0 0H36" fill="none" stroke="${strokeOf(line)}" stroke-width="2"${dash ? ` stroke-dasharray="${dash}"` : ""}/>` : "")
    + (points ? `<path d="${symbolPath(symbols[points.kind % symbols.length], 18, 0, 4)}" fill="${points.measured ? "none" : strokeOf(points)}" stroke="${strokeOf(points)}" stroke-width="1.5"/>` : "");
}

export interface Drawn { svg: string; whole: string; legend: { sample: string; label: string }[] }

let made = 0;

export function drawFigure(figure: Figure, width: number): Drawn {
  const all = (of: (series: Series) => (number | null)[]) => figure.series.flatMap(of);
  const ends = (series: Series, sign: number) => series.y.map((y, k) => {
    const end = y == null ? null : y + sign * (series.error[k] ?? 0);
    return figure.y_log && end != null && end <= 0 ? y : end;
  });
  const x = rangeOf(all((series) => series.x), figure.x_label, figure.x_log);
  const y = rangeOf(all((series) => [...ends(series, -1), ...ends(series, 1)]), figure.y_label, figure.y_log);
  // An interval of two specimens may be many times what is drawn.
  const values = rangeOf(all((series) => series.y), figure.y_label, figure.y_log);
  if (!figure.y_log) {
    const room = 0.6 * (values.high - values.low);
    y.low = Math.max(y.low, values.low - room);
    y.high = Math.min(y.high, values.high + room);
  } else {
    y.low = Math.max(y.low, values.low / 3);
    y.high = Math.min(y.high, values.high * 3);
  }
  const plot = new SvgPlot(x, y, width, Math.round(Math.min(360, 0.68 * width)));
  // Published curves below, then lines, then symbols.
  const order = (series: Series) => (series.measured && series.line ? 0 : series.line ? 1 : 2);
  [...figure.series].sort((a, b) => order(a) - order(b)).forEach((series) => draw(plot, series, figure.y_log));
  const labels = [...new Set(figure.series.map((series) => series.label))];
  const legend = labels.map((label) => ({ label, sample: sampleOf(figure.series.filter((series) => series.label === label)) }));
  const own = `f${++made}`;  // several figures in one page: each needs its own clip path
  const named = (svg: string) => svg.replaceAll('id="c"', `id="${own}"`).replaceAll("url(#c)", `url(#${own})`);
  return { svg: named(plot.text(figure.title)), whole: plot.text(figure.title, legend), legend };
}

export function csvOfFigure(figure: Figure): string {
  const rows: (string | number | null)[][] = [["series", figure.x_label, figure.y_label, "half of the 95 % interval"]];
  for (const series of figure.series)
    series.x.forEach((x, k) => { if (x != null) rows.push([series.label, x, series.y[k], series.error[k] ?? null]); });
  return csvOf(rows);
}
