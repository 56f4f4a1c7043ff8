// What `rvelab sheet` wrote into the page (rvelab/sheet/page.cpp).
import type { Table } from "./data";

export interface Series { label: string; kind: number; line: boolean; measured: boolean; x: (number | null)[];
  y: (number | null)[]; error: (number | null)[] }
export interface Figure { key: string; title: string; x_label: string; y_label: string; caption: string; x_log: boolean;
  y_log: boolean; series: Series[] }
export interface Headline { label: string; where: string; value: string; interval: string; published: string;
  definition: string }
export interface Group { name: string; list: Table; matrices: Table[]; about: Table; figures: Figure[] }
export interface Model { name: string; remarks: string[]; parameters: Table; misfits: Table; figures: Figure[] }
export interface Sheet { version: string; title: string; headline: Headline[]; groups: Group[]; remarks: string[];
  models: Model[] }
