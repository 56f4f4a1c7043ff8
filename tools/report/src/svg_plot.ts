// Figures as SVG: axes with round numbers, lines, bands, circles. Used for downloads and for figures that do not move.
import { ink, faint, paper, type Symbol } from "./palette";
import { shown } from "./data";

export const escaped = (text: string) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

export function ticks(low: number, high: number, about: number): number[] {
  const raw = (high - low) / about, power = 10 ** Math.floor(Math.log10(raw));
  const step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) list.push(k * step);
  return list;
}
/** Powers of ten; between them 2 and 5 where few powers are in sight. */
export function logTicks(low: number, high: number): number[] {
  const list = [], few = Math.log10(high / low) < 3;
  for (let k = Math.floor(Math.log10(low)); k <= Math.ceil(Math.log10(high)); ++k)
    for (const factor of few ? [1, 2, 5] : [1]) list.push(factor * 10 ** k);
  return list.filter((value) => value >= low * 0.999 && value <= high * 1.001);
}

export function symbolPath(symbol: Symbol, x: number, y: number, r: number): string {
  switch (symbol) {
    case "circle": return `M${x - r} ${y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0z`;
    case "square": return `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}z`;
    case "triangle": return `M${x} ${y - 1.2 * r}L${x + 1.1 * r} ${y + 0.9 * r}L${x - 1.1 * r} ${y + 0.9 * r}z`;
    case "diamond": return `M${x} ${y - 1.3 * r}L${x + 1.3 * r} ${y}L${x} ${y + 1.3 * r}L${x - 1.3 * r} ${y}z`;
    case "cross": return `M${x - r} ${y - r}l${2 * r} ${2 * r}M${x + r} ${y - r}l${-2 * r} ${2 * r}`;
  }
}

export interface Axis { label: string; low: number; high: number; log?: boolean }

export class SvgPlot {
  private parts: string[] = [];
  private top = 14;
  private left = 62;
  constructor(private x: Axis, private y: Axis, readonly width = 640, readonly height = 400, private bottom = 46,
              private right = 16) {}
  private part(axis: Axis, value: number) {
    return axis.log ? Math.log(value / axis.low) / Math.log(axis.high / axis.low) : (value - axis.low) / (axis.high - axis.low);
  }
  X = (value: number) => +(this.left + this.part(this.x, value) * (this.width - this.left - this.right)).toFixed(2);
  Y = (value: number) => +(this.height - this.bottom - this.part(this.y, value) * (this.height - this.top - this.bottom)).toFixed(2);

  path(points: [number, number][], style: string, close = false) {
    let d = "", pen = false;
    for (const [x, y] of points) {
      if (!Number.isFinite(x) || !Number.isFinite(y) || (this.x.log && x <= 0) || (this.y.log && y <= 0)) { pen = false; continue; }
      d += `${pen ? "L" : "M"}${this.X(x)} ${this.Y(y)}`;
      pen = true;
    }
    if (d) this.parts.push(`<path d="${d}${close ? "z" : ""}" ${style}/>`);
  }
  raw(text: string) { this.parts.push(text); }
  symbol(symbol: Symbol, x: number, y: number, colour: string) {
    this.parts.push(`<path d="${symbolPath(symbol, this.X(x), this.Y(y), 4)}" fill="${symbol === "cross" ? "none" : colour}" stroke="${colour}" stroke-width="1.5"/>`);
  }

  /** `legend`: lines of text below the axes, each after a sample of its own. */
  text(title: string, legend: { sample: string; label: string }[] = []): string {
    const grid: string[] = [], names: string[] = [];
    const list = (axis: Axis, about: number) => (axis.log ? logTicks(axis.low, axis.high) : ticks(axis.low, axis.high, about));
    for (const value of list(this.x, this.width / 110)) {
      grid.push(`<path d="M${this.X(value)} ${this.top}V${this.height - this.bottom}"/>`);
      names.push(`<text x="${this.X(value)}" y="${this.height - this.bottom + 16}" text-anchor="middle">${shown(value)}</text>`);
    }
    for (const value of list(this.y, this.height / 75)) {
      grid.push(`<path d="M${this.left} ${this.Y(value)}H${this.width - this.right}"/>`);
      names.push(`<text x="${this.left - 6}" y="${this.Y(value) + 4}" text-anchor="end">${shown(value)}</text>`);
    }
    const below = 20 * legend.length, high = this.height + below;
    const rows = legend.map(({ sample, label }, k) =>
      `<g transform="translate(10 ${this.height + 8 + 20 * k})">${sample}<text x="44" y="4">${escaped(label)}</text></g>`);
    return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${this.width} ${high}" role="img" font-family="system-ui, sans-serif" font-size="12" fill="${ink()}"><title>${escaped(title)}</title>`
      + `<rect width="${this.width}" height="${high}" fill="${paper()}"/><clipPath id="c"><rect x="${this.left}" y="${this.top}" width="${this.width - this.left - this.right}" height="${this.height - this.top - this.bottom}"/></clipPath>`
      + `<g stroke="${faint()}" stroke-width="0.7" fill="none">${grid.join("")}</g><g clip-path="url(#c)" fill="none">${this.parts.join("")}</g>`
      + `<rect x="${this.left}" y="${this.top}" width="${this.width - this.left - this.right}" height="${this.height - this.top - this.bottom}" fill="none" stroke="${ink()}" stroke-width="0.8"/>${names.join("")}`
      + `<text x="${(this.left + this.width - this.right) / 2}" y="${this.height - this.bottom + 36}" text-anchor="middle">${escaped(this.x.label)}</text>`
      + `<text transform="translate(14 ${(this.top + this.height - this.bottom) / 2}) rotate(-90)" text-anchor="middle">${escaped(this.y.label)}</text>${rows.join("")}</svg>`;
  }
}
