/** What page and worker say to each other. */
export interface Picture {
  dimension: number;
  cell: Float64Array; // three edges, x, y, z of each, m
  grains: Float32Array; // x, y, z, angle, half axes a and b, sum of the pressing forces: of each
  contacts: Float32Array; // x, y, z, branch x, y, z, force: of each
  void_ratio: number;
  coordination: number;
  stress: Float64Array; // xx, yy, zz, yz, xz, xy, Pa, tension positive
}
export const [grainColumns, contactColumns] = [7, 7];

/** Columns of a record. */
export const column = { stage: 0, strain: 1, xx: 2, yy: 3, zz: 4, yz: 5, xz: 6, xy: 7, p: 8, q: 9, volume: 10, held: 11 } as const;

export type Call =
  | { do: "pack"; recipe: string }
  | { do: "open"; bytes: Uint8Array }
  | { do: "run"; protocol: string; forks: number }
  | { do: "fork"; from: number; friction: number }
  | { do: "kept" }
  | { do: "save" }
  | { do: "picture" }
  | { do: "strain"; xx: number; yy: number }
  | { do: "envelope"; length: number; count: number }
  | { do: "strength"; circles: number[] };

export interface Packed { void_ratio: number; draw: number; preparation_friction: number; recipe: string }
export interface Tested {
  events: string[];
  records: number;
  peak_s: number; // Pa; NaN of a test at constant volume that is too short
  peak_t: number;
  protocol?: string;
  strain?: number;
}
export interface Strength { friction_angle: number; standard_error: number; Nq: number }

/** By the way of a call. */
export type Note = { draw: number; voidRatio: number } | { rows: Float64Array[] } | { picture: Picture };
export type FromWorker = { id: number; note: Note } | { id: number; answer: unknown } | { id: number; error: string };
