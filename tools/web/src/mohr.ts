/** Mohr circles of the largest stress of each test, and the line through the origin that they make. */
import { words } from "./words";

export interface Circle {
  s: number; // kPa
  t: number;
  colour: string;
}

export function drawCircles(place: HTMLElement, circles: Circle[], angle: number) {
  if (circles.length === 0) {
    place.textContent = words.mohrNone;
    return;
  }
  const largest = 1.08 * Math.max(...circles.map(({ s, t }) => s + t));
  const top = 1.15 * Math.max(...circles.map(({ t }) => t), 0.3 * largest);
  const [width, left, below] = [640, 56, 40];
  const scale = (width - left - 8) / largest;
  const height = top * scale + below;
  const x = (value: number) => left + value * scale;
  const y = (value: number) => height - below - value * scale;
  const arcs = circles.map(
    ({ s, t, colour }) =>
      `<path d="M${x(s - t)} ${y(0)} A${t * scale} ${t * scale} 0 0 1 ${x(s + t)} ${y(0)}" fill="none" stroke="${
        colour
      }" stroke-width="2"/>`,
  );
  const rise = Math.tan((angle * Math.PI) / 180);
  const end = Math.min(largest, top / rise);
  const step = 10 ** Math.floor(Math.log10(largest / 2));
  const each = largest / step > 10 ? 2 * step : step;
  const ticks = Array.from({ length: Math.floor(largest / each) + 1 }, (_, k) => k * each).map(
    (value) => `<text x="${x(value)}" y="${height - 22}" text-anchor="middle">${Number(value.toPrecision(3))}</text>`,
  );
  place.innerHTML = `<svg viewBox="0 0 ${width} ${height}" role="img" aria-label="${words.mohr}">
    <path d="M${left} 4 V${y(0)} H${width}" fill="none" stroke="currentColor"/>${arcs.join("")}
    <path d="M${x(0)} ${y(0)} L${x(end)} ${y(end * rise)}" stroke="currentColor" stroke-dasharray="7 5"/>
    ${ticks.join("")}
    <text x="${(left + width) / 2}" y="${height - 4}" text-anchor="middle">${words.mohrAxes.normal}</text>
    <text transform="translate(16 ${height / 2 - 16}) rotate(-90)" text-anchor="middle">${words.mohrAxes.shear}</text>
  </svg>`;
}
