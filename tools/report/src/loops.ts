// Secant shear modulus and damping of the loops of cyclic tests against the amplitude of the shear strain.
import type { Section } from "./data";
import { csvOf } from "./download";
import { symbols, styleOf } from "./palette";
import { sample } from "./chart";
import { SvgPlot } from "./svg_plot";

export function loops(section: Section): { svg: string; csv: string } | undefined {
  const rows = (section.loops ?? []).slice(1).map((row) => ({ test: row[0], values: row.slice(3).map(Number) }));
  if (rows.length < 2) return undefined;
  const tests = [...new Set(rows.map((row) => row.test))];
  const column = (k: number) => rows.map((row) => row.values[k]);
  const x = { label: "amplitude of the shear strain (%)", low: Math.min(...column(0)) / 1.3, high: Math.max(...column(0)) * 1.3, log: true };
  const one = (k: number, label: string) => {
    const plot = new SvgPlot(x, { label, low: 0, high: 1.15 * Math.max(...column(k)) }, 480, 300);
    for (const row of rows) {
      const at = tests.indexOf(row.test);
      plot.symbol(symbols[at % symbols.length], row.values[0], row.values[k], styleOf(at).colour);
    }
    return plot.text(`${label} against the amplitude of the shear strain`);
  };
  const inner = (text: string, left: number) => `<g transform="translate(${left} 0)">${text.replace(/^<svg[^>]*>|<\/svg>$/g, "").replaceAll('"c"', `"c${left}"`).replaceAll("#c)", `#c${left})`)}</g>`;
  const head = one(1, "secant shear modulus (MPa)").match(/^<svg[^>]*>/)![0];
  const legend = tests.map((test, k) => `<g transform="translate(62 ${312 + 20 * k})">${sample(k, true).replace(/<\/?svg[^>]*>/g, "").replace(/<path d="M0 0H36".*?\/>/, "")}<text x="44" y="4">${test}</text></g>`);
  const high = 320 + 20 * tests.length;
  return { svg: `${head.replace(/viewBox="[^"]*"/, `viewBox="0 0 980 ${high}"`)}${inner(one(1, "secant shear modulus (MPa)"), 0)}${inner(one(2, "damping ratio (%)"), 490)}${legend.join("")}</svg>`,
    csv: csvOf(section.loops!) };
}
