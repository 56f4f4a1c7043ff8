/** Files that the page gives away. */
import { column } from "./messages";
import type { Curve } from "./curves";

export function give(name: string, content: BlobPart, type: string) {
  const address = URL.createObjectURL(new Blob([content], { type }));
  const link = Object.assign(document.createElement("a"), { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** Every digit that a double has. */
export function csvOf(curves: Curve[]): string {
  const head = "test,stage,strain,sigma_xx_Pa,sigma_yy_Pa,sigma_xy_Pa,p_Pa,q_Pa,volumetric_strain,held";
  const columns = Object.values(column);
  const lines = curves.flatMap((curve) =>
    curve.rows.map((row) => [`"${curve.name}"`, ...columns.map((k) => row[k])].join(",")),
  );
  return [head, ...lines, ""].join("\n");
}
