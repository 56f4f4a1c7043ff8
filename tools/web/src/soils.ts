/** Soils to begin with, and where their numbers are from. */
export interface Soil {
  name: string;
  source: string;
  shape: "disc" | "ellipse";
  grading: "uniform" | "sieve";
  smallest: number; // mm, diameters
  largest: number;
  d10: number;
  d50: number;
  d60: number;
  friction: number; // degrees, between grains
  voidRatio: string; // empty: as packed with the final friction
  modulus: number; // MPa
  rolling: boolean;
}

const dense: Soil = {
  name: "Dense discs",
  source: "Liang and Zhao 2019, Int. J. Numer. Anal. Methods Geomech., table 2 (pack_dense of the program)",
  shape: "disc",
  grading: "uniform",
  smallest: 6,
  largest: 14,
  d10: 0.2,
  d50: 0.35,
  d60: 0.37,
  friction: 23,
  voidRatio: "0.1874",
  modulus: 800,
  rolling: true,
};

export const soils: Record<string, Soil> = {
  dense,
  loose: {
    ...dense,
    name: "Loose discs",
    source: "The same grains without rolling resistance, packed with their final friction: as loose as they come",
    voidRatio: "",
    rolling: false,
  },
  hostun: {
    ...dense,
    name: "Discs graded as Hostun sand RF",
    source: "Grading: Flavigny et al. 1990; contacts of the dense discs. A plane of discs is no sand: compare trends",
    grading: "sieve",
    d10: 0.22,
    d50: 0.35,
    d60: 0.374,
    voidRatio: "",
  },
};
