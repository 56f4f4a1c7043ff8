// Files that a reader takes from the page. Nothing is asked of a server: the file is made here.

export function download(name: string, kind: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: kind }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const cell = (value: string | number | null | undefined) =>
  value == null || (typeof value === "number" && !Number.isFinite(value)) ? ""
    : /[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : String(value);

export const csvOf = (rows: (string | number | null | undefined)[][]) => rows.map((row) => row.map(cell).join(",")).join("\n") + "\n";

/** Two buttons below a figure. */
export function buttons(name: () => string, csv: () => string, svg: () => string): HTMLElement {
  const box = document.createElement("span");
  box.className = "downloads";
  for (const [label, kind, text] of [["CSV", "text/csv", csv], ["SVG", "image/svg+xml", svg]] as const) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = label;
    button.title = `save what is drawn as ${label}`;
    button.addEventListener("click", () => download(`${name()}.${label.toLowerCase()}`, kind, text()));
    box.append(button);
  }
  return box;
}
