// Tables of the pages.
import type { Table } from "./data";

/** A column that says nothing below its head is left out; a head of empty texts makes the first column heads. */
export function tableOf(rows: Table): HTMLElement {
  const box = document.createElement("div"), table = document.createElement("table");
  box.className = "wide";
  rows.forEach((row, k) => {
    if (k === 0 && row.every((cell) => !cell)) return;
    const line = table.insertRow();
    row.forEach((cell, column) => {
      if (rows.length > 1 && rows.slice(1).every((other) => !other[column])) return;  // says nothing
      const place = document.createElement(k === 0 || (column === 0 && rows[0].every((head) => !head)) ? "th" : "td");
      place.textContent = cell;
      line.append(place);
    });
  });
  box.append(table);
  return box;
}
