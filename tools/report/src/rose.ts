// Contact rose: density of the normals over their direction, bars of 10 degrees, with the fit of the fabric tensor; mean
// normal force in each direction. In space directions are seen in the xz plane, each weighted by its part in that plane.
import { shown, type State } from "./data";
import { csvOf } from "./download";
import { faint, ink, paper, styleOf } from "./palette";

const bars = 36, width = (2 * Math.PI) / bars;

export function rose(states: State[], title: string): { svg: string; csv: string; words: string } | undefined {
  const count = new Float64Array(bars), force = new Float64Array(bars);
  let c2 = 0, s2 = 0, all = 0, forces = 0;
  for (const state of states)
    for (let m = 0; m < state.contacts; ++m) {
      const x = state.normal[3 * m], y = state.normal[3 * m + (state.dimension === 2 ? 1 : 2)], weight = Math.hypot(x, y);
      if (!(weight > 1e-6)) continue;
      const angle = Math.atan2(y, x);
      for (const turn of [0, Math.PI]) {
        const bar = Math.floor(((angle + turn + 4 * Math.PI) % (2 * Math.PI)) / width) % bars;
        count[bar] += weight;
        force[bar] += weight * state.force[m];
      }
      c2 += weight * Math.cos(2 * angle);
      s2 += weight * Math.sin(2 * angle);
      all += weight;
      forces += weight * state.force[m];
    }
  if (!(all > 0) || !(forces > 0)) return undefined;
  const density = Array.from(count, (value) => value / (2 * all) / width);
  const mean = Array.from(force, (value, k) => (count[k] > 0 ? value / count[k] / (forces / all) : 0));
  const a = (2 * Math.hypot(c2, s2)) / all, direction = 0.5 * Math.atan2(s2, c2);
  const axes = states[0].dimension === 2 ? ["x", "y"] : ["x", "z"];
  const style = styleOf(0), other = styleOf(1);
  const circle = (values: number[], top: number, cx: number, fill: string, label: string, fit?: (angle: number) => number) => {
    const R = 112, at = (angle: number, r: number) => `${(cx + (R * r / top) * Math.cos(angle)).toFixed(1)} ${(150 - (R * r / top) * Math.sin(angle)).toFixed(1)}`;
    const step = top > 1.2 ? 0.5 : top > 0.6 ? 0.2 : top > 0.25 ? 0.1 : 0.05;
    let text = "";
    for (let ring = step; ring < top; ring += step)
      text += `<circle cx="${cx}" cy="150" r="${(R * ring / top).toFixed(1)}" stroke="${faint()}" fill="none"/><text x="${cx + 3}" y="${(150 - R * ring / top - 2).toFixed(1)}" font-size="9" fill-opacity="0.75">${shown(ring)}</text>`;
    values.forEach((value, k) => { text += `<path d="M${cx} 150L${at(k * width, value)}L${at((k + 0.5) * width, value)}L${at((k + 1) * width, value)}Z" fill="${fill}" fill-opacity="0.45" stroke="${fill}" stroke-width="0.6"/>`; });
    if (fit) text += `<path d="M${Array.from({ length: 121 }, (_, k) => at((k * Math.PI) / 60, fit((k * Math.PI) / 60))).join("L")}Z" fill="none" stroke="${other.colour}" stroke-width="1.8" stroke-dasharray="6 3"/>`;
    return text + `<text x="${cx + R + 8}" y="154">${axes[0]}</text><text x="${cx}" y="${150 - R - 16}" text-anchor="middle">${axes[1]}</text><text x="${cx}" y="292" text-anchor="middle">${label}</text>`;
  };
  const fit = (angle: number) => (1 + a * Math.cos(2 * (angle - direction))) / (2 * Math.PI);
  const top = 1.1 * Math.max(...density, fit(direction)), topForce = 1.1 * Math.max(...mean);
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 560 300" role="img" font-family="system-ui, sans-serif" font-size="12" fill="${ink()}"><title>${title}</title><rect width="560" height="300" fill="${paper()}"/>`
    + circle(density, top, 138, style.colour, "density of normals; dashed: fit", fit)
    + circle(mean, topForce, 420, styleOf(2).colour, "mean normal force over the mean of all") + "</svg>";
  const degrees = ((direction * 180) / Math.PI + 180) % 180;
  const words = `Anisotropy of the normals a = ${shown(a)}, along ${shown(Math.round(degrees))}\u00b0 from ${axes[0]}; ${states.reduce((sum, state) => sum + state.contacts, 0)} contacts`
    + (states[0].dimension === 3 ? ", seen in the xz plane." : ".");
  const csv = csvOf([["angle (degrees)", "density of normals", "fit", "mean normal force over the mean of all"],
    ...density.map((value, k) => [(k + 0.5) * 10, value, fit((k + 0.5) * width), mean[k]])]);
  return { svg, csv, words };
}
