// What is drawn of a state: grains with their colours, chains with their widths, the cell; and the same as SVG.
import { colour, css, ink, paper } from "./palette";
import type { Field, Run, State } from "./data";
import type { Viewer } from "./viewer";

export type Draw = "grains" | "both" | "chains";
export type ChainColour = "force" | "friction";

export interface Picture {
  of: unknown; dimension: 2 | 3; kind: number; count: number; largest: number;
  position: Float32Array; half: Float32Array; angle: Float32Array; colour: Float32Array;
  rocks: number[][];    // in space: centre and three half axes, in metres
  round: Float32Array;  // 0: a rectangle, as points in the plane; 1: a disc, an ellipse, a ball
  chains: number; begin: Float32Array; end: Float32Array; width: Float32Array; chainColour: Float32Array;
  edges: Float32Array; low: [number, number, number]; high: [number, number, number];
}

const strong = [0.84, 0.3, 0.05], weak = [0.45, 0.45, 0.45];

/** Edges of the cell about its centre. */
function edgesOf(state: State, centre: number[]): Float32Array {
  const L = state.lattice, d = state.dimension, points: number[] = [];
  const corner = (bits: number) => [0, 1, 2].map((k) => centre[k]
    + (k < d ? [0, 1, 2].slice(0, d).reduce((sum, axis) => sum + L[3 * axis + k] * ((bits >> axis & 1) - 0.5), 0) : 0));
  for (let bits = 0; bits < 1 << d; ++bits)
    for (let axis = 0; axis < d; ++axis)
      if (!(bits >> axis & 1)) points.push(...corner(bits), ...corner(bits | 1 << axis));
  return new Float32Array(points);
}

export function pictureOf(run: Run, state: State, field: Field | undefined, draw: Draw, chainColour: ChainColour): Picture {
  const shape = run.states.shape, kind = { disc: 0, ellipse: 1, sphere: 2, point: state.dimension === 2 ? 3 : 2 }[shape];
  // Of points with rocks "chains" are the rocks. In the plane rocks are drawn as grains are, in space as ellipsoids.
  const points = shape === "point", shownRocks = points && draw === "grains" ? [] : state.rocks;
  const flatRocks = state.dimension === 2 ? shownRocks : [], rocks = flatRocks.length, n = draw === "chains" && !points ? 0 : state.n + rocks;
  const position = new Float32Array(3 * (state.n + rocks)), half = new Float32Array(2 * (state.n + rocks));
  const angle = new Float32Array(state.n + rocks), tint = new Float32Array(3 * (state.n + rocks));
  const round = new Float32Array(state.n + rocks).fill(kind === 3 ? 0 : 1).fill(1, state.n);
  position.set(state.position);
  angle.set(state.angle);
  // In space chains lie within the grains, rocks within the points: these are drawn at half of their size.
  const shrink = points && draw === "chains" ? 0 : draw === "both" && state.dimension === 3 ? 0.5 : 1;
  half.set(state.half.map((value) => value * shrink));
  const values = field && state.values.get(field.key);
  const reach = field?.about_zero ? Math.max(Math.abs(field.from), Math.abs(field.to)) : 0;
  for (let g = 0; g < state.n; ++g) {
    const value = values ? values[g] : NaN;
    const part = !field ? NaN : field.about_zero ? 0.5 + value / (2 * reach) : (value - field.from) / (field.to - field.from || 1);
    const rgb = colour(part, field?.about_zero ?? false);
    for (let k = 0; k < 3; ++k) tint[3 * g + k] = rgb[k] / 255;
  }
  flatRocks.forEach((rock, k) => {
    const g = state.n + k;
    position.set([rock[0], rock[1], 0], 3 * g);
    half.set([rock[3], rock[4]], 2 * g);
    angle[g] = rock[5];
    tint.set([0.6, 0.6, 0.6], 3 * g);
  });

  const c = draw === "grains" ? 0 : state.contacts;
  const begin = new Float32Array(3 * c), end = new Float32Array(3 * c), width = new Float32Array(c), own = new Float32Array(3 * c);
  const mean = state.force.reduce((sum, value) => sum + value, 0) / (state.contacts || 1);
  const radius = state.half.reduce((sum, value) => sum + value, 0) / (2 * state.n);
  for (let m = 0; m < c; ++m) {
    for (let k = 0; k < 3; ++k) {
      begin[3 * m + k] = state.position[3 * state.i[m] + k];
      end[3 * m + k] = begin[3 * m + k] + state.branch[3 * m + k];
    }
    width[m] = radius * (state.dimension === 2 ? 0.16 : 0.1) * Math.min(8, state.force[m] / (mean || 1)) + 0.02 * radius;
    own.set(chainColour === "friction" ? colour(state.friction[m], false).map((value) => value / 255)
      : state.force[m] > mean ? strong : weak, 3 * m);
  }
  const low: [number, number, number] = [Infinity, Infinity, Infinity], high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  const edges = edgesOf(state, run.states.centre ?? [0, 0, 0]);
  for (let k = 0; k < edges.length; ++k) {
    low[k % 3] = Math.min(low[k % 3], edges[k]);
    high[k % 3] = Math.max(high[k % 3], edges[k]);
  }
  for (const rock of state.rocks)
    for (let k = 0; k < state.dimension; ++k) {
      const reach = state.dimension === 2 ? rock[3] : Math.hypot(rock[3 + k], rock[6 + k], rock[9 + k]);
      low[k] = Math.min(low[k], rock[k] - reach);
      high[k] = Math.max(high[k], rock[k] + reach);
    }
  if (shape !== "point")
    for (let k = 0; k < state.dimension; ++k) { low[k] -= 1.5 * radius; high[k] += 1.5 * radius; }
  return { of: run, dimension: state.dimension, kind, count: n, largest: half.reduce((a, b) => Math.max(a, b), 0), position, half, angle, round, rocks: state.dimension === 3 ? shownRocks : [],
    colour: tint, chains: c, begin, end, width, chainColour: own, edges: shape === "point" ? new Float32Array(0) : edges, low, high };
}

const rgbOf = (values: Float32Array, k: number) => css([0, 1, 2].map((m) => Math.round(255 * values[3 * k + m])));

/** As the viewer shows it now. */
export function svgOfPicture(picture: Picture, viewer: Viewer, title: string): string {
  const scale = viewer.pixelsPerMetre(), at = (values: Float32Array, k: number) => viewer.project(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
  const pieces: { z: number; text: string }[] = [];
  const f = (value: number) => value.toFixed(2);
  for (let g = 0; g < picture.count; ++g) {
    const [x, y, z] = at(picture.position, g), a = scale * picture.half[2 * g], b = scale * picture.half[2 * g + 1];
    const look = `fill="${rgbOf(picture.colour, g)}" stroke="#000" stroke-opacity="0.45" stroke-width="0.6"`;
    const turn = ((-picture.angle[g] * 180) / Math.PI).toFixed(1);
    pieces.push({ z, text: !picture.round[g] ? `<rect x="${f(x - a)}" y="${f(y - b)}" width="${f(2 * a)}" height="${f(2 * b)}" transform="rotate(${turn} ${f(x)} ${f(y)})" fill="${rgbOf(picture.colour, g)}"/>`
      : a !== b ? `<ellipse cx="${f(x)}" cy="${f(y)}" rx="${f(a)}" ry="${f(b)}" transform="rotate(${turn} ${f(x)} ${f(y)})" ${look}/>`
      : `<circle cx="${f(x)}" cy="${f(y)}" r="${f(a)}" ${look}/>` });
  }
  for (const rock of picture.rocks) {
    const [x, y, z] = viewer.project(rock[0], rock[1], rock[2]);
    let xx = 0, xy = 0, yy = 0; // the outline of sum u_k v_k, |u| = 1, is the ellipse of sum v_k v_k^T
    for (let k = 3; k < 12; k += 3) {
      const [u, v] = viewer.project(rock[0] + rock[k], rock[1] + rock[k + 1], rock[2] + rock[k + 2]);
      xx += (u - x) ** 2; xy += (u - x) * (v - y); yy += (v - y) ** 2;
    }
    const mean = (xx + yy) / 2, apart = Math.hypot((xx - yy) / 2, xy), turn = (Math.atan2(2 * xy, xx - yy) * 90) / Math.PI;
    pieces.push({ z, text: `<ellipse cx="${f(x)}" cy="${f(y)}" rx="${f(Math.sqrt(mean + apart))}" ry="${f(Math.sqrt(Math.max(0, mean - apart)))}" transform="rotate(${turn.toFixed(1)} ${f(x)} ${f(y)})" fill="rgb(153,153,153)" stroke="#000" stroke-opacity="0.45" stroke-width="0.6"/>` });
  }
  for (let m = 0; m < picture.chains; ++m) {
    const [x, y, z] = at(picture.begin, m), [u, v, w] = at(picture.end, m);
    pieces.push({ z: picture.dimension === 2 ? -2 : (z + w) / 2, text: `<path d="M${f(x)} ${f(y)}L${f(u)} ${f(v)}" stroke="${rgbOf(picture.chainColour, m)}" stroke-width="${f(scale * picture.width[m])}"/>` });
  }
  pieces.sort((one, other) => other.z - one.z);
  let box = "";
  for (let k = 0; k < picture.edges.length / 6; ++k) {
    const [x, y] = at(picture.edges, 2 * k), [u, v] = at(picture.edges, 2 * k + 1);
    box += `M${f(x)} ${f(y)}L${f(u)} ${f(v)}`;
  }
  const width = viewer.place.clientWidth, height = viewer.place.clientHeight;
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" role="img"><title>${title}</title>`
    + `<rect width="${width}" height="${height}" fill="${paper()}"/>${pieces.map((piece) => piece.text).join("")}`
    + `<path d="${box}" fill="none" stroke="${ink()}"/></svg>`;
}
