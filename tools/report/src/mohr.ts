// Mohr circles at the peak and the envelope, as the calibration gives it (rvelab/report/page.cpp).
import type { Section } from "./data";
import { csvOf } from "./download";
import { styleOf } from "./palette";
import { sample } from "./chart";
import { SvgPlot } from "./svg_plot";

const degree = Math.PI / 180;

export function mohr(section: Section, width: number): { svg: string; csv: string; words: string[] } | undefined {
  const sets = section.strength ?? [];
  if (!sets.length) return undefined;
  const reach = Math.max(...sets.flatMap((set) => set.circles.flatMap((circle) => circle.states.map(([s, t]) => s + t)))) * 1.06;
  const top = Math.max(...sets.flatMap((set) => set.circles.flatMap((circle) => circle.states.map(([, t]) => t)))) * 1.15;
  // Circles are round: both axes have one scale.
  const plain = width - 78, high = Math.max(160, (plain * top) / reach);
  const plot = new SvgPlot({ label: "normal stress \u03c3, compression positive (kPa)", low: 0, high: reach },
    { label: "shear stress \u03c4 (kPa)", low: 0, high: (reach * high) / plain }, width, high + 60);
  const rows: (string | number | null)[][] = [["group", "s (kPa)", "t (kPa)", "friction angle (degrees)", "cohesion (kPa)"]];
  const legend: { sample: string; label: string }[] = [];
  const inner = (kind: number) => sample(kind, false).replace(/<\/?svg[^>]*>/g, "");
  for (const set of sets) {
    const first = set.circles[0]?.kind ?? 0;
    const line = (angle: number, style: string) => plot.path([[0, set.cohesion_kPa], [reach, set.cohesion_kPa + reach * Math.tan(angle * degree)]], style);
    const colour = sets.length > 1 ? styleOf(first).colour : "#c2185b";
    if (set.low != null && set.high != null) {
      const at = (angle: number): [number, number] => [reach, set.cohesion_kPa + reach * Math.tan(angle * degree)];
      plot.path([[0, set.cohesion_kPa], at(set.low), at(set.high)], `fill="${colour}" fill-opacity="0.15"`, true);
    }
    for (const circle of set.circles) {
      const style = styleOf(circle.kind);
      const arc = (s: number, t: number) => Array.from({ length: 91 }, (_, k): [number, number] =>
        [s - t * Math.cos(k * 2 * degree), t * Math.sin(k * 2 * degree)]);
      const mean = [0, 1].map((k) => circle.states.reduce((sum, state) => sum + state[k], 0) / circle.states.length);
      if (circle.states.length > 1)
        for (const [s, t] of circle.states) plot.path(arc(s, t), `stroke="${style.colour}" stroke-width="0.6" stroke-opacity="0.6"`);
      plot.path(arc(mean[0], mean[1]), `stroke="${style.colour}" stroke-width="1.8" stroke-dasharray="${style.dash.join(" ")}" fill="${style.colour}" fill-opacity="0.06"`);
      legend.push({ sample: inner(circle.kind), label: section.kinds[circle.kind].label + (circle.states.length > 1 ? ` (mean of ${circle.states.length}, thin: each)` : "") });
      for (const [s, t] of circle.states) rows.push([section.kinds[circle.kind].label, s, t, set.angle, set.cohesion_kPa]);
    }
    line(set.angle, `stroke="${colour}" stroke-width="1.8"`);
    legend.push({ sample: `<path d="M0 0H36" stroke="${colour}" stroke-width="2"/>`, label: `${set.name ? set.name + ": " : ""}\u03c6 = ${set.text}` + (set.low != null ? " (shaded)" : "") });
    if (set.large_strain != null) {
      line(set.large_strain, `stroke="${colour}" stroke-width="1.4" stroke-dasharray="7 4"`);
      legend.push({ sample: `<path d="M0 0H36" stroke="${colour}" stroke-width="1.4" stroke-dasharray="7 4"/>`, label: `${set.name ? set.name + ": " : ""}at large strain` });
    }
  }
  return { svg: plot.text("Mohr circles at the peak", legend), csv: csvOf(rows), words: sets.map((set) => set.words) };
}
