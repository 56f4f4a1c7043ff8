// G/G_max and damping of the loops of cyclic tests against the amplitude of the shear strain.
import type { Section } from "./data";
import { csvOf } from "./download";
import { symbols, styleOf } from "./palette";
import { sample } from "./chart";
import { escaped, SvgPlot } from "./svg_plot";

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
  const narrow = innerWidth < 700;  // one below the other
  const inner = (text: string, number: number) => `<g transform="translate(${narrow ? 0 : 490 * number} ${narrow ? 310 * number : 0})">${text.replace(/^<svg[^>]*>|<\/svg>$/g, "").replaceAll('"c"', `"c${number}"`).replaceAll("#c)", `#c${number})`)}</g>`;
  const ratio = one(3, "G/G_max"), head = ratio.match(/^<svg[^>]*>/)![0], top = narrow ? 620 : 310;
  const legend = tests.map((test, k) => {
    const [, , , , , , , modulus, of] = section.loops!.find((row) => row[0] === test)!;
    return `<g transform="translate(62 ${top + 2 + 20 * k})">${sample(k, true).replace(/<\/?svg[^>]*>/g, "").replace(/<path d="M0 0H36".*?\/>/, "")}<text x="44" y="4">${escaped(`${test}: G_max ${modulus} MPa (${of})`)}</text></g>`;
  });
  return { svg: `${head.replace(/viewBox="[^"]*"/, `viewBox="0 0 ${narrow ? 480 : 980} ${top + 10 + 20 * tests.length}"`)}${inner(ratio, 0)}${inner(one(2, "damping ratio (%)"), 1)}${legend.join("")}</svg>`,
    csv: csvOf(section.loops!) };
}
