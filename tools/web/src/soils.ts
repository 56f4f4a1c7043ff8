/** Soils to begin with, and where their numbers are from. */
export interface Soil {
  name: string;
  source: string;
  shape: "disc" | "ellipse" | "sphere";
  aspect: number; // b/a of ellipses
  grading: "uniform" | "sieve";
  smallest: number; // mm, diameters
  largest: number;
  d10: number;
  d50: number;
  d60: number;
  friction: number; // degrees, between grains
  voidRatio: string; // empty: as packed with the final friction
  modulus: number; // MPa
  stiffnessRatio: number; // kt/kn of discs and ellipses; of spheres Hertz's law has Poisson's ratio
  rolling: boolean;
}

const dense: Soil = {
  name: "Dense discs",
  source: "Liang and Zhao 2019, Int. J. Numer. Anal. Methods Geomech., table 2 (pack_dense of the program)",
  shape: "disc",
  aspect: 1,
  grading: "uniform",
  smallest: 6,
  largest: 14,
  d10: 0.2,
  d50: 0.35,
  d60: 0.37,
  friction: 23,
  voidRatio: "0.1874",
  modulus: 800,
  stiffnessRatio: 0.5,
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
  bedded: {
    ...dense,
    name: "Bedded ellipses",
    source: "Liang et al. 2023, table 2 (pack_bedded of the program): kn = kt = 6e6 N/m; long axes within 30° of x",
    shape: "ellipse",
    aspect: 0.743,
    smallest: 8.62, // twice sqrt(a b), a = 5 mm
    largest: 8.62,
    friction: 31,
    voidRatio: "",
    modulus: 1392, // kn over the radius of equal grains
    stiffnessRatio: 1,
    rolling: false,
  },
  spheres: {
    ...dense,
    name: "Glass spheres",
    source: "The packing “hertz” of YADE's reference tests (pack_hertz of the program), Hertz's law, Poisson's ratio 0.25",
    shape: "sphere",
    smallest: 2,
    largest: 4,
    friction: 26.6,
    voidRatio: "0.6208",
    modulus: 7000,
    rolling: false,
  },
};
