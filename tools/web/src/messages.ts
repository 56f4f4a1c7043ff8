/** What page and worker say to each other. */
export interface Picture {
  cell: Float64Array; // a_x, a_y, b_x, b_y, m
  grains: Float64Array; // x, y, r, angle, a, b of each
  contacts: Float64Array; // x, y, branch x, branch y, force, slides: of each
  void_ratio: number;
  coordination: number;
  stress: Float64Array; // xx, yy, xy, Pa, tension positive
}

/** Columns of a record. */
export const column = { stage: 0, strain: 1, xx: 2, yy: 3, xy: 4, p: 5, q: 6, volume: 7, held: 8 } as const;

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
  peak_s: number;
  peak_t: number;
  peak_strain: number;
  friction_angle: number;
  protocol?: string;
  strain?: number;
}
export interface Strength { friction_angle: number; standard_error: number; Nq: number }

/** By the way of a call. */
export type Note = { draw: number; voidRatio: number } | { rows: Float64Array[] } | { picture: Picture };
export type FromWorker = { id: number; note: Note } | { id: number; answer: unknown } | { id: number; error: string };
