// What `rvelab report` wrote into the page, and the states in it (rvelab/report/states.hpp has their layout).

export interface Column { key: string; label: string; unit: string; meaning: string; values: (number | null)[];
  errors?: (number | null)[] }
export interface Field { key: string; label: string; unit: string; about_zero: boolean; low: number; high: number;
  from: number; to: number }
export interface PackedState { record: number; contacts: number; packed: string; grains?: number; rocks?: number[][] }
export interface States { grains: number; shape: "disc" | "sphere" | "ellipse" | "point"; sizes?: string;
  largest_force_N?: number; side?: [number, number]; centre?: [number, number, number]; fields: Field[];
  states: PackedState[] }
export interface Run { file: string; kind: number; stage?: number[]; columns: Column[]; found: number; states: States;
  complete?: boolean }
export interface Kind { label: string; set: number; pressure_kPa?: number }
export interface Strength { name: string; set: number; circles: { kind: number; states: [number, number][] }[];
  angle: number; low: number | null; high: number | null; text: string; cohesion_kPa: number; large_strain: number | null;
  words: string }
export type Table = string[][];
export interface Section { name: string; kind: "test" | "mpm"; dimension: 2 | 3; stages?: string[]; last_stage?: number;
  curves: [string, string][]; kinds: Kind[]; runs: Run[]; strength?: Strength[]; asked?: Table; specimen?: Table;
  protocol?: string; means?: Table; differences?: Table; loops?: Table; errors?: Table; errors_in_words?: string }
export interface Report { version: string; title: string; every: number; sections: Section[] }

export const report: Report = JSON.parse(document.getElementById("data")!.textContent!);

/** A state as it is drawn: metres, laboratory frame. */
export interface State {
  record: number; dimension: 2 | 3; n: number; contacts: number;
  lattice: Float32Array;                     // columns
  position: Float32Array;                    // x y z of each grain
  half: Float32Array;                        // two half lengths of each grain
  angle: Float32Array;                       // of the first of them
  values: Map<string, Float32Array>;         // by the key of the field; NaN: none
  i: ArrayLike<number>; j: ArrayLike<number>;
  branch: Float32Array;                      // x y z of each contact, from i to the image of j
  force: Float32Array;                       // N
  friction: Float32Array;                    // mobilised part
  normal: Float32Array;                      // x y z
  rocks: number[][];
}

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}

async function unpacked(base64: string): Promise<DataView<ArrayBuffer>> {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new DataView(await new Response(stream).arrayBuffer());
}

/** Reads arrays one after the other. They are little-endian, as every machine with a browser is. */
class Reader {
  private at = 0;
  constructor(private view: DataView<ArrayBuffer>) {}
  private next(bytes: number) { return this.view.buffer.slice(this.at, (this.at += bytes)); }
  float32(n: number) { return new Float32Array(this.next(4 * n)); }
  uint16(n: number) { return new Uint16Array(this.next(2 * n)); }
  uint32(n: number) { return new Uint32Array(this.next(4 * n)); }
  uint8(n: number) { return new Uint8Array(this.next(n)); }
  within(n: number, low: number, high: number) {
    const found = new Float32Array(n), step = (high - low) / 65534;
    this.uint16(n).forEach((v, k) => { found[k] = v === 65535 ? NaN : low + step * v; });
    return found;
  }
}

const sizes = new Map<Run, Promise<Float32Array>>();
const kept = new Map<PackedState, Promise<State>>();
const most = 64; // states that are kept unpacked

async function sizesOf(run: Run): Promise<Float32Array> {
  const view = await unpacked(run.states.sizes!);
  return new Reader(view).float32(view.byteLength / 4);
}

async function read(run: Run, packed: PackedState, dimension: 2 | 3): Promise<State> {
  const states = run.states, shape = states.shape, n = packed.grains ?? states.grains, c = packed.contacts;
  if (states.sizes && !sizes.has(run)) sizes.set(run, sizesOf(run));
  const reader = new Reader(await unpacked(packed.packed));
  const lattice = reader.float32(9);
  const part = Array.from({ length: dimension }, () => reader.uint16(n));
  const position = new Float32Array(3 * n), centre = states.centre ?? [0, 0, 0];
  for (let k = 0; k < dimension; ++k)
    for (let g = 0; g < n; ++g) {
      let sum = centre[k];
      for (let axis = 0; axis < dimension; ++axis) sum += lattice[3 * axis + k] * (part[axis][g] / 65536 - 0.5);
      position[3 * g + k] = sum;
    }
  const half = new Float32Array(2 * n), angle = new Float32Array(n);
  if (shape === "ellipse") angle.set(Float32Array.from(reader.uint16(n), (v) => (v / 65536) * Math.PI));
  if (shape === "point") {
    const side = reader.within(n, states.side![0], states.side![1]);
    const across = reader.within(n, states.side![0], states.side![1]);
    for (let g = 0; g < n; ++g) { half[2 * g] = side[g] / 2; half[2 * g + 1] = across[g] / 2; }
    angle.set(Float32Array.from(reader.uint16(n), (v) => (v / 65536) * Math.PI));
  } else {
    const own = await sizes.get(run)!;
    for (let g = 0; g < n; ++g) {
      half[2 * g] = own[g];
      half[2 * g + 1] = shape === "ellipse" ? own[n + g] : own[g];
    }
  }
  const values = new Map(states.fields.map((field) => [field.key, reader.within(n, field.low, field.high)]));
  const rows = () => (n > 65536 ? reader.uint32(c) : reader.uint16(c));
  const i = rows(), j = rows();
  const image = Array.from({ length: c ? dimension : 0 }, () => reader.uint8(c));
  const force = reader.within(c, 0, states.largest_force_N ?? 0);
  const friction = Float32Array.from(reader.uint8(c), (v) => v / 255);
  const branch = new Float32Array(3 * c), normal = new Float32Array(3 * c);
  for (let m = 0; m < c; ++m) {
    for (let axis = 0; axis < dimension; ++axis) {
      const along = (part[axis][j[m]] - part[axis][i[m]]) / 65536 + image[axis][m] - 128;
      for (let k = 0; k < dimension; ++k) branch[3 * m + k] += lattice[3 * axis + k] * along;
    }
    const length = Math.hypot(branch[3 * m], branch[3 * m + 1], branch[3 * m + 2]) || 1;
    for (let k = 0; k < 3; ++k) normal[3 * m + k] = branch[3 * m + k] / length;
  }
  if (shape === "ellipse")
    reader.uint16(c).forEach((v, m) => {
      normal[3 * m] = Math.cos((v / 32768) * Math.PI);
      normal[3 * m + 1] = Math.sin((v / 32768) * Math.PI);
    });
  return { record: packed.record, dimension, n, contacts: c, lattice, position, half, angle, values, i, j, branch, force,
    friction, normal, rocks: packed.rocks ?? [] };
}

export function stateOf(section: Section, run: Run, number: number): Promise<State> {
  const packed = run.states.states[number];
  if (!kept.has(packed)) {
    if (kept.size >= most) kept.delete(kept.keys().next().value!);
    kept.set(packed, read(run, packed, section.dimension));
  }
  return kept.get(packed)!;
}

export const columnOf = (run: Run, key: string): Column | undefined => run.columns.find((column) => column.key === key);

/** State nearest to a record. */
export function nearestState(run: Run, record: number): number {
  const states = run.states.states;
  let best = 0;
  states.forEach((state, k) => {
    if (Math.abs(state.record - record) < Math.abs(states[best].record - record)) best = k;
  });
  return best;
}

/** Three significant digits. */
export function shown(value: number | null | undefined): string {
  if (value == null || !Number.isFinite(value)) return "none";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = size >= 1e5 || size < 1e-3 ? value.toExponential(2) : Number(value.toPrecision(3)).toString();
  return text.replace("-", "\u2212");
}
/** A value in the digits that its error leaves, two of its own. */
export function shownWithError(value: number, error: number): string {
  const digits = 1 - Math.floor(Math.log10(error));
  if (!(error > 0) || digits > 8 || Math.abs(value) >= 1e5) return `${shown(value)} \u00b1 ${shown(error)}`;
  const places = Math.max(0, digits);
  return `${value.toFixed(places)} \u00b1 ${error.toFixed(places)}`.replace("-", "\u2212");
}
export const withUnit = (label: string, unit: string) => (unit ? `${label} (${unit})` : label);
