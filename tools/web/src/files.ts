/** Files that the page gives away. */
import { column } from "./messages";
import type { Curve } from "./curves";

export function give(name: string, content: BlobPart, type: string) {
  const address = URL.createObjectURL(new Blob([content], { type }));
  const link = Object.assign(document.createElement("a"), { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** Every digit that a double has. In the plane there is no z. */
export function csvOf(curves: Curve[], dimension: number): string {
  const columns = Object.entries(column).filter(([name]) => dimension === 3 || !/z$/.test(name));
  const names: Record<string, string> = { p: "p_Pa", q: "q_Pa", volume: "volumetric_strain" };
  const head = ["test", ...columns.map(([name]) => names[name] ?? (/^[xyz]{2}$/.test(name) ? `sigma_${name}_Pa` : name))];
  const lines = curves.flatMap((curve) =>
    curve.rows.map((row) => [`"${curve.name}"`, ...columns.map(([, k]) => row[k])].join(",")),
  );
  return [head.join(","), ...lines, ""].join("\n");
}
