// Colours that colour-blind readers tell apart (Okabe and Ito 2008), each with a dash and a symbol of its own, and maps
// for quantities: viridis (van der Walt and Smith), one from blue over grey to orange about zero.

export const dark = () => getComputedStyle(document.documentElement).getPropertyValue("--dark").trim() === "1";
export const ink = () => getComputedStyle(document.documentElement).getPropertyValue("--ink").trim();
export const faint = () => getComputedStyle(document.documentElement).getPropertyValue("--faint").trim();
export const paper = () => getComputedStyle(document.documentElement).getPropertyValue("--paper").trim();

const onLight = ["#0072b2", "#d55e00", "#008563", "#b0568d", "#3a8fc0", "#a87400", "#444444"];
const onDark = ["#56b4e9", "#f08a3c", "#2fc79a", "#e39cc5", "#9ad1f2", "#e6b94a", "#cccccc"];
const dashes = [[], [8, 3], [2, 3], [9, 3, 2, 3], [5, 2, 2, 2, 2, 2]];
export const symbols = ["circle", "square", "triangle", "diamond", "cross"] as const;
export type Symbol = (typeof symbols)[number];

export function styleOf(kind: number) {
  const list = dark() ? onDark : onLight;
  return { colour: list[kind % list.length], dash: dashes[kind % dashes.length], symbol: symbols[kind % symbols.length] };
}

const viridis = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99],
  [170, 220, 50], [253, 231, 37]];
const aboutZero = [[0, 62, 125], [60, 122, 178], [148, 187, 215], [222, 222, 222], [239, 178, 122], [209, 112, 32],
  [127, 54, 0]];

export function colour(part: number, centred: boolean): [number, number, number] {
  if (!Number.isFinite(part)) return [150, 150, 150];
  const map = centred ? aboutZero : viridis, at = Math.min(1, Math.max(0, part)) * (map.length - 1);
  const low = Math.min(map.length - 2, Math.floor(at));
  return map[low].map((value, k) => Math.round(value + (at - low) * (map[low + 1][k] - value))) as [number, number, number];
}
export const css = (rgb: number[]) => `rgb(${rgb.join(",")})`;
