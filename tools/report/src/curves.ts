// Lines of a chart: each test by itself, or means over the tests of a kind on a common grid of driving strains.
import { columnOf, type Run, type Section } from "./data";

export interface Line {
  kind: number; label: string; runs: number[];  // runs[0] is the run of a line of one test
  x: number[]; y: number[];
  record: number[];                             // of the run; of a mean the driving strain instead
  mean: boolean;
  scatter?: number[];                           // standard deviation over the tests
  deviation?: number[];                         // standard error of the mean
  error?: number[];                             // error estimate
}
export type Way = "mean" | "each";

const grid = 200;

/** Records of a run that lie in the stage (-1: all). */
export function rowsOf(run: Run, stage: number): number[] {
  const n = run.columns[0].values.length;
  const all = Array.from({ length: n }, (_, k) => k);
  return stage < 0 || !run.stage ? all : all.filter((k) => run.stage![k] === stage);
}
const at = (values: (number | null)[] | undefined, rows: number[]) => rows.map((k) => values?.[k] ?? NaN);

/** Whether a run's driving quantity goes one way, so that a mean at equal strains has a meaning. */
function goesOneWay(values: number[]): boolean {
  const sign = Math.sign(values[values.length - 1] - values[0]);
  return values.length > 1 && sign !== 0 && values.every((value, k) => k === 0 || sign * (value - values[k - 1]) >= -1e-12);
}

function interpolated(x: number[], y: number[], where: number[]): number[] {
  let k = 0;
  return where.map((value) => {
    while (k < x.length - 2 && x[k + 1] < value) ++k;
    const part = x[k + 1] > x[k] ? (value - x[k]) / (x[k + 1] - x[k]) : 0;
    return y[k] + Math.min(1, Math.max(0, part)) * (y[k + 1] - y[k]);
  });
}

function lineOfRun(section: Section, number: number, x: string, y: string, stage: number): Line | undefined {
  const run = section.runs[number], own = columnOf(run, y), rows = rowsOf(run, stage);
  if (!own || !columnOf(run, x) || !rows.length) return undefined;
  // A stage begins a line of its own: strains count from its start.
  const parts = rows.flatMap((row, k) => (k > 0 && run.stage && run.stage[row] !== run.stage[rows[k - 1]] ? [-1, row] : [row]));
  return { kind: run.kind, label: run.file, runs: [number], x: at(columnOf(run, x)!.values, parts), y: at(own.values, parts),
    record: parts, mean: false, error: own.errors ? at(own.errors, parts) : undefined };
}

export function drivingOf(run: Run): string {
  return columnOf(run, "strain") ? "strain" : run.columns[0].key;
}

export function linesOf(section: Section, x: string, y: string, stage: number, way: Way): Line[] {
  const lines: Line[] = [];
  section.kinds.forEach((kind, number) => {
    const runs = section.runs.flatMap((run, k) => (run.kind === number ? [k] : []));
    const own = runs.map((k) => lineOfRun(section, k, x, y, stage)).filter((line) => line !== undefined);
    const driving = own.map((line) => {
      const run = section.runs[line.runs[0]];
      return at(columnOf(run, drivingOf(run))?.values, line.record.filter((row) => row >= 0));
    });
    if (way === "each" || own.length < 2 || !driving.every(goesOneWay)) {
      own.forEach((line) => { line.label = own.length > 1 ? `${kind.label}: ${line.label}` : kind.label || line.label; });
      lines.push(...own);
      return;
    }
    const down = driving[0][driving[0].length - 1] < driving[0][0] ? -1 : 1;
    const along = driving.map((values) => values.map((value) => down * value));
    const begin = Math.max(...along.map((values) => values[0])), end = Math.min(...along.map((values) => values[values.length - 1]));
    const where = Array.from({ length: grid }, (_, k) => begin + ((end - begin) * k) / (grid - 1));
    const all = (of: (line: Line) => number[]) => own.map((line, k) => interpolated(along[k], of(line), where));
    const mean = (rows: number[][]) => where.map((_, k) => rows.reduce((sum, row) => sum + row[k], 0) / rows.length);
    const ys = all((line) => line.y), middle = mean(ys);
    const scatter = middle.map((value, k) => Math.sqrt(ys.reduce((sum, row) => sum + (row[k] - value) ** 2, 0) / (ys.length - 1)));
    lines.push({ kind: number, label: `${kind.label} (mean of ${own.length})`, runs, x: mean(all((line) => line.x)), y: middle,
      record: where.map((value) => down * value), mean: true, scatter, deviation: scatter.map((value) => value / Math.sqrt(ys.length)),
      error: own.every((line) => line.error) ? mean(all((line) => line.error!)) : undefined });
  });
  return lines;
}

/** Record of a run that is nearest to a point of a line. */
export function recordAt(section: Section, line: Line, point: number, run: number, stage: number): number {
  if (!line.mean) return line.record[point];
  const values = columnOf(section.runs[run], drivingOf(section.runs[run]))!.values;
  let best = -1;
  for (const k of rowsOf(section.runs[run], stage))
    if (best < 0 || Math.abs((values[k] ?? NaN) - line.record[point]) < Math.abs((values[best] ?? NaN) - line.record[point])) best = k;
  return best;
}
