/** A whole set-up: what the form shows, the link carries, and the program reads as TOML. */
import { soils, type Soil } from "./soils";
import { words } from "./words";

export type TestKind = "biaxial" | "undrained" | "shear" | "isotropic";

export interface SetUp extends Soil {
  preset: string;
  grains: number;
  test: TestKind;
  pressures: number[]; // kPa
  strain: number; // %
  seeds: number;
}

export function usual(): SetUp {
  return { ...soils.dense, preset: "dense", grains: 400, test: "biaxial", pressures: [100], strain: 10, seeds: 1 };
}

/** What a set-up is tested in: a plane, or space. */
export const dimensionOf = (setUp: { shape: Soil["shape"] }) => (setUp.shape === "sphere" ? 3 : 2);
export const testsOf = (setUp: SetUp): Record<TestKind, string> => (dimensionOf(setUp) === 3 ? words.testsInSpace : words.tests);

/** Numbers of the set-up with what is allowed; beyond these the page would run for hours or the laws do not hold. */
export const ranges: Partial<Record<keyof SetUp, [number, number]>> = {
  grains: [50, 3000],
  smallest: [0.01, 100],
  largest: [0.01, 100],
  d10: [0.01, 100],
  d50: [0.01, 100],
  d60: [0.01, 100],
  friction: [0, 60],
  modulus: [1, 100000],
  strain: [0.1, 50],
  seeds: [1, 20],
};

/** What is wrong with a set-up, one sentence each. */
export function mistakes(setUp: SetUp): string[] {
  const found: string[] = [];
  const names = words.fields as Record<string, string>;
  const check = (name: string, value: number, low: number, high: number) => {
    if (!(value >= low && value <= high)) found.push(words.limits(name, low, high));
  };
  for (const [key, [low, high]] of Object.entries(ranges)) {
    const sieve = /^d\d0$/.test(key);
    if (sieve !== (setUp.grading === "sieve") && (sieve || key === "smallest" || key === "largest")) continue;
    const label = sieve ? `sieve${key.slice(1)}` : key;
    check(names[label], setUp[key as keyof SetUp] as number, low, high);
  }
  if (setUp.voidRatio.trim() !== "") check(names.voidRatio, Number(setUp.voidRatio), 0.05, 1);
  if (setUp.pressures.length === 0 || setUp.pressures.length > 10) check(words.fields.pressures, NaN, 1, 10000);
  for (const pressure of setUp.pressures) check(words.fields.pressures, pressure, 1, 10000);
  const ordered =
    setUp.grading === "sieve" ? setUp.d10 <= setUp.d50 && setUp.d50 <= setUp.d60 : setUp.smallest <= setUp.largest;
  if (!ordered) found.push(words.order);
  return found;
}

export function recipeOf(setUp: SetUp, seed: number, pressure: number): string {
  const grading =
    setUp.grading === "sieve"
      ? `grading = "d10_d60"\nd10_mm = ${setUp.d10}\nd50_mm = ${setUp.d50}\nd60_mm = ${setUp.d60}`
      : `grading = "uniform"\nsmallest_radius_m = ${setUp.smallest / 2000}\nlargest_radius_m = ${setUp.largest / 2000}`;
  // Ten grains thick, as the specimens of discs that the presets are from: the force on a grain grows with the slab.
  const middle = setUp.grading === "sieve" ? setUp.d50 : (setUp.smallest + setUp.largest) / 2;
  const thickness = setUp.shape === "sphere" ? "" : `thickness_m = ${(10 * middle) / 1000}\n`;
  const outline =
    setUp.shape === "ellipse"
      ? `\nsmallest_aspect_ratio = ${setUp.aspect}\nlargest_aspect_ratio = ${setUp.aspect}\nbedding_angle_deg = 0\nbedding_spread_deg = 30`
      : "";
  const preparation = setUp.shape === "ellipse" && setUp.voidRatio.trim() === "" ? "[preparation]\nfriction = 0.2\n\n" : "";
  const voidRatio = setUp.voidRatio.trim() === "" ? "" : `void_ratio = ${Number(setUp.voidRatio)}\n`;
  const rolling = setUp.rolling ? "rolling_stiffness = 1\nrolling_friction = 0.05\n" : "";
  const [law, second] =
    setUp.shape === "sphere" ? ["hertz_mindlin", "poisson_ratio = 0.25"] : ["linear", `stiffness_ratio = ${setUp.stiffnessRatio}`];
  return `[pack]
name = "${setUp.name}"
shape = "${setUp.shape}"
number = ${setUp.grains}
seed = ${seed}
${thickness}
[grains]
${grading}${outline}

${preparation}[target]
pressure_Pa = ${pressure * 1000}
${voidRatio}
[contact]
law = "${law}"
rolling = ${setUp.rolling}

[damping]
local = 0.1

[[material]]
name = "sand"
density_kg_m3 = 2650
young_modulus_Pa = ${setUp.modulus * 1e6}
${second}
friction_angle_deg = ${setUp.friction}
${rolling}`;
}

export function protocolOf(setUp: SetUp, pressure: number): string {
  const strain = setUp.strain / 100;
  const every = strain / 200;
  const axis = dimensionOf(setUp) === 3 ? "z" : "y";
  const head = `[test]\nname = "${testsOf(setUp)[setUp.test]}"\ndimension = ${dimensionOf(setUp)}\npressure_Pa = ${pressure * 1000}\n
[loading]\nmode = "quasi_static"\n
[solver]\ntarget_unbalanced = 1e-3\nmax_overlap_ratio = 0.5\n
[[stage]]\nkind = "isotropic"\n\n[[stage]]\n`;
  switch (setUp.test) {
    case "biaxial":
      return `${head}kind = "compression"\naxis = "${axis}"\nto_strain = ${strain}\nrecord_every = ${every}\nlateral = "constant_stress"\n`;
    case "undrained":
      return `${head}kind = "compression"\naxis = "${axis}"\nto_strain = ${strain}\nrecord_every = ${every}\nlateral = "constant_volume"
  [[stage.until]]\n  quantity = "p_over_first"\n  below = 1e-3\n`;
    case "shear":
      return `${head}kind = "simple_shear"\nto_strain = ${strain}\nrecord_every = ${every}\nnormal = "constant_volume"\n`;
    case "isotropic": {
      const steps = [1.5, 2, 3, 4, 6, 8, 12, 16].map((factor) => factor * pressure * 1000);
      return `${head}kind = "pressure_path"\nto_Pa = [${steps.join(", ")}]\nrecords_per_point = 5\n`;
    }
  }
}

/** The set-up in the fragment of the address, and back: null if the fragment is none of this page. */
export function fragmentOf(setUp: SetUp): string {
  return `#${encodeURIComponent(JSON.stringify(setUp))}`;
}

export function fromFragment(fragment: string): SetUp | null {
  try {
    const read = JSON.parse(decodeURIComponent(fragment.replace(/^#/, ""))) as Record<string, unknown>;
    const all = usual();
    for (const [key, value] of Object.entries(all)) if (typeof read[key] !== typeof value) return null;
    const setUp = { ...all, ...read } as SetUp;
    const known = setUp.preset in soils && setUp.test in words.tests && ["disc", "ellipse", "sphere"].includes(setUp.shape) && Array.isArray(setUp.pressures);
    const plain = /^[\w .,()-]*$/.test(setUp.name);
    return known && plain && mistakes(setUp).length === 0 ? setUp : null;
  } catch {
    return null;
  }
}
