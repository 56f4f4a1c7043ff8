/** Curves as they are drawn, with uPlot: one row of points for each test. */
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { column } from "./messages";
import { seldom } from "./seldom";
import type { TestKind } from "./setup";
import { words } from "./words";

export interface Curve {
  name: string;
  colour: string;
  dashed: boolean;
  rows: Float64Array[];
}

/** Of colour-blind safe colours (Okabe and Ito). */
export const colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c6bb1", "#999933"];

interface Axes {
  x: string;
  y: string;
  of: (row: Float64Array) => [number, number];
}

function axesOf(test: TestKind): Axes {
  const { strain, shear, q, p, volume } = words.axes;
  if (test === "isotropic")
    return { x: p, y: volume, of: (row) => [row[column.p] / 1e3, 100 * row[column.volume]] };
  if (test === "shear") return { x: shear, y: q, of: (row) => [100 * row[column.strain], row[column.q] / 1e3] };
  return { x: strain, y: q, of: (row) => [100 * row[column.strain], row[column.q] / 1e3] };
}

/** What `build` draws on is kept in memory, not in the graphics card: some lines are quicker so, and the card, or the
 *  software in its place, is left to the grains. uPlot has no option for it. */
function inMemory<Built>(build: () => Built): Built {
  const usual = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string) {
    return usual.call(this, kind, { willReadFrequently: true });
  } as typeof usual;
  try {
    return build();
  } finally {
    HTMLCanvasElement.prototype.getContext = usual;
  }
}

export class CurveView {
  private plot: uPlot | null = null;
  private look = "";
  private curves: Curve[] = [];
  private test: TestKind = "biaxial";

  private readonly drawSoon = seldom(300, () => this.draw());

  constructor(private readonly place: HTMLElement) {
    new ResizeObserver(() => this.plot?.setSize(this.size())).observe(place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  show(test: TestKind, curves: Curve[]) {
    this.test = test;
    this.curves = curves;
    this.drawSoon();
  }

  private size() {
    return { width: Math.max(200, this.place.clientWidth), height: Math.max(200, this.place.clientHeight) };
  }

  private draw() {
    const axes = axesOf(this.test);
    // Of the last stage of the test; what came before brought the specimen to its pressure.
    const points = this.curves.map((curve) => {
      const last = curve.rows.length > 0 ? Math.max(1, curve.rows[curve.rows.length - 1][column.stage]) : 1;
      const sorted = curve.rows.filter((row) => row[column.stage] === last).map(axes.of);
      const [xs, ys] = [sorted.map(([x]) => x), sorted.map(([, y]) => y)];
      return [xs, ys] as [number[], number[]];
    });
    const joined = points.length > 0 ? uPlot.join(points.map((each) => each as unknown as uPlot.AlignedData)) : [[]];
    const ink = getComputedStyle(this.place).getPropertyValue("color");
    const grid = getComputedStyle(this.place).getPropertyValue("--line");
    const axis = (label: string): uPlot.Axis => ({ label, stroke: ink, grid: { stroke: grid }, ticks: { stroke: grid } });
    // The plot is built anew only where more than its points changed: that takes longer than a picture may.
    const look = JSON.stringify([axes.x, axes.y, ink, grid, this.curves.map(({ name, dashed }) => [name, dashed])]);
    if (this.plot !== null && look === this.look) return this.plot.setData(joined as uPlot.AlignedData);
    this.look = look;
    this.plot?.destroy();
    this.plot = inMemory(() => new uPlot(
      {
        ...this.size(),
        scales: { x: { time: false } },
        legend: { show: false },
        axes: [axis(axes.x), axis(axes.y)],
        series: [
          {},
          ...this.curves.map((curve) => ({
            label: curve.name,
            stroke: curve.colour,
            width: 2,
            dash: curve.dashed ? [6, 4] : undefined,
            spanGaps: true,
            points: { show: false },
          })),
        ],
      },
      joined as uPlot.AlignedData,
      this.place,
    ));
  }
}
